// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/real_nodes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

namespace {

/// Sums of few terms are this much larger at most than they are computed.
constexpr double rounding = 1 + 1e-12;

double diameter_of(std::span<const Point> corners) {
    double diameter = 0;
    for (const Point& a : corners) {
        for (const Point& b : corners) diameter = std::max(diameter, norm(a - b));
    }
    return diameter;
}

void raise(float& number, double to) {
    number = std::max(number, detail::float_above(to * rounding));
}

}  // namespace

/// Fills the table. Numbers of nodes are those of RealNodes::nodes_.
class RealNodes::Preroll {
public:
    Preroll(RealNodes& nodes, const BaseWalk& walk, LeafRecords& records, LeafSummary& summary)
        : nodes_{&nodes},
          records_{&records},
          summary_{&summary},
          components_{records.components()},
          drawn_{records.drawn()} {
        walk.for_each([this](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule == nullptr) add_leaf(way);
        });
        const auto add = [this](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule != nullptr) add_split(way);
        };
        walk.for_each(add, BaseWalk::Positions::yes);
        std::stable_sort(splits_.begin(), splits_.end(),
                         [](const Split& a, const Split& b) { return a.level < b.level; });
        deviation_.resize(nodes.nodes_.size());
    }

    void run() {
        for (const Split& split : splits_) put_offsets(split);
        summary_->jumps.reserve(leaves_.size());
        if (drawn_ == 1) summary_->ranges.reserve(leaves_.size());
        for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) seed(leaf);
        sweep();
    }

private:
    RealNode& node(std::uint32_t number) { return nodes_->nodes_[number]; }
    double value(std::uint32_t number, std::size_t c) const {
        return nodes_->values_[number * components_ + c];
    }

    /// Makes the corners of a leaf known. A corner inside a larger leaf's part has the value of the
    /// record, any other that of the first leaf that has it.
    void add_leaf(std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        LeafNodes corner{};
        const LeafPolynomial& from = records_->leaves()[leaves_.size()];
        for (std::size_t k = 0; k < e.shape->corners; ++k) {
            const auto fresh = static_cast<std::uint32_t>(nodes_->nodes_.size());
            const auto [at, is_new] = nodes_->number_.insert(e.key[k], fresh);
            corner[k] = *at;
            if (is_new) {
                nodes_->nodes_.emplace_back();
                for (std::size_t c = 0; c < components_; ++c) {
                    nodes_->values_.push_back(
                        records_->net(from, c)[net_corner(from.degree, from.factors(), k)]);
                }
            }
            if (node(corner[k]).hangs) continue;
            const Place place = e.shape->reference_corner(k);
            const OnRecord hangs_on = records_->around(way, std::span(&place, 1));
            if (hangs_on.record < 0) continue;
            node(corner[k]).hangs = true;
            records_->values_at(hangs_on, nodes_->values_.data() + corner[k] * components_);
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
        RealNode& made = node(split.node[shape.corners + n]);
        if (!made.hangs || made.halves > 0) return;
        const std::array<Place, 4> places = corners_of(shape, part);
        const OnRecord on = records_->around(way, std::span(places).first(part.count));
        if (on.record < 0) return;
        made.shift = static_cast<std::uint8_t>(on.shift);
        made.beta = records_->facts_on(on).beta;
        made.halves = static_cast<std::uint32_t>(nodes_->parts_.size());
        const PartOfLeaf in = records_->in_owner(on);
        HalvedPart half{
            in.leaf, static_cast<std::uint8_t>(in.level), static_cast<std::uint8_t>(in.count), {}};
        for (std::size_t i = 0; i < in.count; ++i) {
            for (std::size_t d = 0; d < 3; ++d) {
                half.corner[i][d] = static_cast<std::int32_t>(in.corner[i][d]);
            }
        }
        nodes_->parts_.push_back(half);
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

    /// Tells the corners of a leaf what they cannot know from nodes, and the summary of the leaf.
    void seed(std::size_t leaf) {
        const LeafPolynomial& of = records_->leaves()[leaf];
        const auto corners = std::span(leaves_[leaf]).first(of.parts().corners);
        NetFacts facts = records_->facts_of(of);
        summary_->greatest_beta = std::max(summary_->greatest_beta, facts.beta);
        double error = facts.beta;
        double flatness = facts.beta;
        for (std::size_t part = 0; part < of.parts().parts.size(); ++part) {
            const NetFacts there = records_->facts_on(of, part);
            flatness = std::max(flatness, there.beta);
            facts.least = std::min(facts.least, there.least);
            facts.greatest = std::max(facts.greatest, there.greatest);
        }
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
            const std::size_t own = net_corner(of.degree, of.factors(), k);
            jump = std::max(jump, norm_of(drawn_, [&](std::size_t c) {
                                return records_->net(of, c)[own] - value(corners[k], c);
                            }));
            moved = std::max(moved, deviation_[corners[k]]);
        }
        const float jumps = std::max(of.jump, detail::float_above(jump));
        summary_->jumps.push_back(jumps);
        if (drawn_ == 1) summary_->add_range(low, high);
        // What is inside parts is that of the records, which are off by the jumps.
        error += drawn_ == 1 ? jump : jump + static_cast<double>(jumps);
        if (drawn_ == 1) error = std::max({error, facts.greatest - hi, lo - facts.least});
        error += moved;
        for (const std::uint32_t number : corners) {
            RealNode& corner = node(number);
            raise(corner.bound, error);
            raise(corner.stop, flat_share * flatness);
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
    LeafRecords* records_;
    LeafSummary* summary_;
    std::size_t components_;
    std::size_t drawn_;
    std::vector<LeafNodes> leaves_;
    std::vector<Split> splits_;      // coarse to fine
    std::vector<double> deviation_;  // how far P_S U may be from U at a node that hangs
    std::vector<bool> done_;
};

RealNodes::RealNodes(std::uint64_t epoch, const BaseWalk& walk, LeafRecords& records,
                     LeafSummary& summary)
    : epoch_{epoch},
      components_{summary.components},
      least_{summary.least[0]},
      greatest_{summary.greatest[0]} {
    Preroll(*this, walk, records, summary).run();
    nodes_.shrink_to_fit();
    parts_.shrink_to_fit();
    values_.shrink_to_fit();
}

PartOfLeaf RealNodes::part_halved(const RealNode& node) const {
    const HalvedPart& half = parts_[node.halves];
    PartOfLeaf part{half.leaf, half.level, {}, half.count};
    for (std::size_t i = 0; i < half.corner.size(); ++i) {
        std::copy(half.corner[i].begin(), half.corner[i].end(), part.corner[i].begin());
    }
    return part;
}

double RealNodes::offset_bound(NodeKey key) const {
    const RealNode* const node = find(key);
    return node == nullptr ? 0 : static_cast<double>(node->off);
}

/// Virtual nodes are in no table: their elements bring their own bounds (Member::beyond).
double RealNodes::bound(const Rule&, std::span<const NodeKey> keys) const {
    float bound = 0;
    for (const NodeKey key : keys) {
        const RealNode* const node = find(key);
        if (node != nullptr) bound = std::max(bound, node->bound);
    }
    return static_cast<double>(bound);
}

std::size_t RealNodes::memory_bytes() const {
    return nodes_.capacity() * sizeof(RealNode) + parts_.capacity() * sizeof(HalvedPart) +
           values_.capacity() * sizeof(double) + number_.memory_bytes();
}

}  // namespace nestgrid::engine
