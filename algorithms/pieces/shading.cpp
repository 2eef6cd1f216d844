// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>

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
                                 const ElementDeviations* deviations,
                                 const DiscontinuousOptions& options) {
    engine::require_drawable(data, 2, deviations, options);
    if (!std::isfinite(scale)) {
        throw InvalidInput("the scale of the heights is not a finite number");
    }
    std::optional<ElementDeviations> own;
    if (deviations == nullptr && options.threshold > 0) deviations = &own.emplace(data);
    const engine::WidenedHierarchy<float> hierarchy(data.grid(), engine::widening(data, 0));
    const engine::Walk<double> walk(hierarchy, PieceShading::needs);
    engine::SurfacePart<3> part;
    part.surface.elements = hierarchy.make_elements();
    DiscontinuousSurface result;
    PieceShading(walk, data, deviations, options, scale, part).run(result);
    result.surface = std::move(part.surface);
    return result;
}

}  // namespace

DiscontinuousSurface shading(const DiscontinuousData& data, const ElementDeviations& deviations,
                             const DiscontinuousOptions& options) {
    return triangulate(data, 0, &deviations, options);
}
DiscontinuousSurface shading(const DiscontinuousData& data, const DiscontinuousOptions& options) {
    return triangulate(data, 0, nullptr, options);
}
DiscontinuousSurface height_field(const DiscontinuousData& data, double scale,
                                  const ElementDeviations& deviations,
                                  const DiscontinuousOptions& options) {
    return triangulate(data, scale, &deviations, options);
}
DiscontinuousSurface height_field(const DiscontinuousData& data, double scale,
                                  const DiscontinuousOptions& options) {
    return triangulate(data, scale, nullptr, options);
}

}  // namespace nestgrid
