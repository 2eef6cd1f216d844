// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Standard rules agree wherever two shapes share a face: grids of two elements, of all pairs of
// shapes, faces and ways to turn one upon the other, refined in all combinations, are sound and
// their surfaces closed.
#include <cmath>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/standard_rules.hpp>

#include "closedness.hpp"
#include "forest.hpp"

using namespace nestgrid_test;

namespace rules_agree_test {

/// How elements are refined.
using RuleOf = const Rule& (*)(Shape);

Point mean(const std::vector<Point>& x) {
    Point sum{};
    for (const Point& at : x) sum = sum + (1.0 / static_cast<double>(x.size())) * at;
    return sum;
}

std::vector<Point> face_corners(const FaceTopology& face, const std::vector<Point>& x) {
    std::vector<Point> corners;
    for (std::size_t k = 0; k < face.corners; ++k) corners.push_back(x[face.corner[k]]);
    return corners;
}

std::vector<Point> reference(Shape shape) {
    const Topology& t = topology(shape);
    return {t.reference.begin(), t.reference.begin() + t.corners};
}

/// The weights of x in a frame of three vectors.
Point in_frame(const std::array<Point, 3>& v, const Point& x) {
    const double volume = dot(v[0], cross(v[1], v[2]));
    return {dot(x, cross(v[1], v[2])) / volume, dot(x, cross(v[2], v[0])) / volume,
            dot(x, cross(v[0], v[1])) / volume};
}

/// Vectors from the first corner of a loop to its neighbours, and from the face to `towards`.
std::array<Point, 3> frame(const std::vector<Point>& loop, const Point& towards) {
    if (loop.size() == 2) return {loop[1] - loop[0], towards, Point{0, 0, 1}};
    return {loop[1] - loop[0], loop.back() - loop[0], towards};
}

/// A reference element and another one beyond its face f, whose face g lies on f, turned by `turn`
/// corners.
template <int dim>
Forest<dim> pair(Shape first, std::size_t f, Shape second, std::size_t g, std::size_t turn) {
    Forest<dim> forest;
    const std::vector<Point> x = reference(first);
    const std::vector<Point> y = reference(second);
    const FaceTopology& here = topology(first).face[f];
    const FaceTopology& there = topology(second).face[g];
    const std::size_t n = here.corners;
    std::vector<std::uint32_t> nodes;
    for (const Point& at : x) nodes.push_back(forest.add_node(at));
    forest.add_coarse(first, nodes, 1);

    // The loops run opposite to each other.
    std::vector<std::uint8_t> matched;
    for (std::size_t k = 0; k < n; ++k) matched.push_back(here.corner[(turn + n - k) % n]);
    std::vector<Point> from = face_corners(there, y);
    std::vector<Point> to;
    for (const std::uint8_t k : matched) to.push_back(x[k]);
    const std::array<Point, 3> old_frame = frame(from, mean(y) - mean(from));
    const std::array<Point, 3> new_frame = frame(to, mean(to) - mean(x));
    std::vector<std::uint32_t> others;
    for (std::size_t c = 0; c < y.size(); ++c) {
        const auto on_face = std::find(there.corner.begin(), there.corner.begin() + n, c);
        if (on_face != there.corner.begin() + n) {
            others.push_back(matched[static_cast<std::size_t>(on_face - there.corner.begin())]);
            continue;
        }
        const Point w = in_frame(old_frame, y[c] - from[0]);
        others.push_back(forest.add_node(to[0] + w[0] * new_frame[0] + w[1] * new_frame[1] +
                                         w[2] * new_frame[2]));
    }
    forest.add_coarse(second, others, 1);
    return forest;
}

/// Calls test(forest) for all pairs.
template <int dim, class Test>
void for_each_pair(const std::vector<Shape>& shapes, Test&& test) {
    for (const Shape first : shapes) {
        for (const Shape second : shapes) {
            for (std::size_t f = 0; f < topology(first).faces; ++f) {
                for (std::size_t g = 0; g < topology(second).faces; ++g) {
                    const std::size_t n = topology(first).face[f].corners;
                    if (topology(second).face[g].corners != n) continue;
                    for (std::size_t turn = dim == 2 ? 1 : 0; turn < n; ++turn) {
                        SCOPED_TRACE(std::string(topology(first).name) + " face " +
                                     std::to_string(f) + ", " + std::string(topology(second).name) +
                                     " face " + std::to_string(g) + ", turned by " +
                                     std::to_string(turn));
                        test(pair<dim>(first, f, second, g, turn));
                    }
                }
            }
        }
    }
}

template <int dim>
void expect_sound(const Forest<dim>& forest, std::mt19937& random) {
    const ForestField<dim> field(forest, [&](const Point&) { return uniform(random) - 0.5; });
    const auto violation = check_grid(forest, field);
    ASSERT_FALSE(violation) << violation->sentence;
    const HierarchicalIndicator indicator(forest, field);
    for (const double threshold : {0.0, 0.2, 0.6}) {
        expect_closed(isosurface(forest, field, 0.0, under(indicator, threshold)).surface);
    }
}

/// Both, one or none of two elements refined, then some elements more.
template <int dim>
void expect_rules_agree(const std::vector<Shape>& shapes, RuleOf rule) {
    std::mt19937 random(29);
    int pairs = 0;
    for_each_pair<dim>(shapes, [&](const Forest<dim>& coarse) {
        ++pairs;
        for (unsigned refined = 1; refined < 4; ++refined) {
            Forest<dim> forest = coarse;
            for (std::uint32_t e = 0; e < 2; ++e) {
                if ((refined >> e & 1U) != 0) forest.refine(e, rule(forest.cells[e].shape));
            }
            for (int more = 0; more < pairs % 3; ++more) {
                const auto e = static_cast<std::uint32_t>(random() % forest.cells.size());
                if (forest.cells[e].rule == nullptr) forest.refine(e, rule(forest.cells[e].shape));
            }
            expect_sound(forest, random);
        }
    });
    EXPECT_GT(pairs, dim == 2 ? 40 : 500);
}

TEST(StandardRules, AgreeInTheRedOnesOfAllShapes) {
    expect_rules_agree<2>({Shape::triangle, Shape::quadrilateral}, red_rule);
    expect_rules_agree<3>({Shape::tetrahedron, Shape::pyramid, Shape::prism, Shape::hexahedron},
                          red_rule);
}

/// What the header says goes together not is refused.
TEST(StandardRules, SaySoWhereTheyDoNotAgree) {
    std::mt19937 random(30);
    for (const Shape second : {Shape::hexahedron, Shape::pyramid, Shape::prism}) {
        Forest<3> forest = pair<3>(Shape::prism, 2, second, second == Shape::prism ? 2 : 0, 0);
        if (second == Shape::hexahedron) forest = pair<3>(Shape::prism, 2, second, 4, 0);
        forest.refine(0, prism_rule(PrismSplit::isotropic));
        forest.refine(1, red_rule(second));
        const ForestField<3> field(forest, [&](const Point&) { return uniform(random); });
        const auto violation = check_grid(forest, field);
        ASSERT_TRUE(violation);
        EXPECT_GT(violation->sentence.size(), 20U);
    }
}

}  // namespace rules_agree_test
