// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A crack is no boundary: where coarse elements touch without sharing the nodes of what they have
// in common, check_grid says so, and what is drawn there is open. The coarse grids are the leaves
// of all families, which touch in parts of faces wherever a node hangs.
#include <cmath>
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
