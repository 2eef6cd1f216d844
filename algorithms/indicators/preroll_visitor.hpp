// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cmath>
#include <functional>
#include <string>

#include <indicators/offset.hpp>
#include <indicators/preroll.hpp>
#include <indicators/preroll_log.hpp>
#include <indicators/spread.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <walk/frontier.hpp>
#include <walk/walk_steps.hpp>

namespace nestgrid::engine {

/// Whether a walk is to enter an element.
template <class Real>
using ElementTest = std::function<bool(const ElementView<Real>&, const Split&)>;

/// Tells a receiver of the splits and leaves that a walk meets, and collects facts about them.
/// \tparam Receiver Sweeps or PrerollLog
template <class Real, class Receiver>
class PrerollVisitor final : public TaskVisitor<Real> {
public:
    using View = ElementView<Real>;

    PrerollVisitor(const Walk<Real>& walk, const PrerollRequest& request, Receiver& receiver)
        : walk_{&walk}, request_{&request}, receiver_{&receiver}, deviations_(walk) {}

    const detail::PrerollFacts& facts() const { return facts_; }

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule&, const Real*, NodeMask which, bool) override {
        return {0, *request_->leaf_errors ? which : NodeMask{0}};
    }

    /// Elements for which `enters` is false are left out, with all below them.
    void restrict_to(const ElementTest<Real>& enters) { enters_ = &enters; }

    Decision inspect(const View& view, const Split& split) override {
        if (enters_ != nullptr && !(*enters_)(view, split)) return {Visit::skip, 0};
        if (view.level == 0) add_coarse_values(view);
        if (split.rule != nullptr) return {};
        if (*request_->leaf_errors) {
            receiver_->leaf(corner_keys(view), error_of(view));
        } else if (view.level == 0) {
            receiver_->leaf(corner_keys(view), 0);  // the nodes of a coarse leaf count, too
        }
        return {};
    }

    void entered(const View& view, const Split& split, const Real* value) override {
        const std::size_t stride = walk_->components();
        const Rule& rule = *split.rule;
        const std::size_t corners = corner_keys(view).size();
        facts_.largest_split = std::max(facts_.largest_split, rule.new_nodes.size());
        facts_.all_divided = facts_.all_divided && rule.divides_all;
        facts_.finest_level = std::max(facts_.finest_level, view.level + 1);
        facts_.longest_chain = std::max(facts_.longest_chain, rule.steps);
        if ((split.constrained & ~split.unseen & rule.all()) != 0)
            compare_hanging(view, split, value);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            if ((split.constrained >> n & 1U) != 0) continue;
            facts_.add_value(static_cast<double>(value[(corners + n) * stride]), limit_);
        }
        std::ranges::copy(split.keys, keys_.data() + corners);
        receiver_->split({split.rule, view.level, split.outside, reach(view, split),
                          std::span<const NodeKey>(keys_).first(corners + split.keys.size())},
                         [&](std::size_t n) {
                             if ((split.constrained >> n & 1U) != 0) return 0.0F;
                             const Real mean =
                                 nestgrid::detail::interpolate(rule.new_nodes[n], value, stride);
                             return offset_above(value[(corners + n) * stride], mean);
                         });
        if (request_->deviations) deviations_.enter(view, split, value, left_);
    }
    /// To be called when the walk is over.
    void finish() { deviations_.finish(left_); }

    void extract(const View&) override {}
    void walk_below(const Walk<Real>& walk, const View& view) override {
        walk.walk_below_as(view, *this);
    }

    Decision look(const View&, const Split&) override { return {}; }
    void undo() override {}
    void restart() override {
        deviations_.clear();
        if constexpr (std::is_same_v<Receiver, PrerollLog>) receiver_->clear();
    }

private:
    static constexpr double limit_ = static_cast<double>(std::numeric_limits<Real>::max() / 8);

    std::span<const NodeKey> corner_keys(const View& view) {
        walk_->corners(view, keys_.data(), nullptr);
        return std::span(keys_).first(view.corner_count());
    }

    void add_coarse_values(const View& view) {
        const NodeMask unseen = walk_->unseen_corners(view);
        for (std::size_t i = 0; i < view.corner_count(); ++i) {
            if ((unseen >> i & 1U) != 0) continue;
            facts_.add_value(static_cast<double>(view.value[i * walk_->components()]), limit_);
        }
    }

    /// How far the split hands `stop` on; 0 where distances do not count.
    float reach(const View& view, const Split& split) {
        if (!request_->measures) return 0;
        return reach_of(*split.rule, walk_->split_positions(view, split, positions_));
    }

    float error_of(const View& leaf) const {
        const double error = (*request_->leaf_errors)(leaf.element());
        if (!(error >= 0)) {
            throw InvalidInput("the error of a leaf is not a usable number: " +
                               std::to_string(error));
        }
        return detail::float_above(error);
    }

    /// Compares the values of the field at hanging nodes, where it has any, with those that the
    /// walk uses.
    void compare_hanging(const View& view, const Split& split, const Real* value) {
        const std::size_t stride = walk_->components();
        const Rule& rule = *split.rule;
        const NodeMask hanging = split.constrained & ~split.unseen & rule.all();
        const std::size_t corners = view.corner_count() * stride;
        given_.assign(value, value + corners);
        given_.resize(corners + rule.new_nodes.size() * stride);
        const NodeMask missing = walk_->hierarchy().new_values(
            view.stack->task.get(), view.element(), rule, hanging, given_.data());
        for (NodeMask left = hanging & ~missing; left != 0; left &= left - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(left));
            const Real used = value[(view.corner_count() + n) * stride];
            const double off = std::abs(static_cast<double>(given_[corners + n * stride]) -
                                        static_cast<double>(used));
            if (!(off <= facts_.hanging_violation)) facts_.hanging_violation = off;
        }
    }

    const Walk<Real>* walk_;
    const PrerollRequest* request_;
    Receiver* receiver_;
    PathDeviations<Real> deviations_;
    std::function<void(const Deviation&)> left_ = [this](const Deviation& d) {
        receiver_->deviation(d);
    };
    const ElementTest<Real>* enters_ = nullptr;
    detail::PrerollFacts facts_;
    std::array<NodeKey, max_corners + max_new_nodes> keys_;
    SplitPositions positions_;
    std::vector<Real> given_;
};

}  // namespace nestgrid::engine
