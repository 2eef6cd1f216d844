// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurface_series.hpp>

#include <levels/draw.hpp>
#include <levels/isosurface_visitor.hpp>

namespace nestgrid::detail {

namespace {

template <int dimension, class Real>
class Series final : public SeriesState<dimension> {
    using Visitor = engine::IsosurfaceVisitor<dimension, Real, true>;

public:
    Series(std::unique_ptr<const Hierarchy<Real>> hierarchy, const HierarchicalIndicator& indicator)
        : hierarchy_{std::move(hierarchy)},
          criterion_{&indicator, 0},
          walk_{*hierarchy_, Visitor::needs, indicator.hanging()} {
        result_.surface.elements = hierarchy_->make_elements();
    }

    const Isosurface<dimension>& draw(const HierarchicalIndicator& indicator, double isovalue,
                                      const IsosurfaceOptions& options,
                                      const Executor& executor) override {
        const std::span<const double> isovalues(&isovalue, 1);
        engine::require_drawable(*hierarchy_, isovalues, indicator);
        criterion_ = criterion_for<dimension>(*hierarchy_, isovalue, indicator, options, executor);
        options_ = options;
        result_.surface.clear();
        builders_.clear();
        builders_.emplace_back(result_.surface, options.elements);
        if (visitor_) {
            visitor_->begin_again(isovalues, builders_, criterion_);
        } else {
            visitor_ = std::make_unique<Visitor>(walk_, isovalues, builders_, criterion_, indicator,
                                                 options_);
        }
        result_.cancelled = false;
        try {
            visitor_->run(executor);
        } catch (const engine::Cancelled&) {
            result_.cancelled = true;
        }
        visitor_->report(0, result_);
        return result_;
    }

private:
    std::unique_ptr<const Hierarchy<Real>> hierarchy_;
    Threshold criterion_;
    IsosurfaceOptions options_;
    engine::Walk<Real> walk_;
    std::vector<typename Visitor::Builder> builders_;
    std::unique_ptr<Visitor> visitor_;
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
