// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <graphs/element_polygon.hpp>
#include <nestgrid/error.hpp>
#include <pieces/piece_walk.hpp>

namespace nestgrid {

namespace {

class PieceShading final : public engine::PieceWalk {
public:
    PieceShading(const engine::Walk<double>& walk, const DiscontinuousData& data,
                 const ElementDeviations* deviations, const DiscontinuousOptions& options,
                 double scale, engine::SurfacePart<3>& part)
        : PieceWalk(walk, data, deviations, options, 0),
          polygon_(walk, {scale, options.flatness}),
          surface_({part, false, options.elements}, 0) {}

private:
    bool of_interest(const View&, const engine::Split&) override { return true; }
    double draw(const View& view, std::span<double>) override {
        polygon_.load(view);
        polygon_.draw(nullptr, surface_);
        return polygon_.chord(view.is_leaf());
    }

    engine::ElementPolygon<double> polygon_;
    engine::LevelSurface<3> surface_;
};

DiscontinuousSurface triangulate(const DiscontinuousData& data, double scale,
                                 const DiscontinuousOptions& options) {
    engine::require_drawable(data, 2, options);
    if (!std::isfinite(scale)) {
        throw InvalidInput("the scale of the heights is not a finite number");
    }
    return engine::draw_pieces(engine::widened(data, 0), data, options,
                               [&](const auto& walk, const auto* d, auto& part) {
                                   return PieceShading(walk, data, d, options, scale, part);
                               });
}

}  // namespace

DiscontinuousSurface shading(const DiscontinuousData& data, const DiscontinuousOptions& options) {
    return triangulate(data, 0, options);
}
DiscontinuousSurface height_field(const DiscontinuousData& data, double scale,
                                  const DiscontinuousOptions& options) {
    return triangulate(data, scale, options);
}

}  // namespace nestgrid
