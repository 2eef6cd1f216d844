// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs a drawing: counts elements, tells the progress, and lets several threads draw.
//
// There are three drawings: level sets, triangulations of the plane, and data that jump. Each says
// what it does with an element, what one of its parts is, and how a part is added. Each task draws
// a part, and the leader adds the parts in the order in which one thread meets them, while tasks
// draw later ones. So no bit depends on the number of threads, or on where the frontier cuts the
// grid.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <nestgrid/algorithms/isosurface_options.hpp>
#include <ranks/agreement.hpp>
#include <surfaces/simplex_tally.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

using Progress = std::function<bool(const TraversalCounts&)>;

template <class Real>
class Drawing : public TaskVisitor<Real> {
public:
    using View = ElementView<Real>;

    Drawing(const Drawing&) = delete;
    Drawing& operator=(const Drawing&) = delete;
    virtual ~Drawing() = default;

    /// Draws everything. Collective where the grid is distributed.
    /// \throw Cancelled, OverLimit, and what the grid, the field and the sinks throw
    virtual void run(const Executor& executor) = 0;
    /// Hands all that is drawn to the sinks where run() was cancelled.
    virtual void flush() {}
    /// Takes the counts and bounds of all ranks together, after run(). Collective.
    virtual void agree(Ranks& ranks);
    /// Counts simplices and draws nothing.
    /// \param most run() throws OverLimit where there are more
    virtual void count_only(std::uint64_t most) { tally_ = SimplexTally(most); }
    /// Number of simplices that were counted.
    std::uint64_t simplices() const { return tally_.drawn(); }

    void undo() override {
        counts_.calls -= counted_;
        counts_.visited -= counted_;
    }
    void restart() override { counts_ = {}; }

protected:
    /// \param progress borrowed, and empty where nobody is to be told
    Drawing(const Walk<Real>& walk, const Progress& progress)
        : walk_{&walk}, progress_{progress ? &progress : nullptr} {}

    /// Makes a part that draws what one task walks. Several threads call this.
    /// \param used a part that has been added and may be used again, or null
    virtual std::unique_ptr<Drawing> begin_part(std::unique_ptr<Drawing> used) = 0;
    /// Adds all but the counts of a part.
    virtual void add(Drawing& part) = 0;
    /// Walks the whole grid. A final class has the walk compiled for itself.
    virtual void walk_alone() { walk_->run(*this); }

    /// Walks alone, or in tasks.
    void walk_elements(const Executor& executor);
    const SharedNodes* shared() const { return walk_->hierarchy().facts().shared; }
    /// Adds elements that were decided about, and those among them that are of interest.
    void count(std::uint64_t calls, std::uint64_t visited) {
        counts_.calls += calls;
        counts_.visited += visited;
    }
    /// Tells the sum of the counts and these.
    /// \throw Cancelled where progress says so
    void tell(std::uint64_t calls, std::uint64_t visited) const;

    const Walk<Real>* walk_;
    TraversalCounts counts_;
    SimplexTally tally_;
    std::uint64_t counted_ = 1;  // by the last inspect(): 0 where another rank counts the element

private:
    const Progress* progress_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<Drawing>> idle_;  // parts that were added
};

/// Runs a drawing, and takes its counts and bounds of all ranks together.
/// \return whether progress cancelled it
template <class Real>
bool run_until_cancelled(Drawing<Real>& drawing, const Executor& executor,
                         const SharedNodes* shared);

/// Counts the simplices of a drawing, on all ranks together.
/// \return nothing where there are more than `most`
///
/// \throw Cancelled, and what the grid and the field throw
template <class Real>
std::optional<std::uint64_t> count_within(Drawing<Real>& drawing, std::uint64_t most,
                                          const Executor& executor, const SharedNodes* shared);

}  // namespace nestgrid::engine
