// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurface_series.hpp>

#include <level_sets/draw.hpp>

namespace nestgrid::detail {

namespace {

template <int dimension, class Real>
class Series final : public SeriesState<dimension> {
    using Drawing = engine::LevelSet<dimension, Real>;

public:
    Series(std::unique_ptr<const Hierarchy<Real>> hierarchy, const HierarchicalIndicator& indicator)
        : hierarchy_{std::move(hierarchy)},
          criterion_{&indicator, 0},
          walk_{*hierarchy_, Drawing::needs, indicator.hanging()} {
        levels_.hierarchy = hierarchy_.get();
        result_.surface.elements = hierarchy_->make_elements();
    }

    const Isosurface<dimension>& draw(const HierarchicalIndicator& indicator, double isovalue,
                                      const Projection& projection,
                                      const IsosurfaceOptions& options,
                                      const Executor& executor) override {
        const engine::SharedNodes* const shared = hierarchy_->facts().shared;
        engine::together(shared, "a series of isosurfaces", [&] {
            if (projection.has_criterion() || !projection.asks_for_offsets()) {
                throw InvalidInput(
                    "a series draws offsets within a threshold or a number of triangles only");
            }
            engine::require_same_epoch(*hierarchy_, indicator);
            engine::set_isovalues(levels_, std::span<const double>(&isovalue, 1));
        });
        criterion_ =
            engine::criterion_for<dimension>(levels_, indicator, projection, options, executor);
        engine::together(
            shared, [&] { return engine::asked_for(levels_, criterion_, options); },
            [&] {
                engine::require_drawable<dimension>(*hierarchy_, criterion_, indicator, options);
            });
        search_.emplace(walk_, levels_.levels, criterion_, indicator);
        options_ = options;
        result_.surface.clear();
        const typename Drawing::Builder builder(result_.surface, options.elements);
        const std::span builders(&builder, 1);
        if (drawing_) {
            drawing_->begin(*search_, builders);
        } else {
            drawing_ = std::make_unique<Drawing>(walk_, *search_, builders, options_,
                                                 levels_.first_attribute);
        }
        result_.cancelled = engine::run_until_cancelled<Real>(*drawing_, executor, shared);
        drawing_->report(0, result_);
        return result_;
    }

private:
    std::unique_ptr<const Hierarchy<Real>> hierarchy_;
    Threshold criterion_;
    IsosurfaceOptions options_;
    engine::Walk<Real> walk_;
    engine::Levels<Real> levels_{};
    std::optional<engine::LevelSearch<Real>> search_;
    std::unique_ptr<Drawing> drawing_;
    Isosurface<dimension> result_;
};

}  // namespace

template <int dimension>
std::unique_ptr<SeriesState<dimension>> make_series(
    std::unique_ptr<const Hierarchy<float>> hierarchy, const HierarchicalIndicator& indicator) {
    return std::make_unique<Series<dimension, float>>(std::move(hierarchy), indicator);
}
template <int dimension>
std::unique_ptr<SeriesState<dimension>> make_series(
    std::unique_ptr<const Hierarchy<double>> hierarchy, const HierarchicalIndicator& indicator) {
    return std::make_unique<Series<dimension, double>>(std::move(hierarchy), indicator);
}

template std::unique_ptr<SeriesState<2>> make_series<2>(std::unique_ptr<const Hierarchy<float>>,
                                                        const HierarchicalIndicator&);
template std::unique_ptr<SeriesState<3>> make_series<3>(std::unique_ptr<const Hierarchy<float>>,
                                                        const HierarchicalIndicator&);
template std::unique_ptr<SeriesState<2>> make_series<2>(std::unique_ptr<const Hierarchy<double>>,
                                                        const HierarchicalIndicator&);
template std::unique_ptr<SeriesState<3>> make_series<3>(std::unique_ptr<const Hierarchy<double>>,
                                                        const HierarchicalIndicator&);

}  // namespace nestgrid::detail
