// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/distributed.hpp>

#include <bit>
#include <limits>
#include <string>

#include <nestgrid/detail/forwarding_hierarchy.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>
#include <ranks/claims.hpp>
#include <ranks/hanging_across.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid {

namespace engine {

namespace {

std::uint64_t hash_of(const Point& x) {
    std::uint64_t sum = 0;
    for (const double along : x) {
        sum = nestgrid::detail::mix64(sum + std::bit_cast<std::uint64_t>(along + 0.0));
    }
    return sum;
}

/// A hierarchy that walks with ranks before the nodes that they share are known.
class BeforeSharing final : public nestgrid::detail::ForwardingHierarchy<float> {
public:
    BeforeSharing(const Hierarchy<float>& inner, const SharedNodes& shared)
        : ForwardingHierarchy(inner, with(inner.facts(), shared)) {}

private:
    static HierarchyFacts with(HierarchyFacts facts, const SharedNodes& shared) {
        facts.shared = &shared;
        facts.drop_promises_of_whole_grids();
        return facts;
    }
};

/// Whether the grid says more of a node than ranks derive alike: its key, or its place.
bool may_differ(const Hierarchy<float>& grid) {
    return grid.offers(Feature::own_keys) || grid.offers(Feature::new_positions);
}

/// The nodes that other ranks may have: all nodes of the elements that this rank visits, with their
/// places where these may differ; none where this rank has all leaves.
std::vector<SharedNodes::Candidate> nodes_of(const Hierarchy<float>& grid) {
    if (has_all_leaves(grid)) return {};
    const bool places = may_differ(grid);
    const Walk<float> walk(grid,
                           {.values = false, .keys = true, .positions = places, .on_ranks = true});
    struct Seen {};
    KeyTable<NodeKey, Seen> seen;
    std::vector<SharedNodes::Candidate> nodes;
    SplitKeys keys;
    SplitPositions positions{};
    for_each_element(walk, true, [&](const ElementView<float>& view, const Split& split) {
        walk.corners(view, keys.data(), nullptr);
        std::size_t count = view.corner_count();
        if (split.rule != nullptr) count = walk.split_keys(view, split, keys).size();
        if (places && split.rule == nullptr) walk.corners(view, nullptr, positions.data());
        if (places && split.rule != nullptr) {
            const auto of = walk.split_positions(view, split, positions);
            if (of.data() != positions.data()) std::copy(of.begin(), of.end(), positions.begin());
        }
        for (std::size_t n = view.level == 0 ? 0 : view.corner_count(); n < count; ++n) {
            if (!seen.insert(keys[n], {}).second) continue;
            nodes.push_back({keys[n], places ? hash_of(positions[n]) : 0});
        }
    });
    return nodes;
}

/// A corner of the first coarse element of all ranks. Collective.
/// \param first the least place of a coarse element of this rank
/// \param corner of that element
Point corner_of_all(Ranks& ranks, std::uint64_t first, const Point& corner) {
    std::uint64_t least = first;
    ranks.reduce(std::span(&least, 1), Ranks::Reduction::min);
    constexpr double none = -std::numeric_limits<double>::infinity();
    Point x = first == least ? corner : Point{none, none, none};
    std::array<double*, 3> along{&x[0], &x[1], &x[2]};
    take_greatest(ranks, along);
    return x;
}

}  // namespace

}  // namespace engine

std::shared_ptr<const engine::SharedNodes> detail::share_nodes(const Hierarchy<float>& grid,
                                                               Ranks& ranks,
                                                               std::size_t most_sharers,
                                                               const GridOnRanks& says) {
    // All ranks find this out alone: those of another communicator are not to be waited for.
    if (says.rank_count != 0 && says.rank_count != ranks.size()) {
        throw InvalidInput("the communicator of the grid has " + std::to_string(says.rank_count) +
                           " processes, that of the ranks " + std::to_string(ranks.size()) +
                           ": they must be the same");
    }
    std::vector<std::uint64_t> places;
    for (std::size_t i = 0; says.place && i < grid.coarse_count(); ++i) {
        places.push_back(says.place(i));
    }
    const auto shared =
        std::make_shared<engine::SharedNodes>(ranks, grid.epoch(), std::move(places));
    const engine::BeforeSharing before(grid, *shared);
    std::vector<engine::SharedNodes::Candidate> nodes;
    std::vector<engine::ClaimPath> claims;
    const auto asked = [&] {
        return (grid.offers(Feature::own_keys) ? "a distributed grid with own keys"
                                               : "a distributed grid") +
               std::string(grid.offers(Feature::new_positions) ? ", curved, of dimension "
                                                               : ", of dimension ") +
               std::to_string(grid.facts().dimension) +
               (says.place ? ""
                           : ", " + std::to_string(grid.coarse_count()) + " coarse elements,") +
               " with nodes of more than " + std::to_string(most_sharers) + " ranks told to all";
    };
    std::uint64_t first = ~std::uint64_t{0};
    Coarse coarse;
    engine::together(shared.get(), asked, [&] {
        engine::require_drawn_on_ranks(grid);
        nodes = engine::nodes_of(before);
        if (!says.place) {
            engine::for_each_claim(grid, [&](const auto& path) { claims.push_back(path); });
        }
        std::size_t at = 0;
        for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
            if (shared->coarse_place(i) >= first) continue;
            first = shared->coarse_place(i);
            at = i;
        }
        Family family;
        if (grid.coarse_count() > 0) grid.coarse(grid.open().get(), at, coarse, family);
    });
    if (!says.place) engine::require_one_rank_each(ranks, claims, grid.coarse_count());
    shared->set_corner(engine::corner_of_all(ranks, first, coarse.corners[0]));
    shared->find(nodes, most_sharers, engine::may_differ(grid));
    shared->set_hanging(engine::hanging_across(before, *shared));
    return shared;
}

}  // namespace nestgrid
