// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A crack is no boundary: where coarse elements touch without sharing the nodes of what they have
// in common, check_grid says so, and what is drawn there is open. The coarse grids are the leaves
// of all families, which touch in parts of faces wherever a node hangs.
#include <cmath>
#include <initializer_list>
#include <map>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/detail/coarse_boundary.hpp>
#include <nestgrid/standard_rules.hpp>

#include "families.hpp"

using namespace nestgrid_test;

namespace contacts_test {

double plane(const Point& x) { return x[0] + 0.7 * x[1] + 0.4 * x[2]; }

/// The leaves of a hierarchy as a grid of coarse elements only; one place, one id. It is its own
/// field, the plane.
template <int dim>
class Leaves {
public:
    using Element = std::size_t;
    using value_type = double;
    static constexpr int dimension = dim;

    template <class Grid>
    explicit Leaves(const Grid& grid) {
        auto context = make_context(grid);
        for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
            const auto coarse = detail::call_coarse(grid, context, i);
            const std::size_t corners = topology(coarse.shape).corners;
            add(grid, context, coarse.element, coarse.shape, coarse.orientation,
                {coarse.corners.begin(), coarse.corners.begin() + corners});
        }
    }

    /// Some elements of another grid.
    Leaves(const Leaves& from, std::initializer_list<std::size_t> which) {
        for (const std::size_t i : which) {
            leaves_.push_back(from.leaves_[i]);
            leaves_.back().element = leaves_.size() - 1;
        }
    }

    std::size_t coarse_count() const { return leaves_.size(); }
    CoarseElement<Element> coarse(std::size_t i) const { return leaves_[i]; }
    const Rule* split(Element) const { return nullptr; }
    void children(Element, std::span<Element> out) const { std::fill(out.begin(), out.end(), 0); }
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = plane(leaves_[i].corners[k]);
        return 0;
    }
    NodeMask new_values(Element, NodeMask, std::span<double>) const { return 0; }

    /// Gives each element ids of its own.
    void part() {
        std::uint64_t next = 0;
        for (auto& leaf : leaves_) {
            for (auto& id : leaf.ids) id = next++;
        }
    }

private:
    template <class Grid, class Context>
    void add(const Grid& grid, Context& context, const ElementOf<Grid>& e, Shape shape,
             int orientation, std::vector<Point> x) {
        const Rule* rule = detail::call_split(grid, context, e);
        if (rule == nullptr) {
            CoarseElement<Element> leaf;
            leaf.element = leaves_.size();
            leaf.shape = shape;
            leaf.orientation = static_cast<std::int8_t>(orientation);
            for (std::size_t k = 0; k < topology(shape).corners; ++k) {
                leaf.corners[k] = rounded(x[k]);
                leaf.ids[k] = ids_.try_emplace(leaf.corners[k], ids_.size()).first->second;
            }
            leaves_.push_back(leaf);
            return;
        }
        for (const Stencil& stencil : rule->new_nodes) {
            Point mean{};
            for (std::size_t p = 0; p < stencil.count; ++p) {
                mean = mean + stencil.weight[p] * x[stencil.parent[p]];
            }
            x.push_back(mean);
        }
        std::vector<ElementOf<Grid>> children(rule->children.size());
        detail::call_children(grid, context, e, std::span(children));
        for (std::size_t c = 0; c < children.size(); ++c) {
            const Child& child = rule->children[c];
            std::vector<Point> corners;
            for (std::size_t k = 0; k < topology(child.shape).corners; ++k) {
                corners.push_back(x[child.corner[k]]);
            }
            add(grid, context, children[c], child.shape, orientation * child.orientation, corners);
        }
    }
    static Point rounded(const Point& x) {
        return {std::round(x[0] * 0x1p40) * 0x1p-40, std::round(x[1] * 0x1p40) * 0x1p-40,
                std::round(x[2] * 0x1p40) * 0x1p-40};
    }

    std::vector<CoarseElement<Element>> leaves_;
    std::map<Point, std::uint64_t> ids_;
};

/// What a surface has on the boundary, points or a length, and how many edges (points) are open.
struct Ends {
    double boundary = 0;
    std::size_t open = 0;
};

Ends ends(const Surface<2>& line) {
    std::vector<int> uses(line.vertices.size());
    for (const auto& segment : line.simplices) {
        for (const std::uint32_t v : segment) ++uses[v];
    }
    const auto single = static_cast<std::size_t>(std::count(uses.begin(), uses.end(), 1));
    return {double(line.boundary.size()), single - line.boundary.size()};
}

Ends ends(const Surface<3>& surface) {
    Ends result;
    for (const auto& [a, b] : surface.boundary) {
        result.boundary += norm(surface.vertices[a] - surface.vertices[b]);
    }
    result.open = surface_report(surface).open_edges;
    return result;
}

template <class Family>
class Contacts : public testing::Test {};
TYPED_TEST_SUITE(Contacts, Families);

TYPED_TEST(Contacts, AreNoBoundary) {
    using Grid = typename TypeParam::Grid;
    constexpr int dimension = Grid::dimension;
    std::mt19937 random(17);
    for (Grid& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        refine_at_random(grid, random, 2, 5 * TypeParam::steps, 3, 4000);
        const std::vector<double> values = sample_nodes(grid, plane);
        const NodeField<Grid, double> field(grid, values);
        const Leaves<dimension> leaves(grid);
        const auto violation = check_grid(leaves, leaves);
        bool touches = false;
        for (const double isovalue : {0.4, 0.55, 0.7}) {
            const Ends whole = ends(isosurface(grid, field, isovalue).surface);
            const Ends parts = ends(isosurface(leaves, leaves, isovalue).surface);
            EXPECT_EQ(whole.open, 0U);
            EXPECT_NEAR(parts.boundary, whole.boundary, 1e-5);  // cuts keep away from nodes
            touches |= parts.open > 0;
        }
        if (violation) {
            EXPECT_EQ(violation->law, Law::coarse_contact) << violation->sentence;
        }
        EXPECT_EQ(violation.has_value(), touches);
    }
}

/// The same elements without a common node are pieces, and their surfaces end on the sides of
/// slits.
TYPED_TEST(Contacts, OfWholeFacesAreSlits) {
    using Grid = typename TypeParam::Grid;
    for (const Grid& grid : TypeParam::grids()) {
        Leaves<Grid::dimension> leaves(grid);
        leaves.part();
        std::vector<std::string> notes;
        const auto violation = check_grid(leaves, leaves, {.notes = &notes});
        EXPECT_FALSE(violation) << violation->sentence;
        const std::string pieces = std::to_string(leaves.coarse_count()) + " pieces";
        const bool noted = std::any_of(notes.begin(), notes.end(), [&](const std::string& note) {
            return note.find(pieces) != std::string::npos;
        });
        EXPECT_EQ(noted, leaves.coarse_count() > 1);
        EXPECT_EQ(ends(isosurface(leaves, leaves, 0.55).surface).open, 0U);
    }
}

/// Whether a point lies in an element, or on its boundary, all faces being plane.
template <class Coarse>
bool lies_in(const Coarse& e, const Point& x, int dimension) {
    const Topology& t = topology(e.shape);
    const auto beyond = [&](const Point& from, const Point& normal) {
        return dot(normal, x - from) > 1e-9 * norm(normal);
    };
    const auto& at = e.corners;
    const Point upwards = cross(at[1] - at[0], at[2] - at[0]);
    if (dimension == 2 && (beyond(at[0], upwards) || beyond(at[0], -1.0 * upwards))) return false;
    for (std::size_t f = 0; f < t.faces; ++f) {
        const auto& corner = t.face[f].corner;
        const Point along = at[corner[1]] - at[corner[0]];
        const Point across =
            dimension == 2 ? upwards : double(e.orientation) * (at[corner[2]] - at[corner[0]]);
        if (beyond(at[corner[0]], cross(along, across))) return false;
    }
    return true;
}

/// Whether a node of one element lies on the other one, which does not have it.
template <class Coarse>
bool touches_loosely(const Coarse& one, const Coarse& other, int dimension) {
    const auto corners_of = [](const Coarse& e) {
        return std::span(e.ids).first(topology(e.shape).corners);
    };
    for (std::size_t k = 0; k < corners_of(one).size(); ++k) {
        const bool shared =
            std::ranges::find(corners_of(other), one.ids[k]) != corners_of(other).end();
        if (!shared && lies_in(other, one.corners[k], dimension)) return true;
    }
    return false;
}

/// Two leaves share all nodes of the part in which they touch, be it a face, an edge or a point, or
/// check_grid says that they do not.
TYPED_TEST(Contacts, OfTwoElementsAreTold) {
    using Grid = typename TypeParam::Grid;
    constexpr int dimension = Grid::dimension;
    std::mt19937 random(23);
    for (Grid& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        refine_at_random(grid, random, 2, 5 * TypeParam::steps, 3, 1000);
        const Leaves<dimension> leaves(grid);
        std::array<std::size_t, 2> seen{};
        const std::size_t count = leaves.coarse_count();
        for (std::size_t tried = 0; tried < 20000 && seen[0] + seen[1] < 400; ++tried) {
            const std::size_t i = random() % count;
            const std::size_t k = random() % count;
            const auto one = leaves.coarse(i);
            const auto other = leaves.coarse(k);
            const bool apart = norm(one.corners[0] - other.corners[0]) > 0.5;
            if (i == k || apart) continue;
            const bool loose =
                touches_loosely(one, other, dimension) || touches_loosely(other, one, dimension);
            ++seen[loose ? 1 : 0];
            const Leaves<dimension> two(leaves, {i, k});
            const auto violation = check_grid(two, two);
            ASSERT_EQ(violation.has_value(), loose)
                << (violation ? violation->sentence : "nothing is said of two elements");
            if (violation) {
                EXPECT_EQ(violation->law, Law::coarse_contact) << violation->sentence;
            }
        }
        EXPECT_GT(seen[0], 20U);
    }
}

/// Elements at given places, one id a place.
template <int dim>
class Placed {
public:
    using Element = std::size_t;
    static constexpr int dimension = dim;

    void add(Shape shape, const std::vector<Point>& corners) {
        CoarseElement<Element> e;
        e.element = elements_.size();
        e.shape = shape;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            e.corners[k] = corners[k];
            e.ids[k] = ids_.try_emplace(corners[k], ids_.size()).first->second;
        }
        const double volume = measure(shape, std::span(e.corners).first(corners.size()));
        if (dim == 3 && volume < 0) e.orientation = -1;
        elements_.push_back(e);
    }
    void add_cube(const Point& from, double size) {
        std::vector<Point> corners;
        for (const Point& x : topology(Shape::hexahedron).reference) {
            corners.push_back(from + size * x);
        }
        add(Shape::hexahedron, corners);
    }
    std::size_t coarse_count() const { return elements_.size(); }
    CoarseElement<Element> coarse(std::size_t i) const { return elements_[i]; }
    const Rule* split(Element) const { return nullptr; }
    void children(Element, std::span<Element> out) const { std::ranges::fill(out, 0); }

private:
    std::vector<CoarseElement<Element>> elements_;
    std::map<Point, std::uint64_t> ids_;
};

template <int dim>
std::string sentence_of(const Placed<dim>& grid) {
    const auto violation = check_grid(grid, ZeroField<Placed<dim>>{});
    return violation ? violation->sentence : "";
}

TEST(ContactCases, InAnEdgeOrAPointAreTold) {
    Placed<3> along_edge;
    along_edge.add_cube({0, 0, 0}, 1);
    along_edge.add_cube({1, 1, 0.5}, 1);
    EXPECT_EQ(sentence_of(along_edge),
              "node 7 of coarse element 0, at (1.000000, 1.000000, 1.000000), lies on face 0 of "
              "coarse element 1, which does not have it: they touch and share no node there");
    Placed<3> tip;
    tip.add_cube({0, 0, 0}, 1);
    tip.add(Shape::tetrahedron, {{0.5, 0.5, 1}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
    EXPECT_EQ(sentence_of(tip),
              "node 8 of coarse element 1, at (0.500000, 0.500000, 1.000000), lies on face 5 of "
              "coarse element 0, which does not have it: they touch and share no node there");
    Placed<3> crossed;
    crossed.add(Shape::tetrahedron, {{0, 0, 0}, {2, 0, 0}, {1, 1, -1}, {1, -1, -1}});
    crossed.add(Shape::tetrahedron, {{1, -1, 0}, {1, 1, 0}, {2, 0, 1}, {0, 0, 1}});
    EXPECT_EQ(sentence_of(crossed),
              "the edge 0-1 of coarse element 0 and the edge 4-5 of coarse element 1 cross at "
              "(1.000000, 0.000000, 0.000000): they touch and share no node there");
    Placed<2> flat;
    flat.add(Shape::triangle, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    flat.add(Shape::triangle, {{0.5, 0.5, 0}, {1, 0.7, 0}, {0.7, 1, 0}});
    EXPECT_EQ(sentence_of(flat),
              "node 3 of coarse element 1, at (0.500000, 0.500000, 0.000000), lies on face 0 of "
              "coarse element 0, which does not have it: they touch and share no node there");
}

TEST(ContactCases, InSharedEdgesAndPointsAreSound) {
    Placed<3> grid;
    grid.add_cube({0, 0, 0}, 1);
    grid.add_cube({1, 1, 0}, 1);
    grid.add_cube({-1, -1, -1}, 1);
    EXPECT_EQ(sentence_of(grid), "");
}

/// A node on a bilinear face, and one beside it.
TEST(ContactCases, WithCurvedFacesAreTold) {
    const std::vector<Point> warped{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1.8}};
    for (const bool touches : {true, false}) {
        Placed<3> grid;
        grid.add(Shape::hexahedron, warped);
        const double z = 1 + 0.8 * 0.25 * 0.5 + (touches ? 0 : 0.01);
        grid.add(Shape::tetrahedron, {{0.25, 0.5, z}, {0, 0, 3}, {1, 0, 3}, {0, 1, 3}});
        EXPECT_EQ(!sentence_of(grid).empty(), touches) << sentence_of(grid);
    }
}

TEST(ContactCases, OverlapsAreTold) {
    Placed<3> grid;
    grid.add_cube({0, 0, 0}, 1);
    grid.add_cube({0.3, 0.4, 0.4}, 1);
    EXPECT_EQ(
        sentence_of(grid),
        "the coarse elements 0 and 1 overlap: (0.500000, 0.500000, 0.500000) lies inside both");
    std::vector<std::string> notes;
    EXPECT_FALSE(check_grid(grid, ZeroField<Placed<3>>{}, {.contacts = true, .notes = &notes}));
    EXPECT_EQ(std::ranges::count_if(
                  notes, [](const std::string& note) { return note.find("overlap") != note.npos; }),
              1);
    Placed<2> folded;  // over their common edge
    folded.add(Shape::triangle, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    folded.add(Shape::triangle, {{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}});
    EXPECT_NE(sentence_of(folded).find("the coarse elements 0 and 1 overlap"), std::string::npos);
}

/// The first one is named, and all where they are allowed.
TEST(ContactCases, AreToldWithTheirPlace) {
    Leaves<3> cubes(OctreeGrid<3>(hexahedra(1)));
    std::vector<std::string> notes;
    EXPECT_FALSE(check_grid(cubes, cubes, {.notes = &notes}));
    for (const std::string& note : notes) {
        EXPECT_EQ(note.find("pieces"), std::string::npos) << note;
    }
    OctreeGrid<3> grid(hexahedra(2), {.balanced = false});
    grid.adapt([](const Leaf& leaf) {
        return leaf.centre()[0] + leaf.centre()[1] + leaf.centre()[2] < 1 ? Mark::refine
                                                                          : Mark::keep;
    });
    const Leaves<3> leaves(grid);
    const auto violation = check_grid(leaves, leaves);
    ASSERT_TRUE(violation);
    EXPECT_EQ(violation->sentence,
              "face 1 of coarse element 1 and face 0 of coarse element 8, around (0.500000, "
              "0.125000, 0.125000), touch in a part whose corners they do not share: what is drawn "
              "there is open");
    notes.clear();
    EXPECT_FALSE(check_grid(leaves, leaves, {.contacts = true, .notes = &notes}));
    EXPECT_EQ(std::count_if(notes.begin(), notes.end(),
                            [](const std::string& note) {
                                return note.find("touch in a part") != std::string::npos;
                            }),
              12);
}

}  // namespace contacts_test
