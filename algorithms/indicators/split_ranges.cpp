// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/split_ranges.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/detail/round_up.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

namespace {

/// Numbers from a least to a greatest one; none at first.
struct ValueRange {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();

    void add(double value) {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    void add(const ValueRange& other) {
        least = std::min(least, other.least);
        greatest = std::max(greatest, other.greatest);
    }
};

/// A divided element, or one with which a part of a walk begins.
struct RangedSplit {
    int level = 0;
    const Rule* rule = nullptr;  ///< null where only `all` is known
    ValueRange corners{};
    ValueRange all{};  ///< of the values at all nodes in it
    std::vector<NodeKey> keys{};

    void tell(const TakeRange& take) const {
        take(name_of_split(*rule, keys),
             detail::float_above(std::max(detail::distance_above(all.greatest, corners.greatest),
                                          detail::distance_above(corners.least, all.least))));
    }
};

using Take = std::function<void(const RangedSplit&)>;

/// The divided elements that a walk is in: each ends where one of its level or above begins.
class OpenSplits {
public:
    explicit OpenSplits(Take take) : take_{std::move(take)} {}

    /// Ends the elements from a level on.
    void close(int level) {
        while (open_ > 0 && splits_[open_ - 1].level >= level) {
            const RangedSplit& last = splits_[--open_];
            if (last.rule != nullptr) take_(last);
            if (open_ > 0) splits_[open_ - 1].all.add(last.all);
        }
    }
    /// The element that begins, with the memory of earlier ones.
    RangedSplit& begin(int level) {
        close(level);
        if (splits_.size() == open_) splits_.emplace_back();
        RangedSplit& split = splits_[open_++];
        split.level = level;
        split.corners = split.all = {};
        return split;
    }
    void begin_with(const RangedSplit& split) { begin(split.level) = split; }
    void clear() { open_ = 0; }

private:
    Take take_;
    std::vector<RangedSplit> splits_;
    std::size_t open_ = 0;
};

/// Meets all divided elements.
template <class Real>
class RangeVisitor : public TaskVisitor<Real> {
public:
    using View = ElementView<Real>;

    RangeVisitor(const Walk<Real>& walk, Take take) : walk_{&walk}, open_(std::move(take)) {}

    const detail::PrerollFacts& facts() const { return facts_; }

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule&, const Real*, NodeMask, bool) override { return {}; }
    Decision inspect(const View& view, const Split&) override {
        if (view.level == 0) add_coarse_values(view);
        return {};
    }
    void entered(const View& view, const Split& split, const Real* value) override {
        const Rule& rule = *split.rule;
        facts_.all_divided = facts_.all_divided && rule.divides_all;
        facts_.finest_level = std::max(facts_.finest_level, view.level + 1);
        RangedSplit& ranged = open_.begin(view.level);
        ranged.rule = &rule;
        ranged.keys.assign(split.keys.begin(), split.keys.end());
        const std::size_t stride = walk_->components();
        const std::size_t corners = view.corner_count();
        for (std::size_t k = 0; k < corners; ++k) {
            ranged.corners.add(static_cast<double>(value[k * stride]));
        }
        ranged.all = ranged.corners;
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const auto at_node = static_cast<double>(value[(corners + n) * stride]);
            ranged.all.add(at_node);
            if ((split.constrained >> n & 1U) == 0) facts_.add_value(at_node, limit_);
        }
    }
    void extract(const View&) override {}
    Decision look(const View&, const Split&) override { return {}; }
    void undo() override {}
    void restart() override { open_.clear(); }
    void finish() { open_.close(0); }

private:
    static constexpr double limit_ = static_cast<double>(std::numeric_limits<Real>::max() / 8);

    void add_coarse_values(const View& view) {
        const NodeMask unseen = walk_->unseen_corners(view);
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            if ((unseen >> k & 1U) != 0) continue;
            facts_.add_value(static_cast<double>(view.value[k * walk_->components()]), limit_);
        }
    }

    const Walk<Real>* walk_;
    OpenSplits open_;
    detail::PrerollFacts facts_;
};

/// Logs the divided elements above the parts of a walk, and where the parts begin.
template <class Real>
class AboveVisitor final : public RangeVisitor<Real> {
public:
    using View = ElementView<Real>;

    explicit AboveVisitor(const Walk<Real>& walk)
        : RangeVisitor<Real>(walk, [this](const RangedSplit& split) { log_.push_back(split); }) {}

    Decision inspect(const View& view, const Split& split) override {
        last_level_ = view.level;
        return RangeVisitor<Real>::inspect(view, split);
    }
    void entered(const View& view, const Split& split, const Real* value) override {
        RangeVisitor<Real>::entered(view, split, value);
        this->finish();
    }
    void undo() override { log_.push_back({.level = last_level_}); }
    void restart() override {
        log_.clear();
        RangeVisitor<Real>::restart();
    }
    const std::vector<RangedSplit>& log() const { return log_; }

private:
    std::vector<RangedSplit> log_;
    int last_level_ = 0;
};

/// One part of a walk: some elements with all below them.
template <class Real>
class PartVisitor final : public RangeVisitor<Real> {
public:
    using View = ElementView<Real>;

    explicit PartVisitor(const Walk<Real>& walk)
        : RangeVisitor<Real>(walk, [this](const RangedSplit& split) {
              split.tell(
                  [&](const SplitName& name, float beyond) { log_.emplace_back(name, beyond); });
              if (split.level == roots_.back().level) roots_.back().all = split.all;
          }) {}

    /// Called for each element with which the part begins.
    bool takes(const View& view) override {
        this->finish();
        roots_.push_back({.level = view.level});
        return false;
    }
    /// What is told of divided elements.
    const std::vector<std::pair<SplitName, float>>& log() const { return log_; }
    /// The elements with which the part begins, with the ranges of those that are divided.
    const std::vector<RangedSplit>& roots() const { return roots_; }

private:
    std::vector<std::pair<SplitName, float>> log_;
    std::vector<RangedSplit> roots_;
};

template <class Real>
detail::PrerollFacts walk_with_threads(const Walk<Real>& walk, const Executor& executor,
                                       const TakeRange& take) {
    AboveVisitor<Real> above(walk);
    std::vector<std::unique_ptr<PartVisitor<Real>>> parts(most_tasks(executor));
    OpenSplits open([&](const RangedSplit& split) { split.tell(take); });
    detail::PrerollFacts facts;
    std::size_t next = 0;
    const auto end_of_part = [&](std::size_t i) {
        const std::unique_ptr<PartVisitor<Real>> part = std::move(parts[i]);
        part->finish();
        for (const auto& [name, beyond] : part->log()) take(name, beyond);
        facts.add(part->facts());
        for (const RangedSplit& root : part->roots()) {
            for (; above.log()[next].rule != nullptr; ++next) open.begin_with(above.log()[next]);
            open.begin_with({.level = root.level, .all = root.all});
            ++next;
        }
    };
    run_tasks<Real>(
        walk, above, executor,
        [&](std::size_t i) -> PartVisitor<Real>& {
            parts[i] = std::make_unique<PartVisitor<Real>>(walk);
            return *parts[i];
        },
        end_of_part);
    for (; next < above.log().size(); ++next) open.begin_with(above.log()[next]);
    open.close(0);
    facts.add(above.facts());
    return facts;
}

}  // namespace

template <class Real>
detail::PrerollFacts walk_ranges(const Walk<Real>& walk, const Executor& executor,
                                 const TakeRange& take) {
    if (executor.concurrency() > 1) return walk_with_threads(walk, executor, take);
    RangeVisitor<Real> visitor(walk, [&](const RangedSplit& split) { split.tell(take); });
    walk.run(visitor);
    visitor.finish();
    return visitor.facts();
}

template detail::PrerollFacts walk_ranges(const Walk<float>&, const Executor&, const TakeRange&);
template detail::PrerollFacts walk_ranges(const Walk<double>&, const Executor&, const TakeRange&);

}  // namespace nestgrid::engine
