// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the adapter of Dune knows of AlbertaGrid: bisection, and one thread only, since ALBERTA's
// elements are made from a stack that all entities of a program share.
#pragma once

#include <nestgrid/adapters/dune_rules.hpp>

namespace Dune {
template <int dim, int dimworld>
class AlbertaGrid;
}

namespace nestgrid {

/// What DuneGrid knows of ALBERTA's bisections.
template <int dim>
struct DuneTraits<Dune::AlbertaGrid<dim, dim>> : DuneDefaults<Dune::AlbertaGrid<dim, dim>> {
    static constexpr int max_children = 2;
    static constexpr bool leaf_indices_on_branches = true;
    static constexpr bool several_threads = false;
};

}  // namespace nestgrid
