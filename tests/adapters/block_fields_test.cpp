// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fields on blocks: linear functions, agreement with CellAverages, any layout in memory.
#include <walk/for_each_element.hpp>
#include <walk/hanging_nodes.hpp>

#include "block_samples.hpp"
#include "solver_laws.hpp"

using namespace nestgrid_test;

namespace block_fields_test {

constexpr std::array rules{CellRule::smooth, CellRule::sharp_centres, CellRule::sharp_means};

/// What a field has at the corners of leaves, by their places.
template <int dim, class Field>
std::map<Point, double> values_of(const BlockGrid<dim>& grid, const Field& field) {
    using Real = typename Field::value_type;
    const auto hierarchy = erase(grid, field);
    const HangingNodes hanging = engine::find_hanging_nodes(hierarchy);
    const engine::Walk<Real> walk(hierarchy, {.keys = true, .positions = true}, &hanging);
    std::map<Point, double> values;
    std::array<Point, max_corners> x;
    engine::for_each_element(walk, false, [&](const auto& view, const engine::Split& split) {
        if (split.rule != nullptr) return;
        walk.corners(view, nullptr, x.data());
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            values[x[k]] = static_cast<double>(view.value[k]);
        }
    });
    return values;
}

template <int dim>
void expect_linear() {
    for (unsigned seed = 1; seed < 6; ++seed) {
        const Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .side = seed == 1 ? 2 : 4});
        const BlockGrid<dim> grid(blocks);
        const BlockData<dim> data(blocks, slanted<dim>);
        for (const CellRule rule : rules) {
            expect_linear_exact(grid, BlockCells<dim, double>(grid, data.arrays(), rule));
        }
        const BlockData<dim> nodal(blocks, slanted<dim>, 2, BlockCentring::nodes);
        expect_linear_exact(grid, BlockNodes<dim, double>(grid, nodal.arrays()));
    }
}

/// Data of cells at walls and where any levels meet, and data at nodes.
TEST(BlockFields, ReproduceLinearFunctions) {
    expect_linear<2>();
    expect_linear<3>();
}

template <int dim>
void expect_constants_and_ranges() {
    for (unsigned seed = 1; seed < 4; ++seed) {
        const Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .side = 3});
        const BlockGrid<dim> grid(blocks);
        const BlockData<dim> flat(blocks, [](const Point&) { return 0.1; });
        std::mt19937 random(seed);
        const BlockData<dim> noise(blocks, [&](const Point&) { return uniform(random); });
        for (const CellRule rule : rules) {
            for (const auto& [x, u] :
                 values_of(grid, BlockCells<dim, double>(grid, flat.arrays(), rule))) {
                ASSERT_EQ(u, 0.1);
            }
            for (const auto& [x, u] :
                 values_of(grid, BlockCells<dim, double>(grid, noise.arrays(), rule))) {
                bool is_inside = true;
                for (std::size_t d = 0; d < dim; ++d) {
                    is_inside = is_inside && x[d] > 0 && x[d] < 1;
                }
                ASSERT_GE(u, is_inside ? 0 : -1);
                ASSERT_LE(u, is_inside ? 1 : 2);
            }
        }
    }
}

/// Equal values give that value, to the last bit. Inside no value leaves the range, at walls by no
/// more than its length.
TEST(BlockFields, KeepConstantsAndRanges) {
    expect_constants_and_ranges<2>();
    expect_constants_and_ranges<3>();
}

template <int dim>
void expect_agreement() {
    for (unsigned seed = 1; seed < 4; ++seed) {
        const Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .side = 5});
        const BlockGrid<dim> grid(blocks);
        std::mt19937 random(seed);
        const BlockData<dim> data(blocks, [&](const Point&) { return uniform(random); });
        const BlockCells<dim, double> field(grid, data.arrays());
        const CellAverages averages(grid, [&](const auto& e) { return field.leaf_value(e); });
        const auto here = values_of(grid, field);
        const auto there = values_of(grid, averages);
        ASSERT_EQ(here.size(), there.size());
        std::size_t inside = 0;
        for (const auto& [x, u] : here) {
            bool is_inside = true;
            for (std::size_t d = 0; d < dim; ++d) is_inside = is_inside && x[d] > 0.2 && x[d] < 0.8;
            if (!is_inside) continue;
            ++inside;
            ASSERT_NEAR(u, there.at(x), 1e-13);
        }
        EXPECT_GT(inside, 10U);
    }
}

/// Where the domain does not end.
TEST(BlockFields, AgreeWithCellAverages) {
    expect_agreement<2>();
    expect_agreement<3>();
}

/// Where one level fills the middle, also for what is sharp.
TEST(BlockFields, ThatAreSharpAgreeWithCellAverages) {
    const Blocks<3> blocks = random_blocks<3>({.levels = 1, .side = 9});
    const BlockGrid<3> grid(blocks);
    std::mt19937 random(2);
    const BlockData<3> data(blocks, [&](const Point&) { return uniform(random); });
    for (const CellRule rule : rules) {
        const BlockCells<3, double> field(grid, data.arrays(), rule);
        const CellAverages averages(
            grid, [&](const auto& e) { return field.leaf_value(e); }, rule);
        const auto there = values_of(grid, averages);
        std::size_t inside = 0;
        for (const auto& [x, u] : values_of(grid, field)) {
            bool is_inside = true;
            for (const double at : x) is_inside = is_inside && at > 0.3 && at < 0.7;
            if (!is_inside) continue;
            ++inside;
            ASSERT_NEAR(u, there.at(x), 1e-13);
        }
        EXPECT_GE(inside, 64U);
    }
}

template <int dim>
void expect_gradients_by_key() {
    for (unsigned seed = 1; seed < 6; ++seed) {
        const Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .side = 4});
        const BlockGrid<dim> grid(blocks);
        std::mt19937 random(seed);
        const BlockData<dim> data(blocks, [&](const Point&) { return uniform(random); });
        for (const CellRule rule : rules) {
            const BlockCells<dim, double> field(grid, data.arrays(), rule);
            const auto hierarchy = erase(grid, field);
            ASSERT_TRUE(hierarchy.facts().gradients_by_key);
            const engine::Walk<double> walk(hierarchy, {.keys = true});
            engine::for_each_element(walk, false, [&](const auto& view, const engine::Split&) {
                std::array<NodeKey, max_corners> key;
                std::array<Point, max_corners> of_element;
                std::array<Point, max_corners> of_node;
                const std::size_t count = view.corner_count();
                walk.corners(view, key.data(), nullptr);
                walk.gradients(view, std::span(of_element).first(count));
                hierarchy.node_gradients(std::span(key).first(count), of_node);
                for (std::size_t k = 0; k < count; ++k) ASSERT_EQ(of_node[k], of_element[k]);
            });
        }
    }
}

/// Asked for by key, gradients have the bits of those of any element at the node.
TEST(BlockFields, HaveOneGradientAtANode) {
    expect_gradients_by_key<2>();
    expect_gradients_by_key<3>();
}

/// In a plane across an axis, places and gradients are those of the plane across z along other
/// axes.
TEST(BlockFields, LieInPlanesAcrossAnyAxis) {
    const Blocks<2> flat = random_blocks<2>({.seed = 3, .side = 4});
    std::mt19937 random(3);
    const BlockData<2> data(flat, [&](const Point&) { return uniform(random); });
    const auto drawn = [&](const Blocks<2>& blocks) {
        std::vector<Point> found;  // places and gradients of the corners of all elements
        const BlockGrid<2> grid(blocks);
        const BlockCells<2, double> field(grid, data.arrays());
        const auto hierarchy = erase(grid, field);
        const engine::Walk<double> walk(hierarchy, {.keys = true, .positions = true});
        engine::for_each_element(walk, false, [&](const auto& view, const engine::Split&) {
            std::array<Point, max_corners> places;
            std::array<Point, max_corners> gradients;
            walk.corners(view, nullptr, places.data());
            walk.gradients(view, std::span(gradients).first(view.corner_count()));
            found.insert(found.end(), places.begin(), places.begin() + 4);
            found.insert(found.end(), gradients.begin(), gradients.begin() + 4);
        });
        return found;
    };
    const std::vector<Point> expected = drawn(flat);
    ASSERT_GT(expected.size(), 100U);
    for (const std::array<int, 2> axes : {std::array{0, 2}, std::array{1, 2}}) {
        Blocks<2> turned = flat;
        turned.axes = axes;
        turned.origin = {0.3, 0.3, 0.3};
        for (std::size_t d = 0; d < 2; ++d) {
            turned.origin[static_cast<std::size_t>(axes[d])] = flat.origin[d];
        }
        const auto across = static_cast<std::size_t>(3 - axes[0] - axes[1]);
        const std::vector<Point> found = drawn(turned);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            for (std::size_t d = 0; d < 2; ++d) {
                ASSERT_EQ(found[i][static_cast<std::size_t>(axes[d])], expected[i][d]);
            }
            ASSERT_EQ(found[i][across], i / 4 % 2 == 0 ? 0.3 : 0.0);
        }
    }
    for (const std::array<int, 2> axes : {std::array{1, 0}, std::array{1, 1}, std::array{1, 3}}) {
        Blocks<2> wrong = flat;
        wrong.axes = axes;
        EXPECT_THROW(BlockGrid<2>{wrong}, InvalidInput);
    }
}

/// Boxes cut in other ways, with other ghosts, in another order, give the same values.
TEST(BlockFields, DoNotDependOnHowBoxesAreCut) {
    for (unsigned seed = 1; seed < 6; ++seed) {
        const Blocks<3> blocks = random_blocks<3>({.seed = seed, .side = 4});
        Blocks<3> other = blocks;
        std::mt19937 random(seed);
        for (std::size_t l = 0; l < other.levels.size(); ++l) {
            std::vector<BlockBox<3>> parts;
            for (const BlockBox<3>& box : blocks.levels[l].boxes) {
                cut(box, l == 0 ? 1 : other.levels[l].ratio[0], random, parts);
            }
            std::shuffle(parts.begin(), parts.end(), random);
            other.levels[l].boxes = parts;
        }
        const auto f = [](const Point& x) {
            return std::sin(91 * x[0]) + std::sin(73 * x[1]) * std::sin(57 * x[2]);
        };
        const BlockGrid<3> grid(blocks);
        const BlockGrid<3> other_grid(other);
        const BlockData<3> data(blocks, f, 0);
        const BlockData<3> other_data(other, f, 2);
        for (const CellRule rule : rules) {
            EXPECT_EQ(values_of(grid, BlockCells<3, double>(grid, data.arrays(), rule)),
                      values_of(other_grid,
                                BlockCells<3, double>(other_grid, other_data.arrays(), rule)));
        }
    }
}

/// Numbers one behind the other from the last cell to the first, not aligned, in single precision.
TEST(BlockFields, ReadAnyLayout) {
    Blocks<3> blocks;
    blocks.levels.push_back({{{{0, 0, 0}, {3, 4, 5}}}, {}});
    blocks.spacing = {0.25, 0.2, 1.0 / 6};
    const BlockGrid<3> grid(blocks);
    const auto f = [](const Point& x) { return x[0] + 10 * x[1] * x[2]; };
    const BlockData<3, float> data(blocks, f, 1);
    const CellsOfBlocks<3> cells(blocks);
    std::vector<std::byte> bytes(1 + 4UL * 5 * 6 * sizeof(float));
    std::ptrdiff_t at = 1;
    Cell<3> c{};
    for (c[0] = 3; c[0] >= 0; --c[0]) {
        for (c[1] = 0; c[1] < 5; ++c[1]) {
            for (c[2] = 5; c[2] >= 0; --c[2]) {
                const auto value = static_cast<float>(f(cells.centre(0, c)));
                std::memcpy(bytes.data() + at, &value, sizeof(value));
                at += sizeof(value);
            }
        }
    }
    const BlockArray<3, float> array{bytes.data() + 1 + 4UL * (3UL * 30 + 5),
                                     {-4L * 30, 4L * 6, -4L}};
    EXPECT_EQ(values_of(grid, BlockCells<3, float>(grid, data.arrays())),
              values_of(grid, BlockCells<3, float>(grid, {{array}})));
}

/// A node has the value of the finest box that has it.
TEST(BlockFields, OfNodesComeFromTheFinestBox) {
    for (unsigned seed = 1; seed < 4; ++seed) {
        const Blocks<2> blocks = random_blocks<2>({.seed = seed, .side = 4});
        const BlockGrid<2> grid(blocks);
        std::size_t level = 0;
        std::map<Point, double> expected;
        const CellsOfBlocks<2> cells(blocks);
        for (level = 0; level < blocks.levels.size(); ++level) {
            for (BlockBox<2> box : blocks.levels[level].boxes) {
                for (int& last : box.upper) ++last;
                for_each_cell(box, [&](const Cell<2>& c) {
                    expected[cells.at(level, c, 0)] = static_cast<double>(level);
                });
            }
        }
        std::vector<double> in_order;
        for (level = 0; level < blocks.levels.size(); ++level) {
            for (BlockBox<2> box : blocks.levels[level].boxes) {
                for (int& last : box.upper) ++last;
                for_each_cell(
                    box, [&](const Cell<2>&) { in_order.push_back(static_cast<double>(level)); });
            }
        }
        const BlockData<2> data(blocks, in_turn(in_order), 1, BlockCentring::nodes);
        const BlockNodes<2, double> field(grid, data.arrays());
        // As the field gives them: the walk would put interpolants at hanging nodes.
        const auto look = [&](const auto& e, const auto& again) -> void {
            const Rule* rule = grid.split(e);
            if (rule == nullptr) return;
            std::array<double, 5> values{};
            EXPECT_EQ(field.new_values(e, 31, values), 0U);
            std::array<BlockGrid<2>::Element, 4> children;
            grid.children(e, children);
            for (std::size_t n = 0; n < 5; ++n) {
                std::array<Point, 4> x;
                grid.corner_positions(children[rule->new_corner[n].child], x);
                EXPECT_EQ(values[n], expected.at(x[rule->new_corner[n].corner]));
            }
            for (const auto& child : children) again(child, again);
        };
        for (std::size_t i = 0; i < grid.coarse_count(); ++i) look(grid.coarse(i).element, look);
    }
}

}  // namespace block_fields_test
