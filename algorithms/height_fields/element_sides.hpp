// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The corners of a two-dimensional element, and its sides as parts of maximal edges: what the nodes
// recorded on edges (edge_nodes.hpp) come from, and where they are found again.
#pragma once

#include <array>
#include <vector>

#include <height_fields/edge_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// An edge of an element on the maximal edge around it.
struct ElementSide {
    std::array<std::size_t, 2> corner;
    KeyPair around;               ///< the ends of the maximal edge
    std::array<double, 2> place;  ///< of the two corners on it

    /// Whether places rise from the first corner to the second.
    bool rises() const { return place[0] < place[1]; }
};

template <class Real>
class ElementSides {
public:
    using View = ElementView<Real>;

    explicit ElementSides(const Walk<Real>& walk)
        : walk_{&walk}, components_{walk.components()}, values_(components_) {}

    /// Loads an element, which must outlive its use.
    void load(const View& view);

    const View& view() const { return *view_; }
    const std::array<NodeKey, max_corners>& keys() const { return key_; }
    const std::array<Point, max_corners>& positions() const { return x_; }
    double u(std::size_t corner, std::size_t component = 0) const {
        return static_cast<double>(view_->value[corner * components_ + component]);
    }
    /// All components at a corner; valid until the next call.
    std::span<const double> values(std::size_t corner) {
        for (std::size_t c = 0; c < components_; ++c) values_[c] = u(corner, c);
        return values_;
    }
    /// An edge that is a part of a larger one.
    ElementSide side(std::size_t edge) const;
    /// The edges on the boundary of the domain, as a mask.
    unsigned boundary() const { return walk_->boundary(*view_); }

    /// Records the nodes that the element has inside closed edges: of each of its edges the end
    /// with the greater place, because that is the other end of the next edge, too.
    void record(EdgeNodes& nodes);

private:
    const Walk<Real>* walk_;
    std::size_t components_;
    const View* view_ = nullptr;
    std::array<NodeKey, max_corners> key_{};
    std::array<Point, max_corners> x_{};
    std::vector<double> values_;
};

}  // namespace nestgrid::engine
