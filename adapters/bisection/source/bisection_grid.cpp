// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/bisection_grid.hpp>

namespace nestgrid {

template class StoredGrid<Bisection<2>>;
template class StoredGrid<Bisection<3>>;
namespace detail {
template class Rewrite<Bisection<2>>;
template class Rewrite<Bisection<3>>;
template class ErasedHierarchy<BisectionGrid<2>, NodeField<BisectionGrid<2>, float>>;
template class ErasedHierarchy<BisectionGrid<2>, NodeField<BisectionGrid<2>, double>>;
template class ErasedHierarchy<BisectionGrid<3>, NodeField<BisectionGrid<3>, float>>;
template class ErasedHierarchy<BisectionGrid<3>, NodeField<BisectionGrid<3>, double>>;
}  // namespace detail

}  // namespace nestgrid
