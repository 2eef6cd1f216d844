// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/red_green.hpp>

namespace nestgrid {

template class StoredGrid<RedGreen<2>>;
template class StoredGrid<RedGreen<3>>;
template class StoredGrid<RedGreen<2, 3>>;
template class StoredGrid<RedGreen<3, 4>>;
namespace detail {
template class Rewrite<RedGreen<2>>;
template class Rewrite<RedGreen<3>>;
template class Rewrite<RedGreen<2, 3>>;
template class Rewrite<RedGreen<3, 4>>;
template class ErasedHierarchy<RedGreenGrid<2>, NodeField<RedGreenGrid<2>, float>>;
template class ErasedHierarchy<RedGreenGrid<2>, NodeField<RedGreenGrid<2>, double>>;
template class ErasedHierarchy<RedGreenGrid<3>, NodeField<RedGreenGrid<3>, float>>;
template class ErasedHierarchy<RedGreenGrid<3>, NodeField<RedGreenGrid<3>, double>>;
template class ErasedHierarchy<RedGreenSimplices<2>, NodeField<RedGreenSimplices<2>, float>>;
template class ErasedHierarchy<RedGreenSimplices<2>, NodeField<RedGreenSimplices<2>, double>>;
template class ErasedHierarchy<RedGreenSimplices<3>, NodeField<RedGreenSimplices<3>, float>>;
template class ErasedHierarchy<RedGreenSimplices<3>, NodeField<RedGreenSimplices<3>, double>>;
}  // namespace detail

}  // namespace nestgrid
