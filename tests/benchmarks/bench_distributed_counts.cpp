// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who shares nodes with whom, for more ranks than can be run: an octree refined at a sphere and cut
// in order, every node with the ranks that visit an element around it. No messages are sent.
//     bench_distributed_counts LEVELS RANKS...
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <utility>

#include "cut_grid.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace {

/// The ranks from the first to the last one.
using Ranks = std::pair<int, int>;

/// The nodes that several ranks visit. Ranks visit all elements of which they have a leaf.
class Sharers {
public:
    Sharers(const Whole& whole, const std::vector<int>& owner) {
        std::vector<int> only(whole.positions.size(), none);
        for (const Whole::Element& element : whole.elements) {
            const Ranks ranks{owner[element.first_leaf], owner[element.last_leaf - 1]};
            for (const std::uint32_t node : whole.nodes_of(element)) {
                if (ranks == Ranks{only[node], only[node]}) continue;
                if (only[node] == none && ranks.first == ranks.second) {
                    only[node] = ranks.first;
                } else {
                    visits_.push_back({node, ranks});
                }
            }
        }
        for (std::uint32_t node = 0; node < only.size(); ++node) {
            if (only[node] != none) visits_.push_back({node, {only[node], only[node]}});
        }
        std::sort(visits_.begin(), visits_.end());
    }
    /// Calls function(ranks) for each node of more than one rank, with all of them in order.
    template <class Function>
    void for_each_node(const Function& function) const {
        std::vector<int> ranks;
        for (std::size_t i = 0; i < visits_.size(); ++i) {
            const Ranks& visit = visits_[i].second;
            for (int r = std::max(visit.first, ranks.empty() ? 0 : ranks.back() + 1);
                 r <= visit.second; ++r) {
                ranks.push_back(r);
            }
            if (i + 1 < visits_.size() && visits_[i + 1].first == visits_[i].first) continue;
            if (ranks.size() > 1) function(ranks);
            ranks.clear();
        }
    }

private:
    static constexpr int none = -1;
    std::vector<std::pair<std::uint32_t, Ranks>> visits_;
};

struct MeanAndMost {
    double sum = 0;
    std::size_t count = 0;
    std::size_t most = 0;

    void add(std::size_t n) {
        sum += static_cast<double>(n);
        ++count;
        most = std::max(most, n);
    }
    void print(const std::string& name) const {
        std::printf("%s_mean %.1f\n%s_most %zu\n", name.c_str(),
                    sum / static_cast<double>(std::max<std::size_t>(count, 1)), name.c_str(), most);
    }
};

/// As in bench_forest.
bool meets_sphere(const Leaf& leaf) {
    const double distance = norm(leaf.centre() - Point{0.5, 0.45, 0.55}) - 0.3;
    return leaf.level < 3 || std::abs(distance) < 0.75 / (1 << leaf.level);
}

/// \param most_sharers nodes that more ranks have are common, as in Distributed
void count(const Whole& whole, int size, std::size_t most_sharers) {
    std::mt19937 unused;
    const Sharers sharers(whole, whole.partition(size, Whole::Cut::in_order, unused));
    std::size_t common = 0;
    std::vector<std::size_t> shared(static_cast<std::size_t>(size));
    std::vector<std::set<int>> neighbours(static_cast<std::size_t>(size));
    sharers.for_each_node([&](const std::vector<int>& ranks) {
        if (ranks.size() > most_sharers) return void(++common);
        for (const int rank : ranks) {
            const auto r = static_cast<std::size_t>(rank);
            ++shared[r];
            for (const int other : ranks) {
                if (other != rank) neighbours[r].insert(other);
            }
        }
    });
    MeanAndMost nodes;
    MeanAndMost beside;
    for (const std::size_t n : shared) nodes.add(n);
    for (const std::set<int>& n : neighbours) beside.add(n.size());
    const std::string name =
        "ranks_" + std::to_string(size) + "_sharers_" + std::to_string(most_sharers);
    std::printf("%s_common_nodes %zu\n", name.c_str(), common);
    nodes.print(name + "_shared_nodes");
    beside.print(name + "_neighbours");
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    const int levels = quick ? 4 : argc > 1 ? std::atoi(argv[1]) : 9;
    std::vector<int> sizes;
    for (int i = 2; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
    if (sizes.empty()) sizes = {8, 64};
    if (levels < 1 || *std::ranges::min_element(sizes) < 1) {
        std::fprintf(stderr, "bench_distributed_counts: LEVELS and RANKS must be at least 1\n");
        return 1;
    }
    auto grid = std::move(BalancedOctree::grids()[0]);
    for (int level = 0; level < levels; ++level) {
        grid.adapt([](const Leaf& leaf) { return meets_sphere(leaf) ? Mark::refine : Mark::keep; });
    }
    const Whole whole(grid);
    std::printf("leaves %u\n", whole.leaves);
    for (const int size : sizes) {
        for (const std::size_t most_sharers : {std::size_t{16}, std::size_t{24}, std::size_t{32}}) {
            count(whole, size, most_sharers);
        }
    }
}
