// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether |U - C| <= e on triangles, exactly: not at some of their points. Or, where colours are
// drawn linearly on triangles, whether each of them differs from U by at most its error.
#pragma once

#include <collapses/kuhn_lattice.hpp>
#include <collapses/leaf_ranges.hpp>
#include <collapses/leaf_section.hpp>

namespace nestgrid::engine {

/// Colours at the corners of a triangle, each the components of one corner, in units of their
/// errors.
using CornerColours = std::array<std::span<const double>, 3>;

/// Checks triangles against the leaves near an isovalue, or along a surface, which it borrows.
///
/// In a simplex U is affine on a triangle, so |U - C| is greatest at a corner of the polygon that
/// the triangle has in common with the simplex. In an affine prism or hexahedron U is a cubic
/// polynomial on that polygon, and within its Bernstein coefficients on parts of it. In other
/// leaves U is within its corner values on parts of the leaf. Where parts are too small to go on,
/// the triangle is refused. A colour is affine on the triangle and changes nothing of this.
class FieldCheck {
public:
    /// What is drawn: an isosurface, colours that keep their place, or colours that may move.
    enum class Drawn { isovalue, colours, moving_colours };

    explicit FieldCheck(const NearLeaves& leaves, Drawn drawn = Drawn::isovalue);

    /// Whether a triangle keeps |U - C| <= e and lies in the domain.
    /// \param greatest raised to an upper bound of |U - C| on the triangle, if it does
    bool keeps(const FlatTriangle& triangle, double& greatest) const;
    /// Whether all triangles of a fan do so, if their sides opposite the common corner do.
    bool keeps_fan(const Fan& fan) const;
    /// Looks at the leaves one by one in any case.
    bool keeps_in_leaves(const FlatTriangle& triangle, double& greatest) const;
    /// Whether each colour, linear on a triangle in the domain, keeps within its error of U.
    /// \param greatest raised to an upper bound of what they differ by in these units, if they do
    bool keeps_colours(const FlatTriangle& triangle, const CornerColours& colours,
                       double& greatest) const;
    /// Answers without the bound, which is faster: for triangles that replace checked ones.
    /// Triangles that moved may have entered what is hidden, and are refused there.
    bool keeps_colours(const FlatTriangle& triangle, const CornerColours& colours) const;

private:
    class Judge;
    AffineLeaf map(const NearLeaf& leaf) const;

    const NearLeaves* leaves_;
    bool may_enter_hidden_;
    std::vector<AffineLeaf> maps_;        // by leaf, without a lattice; of bent ones meaningless
    std::optional<LeafRanges> ranges_;    // of colours
    std::optional<KuhnLattice> lattice_;  // where the leaves are of that kind: faster
};

}  // namespace nestgrid::engine
