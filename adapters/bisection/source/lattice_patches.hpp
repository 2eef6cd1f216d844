// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The walk in patches over lattices. The sources that include this header instantiate it.
#pragma once

#include <nestgrid/adapters/bisection.hpp>
#include <patches/erased_bisections.hpp>

namespace nestgrid {

template <int dim, WalkedInPatches Sample, class Real>
void bisect_patches(const LatticeBisection<dim>& grid,
                    const LatticeField<LatticeBisection<dim>, Sample>& field, NoContext&,
                    const typename LatticeBisection<dim>::Element& e, const Real* values, int level,
                    int orientation, detail::ErasedBisectionVisitor<dim, Real>& visitor) {
    detail::walk_for(visitor, grid, field, e, values, level, orientation);
}

}  // namespace nestgrid

#define NESTGRID_INSTANTIATE(dim, Sample, Real)                                                  \
    template class LatticeField<LatticeBisection<dim>, Sample>;                                  \
    template class detail::ErasedHierarchy<LatticeBisection<dim>,                                \
                                           LatticeField<LatticeBisection<dim>, Sample>>;         \
    template void bisect_patches(const LatticeBisection<dim>&,                                   \
                                 const LatticeField<LatticeBisection<dim>, Sample>&, NoContext&, \
                                 const LatticeBisection<dim>::Element&, const Real*, int, int,   \
                                 detail::ErasedBisectionVisitor<dim, Real>&);

// All samples whose values are float, and all whose values are double (lattice_field.hpp).
#define NESTGRID_INSTANTIATE_FLOATS(dim)           \
    NESTGRID_INSTANTIATE(dim, float, float)        \
    NESTGRID_INSTANTIATE(dim, std::int8_t, float)  \
    NESTGRID_INSTANTIATE(dim, std::uint8_t, float) \
    NESTGRID_INSTANTIATE(dim, std::int16_t, float) \
    NESTGRID_INSTANTIATE(dim, std::uint16_t, float)
#define NESTGRID_INSTANTIATE_DOUBLES(dim)            \
    NESTGRID_INSTANTIATE(dim, double, double)        \
    NESTGRID_INSTANTIATE(dim, std::int32_t, double)  \
    NESTGRID_INSTANTIATE(dim, std::uint32_t, double) \
    NESTGRID_INSTANTIATE(dim, std::int64_t, double)  \
    NESTGRID_INSTANTIATE(dim, std::uint64_t, double)
