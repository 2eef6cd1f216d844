// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Leaves near an isovalue that are Kuhn's tetrahedra of a lattice, as bisections of a volume make
// them: U at a point, and its range on a triangle, without looking for leaves.
//
// In lattice coordinates, suitably shifted, these tetrahedra are cut out by nine families of
// planes: x, y, z = i and x +- y, y +- z, x +- z = 2 i. On a triangle U is affine between planes,
// so |U - C| is greatest at a corner, where a side meets a plane, or where the inside meets a line
// that two planes have in common.
#pragma once

#include <optional>

#include <collapses/near_leaves.hpp>

namespace nestgrid::engine {

/// Triangles with a common corner.
struct Fan {
    Point w;
    std::span<const Point> ring;                         ///< the other corners, each once
    std::span<const std::array<std::uint32_t, 2>> side;  ///< of each triangle, opposite w
};

class KuhnLattice {
public:
    /// Looks at every leaf. \return nothing where one is no such tetrahedron, where a face on the
    /// boundary of the domain does not lie on the box around all leaves, or where leaves may be
    /// hidden
    static std::optional<KuhnLattice> find(const NearLeaves& leaves);

    /// Whether a triangle keeps |U - C| <= e, and lies in the domain.
    /// \param greatest raised to the greatest |U - C| on it, if it does
    bool keeps(const Triangle& x, double& greatest) const;
    /// Whether the triangles from w to sides keep it, which are known to keep it themselves.
    bool keeps_fan(const Fan& fan) const;

private:
    using Index = std::array<int, 3>;

    explicit KuhnLattice(double error) : error_{error} {}

    Index index_of(const Point& x) const;
    bool takes(const NearLeaves& leaves, const NearLeaf& leaf) const;
    void keep_values(const NearLeaves& leaves);
    Point coordinates(const Point& x) const;
    double value(const Index& at) const;
    bool keeps_at(const Point& x, double& greatest) const;
    bool contains(const Point& at) const;
    bool keeps_side(const Point& a, const Point& b, double& greatest) const;
    bool keeps_along(int family, const Point& a, const Point& b, double& greatest) const;
    bool keeps_inside(const Triangle& x, double& greatest) const;

    double error_;
    Point low_{};      // of the box around all leaves
    Point spacing_{};  // between lattice points
    Index shift_{};    // which of them have even coordinates
    Index last_{};     // lattice point, without the shift
    // Values in bricks of 8 x 8 x 8, without those of nodes that are not near.
    Index bricks_{};
    std::vector<std::uint32_t> brick_;
    std::vector<double> values_;
};

}  // namespace nestgrid::engine
