// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/real_nodes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <high_order/node_preroll.hpp>
#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

RealNodes::HalvedPart::HalvedPart(const PartOfLeaf& part)
    : leaf{part.leaf},
      level{static_cast<std::uint8_t>(part.level)},
      count{static_cast<std::uint8_t>(part.count)} {
    for (std::size_t i = 0; i < part.count; ++i) {
        for (std::size_t d = 0; d < 3; ++d) {
            corner[i][d] = static_cast<std::int32_t>(part.corner[i][d]);
        }
    }
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

void RealNodes::Preroll::run() {
    std::stable_sort(splits_.begin(), splits_.end(),
                     [](const Split& a, const Split& b) { return a.level < b.level; });
    deviation_.resize(nodes_->nodes_.size());
    for (const Split& split : splits_) put_offsets(split);
    summary_->reserve(leaves_.size());
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) seed(leaf);
    sweep();
}

/// Fathers come first: what moves the parents is known.
void RealNodes::Preroll::put_offsets(const Split& split) {
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
void RealNodes::Preroll::seed(std::size_t leaf) {
    const LeafFacts& facts = facts_[leaf];
    const auto corners = std::span(leaves_[leaf]).first(records_.leaves()[leaf].parts().corners);
    summary_->greatest_beta = std::max(summary_->greatest_beta, facts.beta);
    double error = facts.beta;
    double lo = std::numeric_limits<double>::infinity();
    double hi = -lo;
    double low = facts.least;
    double high = facts.greatest;
    double moved = 0;
    double greatest_off = 0;
    for (const auto& corner : corners) {
        const double at_corner = value(corner, 0);
        const auto off = static_cast<double>(node(corner).off);
        lo = std::min(lo, at_corner);
        hi = std::max(hi, at_corner);
        low = std::min(low, at_corner - off);
        high = std::max(high, at_corner + off);
        moved = std::max(moved, deviation_[corner]);
        greatest_off = std::max(greatest_off, off);
    }
    const double jump = facts.corner_jump;
    const float jumps = std::max(facts.jump, detail::float_above(jump));
    summary_->jumps.push_back(jumps);
    if (drawn_ == 1) summary_->add_range(low, high);
    // What is inside parts is that of the records, which are off by the jumps.
    error += drawn_ == 1 ? jump : jump + static_cast<double>(jumps);
    if (drawn_ == 1) error = std::max({error, facts.greatest - hi, lo - facts.least});
    error += moved;
    if (drawn_ > 1) {
        summary_->beyond_hull.push_back(
            nestgrid::detail::float_above((error + greatest_off) * rounding));
    }
    for (const std::uint32_t number : corners) {
        RealNode& corner = node(number);
        raise(corner.bound, error);
        raise(corner.stop, flat_share * facts.flatness);
    }
}

/// Fine to coarse, level by level: `bound` without the node's own part is that of finer nodes.
void RealNodes::Preroll::sweep() {
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
void RealNodes::Preroll::add_own_part(const Split& split) {
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
void RealNodes::Preroll::put_stop(const Split& split) {
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

void RealNodes::Preroll::raise_corners(const Split& split) {
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

RealNodes::RealNodes(std::uint64_t epoch, const LeafFunction& function, const BaseWalk& walk,
                     LeafSummary& summary, const Executor& executor)
    : epoch_{epoch}, components_{summary.components} {
    Preroll(*this, function, walk, summary, executor).run();
    least_ = summary.least[0];
    greatest_ = summary.greatest[0];
    nodes_.shrink_to_fit();
    parts_.shrink_to_fit();
    values_.shrink_to_fit();
}

}  // namespace nestgrid::engine
