// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "alberta_bisection.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>

#include <fcntl.h>

#include <dune/common/parallel/mpihelper.hh>
#include <dune/grid/albertagrid.hh>
#include <dune/grid/albertagrid/gridfactory.hh>

namespace {

using Grid = Dune::AlbertaGrid<3, 3>;
using Vector = Dune::FieldVector<double, 3>;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// ALBERTA writes to standard output whatever it does.
class Silence {
public:
    Silence() : kept_{dup(STDOUT_FILENO)} {
        std::fflush(stdout);
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        close(nowhere);
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;
    ~Silence() {
        std::cout.flush();
        std::fflush(stdout);
        dup2(kept_, STDOUT_FILENO);
        close(kept_);
    }

private:
    int kept_;
};

}  // namespace

AlbertaFigures refine_alberta_at_sphere(int levels) {
    const Silence silence;
    int count = 0;
    char** arguments = nullptr;
    Dune::MPIHelper::instance(count, arguments);
    Dune::GridFactory<Grid> factory;
    for (unsigned i = 0; i < 8; ++i) {
        factory.insertVertex({double(i & 1U), double(i >> 1U & 1U), double(i >> 2U)});
    }
    std::array<unsigned, 3> order{0, 1, 2};
    do {
        factory.insertElement(Dune::GeometryTypes::simplex(3),
                              {0, 1U << order[0], 7U - (1U << order[2]), 7});
    } while (std::next_permutation(order.begin(), order.end()));
    factory.markLongestEdge();
    const auto grid = std::unique_ptr<Grid>(factory.createGrid());
    AlbertaFigures result;
    for (int level = 0; level < levels; ++level) {
        const double start = now();
        for (const auto& e : elements(grid->leafGridView())) {
            if (e.level() >= levels) continue;
            const auto geometry = e.geometry();
            const Vector centre = geometry.center();
            double size = 0;
            for (int i = 0; i < 4; ++i) {
                size = std::max(size, (geometry.corner(i) - centre).two_norm());
            }
            const Vector middle{0.5, 0.5, 0.5};
            if (std::abs((centre - middle).two_norm() - 0.35) < size) grid->mark(1, e);
        }
        grid->preAdapt();
        grid->adapt();
        grid->postAdapt();
        result.seconds = now() - start;
    }
    result.leaves = static_cast<std::size_t>(grid->leafGridView().size(0));
    return result;
}
