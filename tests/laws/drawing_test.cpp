// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn under a projection as a value has the bits of its parts, and keeps what the
// projection asks for, on every family.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>

#include "families.hpp"
#include "projection_judge.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "triangle_samples.hpp"

using namespace nestgrid_test;

namespace drawing_test {

template <class Family>
class Drawing : public testing::Test {};
TYPED_TEST_SUITE(Drawing, Families);

const std::vector<Projection> projections{
    {},
    {.threshold = 0.1},
    {.threshold = 0.1, .indicator = "error"},
    {.threshold = 0.2, .blend = 1.5},
    {.lens = LensRequest{.distance = Ball{{0.3, 0.3, 0.3}, 0.2}, .finest = 0.1}},
};

/// Calls test(hierarchy, prerolls, dimension) for some fields of refined grids of a family.
template <class Family, class Test>
void for_each_drawn(unsigned seed, Test&& test) {
    for_each_field_at_sphere<Family>(2, seed, [&](const auto& grid, const auto& samples) {
        using Grid = typename Family::Grid;
        const NodeField<Grid, double> field(grid, samples.values);
        Prerolls prerolls(FieldOnGrid(grid, field));
        test(erase(grid, field), prerolls, std::integral_constant<int, Grid::dimension>{});
    });
}

TYPED_TEST(Drawing, HasTheBitsOfItsParts) {
    for_each_drawn<TypeParam>(41, [](const auto& hierarchy, Prerolls& prerolls, auto dimension) {
        for (const Projection& projection : projections) {
            const double zero = 0;
            Projection told = projection;
            if (told.draws_everything()) told.threshold = 0;
            const Criteria levels(prerolls, told, std::span(&zero, 1), {});
            const Criteria criteria(prerolls, told, {}, {});
            const AnyCriterion s = criteria.criterion();
            expect_same(
                static_cast<const Isosurface<dimension>&>(
                    isosurface<dimension>(prerolls, 0, projection)),
                isosurface<dimension>(hierarchy, 0, under(levels.criterion(), levels.bounds())));
            const std::vector<Point> points{{0.4, 0.3, dimension == 3 ? 0.6 : 0}};
            const bool everything = projection.draws_everything();
            expect_same_bits(probe(prerolls, points, projection).values,
                             everything
                                 ? probe(hierarchy, points).values
                                 : probe(hierarchy, points, under(s, criteria.bounds())).values,
                             "values at points");
            if constexpr (dimension == 3) {
                const Plane plane({0.4, 0.5, 0.5}, {1, 2, 3});
                expect_same(slice(prerolls, plane, projection).surface,
                            everything
                                ? slice(hierarchy, plane).surface
                                : slice(hierarchy, plane, under(s, criteria.bounds())).surface);
                expect_same(boundary_surface(prerolls, projection).surface,
                            everything
                                ? boundary_surface(hierarchy).surface
                                : boundary_surface(hierarchy, under(s, criteria.bounds())).surface);
            } else {
                const std::vector<double> values{0, 0.1};
                const Criteria lines(prerolls, told, values, {});
                EXPECT_EQ(isolines(prerolls, values, projection).lines.vertices,
                          isolines(hierarchy, values, under(lines.criterion(), lines.bounds()))
                              .lines.vertices);
                expect_same(height_field(prerolls, 0.5, projection).surface,
                            height_field(hierarchy, 0.5, under(s, criteria.bounds())).surface);
                expect_same(shading(prerolls, projection).surface,
                            shading(hierarchy, under(s, criteria.bounds())).surface);
            }
        }
        expect_same(
            isoband<dimension>(prerolls, 0, 0.1, {.threshold = 0.1}).surface,
            isoband<dimension>(hierarchy, 0.0, 0.1,
                               under(Criteria(prerolls, {.threshold = 0.1}, {}, {}).criterion(),
                                     *prerolls.bounds({})))
                .surface);
    });
}

/// Draws within half the number of all simplices, where the coarsest drawing has no more.
/// \param draw draw(projection)
/// \param count count(drawn)
template <class Draw, class Count>
void expect_within_half(const Draw& draw, const Count& count) {
    const std::size_t most =
        std::max(count(draw({.threshold = 0})) / 2, count(draw({.threshold = 1e9})));
    if (most == 0) return;
    const auto drawn = draw({.max_triangles = most});
    EXPECT_LE(count(drawn), most);
    EXPECT_EQ(count(drawn), drawn.search.triangles);
    // Without a search, threshold 0 stops nowhere: also not where nothing is left out.
    if (drawn.search.threshold > 0) {
        EXPECT_EQ(count(drawn), count(draw({.threshold = drawn.search.threshold})));
    }
    if (drawn.search.end() != BudgetEnd::step) return;
    EXPECT_GT(count(draw({.threshold = drawn.search.next_threshold})), most);
}

/// A number of triangles is one of all levels together.
TYPED_TEST(Drawing, KeepsOneNumberOfSeveralLevels) {
    for_each_drawn<TypeParam>(47, [](const auto&, Prerolls& prerolls, auto dimension) {
        expect_within_half(
            [&](const Projection& projection) {
                return isoband<dimension>(prerolls, -0.1, 0.1, projection);
            },
            [](const auto& band) { return band.surface.simplices.size(); });
        if constexpr (dimension == 2) {
            const std::vector<double> values{-0.2, 0, 0.1};
            expect_within_half(
                [&](const Projection& projection) {
                    return isolines(prerolls, values, projection);
                },
                [](const auto& drawn) {
                    std::size_t segments = 0;
                    for (std::size_t i = 0; i < drawn.lines.count(); ++i) {
                        segments += drawn.lines.line(i).size() - 1;
                    }
                    return segments;
                });
        }
    });
}

TYPED_TEST(Drawing, IsFineInARegion) {
    const Ball ball{{0.4, 0.4, 0.4}, 0.2};
    const double zero = 0;
    for_each_drawn<TypeParam>(45, [&](const auto& hierarchy, Prerolls& prerolls, auto dimension) {
        const Projection projection{.threshold = 0.4, .region = RegionRequest{ball, 0.01}};
        const Region region(hierarchy, [&](const Point& x) { return ball(x) <= 0; });
        const ChosenIndicator offsets = prerolls.choose("offset", 1, {}, {});
        const auto s = fine_inside(region, *offsets.indicator, 0.4, 0.01);
        const Isosurface<dimension> expected =
            isosurface<dimension>(hierarchy, 0, under(s, *offsets.bounds));
        expect_same(static_cast<const Isosurface<dimension>&>(
                        isosurface<dimension>(prerolls, 0, projection)),
                    expected);
        expect_same(
            isosurfaces<dimension>(prerolls, std::span(&zero, 1), projection).front().surface,
            expected.surface);
    });
}

TYPED_TEST(Drawing, LetsColoursFollowTheData) {
    std::size_t split = 0;
    bool simplices = false;
    for_each_drawn<TypeParam>(46, [&](const auto& hierarchy, Prerolls& prerolls, auto dimension) {
        simplices = detail::cuts_are_errors(hierarchy.facts());  // whose colours are exact
        for (const double threshold : {0.0, 0.1}) {
            const Projection plain{.threshold = threshold};
            Projection followed = plain;
            followed.colour_tolerance = 0.01;
            const Criteria criteria(prerolls, plain, {}, {});
            const auto expect_followed = [&](Surface<3> drawn, const Surface<3>& got) {
                split += refine_colours(drawn, hierarchy, 0.01,
                                        under(criteria.criterion(), criteria.bounds()))
                             .split;
                expect_same(got, drawn);
            };
            if constexpr (dimension == 3) {
                const Plane plane({0.4, 0.5, 0.5}, {1, 2, 3});
                expect_followed(slice(prerolls, plane, plain).surface,
                                slice(prerolls, plane, followed).surface);
            } else {
                expect_followed(shading(prerolls, plain).surface,
                                shading(prerolls, followed).surface);
            }
        }
    });
    EXPECT_TRUE(TypeParam::Grid::dimension == 2 || (split > 0) != simplices);
}

TYPED_TEST(Drawing, MeasuresFromTheSurfaceOfAllData) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        bool first = true;
        for_each_drawn<TypeParam>(47, [&](const auto& hierarchy, Prerolls& prerolls, auto) {
            if (!std::exchange(first, false)) return;
            const Surface<3> whole = isosurface<3>(prerolls, 0, {}).surface;
            const Surface<3> drawn = isosurface<3>(prerolls, 0, {.threshold = 0.2}).surface;
            const MeasuredError expected = measure_error(hierarchy, drawn, whole, 0.0, 1000);
            const MeasuredError measured = measure_error(prerolls, drawn, 0, 1000);
            EXPECT_EQ(measured.value.greatest, expected.value.greatest);
            EXPECT_EQ(measured.distance.rms, expected.distance.rms);
            EXPECT_EQ(measured.back.greatest, expected.back.greatest);
            EXPECT_LT(measure_error(prerolls, whole, 0, 1000).distance.greatest, 1e-9);
        });
    }
}

/// The greatest |U - C| at samples of the triangles.
template <class Real>
double error_of(const Surface<3>& s, const Hierarchy<Real>& hierarchy) {
    std::vector<Point> points;
    for (std::size_t t = 0; t < s.simplices.size(); ++t) {
        const auto of = samples_of(corners_of(s, t), 3);
        points.insert(points.end(), of.begin(), of.end());
    }
    const ProbeResult probed = probe(hierarchy, points);
    double greatest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (probed.found(i)) greatest = std::max(greatest, std::abs(probed.values[i]));
    }
    return greatest;
}

TYPED_TEST(Drawing, KeepsTheErrorWithFewerTrianglesWhereEdgesAreCollapsed) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        std::size_t collapses = 0;
        for_each_drawn<TypeParam>(42, [&](const auto& hierarchy, Prerolls& prerolls, auto) {
            const Projection projection{
                .threshold = 0.2, .indicator = "deviation", .collapse = true};
            const auto drawn = isosurface<3>(prerolls, 0, projection);
            ASSERT_TRUE(drawn.collapsed);
            collapses += drawn.collapsed->collapses;
            expect_closed(drawn.surface);
            // Cuts keep a fraction of 2^-20 of their edge away from its ends.
            constexpr double cut = 1e-5;
            EXPECT_LE(error_of(drawn.surface, hierarchy), drawn.error_bound * (1 + 1e-9) + cut);
            EXPECT_LE(drawn.collapsed->error, 0.2);
        });
        EXPECT_GT(collapses, 0U);
    }
}

TYPED_TEST(Drawing, KeepsWithinANumberOfTriangles) {
    bool first = true;
    for_each_drawn<TypeParam>(43, [&](const auto&, Prerolls& prerolls, auto dimension) {
        const std::size_t full = isosurface<dimension>(prerolls, 0, {}).surface.simplices.size();
        const std::uint64_t most = full / 2 + 1;
        for (const bool collapse : {false, true}) {
            if (collapse && (dimension == 2 || !std::exchange(first, false))) continue;
            try {
                const auto drawn = isosurface<dimension>(
                    prerolls, 0,
                    {.max_triangles = most, .indicator = "error", .collapse = collapse});
                EXPECT_LE(drawn.surface.simplices.size(), most);
                EXPECT_EQ(drawn.search.max_triangles, most);
            } catch (const InvalidInput& refused) {
                EXPECT_NE(std::string(refused.what()).find("coarsest"), std::string::npos);
            }
        }
    });
}

/// The error that is told keeps the number, which is nearly used up or is exceeded at the error
/// before it.
template <class Result>
void expect_fits(const Result& drawn, std::uint64_t most) {
    EXPECT_LE(drawn.surface.simplices.size(), most);
    EXPECT_EQ(drawn.search.triangles, drawn.surface.simplices.size());
    EXPECT_EQ(drawn.search.max_triangles, most);
    const bool filled = 10 * drawn.search.triangles >= 9 * most;
    EXPECT_TRUE(filled || drawn.search.next_triangles > most);
    ASSERT_TRUE(drawn.collapsed);
    EXPECT_LE(drawn.collapsed->error, drawn.search.threshold);
}

/// A criterion in the place of a threshold, kept or borrowed.
TYPED_TEST(Drawing, TakesACriterionOfOnesOwn) {
    for_each_drawn<TypeParam>(46, [](const auto& hierarchy, Prerolls& prerolls, auto dimension) {
        const HierarchicalIndicator offsets(hierarchy);
        const Threshold threshold(&offsets, 0.1);
        const Criterion& borrowed = threshold;
        const Projection named{.threshold = 0.1};
        for (const Projection& own :
             {under(offsets, 0.1), under(threshold, offsets), under(borrowed, offsets)}) {
            expect_same(isosurface<dimension>(prerolls, 0, own).surface,
                        isosurface<dimension>(prerolls, 0, named).surface);
            if constexpr (dimension == 3) {
                const Plane plane({0.4, 0.5, 0.5}, {1, 2, 3});
                expect_same(slice(prerolls, plane, own).surface,
                            slice(prerolls, plane, named).surface);
            } else {
                expect_same(shading(prerolls, own).surface, shading(prerolls, named).surface);
            }
        }
    });
}

TYPED_TEST(Drawing, CollapsesColoursToANumberOfTriangles) {
    std::size_t fitting = 0;
    for_each_drawn<TypeParam>(44, [&](const auto&, Prerolls& prerolls, auto dimension) {
        if (fitting > 0) return;  // one field is enough
        const auto fit = [&](const auto& draw) {
            const std::uint64_t all = draw(Projection{.threshold = 0}).surface.simplices.size();
            const std::uint64_t most = all - all / 4;
            if (most == all) return;
            try {
                expect_fits(draw({.max_triangles = most, .indicator = "error", .collapse = true}),
                            most);
                ++fitting;
            } catch (const InvalidInput& refused) {
                EXPECT_NE(std::string(refused.what()).find("coarsest"), std::string::npos);
            }
        };
        if constexpr (dimension == 3) {
            const Plane plane({0.4, 0.5, 0.5}, {1, 2, 3});
            fit([&](const Projection& p) { return slice(prerolls, plane, p); });
            fit([&](const Projection& p) { return boundary_surface(prerolls, p); });
        } else {
            fit([&](const Projection& p) { return shading(prerolls, p); });
            fit([&](const Projection& p) { return height_field(prerolls, 0.5, p); });
        }
    });
    EXPECT_GT(fitting, 0U);
}

TEST(Drawing, RefusesWhatMakesNoSense) {
    const LatticeBisection<3> grid({.samples = {5, 5, 5}});
    std::vector<float> values(125);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 7);
    const LatticeField field(grid, std::span<const float>(values));
    Prerolls prerolls(FieldOnGrid(grid, field));
    const auto refused = [&](const Projection& projection, const std::string& part) {
        expect_refused([&] { isosurface<3>(prerolls, 2, projection); }, part);
    };
    refused({.collapse = true}, "neither is given");
    const HierarchicalIndicator offsets(grid, field);
    Projection by_criterion = under(offsets, 1);
    by_criterion.max_triangles = 9;
    refused(by_criterion, "by a criterion has no threshold");
    by_criterion = under(offsets, 1);
    by_criterion.threshold = 1;
    refused(by_criterion, "by a criterion has no threshold");
    by_criterion = under(offsets, 1);
    by_criterion.bounds = nullptr;
    refused(by_criterion, "needs bounds");
    refused({.bounds = &offsets}, "no other one has them");
    refused({.threshold = 1, .collapse = true, .slice_distance = 1}, "none is drawn");
    refused({.keeps_distance = true}, "no threshold that says which");
    refused({.threshold = 1,
             .lens = LensRequest{.distance = Ball{{}, 1}, .finest = 1},
             .collapse = true},
            "without a lens");
    const Projection collapsed{.threshold = 1, .collapse = true};
    expect_refused([&] { isosurface<3>(prerolls, 2, collapsed, {.cap = true}); }, "with caps");
    expect_refused([&] { isosurface<3>(prerolls, 2, collapsed, {.at_nodes = true}); }, "at nodes");
    const RegionRequest region{.distance = Ball{{2, 2, 2}, 1}};
    refused({.threshold = 1, .region = region, .collapse = true}, "without a region");
    refused({.threshold = 1, .blend = 2, .region = region}, "threshold of its own");
    refused({.threshold = 1, .region = RegionRequest{region.distance, -1}}, "in the region");
    refused({.colour_tolerance = 1}, "slices, boundaries and shadings only");
    const Plane plane({2, 2, 2}, {0, 0, 1});
    expect_refused([&] { slice(prerolls, plane, {.colour_tolerance = -1}); }, "tolerance");
    expect_refused([&] { slice(prerolls, plane, {.max_triangles = 9, .colour_tolerance = 1}); },
                   "a number of triangles");
    const std::vector<double> isovalues{1, 2};
    expect_refused([&] { isosurfaces<3>(prerolls, isovalues, {.max_triangles = 9}); }, "several");
    expect_refused([&] { slice(prerolls, plane, {.threshold = 1, .slice_distance = 1}); },
                   "whose edges are collapsed");
    expect_refused(
        [&] {
            slice(prerolls, plane, {.threshold = 1, .collapse = true, .slice_distance = 1},
                  {.cap = true});
        },
        "without a cap");
    expect_refused(
        [&] {
            boundary_surface(prerolls, {.threshold = 1, .collapse = true, .slice_distance = 1});
        },
        "without a cap");
    expect_refused([&] { slice(prerolls, plane, {.threshold = 1, .keeps_distance = true}); },
                   "isosurfaces in space");
    expect_refused([&] { isoband<3>(prerolls, 1, 2, collapsed); }, "bands");
    expect_refused([&] { isoband<3>(prerolls, 1, 2, {.max_triangles = 9}); }, "more than 9");
    expect_refused([&] { isosurface<2>(prerolls, 2, {}); }, "dimension 3, not 2");
    expect_refused([&] { height_field(prerolls, 1, {}); }, "dimension 3, not 2");
    const std::vector<Point> points{{2, 2, 2}};
    expect_refused([&] { probe(prerolls, points, {.max_triangles = 9}); }, "a probe");
}

}  // namespace drawing_test
