// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/hanging_across.hpp>

#include <map>
#include <optional>
#include <string>

#include <nestgrid/detail/hanging_probe.hpp>
#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid::engine {

namespace {

/// The corners of an edge or a face, in tensor order.
struct Part {
    std::array<NodeKey, 4> key{};
    std::array<bool, 4> here{true, true, true, true};  ///< else it is common, and not on this rank
    std::uint8_t corners = 0;
    bool of_leaf = true;  ///< else an element divides it between the middles of 01 and 23 first

    template <class Corners>
    Part(std::span<const NodeKey> keys, const Corners& of, std::size_t count, bool leaf)
        : corners{static_cast<std::uint8_t>(count)}, of_leaf{leaf} {
        for (std::size_t i = 0; i < count; ++i) key[i] = keys[of[i]];
    }
    /// Reads what a rank wrote, with the numbers by which both call their nodes.
    Part(Reader& in, int rank, const SharedNodes& shared) {
        const auto what = in.get<std::uint8_t>();
        corners = what >> 1U;
        of_leaf = (what & 1U) != 0;
        for (std::size_t i = 0; i < corners; ++i) {
            const NodeKey* const node = shared.node_with(rank, in.get<std::uint32_t>());
            if (node != nullptr) key[i] = *node;
            here[i] = node != nullptr;
        }
    }
    void put_into(Bytes& out, int rank, const SharedNodes& shared) const {
        put(out, static_cast<std::uint8_t>(unsigned{corners} << 1U | unsigned{of_leaf}));
        for (const NodeKey node : all()) put(out, shared.number_with(rank, node));
    }
    std::span<const NodeKey> all() const { return std::span(key).first(corners); }
    bool all_here() const { return here[0] && here[1] && here[2] && here[3]; }
};

class HangingAcross {
public:
    HangingAcross(const Hierarchy<float>& grid, const SharedNodes& shared)
        : walk_(grid, {.values = false, .keys = true, .on_ranks = true}),
          shared_{&shared},
          box_(shared.ranks().size()) {}

    /// Collects the nodes of this rank, and tells the parts of leaves that others may have, too.
    void collect() {
        for_each_element(walk_, false, [&](const ElementView<float>& view, const Split& split) {
            if (split.rule == nullptr) {
                if (shared_->count() > 0) tell_leaf(view);
                return;
            }
            const std::span<const NodeKey> keys = walk_.split_keys(view, split, keys_);
            probe_.add_nodes(*split.rule, keys, split.keys);
            if (shared_->count() == 0) return;
            for (const auto& face : faces_of(*split.rule)) tell({keys, face.corner, 4, false});
        });
        probe_.finish();
    }
    void exchange() {
        shared_->send(box_, [&](int rank, Reader& in) {
            while (in.more()) told_.emplace_back(in, rank, *shared_);
        });
    }
    HangingNodes find() {
        for (const Part& part : told_) {
            if (part.of_leaf) probe_leaf_part(part);
            if (!part.of_leaf && part.all_here() && probe_.crosses(part.key))
                refuse_crossed("elements of two ranks");
        }
        for_each_element(walk_, false, [&](const ElementView<float>& view, const Split& split) {
            if (split.rule != nullptr) return check(view, split);
            walk_.corners(view, keys_.data(), nullptr);
            probe_.probe_leaf(view.shape, keys_);
        });
        if (!probe_.hangs_at_weights()) return probe_.take();
        throw GridError(
            "a node hangs that is not in the middle of an edge, as where a neighbour is divided by "
            "three or graded: this is not made for distributed grids yet");
    }

private:
    struct ToldFace {
        int rank;
        unsigned corners;  ///< of the leaf, one bit each
    };

    /// An edge, or a face with its edges.
    void probe_leaf_part(const Part& part) {
        if (part.corners > 2) probe_edges(part);
        if (part.all_here()) probe_.probe_part(part.all());
    }
    void probe_edges(const Part& face) {
        constexpr std::array<std::size_t, 3> triangle{0, 1, 2};
        constexpr std::array<std::size_t, 4> quadrilateral{0, 1, 3, 2};
        const std::span<const std::size_t> loop = face.corners == 3
                                                      ? std::span<const std::size_t>(triangle)
                                                      : std::span<const std::size_t>(quadrilateral);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::size_t from = loop[i];
            const std::size_t to = loop[(i + 1) % loop.size()];
            if (!face.here[from] || !face.here[to]) continue;
            probe_.probe_part(std::array{face.key[from], face.key[to]});
        }
    }
    using OneWayFaces = std::vector<nestgrid::detail::OneWayFace>;
    const OneWayFaces& faces_of(const Rule& rule) {
        const auto at = faces_.find(&rule);
        if (at != faces_.end()) return at->second;
        return faces_.emplace(&rule, nestgrid::detail::one_way_faces(rule, false)).first->second;
    }
    /// Tells the faces of a leaf, and its edges to those who are not told a face around them.
    void tell_leaf(const ElementView<float>& leaf) {
        const Topology& t = leaf.topology();
        walk_.corners(leaf, keys_.data(), nullptr);
        told_faces_.clear();
        for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
            std::array<std::uint8_t, 4> corner{};
            unsigned corners = 0;
            for (int i = 0; i < t.face[f].corners; ++i) {
                corner[static_cast<std::size_t>(i)] = t.face[f].tensor_corner(i);
                corners |= 1U << t.face[f].tensor_corner(i);
            }
            const Part face(keys_, corner, t.face[f].corners, true);
            shared_->route(face.all(), box_, [&](Bytes& out, int rank) {
                told_faces_.push_back({rank, corners});
                face.put_into(out, rank, *shared_);
            });
        }
        for (std::size_t e = 0; e < t.edges; ++e) {
            const unsigned ends = 1U << t.edge[e][0] | 1U << t.edge[e][1];
            const Part edge(keys_, t.edge[e], 2, true);
            shared_->route(edge.all(), box_, [&](Bytes& out, int rank) {
                const auto knows = [&](const ToldFace& face) {
                    return face.rank == rank && (ends & ~face.corners) == 0;
                };
                if (std::any_of(told_faces_.begin(), told_faces_.end(), knows)) return;
                edge.put_into(out, rank, *shared_);
            });
        }
    }
    void tell(const Part& part) {
        shared_->route(part.all(), box_,
                       [&](Bytes& out, int rank) { part.put_into(out, rank, *shared_); });
    }
    void check(const ElementView<float>& view, const Split& split) {
        if (!probe_.divides_one_way()) return;
        if (!probe_.crossed_face(*split.rule, walk_.split_keys(view, split, keys_))) return;
        refuse_crossed("elements below coarse element " + std::to_string(view.coarse) +
                       " and their neighbours");
    }
    [[noreturn]] static void refuse_crossed(const std::string& who) {
        throw GridError(who +
                        " divide a face in different directions first and one of them then across, "
                        "so that a node there hangs on others than its parents: refine both in the "
                        "same order, or each in its own direction only");
    }

    Walk<float> walk_;
    const SharedNodes* shared_;
    nestgrid::detail::HangingProbe probe_;
    Outbox box_;
    std::vector<Part> told_;
    std::vector<ToldFace> told_faces_;  // of one leaf
    std::map<const Rule*, OneWayFaces> faces_;
    SplitKeys keys_{};
};

}  // namespace

HangingNodes hanging_across(const Hierarchy<float>& grid, const SharedNodes& shared) {
    std::optional<HangingAcross> search;
    together(&shared, "hanging nodes", [&] {
        search.emplace(grid, shared);
        search->collect();
    });
    search->exchange();
    HangingNodes hanging;
    together(&shared, "hanging nodes", [&] { hanging = search->find(); });
    return hanging;
}

}  // namespace nestgrid::engine
