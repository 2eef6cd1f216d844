// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II's triangulations (Arndt et al. 2022) and nodal data on them, read in place.
//
// Elements are cells of any level, nodes are deal.II's vertices, whose indices are shared by all
// levels: they are the node keys. Quadrilaterals and hexahedra may be refined locally, simplices
// everywhere or locally; refinement must be isotropic.
// Kept beside the triangulation: one bit per vertex, whether it hangs; it follows every refinement.
#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>

#include <nestgrid/error.hpp>
#include <nestgrid/operations.hpp>
#include <nestgrid/rule_table.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// A triangulation as a nested grid. It must outlive this object, which follows its refinements:
/// what was derived from an earlier state (an indicator) is refused afterwards.
template <int dim, int spacedim = dim>
class DealiiGrid {
public:
    using Triangulation = dealii::Triangulation<dim, spacedim>;
    using Cell = typename Triangulation::cell_iterator;
    struct Element {
        int level = 0;
        int index = 0;
    };
    static constexpr int dimension = dim;
    static constexpr int max_corners = 1 << dim;
    static constexpr int max_new_nodes = dim == 1 ? 1 : dim == 2 ? 5 : 19;
    static constexpr int max_children = 1 << dim;

    /// \param mapping gives the positions of vertices; null: where the triangulation has them
    /// \throw InvalidInput for a triangulation that is distributed over several processes, or
    ///        refined in one direction only
    explicit DealiiGrid(const Triangulation& triangulation,
                        const dealii::Mapping<dim, spacedim>* mapping = nullptr);

    std::size_t coarse_count() const { return triangulation_->n_cells(0); }
    CoarseElement<Element> coarse(std::size_t i) const;
    const Rule* split(const Element& e) const {
        const Cell c = cell(e);
        if (!c->has_children()) return nullptr;
        return all_cubes_ ? halving_ : other_split(c);
    }
    void children(const Element& e, std::span<Element> out) const {
        const Cell c = cell(e);
        for (unsigned k = 0; k < out.size(); ++k) out[k] = {e.level + 1, c->child_index(int(k))};
    }

    std::size_t node_count() const { return triangulation_->n_vertices(); }
    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        const Cell c = cell(e);
        for (unsigned k = 0; k < out.size(); ++k) out[k] = c->vertex_index(k);
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const {
        for_each_new_node(e, [&](std::size_t n, const Cell& child, unsigned corner) {
            out[n] = child->vertex_index(corner);
        });
    }
    NodeMask constrained(const Element& e) const {
        NodeMask hanging = 0;
        for_each_new_node(e, [&](std::size_t n, const Cell& child, unsigned corner) {
            hanging |= NodeMask{hangs_[child->vertex_index(corner)]} << n;
        });
        return hanging;
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out) const;
    std::uint64_t epoch() const { return epoch_; }

    const Triangulation& triangulation() const { return *triangulation_; }
    Cell cell(const Element& e) const { return Cell(triangulation_, e.level, e.index); }
    /// Number of a leaf in vectors of cell data, such as those of dealii::KellyErrorEstimator.
    unsigned leaf_index(const Element& e) const { return cell(e)->active_cell_index(); }

    /// Calls f(n, child, corner) for every new node n of an element that is refined.
    template <class Function>
    void for_each_new_node(const Element& e, Function&& f) const {
        const Rule& rule = *split(e);
        const Cell c = cell(e);
        std::array<int, max_children> child;
        for (unsigned k = 0; k < rule.children.size(); ++k) child[k] = c->child_index(k);
        for (std::size_t n = 0; n < rule.new_corner.size(); ++n) {
            const ChildCorner at = rule.new_corner[n];
            f(n, cell({e.level + 1, child[at.child]}), unsigned{at.corner});
        }
    }

private:
    const Rule* other_split(const Cell& c) const;
    static Shape shape(const Cell& c);
    Point position(const Cell& c, unsigned corner) const;
    static Point point(const dealii::Point<spacedim>& x) {
        Point result{0, 0, 0};
        for (unsigned d = 0; d < spacedim; ++d) result[d] = x[d];
        return result;
    }
    std::vector<PlacedChild> simplex_children(const Cell& c) const;
    template <class Object>
    void mark(const Object& line_or_face, int level, bool lines_too,
              const std::vector<std::uint8_t>& finest);
    void update();

    const Triangulation* triangulation_;
    const dealii::Mapping<dim, spacedim>* mapping_;
    const Rule* halving_ = nullptr;
    bool all_cubes_ = false;
    RuleTable simplex_rules_;
    const Rule* only_simplex_rule_ = nullptr;
    std::vector<bool> hangs_;  // by vertex
    std::uint64_t epoch_ = 0;
    boost::signals2::scoped_connection refined_;
};

/// Components of a finite element function at the vertices, from the solver's own vector. Of
/// elements of higher order the values at the vertices alone are used.
template <int dim, class Vector, int component_count = 1, int spacedim = dim>
class DealiiField {
public:
    using Grid = DealiiGrid<dim, spacedim>;
    using value_type = typename Vector::value_type;
    static constexpr int components = component_count;

    /// \param which components of the finite element, in the order in which the field gives them
    /// \throw InvalidInput where the degrees of freedom are not those of the grid or of nodes at
    ///        its vertices, or where the vector does not have one entry for each
    DealiiField(const Grid& grid, const dealii::DoFHandler<dim, spacedim>& dofs,
                const Vector& values, const std::array<unsigned, component_count>& which = {});

    NodeMask coarse_values(std::size_t i, std::span<value_type> out) const {
        const DofCell c(&grid_->triangulation(), 0, int(i), dofs_);
        for (unsigned k = 0; k < c->n_vertices(); ++k) put(c, k, out, k);
        return 0;
    }
    NodeMask new_values(const typename Grid::Element& e, NodeMask which,
                        std::span<value_type> out) const {
        // All indices before all values: none waits for another one's way through memory.
        std::array<std::array<dealii::types::global_dof_index, component_count>,
                   Grid::max_new_nodes>
            dof;
        grid_->for_each_new_node(e, [&](std::size_t n, const auto& child, unsigned corner) {
            const DofCell c(&grid_->triangulation(), child->level(), child->index(), dofs_);
            for (std::size_t i = 0; i < offset_.size(); ++i) {
                dof[n][i] = c->vertex_dof_index(corner, offset_[i]);
            }
        });
        for (std::size_t n = 0; which >> n != 0; ++n) {
            if ((which >> n & 1U) == 0) continue;
            for (std::size_t i = 0; i < offset_.size(); ++i) {
                out[n * offset_.size() + i] = (*values_)(dof[n][i]);
            }
        }
        return 0;
    }

private:
    using DofCell = typename dealii::DoFHandler<dim, spacedim>::cell_iterator;

    void put(const DofCell& c, unsigned corner, std::span<value_type> out, std::size_t n) const {
        for (std::size_t i = 0; i < offset_.size(); ++i) {
            out[n * offset_.size() + i] = (*values_)(c->vertex_dof_index(corner, offset_[i]));
        }
    }

    const Grid* grid_;
    const dealii::DoFHandler<dim, spacedim>* dofs_;
    const Vector* values_;
    std::array<unsigned, component_count> offset_{};  // among the degrees of freedom of a vertex
};

}  // namespace nestgrid

#include <nestgrid/adapters/dealii_steps.hpp>
