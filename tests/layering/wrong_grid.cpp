// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A grid without split() and a field with integers: refused in English.
#include <nestgrid/algorithms/isosurface.hpp>

struct Leafless {
    struct Element {};
    static constexpr int dimension = 3;
    std::size_t coarse_count() const;
    nestgrid::CoarseElement<Element> coarse(std::size_t) const;
    void children(const Element&, std::span<Element>) const;
};

struct Integers {
    using value_type = int;
};

static_assert(nestgrid::require_nested_grid<Leafless>());
static_assert(nestgrid::require_nodal_field<Integers, Leafless>());
