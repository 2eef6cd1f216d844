// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data on a forest of p4est, read in place; included by p4est.hpp.
#pragma once

#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/mean.hpp>

namespace nestgrid {

namespace detail {

/// The face codes of lnodes of degree 1.
template <int dim>
class P4estFaceCodes {
public:
    using Nodes = typename P4estTypes<dim>::Nodes;

    /// \throw InvalidInput for lnodes of another degree or another forest
    P4estFaceCodes(const Nodes* nodes, std::size_t leaf_count) : nodes_{nodes} {
        if (nodes == nullptr) throw InvalidInput("there are no lnodes");
        if (nodes->degree != 1) {
            throw InvalidInput("the lnodes have degree " + std::to_string(nodes->degree) +
                               ", not 1");
        }
        if (static_cast<std::size_t>(nodes->num_local_elements) != leaf_count) {
            throw InvalidInput("the lnodes belong to another forest: they number " +
                               std::to_string(nodes->num_local_elements) +
                               " elements, but there are " + std::to_string(leaf_count) +
                               " leaves");
        }
    }
    /// 0 where no corner of the leaf hangs.
    unsigned operator[](std::size_t leaf) const {
        return static_cast<unsigned>(nodes_->face_code[leaf]);
    }
    /// The corner of a leaf that is one of its father's too.
    static unsigned own_corner(unsigned code) { return code & (corners_ - 1); }

    /// Whether the corner hangs that lies apart from that one in some directions, one bit each.
    /// Behind the own corner, bit i of a code stands for the father's face across direction i and,
    /// in three dimensions, a later one for its edge along it.
    static bool hangs(unsigned code, unsigned apart) {
        if (code == 0 || apart == 0 || apart == corners_ - 1) return false;
        if (dim == 3 && std::has_single_bit(apart)) return (code >> 6U & apart) != 0;
        return (code >> static_cast<unsigned>(dim) & (apart ^ (corners_ - 1))) != 0;
    }

private:
    static constexpr unsigned corners_ = 1U << dim;
    const Nodes* nodes_;
};

}  // namespace detail

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

/// Nodal values by p4est_lnodes or p8est_lnodes of degree 1, one per independent node. Nodes that
/// hang have no value of their own and get the mean of the corners of the edge or face they hang
/// on. lnodes exist on forests that are balanced across corners (P4EST_CONNECT_FULL).
template <int dim, class Map, class Real>
class P4estNodalField {
public:
    using value_type = Real;
    using Grid = P4estGrid<dim, Map>;
    using Element = typename Grid::Element;
    using Nodes = typename P4estTypes<dim>::Nodes;

    /// \param values of each local node; all three must outlive the field and stay as they are
    /// \throw InvalidInput for lnodes of another degree or another forest, or where there is not
    ///        one value for each node
    P4estNodalField(const Grid& grid, const Nodes* nodes, std::span<const Real> values)
        : grid_{&grid},
          codes_{nodes, grid.leaf_count()},
          nodes_{nodes},
          values_{values},
          epoch_{grid.epoch()} {
        if (values.size() != static_cast<std::size_t>(nodes->num_local_nodes)) {
            throw InvalidInput("there are " + std::to_string(values.size()) +
                               " values, but the lnodes number " +
                               std::to_string(nodes->num_local_nodes) + " nodes");
        }
    }

    /// \throw GridError where the forest has changed since the field was made
    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        if (grid_->epoch() != epoch_) {
            throw GridError("the forest has changed since its nodes were numbered");
        }
        const Element e = grid_->coarse(i).element;
        for (unsigned c = 0; c < corners_; ++c) out[c] = corner_value(e, c);
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<Real> out) const {
        const Rule& rule = *grid_->split(e);
        std::array<Element, corners_> children;
        grid_->children(e, children);
        for (std::size_t k = 0; k < Grid::max_new_nodes; ++k) {
            if ((which >> k & 1U) == 0) continue;
            const auto [child, corner] = rule.new_corner[k];
            out[k] = corner_value(children[child], corner);
        }
        return 0;
    }

private:
    static constexpr unsigned corners_ = 1U << dim;

    Real corner_value(const Element& e, unsigned corner) const {
        const std::size_t leaf = grid_->corner_leaf(e, corner);
        const auto at = [&](unsigned c) {
            return values_[static_cast<std::size_t>(nodes_->element_nodes[corners_ * leaf + c])];
        };
        const unsigned code = codes_[leaf];
        const unsigned own = codes_.own_corner(code);
        const unsigned apart = own ^ corner;
        if (!codes_.hangs(code, apart)) return at(corner);
        // The entries of hanging corners are the nodes of the father's edge or face.
        if (std::has_single_bit(apart)) return midpoint(at(own), at(corner));
        const unsigned first = apart & (~apart + 1);
        return face_mean(at(own), at(own ^ first), at(own ^ apart ^ first), at(corner));
    }

    const Grid* grid_;
    detail::P4estFaceCodes<dim> codes_;
    const Nodes* nodes_;
    std::span<const Real> values_;
    std::uint64_t epoch_;
};

template <int dim, class Map, class Nodes, class Values>
P4estNodalField(const P4estGrid<dim, Map>&, Nodes*, const Values&)
    -> P4estNodalField<dim, Map, std::remove_cvref_t<decltype(std::declval<const Values&>()[0])>>;

/// Values of cells, one per leaf in p4est's order: what CellAverages asks for.
template <int dim, class Map, class Real>
class P4estCellValues {
public:
    using Grid = P4estGrid<dim, Map>;

    /// \param values of each leaf; both must outlive this and stay as they are
    /// \throw InvalidInput where there is not one value for each leaf
    P4estCellValues(const Grid& grid, std::span<const Real> values)
        : grid_{&grid}, values_{values} {
        if (values.size() != grid.leaf_count()) {
            throw InvalidInput("there are " + std::to_string(values.size()) +
                               " values of cells, but " + std::to_string(grid.leaf_count()) +
                               " leaves");
        }
    }
    Real operator()(const typename Grid::Element& leaf) const {
        return values_[grid_->leaf_index(leaf)];
    }

private:
    const Grid* grid_;
    std::span<const Real> values_;
};

template <int dim, class Map, class Values>
P4estCellValues(const P4estGrid<dim, Map>&, const Values&)
    -> P4estCellValues<dim, Map, std::remove_cvref_t<decltype(std::declval<const Values&>()[0])>>;

}  // namespace nestgrid
