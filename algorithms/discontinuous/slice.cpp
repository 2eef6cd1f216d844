// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <contours/cell_contour.hpp>
#include <discontinuous/element_section.hpp>
#include <discontinuous/piece_walk.hpp>

namespace nestgrid {

namespace {

/// Component 0 of the values is the function, the data follow.
class PieceSlice final : public engine::PieceWalk {
public:
    PieceSlice(const engine::Pieces& pieces, const engine::PositionFunctions& function)
        : PieceWalk(pieces), function_{&function}, section_(*pieces.walk) {}

private:
    bool of_interest(const View& view, const engine::Split& split) override;
    double draw(const View& view, std::span<double> values) override;
    std::span<const Point> corners(const View& view) const {
        return std::span(x_).first(view.corner_count());
    }

    const engine::PositionFunctions* function_;
    engine::ElementSection section_;
    // The corners of the element that of_interest() was asked about last, and the function there.
    std::array<Point, max_corners> x_{};
    std::array<double, max_corners> f_{};
};

bool PieceSlice::of_interest(const View& view, const engine::Split& split) {
    walk().corners(view, nullptr, x_.data());
    const std::span<const Point> x = corners(view);
    for (std::size_t k = 0; k < x.size(); ++k) f_[k] = function_->at<double>(0, x[k]);
    const auto [least, greatest] = std::ranges::minmax(std::span(f_).first(x.size()));
    if (least <= 0 && greatest >= 0) return true;
    if (view.is_leaf() || function_->affine(0)) return false;
    const auto within = function_->range(0, x, {least, greatest}, f_[0],
                                         function_->distance_beyond_hull(split.keys, true));
    return within.least <= 0 && within.greatest >= 0;
}

double PieceSlice::draw(const View& view, std::span<double> values) {
    const std::span<const Point> x = corners(view);
    const std::size_t stride = walk().components();
    for (std::size_t k = 0; k < x.size(); ++k) values[k * stride] = f_[k];
    if (!section_.draw(view, surface().builder()) || x.size() == 4) return 0;
    std::array<double, max_corners> data;
    for (std::size_t k = 0; k < x.size(); ++k) data[k] = values[k * stride + 1];
    return 2 * engine::affine_residual(x, std::span<const double>(data).first(x.size()));
}

}  // namespace

DiscontinuousSurface slice(const DiscontinuousData& data, const LevelFunction& function,
                           const DiscontinuousOptions& options, const Executor& executor) {
    engine::require_drawable(data, 3, options);
    const LevelFunction* const functions[] = {&function};
    const engine::WidenedHierarchy<float> hierarchy = engine::widened(data, 1);
    const engine::PositionFunctions placed(functions, hierarchy, options.position_bounds);
    return engine::draw_pieces(hierarchy, data, options, 1, executor, [&](const auto& pieces) {
        return std::make_unique<PieceSlice>(pieces, placed);
    });
}

}  // namespace nestgrid
