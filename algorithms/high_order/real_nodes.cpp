// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/real_nodes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

namespace {

/// Sums of few terms are this much larger at most than they are computed.
constexpr double rounding = 1 + 1e-12;

void raise(float& number, double to) { number = std::max(number, float_above(to * rounding)); }

}  // namespace

/// Fills the table. Numbers of nodes are those of RealNodes::nodes_.
class RealNodes::Preroll {
public:
    Preroll(RealNodes& nodes, const BaseWalk& walk, LeafRecords& records)
        : nodes_{&nodes},
          records_{&records},
          rule_{&walk.rule()},
          dimension_{records.dimension()},
          corners_{std::size_t{1} << static_cast<unsigned>(dimension_)},
          halved_{halved_parts(walk.rule())} {
        walk.for_each([this](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule == nullptr) add_leaf(way);
        });
        walk.for_each([this](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule != nullptr) add_split(way);
        });
        std::stable_sort(splits_.begin(), splits_.end(),
                         [](const Split& a, const Split& b) { return a.level < b.level; });
        deviation_.resize(nodes.nodes_.size());
    }

    void run() {
        for (const Split& split : splits_) put_offsets(split);
        for (const Leaf& leaf : leaves_) seed(leaf);
        sweep();
    }

private:
    RealNode& node(std::uint32_t number) { return nodes_->nodes_[number]; }
    double value(std::uint32_t number) const {
        return nodes_->values_[number * records_->components()];
    }

    /// Makes the corners of a leaf known. A corner inside a larger leaf's part has the value of the
    /// record, any other that of the first leaf that has it.
    void add_leaf(std::span<const BaseElement> way) {
        const std::size_t number = records_->leaf_at(way.back().path);
        const LeafPolynomial& from = records_->leaves()[number];
        const std::size_t components = records_->components();
        Leaf leaf{{}, number};
        for (std::size_t k = 0; k < corners_; ++k) {
            const auto fresh = static_cast<std::uint32_t>(nodes_->nodes_.size());
            const auto [at, is_new] = nodes_->number_.insert(way.back().key[k], fresh);
            leaf.corner[k] = *at;
            if (is_new) {
                nodes_->nodes_.emplace_back();
                for (std::size_t c = 0; c < components; ++c) {
                    nodes_->values_.push_back(
                        records_->net(from, c)[net_corner(from.degree, dimension_, k)]);
                }
            }
            if (node(leaf.corner[k]).hangs) continue;
            const BoxPlace place{static_cast<std::uint32_t>(k & 1U),
                                 static_cast<std::uint32_t>(k >> 1U & 1U),
                                 static_cast<std::uint32_t>(k >> 2U)};
            const RecordPlace hangs_on = records_->place_of(way, 0, place);
            if (hangs_on.record < 0) continue;
            node(leaf.corner[k]).hangs = true;
            records_->values_at(hangs_on, place, 0,
                                nodes_->values_.data() + leaf.corner[k] * components);
        }
        leaves_.push_back(leaf);
    }

    void add_split(std::span<const BaseElement> way) {
        const BoxSplitKeys keys = split_keys_of(way.back().key, *rule_);
        Split split{{}, static_cast<int>(way.size())};
        const std::size_t count = corners_ + rule_->new_nodes.size();
        for (std::size_t n = 0; n < count; ++n) {
            split.node[n] = *nodes_->number_.find(keys[n]);  // a corner of a leaf
            if (n < corners_) continue;
            RealNode& made = node(split.node[n]);
            const HalvedPart& part = halved_[n - corners_];
            if (!made.hangs) continue;
            const RecordPlace place = records_->place_of(way, part.span, part.at);
            if (place.record < 0) continue;
            made.shift = place.shift;
            made.beta = records_->facts_on(place, part.span, part.at, 0).beta;
        }
        splits_.push_back(split);
    }

    /// Fathers come first: what moves the parents is known.
    void put_offsets(const Split& split) {
        std::array<double, 27> u;
        for (std::size_t n = 0; n < corners_ + rule_->new_nodes.size(); ++n) {
            u[n] = value(split.node[n]);
        }
        for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
            const Stencil& stencil = rule_->new_nodes[n];
            const std::uint32_t number = split.node[corners_ + n];
            RealNode& made = node(number);
            double off =
                std::abs(u[corners_ + n] - nestgrid::detail::interpolate(stencil, u.data(), 1));
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

    /// Tells the corners of a leaf what they cannot know from nodes.
    void seed(const Leaf& leaf) {
        const LeafPolynomial& of = records_->leaves()[leaf.leaf];
        NetFacts facts = net_facts(records_->net(of), of.degree, dimension_);
        double error = facts.beta;
        double flatness = facts.beta;
        for (PartCode part = 0; part + 1 < part_count(dimension_); ++part) {
            if (of.part[part].record < 0) continue;
            const unsigned low = low_corner_of(part, dimension_);
            const NetFacts there = records_->facts_on(of.part[part], span_of(part, dimension_),
                                                      {low & 1U, low >> 1U & 1U, low >> 2U}, 0);
            flatness = std::max(flatness, there.beta);
            facts.least = std::min(facts.least, there.least);
            facts.greatest = std::max(facts.greatest, there.greatest);
        }
        double lo = std::numeric_limits<double>::infinity();
        double hi = -lo;
        double jump = 0;
        double moved = 0;
        for (std::size_t k = 0; k < corners_; ++k) {
            const double u = value(leaf.corner[k]);
            const double own = records_->net(of)[net_corner(of.degree, dimension_, k)];
            lo = std::min(lo, u);
            hi = std::max(hi, u);
            jump = std::max(jump, std::abs(own - u));
            moved = std::max(moved, deviation_[leaf.corner[k]]);
        }
        records_->raise_jump(leaf.leaf, jump);
        error = std::max({error + jump, facts.greatest - hi, lo - facts.least}) + moved;
        for (std::size_t k = 0; k < corners_; ++k) {
            RealNode& corner = node(leaf.corner[k]);
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

    /// Once for each node, when all finer nodes are done.
    void add_own_part(const Split& split) {
        done_.resize(nodes_->nodes_.size(), false);
        for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
            const std::uint32_t number = split.node[corners_ + n];
            if (done_[number]) continue;
            done_[number] = true;
            RealNode& made = node(number);
            made.bound = float_above(
                (static_cast<double>(made.bound) + static_cast<double>(made.off)) * rounding);
        }
    }

    /// On an element that stops, U differs from the interpolant of its true corner values by at
    /// most `below`, and those from P_S U by the offsets of the corners that S holds at: by at most
    /// `bound` in all. The triangles leave P_S U by twice its affine residual, which is that of the
    /// true values, moved by at most 5 / 2 bound. Together that is 6 bound + 2 residual.
    void put_stop(const Split& split) {
        std::array<double, max_box_corners> u;
        for (std::size_t k = 0; k < corners_; ++k) u[k] = value(split.node[k]);
        const double residual = fit_affine(std::span(u).first(corners_), dimension_).residual;
        double below = 0;
        for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
            below = std::max(below, static_cast<double>(node(split.node[corners_ + n]).bound));
        }
        for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
            RealNode& made = node(split.node[corners_ + n]);
            raise(made.stop, 6 * below + 2 * residual);
        }
    }

    void raise_corners(const Split& split) {
        float stop = 0;
        float bound = 0;
        for (std::size_t n = 0; n < rule_->new_nodes.size(); ++n) {
            const RealNode& made = node(split.node[corners_ + n]);
            stop = std::max(stop, made.stop);
            bound = std::max(bound, made.bound);
        }
        for (std::size_t k = 0; k < corners_; ++k) {
            RealNode& corner = node(split.node[k]);
            corner.stop = std::max(corner.stop, stop);
            corner.bound = std::max(corner.bound, bound);
        }
    }

    RealNodes* nodes_;
    LeafRecords* records_;
    const Rule* rule_;
    int dimension_;
    std::size_t corners_;
    std::vector<HalvedPart> halved_;
    std::vector<Leaf> leaves_;
    std::vector<Split> splits_;      // coarse to fine
    std::vector<double> deviation_;  // how far P_S U may be from U at a node that hangs
    std::vector<bool> done_;
};

RealNodes::RealNodes(const Hierarchy<double>& base, const BaseWalk& walk, LeafRecords& records)
    : records_{&records}, epoch_{base.epoch()} {
    Preroll(*this, walk, records).run();
    nodes_.shrink_to_fit();
    values_.shrink_to_fit();
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
    return nodes_.capacity() * sizeof(RealNode) + values_.capacity() * sizeof(double) +
           number_.memory_bytes();
}

}  // namespace nestgrid::engine
