// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What ranks tell each other for a surface of a grid refined at a sphere and cut in order: of the
// busiest rank, exchanges, messages and bytes of each step. Ranks are threads; times mean nothing.
#include <cstdio>
#include <cstring>
#include <mutex>
#include <string>

#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <ranks/shared_nodes.hpp>

#include "cut_grid.hpp"
#include "sample_grids.hpp"
#include "simulated_ranks.hpp"

using namespace nestgrid_test;

namespace {

/// The greatest numbers of any rank.
struct Busiest {
    std::mutex mutex;
    std::map<std::string, std::uint64_t> figures;

    void take(const std::string& name, std::uint64_t figure) {
        const std::scoped_lock lock(mutex);
        figures[name] = std::max(figures[name], figure);
    }
};

/// Takes what a rank sent since it last did.
class Meter {
public:
    Meter(const Ranks& ranks, Busiest& busiest) : ranks_{&ranks}, busiest_{&busiest} {}
    void take(const std::string& step) {
        const SimulatedRanks::Traffic now = SimulatedRanks::traffic(*ranks_);
        busiest_->take(step + " exchanges", now.exchanges - last_.exchanges);
        busiest_->take(step + " messages", now.messages - last_.messages);
        busiest_->take(step + " bytes", now.bytes - last_.bytes);
        busiest_->take(step + " bytes to all", now.gathered - last_.gathered);
        busiest_->take(step + " numbers reduced", now.reduced - last_.reduced);
        last_ = now;
    }

private:
    const Ranks* ranks_;
    Busiest* busiest_;
    SimulatedRanks::Traffic last_;
};

template <class Grid>
void measure(const std::string& name, Grid grid, std::size_t leaves, int ranks) {
    while (grid.leaf_count() < leaves) {
        grid.adapt(
            [](const Leaf& leaf) { return near_sphere(leaf, 3, 1.2) ? Mark::refine : Mark::keep; });
    }
    const Whole whole(grid);
    std::mt19937 random(1);
    const std::vector<int> owner = whole.partition(ranks, Whole::Cut::in_order, random);
    std::vector<double> values;
    for (const Point& x : whole.positions) {
        values.push_back(to_sphere(x, 3) + 0.05 * std::sin(20 * x[0]));
        values.push_back(0);
    }
    Busiest busiest;
    SimulatedRanks::run(ranks, [&](Ranks& mine) {
        Meter meter(mine, busiest);
        const Part part(whole, owner, mine.rank());
        const CutGrid<3> here(whole, &part, false);
        const Distributed distributed(here, mine);
        meter.take("1 grid");
        const DistributedField field(distributed, CutField<3, double>{&here, &values});
        meter.take("2 field");
        const HierarchicalIndicator indicator(distributed, field);
        meter.take("3 indicator");
        for (const char* step : {"4 surface", "5 next isovalue"}) {
            isosurface(distributed, field, step[0] == '4' ? 0.0 : 0.01, under(indicator, 1e-3));
            meter.take(step);
        }
        busiest.take("shared nodes", distributed.shared_nodes()->count());
        busiest.take("common nodes", distributed.shared_nodes()->common_count());
    });
    std::printf("%s leaves %u\n", name.c_str(), whole.leaves);
    for (const auto& [figure, number] : busiest.figures) {
        std::printf("%s %s %llu\n", name.c_str(), figure.c_str(),
                    static_cast<unsigned long long>(number));
    }
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    const std::size_t leaves = quick ? 2000 : 300000;
    for (const int ranks : {8, 64}) {
        const std::string on = " on " + std::to_string(ranks) + " ranks";
        measure("octree" + on, BalancedOctree::grids()[0], leaves, ranks);
        measure("bisection" + on, BisectionTetrahedra::grids()[0], leaves / 8, ranks);
    }
}
