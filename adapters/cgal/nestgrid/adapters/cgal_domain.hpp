// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The inside of a closed triangle surface as the domain of a lens, by CGAL's tree of boxes (GPL).
#pragma once

#include <cmath>
#include <memory>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Kernel_traits.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/number_utils.h>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// The distance from the solid within a surface; a Distance (domains.hpp). Copies share their tree.
/// \tparam P a point of a kernel with exact predicates
template <class P>
class CgalSolid {
public:
    /// \param surface must not intersect itself; must outlive the domain and stay as it is
    /// \throw InvalidInput where the surface is empty, open, or has other faces than triangles
    explicit CgalSolid(const CGAL::Surface_mesh<P>& surface) {
        // CGAL::is_empty() asks for vertices, which may lie in no face.
        if (surface.number_of_faces() == 0) {
            throw InvalidInput("the surface of a solid is empty");
        }
        if (!CGAL::is_closed(surface)) throw InvalidInput("the surface of a solid is open");
        if (!CGAL::is_triangle_mesh(surface)) {
            throw InvalidInput("the surface of a solid has faces that are no triangles");
        }
        search_ = std::make_shared<const Search>(surface);
    }

    double operator()(const Point& x) const {
        const P at(x[0], x[1], x[2]);
        if (search_->side(at) != CGAL::ON_UNBOUNDED_SIDE) return 0;
        return std::sqrt(CGAL::to_double(search_->tree.squared_distance(at)));
    }

private:
    using Mesh = CGAL::Surface_mesh<P>;
    using Kernel = typename CGAL::Kernel_traits<P>::Kernel;
    using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
    using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

    struct Search {
        Tree tree;
        CGAL::Side_of_triangle_mesh<Mesh, Kernel> side;

        explicit Search(const Mesh& surface)
            : tree{faces(surface).first, faces(surface).second, surface}, side{tree} {
            // Built here, and not by the first of several threads.
            tree.build();
            tree.accelerate_distance_queries();
        }
    };

    std::shared_ptr<const Search> search_;
};

}  // namespace nestgrid
