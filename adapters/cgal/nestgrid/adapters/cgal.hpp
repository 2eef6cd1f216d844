// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// CGAL (GPL for these packages): surfaces as coarse grids, octrees as nested grids.
#pragma once

#include <type_traits>

#include <CGAL/Octree.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/number_utils.h>

#include <nestgrid/adapters/coarse.hpp>
#include <nestgrid/grid.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

namespace detail {

/// Whether a point of CGAL is nothing but three doubles or floats, one after another.
template <class P>
inline constexpr bool is_three_numbers = [] {
    using Number = std::remove_cvref_t<decltype(std::declval<const P&>().x())>;
    return (std::is_same_v<Number, double> || std::is_same_v<Number, float>)&&sizeof(P) ==
           3 * sizeof(Number);
}();

}  // namespace detail

/// The triangles and quadrilaterals of a surface. Points that are three doubles or floats in
/// memory stay in the mesh, which must then outlive the grid and keep its vertices; those of other
/// kernels are copied and rounded.
/// \throw InvalidInput for other polygons, and for a mesh with removed elements in it
template <class P>
CoarseGrid coarse_from_cgal(const CGAL::Surface_mesh<P>& mesh) {
    if (mesh.has_garbage()) {
        throw InvalidInput("the mesh still holds removed elements; call collect_garbage() first");
    }
    CoarseGrid grid;
    grid.dimension = 2;
    const std::size_t count = mesh.number_of_vertices();
    if constexpr (detail::is_three_numbers<P>) {
        using Number = std::remove_cvref_t<decltype(std::declval<const P&>().x())>;
        if (count > 0) {
            const auto* first = reinterpret_cast<const Number*>(mesh.points().data());
            grid.nodes = Coordinates::borrow(first, count);
        }
    } else {
        std::vector<Point> points;
        points.reserve(count);
        for (const auto v : mesh.vertices()) {
            const P& p = mesh.point(v);
            points.push_back(
                {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
        }
        grid.nodes = Coordinates(std::move(points));
    }
    std::vector<std::uint32_t> loop;
    for (const auto face : mesh.faces()) {
        loop.clear();
        for (const auto v : mesh.vertices_around_face(mesh.halfedge(face))) loop.push_back(v);
        grid.add_loop(loop);
    }
    return grid;
}

/// A CGAL::Octree, traversed in place: one coarse hexahedron, its bounding box, halved in every
/// direction; an element is CGAL's own handle of a node. Nothing is copied; the tree must outlive
/// the grid and stay as it is.
///
/// Child i of a node of CGAL lies, as in the dyadic rule, on the upper side of coordinate d where
/// bit d of i is set. The tree need not be balanced: the library derives which nodes hang.
template <class Octree>
class CgalOctree {
public:
    using Element = typename Octree::Node;
    static constexpr int dimension = 3;
    static_assert(Octree::Dimension::value == 3);

    explicit CgalOctree(const Octree& tree)
        : tree_{&tree}, rule_{&dyadic_rule(Shape::hexahedron)} {}

    std::size_t coarse_count() const { return 1; }

    CoarseElement<Element> coarse(std::size_t) const {
        CoarseElement<Element> box;
        box.element = tree_->root();
        box.shape = Shape::hexahedron;
        const auto bounds = tree_->bbox(tree_->root());
        for (std::size_t i = 0; i < 8; ++i) {
            box.ids[i] = i;
            for (std::size_t d = 0; d < 3; ++d) {
                const auto axis = static_cast<int>(d);
                box.corners[i][d] = (i >> d & 1U) != 0 ? bounds.max(axis) : bounds.min(axis);
            }
        }
        return box;
    }

    const Rule* split(const Element& e) const { return e.is_leaf() ? nullptr : rule_; }

    void children(const Element& e, std::span<Element> out) const {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = e[i];
    }

private:
    const Octree* tree_;
    const Rule* rule_;
};

}  // namespace nestgrid
