// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of block-structured data: closed whatever the boxes, planes without a crease, balls of
// second order.
#include "ball_at_wall.hpp"
#include "block_samples.hpp"
#include "closedness.hpp"

using namespace nestgrid_test;

namespace {

/// Isosurfaces of one field of random blocks, at a threshold each.
template <int dim>
int expect_closed_surfaces(const Blocks<dim>& blocks, unsigned seed) {
    const BlockGrid<dim> grid(blocks);
    const auto all = catching_fields(CellsOfBlocks<dim>(blocks).centres(), seed);
    const NodalSamples& samples = all[seed % all.size()];
    SCOPED_TRACE(samples.name + ", seed " + std::to_string(seed));
    const BlockData<dim> data(blocks, in_turn(samples.values), static_cast<int>(seed % 3));
    const CellRule rule = seed % 5 == 0 ? CellRule::sharp_means : CellRule::smooth;
    const BlockCells<dim, double> field(grid, data.arrays(), rule);
    const HierarchicalIndicator indicator(grid, field);
    int drawn = 0;
    for (const double threshold : {0.0, 0.01, 0.1, 0.5}) {
        const auto result = isosurface(grid, field, 0.0, under(indicator, threshold),
                                       {.cap = seed % 2 == 0, .verify = true});
        expect_closed(result.surface, seed % 2 == 0);
        ++drawn;
    }
    return drawn;
}

/// 2,000 in space, and half as many lines in the plane.
TEST(BlockSurfaces, AreClosedOnRandomBlocks) {
    int drawn = 0;
    for (unsigned seed = 1; drawn < 2000; ++seed) {
        drawn += expect_closed_surfaces(random_blocks<3>({.seed = seed,
                                                          .levels = 1 + static_cast<int>(seed % 4),
                                                          .side = 2 + static_cast<int>(seed % 3),
                                                          .rarity = seed % 4 == 3 ? 6U : 3U,
                                                          .ratios = {2, seed % 4 == 3 ? 2 : 4}}),
                                        seed);
        ASSERT_FALSE(HasFailure());
    }
    for (unsigned seed = 1; drawn < 3000; ++seed) {
        drawn += expect_closed_surfaces(
            random_blocks<2>({.seed = seed, .levels = 4, .side = 1 + static_cast<int>(seed % 6)}),
            seed);
        ASSERT_FALSE(HasFailure());
    }
}

/// Blocks of 4^dim cells, of which some are divided at random, down to a level: the leaves alone.
template <int dim>
Blocks<dim> random_leaf_blocks(unsigned seed, int levels) {
    std::mt19937 random(seed);
    Blocks<dim> blocks;
    blocks.spacing = {0.125, 0.125, 0.125};
    blocks.levels.resize(static_cast<std::size_t>(levels));
    const auto add = [&](const Cell<dim>& block, int level, const auto& again) -> void {
        const bool is_last = level + 1 == levels;
        if (!is_last && (level == 0 || random() % 4 == 0)) {
            for (unsigned k = 0; k < 1U << dim; ++k) {
                Cell<dim> child = block;
                for (std::size_t d = 0; d < child.size(); ++d) {
                    child[d] = 2 * child[d] + static_cast<int>(k >> d & 1U);
                }
                again(child, level + 1, again);
            }
            return;
        }
        BlockBox<dim> box;
        for (std::size_t d = 0; d < block.size(); ++d) {
            box.lower[d] = 4 * block[d];
            box.upper[d] = box.lower[d] + 3;
        }
        blocks.levels[static_cast<std::size_t>(level)].boxes.push_back(box);
    };
    for (unsigned k = 0; k < 1U << dim; ++k) {
        Cell<dim> root{};
        for (std::size_t d = 0; d < root.size(); ++d) root[d] = static_cast<int>(k >> d & 1U) - 1;
        add(root, 0, add);
    }
    for (auto& level : blocks.levels) level.ratio.fill(2);
    while (blocks.levels.back().boxes.empty()) blocks.levels.pop_back();
    return blocks;
}

/// As Athena++ stores them. The parents have no data.
template <int dim>
void expect_leaf_blocks_closed() {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const Blocks<dim> leaves = random_leaf_blocks<dim>(seed, 3);
        Blocks<dim> blocks = leaves;
        add_parents(blocks);
        Blocks<dim> again = blocks;
        add_parents(again);  // none is missing
        for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
            EXPECT_EQ(again.levels[l].boxes.size(), blocks.levels[l].boxes.size());
        }
        const BlockGrid<dim> grid(blocks);
        const BlockData<dim> all(blocks, [](const Point& x) { return norm(x) - 0.31; });
        BlockArrays<dim, double> arrays = all.arrays();
        std::size_t parents = 0;
        for (std::size_t l = 0; l < arrays.size(); ++l) {
            for (std::size_t b = leaves.levels[l].boxes.size(); b < arrays[l].size(); ++b) {
                arrays[l][b].first = nullptr;
                ++parents;
            }
        }
        EXPECT_GT(parents, 3U);
        const BlockCells<dim, double> field(grid, arrays);
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : {0.0, 0.02, 0.2}) {
            const auto surface =
                isosurface(grid, field, 0.0, under(indicator, threshold), {.verify = true}).surface;
            expect_closed(surface);
            EXPECT_GT(surface.simplices.size(), 0U);
        }
    }
}

TEST(BlockSurfaces, AreClosedWhereLeavesAloneAreStored) {
    expect_leaf_blocks_closed<2>();
    expect_leaf_blocks_closed<3>();
}

/// The unit cube, one half of which is finer by some ratios.
Blocks<3> half_refined(int n, const std::vector<int>& ratios) {
    Blocks<3> blocks;
    blocks.levels.push_back({{{{0, 0, 0}, {n - 1, n - 1, n - 1}}}, {}});
    blocks.spacing = {1.0 / n, 1.0 / n, 1.0 / n};
    for (const int ratio : ratios) {
        n *= ratio;
        blocks.levels.push_back({{{{0, 0, 0}, {n / 2 - 1, n - 1, n - 1}}}, {ratio, ratio, ratio}});
    }
    return blocks;
}

TEST(BlockSurfaces, OfPlanesHaveNoCrease) {
    const Point slope{0.3, 0.7, -0.4};
    const Point normal = (1 / norm(slope)) * slope;
    for (const std::vector<int>& ratios :
         {std::vector<int>{2}, std::vector<int>{4}, std::vector<int>{2, 4}}) {
        const Blocks<3> blocks = half_refined(8, ratios);
        const BlockGrid<3> grid(blocks);
        const BlockData<3> data(blocks, [&](const Point& x) { return dot(slope, x); });
        for (const CellRule rule : {CellRule::smooth, CellRule::sharp_means}) {
            const BlockCells<3, double> field(grid, data.arrays(), rule);
            const auto surface = isosurface(grid, field, 0.32).surface;
            ASSERT_GT(surface.simplices.size(), 100U);
            double crease = 0;  // degrees
            for (const auto& [a, b, c] : surface.simplices) {
                const Point& x = surface.vertices[a];
                const Point area = cross(surface.vertices[b] - x, surface.vertices[c] - x);
                ASSERT_NEAR(dot(x, slope), 0.32, 1e-14);
                if (norm(area) < 1e-8) continue;
                const double sine = norm(cross(normal, area)) / norm(area);
                crease = std::max(crease, std::asin(std::min(1.0, sine)) * 180 / std::acos(-1.0));
            }
            EXPECT_LT(crease, 0.005);
        }
    }
}

/// Relative errors of the area and of the volume of a ball that a wall cuts and a change of level
/// crosses, and the greatest distance of a vertex from the sphere.
std::array<double, 3> errors_of_ball(int n, int ratio, CellRule rule = CellRule::smooth) {
    const Blocks<3> blocks = half_refined(n, {ratio});
    const BlockGrid<3> grid(blocks);
    const BallAtWall ball;
    const BlockData<3> data(blocks, ball);
    const BlockCells<3, double> field(grid, data.arrays(), rule);
    return ball.errors_of(isosurface(grid, field, 0).surface);
}

TEST(BlockSurfaces, OfBallsAreOfSecondOrder) {
    for (const int ratio : {2, 4}) {
        const auto coarse = errors_of_ball(12, ratio);
        const auto fine = errors_of_ball(24, ratio);
        const auto sharp = errors_of_ball(12, ratio, CellRule::sharp_centres);
        for (std::size_t i = 0; i < 3; ++i) {
            SCOPED_TRACE(coarse[i]);
            EXPECT_LE(fine[i], coarse[i] / 3.2);
            EXPECT_LE(fine[i], 0.01);
            EXPECT_LE(sharp[i], coarse[i] / 1.3);
        }
    }
}

/// A function with its gradient, and a level of it inside the unit cube.
struct Smooth {
    std::string name;
    std::function<double(const Point&)> value;
    std::function<Point(const Point&)> gradient;
    double isovalue;
};

std::vector<Smooth> smooth_functions() {
    const Point middle{0.47, 0.52, 0.49};
    const auto s = [](double x) { return std::sin(6 * x); };
    const auto c = [](double x) { return std::cos(6 * x); };
    return {
        {"distance", [=](const Point& x) { return norm(x - middle); },
         [=](const Point& x) { return x - middle; }, 0.31},
        {"square", [=](const Point& x) { return dot(x - middle, x - middle); },
         [=](const Point& x) { return x - middle; }, 0.31 * 0.31},
        {"gyroid",
         [=](const Point& x) { return s(x[0]) * c(x[1]) + s(x[1]) * c(x[2]) + s(x[2]) * c(x[0]); },
         [=](const Point& x) {
             return Point{c(x[0]) * c(x[1]) - s(x[2]) * s(x[0]),
                          c(x[1]) * c(x[2]) - s(x[0]) * s(x[1]),
                          c(x[2]) * c(x[0]) - s(x[1]) * s(x[2])};
         },
         0.1}};
}

/// The means of a function over leaves, in the order of boxes.
std::vector<double> means_of(const Blocks<3>& blocks, const Smooth& f) {
    const CellsOfBlocks<3> cells(blocks);
    std::vector<double> means;
    for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
        for (const BlockBox<3>& box : blocks.levels[l].boxes) {
            for_each_cell(box, [&](const Cell<3>& cell) {
                if (!cells.is_leaf(l, cell)) return;
                const Point low = cells.at(l, cell, 0.5 - 0.5 / std::sqrt(3.0));  // Gauss' points
                const Point high = cells.at(l, cell, 0.5 + 0.5 / std::sqrt(3.0));
                double sum = 0;
                for (unsigned k = 0; k < 8; ++k) {
                    sum +=
                        f.value({((k & 1U) != 0 ? high : low)[0], ((k & 2U) != 0 ? high : low)[1],
                                 ((k & 4U) != 0 ? high : low)[2]});
                }
                means.push_back(sum / 8);
            });
        }
    }
    return means;
}

/// By how many degrees normals miss those of a function, root mean square: beside the change of
/// level, and among the coarse cells that are not beside it.
struct Missed {
    double at_change;
    double away;
};
Missed missed_by(const Surface<3>& surface, const Smooth& f, double cell) {
    std::array<double, 2> sum{};
    std::array<int, 2> count{};
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        const Point& x = surface.vertices[v];
        const bool at_wall =
            std::ranges::any_of(x, [&](double at) { return std::min(at, 1 - at) < 1.5 * cell; });
        const bool is_away = x[0] > 0.5 + 1.5 * cell;
        if (at_wall || (!is_away && x[0] < 0.5 - 1.5 * cell)) continue;
        const Point g = f.gradient(x);
        const double sine = norm(cross(surface.normals[v], g)) / norm(g);
        sum[is_away ? 1 : 0] += std::pow(std::asin(std::min(1.0, sine)) * 180 / std::acos(-1.0), 2);
        ++count[is_away ? 1 : 0];
    }
    EXPECT_GT(std::min(count[0], count[1]), 50);
    return {std::sqrt(sum[0] / count[0]), std::sqrt(sum[1] / count[1])};
}

Missed missed_by(const Smooth& f, int n, int ratio, CellRule rule) {
    const Blocks<3> blocks = half_refined(n, {ratio});
    const BlockGrid<3> grid(blocks);
    const std::vector<double> means = means_of(blocks, f);
    const BlockData<3> data(blocks, rule == CellRule::sharp_means ? in_turn(means) : f.value);
    const BlockCells<3, double> field(grid, data.arrays(), rule);
    const auto surface =
        isosurface(grid, field, f.isovalue, Projection{}, {.normals = true}).surface;
    return missed_by(surface, f, 1.0 / n);
}

/// Normals come from the data, not from what the rule makes of them: they miss by no more than 1.5
/// times as much where levels meet as elsewhere, and by the square of the size of cells.
TEST(BlockSurfaces, HaveNormalsAsGoodWhereLevelsMeet) {
    for (const Smooth& f : smooth_functions()) {
        for (const int ratio : {2, 4}) {
            for (const CellRule rule :
                 {CellRule::smooth, CellRule::sharp_centres, CellRule::sharp_means}) {
                SCOPED_TRACE(f.name + ", ratio " + std::to_string(ratio) + ", rule " +
                             std::to_string(static_cast<int>(rule)));
                const Missed coarse = missed_by(f, 12, ratio, rule);
                const Missed fine = missed_by(f, 24, ratio, rule);
                const double rounding = 0.04;  // normals are turned until they agree with triangles
                EXPECT_LE(coarse.at_change, 1.5 * coarse.away + rounding);
                EXPECT_LE(fine.at_change, 1.5 * fine.away + rounding);
                EXPECT_LE(fine.away, 0.3 * coarse.away + rounding);
                EXPECT_LE(fine.at_change, 0.1);
            }
        }
    }
}

/// A plane has one normal, at walls and where any levels meet.
TEST(BlockSurfaces, OfPlanesHaveOneNormal) {
    const Point slope{0.3, 0.7, -0.4};
    for (unsigned seed = 1; seed < 8; ++seed) {
        const Blocks<3> blocks = random_blocks<3>({.seed = seed, .side = 4});
        const BlockGrid<3> grid(blocks);
        const BlockData<3> data(blocks, [&](const Point& x) { return dot(slope, x); });
        const BlockCells<3, double> field(grid, data.arrays());
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : {0.0, 1e-9}) {
            const auto surface =
                isosurface(grid, field, 0.32, under(indicator, threshold), {.normals = true})
                    .surface;
            ASSERT_GT(surface.normals.size(), 3U);
            for (const Point& n : surface.normals) {
                ASSERT_LT(norm(n + (1 / norm(slope)) * slope), 1e-6);
            }
        }
    }
}

}  // namespace
