// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <discontinuous/piece_walk.hpp>
#include <height_fields/element_polygon.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

class PieceShading final : public engine::PieceWalk {
public:
    PieceShading(const engine::Pieces& pieces, double scale)
        : PieceWalk(pieces), polygon_(*pieces.walk, {scale, pieces.options->flatness}) {}

private:
    bool of_interest(const View&, const engine::Split&) override { return true; }
    double draw(const View& view, std::span<double>) override {
        polygon_.load(view);
        engine::Polygon polygon = polygon_.polygon();
        polygon_.draw(polygon, surface());
        return polygon_.chord(polygon, view.is_leaf());
    }

    engine::ElementPolygon<double> polygon_;
};

DiscontinuousSurface triangulate(const DiscontinuousData& data, double scale,
                                 const DiscontinuousOptions& options, const Executor& executor) {
    engine::require_drawable(data, 2, options);
    if (!std::isfinite(scale)) {
        throw InvalidInput("the scale of the heights is not a finite number");
    }
    return engine::draw_pieces(
        engine::widened(data, 0), data, options, 0, executor,
        [&](const auto& pieces) { return std::make_unique<PieceShading>(pieces, scale); });
}

}  // namespace

DiscontinuousSurface shading(const DiscontinuousData& data, const DiscontinuousOptions& options,
                             const Executor& executor) {
    return triangulate(data, 0, options, executor);
}
DiscontinuousSurface height_field(const DiscontinuousData& data, double scale,
                                  const DiscontinuousOptions& options, const Executor& executor) {
    return triangulate(data, scale, options, executor);
}

}  // namespace nestgrid
