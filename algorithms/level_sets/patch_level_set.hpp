// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <level_sets/level_search.hpp>
#include <patches/patch_drawing.hpp>

namespace nestgrid::engine {

/// Takes the counts of a walk in patches: elements that it decided about, and those of interest.
class PatchCounts {
public:
    /// Called now and then with the counts so far.
    virtual void tick(std::uint64_t calls, std::uint64_t visited) = 0;
    /// Called at the end with all counts.
    virtual void add(std::uint64_t calls, std::uint64_t visited) = 0;

protected:
    PatchCounts() = default;
    ~PatchCounts() = default;
    PatchCounts(const PatchCounts&) = default;
    PatchCounts& operator=(const PatchCounts&) = default;
    PatchCounts(PatchCounts&&) noexcept = default;
    PatchCounts& operator=(PatchCounts&&) noexcept = default;
};

/// Draws level sets in the bisections below an element, which it walks in patches. Each bit is that
/// of the general walk. Requires LevelSearch::fits_patches() and facts().knows_patches or, for
/// slices by one affine function, facts().bisects_means.
template <int dimension, class Real>
void draw_in_patches(const Walk<Real>& walk, const ElementView<Real>& view,
                     const LevelSearch<Real>& search, const PatchTarget<dimension, Real>& target,
                     PatchCounts& counts);

}  // namespace nestgrid::engine
