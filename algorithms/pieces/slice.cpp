// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>

#include <contours/cell_contour.hpp>
#include <pieces/element_section.hpp>
#include <pieces/piece_walk.hpp>

namespace nestgrid {

namespace {

/// Component 0 of the values is the function, the data follow.
class PieceSlice final : public engine::PieceWalk {
public:
    PieceSlice(const engine::Walk<double>& walk, const engine::PositionFunctions& function,
               const DiscontinuousData& data, const ElementDeviations* deviations,
               const DiscontinuousOptions& options, engine::SurfacePart<3>& part)
        : PieceWalk(walk, data, deviations, options, 1),
          function_{&function},
          section_(walk.components()),
          builder_(part, false, options.elements) {}

private:
    bool of_interest(const View& view, const engine::Split& split) override;
    double draw(const View& view, std::span<double> values) override;
    std::span<const Point> load(const View& view);

    const engine::PositionFunctions* function_;
    engine::ElementSection section_;
    engine::SurfaceBuilder<3> builder_;
    std::array<Point, max_corners> x_{};
    std::array<double, max_corners> f_{};  // the function at the corners
};

/// Loads the corners of an element, and the function there.
std::span<const Point> PieceSlice::load(const View& view) {
    walk().corners(view, nullptr, x_.data());
    const std::span<const Point> x = std::span(x_).first(view.corner_count());
    for (std::size_t k = 0; k < x.size(); ++k) f_[k] = function_->at<double>(0, x[k]);
    return x;
}

bool PieceSlice::of_interest(const View& view, const engine::Split& split) {
    const std::span<const Point> x = load(view);
    const auto [least, greatest] = std::ranges::minmax(std::span(f_).first(x.size()));
    if (least <= 0 && greatest >= 0) return true;
    if (view.is_leaf() || function_->affine(0)) return false;
    const auto within =
        function_->range(0, x, {least, greatest}, f_[0], function_->stray(split.keys, true));
    return within.least <= 0 && within.greatest >= 0;
}

double PieceSlice::draw(const View& view, std::span<double> values) {
    const std::span<const Point> x = load(view);
    const std::size_t stride = walk().components();
    for (std::size_t k = 0; k < x.size(); ++k) values[k * stride] = f_[k];
    section_.draw(view, x, walk().boundary(view), builder_);
    if (!section_.drew() || x.size() == 4) return 0;
    std::array<double, max_corners> data;
    for (std::size_t k = 0; k < x.size(); ++k) data[k] = values[k * stride + 1];
    return 2 * affine_residual(x, std::span<const double>(data).first(x.size()));
}

DiscontinuousSurface cut(const DiscontinuousData& data, const LevelFunction& function,
                         const ElementDeviations* deviations, const DiscontinuousOptions& options) {
    engine::require_drawable(data, 3, deviations, options);
    std::optional<ElementDeviations> own;
    if (deviations == nullptr && options.threshold > 0) deviations = &own.emplace(data);
    const engine::WidenedHierarchy<float> hierarchy(data.grid(), engine::widening(data, 1));
    const LevelFunction* const functions[] = {&function};
    const engine::PositionFunctions placed(functions, hierarchy, options.position_bounds);
    const engine::Walk<double> walk(hierarchy, PieceSlice::needs);
    engine::SurfacePart<3> part;
    part.surface.elements = hierarchy.make_elements();
    DiscontinuousSurface result;
    PieceSlice(walk, placed, data, deviations, options, part).run(result);
    result.surface = std::move(part.surface);
    return result;
}

}  // namespace

DiscontinuousSurface slice(const DiscontinuousData& data, const LevelFunction& function,
                           const ElementDeviations& deviations,
                           const DiscontinuousOptions& options) {
    return cut(data, function, &deviations, options);
}
DiscontinuousSurface slice(const DiscontinuousData& data, const LevelFunction& function,
                           const DiscontinuousOptions& options) {
    return cut(data, function, nullptr, options);
}

}  // namespace nestgrid
