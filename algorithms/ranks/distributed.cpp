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

/// Finds the nodes that other ranks may have: those of elements that are here in part, and those of
/// faces of leaves beside which no leaf here has the same face. Around any other node all leaves
/// are here: the way around it from one that is to one that is not would leave what is here by a
/// face that has the node and that no other leaf here has. In planes, which may meet in an edge by
/// more than two, the nodes on the boundary of each greatest element that is here wholly. Where
/// ranks list different coarse elements, all nodes that this rank has.
class NodeSearch {
public:
    /// \param same_coarse whether all ranks list the same coarse elements
    NodeSearch(const Hierarchy<float>& grid, bool same_coarse)
        : grid_{&grid},
          named_{grid.offers(Feature::own_keys) && same_coarse},
          places_{grid.offers(Feature::new_positions) ||
                  (grid.offers(Feature::own_keys) && !named_)},
          on_boundary_{same_coarse},
          by_faces_{same_coarse && grid.facts().dimension == 3},
          task_{grid.open()},
          walk_(grid, {.values = false, .keys = true, .positions = places_, .on_ranks = true}) {}

    std::vector<SharedNodes::Candidate> run() {
        if (has_all_leaves(*grid_)) return {};
        for_each_element(
            walk_, !by_faces_,
            [&](const ElementView<float>& view, const Split& split) { look_at(view, split); });
        keep_beside_others();
        return std::move(nodes_);
    }

private:
    struct Level {
        /// The faces, of the element that is here wholly, that a node lies in, one bit each.
        std::array<std::uint8_t, std::tuple_size_v<SplitKeys>> on;
        /// As derived from ids of coarse elements, which all ranks list: the same on all.
        std::array<NodeKey, std::tuple_size_v<SplitKeys>> name;
    };
    /// Nodes inside an element that is here wholly, on its boundary, and those that are looked for.
    enum class Whose : std::uint8_t { inside, ours, perhaps_others };
    static constexpr std::uint8_t in_part = 0x80;    ///< of an element that is here in part
    using FaceNodes = std::array<std::uint32_t, 4>;  ///< in order; triangles name one twice

    void look_at(const ElementView<float>& view, const Split& split) {
        const bool is_leaf = split.rule == nullptr;
        const std::size_t corners = view.corner_count();
        const std::size_t count = corners + (is_leaf ? 0 : split.rule->new_nodes.size());
        const Level& level = put_level(view, split, count);
        if (!is_leaf || view.level == 0) put_nodes(view, split, level, count);
        if (is_leaf && by_faces_) put_faces(view, level);
    }
    /// Notes the nodes that others may have, if leaves around them are elsewhere.
    void put_nodes(const ElementView<float>& view, const Split& split, const Level& level,
                   std::size_t count) {
        if (split.rule == nullptr) {
            walk_.corners(view, keys_.data(), places_ ? positions_.data() : nullptr);
        } else {
            walk_.split_keys(view, split, keys_);
        }
        if (places_ && split.rule != nullptr) {
            const auto of = walk_.split_positions(view, split, positions_);
            if (of.data() != positions_.data()) std::copy(of.begin(), of.end(), positions_.begin());
        }
        for (std::size_t n = view.level == 0 ? 0 : view.corner_count(); n < count; ++n) {
            if (level.on[n] == 0) continue;
            const std::uint32_t i = number(keys_[n]);
            if (whose_[i] == Whose::inside) {
                nodes_[i] = {named_ ? level.name[n] : keys_[n], keys_[n],
                             places_ ? hash_of(positions_[n]) : 0};
                whose_[i] = Whose::ours;
            }
            if (level.on[n] == in_part || !by_faces_) whose_[i] = Whose::perhaps_others;
        }
    }
    /// Notes the faces of a leaf that touch the boundary of the greatest element here wholly.
    void put_faces(const ElementView<float>& leaf, const Level& level) {
        const Topology& t = leaf.topology();
        const auto touches = [&](std::size_t k) { return level.on[k] != 0; };
        bool has_keys = false;
        for (std::size_t f = 0; f < t.faces; ++f) {
            const auto count = static_cast<std::size_t>(t.face[f].corners);
            const std::span corner = std::span(t.face[f].corner).first(count);
            if (std::none_of(corner.begin(), corner.end(), touches)) continue;
            if (!std::exchange(has_keys, true)) walk_.corners(leaf, keys_.data(), nullptr);
            FaceNodes& nodes = faces_.emplace_back();
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                nodes[i] = number(keys_[corner[std::min(i, count - 1)]]);
            }
            std::sort(nodes.begin(), nodes.end());
        }
    }
    /// The number of a node, which is inside until put_nodes() has it.
    std::uint32_t number(NodeKey key) {
        const auto [known, is_new] = number_.insert(key, static_cast<std::uint32_t>(nodes_.size()));
        if (is_new) {
            nodes_.emplace_back();
            whose_.push_back(Whose::inside);
        }
        return *known;
    }
    void keep_beside_others() {
        std::sort(faces_.begin(), faces_.end());
        for (auto at = faces_.begin(); at != faces_.end();) {
            const auto end =
                std::find_if(at, faces_.end(), [&](const auto& f) { return f != *at; });
            if (end - at != 2) {
                for (const std::uint32_t node : *at) {
                    if (whose_[node] == Whose::ours) whose_[node] = Whose::perhaps_others;
                }
            }
            at = end;
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (whose_[i] == Whose::perhaps_others) nodes_[kept++] = nodes_[i];
        }
        nodes_.resize(kept);
    }
    /// \param count of the nodes, corners first
    const Level& put_level(const ElementView<float>& view, const Split& split, std::size_t count) {
        const auto depth = static_cast<std::size_t>(view.level);
        if (levels_.size() < depth + 2) levels_.resize(depth + 2);
        Level& level = levels_[depth];
        const std::size_t corners = view.corner_count();
        const bool whole = view.member->presence == Presence::here && on_boundary_;
        const bool begins =
            whole && (view.father == nullptr || view.father->member->presence != Presence::here);
        if (depth == 0 && named_) put_coarse_names(view, level);
        for (std::size_t k = 0; k < corners; ++k) {
            if (depth > 0) {
                level.on[k] = levels_[depth - 1].on[view.as->corner[k]];
                level.name[k] = levels_[depth - 1].name[view.as->corner[k]];
            }
            if (begins) level.on[k] = faces_at(view.topology(), k);
            if (!whole) level.on[k] = in_part;
        }
        for (std::size_t n = corners; n < count; ++n) {
            const Stencil& of = split.rule->new_nodes[n - corners];
            level.on[n] = 0xFF;
            for (std::size_t i = 0; i < of.count; ++i) level.on[n] &= level.on[of.parent[i]];
            if (named_) level.name[n] = derived_key(of, level.name.data());
        }
        return level;
    }
    void put_coarse_names(const ElementView<float>& view, Level& level) {
        Coarse coarse;
        grid_->coarse(task_.get(), view.coarse, coarse, family_);
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            level.name[k] = coarse_key(coarse.ids[k]);
        }
    }
    /// The faces that a corner of an element lies in.
    static std::uint8_t faces_at(const Topology& t, std::size_t corner) {
        unsigned faces = 0;
        for (std::size_t f = 0; f < t.faces; ++f) {
            for (std::size_t i = 0; i < t.face[f].corners; ++i) {
                faces |= unsigned{t.face[f].corner[i] == corner} << f;
            }
        }
        return static_cast<std::uint8_t>(faces);
    }

    const Hierarchy<float>* grid_;
    bool named_;        // own keys are compared under names
    bool places_;       // places are compared
    bool on_boundary_;  // else all nodes are looked for
    bool by_faces_;
    std::unique_ptr<Task> task_;
    Family family_;
    Walk<float> walk_;
    std::vector<Level> levels_;                // on the way down
    KeyTable<NodeKey, std::uint32_t> number_;  // of nodes_
    std::vector<SharedNodes::Candidate> nodes_;
    std::vector<Whose> whose_;  // of each
    std::vector<FaceNodes> faces_;
    SplitKeys keys_{};
    SplitPositions positions_{};
};

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
        nodes = engine::NodeSearch(before, !says.place).run();
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
