// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of data that jump between elements, on every family: elements are drawn alone, with values
// of leaves below them, where these deviate by the threshold at most.
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/discontinuous.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/detail/interpolate.hpp>

#include "cut_cube.hpp"
#include "families.hpp"
#include "is_affine.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace discontinuous_test {

double smooth(const Point& x) { return std::sin(4 * x[0]) + x[1] * x[1] - 0.5 * x[2]; }
double linear(const Point& x) { return 2 * x[0] - 3 * x[1] + x[2] + 0.125; }

using Place = std::array<std::int64_t, 3>;

/// A place up to rounding, in which a walk and a grid may differ at nodes that hang.
Place place(const Point& x) {
    Place at;
    for (std::size_t d = 0; d < 3; ++d) at[d] = std::llround(x[d] * 0x1p30);
    return at;
}
/// A function, and on top of it a constant for each leaf; component 1 tells the constant alone.
template <class Grid>
struct JumpingField {
    using Element = ElementOf<Grid>;
    static constexpr int components = 2;

    const Grid* grid;
    double (*function)(const Point&);
    double jump;
    std::vector<Point> position = grid->node_positions();

    std::vector<NodeKey> keys(const Element& leaf, std::size_t corners) const {
        std::vector<NodeKey> keys(corners);
        grid->corner_keys(leaf, keys);
        return keys;
    }
    double constant(const std::vector<NodeKey>& keys) const {
        std::size_t hash = 17;
        for (const NodeKey key : keys) hash = 31 * hash + static_cast<std::size_t>(key);
        return jump * static_cast<double>(hash % 64) / 64;
    }
    void leaf_values(const Element& leaf, std::span<double> out) const {
        const std::vector<NodeKey> of = keys(leaf, out.size() / 2);
        for (std::size_t k = 0; k < of.size(); ++k) {
            out[2 * k + 1] = constant(of);
            out[2 * k] = function(position[of[k]]) + out[2 * k + 1];
        }
    }
};

/// All values that leaves below an element have at each place, and how far they are from what the
/// corners of the element interpolate.
template <class Grid>
class Below {
public:
    using Element = ElementOf<Grid>;

    explicit Below(const JumpingField<Grid>& field)
        : field_{&field}, context_{field.grid->make_context()} {}

    const std::multimap<Place, double>& values(const Element& e, Shape shape) {
        at_.clear();
        visit(e, shape, {});
        return at_;
    }
    /// \param corners component 0 at the corners of the element
    double deviation(const Element& e, Shape shape, const std::vector<double>& corners) {
        greatest_ = 0;
        visit(e, shape, corners);
        return greatest_;
    }

private:
    void visit(const Element& e, Shape shape, const std::vector<double>& corners) {
        const std::size_t count = topology(shape).corners;
        const Rule* const rule = field_->grid->split(e);
        if (rule == nullptr) return leaf(e, count, corners);
        std::vector<double> node = corners;
        for (const Stencil& stencil : rule->new_nodes) {
            if (!corners.empty()) node.push_back(detail::interpolate(stencil, node.data(), 1));
        }
        std::vector<Element> children(rule->children.size());
        field_->grid->children(e, children, context_);
        for (std::size_t c = 0; c < children.size(); ++c) {
            const Child& child = rule->children[c];
            std::vector<double> of_child;
            for (std::size_t i = 0; !node.empty() && i < topology(child.shape).corners; ++i) {
                of_child.push_back(node[child.corner[i]]);
            }
            visit(children[c], child.shape, of_child);
        }
    }
    void leaf(const Element& e, std::size_t count, const std::vector<double>& corners) {
        std::vector<double> values(2 * count);
        field_->leaf_values(e, values);
        const std::vector<NodeKey> keys = field_->keys(e, count);
        for (std::size_t k = 0; k < count; ++k) {
            at_.emplace(place(field_->position[keys[k]]), values[2 * k]);
            if (!corners.empty()) {
                greatest_ = std::max(greatest_, std::abs(corners[k] - values[2 * k]));
            }
        }
    }

    const JumpingField<Grid>* field_;
    typename Grid::Context context_;
    std::multimap<Place, double> at_;
    double greatest_ = 0;
};

/// Component 0 at the corners of each element of a shading, by the places of the corners.
std::vector<std::map<Place, double>> drawn_corners(const Surface<3>& surface) {
    std::vector<std::map<Place, double>> drawn(surface.level_of.size());
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        for (const std::uint32_t v : surface.simplices[t]) {
            drawn[surface.element_of[t]].emplace(place(surface.vertices[v]),
                                                 surface.attributes[2 * v]);
        }
    }
    return drawn;
}

double area_of(const Surface<3>& surface) { return surface_report(surface).area; }

template <class Family>
class Discontinuous : public testing::Test {};
TYPED_TEST_SUITE(Discontinuous, Families);

/// Calls test(field) for grids that are refined at a sphere.
template <class Family, class Test>
void for_each_jumping_field(double (*function)(const Point&), double jump, Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, 3 * Family::steps);
        test(JumpingField<typename Family::Grid>{&grid, function, jump});
    }
}

TYPED_TEST(Discontinuous, DrawsEveryLeafWithItsValues) {
    for_each_jumping_field<TypeParam>(smooth, 1, [](const auto& field) {
        if constexpr (TypeParam::Grid::dimension == 2) {
            const auto drawn = shading({*field.grid, field}).surface;
            EXPECT_EQ(drawn.level_of.size(), field.grid->leaf_count());
            EXPECT_EQ(drawn.attributes.size(), 2 * drawn.vertices.size());
            for (std::size_t v = 0; v < drawn.vertices.size(); ++v) {
                EXPECT_NEAR(drawn.attributes[2 * v],
                            smooth(drawn.vertices[v]) + drawn.attributes[2 * v + 1], 1e-14);
            }
        }
    });
}

/// Elements stop within the threshold, with values of leaves below them at their corners; what they
/// cover is the domain. In triangles the error that is told is reached.
TYPED_TEST(Discontinuous, StopsWithinTheThreshold) {
    using Grid = typename TypeParam::Grid;
    if constexpr (Grid::dimension == 2) {
        for_each_jumping_field<TypeParam>(smooth, 0.02, [](const auto& field) {
            const DiscontinuousData data(*field.grid, field);
            const ElementDeviations deviations(data);
            const double area = area_of(shading(data).surface);
            std::size_t before = field.grid->leaf_count();
            Below<Grid> below(field);
            for (const double threshold : {0.0, 0.021, 0.05, 0.2, 1e9}) {
                const auto result =
                    shading(data, {.threshold = threshold, .deviations = &deviations});
                const auto elements = result.surface.elements.template as<ElementOf<Grid>>();
                const auto corners = drawn_corners(result.surface);
                double greatest = 0;  // of what elements deviate
                EXPECT_EQ(corners.size(), result.counts.extracted);
                EXPECT_NEAR(area_of(result.surface), area, 1e-12 * area);
                for (std::size_t e = 0; e < corners.size(); ++e) {
                    const Shape shape = result.surface.shape_of[e];
                    const auto& values = below.values(elements[e], shape);
                    for (const auto& drawn : corners[e]) {
                        const auto [first, last] = values.equal_range(drawn.first);
                        EXPECT_TRUE(std::any_of(first, last, [&](const auto& one) {
                            return one.second == drawn.second;
                        }));
                    }
                    std::vector<double> at;
                    for (const NodeKey key : field.keys(elements[e], topology(shape).corners)) {
                        at.push_back(corners[e].at(place(field.position[key])));
                    }
                    const double deviation = below.deviation(elements[e], shape, at);
                    EXPECT_LE(deviation, threshold);
                    EXPECT_LE(deviation, result.error_bound);
                    greatest = std::max(greatest, deviation);
                }
                EXPECT_LE(corners.size(), before);
                before = corners.size();
                if (std::ranges::all_of(result.surface.shape_of, is_simplex)) {
                    EXPECT_LE(result.error_bound, greatest * (1 + 1e-6)) << "not reached";
                }
            }
            EXPECT_EQ(before, field.grid->coarse_count());
        });
    }
}

/// A plane is covered once whatever the levels of elements, also where it runs in their faces.
TYPED_TEST(Discontinuous, SlicesTakeEachPointOfAPlaneOnce) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_jumping_field<TypeParam>(smooth, 0.02, [](const auto& field) {
            if (!is_affine(*field.grid)) return;
            const DiscontinuousData data(*field.grid, field);
            const ElementDeviations deviations(data);
            for (const auto& [through, normal] :
                 {std::pair<Point, Point>{{0.4, 0.5, 0.49}, {0.3, 0.5, 0.81}},
                  {{0.5, 0, 0}, {1, 0, 0}},
                  {{0.5, 0.5, 0.5}, {1, 1, 0}},
                  {{0, 0.25, 0}, {0, 1, -1}},
                  {{0, 0, 0}, {0, 0, 1}},
                  {{0, 0, 0}, {0, 0, -1}},
                  {{0, 1, 0}, {0, 1, 0}}}) {
                const nestgrid::Plane plane(through, normal);
                std::size_t before = ~std::size_t{0};
                for (const double threshold : {0.0, 0.05, 1e9}) {
                    const auto result =
                        slice(data, plane, {.threshold = threshold, .deviations = &deviations});
                    const Surface<3>& drawn = result.surface;
                    EXPECT_NEAR(area_of(drawn), area_in_cube(through, normal), 1e-12);
                    for (const Point& x : drawn.vertices) EXPECT_NEAR(plane.value(x), 0, 1e-12);
                    for (const auto& [a, b, c] : drawn.simplices) {
                        const Point& x = drawn.vertices[a];
                        EXPECT_LT(dot(cross(drawn.vertices[b] - x, drawn.vertices[c] - x), normal),
                                  0);
                    }
                    EXPECT_LE(drawn.level_of.size(), before);
                    before = drawn.level_of.size();
                }
            }
        });
    }
}

/// Data that are linear on each leaf are drawn exactly, with their jumps.
TYPED_TEST(Discontinuous, SlicesCarryWhatIsLinearOnLeaves) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_jumping_field<TypeParam>(linear, 1, [](const auto& field) {
            if (!is_affine(*field.grid)) return;
            const nestgrid::Sphere sphere({0.5, 0.5, 0.5}, 0.3);
            const nestgrid::Plane plane({0.4, 0.5, 0.49}, {0.3, 0.5, 0.81});
            for (const LevelFunction* f : {static_cast<const LevelFunction*>(&sphere),
                                           static_cast<const LevelFunction*>(&plane)}) {
                const Surface<3> drawn = slice({*field.grid, field}, *f).surface;
                ASSERT_FALSE(drawn.vertices.empty());
                for (std::size_t v = 0; v < drawn.vertices.size(); ++v) {
                    EXPECT_NEAR(drawn.attributes[2 * v],
                                linear(drawn.vertices[v]) + drawn.attributes[2 * v + 1], 1e-12);
                }
            }
        });
    }
}

/// Where no node hangs, data without a jump are drawn as nodal data are.
TYPED_TEST(Discontinuous, SlicesOfContinuousDataAreThoseOfNodalData) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_jumping_field<TypeParam>(linear, 0, [](const auto& field) {
            const DiscontinuousData data(*field.grid, field);
            if (!data.grid().facts().conforming) return;
            const nestgrid::Sphere sphere({0.5, 0.5, 0.5}, 0.3);
            const auto pieces = slice(data, sphere);
            const std::vector<double> values = sample_nodes(*field.grid, linear);
            const NodeField<typename TypeParam::Grid, double> nodal(*field.grid, values);
            const Slice whole = slice(*field.grid, nodal, sphere);
            EXPECT_NEAR(area_of(pieces.surface), area_of(whole.surface), 1e-12);
        });
    }
}

/// Deviations decide about what stops, and nothing else.
TYPED_TEST(Discontinuous, NeedsNoDeviationsAtThresholdZero) {
    for_each_jumping_field<TypeParam>(smooth, 1, [](const auto& field) {
        const DiscontinuousData data(*field.grid, field);
        const ElementDeviations deviations(data);
        const DiscontinuousOptions coarse{.threshold = 0.1};
        if constexpr (TypeParam::Grid::dimension == 2) {
            expect_same(shading(data).surface, shading(data, {.deviations = &deviations}).surface);
            expect_same(shading(data, coarse).surface,
                        shading(data, {.threshold = 0.1, .deviations = &deviations}).surface);
        } else {
            const nestgrid::Plane plane({0.4, 0.5, 0.49}, {0.3, 0.5, 0.81});
            expect_same(slice(data, plane).surface,
                        slice(data, plane, {.deviations = &deviations}).surface);
            expect_same(slice(data, plane, coarse).surface,
                        slice(data, plane, {.threshold = 0.1, .deviations = &deviations}).surface);
        }
    });
}

/// Draws whatever the dimension allows.
template <class Field>
nestgrid::DiscontinuousSurface draw(
    const Field& field, const DiscontinuousOptions& options,
    const nestgrid::Executor& executor = nestgrid::SequentialExecutor{}) {
    const DiscontinuousData data(*field.grid, field);
    if constexpr (std::remove_cvref_t<decltype(*field.grid)>::dimension == 2) {
        return height_field(data, 0.5, options, executor);
    } else {
        return slice(data, nestgrid::Sphere({0.5, 0.5, 0.5}, 0.3), options, executor);
    }
}

/// No bit depends on the number of threads, nor on where the grid is cut into tasks.
TYPED_TEST(Discontinuous, DoesNotDependOnThreads) {
    for_each_jumping_field<TypeParam>(smooth, 0.02, [](const auto& field) {
        for (const double threshold : {0.0, 0.03, 0.2, 1e9}) {
            const DiscontinuousOptions options{.threshold = threshold};
            const auto one = draw(field, options);
            for (const std::size_t threads : {2, 5}) {
                const auto many = draw(field, options, ThreadExecutor(threads));
                expect_same(one.surface, many.surface);
                EXPECT_EQ(one.error_bound, many.error_bound);
                EXPECT_EQ(one.counts.calls, many.counts.calls);
                EXPECT_EQ(one.counts.visited, many.counts.visited);
                EXPECT_EQ(one.counts.extracted, many.counts.extracted);
            }
        }
    });
}

/// A number of triangles is kept, at a threshold that draws the same, and the next lesser threshold
/// exceeds it.
TYPED_TEST(Discontinuous, KeepsANumberOfTriangles) {
    for_each_jumping_field<TypeParam>(smooth, 0.02, [](const auto& field) {
        const std::size_t all = draw(field, {}).surface.simplices.size();
        const std::size_t fewest = draw(field, {.threshold = 1e9}).surface.simplices.size();
        for (const std::size_t most : {all, (all + fewest) / 2, fewest}) {
            if (most == 0) continue;
            const auto drawn = draw(field, {.max_triangles = most}, ThreadExecutor(2));
            const nestgrid::TriangleBudget& search = drawn.search;
            EXPECT_LE(drawn.surface.simplices.size(), most);
            EXPECT_EQ(drawn.surface.simplices.size(), search.triangles);
            EXPECT_EQ(search.max_triangles, most);
            expect_same(drawn.surface, draw(field, {.threshold = search.threshold}).surface);
            if (search.end() == nestgrid::BudgetEnd::step) {
                const double next = search.next_threshold;
                EXPECT_GT(draw(field, {.threshold = next}).surface.simplices.size(), most);
            }
        }
        if (fewest > 1) {
            expect_refused([&] { draw(field, {.max_triangles = fewest - 1}); }, "triangles");
        }
    });
}

TEST(DiscontinuousCells, AreConstantOnLeavesAndLifted) {
    for (auto& grid : UnbalancedQuadtree::grids()) {
        refine_at_sphere(grid, 4);
        int next = 0;
        const auto number = [&](const ElementOf<OctreeGrid<2>>&) { return next++; };
        const Surface<3> drawn = height_field({grid, number}, 0.5).surface;
        std::size_t differ = 0;
        for (const auto& [a, b, c] : drawn.simplices) {
            EXPECT_EQ(drawn.attributes[a], drawn.attributes[b]);
            EXPECT_EQ(drawn.attributes[a], drawn.attributes[c]);
            EXPECT_EQ(drawn.vertices[a][2], 0.5 * drawn.attributes[a]);
            differ += drawn.attributes[a] != drawn.attributes[drawn.simplices[0][0]] ? 1 : 0;
        }
        EXPECT_EQ(static_cast<std::size_t>(next), grid.leaf_count());
        EXPECT_EQ(differ, 2 * (grid.leaf_count() - 1));
    }
}

/// Contours of all kinds, with ambiguous faces and tunnels.
class Folds final : public LevelFunction {
public:
    double value(const Point& x) const override {
        return std::sin(37 * x[0] + 61 * x[1] * x[1] + 43 * x[2] + 29 * x[0] * x[2]) + 0.1;
    }
};

TEST(DiscontinuousCells, DrawContoursOfAllKindsAsSlicesDo) {
    for (auto& grid : BalancedOctree::grids()) {
        for (int i = 0; i < 4; ++i) grid.refine_uniformly();
        const std::vector<double> values(grid.node_count(), 1.0);
        const NodeField<OctreeGrid<3>, double> field(grid, values);
        const auto one = [](const ElementOf<OctreeGrid<3>>&) { return 1.0; };
        const Surface<3> pieces = slice({grid, one}, Folds{}).surface;
        const Surface<3> whole = slice(grid, field, Folds{}).surface;
        EXPECT_EQ(pieces.simplices.size(), whole.simplices.size());
        EXPECT_NEAR(area_of(pieces), area_of(whole), 1e-12 * area_of(whole));
        for (const double u : pieces.attributes) EXPECT_NEAR(u, 1, 1e-14);
    }
}

TEST(DiscontinuousCells, RefuseWrongInput) {
    OctreeGrid<2> grid(quadrilaterals(2));
    const auto one = [](const ElementOf<OctreeGrid<2>>&) { return 1.0; };
    const auto wrong = [](const ElementOf<OctreeGrid<2>>&) { return NAN; };
    const DiscontinuousData data(grid, one);
    expect_refused([&] { shading(data, {.threshold = -1}); }, "the threshold is negative");
    expect_refused([&] { shading(data, {.flatness = NAN}); }, "the flatness is negative");
    expect_refused([&] { shading(data, {.threshold = 1, .max_triangles = 9}); }, "not both");
    expect_refused([&] { height_field(data, INFINITY); }, "the scale of the heights is not a");
    expect_refused(
        [&] {
            slice(data, nestgrid::Plane({0, 0, 0}, {0, 0, 1}));
        },
        "the hierarchy has dimension 2, not 3");
    expect_refused([&] { shading({grid, wrong}); }, "a value at a corner of a leaf is not");
    expect_refused(
        [&] {
            const ElementDeviations d({grid, wrong});
        },
        "a value at a corner of a leaf is not");
    const ElementDeviations deviations(data);
    grid.adapt([](const Leaf&) { return Mark::refine; });
    EXPECT_THROW(shading(data, {.deviations = &deviations}), GridError);
}

TEST(DiscontinuousCells, EndsWhenProgressSaysSo) {
    OctreeGrid<2> grid(quadrilaterals(64));
    for (int i = 0; i < 3; ++i) grid.adapt([](const Leaf&) { return Mark::refine; });
    const auto one = [](const ElementOf<OctreeGrid<2>>&) { return 1.0; };
    const auto result =
        shading({grid, one}, {.progress = [](const TraversalCounts&) { return false; }});
    EXPECT_TRUE(result.cancelled);
    EXPECT_LT(result.surface.level_of.size(), grid.leaf_count());
}

}  // namespace discontinuous_test
