// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/octree_grid.hpp>

namespace nestgrid {

template class StoredGrid<Octree<2>>;
template class StoredGrid<Octree<3>>;
namespace detail {
template class Rewrite<Octree<2>>;
template class Rewrite<Octree<3>>;
template class ErasedHierarchy<OctreeGrid<2>, NodeField<OctreeGrid<2>, float>>;
template class ErasedHierarchy<OctreeGrid<2>, NodeField<OctreeGrid<2>, double>>;
template class ErasedHierarchy<OctreeGrid<3>, NodeField<OctreeGrid<3>, float>>;
template class ErasedHierarchy<OctreeGrid<3>, NodeField<OctreeGrid<3>, double>>;
}  // namespace detail

}  // namespace nestgrid
