// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the colours of a slice jump, and where isolines on it end, whoever drew them: judged by
// positions and values alone.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include <nestgrid/shape.hpp>

/// Triangles with a colour at each vertex, linear in between. Vertices may come several times.
struct ColouredTriangles {
    std::vector<nestgrid::Point> vertices;
    std::vector<double> values;  ///< of the vertices
    std::vector<std::array<std::size_t, 3>> triangles;
};

/// Segments of isolines; vertices may come several times.
struct Segments {
    std::vector<nestgrid::Point> vertices;
    std::vector<std::array<std::size_t, 2>> segments;
};

using OnBoundary = std::function<bool(const nestgrid::Point&)>;

struct JumpCount {
    std::size_t open_edges = 0;  ///< of one triangle only, inside the domain
    /// Edges at which the colours of the two sides differ by more than the tolerance: of two
    /// triangles, or of one, with vertices of others inside the edge.
    std::size_t jumping_edges = 0;
    double greatest_jump = 0;
};

/// Vertices within 1e-6 of each other are one position.
JumpCount count_jumps(const ColouredTriangles& surface, const OnBoundary& on_boundary,
                      double tolerance);

/// Positions inside the domain in which one segment ends.
std::size_t count_open_ends(const Segments& lines, const OnBoundary& on_boundary);
