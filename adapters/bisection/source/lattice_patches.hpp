// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The walk in patches over lattices. The sources that include this header instantiate it.
#pragma once

#include <nestgrid/adapters/bisection.hpp>
#include <patches/erased_bisections.hpp>

namespace nestgrid {

template <int dim, WalkedInPatches Sample>
void bisect_patches(const LatticeBisection<dim>& grid,
                    const LatticeField<LatticeBisection<dim>, Sample>& field,
                    const typename LatticeBisection<dim>::Element& e,
                    detail::PatchVisitor& visitor) {
    engine::bisect_for(visitor, grid, field, e);
}

// Compiled once for all samples.
extern template void engine::walk_for(engine::ErasedBisectionVisitor<3, double>&,
                                      const LatticeBisection<3>&,
                                      const engine::MeanValues<LatticeBisection<3>>&,
                                      const LatticeBisection<3>::Element&);

}  // namespace nestgrid

#define NESTGRID_INSTANTIATE(dim, Sample)                                                \
    template class LatticeField<LatticeBisection<dim>, Sample>;                          \
    template class detail::ErasedHierarchy<LatticeBisection<dim>,                        \
                                           LatticeField<LatticeBisection<dim>, Sample>>; \
    template void bisect_patches(const LatticeBisection<dim>&,                           \
                                 const LatticeField<LatticeBisection<dim>, Sample>&,     \
                                 const LatticeBisection<dim>::Element&, detail::PatchVisitor&);

// All samples whose values are float, and all whose values are double (lattice_field.hpp).
#define NESTGRID_INSTANTIATE_FLOATS(dim)    \
    NESTGRID_INSTANTIATE(dim, float)        \
    NESTGRID_INSTANTIATE(dim, std::int8_t)  \
    NESTGRID_INSTANTIATE(dim, std::uint8_t) \
    NESTGRID_INSTANTIATE(dim, std::int16_t) \
    NESTGRID_INSTANTIATE(dim, std::uint16_t)
#define NESTGRID_INSTANTIATE_DOUBLES(dim)    \
    NESTGRID_INSTANTIATE(dim, double)        \
    NESTGRID_INSTANTIATE(dim, std::int32_t)  \
    NESTGRID_INSTANTIATE(dim, std::uint32_t) \
    NESTGRID_INSTANTIATE(dim, std::int64_t)  \
    NESTGRID_INSTANTIATE(dim, std::uint64_t)
