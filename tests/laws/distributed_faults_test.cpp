// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One rank that fails, or asks for something else, in any step: all ranks end with one sentence
// that names it, and none waits for a message that never comes.
#include <optional>

#include <nestgrid/algorithms/cell_data.hpp>

#include "distributed_judge.hpp"
#include "refusal.hpp"
#include "sample_grids.hpp"
#include "table_in_c.hpp"

using namespace nestgrid_test;

namespace {

constexpr int rank_count = 4;
constexpr int odd_rank = 2;  // that fails

/// What differs on one rank.
struct Odd {
    double isovalue = 0.5;
    Projection projection{.threshold = 0.01};
    IsosurfaceOptions options{};
    std::size_t most_sharers = 24;
    double scale = 1;                 ///< of its values
    double bad = 0;                   ///< at one of its nodes, where not 0
    int throws_in_step = -1;          ///< its field throws: 0 values, 1 preroll, 2 surface
    bool as_floats = false;           ///< its field has other numbers
    bool no_values = false;           ///< its field never has a value
    bool draws_at_once = false;       ///< it makes no preroll
    std::uint64_t epoch_in_step = 9;  ///< from this step on its grid has changed
    bool sink_fails = false;          ///< takes no triangles
    bool moves_keys = false;          ///< two of its nodes have each other's keys
    int claims_leaf_of = -1;          ///< it says that it has a leaf of this rank
    bool loses_leaf = false;          ///< it says that one of its leaves is elsewhere
    bool cells_throw = false;         ///< its data of cells cannot be read
};

/// A grid that changes, and may have keys of its own that mean something else elsewhere.
struct FragileGrid : CutGrid<3> {
    FragileGrid(const CutGrid<3>& grid, const int* now, const Odd* is)
        : CutGrid<3>(grid), step(now), odd(is) {}
    std::uint64_t epoch() const {
        return static_cast<std::uint64_t>(*step) >= odd->epoch_in_step ? 1 : 0;
    }
    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        CutGrid<3>::corner_keys(e, out);
        exchange(out);
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        CutGrid<3>::new_keys(e, out);
        exchange(out);
    }
    void exchange(std::span<NodeKey> keys) const {
        for (NodeKey& key : keys) {
            if (odd->moves_keys && key < 2) key = 1 - key;
        }
    }
    const int* step;
    const Odd* odd;
};

template <class Real>
struct FragileField : CutField<3, Real> {
    FragileField(const CutField<3, Real>& field, const int* now, const Odd* is)
        : CutField<3, Real>(field), step(now), odd(is) {}
    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        fail();
        const NodeMask missing = CutField<3, Real>::coarse_values(i, out);
        return odd->no_values ? ~NodeMask{0} : missing;
    }
    NodeMask new_values(const CutGrid<3>::Element& e, NodeMask which, std::span<Real> out) const {
        fail();
        const NodeMask missing = CutField<3, Real>::new_values(e, which, out);
        return odd->no_values ? ~NodeMask{0} : missing;
    }
    void fail() const {
        if (*step == odd->throws_in_step) throw std::runtime_error("the disk is gone");
    }
    const int* step;
    const Odd* odd;
};

/// Takes triangles, and may fail.
struct FragileSink final : SimplexSink<3> {
    explicit FragileSink(bool does) : fails{does} {}
    void take(const Surface<3>&) override {
        if (fails) throw std::runtime_error("the pipe is closed");
    }
    bool fails;
};

class Scene {
public:
    Scene() : grid_(UnbalancedOctree::grids()[0]) {
        std::mt19937 random(3);
        refine_at_random(grid_, random, 3, 4, 3, 150);
        whole_.emplace(grid_);
        owner_ = whole_->partition(rank_count, Whole::Cut::in_runs, random);
        for (const Point& x : whole_->positions) {
            values_.push_back(x[0] + 0.3 * std::sin(9 * x[1]));
            values_.push_back(x[2]);
        }
    }

    /// What each rank says where one is odd.
    std::vector<std::string> run(const Odd& odd) const {
        return SimulatedRanks::run(rank_count, [&](Ranks& ranks) {
            const Odd same;
            const Odd& is = ranks.rank() == odd_rank ? odd : same;
            if (is.as_floats) return draw<float>(ranks, is);
            draw<double>(ranks, is);
        });
    }

private:
    template <class Real>
    void draw(Ranks& ranks, const Odd& odd) const {
        int step = 0;
        std::vector<int> owner = owner_;
        if (odd.claims_leaf_of >= 0) *std::ranges::find(owner, odd.claims_leaf_of) = odd_rank;
        if (odd.loses_leaf) *std::ranges::find(owner, odd_rank) = 0;
        const Part part(*whole_, owner, ranks.rank());
        std::vector<Real> values;
        for (const double v : values_) values.push_back(static_cast<Real>(odd.scale * v));
        for (std::size_t n = 0; odd.bad != 0 && n < part.visited.size(); ++n) {
            if (part.visited[n]) values[2 * n] = static_cast<Real>(odd.bad);
        }
        const FragileGrid mine(CutGrid<3>(*whole_, &part, true), &step, &odd);
        const Distributed grid(mine, ranks, odd.most_sharers);
        const CellAverages cells(grid, [&](const auto&) {
            if (odd.cells_throw) throw std::runtime_error("the cells are gone");
            return 1.0;
        });
        const DistributedField field(grid, FragileField<Real>({&mine, &values}, &step, &odd));
        step = 1;
        const Prerolls prerolls(grid, field);
        if (odd.draws_at_once) {
            // Other ranks make their prerolls; what is asked for is compared first.
            const Wide bounds;
            isosurface(grid, field, odd.isovalue, under(Exact(), bounds), odd.options);
        }
        prerolls.choose("offset", 1, {}, {});
        step = 2;
        // Several threads tell their progress at once; one tells it now and then.
        const ThreadExecutor threads(2);
        const FragileSink sink(odd.sink_fails);
        const auto result =
            extract_isosurfaces<3>(prerolls, std::span(&odd.isovalue, 1), std::vector{sink},
                                   odd.projection, odd.options, {threads});
        if (result[0].cancelled) throw std::runtime_error("cancelled");
    }
    struct Wide final : Bounds {
        double offset_bound(NodeKey) const override { return 9; }
        double bound(const Rule&, std::span<const NodeKey>) const override { return 9; }
        const HangingNodes* hanging() const override { return nullptr; }
        bool made_for(std::uint64_t) const override { return true; }
    };

    OctreeGrid<3> grid_;
    std::optional<Whole> whole_;
    std::vector<int> owner_;
    std::vector<double> values_;
};

/// All ranks say the same, which has all of these parts.
void expect_all_say(const char* what, const Odd& odd, const std::vector<std::string>& parts) {
    static const Scene scene;
    const std::vector<std::string> ended = scene.run(odd);
    for (const std::string& sentence : ended) {
        EXPECT_EQ(sentence, ended[0]) << what;
        for (const std::string& part : parts) {
            EXPECT_NE(sentence.find(part), std::string::npos)
                << what << ": '" << sentence << "', not '" << part << "'";
        }
    }
}

TEST(DistributedFaults, NothingIsWrong) {
    expect_all_say("nothing", {}, {});
    for (const std::string& sentence : Scene().run({})) EXPECT_EQ(sentence, "");
}

TEST(DistributedFaults, RanksAskForDifferentThings) {
    expect_all_say("isovalue", {.isovalue = 0.25},
                   {"all ranks must ask for the same", "rank 0", "0.5", "rank 2", "0.25"});
    expect_all_say("threshold", {.projection = {.threshold = 0.125}},
                   {"all ranks must ask for the same", "rank 2", "0.125"});
    expect_all_say("cap", {.options = {.cap = true}},
                   {"all ranks must ask for the same", "rank 2", "with caps"});
    expect_all_say("criterion", {.projection = {.threshold = 0.01, .blend = 2}},
                   {"all ranks must ask for the same", "rank 2"});
    expect_all_say("indicator", {.projection = {.threshold = 0.01, .indicator = "visual"}},
                   {"all ranks must ask for the same", "rank 2"});
    expect_all_say("sharers", {.most_sharers = 3},
                   {"all ranks must ask for the same", "rank 2", "more than 3"});
    expect_all_say("type of values", {.as_floats = true},
                   {"all ranks must ask for the same", "rank 2", "4 bytes"});
}

TEST(DistributedFaults, OneRankAsksForWhatIsRefused) {
    expect_all_say("isovalue", {.isovalue = std::nan("")}, {"rank 2: the isovalue"});
    expect_all_say("threshold", {.projection = {.threshold = -1}}, {"rank 2: the threshold"});
    expect_all_say("normals", {.options = {.normals = true, .at_nodes = true}},
                   {"rank 2: a surface with normals and vertices at nodes is not made for "
                    "distributed grids"});
    expect_all_say("budget", {.projection = {.max_triangles = 9}},
                   {"rank 2: no threshold is searched"});
    expect_all_say("another algorithm", {.draws_at_once = true},
                   {"rank 0 asks for a preroll, and rank 2 for isosurfaces"});
}

TEST(DistributedFaults, ValuesOfOneRankAreBad) {
    expect_all_say("not a number", {.bad = std::nan("")}, {"rank 2"});
    expect_all_say("other values", {.scale = 1.5},
                   {"rank ", "differs from that of rank", "copies", "by up to", "updated?"});
    expect_all_say("no values", {.no_values = true}, {"rank ", ": the field has no value at"});
}

TEST(DistributedFaults, OneRankThrows) {
    for (int step = 0; step < 3; ++step) {
        expect_all_say("field", {.throws_in_step = step}, {"rank 2: the disk is gone"});
    }
    Odd odd;
    odd.options.progress = [](const TraversalCounts&) -> bool {
        throw std::runtime_error("nobody listens");
    };
    expect_all_say("progress", odd, {"rank 2: nobody listens"});
    expect_all_say("data of cells", {.cells_throw = true}, {"rank 2: the cells are gone"});
    expect_all_say("sink", {.sink_fails = true}, {"rank 2: the pipe is closed"});
    expect_all_say("another grid after the fields", {.epoch_in_step = 1},
                   {"rank 2", "the grid has changed since"});
    expect_all_say("another grid after the preroll", {.epoch_in_step = 2},
                   {"rank 2", "the grid has changed since"});
}

TEST(DistributedFaults, OneRankCancels) {
    Odd odd;
    odd.options.progress = [](const TraversalCounts&) { return false; };
    expect_all_say("progress", odd, {"cancelled"});
}

TEST(DistributedFaults, OwnKeysAreNotGlobal) {
    expect_all_say("keys", {.moves_keys = true},
                   {"ranks ", "have a node under two keys"});
}

/// A leaf that no rank has would be a hole, and one that two have would be drawn twice.
TEST(DistributedFaults, LeavesAreNotOnOneRankEach) {
    const std::string must = "presence must give each leaf to one rank, but element ";
    expect_all_say("one leaf twice", {.claims_leaf_of = 1}, {must, " is on ranks 1 and 2"});
    expect_all_say("one leaf twice", {.claims_leaf_of = 3}, {must, " is on ranks 2 and 3"});
    expect_all_say("one leaf less", {.loses_leaf = true}, {must, " is on no rank"});
}

TEST(DistributedFaults, PlacesOfNodesDiffer) {
    OctreeGrid<3> grid = UnbalancedOctree::grids()[0];
    Whole whole(grid);
    whole.curve();
    std::mt19937 random(1);
    const std::vector<int> owner = whole.partition(3, Whole::Cut::in_runs, random);
    const auto ended = SimulatedRanks::run(3, [&](Ranks& ranks) {
        Whole own = whole;
        if (ranks.rank() == 1) own.curve();
        const Part part(own, owner, ranks.rank());
        const CutGrid<3> mine(own, &part, false);
        const Distributed on_ranks(mine, ranks);
    });
    for (const std::string& sentence : ended) {
        EXPECT_NE(sentence.find("have a node at two places under one key"), std::string::npos)
            << sentence;
    }
}

/// What a walk knows of an element has not grown: the presence lies behind `hidden`.
static_assert(sizeof(void*) != 8 || sizeof(Member) == sizeof(Handle) + 32);

TEST(DistributedFaults, GridWithoutRanks) {
    OctreeGrid<3> grid = UnbalancedOctree::grids()[0];
    const Whole whole(grid);
    std::mt19937 random(1);
    const std::vector<int> owner = whole.partition(2, Whole::Cut::in_order, random);
    const Part part(whole, owner, 1);
    const CutGrid<3> mine(whole, &part, false);
    const std::vector<double> values(2 * whole.positions.size(), 0.5);
    try {
        isosurface(mine, CutField<3, double>{&mine, &values}, 0.5);
        FAIL();
    } catch (const GridError& e) {
        EXPECT_EQ(
            std::string(e.what()),
            "leaves of coarse element 0 are on other processes, and the grid does not say how "
            "to reach them: write 'const Distributed grid(mine, ranks);' and 'const "
            "DistributedField field(grid, values);' (nestgrid/algorithms/distributed.hpp) and "
            "draw these");
    }
    // The same of a table in C, which asks for the operation.
    const CutField<3, double> field{&mine, &values};
    TableInC table(mine);
    const auto behind = open_table<double>(table.table, field_in_c(mine, field));
    EXPECT_EQ(refusal<GridError>([&] { isosurface<3>(*behind, 0.5); }),
              refusal<GridError>([&] { isosurface(mine, field, 0.5); }));
    table.table.presence = [](const void*, void*, const nestgrid_element*, int* which) {
        *which = 4;
        return 0;
    };
    const auto wrong = open_table<double>(table.table, field_in_c(mine, field));
    EXPECT_EQ(refusal<GridError>([&] { isosurface<3>(*wrong, 0.5); }),
              "presence gave 4, not 0, 1, 2 or 3");
    // All of it on one process needs no ranks.
    const Part all(whole, std::vector<int>(owner.size(), 0), 0);
    const CutGrid<3> here(whole, &all, false);
    EXPECT_NO_THROW(isosurface(here, CutField<3, double>{&here, &values}, 0.25));
}

}  // namespace
