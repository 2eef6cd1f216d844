// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangulates the elements at which a criterion stops on a two-dimensional hierarchy.
//
// Two walks draw elements that may stop without conforming: the first one records the nodes inside
// closed edges (edge_nodes.hpp), the second one draws. One walk draws the others. Tasks of several
// threads record and draw parts; the leader puts these together in the order of one thread, so that
// no bit depends on the number of threads.
#pragma once

#include <memory>

#include <graphs/drawn_graph.hpp>
#include <graphs/element_polygon.hpp>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <walk/criterion_question.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

/// The grid, the field and the criterion of a triangulation, all borrowed. Tasks share them.
template <class Real>
struct Graph {
    const Walk<Real>* walk;
    const Criterion* criterion;
    const Bounds* bounds;
    GraphShape shape;
    bool elements;     ///< whether to keep the elements
    bool stops_apart;  ///< whether elements may stop without conforming
};

template <class Real>
class Triangulation final : public TaskVisitor<Real> {
public:
    using View = ElementView<Real>;
    static constexpr Needs needs{.positions = true, .closed = true, .on_ranks = true};

    Triangulation(const Graph<Real>& graph, const SurfaceBuilder<3>& builder);

    /// Only counts triangles, to be called before run().
    /// \param most run() throws OverLimit where there are more
    void count_only(std::uint64_t most) { drawn_.count_only(most); }
    /// Records and draws everything. Collective where the grid is distributed.
    /// \param progress as in ShadingOptions
    /// \throw Cancelled where progress says so; OverLimit
    void run(const Executor& executor, const std::function<bool(const TraversalCounts&)>& progress);
    /// Takes the counts and bounds of all ranks together, after run(). Collective.
    void agree(Ranks& ranks) { drawn_.agree(ranks); }
    /// Puts everything but the surface into a result.
    void report(Shading& result) const;
    /// The number of triangles that were counted.
    std::uint64_t triangles() const { return drawn_.tally.drawn(); }

    bool sees_hidden() const override { return records_; }
    Decision inspect(const View& view, const Split& split) override;
    Decision look(const View& view, const Split& split) override;
    Leaves leaves(const Rule& rule, const Real* values, NodeMask which, bool closed) override;
    void extract(const View& view) override;
    void undo() override {
        drawn_.counts.calls -= counted_;
        drawn_.counts.visited -= counted_;
    }
    void restart() override { drawn_.counts = {}; }

private:
    struct Task {
        SurfacePart<3> part;
        std::unique_ptr<Triangulation> draws;
    };

    const SharedNodes* shared() const { return graph_.walk->hierarchy().facts().shared; }
    void walk(const Executor& executor);
    std::unique_ptr<Task> begin_task() const;
    void count(std::uint64_t elements);
    void record(const View& view);
    void raise_error_bound(const View& view);

    Graph<Real> graph_;
    ElementPolygon<Real> polygon_;
    DrawnGraph drawn_;
    CriterionQuestion question_;
    const EdgeNodes* nodes_ = nullptr;  // recorded by all tasks
    bool records_ = false;              // in the first walk
    double below_ = 0;                  // how far U may leave the corner values in an element
    std::uint64_t counted_ = 1;         // by the last inspect()
    const std::function<bool(const TraversalCounts&)>* progress_ = nullptr;
};

}  // namespace nestgrid::engine
