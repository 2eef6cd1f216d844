// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// AlbertaGrid, of the dimension ALBERTA_DIM.
#include <algorithm>
#include <numeric>

#include <dune/common/parallel/mpihelper.hh>
#include <dune/grid/albertagrid.hh>
#include <dune/grid/albertagrid/gridfactory.hh>

#include <nestgrid/adapters/dune_alberta.hpp>

#include "dune.hpp"

namespace {

constexpr int dim = ALBERTA_DIM;
using Alberta = Dune::AlbertaGrid<dim, dim>;

/// Kuhn's simplices of the unit cube.
std::unique_ptr<Alberta> cube() {
    Dune::GridFactory<Alberta> factory;
    for (unsigned i = 0; i < 1U << dim; ++i) {
        Dune::FieldVector<double, dim> x;
        for (unsigned d = 0; d < dim; ++d) x[d] = i >> d & 1U;
        factory.insertVertex(x);
    }
    std::array<unsigned, dim> order;
    std::iota(order.begin(), order.end(), 0U);
    do {
        std::vector<unsigned> corners{0};
        for (const unsigned d : order) corners.push_back(corners.back() | 1U << d);
        factory.insertElement(Dune::GeometryTypes::simplex(dim), corners);
    } while (std::next_permutation(order.begin(), order.end()));
    factory.markLongestEdge();
    return std::unique_ptr<Alberta>(factory.createGrid());
}

std::unique_ptr<Alberta> bisected(int global, int local, double width) {
    auto solver = cube();
    solver->globalRefine(global);
    for (int step = 0; step < local; ++step) {
        for (const auto& e : elements(solver->leafGridView())) {
            auto x = e.geometry().center();
            x -= Dune::FieldVector<double, dim>(0.5);
            const double size = std::exp2(-static_cast<double>(e.level()) / dim);
            if (std::abs(x.two_norm() - 0.35) < width * size) solver->mark(1, e);
        }
        solver->preAdapt();
        solver->adapt();
        solver->postAdapt();
    }
    return solver;
}

}  // namespace

int main(int count, char** arguments) {
    using namespace recording;
    Dune::MPIHelper::instance(count, arguments);
    const auto solver = bisected(dim, 2 * dim, 0.3);
    record_dune("dune_alberta" + std::to_string(dim) + "/bisected", *solver);
    return finish(count, arguments);
}
