// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <drawing/drawing.hpp>

namespace nestgrid::engine {

template <class Real>
void Drawing<Real>::walk_elements(const Executor& executor) {
    if (executor.concurrency() < 2) return walk_alone();
    std::vector<std::unique_ptr<Drawing>> parts(most_tasks(executor));
    run_tasks<Real>(
        *walk_, *this, executor,
        [&](std::size_t i) -> TaskVisitor<Real>& {
            std::unique_ptr<Drawing> used;
            {
                const std::scoped_lock lock(mutex_);
                if (!idle_.empty()) {
                    used = std::move(idle_.back());
                    idle_.pop_back();
                }
            }
            parts[i] = begin_part(std::move(used));
            parts[i]->progress_ = nullptr;
            return *parts[i];
        },
        [&](std::size_t i) {
            count(parts[i]->counts_.calls, parts[i]->counts_.visited);
            add(*parts[i]);
            tell(0, 0);
            const std::scoped_lock lock(mutex_);
            idle_.push_back(std::move(parts[i]));
        });
}

template <class Real>
void Drawing<Real>::tell(std::uint64_t calls, std::uint64_t visited) const {
    if (progress_ == nullptr) return;
    TraversalCounts counts = counts_;
    counts.calls += calls;
    counts.visited += visited;
    if (!(*progress_)(counts)) throw Cancelled{};
}

template <class Real>
void Drawing<Real>::agree(Ranks& ranks) {
    std::array<std::uint64_t*, 2> sums{&counts_.calls, &counts_.visited};
    take_sums(ranks, sums);
}

template <class Real>
bool run_until_cancelled(Drawing<Real>& drawing, const Executor& executor,
                         const SharedNodes* shared) {
    bool cancelled = false;
    try {
        drawing.run(executor);
    } catch (const Cancelled&) {
        cancelled = true;
    }
    // Of a walk that went to its end, nothing is left to flush.
    if (cancelled) together(shared, "a cancelled drawing", [&] { drawing.flush(); });
    if (shared != nullptr) drawing.agree(shared->ranks());
    return cancelled;
}

template <class Real>
std::optional<std::uint64_t> count_within(Drawing<Real>& drawing, std::uint64_t most,
                                          const Executor& executor, const SharedNodes* shared) {
    drawing.count_only(most);
    try {
        drawing.run(executor);
    } catch (const OverLimit&) {
        return std::nullopt;
    }
    std::uint64_t count = drawing.simplices();
    std::array<std::uint64_t*, 1> sum{&count};
    if (shared != nullptr) take_sums(shared->ranks(), sum);
    if (count > most) return std::nullopt;
    return count;
}

#define NESTGRID_INSTANTIATE(Real)                                                          \
    template class Drawing<Real>;                                                           \
    template bool run_until_cancelled(Drawing<Real>&, const Executor&, const SharedNodes*); \
    template std::optional<std::uint64_t> count_within(Drawing<Real>&, std::uint64_t,       \
                                                       const Executor&, const SharedNodes*);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
