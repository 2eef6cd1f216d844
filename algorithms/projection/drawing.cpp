// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/drawing.hpp>

#include <collapses/collapse_budget.hpp>
#include <level_sets/draw.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/error.hpp>
#include <projection/by_criterion.hpp>
#include <projection/drawn_within.hpp>

namespace nestgrid {

namespace {

/// An isosurface in space that keeps a distance, or an error; then fewer triangles, which do. The
/// isosurface of all data, from which distances are kept, is drawn once.
template <class Real>
class KeptIsosurface {
public:
    KeptIsosurface(const Hierarchy<Real>& hierarchy, double isovalue, const Criteria& criteria,
                   const IsosurfaceOptions& options, const Work& work)
        : hierarchy_{hierarchy},
          isovalue_{isovalue},
          criteria_{criteria},
          options_{options},
          work_{work} {}

    /// The threshold that the projection gives, or the one with its number of triangles.
    TriangleBudget find() {
        const Projection& projection = criteria_.projection();
        return engine::threshold_of(projection, work_, [&] {
            const auto search = [&](const auto& function) {
                return function(engine::criteria_at(criteria_), bounds(), projection.max_triangles,
                                options_, work_.executor);
            };
            if (!projection.collapse) {
                return search([&](const auto&... how) {
                    return engine::find_threshold<3>(
                        hierarchy_, std::span<const double>(&isovalue_, 1), how...);
                });
            }
            if (!projection.keeps_distance) {
                return search([&](const auto&... how) {
                    return engine::find_collapse_error(hierarchy_, isovalue_, how...);
                });
            }
            return search([&](const auto&... how) {
                return engine::find_collapse_distance(hierarchy_, isovalue_, whole().surface,
                                                      how...);
            });
        });
    }
    /// \param kept the error, or the distance
    Projected<Isosurface<3>> draw(double kept) {
        work_.begin("drawing");
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
                                                    bounds(), options_, work_.executor);
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
        return engine::isosurface<3>(hierarchy_, isovalue_, criterion, bounds(), options,
                                     work_.executor);
    }
    void collapse_into(Projected<Isosurface<3>>& drawn, const CollapseOptions& kept) const {
        work_.begin("collapsing");
        drawn.collapsed =
            collapse(drawn.surface, hierarchy_, isovalue_, bounds(), kept, work_.executor);
        drawn.collapsed->hand_to(drawn, drawn.surface_error);
    }

    const Hierarchy<Real>& hierarchy_;
    double isovalue_;
    const Criteria& criteria_;
    const IsosurfaceOptions& options_;
    const Work& work_;
    std::optional<Isosurface<3>> whole_;
};

void check_isosurface(const Projection& projection, const IsosurfaceOptions& options,
                      int dimension) {
    engine::refuse_slice_distance(projection);
    engine::refuse_tolerance(projection);
    if (dimension == 2) {
        engine::refuse_collapse(projection, "isolines");
        engine::refuse_distance(projection);
    }
    if (!projection.collapse) return;
    if (options.cap) throw InvalidInput("edges of surfaces with caps are not collapsed");
    if (options.at_nodes) {
        throw InvalidInput("edges of surfaces with vertices at nodes are not collapsed");
    }
}

/// Counts the simplices of level sets of polynomials. The arguments are borrowed.
template <int dimension>
engine::CountWithin counting(std::span<const double> isovalues, const IsosurfaceOptions& options,
                             const Work& work) {
    return [isovalues, &options, &work](const VirtualRefinement& fine, std::uint64_t most) {
        const auto levels = engine::isosurface_levels<double>(fine, isovalues);
        return engine::count_simplices<dimension>(levels, fine.criterion(), fine.bounds(), most,
                                                  options, work.executor);
    };
}

/// Draws level sets of one walk, perhaps within a number of triangles (segments) of all together.
/// \param dimension of the grid
/// \param parts of polynomials that are drawn
/// \param draw draw(hierarchy, criterion, bounds)
template <class Result, int dimension, class Draw>
Projected<Result> draw_together(const Prerolls& prerolls, std::span<const double> isovalues,
                                const engine::DrawnParts& parts, const Projection& projection,
                                const IsosurfaceOptions& options, const Work& work,
                                const Draw& draw) {
    const auto within = [&](const VirtualRefinement& fine) {
        return draw(fine, fine.criterion(), fine.bounds());
    };
    const auto count = counting<dimension>(isovalues, options, work);
    if (auto drawn = engine::within_error<Result>(prerolls, projection, work, dimension, within,
                                                  count, parts)) {
        return *std::move(drawn);
    }
    return engine::with_field(prerolls, work, dimension, [&](const auto& hierarchy) {
        const Criteria criteria(prerolls, engine::told(projection), isovalues, work);
        const Bounds& bounds = criteria.bounds();
        const TriangleBudget search = engine::threshold_of(projection, work, [&] {
            return engine::find_threshold<dimension>(
                hierarchy, isovalues, engine::criteria_at(criteria), bounds,
                projection.max_triangles, options, work.executor);
        });
        work.begin("drawing");
        return Projected<Result>{draw(hierarchy, criteria.at(search.threshold), bounds), search};
    });
}

}  // namespace

double default_error(const HighOrder& data) {
    const double range = engine::range_of(data);
    return range > 0 ? 1e-3 * range : 1;
}

Projection with_error(const Prerolls& prerolls, Projection projection, const Work& work) {
    if (projection.has_criterion()) return projection;
    const std::shared_ptr<const HighOrder> data = prerolls.high_order(work);
    if (data == nullptr) return projection;
    if (projection.draws_everything()) {
        projection.indicator = "error";
        projection.threshold = default_error(*data);
    } else if (projection.indicator == "offset" && !projection.threshold) {
        projection.indicator = "error";  // within a number of triangles, or by a lens alone
    }
    projection.require_error_alone(data->greatest_degree());
    return projection;
}

template <int dimension>
Projected<Isosurface<dimension>> isosurface(const Prerolls& prerolls, double isovalue,
                                            const Projection& projection,
                                            const IsosurfaceOptions& options, const Work& work) {
    engine::check_first(prerolls, projection, work, "isosurfaces",
                        [&] { check_isosurface(projection, options, dimension); });
    const std::span<const double> isovalues(&isovalue, 1);
    const engine::DrawnParts parts = engine::isosurfaces_at(isovalues, options.cap);
    const auto once = [&](const auto& hierarchy, const Criterion& criterion, const Bounds& bounds) {
        return engine::isosurface<dimension>(hierarchy, isovalue, criterion, bounds, options,
                                             work.executor);
    };
    if constexpr (dimension == 2) {
        return draw_together<Isosurface<2>, 2>(prerolls, isovalues, parts, projection, options,
                                               work, once);
    } else {
        const auto within = [&](const VirtualRefinement& fine) {
            return once(fine, fine.criterion(), fine.bounds());
        };
        const auto collapse_edges = [&](Projected<Isosurface<3>>& drawn,
                                        const VirtualRefinement& fine, double error) {
            const Hierarchy<double>& hierarchy = fine;
            drawn.collapsed = collapse(drawn.surface, hierarchy, isovalue, fine.bounds(),
                                       {.error = error}, work.executor);
            drawn.collapsed->hand_to(drawn, drawn.surface_error);
        };
        if (auto drawn = engine::collapsed_within_error<Isosurface<3>>(
                prerolls, projection, work, 3,
                [&](const VirtualRefinement& fine, double) { return within(fine); },
                collapse_edges)) {
            return *std::move(drawn);
        }
        if (auto drawn =
                engine::within_error<Isosurface<3>>(prerolls, projection, work, 3, within,
                                                    counting<3>(isovalues, options, work), parts)) {
            return *std::move(drawn);
        }
        return engine::with_field(prerolls, work, 3, [&](const auto& hierarchy) {
            const Criteria criteria(prerolls, engine::told(projection), isovalues, work);
            KeptIsosurface surface(hierarchy, isovalue, criteria, options, work);
            const TriangleBudget search = surface.find();
            Projected<Isosurface<3>> drawn = surface.draw(search.threshold);
            drawn.search = search;
            return drawn;
        });
    }
}
template Projected<Isosurface<2>> isosurface<2>(const Prerolls&, double, const Projection&,
                                                const IsosurfaceOptions&, const Work&);
template Projected<Isosurface<3>> isosurface<3>(const Prerolls&, double, const Projection&,
                                                const IsosurfaceOptions&, const Work&);

template <int dimension>
std::vector<Isosurface<dimension>> detail::draw_isosurfaces(
    const Prerolls& prerolls, std::span<const double> isovalues,
    const SurfaceTargets<dimension>& targets, const Projection& projection,
    const IsosurfaceOptions& options, const Work& work) {
    engine::check_one_walk(prerolls, projection, work, "several isosurfaces");
    return engine::draw_once(
        prerolls, projection, isovalues, work, dimension,
        [&](const auto& hierarchy, const Criterion& criterion, const Bounds& bounds) {
            return engine::isosurfaces<dimension>(hierarchy, isovalues, targets, criterion, bounds,
                                                  options, work.executor);
        },
        engine::isosurfaces_at(isovalues, options.cap));
}
template std::vector<Isosurface<2>> detail::draw_isosurfaces(const Prerolls&,
                                                             std::span<const double>,
                                                             const SurfaceTargets<2>&,
                                                             const Projection&,
                                                             const IsosurfaceOptions&, const Work&);
template std::vector<Isosurface<3>> detail::draw_isosurfaces(const Prerolls&,
                                                             std::span<const double>,
                                                             const SurfaceTargets<3>&,
                                                             const Projection&,
                                                             const IsosurfaceOptions&, const Work&);

template <int dimension>
Projected<Isosurface<dimension>> isoband(const Prerolls& prerolls, double low, double high,
                                         const Projection& projection,
                                         const IsosurfaceOptions& options, const Work& work) {
    engine::check_first(prerolls, projection, work, "bands", [&] {
        engine::refuse_all_but_budgets(projection, "bands");
        engine::require_band(low, high, options);
    });
    const std::array isovalues{low, high};
    engine::DrawnParts parts;
    parts.values.emplace(1, isovalues);
    return draw_together<Isosurface<dimension>, dimension>(
        prerolls, isovalues, parts, projection, options, work,
        [&](const auto& hierarchy, const Criterion& criterion, const Bounds& bounds) {
            return engine::isoband<dimension>(hierarchy, low, high, criterion, bounds, options,
                                              work.executor);
        });
}
template Projected<Isosurface<2>> isoband<2>(const Prerolls&, double, double, const Projection&,
                                             const IsosurfaceOptions&, const Work&);
template Projected<Isosurface<3>> isoband<3>(const Prerolls&, double, double, const Projection&,
                                             const IsosurfaceOptions&, const Work&);

Projected<Isolines> isolines(const Prerolls& prerolls, std::span<const double> values,
                             const Projection& projection, const IsosurfaceOptions& options,
                             const Work& work) {
    engine::check_first(prerolls, projection, work, "isolines",
                        [&] { engine::refuse_all_but_budgets(projection, "isolines"); });
    return draw_together<Isolines, 2>(
        prerolls, values, engine::isosurfaces_at(values, false), projection, options, work,
        [&](const auto& hierarchy, const Criterion& criterion, const Bounds& bounds) {
            return engine::isolines(hierarchy, values, criterion, bounds, options, work.executor);
        });
}

ProbeResult probe(const Prerolls& prerolls, std::span<const Point> points,
                  const Projection& projection, const Work& work) {
    engine::check_first(prerolls, projection, work, "a probe", [&] {
        engine::refuse_collapse(projection, "no surface");
        engine::refuse_budget(projection, "a probe, which draws none");
        engine::refuse_distance(projection);
        engine::refuse_tolerance(projection);
    });
    const auto within = [&](const VirtualRefinement& fine) {
        return engine::probe(fine, points, fine.criterion(), fine.bounds());
    };
    if (auto found = engine::from_polynomials(prerolls, projection, work, within)) {
        return *std::move(found);
    }
    const FieldOnGrid field = work.on(prerolls.field());
    return field.visit([&](const auto& hierarchy) {
        if (projection.draws_everything()) return engine::probe(hierarchy, points);
        const Criteria criteria(prerolls, engine::told(projection), {}, work);
        return engine::probe(hierarchy, points, criteria.criterion(), criteria.bounds());
    });
}

}  // namespace nestgrid
