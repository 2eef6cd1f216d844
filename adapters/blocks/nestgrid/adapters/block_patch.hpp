// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sums, least and greatest numbers of neighbouring cells, for all nodes of a patch of cells at
// once.
//
// Numbers are combined in pairs, along x, then along y, then along z. So the sum around a node does
// not depend on the patch it is part of, and equal numbers have exactly that number for their mean.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace nestgrid::detail {

/// width^dim.
template <int dim>
constexpr std::size_t patch_size(std::size_t width) {
    return dim == 2 ? width * width : width * width * width;
}

/// The numbers of a patch, x fastest.
template <int dim, std::size_t width>
using PatchNumbers = std::array<double, patch_size<dim>(width)>;

/// For each node inside a patch, the numbers of the 2^dim cells around it, combined.
/// \param combine of two numbers, symmetric
template <int dim, std::size_t width, class Combine>
PatchNumbers<dim, width - 1> combined(const PatchNumbers<dim, width>& cells,
                                      const Combine& combine) {
    PatchNumbers<dim, width> from = cells;
    PatchNumbers<dim, width> to;
    std::size_t inner = 1;  // numbers in the directions that are done
    std::size_t outer = patch_size<dim>(width) / width;
    for (int d = 0; d < dim; ++d) {
        for (std::size_t o = 0; o < outer; ++o) {
            const double* const in = from.data() + o * width * inner;
            double* const out = to.data() + o * (width - 1) * inner;
            for (std::size_t i = 0; i < (width - 1) * inner; ++i) {
                out[i] = combine(in[i], in[i + inner]);
            }
        }
        inner *= width - 1;
        outer /= width;
        std::swap(from, to);
    }
    PatchNumbers<dim, width - 1> result;
    std::copy_n(from.begin(), result.size(), result.begin());
    return result;
}

/// For each node inside a patch, the mean of the cells around it.
template <int dim, std::size_t width>
PatchNumbers<dim, width - 1> means_in(const PatchNumbers<dim, width>& cells) {
    auto means = combined<dim, width>(cells, [](double a, double b) { return a + b; });
    for (double& mean : means) mean /= 1 << dim;
    return means;
}

/// The numbers of a patch without the outermost ones.
template <int dim, std::size_t width>
PatchNumbers<dim, width - 2> middle_of(const PatchNumbers<dim, width>& numbers) {
    constexpr std::size_t left = width - 2;
    constexpr std::size_t planes = dim == 2 ? 1 : left;
    constexpr std::size_t first_plane = dim == 2 ? 0 : 1;
    PatchNumbers<dim, left> middle;
    for (std::size_t z = 0; z < planes; ++z) {
        for (std::size_t y = 0; y < left; ++y) {
            const std::size_t row = ((z + first_plane) * width + y + 1) * width + 1;
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(row), left,
                        middle.begin() + static_cast<std::ptrdiff_t>((z * left + y) * left));
        }
    }
    return middle;
}

}  // namespace nestgrid::detail
