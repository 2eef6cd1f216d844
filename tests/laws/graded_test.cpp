// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rules that cut edges at other places than the middle, as grids do that are graded towards a wall:
// such grids are sound, their surfaces closed at every threshold, and a linear function is its own
// interpolant.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/rule_table.hpp>

#include "closedness.hpp"
#include "forest.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace graded_test {

/// Where the reference element is cut along each axis; 0 where it is not.
using Cuts = std::array<double, 3>;

/// Boxes between the cuts.
std::vector<PlacedChild> cut_boxes(Shape shape, const Cuts& cuts) {
    const Topology& t = topology(shape);
    std::vector<PlacedChild> children;
    for (std::size_t c = 0; c < t.corners; ++c) {
        PlacedChild child{shape, {}};
        bool is_there = true;
        for (std::size_t d = 0; d < 3; ++d) {
            const bool upper = t.reference[c][d] == 1;
            is_there = is_there && !(upper && cuts[d] == 0);
            const double low = upper ? cuts[d] : 0;
            const double high = upper || cuts[d] == 0 ? 1 : cuts[d];
            for (std::size_t i = 0; i < t.corners; ++i) {
                child.corners[i][d] = t.reference[i][d] == 0 ? low : high;
            }
        }
        if (shape == Shape::quadrilateral) {
            for (Point& x : child.corners) x[2] = 0;
        }
        if (is_there) children.push_back(child);
    }
    return children;
}

/// The triangle in four, the segment cut at a height.
std::vector<PlacedChild> cut_prism(double height) {
    const Rule& rule = prism_rule(PrismSplit::isotropic);
    const std::vector<Point> x = reference_nodes(rule);
    std::vector<PlacedChild> children;
    for (const Child& child : rule.children) {
        PlacedChild& placed = children.emplace_back(PlacedChild{Shape::prism, {}});
        for (std::size_t i = 0; i < 6; ++i) {
            placed.corners[i] = x[child.corner[i]];
            if (placed.corners[i][2] == 0.5) placed.corners[i][2] = height;
        }
    }
    return children;
}

/// Elements that are all affine images of their reference element, refined by one rule each. A node
/// hangs where it lies in a leaf and is no corner of it.
template <int dim>
class GradedGrid : public Forest<dim> {
public:
    using Element = typename Forest<dim>::Element;

    NodeMask constrained(Element e) const {
        const auto& cell = this->cells[e];
        const std::size_t corners = topology(cell.shape).corners;
        NodeMask mask = 0;
        for (std::size_t n = 0; corners + n < cell.nodes.size(); ++n) {
            mask |= NodeMask{hanging_.contains(cell.nodes[corners + n])} << n;
        }
        return mask;
    }

    void refine_randomly(const Rule& rule, std::mt19937& random, std::size_t steps) {
        for (std::size_t i = 0; i < steps; ++i) {
            const auto e = static_cast<Element>(random() % this->cells.size());
            if (this->cells[e].rule == nullptr) this->refine(e, rule);
        }
        for (const auto& cell : this->cells) {
            if (cell.rule == nullptr) find_hanging(cell);
        }
    }
    std::size_t hanging_count() const { return hanging_.size(); }

private:
    void find_hanging(const typename Forest<dim>::Cell& leaf) {
        const Topology& t = topology(leaf.shape);
        const Point origin = this->positions[leaf.nodes[0]];
        std::array<Point, 3> axis{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        for (std::size_t i = 1; i < t.corners; ++i) {
            for (std::size_t d = 0; d < 3; ++d) {
                Point unit{0, 0, 0};
                unit[d] = 1;
                if (t.reference[i] == unit) axis[d] = this->positions[leaf.nodes[i]] - origin;
            }
        }
        const double volume = dot(axis[0], cross(axis[1], axis[2]));
        for (std::uint32_t n = 0; n < this->positions.size(); ++n) {
            if (std::find(leaf.nodes.begin(), leaf.nodes.end(), n) != leaf.nodes.end()) continue;
            const Point x = this->positions[n] - origin;
            const Point at{dot(x, cross(axis[1], axis[2])) / volume,
                           dot(x, cross(axis[2], axis[0])) / volume,
                           dot(x, cross(axis[0], axis[1])) / volume};
            const double greatest =
                std::max({at[0], at[1], at[2], leaf.shape == Shape::prism ? at[0] + at[1] : 0});
            if (std::min({at[0], at[1], at[2]}) > -1e-9 && greatest < 1 + 1e-9) hanging_.insert(n);
        }
    }

    std::set<std::uint32_t> hanging_;
};

/// n^dim boxes over the unit square or cube, each perhaps cut into two prisms.
template <int dim>
GradedGrid<dim> coarse_grid(bool prisms, std::uint32_t n) {
    GradedGrid<dim> grid;
    const std::uint32_t layers = dim == 3 ? n : 0;
    for (std::uint32_t z = 0; z <= layers; ++z) {
        for (std::uint32_t y = 0; y <= n; ++y) {
            for (std::uint32_t x = 0; x <= n; ++x) {
                grid.add_node({double(x) / n, double(y) / n, double(z) / n});
            }
        }
    }
    for (std::uint32_t z = 0; z < std::max(layers, 1U); ++z) {
        for (std::uint32_t y = 0; y < n; ++y) {
            for (std::uint32_t x = 0; x < n; ++x) {
                std::vector<std::uint32_t> v;
                for (std::uint32_t c = 0; c < 1U << dim; ++c) {
                    v.push_back(x + (c & 1U) +
                                (n + 1) * (y + (c >> 1U & 1U) + (n + 1) * (z + (c >> 2U))));
                }
                if (prisms) {
                    grid.add_coarse(Shape::prism, {v[0], v[1], v[2], v[4], v[5], v[6]}, 1);
                    grid.add_coarse(Shape::prism, {v[3], v[2], v[1], v[7], v[6], v[5]}, 1);
                } else {
                    grid.add_coarse(dim == 3 ? Shape::hexahedron : Shape::quadrilateral, v, 1);
                }
            }
        }
    }
    return grid;
}

struct Grading {
    std::string name;
    Shape shape;
    std::vector<PlacedChild> children;
    const Rule* rule;
};

/// In layers, towards a wall below, and towards a corner.
template <int dim>
std::vector<Grading> gradings() {
    static RuleTable table;
    const auto make = [&](std::string name, Shape shape, std::vector<PlacedChild> children,
                          std::initializer_list<Axes> steps) {
        const Rule& rule = table.add(shape, children, in_steps(shape, steps));
        return Grading{std::move(name), shape, std::move(children), &rule};
    };
    if constexpr (dim == 2) {
        const Shape shape = Shape::quadrilateral;
        return {make("layers", shape, cut_boxes(shape, {0, 0.25, 0}), {axis_y}),
                make("a wall", shape, cut_boxes(shape, {0.5, 1.0 / 3, 0}), {axis_x, axis_y}),
                make("a corner", shape, cut_boxes(shape, {0.3, 0.4, 0}), {axis_y, axis_x})};
    } else {
        const Shape shape = Shape::hexahedron;
        return {
            make("layers", shape, cut_boxes(shape, {0, 0, 0.25}), {axis_z}),
            make("a wall", shape, cut_boxes(shape, {0.5, 0.5, 1.0 / 3}), {axis_x | axis_y, axis_z}),
            make("a corner", shape, cut_boxes(shape, {0.3, 0.4, 0.8}), {axis_z, axis_x, axis_y}),
            make("a wall below prisms", Shape::prism, cut_prism(1.0 / 3),
                 {axis_x | axis_y, axis_z})};
    }
}

template <int dim>
void expect_cut_as_told() {
    for (const Grading& grading : gradings<dim>()) {
        const std::vector<Point> x = reference_nodes(*grading.rule);
        for (std::size_t c = 0; c < grading.children.size(); ++c) {
            for (std::size_t i = 0; i < topology(grading.shape).corners; ++i) {
                const Point& told = grading.children[c].corners[i];
                EXPECT_LT(norm(x[grading.rule->children[c].corner[i]] - told), 1e-15)
                    << grading.name;
            }
        }
    }
}

TEST(Graded, RulesCutWhereTheyAreTold) {
    expect_cut_as_told<2>();
    expect_cut_as_told<3>();
}

/// Calls test(grid) on random grids of every grading, hanging nodes and level jumps included.
template <int dim, class Test>
void on_graded_grids(Test&& test) {
    for (const Grading& grading : gradings<dim>()) {
        for (unsigned seed = 0; seed < 6; ++seed) {
            SCOPED_TRACE(grading.name + ", seed " + std::to_string(seed));
            std::mt19937 random(seed);
            GradedGrid<dim> grid = coarse_grid<dim>(grading.shape == Shape::prism, 1 + seed % 2);
            grid.refine_randomly(*grading.rule, random, 20 + 20 * seed);
            test(grid);
        }
    }
}

template <int dim>
void expect_closed_surfaces() {
    std::size_t hanging = 0;
    on_graded_grids<dim>([&](const GradedGrid<dim>& grid) {
        hanging += grid.hanging_count();
        ForestField<dim> field(grid, [](const Point&) { return 0.0; });
        for (const NodalSamples& samples : catching_fields(grid.positions, 21)) {
            field.values = samples.values;
            const auto violation = check_grid(grid, field);
            ASSERT_FALSE(violation) << violation->sentence;
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : six_thresholds) {
                SCOPED_TRACE(samples.name + " at threshold " + std::to_string(threshold));
                expect_closed(isosurface(grid, field, 0.0, under(indicator, threshold)).surface);
            }
        }
    });
    EXPECT_GT(hanging, 100U);
}

TEST(Graded, SurfacesAreClosedInTwoDimensions) { expect_closed_surfaces<2>(); }
TEST(Graded, SurfacesAreClosedInThreeDimensions) { expect_closed_surfaces<3>(); }

/// Offsets are differences from the weighted interpolant, so a linear function has none: at any
/// threshold above rounding its surface is that of the coarse grid.
template <int dim>
void expect_linear_functions_kept() {
    on_graded_grids<dim>([](const GradedGrid<dim>& grid) {
        const auto f = [](const Point& x) { return x[0] + 2 * x[1] - 3 * x[2] - 0.2371; };
        const ForestField<dim> field(grid, f);
        const HierarchicalIndicator indicator(grid, field);
        const auto surface = [&](double threshold) {
            auto result = isosurface(grid, field, 0.0, under(indicator, threshold));
            EXPECT_GT(result.surface.simplices.size(), 0U);
            EXPECT_LE(result.error_bound, 1e-14);
            for (const Point& x : result.surface.vertices) EXPECT_NEAR(f(x), 0, 1e-13);
            return result.surface.simplices.size();
        };
        const std::size_t coarse =
            isosurface(grid, field, 0.0, under(indicator, 100)).surface.simplices.size();
        EXPECT_EQ(surface(1e-12), coarse);
        surface(0);
    });
}

TEST(Graded, LinearFunctionsHaveNoOffsets) {
    expect_linear_functions_kept<2>();
    expect_linear_functions_kept<3>();
}

/// An element divided into n equal parts along each axis, by one rule without steps.
const Rule& divided_by(int n) {
    const auto make = [](int parts) {
        std::vector<PlacedChild> children;
        for (int j = 0; j < parts; ++j) {
            for (int i = 0; i < parts; ++i) {
                PlacedChild child{Shape::quadrilateral, {}};
                for (std::size_t k = 0; k < 4; ++k) {
                    child.corners[k] = {double(i + int(k & 1U)) / parts,
                                        double(j + int(k >> 1U)) / parts, 0};
                }
                children.push_back(child);
            }
        }
        static RuleTable table;
        return &table.add(Shape::quadrilateral, children);
    };
    static const std::array<const Rule*, 2> rules{make(3), make(4)};
    return *rules.at(static_cast<std::size_t>(n - 3));
}

/// Where nodes hang at weighted means and the grid does not say so, nothing is drawn; where none
/// hang, everything is.
template <int dim>
void expect_refused_untold(const GradedGrid<dim>& grid) {
    const Forest<dim>& untold = grid;
    const ForestField<dim> field(grid, [](const Point& x) { return x[0] + x[1] - 0.7; });
    const std::string sentence = refusal<GridError>(
        [&] { isosurface(untold, field, 0.0, under(HierarchicalIndicator(untold, field), 0)); });
    EXPECT_EQ(sentence.find("operation constrained") != std::string::npos, grid.hanging_count() > 0)
        << sentence;
    EXPECT_EQ(check_grid(untold, field).has_value(), grid.hanging_count() > 0);
}

TEST(Graded, NodesThatHangAtWeightsMustBeTold) {
    on_graded_grids<2>(expect_refused_untold<2>);
    on_graded_grids<3>(expect_refused_untold<3>);
    for (const int parts : {3, 4}) {
        for (unsigned seed = 0; seed < 24; ++seed) {
            std::mt19937 random(seed);
            GradedGrid<2> grid = coarse_grid<2>(false, 2);
            grid.refine_randomly(divided_by(parts), random, seed % 8);
            expect_refused_untold(grid);
            const ForestField<2> field(grid, [](const Point& x) { return x[0] * x[1] - 0.2; });
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : {0.0, 0.05, 0.2}) {
                expect_closed(isosurface(grid, field, 0.0, under(indicator, threshold)).surface);
            }
        }
    }
}

}  // namespace graded_test
