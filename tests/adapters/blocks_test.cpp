// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Block-structured grids: the contract, keys and hanging nodes that follow from boxes, and all that
// is refused.
#include <nestgrid/check_grid.hpp>
#include <walk/for_each_element.hpp>

#include "block_samples.hpp"
#include "changed_laws.hpp"
#include "probe_laws.hpp"
#include "refusal_rows.hpp"
#include "solver_laws.hpp"

using namespace nestgrid_test;

namespace {

static_assert(NestedGrid<BlockGrid<2>> && NestedGrid<BlockGrid<3>>);
static_assert(std::is_trivially_copyable_v<BlockGrid<3>::Element>);
static_assert(sizeof(BlockGrid<3>::Element) <= 24);

/// Calls f(blocks) for random ones: many and few boxes, domains that cannot be halved and others.
template <int dim, class Function>
void for_some_blocks(Function&& f) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::array<int, 6> sides{4, 8, 6, 3, 5, 1};
        f(random_blocks<dim>({.seed = seed,
                              .levels = 2 + static_cast<int>(seed % 3),
                              .side = sides[seed - 1],
                              .rarity = seed == 6 ? 1U : 3U}));
    }
}

/// Without keys and hanging nodes, which the library derives.
template <int dim>
class PlainGrid {
public:
    using Element = typename BlockGrid<dim>::Element;
    static constexpr int dimension = dim;
    explicit PlainGrid(const BlockGrid<dim>& grid) : grid_{&grid} {}
    std::size_t coarse_count() const { return grid_->coarse_count(); }
    CoarseElement<Element> coarse(std::size_t i) const { return grid_->coarse(i); }
    const Rule* split(const Element& e) const { return grid_->split(e); }
    void children(const Element& e, std::span<Element> out) const { grid_->children(e, out); }
    void corner_positions(const Element& e, std::span<Point> out) const {
        grid_->corner_positions(e, out);
    }

private:
    const BlockGrid<dim>* grid_;
};

template <int dim>
void expect_contract() {
    for_some_blocks<dim>([](const Blocks<dim>& blocks) {
        const BlockGrid<dim> grid(blocks);
        std::mt19937 random(3);
        const BlockData<dim> data(blocks, [&](const Point&) { return uniform(random) - 0.5; });
        const BlockCells<dim, double> field(grid, data.arrays());
        std::vector<std::string> notes;
        expect_sound_grid(grid, field, {.hanging_values = true, .notes = &notes});
        std::string all;
        for (const std::string& note : notes) all += note + "\n";
        for (const char* operation : {"node_count", "constrained", "corner_positions"}) {
            EXPECT_NE(all.find(operation), std::string::npos) << all;
        }
        if (blocks.levels.size() > 2) return;
        expect_sound_grid(grid, BlockCells<dim, double>(grid, data.arrays(), CellRule::sharp_means),
                          {.hanging_values = true});
    });
}

TEST(Blocks, KeepTheContract) {
    expect_contract<2>();
    expect_contract<3>();
}

/// What follows from boxes is what the library derives from the elements.
template <int dim>
void expect_derived_hanging_nodes() {
    for_some_blocks<dim>([](const Blocks<dim>& blocks) {
        const BlockGrid<dim> grid(blocks);
        const PlainGrid<dim> plain(grid);
        std::mt19937 random(4);
        const BlockData<dim> data(blocks, [&](const Point&) { return uniform(random) - 0.5; });
        const BlockCells<dim, double> field(grid, data.arrays());
        const HierarchicalIndicator own(grid, field);
        const HierarchicalIndicator derived(plain, field);
        for (const double threshold : six_thresholds) {
            const auto a =
                isosurface(grid, field, 0.0, under(own, threshold), {.verify = true}).surface;
            const auto b =
                isosurface(plain, field, 0.0, under(derived, threshold), {.verify = true}).surface;
            ASSERT_EQ(a.vertices, b.vertices);
            ASSERT_EQ(a.simplices, b.simplices);
        }
    });
}

TEST(Blocks, KnowTheirHangingNodes) {
    expect_derived_hanging_nodes<2>();
    expect_derived_hanging_nodes<3>();
}

template <int dim>
void expect_cells() {
    for_some_blocks<dim>([](const Blocks<dim>& blocks) {
        const BlockGrid<dim> grid(blocks);
        const CellsOfBlocks<dim> cells(blocks);
        const auto hierarchy = erase(grid, ZeroField<BlockGrid<dim>>{});
        std::multiset<Point> centres;
        std::set<Point> nodes;
        const engine::Walk<float> walk(hierarchy, {.positions = true});
        engine::for_each_element(walk, false, [&](const auto& view, const engine::Split& split) {
            if (split.rule != nullptr) return;
            std::array<Point, max_corners> x;
            walk.corners(view, nullptr, x.data());
            centres.insert(0.5 * (x[0] + x[(std::size_t{1} << dim) - 1]));
            nodes.insert(x.begin(), x.begin() + (1 << dim));
        });
        EXPECT_EQ(grid.used_node_count(), nodes.size());
        std::multiset<Point> expected;
        for (const Point& x : cells.centres()) expected.insert(x);
        ASSERT_EQ(centres.size(), expected.size());
        EXPECT_EQ(grid.leaf_count(), expected.size());
        double off = 0;
        for (auto a = centres.begin(), b = expected.begin(); a != centres.end(); ++a, ++b) {
            off = std::max(off, norm(*a - *b));
        }
        EXPECT_LT(off, 1e-12);
    });
}

/// The leaves of the hierarchy are the cells that no finer box covers.
TEST(Blocks, AreTheLeavesOfTheHierarchy) {
    expect_cells<2>();
    expect_cells<3>();
}

template <int dim>
void expect_laws() {
    for (unsigned seed = 1; seed < 4; ++seed) {
        const Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .side = 4});
        const BlockGrid<dim> grid(blocks);
        const std::vector<Point> centres = CellsOfBlocks<dim>(blocks).centres();
        for (const NodalSamples& samples : catching_fields(centres, seed)) {
            SCOPED_TRACE(samples.name);
            const BlockData<dim> data(blocks, in_turn(samples.values));
            const BlockCells<dim, double> field(grid, data.arrays());
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : six_thresholds) {
                expect_closed_level(grid, field, 0.0, indicator, threshold);
            }
        }
    }
}

/// Surfaces, slices, boundaries, height fields, isolines.
TEST(Blocks, KeepTheLawsOfSolvers) {
    expect_laws<2>();
    expect_laws<3>();
}

template <int dim>
void expect_probed() {
    for_some_blocks<dim>([](const Blocks<dim>& blocks) {
        const BlockGrid<dim> grid(blocks);
        if (grid.finest_size()[0] < 4) return;
        const BlockData<dim> data(blocks, LinearField<BlockGrid<dim>>::at);
        expect_no_point_lost(grid, BlockCells<dim, double>(grid, data.arrays()), 500, 1);
    });
}

TEST(Blocks, LoseNoPoint) {
    expect_probed<2>();
    expect_probed<3>();
}

TEST(Blocks, RefuseWhatWasMadeForOtherBoxes) {
    const Blocks<3> before = random_blocks<3>({.seed = 1, .side = 4});
    const Blocks<3> after = random_blocks<3>({.seed = 2, .side = 4});
    const BlockData<3> data_before(before, [](const Point& x) { return x[0] - 0.4 * x[1]; });
    const BlockData<3> data_after(after, [](const Point& x) { return x[0] - 0.4 * x[1]; });
    const BlockGrid<3> grid(before);
    const BlockCells<3, double> field(grid, data_before.arrays());
    expect_usable(grid, field);
    const HierarchicalIndicator indicator(grid, field);
    const BlockGrid<3> other(after);
    const BlockCells<3, double> other_field(other, data_after.arrays());
    EXPECT_EQ(BlockGrid<3>(before).epoch(), grid.epoch());
    expect_changed("indicator", [&] { isosurface(other, other_field, 0.1, under(indicator, 0)); });
}

/// Two levels, the second of two boxes.
Blocks<3> two_levels() {
    Blocks<3> blocks;
    blocks.levels.push_back({{{{0, 0, 0}, {3, 7, 7}}, {{4, 0, 0}, {7, 7, 7}}}, {}});
    blocks.levels.push_back({{{{4, 4, 4}, {7, 7, 7}}, {{8, 4, 4}, {11, 7, 7}}}, {2, 2, 2}});
    return blocks;
}

TEST(Blocks, SayWhatIsWrong) {
    RefusalRows rows("blocks");
    const auto add = [&](const std::string& state, const std::function<void(Blocks<3>&)>& spoil) {
        Blocks<3> blocks = two_levels();
        spoil(blocks);
        rows.add(state, [&] { BlockGrid<3>{blocks}; });
    };
    add("no levels", [](auto& b) { b.levels.clear(); });
    add("a level without boxes", [](auto& b) { b.levels[1].boxes.clear(); });
    add("an empty box", [](auto& b) { b.levels[1].boxes[1].upper[0] = 7; });
    add("boxes of one level that overlap", [](auto& b) { b.levels[1].boxes[1].lower[0] = 6; });
    add("level 0 with holes", [](auto& b) { b.levels[0].boxes[1].upper[2] = 6; });
    add("a box outside the domain", [](auto& b) { b.levels[1].boxes[1].upper[0] = 17; });
    add("a box that is not within the level before", [](auto& b) {
        b.levels.push_back({{{{6, 8, 8}, {15, 15, 15}}}, {2, 2, 2}});
    });
    add("a box that is not aligned", [](auto& b) { b.levels[1].boxes[0].lower[1] = 5; });
    add("a ratio that is no power of two", [](auto& b) { b.levels[1].ratio = {3, 3, 3}; });
    add("ratios that differ by direction", [](auto& b) { b.levels[1].ratio = {2, 2, 4}; });
    add("too many cells along a side", [](auto& b) { b.levels[1].ratio.fill(1 << 30); });
    add("cells without an extent", [](auto& b) { b.spacing[2] = 0; });
    const Blocks<3> good = two_levels();
    const BlockGrid<3> grid(good);
    const BlockData<3> data(good, [](const Point& x) { return x[0]; });
    const auto add_arrays = [&](const std::string& state,
                                const std::function<void(BlockArrays<3, double>&)>& spoil) {
        BlockArrays<3, double> arrays = data.arrays();
        spoil(arrays);
        rows.add(state, [&] { BlockCells<3, double>(grid, arrays); });
    };
    add_arrays("arrays of fewer levels", [](auto& a) { a.pop_back(); });
    add_arrays("fewer arrays than boxes", [](auto& a) { a[1].pop_back(); });
    add_arrays("a stride in numbers, not in bytes", [](auto& a) { a[1][0].stride[0] = 1; });
    rows.add("an array of another size",
             [&] { block_array(good.levels[0].boxes[0], std::span<const double>(), 1); });
    rows.add<GridError>("an array that is not here, where it is needed", [&] {
        BlockArrays<3, double> arrays = data.arrays();
        arrays[1][1].first = nullptr;
        isosurface(grid, BlockCells<3, double>(grid, arrays), 0.55);
    });
    rows.add("leaves that are no blocks of one size", [] {
        Blocks<3> blocks = two_levels();
        add_parents(blocks);
    });
    rows.add("leaves that replace a block in part", [] {
        Blocks<3> blocks = two_levels();
        blocks.levels[0].boxes.clear();
        blocks.levels[1].boxes = {{{0, 0, 0}, {3, 3, 3}}};
        add_parents(blocks);
    });
}

/// Leaves out a box, so that the others do not fill the hull that they have still.
template <int dim>
bool leave_out_of_hull(BlockLevel<dim>& level, std::mt19937& random) {
    const auto hull = [&] {
        std::array<Cell<dim>, 2> ends{level.boxes[0].lower, level.boxes[0].upper};
        for (const BlockBox<dim>& box : level.boxes) {
            for (std::size_t d = 0; d < ends[0].size(); ++d) {
                ends[0][d] = std::min(ends[0][d], box.lower[d]);
                ends[1][d] = std::max(ends[1][d], box.upper[d]);
            }
        }
        return ends;
    };
    const auto before = hull();
    level.boxes.erase(level.boxes.begin() +
                      static_cast<std::ptrdiff_t>(random() % level.boxes.size()));
    return !level.boxes.empty() && hull() == before;
}

/// Leaves out a box, and answers whether the next level had boxes within it.
template <int dim>
bool leave_out_below(Blocks<dim>& blocks, std::size_t l, std::size_t b) {
    std::vector<BlockBox<dim>>& boxes = blocks.levels[l].boxes;
    const BlockBox<dim> box = boxes[b];
    boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
    const CellsOfBlocks<dim> cells(blocks);
    bool needed = false;
    for_each_cell(box, [&](const Cell<dim>& c) { needed = needed || !cells.is_leaf(l, c); });
    return needed;
}

/// What each kind of mistake does to good blocks. Returns whether they had a place for it.
template <int dim>
bool spoil(Blocks<dim>& blocks, unsigned kind, std::mt19937& random) {
    const std::size_t l = random() % blocks.levels.size();
    BlockLevel<dim>& level = blocks.levels[l];
    const std::size_t b = random() % level.boxes.size();
    const std::size_t d = random() % static_cast<std::size_t>(dim);
    BlockBox<dim>& box = level.boxes[b];
    switch (kind) {
        case 0:  // overlaps
            level.boxes.push_back(box);
            return true;
        case 1:  // holes
            return leave_out_of_hull(blocks.levels[0], random);
        case 2:  // not within the level before
            if (l == 0 || l + 1 == blocks.levels.size()) return false;
            return leave_out_below(blocks, l, b);
        case 3:  // no power of two
            if (l == 0) return false;
            level.ratio.fill(static_cast<int>(random() % 3) * 2 + 3);
            return true;
        case 4:  // differ by direction
            if (l == 0) return false;
            level.ratio[d] *= 2;
            return true;
        case 5:  // empty
            box.upper[d] = box.lower[d] - 1 - static_cast<int>(random() % 3);
            return true;
        default:  // not aligned
            if (l == 0 || box.upper[d] == box.lower[d]) return false;
            ++box.lower[d];
            return true;
    }
}

template <int dim>
void expect_refused_kinds() {
    std::array<int, 7> tried{};
    std::array<int, 7> refused{};
    for (unsigned seed = 1; std::ranges::min(tried) < 72; ++seed) {
        std::mt19937 random(seed);
        Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .levels = 4, .side = 4});
        if (seed % 10 == 0) {
            EXPECT_NO_THROW(BlockGrid<dim>{blocks});
        }
        const unsigned kind = seed % 7;
        if (!spoil(blocks, kind, random)) continue;
        ++tried[kind];
        const std::string sentence = refusal([&] { BlockGrid<dim>{blocks}; });
        const bool names = sentence.find("level") != std::string::npos;
        refused[kind] += names ? 1 : 0;
    }
    EXPECT_EQ(refused, tried);
}

/// More than 1,000 of them.
TEST(Blocks, RefuseEveryKindOfMistake) {
    expect_refused_kinds<2>();
    expect_refused_kinds<3>();
}

}  // namespace
