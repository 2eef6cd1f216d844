// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <indicators/preroll_log.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

/// Walks a hierarchy with several threads: each walks parts of it with a visitor that logs what it
/// meets, while the executor takes finished parts in order. Elements above the parts come first.
/// \param make make(log) returns a pointer to a visitor that has finish(); several threads call it
/// \param take take(visitor, log) takes what a visitor has done
template <class Real, class Make, class Take>
void walk_in_logs(const Walk<Real>& walk, const Executor& executor, const Make& make,
                  const Take& take) {
    using Visitor = decltype(make(std::declval<PrerollLog&>()));
    struct Part {
        PrerollLog log;
        Visitor visitor;
    };
    PrerollLog log_above;
    const Visitor above = make(log_above);
    const std::size_t wanted = 64 * executor.concurrency();  // many parts, so that logs stay short
    const Frontier<Real> frontier(walk, *above, wanted);
    above->finish();
    take(*above, log_above);
    const std::size_t entries = frontier.entry_count();
    std::vector<std::unique_ptr<Part>> parts(std::min(entries, wanted));
    executor.run(
        parts.size(),
        [&](std::size_t i) {
            parts[i] = std::make_unique<Part>();
            Visitor& visitor = parts[i]->visitor = make(parts[i]->log);
            frontier.run(walk, i * entries / parts.size(), (i + 1) * entries / parts.size(),
                         *visitor);
            visitor->finish();
        },
        [&](std::size_t i) {
            const std::unique_ptr<Part> part = std::move(parts[i]);
            take(*part->visitor, part->log);
        });
}

}  // namespace nestgrid::engine
