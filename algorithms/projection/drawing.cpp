// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/drawing.hpp>

#include <algorithm>
#include <limits>

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/collapse_budget.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

/// The part of an error that colours have before edges are collapsed.
constexpr double colour_start = 0.5;

void refuse_collapse(const Projection& projection, const char* drawing) {
    if (projection.collapse) {
        throw InvalidInput(std::string("edges of ") + drawing + " are not collapsed");
    }
}
void refuse_budget(const Projection& projection, const char* drawing) {
    if (projection.max_triangles > 0) {
        throw InvalidInput(std::string("no threshold is searched for a number of triangles of ") +
                           drawing);
    }
}
void refuse_distance(const Projection& projection) {
    if (projection.keeps_distance) {
        throw InvalidInput("distances are kept by isosurfaces in space only");
    }
}
void refuse_tolerance(const Projection& projection) {
    if (projection.colour_tolerance > 0) {
        throw InvalidInput(
            "triangles are split for their colours on slices, boundaries and shadings only");
    }
}
void refuse_slice_distance(const Projection& projection) {
    if (projection.slice_distance > 0) {
        throw InvalidInput("the distance of a slice without a cap is asked for, but none is drawn");
    }
}

/// Refuses what needs a drawing of its own, or several.
void check_one_walk(const Projection& projection, const char* drawing) {
    refuse_collapse(projection, drawing);
    refuse_budget(projection, drawing);
    refuse_distance(projection);
    refuse_slice_distance(projection);
    refuse_tolerance(projection);
}

/// Calls function(hierarchy), if that has the dimension, with the field as the work asks it.
template <class Function>
auto with_field(Prerolls& prerolls, const Work& work, int dimension, const Function& function) {
    const FieldOnGrid field = work.on(prerolls.field());
    field.facts().require_dimension(dimension);
    return field.visit(function);
}

/// The projection with its threshold, where it draws everything by saying nothing.
Projection told(Projection projection) {
    projection.check();
    if (projection.draws_everything()) projection.threshold = 0;
    return projection;
}

/// The polynomials of a field that the projection asks for within an error; or null.
std::shared_ptr<const HighOrder> polynomials_for(Prerolls& prerolls, const Projection& projection,
                                                 const Work& work) {
    const bool exactly = projection.least_threshold() == 0 && projection.max_triangles == 0;
    if (!projection.asks_for_error() || exactly) return nullptr;
    auto data = prerolls.high_order(work);
    if (data != nullptr) projection.require_error_alone(data->greatest_degree());
    return data;
}

/// Draws a field of higher degree within the error that the projection asks for; nothing where it
/// asks for none, or where all degrees are 1.
/// \param draw called with the VirtualRefinement
template <class Result, class Draw>
std::optional<Projected<Result>> within_error(Prerolls& prerolls, const Projection& projection,
                                              const Work& work, int dimension, const Draw& draw) {
    const std::shared_ptr<const HighOrder> data = polynomials_for(prerolls, projection, work);
    if (data == nullptr) return std::nullopt;
    prerolls.field().facts().require_dimension(dimension);
    const VirtualRefinement fine(*data, {.tolerance = projection.least_threshold()});
    return Projected<Result>{draw(fine), {.threshold = projection.least_threshold()}};
}

auto criteria_at(const Criteria& criteria) {
    return [&criteria](double threshold) { return criteria.at(threshold); };
}

/// The threshold that the projection gives, or the one that find() finds for its number.
template <class Find>
TriangleBudget threshold_of(const Projection& projection, const Find& find) {
    if (projection.max_triangles > 0) return find();
    return {.threshold = projection.least_threshold()};
}

/// An isosurface in space that keeps a distance, or an error; then fewer triangles, which do. The
/// isosurface of all data, from which distances are kept, is drawn once.
template <class Real>
class KeptIsosurface {
public:
    KeptIsosurface(const Hierarchy<Real>& hierarchy, double isovalue, const Criteria& criteria,
                   const IsosurfaceOptions& options, const Executor& executor)
        : hierarchy_{hierarchy},
          isovalue_{isovalue},
          criteria_{criteria},
          options_{options},
          executor_{executor} {}

    /// The threshold that the projection gives, or the one with its number of triangles.
    TriangleBudget find() {
        const Projection& projection = criteria_.projection();
        return threshold_of(projection, [&] {
            const auto search = [&](const auto& function) {
                return function(criteria_at(criteria_), bounds(), projection.max_triangles,
                                options_, executor_);
            };
            if (!projection.collapse) {
                return search([&](const auto&... how) {
                    return find_threshold<3>(hierarchy_, isovalue_, how...);
                });
            }
            if (!projection.keeps_distance) {
                return search([&](const auto&... how) {
                    return find_collapse_error(hierarchy_, isovalue_, how...);
                });
            }
            return search([&](const auto&... how) {
                return find_collapse_distance(hierarchy_, isovalue_, whole().surface, how...);
            });
        });
    }
    /// \param kept the error, or the distance
    Projected<Isosurface<3>> draw(double kept) {
        const Projection& projection = criteria_.projection();
        const bool collapses = projection.collapse && kept > 0;
        const double part = projection.keeps_distance ? 0.5 : collapse_start;
        const double first = collapses ? part * kept : kept;
        const AnyCriterion criterion = criteria_.at(first);
        Projected<Isosurface<3>> drawn;
        if (!projection.keeps_distance || kept == 0) {
            as_isosurface(drawn) = by(criterion, options_);
            if (collapses && !drawn.cancelled) collapse_into(drawn, {.error = kept});
            return drawn;
        }
        if (whole().cancelled) {
            as_isosurface(drawn) = whole();
            return drawn;
        }
        const Surface<3>& all = whole().surface;
        IsosurfaceWithin within = isosurface_within(hierarchy_, isovalue_, {all, first}, criterion,
                                                    bounds(), options_, executor_);
        as_isosurface(drawn) = std::move(within.isosurface);
        drawn.far_points = within.points;
        if (collapses && !drawn.cancelled) {
            CollapseOptions near;
            near.nearness.emplace(Nearness{all, kept});
            collapse_into(drawn, near);
        }
        return drawn;
    }

private:
    static Isosurface<3>& as_isosurface(Projected<Isosurface<3>>& drawn) { return drawn; }
    const Bounds& bounds() const { return criteria_.bounds(); }

    /// The isosurface of all data.
    const Isosurface<3>& whole() {
        if (!whole_) {
            whole_ = by(
                Exact{},
                {.elements = false, .at_nodes = options_.at_nodes, .progress = options_.progress});
        }
        return *whole_;
    }
    Isosurface<3> by(const Criterion& criterion, const IsosurfaceOptions& options) const {
        return isosurface<3>(hierarchy_, isovalue_, criterion, bounds(), options, executor_);
    }
    void collapse_into(Projected<Isosurface<3>>& drawn, const CollapseOptions& kept) const {
        drawn.collapsed = collapse(drawn.surface, hierarchy_, isovalue_, bounds(), kept, executor_);
        drawn.collapsed->hand_to(drawn, drawn.surface_error);
    }

    const Hierarchy<Real>& hierarchy_;
    double isovalue_;
    const Criteria& criteria_;
    const IsosurfaceOptions& options_;
    const Executor& executor_;
    std::optional<Isosurface<3>> whole_;
};

void check_isosurface(const Projection& projection, const IsosurfaceOptions& options,
                      int dimension) {
    refuse_slice_distance(projection);
    refuse_tolerance(projection);
    if (dimension == 2) {
        refuse_collapse(projection, "isolines");
        refuse_distance(projection);
    }
    if (!projection.collapse) return;
    if (options.cap) throw InvalidInput("edges of surfaces with caps are not collapsed");
    if (options.at_nodes) {
        throw InvalidInput("edges of surfaces with vertices at nodes are not collapsed");
    }
}

/// Collapses edges while the colours of a surface keep an error.
template <class Real, class Result>
void collapse_colours_of(Projected<Result>& drawn, const Hierarchy<Real>& hierarchy,
                         const Bounds& bounds, const ColourCollapseOptions& options,
                         double& surface_error, const Executor& executor) {
    drawn.collapsed = collapse_colours(drawn.surface, hierarchy, bounds, options, executor);
    drawn.collapsed->hand_to(drawn, surface_error);
}

/// Draws within the threshold that the projection gives, or the least one with its number of
/// triangles.
/// \param within within(threshold, drawn) draws, and collapses where the projection says so; it
///        sets `drawn` to the triangles that there were before
/// \param find finds the threshold where nothing is collapsed
template <class Within, class Find>
auto draw_within(const Criteria& criteria, const Within& within, const Find& find) {
    const Projection& projection = criteria.projection();
    const TriangleBudget search = threshold_of(projection, [&] {
        if (!projection.collapse) return find();
        const TryCollapse attempt = [&](double error) -> std::optional<CollapseTrial> {
            CollapseTrial trial;
            const auto drawn = within(error, trial.drawn);
            if (drawn.cancelled) return std::nullopt;
            trial.left = drawn.surface.simplices.size();
            return trial;
        };
        const double range = criteria.bounds().greatest() - criteria.bounds().least();
        return find_collapse_error(attempt, range, projection.max_triangles);
    });
    std::uint64_t begun = 0;
    auto drawn = within(search.threshold, begun);
    drawn.search = search;
    return drawn;
}

template <class Real>
Projected<Slice> draw_slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                            const Criteria& criteria, const IsosurfaceOptions& options,
                            const Executor& executor) {
    const Projection& projection = criteria.projection();
    const Bounds& bounds = criteria.bounds();
    const auto within = [&](double error, std::uint64_t& begun) {
        const bool collapses = projection.collapse && error > 0;
        const double first = collapses ? colour_start * error : error;
        // Only a slice of all data is as near to its function as the grid allows.
        const bool moves = collapses && projection.slice_distance > 0;
        const AnyCriterion criterion = moves ? AnyCriterion(Exact{}) : criteria.at(first);
        Projected<Slice> drawn{slice(hierarchy, function, criterion, bounds, options, executor)};
        begun = drawn.surface.simplices.size();
        if (drawn.cancelled) return drawn;
        const double tolerance = collapses ? first : projection.colour_tolerance;
        if (tolerance > 0) refine_colours(drawn.surface, hierarchy, tolerance, criterion, bounds);
        if (!collapses) return drawn;
        ColourCollapseOptions kept{.errors = {error}};
        Surface<3> whole;
        if (moves) {
            whole = drawn.surface;
            kept.nearness.emplace(Nearness{whole, projection.slice_distance});
        }
        collapse_colours_of(drawn, hierarchy, bounds, kept, drawn.surface_error, executor);
        return drawn;
    };
    return draw_within(criteria, within, [&] {
        return find_threshold(hierarchy, function, criteria_at(criteria), bounds,
                              projection.max_triangles, options, executor);
    });
}

/// \param scale nothing: in the plane
template <class Real>
Projected<Shading> draw_shading(const Hierarchy<Real>& hierarchy, std::optional<double> scale,
                                const Criteria& criteria, const ShadingOptions& options,
                                const Executor& executor) {
    const Projection& projection = criteria.projection();
    const Bounds& bounds = criteria.bounds();
    const auto within = [&](double error, std::uint64_t& begun) {
        const bool collapses = projection.collapse && error > 0;
        const double first = collapses ? colour_start * error : error;
        ShadingOptions flat = options;
        if (collapses) flat.flatness = std::min(flat.flatness, first);
        const AnyCriterion s = criteria.at(first);
        Projected<Shading> drawn{scale ? height_field(hierarchy, *scale, s, bounds, flat, executor)
                                       : shading(hierarchy, s, bounds, flat, executor)};
        begun = drawn.surface.simplices.size();
        if (drawn.cancelled) return drawn;
        if (projection.colour_tolerance > 0) {
            refine_colours(drawn.surface, hierarchy, projection.colour_tolerance, s, bounds);
        }
        if (!collapses) return drawn;
        double no_surface_error = 0;
        collapse_colours_of(drawn, hierarchy, bounds,
                            {.errors = {error}, .scale = scale.value_or(0)}, no_surface_error,
                            executor);
        return drawn;
    };
    return draw_within(criteria, within, [&] {
        return find_shading_threshold(hierarchy, criteria_at(criteria), bounds,
                                      projection.max_triangles, options, executor);
    });
}

Projected<Shading> shaded(Prerolls& prerolls, std::optional<double> scale,
                          const Projection& projection, const ShadingOptions& options,
                          const Work& work) {
    refuse_distance(projection);
    refuse_slice_distance(projection);
    if (scale) refuse_tolerance(projection);
    const auto within = [&](const VirtualRefinement& fine) {
        return scale ? height_field(fine, *scale, fine.criterion(), fine.bounds(), options,
                                    work.executor)
                     : shading(fine, fine.criterion(), fine.bounds(), options, work.executor);
    };
    if (auto drawn = within_error<Shading>(prerolls, projection, work, 2, within)) {
        return *std::move(drawn);
    }
    return with_field(prerolls, work, 2, [&](const auto& hierarchy) {
        const Criteria criteria(prerolls, told(projection), {}, work);
        return draw_shading(hierarchy, scale, criteria, options, work.executor);
    });
}

}  // namespace

double default_error(const HighOrder& data) {
    // Bounds are the same at any tolerance.
    const VirtualRefinement coarsest(data, {.tolerance = std::numeric_limits<double>::max()});
    const double range = coarsest.bounds().greatest() - coarsest.bounds().least();
    return range > 0 ? 1e-3 * range : 1;
}

Projection with_error(Prerolls& prerolls, Projection projection, const Work& work) {
    const std::shared_ptr<const HighOrder> data = prerolls.high_order(work);
    if (data == nullptr) return projection;
    if (projection.draws_everything()) {
        projection.indicator = "error";
        projection.threshold = default_error(*data);
    }
    projection.require_error_alone(data->greatest_degree());
    return projection;
}

template <int dimension>
Projected<Isosurface<dimension>> isosurface(Prerolls& prerolls, double isovalue,
                                            const Projection& projection,
                                            const IsosurfaceOptions& options, const Work& work) {
    check_isosurface(projection, options, dimension);
    const auto within = [&](const VirtualRefinement& fine) {
        return isosurface<dimension>(fine, isovalue, fine.criterion(), fine.bounds(), options,
                                     work.executor);
    };
    if (auto drawn =
            within_error<Isosurface<dimension>>(prerolls, projection, work, dimension, within)) {
        return *std::move(drawn);
    }
    return with_field(prerolls, work, dimension, [&](const auto& hierarchy) {
        const Executor& executor = work.executor;
        const Criteria criteria(prerolls, told(projection), std::span(&isovalue, 1), work);
        Projected<Isosurface<dimension>> drawn;
        if constexpr (dimension == 3) {
            KeptIsosurface surface(hierarchy, isovalue, criteria, options, executor);
            const TriangleBudget search = surface.find();
            drawn = surface.draw(search.threshold);
            drawn.search = search;
        } else {
            drawn.search = threshold_of(projection, [&] {
                return find_threshold<2>(hierarchy, isovalue, criteria_at(criteria),
                                         criteria.bounds(), projection.max_triangles, options,
                                         executor);
            });
            static_cast<Isosurface<2>&>(drawn) =
                isosurface<2>(hierarchy, isovalue, criteria.at(drawn.search.threshold),
                              criteria.bounds(), options, executor);
        }
        return drawn;
    });
}
template Projected<Isosurface<2>> isosurface<2>(Prerolls&, double, const Projection&,
                                                const IsosurfaceOptions&, const Work&);
template Projected<Isosurface<3>> isosurface<3>(Prerolls&, double, const Projection&,
                                                const IsosurfaceOptions&, const Work&);

template <int dimension>
std::vector<Isosurface<dimension>> isosurfaces(Prerolls& prerolls,
                                               std::span<const double> isovalues,
                                               const Projection& projection,
                                               const IsosurfaceOptions& options, const Work& work) {
    check_one_walk(projection, "several isosurfaces");
    if (const auto data = polynomials_for(prerolls, projection, work)) {
        prerolls.field().facts().require_dimension(dimension);
        const VirtualRefinement fine(*data, {.tolerance = projection.least_threshold()});
        return isosurfaces<dimension>(fine, isovalues, fine.criterion(), fine.bounds(), options,
                                      work.executor);
    }
    return with_field(prerolls, work, dimension, [&](const auto& hierarchy) {
        const Criteria criteria(prerolls, told(projection), isovalues, work);
        return isosurfaces<dimension>(hierarchy, isovalues, criteria.criterion(), criteria.bounds(),
                                      options, work.executor);
    });
}
template std::vector<Isosurface<2>> isosurfaces<2>(Prerolls&, std::span<const double>,
                                                   const Projection&, const IsosurfaceOptions&,
                                                   const Work&);
template std::vector<Isosurface<3>> isosurfaces<3>(Prerolls&, std::span<const double>,
                                                   const Projection&, const IsosurfaceOptions&,
                                                   const Work&);

MeasuredError measure_error(Prerolls& prerolls, const Surface<3>& drawn, double isovalue,
                            std::size_t points, const Work& work) {
    const std::shared_ptr<const Bounds> bounds = prerolls.finest(work).bounds;
    return with_field(prerolls, work, 3, [&](const auto& hierarchy) {
        const Surface<3> whole =
            isosurface<3>(hierarchy, isovalue, Exact{}, *bounds, {.elements = false}, work.executor)
                .surface;
        return measure_error(drawn, whole, hierarchy, isovalue, points, work.executor);
    });
}

Projected<Slice> slice(Prerolls& prerolls, const LevelFunction& function,
                       const Projection& projection, const IsosurfaceOptions& options,
                       const Work& work) {
    projection.check();
    refuse_distance(projection);
    if (options.cap) refuse_slice_distance(projection);
    const auto within = [&](const VirtualRefinement& fine) {
        return slice(fine, function, fine.criterion(), fine.bounds(), options, work.executor);
    };
    if (auto drawn = within_error<Slice>(prerolls, projection, work, 3, within)) {
        return *std::move(drawn);
    }
    return with_field(prerolls, work, 3, [&](const auto& hierarchy) {
        if (projection.draws_everything()) {
            IsosurfaceOptions everything = options;
            everything.threshold = 0;
            everything.max_triangles = 0;
            Projected<Slice> drawn{slice(hierarchy, function, everything, work.executor)};
            if (projection.colour_tolerance > 0 && !drawn.cancelled) {
                refine_colours(drawn.surface, hierarchy, projection.colour_tolerance);
            }
            return drawn;
        }
        const Criteria criteria(prerolls, told(projection), {}, work);
        return draw_slice(hierarchy, function, criteria, options, work.executor);
    });
}

Projected<Slice> boundary_surface(Prerolls& prerolls, const Projection& projection,
                                  const IsosurfaceOptions& options, const Work& work) {
    refuse_slice_distance(projection);
    return slice(prerolls, detail::Everywhere{}, projection, detail::capped(options), work);
}

template <int dimension>
Projected<Isosurface<dimension>> isoband(Prerolls& prerolls, double low, double high,
                                         const Projection& projection,
                                         const IsosurfaceOptions& options, const Work& work) {
    check_one_walk(projection, "bands");
    const auto within = [&](const VirtualRefinement& fine) {
        return isoband<dimension>(fine, low, high, fine.criterion(), fine.bounds(), options,
                                  work.executor);
    };
    if (auto drawn =
            within_error<Isosurface<dimension>>(prerolls, projection, work, dimension, within)) {
        return *std::move(drawn);
    }
    return with_field(prerolls, work, dimension, [&](const auto& hierarchy) {
        const std::array<double, 2> isovalues{low, high};
        const Criteria criteria(prerolls, told(projection), isovalues, work);
        return Projected<Isosurface<dimension>>{
            isoband<dimension>(hierarchy, low, high, criteria.criterion(), criteria.bounds(),
                               options, work.executor),
            {.threshold = projection.least_threshold()}};
    });
}
template Projected<Isosurface<2>> isoband<2>(Prerolls&, double, double, const Projection&,
                                             const IsosurfaceOptions&, const Work&);
template Projected<Isosurface<3>> isoband<3>(Prerolls&, double, double, const Projection&,
                                             const IsosurfaceOptions&, const Work&);

Projected<Isolines> isolines(Prerolls& prerolls, std::span<const double> values,
                             const Projection& projection, const IsosurfaceOptions& options,
                             const Work& work) {
    check_one_walk(projection, "isolines");
    const auto within = [&](const VirtualRefinement& fine) {
        return isolines(fine, values, fine.criterion(), fine.bounds(), options, work.executor);
    };
    if (auto drawn = within_error<Isolines>(prerolls, projection, work, 2, within)) {
        return *std::move(drawn);
    }
    return with_field(prerolls, work, 2, [&](const auto& hierarchy) {
        const Criteria criteria(prerolls, told(projection), values, work);
        return Projected<Isolines>{isolines(hierarchy, values, criteria.criterion(),
                                            criteria.bounds(), options, work.executor),
                                   {.threshold = projection.least_threshold()}};
    });
}

Projected<Shading> shading(Prerolls& prerolls, const Projection& projection,
                           const ShadingOptions& options, const Work& work) {
    return shaded(prerolls, std::nullopt, projection, options, work);
}

Projected<Shading> height_field(Prerolls& prerolls, double scale, const Projection& projection,
                                const ShadingOptions& options, const Work& work) {
    return shaded(prerolls, scale, projection, options, work);
}

ProbeResult probe(Prerolls& prerolls, std::span<const Point> points, const Projection& projection,
                  const Work& work) {
    projection.check();
    refuse_collapse(projection, "no surface");
    refuse_budget(projection, "a probe, which draws none");
    refuse_distance(projection);
    refuse_tolerance(projection);
    if (const auto data = polynomials_for(prerolls, projection, work)) {
        const VirtualRefinement fine(*data, {.tolerance = projection.least_threshold()});
        return probe(fine, points, fine.criterion(), fine.bounds());
    }
    const FieldOnGrid field = work.on(prerolls.field());
    return field.visit([&](const auto& hierarchy) {
        if (projection.draws_everything()) return probe(hierarchy, points);
        const Criteria criteria(prerolls, told(projection), {}, work);
        return probe(hierarchy, points, criteria.criterion(), criteria.bounds());
    });
}

}  // namespace nestgrid
