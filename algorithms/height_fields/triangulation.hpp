// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangulates the elements at which a criterion stops on a two-dimensional hierarchy.
//
// Elements that may stop without conforming record the nodes inside their closed edges
// (edge_nodes.hpp). Those that may have finer neighbours are put aside as polygons, and drawn when
// the walk is over and all nodes on their sides are known.
#pragma once

#include <memory>

#include <drawing/drawing.hpp>
#include <height_fields/edge_nodes.hpp>
#include <height_fields/element_polygon.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/shading_options.hpp>
#include <surfaces/drawn_surface.hpp>
#include <walk/criterion_question.hpp>

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
class Triangulation final : public Drawing<Real> {
public:
    using Base = Drawing<Real>;
    using View = ElementView<Real>;
    static constexpr Needs needs{.positions = true, .closed = true, .on_ranks = true};

    /// \param progress as in ShadingOptions; borrowed
    Triangulation(const Graph<Real>& graph, const SurfaceBuilder<3>& builder,
                  const Progress& progress);
    /// What a task draws: its surface lies in the drawing.
    explicit Triangulation(const Graph<Real>& graph);

    void run(const Executor& executor) override;
    void agree(Ranks& ranks) override;
    void count_only(std::uint64_t most) override;
    /// Puts everything but the surface into a result.
    void report(Shading& result) const;

    /// Hidden elements are walked to record the nodes on the sides of others.
    bool sees_hidden() const override { return graph_.stops_apart; }
    Decision inspect(const View& view, const Split& split) override;
    Decision look(const View& view, const Split& split) override;
    Leaves leaves(const Rule& rule, const Real* values, NodeMask which, bool closed) override;
    void extract(const View& view) override;

private:
    using Base::counted_;
    using Base::counts_;
    using Base::shared;
    using Base::tally_;

    std::unique_ptr<Base> begin_part(std::unique_ptr<Base> used) override;
    void add(Base& part) override;
    void walk_alone() override;
    void count(std::uint64_t elements);
    void put_aside(const View& view, Polygon& polygon);
    void draw_asides();
    void end_element(const View& view, const Polygon& polygon);

    Graph<Real> graph_;
    ElementPolygon<Real> polygon_;
    SurfacePart<3> part_;  // of a task: what its surface is drawn into
    DrawnSurface<3> surface_;
    EdgeNodes recorded_;  // inside closed edges
    PolygonAsides asides_;
    CriterionQuestion question_;
    double below_ = 0;  // how far U may leave the corner values in an element
};

}  // namespace nestgrid::engine
