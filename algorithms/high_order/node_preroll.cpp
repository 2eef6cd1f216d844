// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How RealNodes are made.
#include <algorithm>
#include <cmath>
#include <limits>

#include <high_order/real_nodes.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

namespace {

/// Sums of few terms are this much larger at most than they are computed.
constexpr double rounding = 1 + 1e-12;

void raise(float& number, double to) {
    number = std::max(number, detail::float_above(to * rounding));
}

}  // namespace

/// Fills the table. Numbers of nodes are those of RealNodes::nodes_.
class RealNodes::Preroll {
public:
    Preroll(RealNodes& nodes, const LeafFunction& function, const BaseWalk& walk,
            LeafSummary& summary)
        : nodes_{&nodes},
          summary_{&summary},
          records_{function, walk},
          components_{summary.components},
          drawn_{summary.drawn} {
        walk.for_each([this](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule == nullptr) add_leaf(way);
        });
        const auto add = [this](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule != nullptr) add_split(way);
        };
        walk.for_each(add, BaseWalk::Positions::yes);
        std::stable_sort(hanging_.begin(), hanging_.end());
        std::stable_sort(halved_.begin(), halved_.end());
        std::stable_sort(splits_.begin(), splits_.end(),
                         [](const Split& a, const Split& b) { return a.level < b.level; });
        nodes.values_.resize(nodes.nodes_.size() * components_);
        facts_.resize(leaves_.size());
        at_corners_.resize(leaves_.size() * max_corners * drawn_);
        records_.read_all(function, walk, summary, [this](std::uint32_t leaf) { look_at(leaf); });
    }

    void run() {
        deviation_.resize(nodes_->nodes_.size());
        for (const Split& split : splits_) put_offsets(split);
        summary_->reserve(leaves_.size());
        for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) seed(leaf);
        sweep();
    }

private:
    /// A node on a part of a record: its numbers are read while the polynomial of the owner, a
    /// leaf, is in memory.
    struct OfOwner {
        std::uint32_t owner;
        std::uint32_t node;
        OnRecord part;

        bool operator<(const OfOwner& other) const { return owner < other.owner; }
    };
    struct LeafFacts {
        double beta;
        double flatness;  // the greatest beta of the leaf and its parts
        double least;     // of the leaf and its records
        double greatest;
        float jump;
    };

    RealNode& node(std::uint32_t number) { return nodes_->nodes_[number]; }
    double value(std::uint32_t number, std::size_t c) const {
        return nodes_->values_[number * components_ + c];
    }

    /// Makes the corners of a leaf known. A corner inside a larger leaf's part has the value of the
    /// record, any other that of the first leaf that has it.
    void add_leaf(std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        LeafNodes corner{};
        for (std::size_t k = 0; k < e.shape->corners; ++k) {
            const auto fresh = static_cast<std::uint32_t>(nodes_->nodes_.size());
            const auto [at, is_new] = nodes_->number_.insert(e.key[k], fresh);
            corner[k] = *at;
            if (is_new) {
                nodes_->nodes_.emplace_back();
                first_.push_back(static_cast<std::uint32_t>(leaves_.size()));
            }
            if (node(corner[k]).hangs) continue;
            const Place place = e.shape->reference_corner(k);
            const OnRecord hangs_on = records_.around(way, std::span(&place, 1));
            if (hangs_on.record < 0) continue;
            node(corner[k]).hangs = true;
            hanging_.push_back({records_.owner_of(hangs_on), corner[k], hangs_on});
        }
        leaves_.push_back(corner);
    }

    void add_split(std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        const RedSplitKeys keys = split_keys_of(e.key, *e.member->rule);
        Split split{{}, e.member->rule, static_cast<int>(way.size())};
        for (std::size_t n = 0; n < e.shape->node.size(); ++n) {
            split.node[n] = *nodes_->number_.find(keys[n]);  // a corner of a leaf
        }
        const double diameter = diameter_of(std::span(e.x).first(e.shape->corners));
        for (const std::uint32_t number : made_by(split)) raise(node(number).size, diameter);
        for (const ShapePart& part : e.shape->parts) put_beta(way, part, split);
        splits_.push_back(split);
    }

    /// Tells the node of a split that halves a part, and hangs, how far that part is from flat. A
    /// triangle has no node: the edges that children have in it, and the faces of leaves, tell.
    void put_beta(std::span<const BaseElement> way, const ShapePart& part, const Split& split) {
        const ShapeParts& shape = *way.back().shape;
        const std::uint8_t n = node_halving(*split.rule, part);
        if (n == no_new_node) return;
        const std::uint32_t number = split.node[shape.corners + n];
        RealNode& made = node(number);
        if (!made.hangs || made.halves > 0) return;
        const std::array<Place, 4> places = corners_of(shape, part);
        const OnRecord on = records_.around(way, std::span(places).first(part.count));
        if (on.record < 0) return;
        made.shift = static_cast<std::uint8_t>(on.shift);
        halved_.push_back({records_.owner_of(on), number, on});
        made.halves = static_cast<std::uint32_t>(nodes_->parts_.size());
        nodes_->parts_.emplace_back(records_.in_owner(on));
    }

    /// Fathers come first: what moves the parents is known.
    void put_offsets(const Split& split) {
        const auto corners = static_cast<std::size_t>(split.rule->corner_count());
        std::array<std::array<double, max_split_nodes>, 3> u;
        for (std::size_t c = 0; c < drawn_; ++c) {
            for (std::size_t n = 0; n < corners + split.rule->new_nodes.size(); ++n) {
                u[c][n] = value(split.node[n], c);
            }
        }
        for (std::size_t n = 0; n < split.rule->new_nodes.size(); ++n) {
            const Stencil& stencil = split.rule->new_nodes[n];
            const std::uint32_t number = split.node[corners + n];
            RealNode& made = node(number);
            double off = norm_of(drawn_, [&](std::size_t c) {
                return u[c][corners + n] - nestgrid::detail::interpolate(stencil, u[c].data(), 1);
            });
            double moved = 0;
            for (std::size_t i = 0; i < stencil.count; ++i) {
                moved = std::max(moved, deviation_[split.node[stencil.parent[i]]]);
            }
            off += moved;
            raise(made.off, off);
            if (!made.hangs) continue;
            deviation_[number] = std::max(deviation_[number], off * rounding);
            raise(made.stop, flat_share * made.beta);
        }
    }

    static std::span<const OfOwner> of_owner(const std::vector<OfOwner>& all, std::uint32_t leaf) {
        const auto [begin, end] = std::equal_range(all.begin(), all.end(), OfOwner{leaf, 0, {}});
        const auto first = static_cast<std::size_t>(begin - all.begin());
        return std::span(all).subspan(first, static_cast<std::size_t>(end - begin));
    }

    /// Takes what nodes and the leaf itself need of a leaf while its polynomial is there.
    void look_at(std::uint32_t leaf) {
        const LeafPolynomial& of = records_.leaves()[leaf];
        for (std::size_t k = of.parts().corners; k-- > 0;) {
            const std::uint32_t number = leaves_[leaf][k];
            const std::size_t own = net_corner(of.degree, of.factors(), k);
            const bool gives = first_[number] == leaf && !node(number).hangs;
            for (std::size_t c = 0; c < components_; ++c) {
                const double at_corner = records_.net(of, c)[own];
                if (gives) nodes_->values_[number * components_ + c] = at_corner;
                if (c < drawn_) at_corners_[(leaf * max_corners + k) * drawn_ + c] = at_corner;
            }
        }
        for (const OfOwner& on : of_owner(hanging_, leaf)) {
            records_.values_at(on.part, nodes_->values_.data() + on.node * components_);
        }
        for (const OfOwner& on : of_owner(halved_, leaf)) {
            node(on.node).beta = records_.facts_on(on.part).beta;
        }
        const NetFacts own = records_.facts_of(of);
        LeafFacts& facts = facts_[leaf];
        facts = {own.beta, own.beta, own.least, own.greatest, records_.jump_of(of)};
        for (std::size_t part = 0; part < of.parts().parts.size(); ++part) {
            const NetFacts there = records_.facts_on(of, part);
            facts.flatness = std::max(facts.flatness, there.beta);
            facts.least = std::min(facts.least, there.least);
            facts.greatest = std::max(facts.greatest, there.greatest);
        }
    }

    /// Tells the corners of a leaf what they cannot know from nodes, and the summary of the leaf.
    void seed(std::size_t leaf) {
        const LeafFacts& facts = facts_[leaf];
        const auto corners =
            std::span(leaves_[leaf]).first(records_.leaves()[leaf].parts().corners);
        summary_->greatest_beta = std::max(summary_->greatest_beta, facts.beta);
        double error = facts.beta;
        double lo = std::numeric_limits<double>::infinity();
        double hi = -lo;
        double low = facts.least;
        double high = facts.greatest;
        double jump = 0;
        double moved = 0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const double at_corner = value(corners[k], 0);
            const auto off = static_cast<double>(node(corners[k]).off);
            lo = std::min(lo, at_corner);
            hi = std::max(hi, at_corner);
            low = std::min(low, at_corner - off);
            high = std::max(high, at_corner + off);
            const double* const own = at_corners_.data() + (leaf * max_corners + k) * drawn_;
            jump = std::max(jump, norm_of(drawn_, [&](std::size_t c) {
                                return own[c] - value(corners[k], c);
                            }));
            moved = std::max(moved, deviation_[corners[k]]);
        }
        const float jumps = std::max(facts.jump, detail::float_above(jump));
        summary_->jumps.push_back(jumps);
        if (drawn_ == 1) summary_->add_range(low, high);
        // What is inside parts is that of the records, which are off by the jumps.
        error += drawn_ == 1 ? jump : jump + static_cast<double>(jumps);
        if (drawn_ == 1) error = std::max({error, facts.greatest - hi, lo - facts.least});
        error += moved;
        for (const std::uint32_t number : corners) {
            RealNode& corner = node(number);
            raise(corner.bound, error);
            raise(corner.stop, flat_share * facts.flatness);
        }
    }

    /// Fine to coarse, level by level: `bound` without the node's own part is that of finer nodes.
    void sweep() {
        for (std::size_t end = splits_.size(); end > 0;) {
            std::size_t begin = end;
            while (begin > 0 && splits_[begin - 1].level == splits_[end - 1].level) --begin;
            const auto level = std::span(splits_).subspan(begin, end - begin);
            for (const Split& split : level) add_own_part(split);
            for (const Split& split : level) put_stop(split);
            for (const Split& split : level) raise_corners(split);
            end = begin;
        }
    }

    static std::span<const std::uint32_t> made_by(const Split& split) {
        return std::span(split.node)
            .subspan(static_cast<std::size_t>(split.rule->corner_count()),
                     split.rule->new_nodes.size());
    }

    /// Once for each node, when all finer nodes are done.
    void add_own_part(const Split& split) {
        done_.resize(nodes_->nodes_.size(), false);
        for (const std::uint32_t number : made_by(split)) {
            if (done_[number]) continue;
            done_[number] = true;
            RealNode& made = node(number);
            made.bound = detail::float_above(
                (static_cast<double>(made.bound) + static_cast<double>(made.off)) * rounding);
        }
    }

    /// On an element that stops, U differs from the interpolant of its true corner values by at
    /// most `below`, and those from P_S U by the offsets of the corners that S holds at: by at most
    /// `bound` in all. The triangles leave P_S U by twice its affine residual, which is that of the
    /// true values, moved by at most 5 / 2 bound on boxes, 8 / 3 on prisms, bound on pyramids, and
    /// 0 on simplices. Together that is 6 bound + 2 residual, or 19 / 3, or 3, or 1.
    void put_stop(const Split& split) {
        const auto corners = static_cast<std::size_t>(split.rule->corner_count());
        const Shape shape = split.rule->parent;
        const Factors factors = factors_of(shape);
        const bool pyramid = shape == Shape::pyramid;
        const double share = pyramid                  ? 3
                             : factors.count == 1     ? 1
                             : factors.all_segments() ? 6
                                                      : 19.0 / 3;
        const double residual = norm_of(drawn_, [&](std::size_t c) {
            std::array<double, max_corners> u;
            for (std::size_t k = 0; k < corners; ++k) u[k] = value(split.node[k], c);
            return pyramid ? pyramid_residual(u)
                           : fit_affine(std::span(u).first(corners), factors).residual;
        });
        double below = 0;
        for (const std::uint32_t made : made_by(split)) {
            below = std::max(below, static_cast<double>(node(made).bound));
        }
        for (const std::uint32_t made : made_by(split)) {
            raise(node(made).stop, share * below + 2 * residual);
        }
    }

    void raise_corners(const Split& split) {
        float stop = 0;
        float bound = 0;
        float size = 0;
        for (const std::uint32_t number : made_by(split)) {
            const RealNode& made = node(number);
            size = std::max(size, made.size);
            stop = std::max(stop, made.stop);
            bound = std::max(bound, made.bound);
        }
        for (const std::uint32_t number :
             std::span(split.node).first(static_cast<std::size_t>(split.rule->corner_count()))) {
            RealNode& corner = node(number);
            corner.stop = std::max(corner.stop, stop);
            corner.bound = std::max(corner.bound, bound);
            raise(corner.size, 1.25 * static_cast<double>(size));
        }
    }

    RealNodes* nodes_;
    LeafSummary* summary_;
    LeafRecords records_;
    std::size_t components_;
    std::size_t drawn_;
    std::vector<std::uint32_t> first_;  // the first leaf that has a node
    std::vector<OfOwner> hanging_;      // nodes, by owner, as the next one
    std::vector<OfOwner> halved_;       // parts that nodes halve
    std::vector<LeafFacts> facts_;
    std::vector<double> at_corners_;  // what leaves have there, of the components that are drawn
    std::vector<LeafNodes> leaves_;
    std::vector<Split> splits_;      // coarse to fine
    std::vector<double> deviation_;  // how far P_S U may be from U at a node that hangs
    std::vector<bool> done_;
};

RealNodes::RealNodes(std::uint64_t epoch, const LeafFunction& function, const BaseWalk& walk,
                     LeafSummary& summary)
    : epoch_{epoch}, components_{summary.components} {
    Preroll(*this, function, walk, summary).run();
    least_ = summary.least[0];
    greatest_ = summary.greatest[0];
    nodes_.shrink_to_fit();
    parts_.shrink_to_fit();
    values_.shrink_to_fit();
}

}  // namespace nestgrid::engine
