// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What must hold of criteria, judged by brute force: by walks that never stop.
#pragma once

#include <functional>
#include <unordered_map>

#include <gtest/gtest.h>

#include <nestgrid/detail/interpolate.hpp>
#include <walk/criterion_question.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/walk.hpp>

#include "closedness.hpp"

namespace nestgrid_test {

/// What is known of a split: keys and true positions of the corners and, behind them, of the new
/// nodes.
struct JudgedSplit {
    const Rule& rule;
    std::span<const NodeKey> keys;
    std::span<const Point> positions;
    NodeMask constrained;
    std::size_t corner_count() const { return static_cast<std::size_t>(rule.corner_count()); }
};

/// Calls a function for every split.
class JudgedSplitVisitor final : public engine::Visitor<double> {
public:
    using View = engine::ElementView<double>;

    JudgedSplitVisitor(const engine::Walk<double>& walk,
                       const std::function<void(const JudgedSplit&)>& function)
        : walk_{&walk}, function_{&function} {}

    bool sees_hidden() const override { return true; }
    engine::Decision inspect(const View&, const engine::Split&) override { return {}; }
    void extract(const View&) override {}
    void entered(const View& view, const engine::Split& split, const double*) override {
        (*function_)({*split.rule, walk_->split_keys(view, split, keys_),
                      walk_->split_positions(view, split, positions_), split.constrained});
    }

private:
    const engine::Walk<double>* walk_;
    const std::function<void(const JudgedSplit&)>* function_;
    engine::SplitKeys keys_{};
    engine::SplitPositions positions_{};
};

inline void for_each_judged_split(const Hierarchy<double>& hierarchy,
                                  const std::function<void(const JudgedSplit&)>& function) {
    const HangingNodes hanging = engine::find_hanging_nodes(hierarchy);
    const engine::Walk<double> walk(hierarchy, {.keys = true, .positions = true}, &hanging);
    JudgedSplitVisitor visitor(walk, function);
    walk.run(visitor);
}

/// The full condition: eta of a corner is at least factor * (eta of a new node + slope * distance).
inline void expect_saturated(const Hierarchy<double>& hierarchy, const Indicator& indicator) {
    std::size_t wrong = 0;
    const auto [factor, slope] = indicator.spread();
    for_each_judged_split(hierarchy, [&, factor = factor, slope = slope](const JudgedSplit& split) {
        for (std::size_t n = split.corner_count(); n < split.keys.size(); ++n) {
            for (std::size_t k = 0; k < split.corner_count(); ++k) {
                const double distance = norm(split.positions[n] - split.positions[k]);
                const double least = factor * (indicator.stop(split.keys[n]) + slope * distance);
                wrong += indicator.stop(split.keys[k]) >= least ? 0U : 1U;
            }
        }
    });
    EXPECT_EQ(wrong, 0U);
}

/// The projection with a criterion, at all nodes of the hierarchy.
class ProjectedNodes final : public engine::Visitor<double> {
public:
    using View = engine::ElementView<double>;

    /// \param isovalue elements that have it between their corners are drawn
    ProjectedNodes(const Hierarchy<double>& hierarchy, const Criterion& criterion, double isovalue)
        : hierarchy_{&hierarchy},
          criterion_{&criterion},
          isovalue_{isovalue},
          hanging_{engine::find_hanging_nodes(hierarchy)},
          walk_{hierarchy, {.keys = true, .positions = true}, &hanging_},
          stride_{walk_.components()} {
        walk_.run(*this);
    }

    /// P_S U at a node, component 0. It is a function of the node, but for faces that change their
    /// shape.
    const std::unordered_map<NodeKey, double>& values() const { return values_; }
    /// P_S G at a node.
    const std::unordered_map<NodeKey, Point>& positions() const { return positions_; }
    std::size_t stopped() const { return stopped_; }
    std::size_t drawn() const { return drawn_; }
    /// Corners of split elements that are interpolated: none under a saturated criterion.
    std::size_t interpolated_corners() const { return interpolated_corners_; }

    /// The greatest difference of component 0 to that of another projection.
    double difference(const ProjectedNodes& other) const {
        double greatest = 0;
        for (const auto& [key, value] : values_) {
            greatest = std::max(greatest, std::abs(value - other.values_.at(key)));
        }
        return greatest;
    }
    /// The same at the nodes in and around drawn elements.
    double difference_where_drawn(const ProjectedNodes& other) const {
        double greatest = 0;
        for (const auto& [key, value] : values_where_drawn_) {
            greatest = std::max(greatest, std::abs(value - other.values_.at(key)));
        }
        return greatest;
    }
    /// The greatest distance of these nodes to where another projection has them.
    double distance_where_drawn(const ProjectedNodes& other) const {
        double greatest = 0;
        for (const auto& [key, value] : values_where_drawn_) {
            greatest = std::max(greatest, norm(positions_.at(key) - other.positions_.at(key)));
        }
        return greatest;
    }

    engine::Decision inspect(const View& view, const engine::Split& split) override {
        if (view.level <= stop_level_) stop_level_ = none_;
        if (stop_level_ == none_) {
            const engine::Decision decision = split.rule == nullptr
                                                  ? engine::Decision{engine::Visit::stop, 0}
                                                  : question_.ask(walk_, *criterion_, view, split);
            if (decision.visit != engine::Visit::stop) {
                interpolated_corners_ += view.interpolated != 0 ? 1U : 0U;
                interpolated_ = decision.interpolated;
                return decision;
            }
            stop(view);
        }
        if (split.rule == nullptr) return {engine::Visit::stop, 0};
        return {engine::Visit::descend, split.rule->all()};
    }
    void extract(const View&) override {}
    void entered(const View& view, const engine::Split& split, const double* value) override {
        const auto keys = walk_.split_keys(view, split, keys_);
        const std::size_t corners = view.corner_count();
        engine::SplitPositions x;
        const bool below = stop_level_ != none_;
        walk_.split_positions(view, split, x);
        for (std::size_t n = 0; n < keys.size(); ++n) {
            const NodeMask bit = n < corners ? NodeMask{0} : NodeMask{1} << (n - corners);
            if (n >= corners && (below || ((interpolated_ | split.constrained) & bit) != 0)) {
                x[n] = nestgrid::detail::interpolate(split.rule->new_nodes[n - corners], x.data());
            }
            keep(keys[n], value[n * stride_], x[n], below && draws_);
        }
    }

private:
    static constexpr int none_ = -1;

    void stop(const View& view) {
        stop_level_ = view.level;
        ++stopped_;
        unsigned inside = 0;
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            inside += view.value[k * stride_] >= isovalue_ ? 1U : 0U;
        }
        draws_ = inside != 0 && inside != view.corner_count();
        drawn_ += draws_ ? 1U : 0U;
        std::array<NodeKey, max_corners> keys{};
        std::array<Point, max_corners> x{};
        walk_.corners(view, keys.data(), x.data());
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            keep(keys[k], view.value[k * stride_], x[k], draws_);
        }
    }
    void keep(NodeKey key, double value, const Point& x, bool drawn) {
        values_[key] = value;
        positions_[key] = x;
        if (drawn) values_where_drawn_[key] = value;
    }

    const Hierarchy<double>* hierarchy_;
    const Criterion* criterion_;
    double isovalue_;
    HangingNodes hanging_;
    engine::Walk<double> walk_;
    std::size_t stride_;
    engine::CriterionQuestion question_;
    engine::SplitKeys keys_{};
    std::unordered_map<NodeKey, double> values_;
    std::unordered_map<NodeKey, Point> positions_;
    std::unordered_map<NodeKey, double> values_where_drawn_;
    std::size_t stopped_ = 0;
    std::size_t drawn_ = 0;
    std::size_t interpolated_corners_ = 0;
    NodeMask interpolated_ = 0;  // of the split at hand, above stopped elements
    int stop_level_ = none_;
    bool draws_ = false;
};

}  // namespace nestgrid_test
