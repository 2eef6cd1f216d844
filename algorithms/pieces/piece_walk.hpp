// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Walks the elements at which discontinuous data stop.
#pragma once

#include <optional>

#include <nestgrid/algorithms/discontinuous.hpp>
#include <pieces/corner_values.hpp>
#include <surfaces/surface_builder.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The grid of discontinuous data, with room for these in a walk's elements.
/// \param in_front how many components are in front of the data
inline WidenedHierarchy<float> widened(const DiscontinuousData& data, std::size_t in_front) {
    return {data.grid(), in_front + static_cast<std::size_t>(data.components()) - 1};
}

/// Draws elements one by one. The walk carries no values: what is drawn gets them here.
class PieceWalk : public Visitor<double> {
public:
    using View = ElementView<double>;
    static constexpr Needs needs{.values = false, .keys = true, .positions = true};

    /// \param walk of the hierarchy that widened() makes of the data
    /// \param deviations null: only leaves are drawn
    /// \param in_front how many components are in front of the data
    /// All arguments are borrowed.
    PieceWalk(const Walk<double>& walk, const DiscontinuousData& data,
              const ElementDeviations* deviations, const DiscontinuousOptions& options,
              std::size_t in_front);

    /// Walks and draws.
    void run(DiscontinuousSurface& result);

    Decision inspect(const View& view, const Split& split) final;
    void extract(const View& view) final;

protected:
    /// Whether anything is drawn in an element or below it.
    virtual bool of_interest(const View& view, const Split& split) = 0;
    /// Draws an element. The components in front of the data are not set.
    /// \param values as ElementView::value
    /// \return how far component 0, as it is drawn, is from what the corners interpolate
    virtual double draw(const View& view, std::span<double> values) = 0;

    const Walk<double>& walk() const { return *walk_; }
    ~PieceWalk() = default;

private:
    /// The range of component 0; infinite where no deviations are known.
    struct Range {
        const ElementDeviations* deviations;
        double least() const;
        double greatest() const;
    };

    void count();
    void raise_error_bound(const View& view, double residual);

    const Walk<double>* walk_;
    CornerValues corner_values_;
    const ElementDeviations* deviations_;
    const DiscontinuousOptions* options_;
    std::size_t in_front_;
    std::vector<double> values_;
    Range range_;
    std::size_t next_ = 0;  // entry of the next split element
    double deviation_ = 0;  // of the element that stops
    TraversalCounts counts_;
    double error_bound_ = 0;
};

/// \throw InvalidInput, GridError as the functions of discontinuous.hpp say
void require_drawable(const DiscontinuousData& data, int dimension,
                      const DiscontinuousOptions& options);

/// Draws a surface. Measures deviations where the threshold needs them and none are given.
/// \param make make(walk, deviations, part) returns a PieceWalk that draws into a part
template <class Make>
DiscontinuousSurface draw_pieces(const WidenedHierarchy<float>& hierarchy,
                                 const DiscontinuousData& data, const DiscontinuousOptions& options,
                                 const Make& make) {
    std::optional<ElementDeviations> own;
    const ElementDeviations* deviations = options.deviations;
    if (deviations == nullptr && options.threshold > 0) deviations = &own.emplace(data);
    const Walk<double> walk(hierarchy, PieceWalk::needs);
    SurfacePart<3> part;
    part.surface.elements = hierarchy.make_elements();
    DiscontinuousSurface result;
    make(walk, deviations, part).run(result);
    result.surface = std::move(part.surface);
    return result;
}

}  // namespace nestgrid::engine
