// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/preroll.hpp>

#include <bit>
#include <cmath>
#include <string>

#include <indicators/offset.hpp>
#include <indicators/preroll_log.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

namespace {

/// Tells a receiver of the splits and leaves that a walk meets, and collects facts about them.
/// \tparam Receiver Sweeps or PrerollLog
template <class Real, class Receiver>
class PrerollVisitor final : public TaskVisitor<Real> {
public:
    using View = ElementView<Real>;

    PrerollVisitor(const Walk<Real>& walk, const LeafErrors& leaf_errors, bool measures,
                   Receiver& receiver)
        : walk_{&walk}, leaf_errors_{&leaf_errors}, measures_{measures}, receiver_{&receiver} {}

    const detail::PrerollFacts& facts() const { return facts_; }

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule&, const Real*, NodeMask which, bool) override {
        return {0, *leaf_errors_ ? which : NodeMask{0}};
    }

    Decision inspect(const View& view, const Split& split) override {
        if (view.level == 0) add_coarse_values(view);
        if (split.rule != nullptr) return {};
        if (*leaf_errors_) {
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
        if ((split.constrained & rule.all()) != 0) compare_hanging(view, split, value);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            if ((split.constrained >> n & 1U) != 0) continue;
            facts_.add_value(static_cast<double>(value[(corners + n) * stride]), limit_);
        }
        std::ranges::copy(split.keys, keys_.data() + corners);
        receiver_->split({split.rule, view.level, split.outside, reach_of(view, rule),
                          std::span<const NodeKey>(keys_).first(corners + split.keys.size())},
                         [&](std::size_t n) {
                             if ((split.constrained >> n & 1U) != 0) return 0.0F;
                             const Real mean =
                                 nestgrid::detail::interpolate(rule.new_nodes[n], value, stride);
                             return offset_above(value[(corners + n) * stride], mean);
                         });
    }

    void extract(const View&) override {}

    Decision look(const View&, const Split&) override { return {}; }
    void undo() override {}
    void restart() override {
        if constexpr (std::is_same_v<Receiver, PrerollLog>) receiver_->clear();
    }

private:
    static constexpr double limit_ = static_cast<double>(std::numeric_limits<Real>::max() / 8);

    std::span<const NodeKey> corner_keys(const View& view) {
        walk_->corners(view, keys_.data(), nullptr);
        return std::span(keys_).first(view.corner_count());
    }

    void add_coarse_values(const View& view) {
        for (std::size_t i = 0; i < view.corner_count(); ++i) {
            facts_.add_value(static_cast<double>(view.value[i * walk_->components()]), limit_);
        }
    }

    /// The greatest distance between a corner and a new node, rounded up; 0 where distances do not
    /// count.
    float reach_of(const View& view, const Rule& rule) const {
        if (!measures_) return 0;
        std::array<Point, max_corners> corner;
        std::array<Point, max_new_nodes> made;
        walk_->corners(view, nullptr, corner.data());
        walk_->new_positions(view, rule, std::span(made).first(rule.new_nodes.size()));
        double greatest = 0;
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            for (std::size_t k = 0; k < view.corner_count(); ++k) {
                greatest = std::max(greatest, norm(made[n] - corner[k]));
            }
        }
        return float_above(greatest);
    }

    float error_of(const View& leaf) const {
        const double error = (*leaf_errors_)(leaf.element());
        if (!(error >= 0)) {
            throw InvalidInput("the error of a leaf is not a usable number: " +
                               std::to_string(error));
        }
        return float_above(error);
    }

    /// Compares the values of the field at hanging nodes, where it has any, with those that the
    /// walk uses.
    void compare_hanging(const View& view, const Split& split, const Real* value) {
        const std::size_t stride = walk_->components();
        const Rule& rule = *split.rule;
        const NodeMask hanging = split.constrained & rule.all();
        given_.resize(rule.new_nodes.size() * stride);
        const NodeMask missing = walk_->hierarchy().new_values(
            view.stack->task.get(), view.element(), rule, hanging, given_.data());
        for (NodeMask left = hanging & ~missing; left != 0; left &= left - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(left));
            const Real used = value[(view.corner_count() + n) * stride];
            const double off =
                std::abs(static_cast<double>(given_[n * stride]) - static_cast<double>(used));
            if (!(off <= facts_.hanging_violation)) facts_.hanging_violation = off;
        }
    }

    const Walk<Real>* walk_;
    const LeafErrors* leaf_errors_;
    bool measures_;  // distances count
    Receiver* receiver_;
    detail::PrerollFacts facts_;
    std::array<NodeKey, max_corners + max_new_nodes> keys_;
    std::vector<Real> given_;
};

template <class Real>
detail::PrerollFacts walk_with_threads(const Walk<Real>& walk, const LeafErrors& leaf_errors,
                                       bool measures, Sweeps& sweeps, const Executor& executor) {
    struct Part {
        PrerollLog log;
        detail::PrerollFacts facts;
    };
    using LoggingVisitor = PrerollVisitor<Real, PrerollLog>;
    PrerollLog above;
    LoggingVisitor visitor(walk, leaf_errors, measures, above);
    const std::size_t wanted = 64 * executor.concurrency();  // many parts, so that logs stay short
    const Frontier<Real> frontier(walk, visitor, wanted);
    above.repeat(sweeps);
    detail::PrerollFacts facts = visitor.facts();
    const std::size_t entries = frontier.entry_count();
    std::vector<std::unique_ptr<Part>> parts(std::min(entries, wanted));
    executor.run(
        parts.size(),
        [&](std::size_t i) {
            parts[i] = std::make_unique<Part>();
            LoggingVisitor below(walk, leaf_errors, measures, parts[i]->log);
            frontier.run(walk, i * entries / parts.size(), (i + 1) * entries / parts.size(), below);
            parts[i]->facts = below.facts();
        },
        [&](std::size_t i) {
            const std::unique_ptr<Part> part = std::move(parts[i]);
            part->log.repeat(sweeps);
            facts.add(part->facts);
        });
    return facts;
}

}  // namespace

template <class Real>
detail::PrerollFacts walk_preroll(const Walk<Real>& walk, const LeafErrors& leaf_errors,
                                  bool measures, Sweeps& sweeps, const Executor& executor) {
    if (executor.concurrency() > 1) {
        return walk_with_threads(walk, leaf_errors, measures, sweeps, executor);
    }
    PrerollVisitor<Real, Sweeps> visitor(walk, leaf_errors, measures, sweeps);
    walk.run(visitor);
    return visitor.facts();
}

template detail::PrerollFacts walk_preroll(const Walk<float>&, const LeafErrors&, bool, Sweeps&,
                                           const Executor&);
template detail::PrerollFacts walk_preroll(const Walk<double>&, const LeafErrors&, bool, Sweeps&,
                                           const Executor&);

}  // namespace nestgrid::engine
