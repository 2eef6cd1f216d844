// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/boost/graph/generators.h>

#include <gtest/gtest.h>

#include <nestgrid/adapters/cgal_domain.hpp>

#include "lipschitz.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;
using nestgrid::Point;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using P = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<P>;

/// The cube between -1 and 1, without the pyramid between its upper side and its centre.
Mesh dented_cube(bool with_bottom = true) {
    Mesh mesh;
    std::array<Mesh::Vertex_index, 9> v;
    for (unsigned i = 0; i < 8; ++i) {
        v[i] = mesh.add_vertex({i & 1U ? 1.0 : -1.0, i & 2U ? 1.0 : -1.0, i & 4U ? 1.0 : -1.0});
    }
    v[8] = mesh.add_vertex({0, 0, 0});
    const auto add = [&](int a, int b, int c) {
        mesh.add_face(v[std::size_t(a)], v[std::size_t(b)], v[std::size_t(c)]);
    };
    const std::array<int, 4> around{0, 1, 3, 2};
    for (std::size_t i = 0; i < 4; ++i) {
        const int a = around[i];
        const int b = around[(i + 1) % 4];
        add(a, b, b + 4);
        add(a, b + 4, a + 4);
        add(a + 4, b + 4, 8);
    }
    if (with_bottom) {
        add(0, 2, 3);
        add(0, 3, 1);
    }
    return mesh;
}

TEST(CgalSolid, IsALipschitzDistance) {
    const Mesh mesh = dented_cube();
    const nestgrid::CgalSolid solid(mesh);
    expect_lipschitz(solid, [](const Point& x) {
        const double side = std::max(std::abs(x[0]), std::abs(x[1]));
        return side <= 1 && std::abs(x[2]) <= 1 && x[2] <= side;
    });
    EXPECT_DOUBLE_EQ(solid({0, 0, -3}), 2);
    EXPECT_DOUBLE_EQ(solid({0, 0, 1}), std::sqrt(0.5));
}

TEST(CgalSolid, IsRefusedWithoutAClosedSurface) {
    const auto solid = [](const Mesh& mesh) { nestgrid::CgalSolid<P>{mesh}; };
    expect_refused([&] { solid(Mesh{}); }, "empty");
    Mesh vertex_alone;
    vertex_alone.add_vertex(P(0, 0, 0));
    expect_refused([&] { solid(vertex_alone); }, "empty");
    expect_refused([&] { solid(dented_cube(false)); }, "open");
    Mesh cube;
    CGAL::make_hexahedron(P(0, 0, 0), P(1, 0, 0), P(1, 1, 0), P(0, 1, 0), P(0, 1, 1), P(0, 0, 1),
                          P(1, 0, 1), P(1, 1, 1), cube);
    expect_refused([&] { solid(cube); }, "no triangles");
}

}  // namespace
