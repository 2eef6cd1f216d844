// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The piece of an edge on which the data pass through a level.
#pragma once

#include <array>
#include <vector>

#include <contours/level.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Halves an edge of an element that stopped at the nodes that the grid has on it, and keeps, each
/// time, the half whose ends lie on different sides of a level. What it finds is a function of the
/// edge and the data on it alone, so that all elements around the edge find the same.
/// Time: O(depth) elements for an edge. Requires a grid on which elements that stop conform.
template <class Real>
class FinestPiece final : public Visitor<Real> {
public:
    using View = ElementView<Real>;

    struct End {
        NodeKey key = 0;
        Point x{};
        double along = 0;  ///< where it lies on the edge, 0 at the lower end
        std::vector<Real> value;
    };

    /// \param walk must carry values, keys and positions
    explicit FinestPiece(const Walk<Real>& walk) : walk_{&walk} {}

    /// \param low, high the corners at the ends of the edge, outside and inside the level
    /// \return the ends of the piece, valid until the next call
    const std::array<End, 2>& find(const View& view, std::size_t low, std::size_t high,
                                   const Level<Real>& level);

    // Answers to the walk.
    Decision inspect(const View& view, const Split& split) override;
    void extract(const View&) override {}

private:
    /// The corners of the element at hand.
    struct Corners {
        std::array<NodeKey, max_corners> key;
        std::array<Point, max_corners> x;
        std::size_t count;

        static constexpr std::size_t none = max_corners;
        std::size_t find(NodeKey of) const;
    };

    void load(const View& view);
    End end(const View& view, std::size_t corner, double along) const;
    void take_middle(const View& view, std::size_t corner);
    void look_for_middle(const Split& split, std::size_t low, std::size_t high);

    const Walk<Real>* walk_;
    const Level<Real>* level_ = nullptr;
    std::array<End, 2> piece_;
    Corners corners_{};
    NodeKey middle_ = 0;     // the node that halves the piece
    double along_ = 0;       // where it lies
    bool halves_ = false;    // middle_ is known, but not its value yet
    bool finished_ = false;  // nothing halves the piece
};

}  // namespace nestgrid::engine
