// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data on a forest of p4est, read in place. Included at the end of p4est.hpp.
#pragma once

#include <bit>

#include <nestgrid/adapters/p4est_face_codes.hpp>
#include <nestgrid/detail/made_for.hpp>
#include <nestgrid/detail/mean.hpp>

namespace nestgrid {

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
        NodeMask missing = 0;
        for (unsigned c = 0; c < corners_; ++c) put_corner_value(e, c, c, out, missing);
        return missing;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<Real> out) const {
        const Rule& rule = *grid_->split(e);
        std::array<Element, corners_> children;
        grid_->children(e, children);
        NodeMask missing = 0;
        for (std::size_t k = 0; k < Grid::max_new_nodes; ++k) {
            if ((which >> k & 1U) == 0) continue;
            const auto [child, corner] = rule.new_corner[k];
            put_corner_value(children[child], corner, k, out, missing);
        }
        return missing;
    }

private:
    static constexpr unsigned corners_ = 1U << dim;

    /// Puts the value at a corner of an element into out[n], unless the leaf there is elsewhere.
    void put_corner_value(const Element& e, unsigned corner, std::size_t n, std::span<Real> out,
                          NodeMask& missing) const {
        const std::size_t leaf = grid_->corner_leaf(e, corner);
        if (leaf == Grid::no_leaf) {
            missing |= NodeMask{1} << n;
        } else {
            out[n] = leaf_value(leaf, corner);
        }
    }
    Real leaf_value(std::size_t leaf, unsigned corner) const {
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
        : grid_{&grid}, values_{values}, made_for_{grid} {
        if (values.size() != grid.leaf_count()) {
            throw InvalidInput("there are " + std::to_string(values.size()) +
                               " values of cells, but " + std::to_string(grid.leaf_count()) +
                               " leaves");
        }
    }
    /// \throw GridError where the forest has changed since
    Real operator()(const typename Grid::Element& leaf) const {
        made_for_.require_same(*grid_, "the object with its values of cells");
        return values_[grid_->leaf_index(leaf)];
    }

private:
    const Grid* grid_;
    std::span<const Real> values_;
    detail::MadeFor made_for_;
};

template <int dim, class Map, class Values>
P4estCellValues(const P4estGrid<dim, Map>&, const Values&)
    -> P4estCellValues<dim, Map, std::remove_cvref_t<decltype(std::declval<const Values&>()[0])>>;

}  // namespace nestgrid
