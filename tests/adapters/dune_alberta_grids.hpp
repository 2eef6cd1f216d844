// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// AlbertaGrid, of the dimension ALBERTA_DIM, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include <dune/grid/albertagrid.hh>
#include <dune/grid/albertagrid/gridfactory.hh>

namespace nestgrid_test {

constexpr int alberta_dimension = ALBERTA_DIM;
using Alberta = Dune::AlbertaGrid<alberta_dimension, alberta_dimension>;

/// Kuhn's simplices of the unit cube.
inline std::unique_ptr<Alberta> cube() {
    Dune::GridFactory<Alberta> factory;
    for (unsigned i = 0; i < 1U << alberta_dimension; ++i) {
        Dune::FieldVector<double, alberta_dimension> x;
        for (unsigned d = 0; d < alberta_dimension; ++d) x[d] = i >> d & 1U;
        factory.insertVertex(x);
    }
    std::array<unsigned, alberta_dimension> order;
    std::iota(order.begin(), order.end(), 0U);
    do {
        std::vector<unsigned> corners{0};
        for (const unsigned d : order) corners.push_back(corners.back() | 1U << d);
        factory.insertElement(Dune::GeometryTypes::simplex(alberta_dimension), corners);
    } while (std::next_permutation(order.begin(), order.end()));
    factory.markLongestEdge();
    return std::unique_ptr<Alberta>(factory.createGrid());
}

/// Refined everywhere, then at a sphere.
inline std::unique_ptr<Alberta> bisected(int global, int local, double width) {
    auto solver = cube();
    solver->globalRefine(global);
    for (int step = 0; step < local; ++step) {
        for (const auto& e : elements(solver->leafGridView())) {
            auto x = e.geometry().center();
            x -= Dune::FieldVector<double, alberta_dimension>(0.5);
            const double size = std::exp2(-static_cast<double>(e.level()) / alberta_dimension);
            if (std::abs(x.two_norm() - 0.35) < width * size) solver->mark(1, e);
        }
        solver->preAdapt();
        solver->adapt();
        solver->postAdapt();
    }
    return solver;
}

}  // namespace nestgrid_test
