// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Anisotropic hexahedra and prisms: where nodes hang on their own parents, or on those that the
// grid gives, surfaces are closed; where they do not, check_grid and the preroll refuse the grid.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/node_levels.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/check_grid.hpp>

#include "anisotropic_grids.hpp"
#include "anisotropic_judge.hpp"
#include "closedness.hpp"
#include "cut_cube.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace anisotropic_test {

/// A function of the place, random: two nodes at one place have one value.
ForestField<3> noise(const Forest<3>& forest, unsigned seed) {
    std::map<Point, double> at;
    std::mt19937 random(seed);
    for (const Point& x : forest.positions) at.try_emplace(x, 0);
    for (auto& [x, value] : at) value = uniform(random) - 0.5;
    return {forest, [&](const Point& x) { return at.at(x); }};
}

/// Calls test(forest, random) for random grids.
template <class Test>
void on_random_grids(unsigned count, unsigned seed, Test&& test) {
    for (unsigned i = 0; i < count; ++i) {
        std::mt19937 random(seed + i);
        const Forest<3> forest = random_anisotropic_grid(random);
        SCOPED_TRACE(seed + i);
        test(forest, random);
    }
}

template <class Grid>
std::string refused_by_preroll(const Grid& grid, const ForestField<3>& field) {
    return refusal<GridError>([&] { HierarchicalIndicator(grid, field); });
}

/// With every shared vertex computed from every element around it.
template <class Grid>
void expect_closed_surfaces(const Grid& grid, const ForestField<3>& field) {
    const HierarchicalIndicator indicator(grid, field);
    const auto draw = [&](const Criterion& criterion, bool cap) {
        const IsosurfaceOptions options{.cap = cap, .verify = true};
        expect_closed(isosurface(grid, field, 0.0, under(criterion, indicator), options).surface,
                      cap);
    };
    for (const double epsilon : six_thresholds) {
        SCOPED_TRACE(epsilon);
        draw(Threshold(&indicator, epsilon), false);
        draw(Threshold(&indicator, epsilon), true);
    }
    const NodeLevels levels(grid);
    for (const int deepest : {0, 1}) {
        SCOPED_TRACE(deepest);
        draw(levels.deeper_than(deepest), false);
    }
}

struct PlaneAt {
    const char* name;
    Point through;
    Point normal;
    int cubes = 1;  // of the coarse grid that have each point of the plane
};

/// In general position, and through nodes, edges and faces, of elements and of the domain.
const std::vector<PlaneAt> planes{
    {"oblique", {0.9, 0.45, 0.52}, {0.3, 0.5, 0.81}},
    {"z = 1/2", {0, 0, 0.5}, {0, 0, 1}},
    {"y = 1/2", {0, 0.5, 0}, {0, -1, 0}},
    {"x = 1", {1, 0, 0}, {1, 0, 0}, 2},
    {"x = 3/4", {0.75, 0, 0}, {-1, 0, 0}},
    {"y = z", {0, 0, 0}, {0, 1, -1}},
    {"x + y + z = 2", {1, 0.5, 0.5}, {1, 1, 1}},
    {"z = 0", {0, 0, 0}, {0, 0, 1}},
};

/// The area of a plane in the cubes that random grids divide.
double area_in_cubes(const Forest<3>& forest, const PlaneAt& plane) {
    double rows = 0;
    for (const Point& x : forest.positions) rows = std::max(rows, x[1]);
    double area = 0;
    for (double y = 0; y < rows; ++y) {
        for (const double x : {0.0, 1.0}) {
            area += area_in_cube(plane.through - Point{x, y, 0}, plane.normal);
        }
    }
    return area / plane.cubes;
}

/// With every shared vertex computed from every element around it.
/// \param area of a plane in the grid, or a negative number where it is not known
template <class Grid, class Area>
void expect_closed_slices(const Grid& grid, const ForestField<3>& field, Area&& area) {
    const HierarchicalIndicator indicator(grid, field);
    const Sphere ball({0.9, 0.4, 0.45}, 0.6);
    for (const double epsilon : {0.0, 0.1, 1.0}) {
        SCOPED_TRACE(epsilon);
        const Threshold criterion(&indicator, epsilon);
        const IsosurfaceOptions options{.verify = true};
        for (const PlaneAt& at : planes) {
            SCOPED_TRACE(at.name);
            const Plane plane(at.through, at.normal);
            const Slice s = slice(grid, field, plane, under(criterion, indicator), options);
            expect_closed(s.surface);
            for (const Point& x : s.surface.vertices) EXPECT_NEAR(plane.value(x), 0, 1e-12);
            if (const double exact = area(at); exact >= 0) {
                EXPECT_NEAR(surface_report(s.surface).area, exact, 1e-12);
            }
        }
        expect_closed(slice(grid, field, ball, under(criterion, indicator), options).surface);
    }
}
template <class Grid>
void expect_closed_slices(const Grid& grid, const ForestField<3>& field) {
    expect_closed_slices(grid, field, [](const PlaneAt&) { return -1.0; });
}

/// The same grid with coarse corners moved at random.
struct Deformed : ParentsByPlace {
    explicit Deformed(const Forest<3>& forest) : ParentsByPlace(forest) {
        for (std::size_t i = 0; i < coarse_count(); ++i) {
            moved_.push_back(ParentsByPlace::coarse(i));
            CoarseElement<Element>& c = moved_.back();
            for (std::size_t k = 0; k < topology(c.shape).corners; ++k) {
                std::mt19937 random(static_cast<unsigned>(c.ids[k]));
                for (double& x : c.corners[k]) x += 0.2 * uniform(random);
            }
        }
    }
    CoarseElement<Element> coarse(std::size_t i) const { return moved_[i]; }

private:
    std::vector<CoarseElement<Element>> moved_;
};

template <class Grid>
void expect_refused_by_both(const Grid& grid, const ForestField<3>& field) {
    EXPECT_TRUE(check_grid(grid, field));
    EXPECT_NE(refused_by_preroll(grid, field).find("different directions"), std::string::npos);
}

/// Directions in which an element is halved, one level after the other; all children alike, or the
/// first one only.
struct Halved {
    std::vector<unsigned> directions;
    bool first_only = false;
};

/// Two cubes side by side along x.
Forest<3> two_cubes(const Halved& left, const Halved& right) {
    Forest<3> forest;
    for (const double z : {0.0, 1.0}) {
        for (const double y : {0.0, 1.0}) {
            for (const double x : {0.0, 1.0, 2.0}) forest.add_node({x, y, z});
        }
    }
    forest.add_coarse(Shape::hexahedron, {0, 1, 3, 4, 6, 7, 9, 10}, 1);
    forest.add_coarse(Shape::hexahedron, {1, 2, 4, 5, 7, 8, 10, 11}, 1);
    for (std::uint32_t e = 0; e < 2; ++e) {
        const Halved& how = e == 0 ? left : right;
        std::vector<std::uint32_t> leaves{e};
        for (const unsigned direction : how.directions) {
            std::vector<std::uint32_t> children;
            for (const std::uint32_t leaf : leaves) {
                forest.refine(leaf, halvings()[direction]);
                for (std::uint32_t c = 0; c < 2; ++c) {
                    children.push_back(forest.cells[leaf].first_child + c);
                }
                if (how.first_only) break;
            }
            leaves = children;
        }
    }
    return forest;
}

constexpr unsigned y = 1;
constexpr unsigned z = 2;
constexpr unsigned yz = 5;  // in both directions at once

TEST(Anisotropic, FacesDividedAcrossAreRefusedByName) {
    for (const Halved& right : {Halved{{z}}, Halved{{z, y}}, Halved{{z, y}, true}}) {
        const Forest<3> grid = two_cubes({{y, z}}, right);
        const auto field = noise(grid, 1);
        const auto violation = check_grid(grid, field);
        ASSERT_TRUE(violation);
        const bool two_keys = right.directions.size() == 2;
        EXPECT_EQ(violation->law, two_keys ? Law::one_stencil : Law::hanging_parents);
        EXPECT_NE(violation->sentence.find("element 0"), std::string::npos);
        EXPECT_NE(violation->sentence.find("element 1"), std::string::npos);
        EXPECT_NE(refused_by_preroll(grid, field).find("around (1.000000, 0.500000, 0.500000)"),
                  std::string::npos)
            << refused_by_preroll(grid, field);
    }
}

TEST(Anisotropic, FacesDividedInOneOrderAreSupported) {
    const std::vector<std::pair<Halved, Halved>> sides{
        {{{y}}, {{z}}},       {{{z, y}}, {{z}}},          {{{y, z}, true}, {{}}},
        {{{y, y}}, {{z, z}}}, {{{z, y}}, {{z, y}, true}},
    };
    for (const auto& [left, right] : sides) {
        const Forest<3> grid = two_cubes(left, right);
        const auto field = noise(grid, 2);
        EXPECT_FALSE(check_grid(grid, field));
        expect_closed_surfaces(grid, field);
    }
}

TEST(Anisotropic, FacesDividedAcrossAreDrawnWhereParentsAreGiven) {
    const std::vector<std::pair<Halved, Halved>> sides{
        {{{y, z}}, {{z}}},    {{{y, z}}, {{z, y}}},      {{{y, z}}, {{z, y}, true}},
        {{{y, z, z}}, {{z}}}, {{{yz, y, z}}, {{z, yz}}},
    };
    for (const auto& [left, right] : sides) {
        const Forest<3> forest = two_cubes(left, right);
        const ParentsByPlace grid(forest);
        for (unsigned seed = 0; seed < 20; ++seed) {
            const auto field = noise(forest, seed);
            const auto violation = check_grid(grid, field);
            EXPECT_FALSE(violation) << violation->sentence;
            expect_closed_surfaces(grid, field);
        }
    }
}

TEST(Anisotropic, ANodeOnTwoEdgesIsRefusedThoughParentsAreGiven) {
    for (const Forest<3>& forest :
         {two_cubes({{y, z}, true}, {{z}}), two_cubes({{yz, y, z}, true}, {{z, yz}})}) {
        expect_refused_by_both(ParentsByPlace(forest), noise(forest, 1));
    }
}

/// Gives one node, the centre of the common face of two cubes, other parents.
struct OtherParents : ParentsByPlace {
    explicit OtherParents(const Forest<3>& forest) : ParentsByPlace(forest) {}
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const {
        return node == centre ? parents : ParentsByPlace::hanging_parents(node);
    }
    NodeKey centre = *places_.find({1, 0.5, 0.5});
    std::array<NodeKey, 2> parents{};
};

TEST(Anisotropic, WrongParentsAreRefused) {
    const Forest<3> forest = two_cubes({{y, z}}, {{z}});
    const auto field = noise(forest, 1);
    OtherParents grid(forest);
    const auto expect_refused = [&](const std::array<NodeKey, 2>& parents, const char* by_check,
                                    const char* by_preroll) {
        grid.parents = parents;
        const auto violation = check_grid(grid, field);
        ASSERT_TRUE(violation);
        EXPECT_EQ(violation->law, Law::hanging_parents);
        EXPECT_NE(violation->sentence.find(by_check), std::string::npos) << violation->sentence;
        EXPECT_NE(refused_by_preroll(grid, field).find(by_preroll), std::string::npos)
            << refused_by_preroll(grid, field);
    };
    expect_refused({grid.centre, grid.centre}, "", "or the grid does not give its parents");
    expect_refused({0, 1}, "do not give it the value", "or the grid does not give its parents");
    expect_refused({0, 1234567}, "a key of no node", "or the grid does not give its parents");
}

TEST(Anisotropic, NoElementAboveACrossingNodeStops) {
    const Forest<3> forest = two_cubes({{y, z}}, {{z}});
    const ParentsByPlace grid(forest);
    const auto field = noise(forest, 1);
    const HierarchicalIndicator indicator(grid, field);
    EXPECT_THROW(isosurface(grid, field, 0.0, under(DeepestLevel(0), indicator)), InvalidInput);
    const Places places(forest);
    const auto key = [&](const Point& x) { return static_cast<NodeKey>(*places.find(x)); };
    const NodeLevels levels(grid);  // -1 where S does not hold
    EXPECT_EQ(levels.level(key({1, 0.5, 0.5})), -1);
    for (const double side : {0.0, 1.0}) EXPECT_EQ(levels.level(key({1, side, 0.5})), -1);
    EXPECT_EQ(levels.level(key({0, 0.5, 0.5})), 2);
}

TEST(Anisotropic, UnsupportedGridsAreRefusedByBoth) {
    unsigned unsupported = 0;
    on_random_grids(6000, 0, [&](const Forest<3>& forest, std::mt19937& random) {
        if (unsupported == 1000 || Judge(forest, random).supports()) return;
        ++unsupported;
        const auto field = noise(forest, unsupported);
        expect_refused_by_both(forest, field);
        expect_refused_by_both(KeysByPlace(forest), field);
    });
    EXPECT_EQ(unsupported, 1000U);
}

TEST(Anisotropic, UnsupportedGridsAreRefusedByBothThoughParentsAreGiven) {
    unsigned unsupported = 0;
    on_random_grids(11000, 200000, [&](const Forest<3>& forest, std::mt19937& random) {
        if (unsupported == 1000 || Judge(forest, random, true).supports()) return;
        ++unsupported;
        const auto field = noise(forest, unsupported);
        const ParentsByPlace grid(forest);
        EXPECT_TRUE(check_grid(grid, field));
        EXPECT_NE(refused_by_preroll(grid, field), "");
    });
    EXPECT_EQ(unsupported, 1000U);
}

TEST(Anisotropic, GridsThatGiveParentsDrawClosedSurfaces) {
    unsigned supported = 0;
    unsigned crossing = 0;
    on_random_grids(3000, 300000, [&](const Forest<3>& forest, std::mt19937& random) {
        const Judge judge(forest, random, true);
        if (!judge.supports()) return;
        ++supported;
        const auto field = noise(forest, supported);
        const ParentsByPlace grid(forest);
        const auto violation = check_grid(grid, field);
        EXPECT_FALSE(violation) << violation->sentence;
        EXPECT_EQ(refused_by_preroll(grid, field), "");
        if (Judge(forest, random).supports()) return;  // the other tests draw these
        ++crossing;
        expect_closed_surfaces(grid, field);
        expect_closed_surfaces(Deformed(forest), field);
        const auto area = [&](const PlaneAt& plane) { return area_in_cubes(forest, plane); };
        expect_closed_slices(grid, field, area);
        SCOPED_TRACE("deformed");
        expect_closed_slices(Deformed(forest), field);
    });
    EXPECT_GT(supported, 2500U);
    EXPECT_GT(crossing, 300U);
}

TEST(Anisotropic, SupportedGridsDrawClosedSurfaces) {
    unsigned supported = 0;
    unsigned hanging = 0;
    unsigned refused = 0;
    on_random_grids(6000, 100000, [&](const Forest<3>& forest, std::mt19937& random) {
        const Judge judge(forest, random);
        if (supported == 900 || !judge.supports()) return;
        ++supported;
        if (judge.hanging() > 0) ++hanging;
        const auto field = noise(forest, supported);
        const KeysByPlace keyed(forest);
        const bool checked = !check_grid(forest, field);
        EXPECT_EQ(checked, !check_grid(keyed, field));
        EXPECT_EQ(checked, refused_by_preroll(forest, field).empty());
        EXPECT_EQ(checked, refused_by_preroll(keyed, field).empty());
        if (!checked) {
            ++refused;
            return;
        }
        expect_closed_surfaces(forest, field);
        expect_closed_surfaces(keyed, field);
        if (supported % 10 != 0) return;
        const auto area = [&](const PlaneAt& plane) { return area_in_cubes(forest, plane); };
        expect_closed_slices(forest, field, area);
    });
    EXPECT_EQ(supported, 900U);
    EXPECT_GT(hanging, 300U);
    EXPECT_LE(refused, 36U);
}

}  // namespace anisotropic_test
