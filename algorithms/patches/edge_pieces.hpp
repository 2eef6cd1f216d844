// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Edges between nodes of a batch of patches, with what the data say along them: the piece that a
// level cuts after the edge is halved at its nodes, and gradients of the data at the ends.
#pragma once

#include <span>

#include <patches/batch_cuts.hpp>
#include <patches/known_bisection.hpp>

namespace nestgrid::engine {

/// A piece of an edge, from its lower to its higher end.
struct EdgePiece {
    std::array<Point, 2> x;
    std::array<double, 2> value;
    std::array<double, 2> along;    ///< where the ends lie on the whole edge, 0 at its lower end
    std::array<Point, 2> gradient;  ///< of the data, where asked for and known
};

/// What is asked of edges.
struct PieceQuestion {
    double isovalue;
    bool finest;     ///< whether to halve each edge as often as the grid does
    bool gradients;  ///< needs a field that has gradient_at()
};

/// A field whose gradient is known at any node.
template <class Field, class Node>
concept GivesGradientsAt = requires(const Field& field, Node node) {
    { field.gradient_at(node) } -> std::same_as<Point>;
};

/// A field that tells gradients of many nodes at once.
template <class Field, class Node>
concept TellsGradientsAt = requires(const Field& field, std::span<const Node> nodes,
                                    std::span<Point> out) {
    field.gradients_at(nodes, out);
};

constexpr std::size_t most_pieces = 64;  // that are asked for at once

/// Sets to[i] to a piece of edges[i]: the whole edge or, of its finest pieces, the one that
/// repeated halving finds, which is a function of the edge and the data on it alone.
/// \param field with known bisections (known_bisection.hpp)
/// \param edges most_pieces at most
template <class Batch, class Field>
void find_pieces(const Batch& batch, const Field& field, std::span<const BatchEdge> edges,
                 const PieceQuestion& question, EdgePiece* to) {
    using Node = typename Batch::Node;
    const auto& grid = *batch.grid;
    EdgePiece* const first = to;
    std::array<std::array<Node, 2>, most_pieces> ends;
    for (const BatchEdge& edge : edges) {
        std::array node{batch.nodes.all[edge.low], batch.nodes.all[edge.high]};
        EdgePiece& piece = *to;
        piece.value = {static_cast<double>(batch.values.all[edge.low]),
                       static_cast<double>(batch.values.all[edge.high])};
        piece.along = {0, 1};
        while (question.finest && grid.halved(node[0], node[1])) {
            const auto middle = grid.middle(node[0], node[1]);
            const auto value =
                static_cast<double>(field.template value_at<false>(middle, grid.key(middle)));
            const std::size_t end = value >= question.isovalue ? 1 : 0;
            node[end] = middle;
            piece.value[end] = value;
            piece.along[end] = 0.5 * (piece.along[0] + piece.along[1]);
        }
        for (std::size_t end = 0; end < 2; ++end) {
            piece.x[end] = grid.position(node[end]);
            if constexpr (GivesGradientsAt<Field, Node>) {
                if (question.gradients) piece.gradient[end] = field.gradient_at(node[end]);
            }
        }
        ends[static_cast<std::size_t>(to++ - first)] = node;
    }
    if constexpr (TellsGradientsAt<Field, Node>) {
        if (!question.gradients || edges.empty()) return;
        std::array<Point, 2 * most_pieces> gradients;
        const std::size_t count = 2 * edges.size();
        field.gradients_at(std::span<const Node>(ends[0].data(), count),
                           std::span(gradients).first(count));
        for (std::size_t i = 0; i < edges.size(); ++i) {
            first[i].gradient = {gradients[2 * i], gradients[2 * i + 1]};
        }
    }
}

}  // namespace nestgrid::engine
