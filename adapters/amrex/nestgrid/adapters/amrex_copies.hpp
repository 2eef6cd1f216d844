// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include <nestgrid/adapters/amrex_numbers.hpp>
#include <nestgrid/adapters/block_fields.hpp>

namespace nestgrid::detail {

/// The number of a cell of a box, counted from the first one.
template <int dim, class Real>
Real read_number(const BlockArray<dim, Real>& array, const BlockPlace<dim>& cell,
                 const AmrexNumberType& type) {
    const auto* at = static_cast<const std::byte*>(array.first);
    for (std::size_t d = 0; d < cell.size(); ++d) at += array.stride[d] * cell[d];
    return type.template read<Real>(at);
}

/// The cells of a box that lie inside of a body (an embedded boundary): those that are free by less
/// than a fraction. Null arrays have none.
template <int dim, class Real>
struct AmrexCovered {
    BlockArray<dim, Real> fractions;
    AmrexNumberType type;
    double least = 0;

    bool holds(const BlockPlace<dim>& cell) const {
        return fractions.first != nullptr && read_number(fractions, cell, type) < least;
    }
    bool any(const CellRange<dim>& cells) const {
        bool is_any = false;
        if (fractions.first == nullptr) return is_any;
        for_each_place(cells, [&](const BlockPlace<dim>& cell) { is_any = is_any || holds(cell); });
        return is_any;
    }
};

/// The numbers of a plotfile that cannot be used where they lie: those with another order of bytes,
/// and boxes with covered cells, which have no number (NaN). Made when they are first asked for,
/// by any thread, and kept.
class AmrexCopies {
public:
    /// Boxes of a field, to be filled by `make` where they are not there yet.
    template <class Make>
    const std::vector<std::vector<std::byte>>& of_field(std::size_t field, const Make& make) {
        const std::lock_guard lock(mutex_);
        const auto [at, is_new] = fields_.try_emplace(field);
        if (is_new) make(at->second);
        return at->second;
    }

    /// The numbers of a box one behind the other, x fastest.
    template <int dim, class Real>
    static std::vector<std::byte> copied(const BlockArray<dim, Real>& from,
                                         const CellRange<dim>& cells, const AmrexNumberType& type,
                                         const AmrexCovered<dim, Real>& covered) {
        std::vector<std::byte> copy(static_cast<std::size_t>(cells.count()) * sizeof(Real));
        std::byte* to = copy.data();
        for_each_place(cells, [&](const BlockPlace<dim>& cell) {
            const Real value = covered.holds(cell) ? std::numeric_limits<Real>::quiet_NaN()
                                                   : read_number(from, cell, type);
            std::memcpy(to, &value, sizeof(Real));
            to += sizeof(Real);
        });
        return copy;
    }

private:
    std::mutex mutex_;
    std::map<std::size_t, std::vector<std::vector<std::byte>>> fields_;
};

}  // namespace nestgrid::detail
