// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <graphs/drawn_graph.hpp>

#include <ranks/agreement.hpp>

namespace nestgrid::engine {

void DrawnGraph::count_only(std::uint64_t most) {
    tally = SimplexTally(most);
    surface.count_only();
}

void DrawnGraph::add(const DrawnGraph& task, const SurfacePart<3>& part) {
    surface.add_extracted(task.surface.extracted());
    surface.add_limited(task.surface.limited());
    surface.raise_error_bound(task.surface.error_bound());
    nodes.append(task.nodes);
    tally.add(task.tally);
    if (!surface.counts_only()) surface.add_part(part);
}

void DrawnGraph::agree(Ranks& ranks) {
    double error = surface.error_bound();
    std::array<double*, 1> greatest{&error};
    take_greatest(ranks, greatest);
    surface.raise_error_bound(error);
    std::uint64_t extracted = surface.extracted();
    std::array<std::uint64_t*, 3> sums{&extracted, &counts.calls, &counts.visited};
    take_sums(ranks, sums);
    surface.add_extracted(extracted - surface.extracted());
}

void DrawnGraph::report(Shading& result) const {
    result.counts = counts;
    result.counts.extracted = surface.extracted();
    result.counts.limited = surface.limited();
    result.error_bound = surface.error_bound();
    result.edge_nodes = nodes.size();
    result.edge_nodes_bytes = nodes.memory_bytes();
    result.table_bytes = surface.memory_bytes();
    result.names = surface.vertex_names();
}

}  // namespace nestgrid::engine
