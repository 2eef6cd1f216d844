// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests of p4est with their lnodes, which tell what hangs. Included at the end of p4est.hpp.
#pragma once

#include <nestgrid/adapters/p4est_face_codes.hpp>

namespace nestgrid {

/// The same forest with its lnodes of degree 1, whose face codes tell which nodes hang, so that the
/// library needs not derive it: prerolls take half the time. lnodes exist on forests that are
/// balanced across corners (P4EST_CONNECT_FULL); on these a node hangs on leaves one level coarser
/// only, so the leaves around it all know.
template <int dim, class Map = P4estVertices>
class P4estBalancedGrid : public P4estGrid<dim, Map> {
public:
    using Base = P4estGrid<dim, Map>;
    using Element = typename Base::Element;

    /// \param nodes must outlive the grid, as the forest
    /// \throw InvalidInput as P4estGrid, and for lnodes of another degree or another forest
    P4estBalancedGrid(const typename Base::Forest* forest,
                      const typename P4estTypes<dim>::Nodes* nodes, Map map = {})
        : Base{forest, std::move(map)}, codes_{nodes, Base::leaf_count()} {}

    NodeMask constrained(const Element& e) const {
        std::array<Element, Base::max_children> children;
        Base::children(e, children);
        NodeMask mask = 0;
        for (unsigned c = 0; c < Base::max_children; ++c) {
            if (Base::split(children[c]) != nullptr) continue;
            const unsigned code = codes_[Base::leaf_index(children[c])];
            if (code == 0) continue;
            for (unsigned k = 0; k < Base::max_corners; ++k) {
                if (!codes_.hangs(code, c ^ k)) continue;
                mask |= NodeMask{1} << Base::split(e)->children[c].corner[k];
            }
        }
        return mask >> static_cast<unsigned>(Base::max_corners);
    }

private:
    detail::P4estFaceCodes<dim> codes_;
};

template <class Nodes>
P4estBalancedGrid(const p4est_t*, Nodes*) -> P4estBalancedGrid<2>;
template <class Nodes>
P4estBalancedGrid(const p8est_t*, Nodes*) -> P4estBalancedGrid<3>;
template <class Nodes, class Map>
P4estBalancedGrid(const p4est_t*, Nodes*, Map) -> P4estBalancedGrid<2, Map>;
template <class Nodes, class Map>
P4estBalancedGrid(const p8est_t*, Nodes*, Map) -> P4estBalancedGrid<3, Map>;

}  // namespace nestgrid
