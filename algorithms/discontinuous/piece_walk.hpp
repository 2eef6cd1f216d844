// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Walks the elements at which discontinuous data stop.
#pragma once

#include <functional>
#include <memory>

#include <discontinuous/corner_values.hpp>
#include <drawing/drawing.hpp>
#include <nestgrid/algorithms/discontinuous.hpp>
#include <surfaces/drawn_surface.hpp>

namespace nestgrid::engine {

/// The grid of discontinuous data, with room for these in a walk's elements.
/// \param in_front how many components are in front of the data
inline WidenedHierarchy<float> widened(const DiscontinuousData& data, std::size_t in_front) {
    return {data.grid(), in_front + static_cast<std::size_t>(data.components()) - 1};
}

class PieceWalk;

/// What is drawn of discontinuous data, and how. All is borrowed; tasks share it.
struct Pieces {
    const Walk<double>* walk;  ///< of the hierarchy that widened() makes of the data
    const DiscontinuousData* data;
    const DiscontinuousOptions* options;
    std::size_t in_front;                 ///< how many components are in front of the data
    const ElementDeviations* deviations;  ///< null: only leaves are drawn
    double threshold = 0;
    /// Makes a walk that draws what one task walks, or everything.
    std::function<std::unique_ptr<PieceWalk>(const Pieces&)> make;
};

/// Draws elements one by one. The walk carries no values: what is drawn gets them here.
class PieceWalk : public Drawing<double> {
public:
    using Base = Drawing<double>;
    static constexpr Needs needs{.values = false, .keys = true, .positions = true};

    explicit PieceWalk(const Pieces& pieces);

    void run(const Executor& executor) final { walk_elements(executor); }
    void count_only(std::uint64_t most) final;
    /// Moves all that was drawn into a result.
    void report(DiscontinuousSurface& result);

    Decision inspect(const View& view, const Split& split) final;
    Decision look(const View& view, const Split& split) final;
    void undo() final;
    void restart() final;
    void begin_entry(std::size_t number) final;
    void extract(const View& view) final;

protected:
    /// Whether anything is drawn in an element or below it.
    virtual bool of_interest(const View& view, const Split& split) = 0;
    /// Draws an element. The components in front of the data are not set.
    /// \param values as ElementView::value
    /// \return how far component 0, as it is drawn, is from what the corners interpolate
    virtual double draw(const View& view, std::span<double> values) = 0;

    const Walk<double>& walk() const { return *walk_; }
    /// What is drawn into; its elements share no vertices.
    DrawnSurface<3>& surface() { return surface_; }

private:
    /// The range of component 0; infinite where no deviations are known.
    struct Range {
        const ElementDeviations* deviations;
        double least() const;
        double greatest() const;
    };

    std::unique_ptr<Base> begin_part(std::unique_ptr<Base> used) final;
    void add(Base& part) final;
    void raise_error_bound(const View& view, double residual);

    const Pieces* pieces_;
    CornerValues corner_values_;
    const ElementDeviations* deviations_;  // null: only leaves are drawn
    std::vector<double> values_;
    Range range_;
    SurfacePart<3> part_;
    DrawnSurface<3> surface_;
    std::size_t next_ = 0;    // entry of the next split element
    std::size_t at_ = 0;      // next_ before the last inspect()
    std::size_t behind_ = 0;  // entry behind the element of the last inspect() and all below it
    std::vector<std::size_t> starts_;  // of a leader: next_ at each entry of the frontier
    const std::vector<std::size_t>* leads_ = nullptr;  // of a part: those of its leader
    double deviation_ = 0;                             // of the element that stops
};

/// \throw InvalidInput, GridError as the functions of discontinuous.hpp say
void require_drawable(const DiscontinuousData& data, int dimension,
                      const DiscontinuousOptions& options);

/// Draws a surface. Measures deviations where the threshold needs them and none are given.
/// \param hierarchy that widened() makes of the data
/// \param make as Pieces::make
DiscontinuousSurface draw_pieces(const WidenedHierarchy<float>& hierarchy,
                                 const DiscontinuousData& data, const DiscontinuousOptions& options,
                                 std::size_t in_front, const Executor& executor,
                                 std::function<std::unique_ptr<PieceWalk>(const Pieces&)> make);

}  // namespace nestgrid::engine
