// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/key_frames.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

/// \throw GridError that says how a frame differs from the first one
void require_one_hierarchy(const HierarchicalIndicator& first, const HierarchicalIndicator& other,
                           std::size_t number) {
    const auto require = [number](bool same, const std::string& what) {
        if (!same) {
            throw GridError("frame " + std::to_string(number) + " is not of the grid of frame 0: " +
                            what + " (frames of several grids need a union of the grids)");
        }
    };
    const auto hanging_count = [](const HierarchicalIndicator& frame) {
        return frame.hanging() == nullptr ? std::size_t{0} : frame.hanging()->size();
    };
    const auto crosses = [](const HierarchicalIndicator& frame) {
        return frame.hanging() != nullptr && frame.hanging()->crossing() != nullptr;
    };
    require(first.epoch() == other.epoch(), "the grid has changed in between");
    require(first.node_count() == other.node_count(),
            "it has " + std::to_string(other.node_count()) + " nodes, not " +
                std::to_string(first.node_count()));
    require((first.entries().dense == nullptr) == (other.entries().dense == nullptr),
            "only one of them numbers its nodes");
    require(hanging_count(first) == hanging_count(other) && crosses(first) == crosses(other),
            "other nodes hang");
    require(first.generations() == other.generations() &&
                first.finest_level() == other.finest_level() &&
                first.stops_conform() == other.stops_conform() &&
                first.one_level_a_node() == other.one_level_a_node(),
            "its elements are split otherwise");
}

using Frames = std::vector<const HierarchicalIndicator*>;

/// W = sum |mu_i| max |U_i|, which no value of U(t) exceeds.
double sum_of_greatest(const Frames& frames, std::span<const float> weights) {
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        const double greatest =
            std::max(std::abs(frames[i]->least()), std::abs(frames[i]->greatest()));
        sum += std::abs(static_cast<double>(weights[i])) * greatest;
    }
    return sum;
}

/// Whether U(t) is one of the frames, bit for bit.
bool is_frame(std::span<const float> weights) {
    const auto count_of = [&](float w) { return std::ranges::count(weights, w); };
    return count_of(1.0F) == 1 && count_of(0.0F) + 1 == std::ssize(weights);
}

/// \throw InvalidInput where U(t) could leave the range of the type of its values
void require_in_range(const Frames& frames, std::span<const float> weights) {
    const double greatest = sum_of_greatest(frames, weights);
    const double range = frames.front()->roundoff() < std::numeric_limits<float>::epsilon() / 4
                             ? std::numeric_limits<double>::max()
                             : static_cast<double>(std::numeric_limits<float>::max());
    if (greatest <= range / 8 || is_frame(weights)) return;
    throw InvalidInput("a value between frames may be no usable number, as great as " +
                       std::to_string(greatest));
}

}  // namespace

KeyFrames::KeyFrames(std::vector<const HierarchicalIndicator*> frames,
                     std::span<const float> weights)
    : frames_{std::move(frames)} {
    const auto& all = frames_.frames();
    for (std::size_t i = 1; i < all.size(); ++i) require_one_hierarchy(first(), *all[i], i);
    set_weights(weights);
}

void KeyFrames::set_weights(std::span<const float> weights) {
    detail::require_weights(frames_.frames().size(), weights);
    require_in_range(frames_.frames(), weights);
    frames_.set_weights(weights);
    set_range(weights);
}

/// Computes the range of U(t) and how far rounding can take its values.
///
/// Let W = sum |mu_i| max |U_i|, and u the roundoff of values. Then U(t) at a node is off by at
/// most 2 u W for each frame. The mean of up to eight values of frame i is off by at most 9 u max
/// |U_i|, and so is that of values of U(t) at a hanging node by 9 u W. At a hanging node U(t)
/// therefore leaves the sum of the frames by at most 18 u W for each generation, and a value below
/// an element leaves its bounds by that much at the node and at a corner, and by 9 u W for each
/// generation between them.
void KeyFrames::set_range(std::span<const float> weights) {
    double roundoff = 0;
    least_ = greatest_ = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        const HierarchicalIndicator& frame = *frames_.frames()[i];
        const auto weight = static_cast<double>(weights[i]);
        const double at_least = weight * frame.least();
        const double at_greatest = weight * frame.greatest();
        least_ += std::min(at_least, at_greatest);
        greatest_ += std::max(at_least, at_greatest);
        roundoff = std::max(roundoff, frame.roundoff());
    }
    rounding_ = 0;
    if (frames_.term_count() == 0 || is_frame(weights)) return;
    const double most = sum_of_greatest(frames_.frames(), weights);
    const auto count = static_cast<double>(frames_.term_count());
    const double of_value =
        2 * count * (roundoff * most + std::numeric_limits<float>::denorm_min());
    rounding_ = 2 * of_value + 45 * first().generations() * roundoff * most;
    least_ -= of_value;
    greatest_ += of_value;
}

NodeMask KeyFrames::stops_at_most(const Rule& rule, std::span<const NodeKey> nodes,
                                  double epsilon) const {
    if (rule.inside != no_new_node && stop(nodes[rule.inside]) <= epsilon) return rule.all();
    return Indicator::stops_at_most(rule, nodes, epsilon);
}

/// Rounds a sum of bounds up, and adds what the rounding of values adds.
double KeyFrames::with_rounding(double sum) const {
    if (rounding_ == 0) return sum;
    return (sum + rounding_) * (1 + 0x1p-48);
}

double KeyFrames::bound(const Rule& rule, std::span<const NodeKey> nodes) const {
    const auto at = [this](NodeKey node) {
        return frames_.sum(
            [node](const HierarchicalIndicator& frame) { return frame.bound(node); });
    };
    if (rule.inside != no_new_node) return with_rounding(at(nodes[rule.inside]));
    double greatest = 0;
    for (const NodeKey node : nodes) greatest = std::max(greatest, at(node));
    return with_rounding(greatest);
}

double KeyFrames::offset_bound(NodeKey node) const {
    return with_rounding(frames_.sum(
        [node](const HierarchicalIndicator& frame) { return frame.offset_bound(node); }));
}

}  // namespace nestgrid
