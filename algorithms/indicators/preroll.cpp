// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/preroll.hpp>

#include <indicators/preroll_visitor.hpp>
#include <indicators/walk_in_logs.hpp>
#include <walk/walk_steps.hpp>

namespace nestgrid::engine {

namespace {

template <class Real>
detail::PrerollFacts walk_with_threads(const Walk<Real>& walk, const PrerollRequest& request,
                                       Sweeps& sweeps, const Executor& executor) {
    using LoggingVisitor = PrerollVisitor<Real, PrerollLog>;
    detail::PrerollFacts facts;
    walk_in_logs(
        walk, executor,
        [&](PrerollLog& log) { return std::make_unique<LoggingVisitor>(walk, request, log); },
        [&](const LoggingVisitor& visitor, const PrerollLog& log) {
            log.repeat(sweeps);
            facts.add(visitor.facts());
        });
    return facts;
}

}  // namespace

template <class Real>
detail::PrerollFacts walk_preroll(const Walk<Real>& walk, const PrerollRequest& request,
                                  Sweeps& sweeps, const Executor& executor) {
    if (executor.concurrency() > 1) return walk_with_threads(walk, request, sweeps, executor);
    PrerollVisitor<Real, Sweeps> visitor(walk, request, sweeps);
    walk.run_as(visitor);
    visitor.finish();
    return visitor.facts();
}

template detail::PrerollFacts walk_preroll(const Walk<float>&, const PrerollRequest&, Sweeps&,
                                           const Executor&);
template detail::PrerollFacts walk_preroll(const Walk<double>&, const PrerollRequest&, Sweeps&,
                                           const Executor&);

}  // namespace nestgrid::engine
