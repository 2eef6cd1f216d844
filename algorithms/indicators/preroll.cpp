// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/preroll.hpp>

#include <indicators/preroll_log.hpp>
#include <indicators/preroll_visitor.hpp>

namespace nestgrid::engine {

namespace {

template <class Real>
detail::PrerollFacts walk_with_threads(const Walk<Real>& walk, const PrerollRequest& request,
                                       Sweeps& sweeps, const Executor& executor) {
    struct Part {
        PrerollLog log;
        detail::PrerollFacts facts;
    };
    using LoggingVisitor = PrerollVisitor<Real, PrerollLog>;
    PrerollLog above;
    LoggingVisitor visitor(walk, request, above);
    const std::size_t wanted = 64 * executor.concurrency();  // many parts, so that logs stay short
    const Frontier<Real> frontier(walk, visitor, wanted);
    visitor.finish();
    above.repeat(sweeps);
    detail::PrerollFacts facts = visitor.facts();
    const std::size_t entries = frontier.entry_count();
    std::vector<std::unique_ptr<Part>> parts(std::min(entries, wanted));
    executor.run(
        parts.size(),
        [&](std::size_t i) {
            parts[i] = std::make_unique<Part>();
            LoggingVisitor below(walk, request, parts[i]->log);
            frontier.run(walk, i * entries / parts.size(), (i + 1) * entries / parts.size(), below);
            below.finish();
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
detail::PrerollFacts walk_preroll(const Walk<Real>& walk, const PrerollRequest& request,
                                  Sweeps& sweeps, const Executor& executor) {
    if (executor.concurrency() > 1) return walk_with_threads(walk, request, sweeps, executor);
    PrerollVisitor<Real, Sweeps> visitor(walk, request, sweeps);
    walk.run(visitor);
    visitor.finish();
    return visitor.facts();
}

template detail::PrerollFacts walk_preroll(const Walk<float>&, const PrerollRequest&, Sweeps&,
                                           const Executor&);
template detail::PrerollFacts walk_preroll(const Walk<double>&, const PrerollRequest&, Sweeps&,
                                           const Executor&);

}  // namespace nestgrid::engine
