// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodal data on a triangulation of deal.II, read in place. Included at the end of dealii.hpp.
#pragma once

namespace nestgrid {

/// Components of a finite element function, from the solver's own vector: at the vertices, and, of
/// elements of higher degree, everywhere (degree() and evaluate(), high_order.hpp). Discontinuous
/// elements have no values at vertices, and are drawn within an error alone, or by HighOrder.
template <int dim, class Vector, int component_count = 1, int spacedim = dim>
class DealiiField {
public:
    using Grid = DealiiGrid<dim, spacedim>;
    using value_type = typename Vector::value_type;
    static constexpr int components = component_count;

    /// \param which components of the finite element, in the order in which the field gives them
    /// \throw InvalidInput where the degrees of freedom are not those of the grid or of nodes, or
    ///        where the vector does not have one entry for each
    DealiiField(const Grid& grid, const dealii::DoFHandler<dim, spacedim>& dofs,
                const Vector& values, const std::array<unsigned, component_count>& which = {});

    /// \throw GridError where the triangulation has changed since the field was made, or the vector
    ///        or the degrees of freedom have
    /// \throw InvalidInput where this process needs a value of another one that the vector lacks,
    /// and
    ///        where a component is discontinuous
    NodeMask coarse_values(std::size_t i, std::span<value_type> out) const {
        made_for_.require_same(*grid_, "the field");
        grid_->require_current();
        if (!discontinuous_.empty()) {
            throw InvalidInput(discontinuous_ +
                               " has no values at vertices: it is drawn within an error, by "
                               "HighOrder");
        }
        if (values_->size() != dofs_->n_dofs() || dofs_->n_dofs() != count_) {
            throw GridError(
                "the vector or the degrees of freedom have changed since the field "
                "was made for them: make another one");
        }
        const DofCell c(&grid_->triangulation(), 0, int(i), dofs_);
        NodeMask missing = 0;
        for (unsigned k = 0; k < c->n_vertices(); ++k) missing |= put(c, k, out, k);
        return missing;
    }
    NodeMask new_values(const typename Grid::Element& e, NodeMask which,
                        std::span<value_type> out) const {
        if (grid_->is_parted()) return parted_values(e, which, out);
        // All indices before all values: none waits for another one's way through memory.
        std::array<std::array<dealii::types::global_dof_index, component_count>,
                   Grid::max_new_nodes>
            dof;
        grid_->for_each_new_node(e, [&](std::size_t n, const auto& child, unsigned corner) {
            dof[n] =
                dofs_at({&grid_->triangulation(), child->level(), child->index(), dofs_}, corner);
        });
        for (std::size_t n = 0; which >> n != 0; ++n) {
            if ((which >> n & 1U) == 0) continue;
            for (std::size_t c = 0; c < dof[n].size(); ++c) {
                out[n * dof[n].size() + c] = (*values_)(dof[n][c]);
            }
        }
        return 0;
    }

    /// The greatest degree of the components on a leaf.
    int degree(const typename Grid::Element& leaf) const {
        return elements_[DofCell(&grid_->triangulation(), leaf.level, leaf.index, dofs_)
                             ->active_fe_index()]
            .degree;
    }
    /// Values at points of the reference element. Where these are the nodes of the components,
    /// entries of the vector are copied.
    void evaluate(const typename Grid::Element& leaf, std::span<const Point> reference,
                  std::span<value_type> out) const;

private:
    using DofCell = typename dealii::DoFHandler<dim, spacedim>::cell_iterator;

    /// Vectors of which a process may have a part.
    template <class V>
    static constexpr bool says_what_it_has = requires(const V& v) {
        v.locally_owned_elements();
        v.has_ghost_elements();
    };

    using Dofs = std::array<dealii::types::global_dof_index, component_count>;

    /// Degrees of freedom of the components at a vertex. Of hp elements a cell that is refined has
    /// none: its child at the vertex, and so on, has.
    Dofs dofs_at(DofCell c, unsigned corner) const {
        unsigned element = 0;
        if (elements_.size() > 1) {
            while (c->has_children()) c = c->child(corner);
            element = c->active_fe_index();
        }
        Dofs dofs;
        for (std::size_t i = 0; i < dofs.size(); ++i) {
            dofs[i] = c->vertex_dof_index(corner, elements_[element].offset[i], element);
        }
        return dofs;
    }
    /// Puts the values at a corner of a cell to out, as those of node n.
    /// \return bit n, where another process owns the leaf there
    NodeMask put(const DofCell& c, unsigned corner, std::span<value_type> out,
                 std::size_t n) const {
        if (!grid_->has_leaf({c->level(), c->index()}, corner)) return NodeMask{1} << n;
        const Dofs dofs = dofs_at(c, corner);
        for (std::size_t i = 0; i < dofs.size(); ++i) out[n * dofs.size() + i] = entry(dofs[i]);
        return 0;
    }
    NodeMask parted_values(const typename Grid::Element& e, NodeMask which,
                           std::span<value_type> out) const {
        NodeMask missing = 0;
        grid_->for_each_new_node(e, [&](std::size_t n, const auto& child, unsigned corner) {
            if ((which >> n & 1U) == 0) return;
            const DofCell c(&grid_->triangulation(), child->level(), child->index(), dofs_);
            missing |= put(c, corner, out, n);
        });
        return missing;
    }
    value_type entry(dealii::types::global_dof_index dof) const {
        if (grid_->is_parted()) require_here(dof);
        return (*values_)(dof);
    }
    void require_here(dealii::types::global_dof_index dof) const;

    /// A degree of freedom of a cell, and where it lies.
    struct Node {
        unsigned dof = 0;
        Point at{0, 0, 0};
    };

    /// What the components are of one finite element.
    struct Components {
        std::array<unsigned, component_count> offset{};  // among the degrees of freedom of a vertex
        std::array<std::vector<Node>, component_count> nodes{};  // first direction fastest
        int degree = 1;
    };

    Components find(const dealii::FiniteElement<dim, spacedim>& fe);
    std::vector<Node> find_nodes(const dealii::FiniteElement<dim, spacedim>& fe, unsigned component,
                                 unsigned of_element) const;
    static bool are_at(std::span<const Node> nodes, std::span<const Point> places);
    static dealii::Point<dim> to_unit_cell(const dealii::FiniteElement<dim, spacedim>& fe,
                                           const Point& x);

    const Grid* grid_;
    const dealii::DoFHandler<dim, spacedim>* dofs_;
    const Vector* values_;
    dealii::types::global_dof_index count_;  // of degrees of freedom
    detail::MadeFor made_for_;
    std::array<unsigned, component_count> which_{};
    std::vector<Components> elements_;  // one, or those of the hp collection
    dealii::IndexSet owned_;            // entries of the vector that this process has
    std::string discontinuous_;         // the name of a component that has no values at vertices
};

template <int dim, class Vector, int component_count, int spacedim>
DealiiField<dim, Vector, component_count, spacedim>::DealiiField(
    const Grid& grid, const dealii::DoFHandler<dim, spacedim>& dofs, const Vector& values,
    const std::array<unsigned, component_count>& which)
    : grid_{&grid}, dofs_{&dofs}, values_{&values}, count_{dofs.n_dofs()}, made_for_{grid} {
    if (&dofs.get_triangulation() != &grid.triangulation()) {
        throw InvalidInput("the degrees of freedom are those of another triangulation");
    }
    if (values.size() != dofs.n_dofs()) {
        throw InvalidInput("the vector has " + std::to_string(values.size()) + " entries for " +
                           std::to_string(dofs.n_dofs()) + " degrees of freedom");
    }
    which_ = which;
    if constexpr (says_what_it_has<Vector>) {
        if (grid.is_parted()) owned_ = values.locally_owned_elements();
    }
    const auto& collection = dofs.get_fe_collection();
    for (unsigned i = 0; i < collection.size(); ++i) elements_.push_back(find(collection[i]));
}

/// \throw InvalidInput where this process does not have an entry of the vector, which it needs
template <int dim, class Vector, int component_count, int spacedim>
void DealiiField<dim, Vector, component_count, spacedim>::require_here(
    dealii::types::global_dof_index dof) const {
    if constexpr (says_what_it_has<Vector>) {
        if (owned_.is_element(dof)) return;
        bool here = values_->has_ghost_elements();
        if constexpr (requires { values_->get_partitioner()->is_ghost_entry(dof); }) {
            here = here && values_->get_partitioner()->is_ghost_entry(dof);
        }
        if (here) return;
        throw InvalidInput(
            "entry " + std::to_string(dof) +
            " of the vector belongs to another process, and the vector has no copy of it: it must "
            "have ghost values at all locally relevant degrees of freedom, which must be updated");
    }
}

/// \throw InvalidInput where a component has no nodes, or one value in a cell
template <int dim, class Vector, int component_count, int spacedim>
auto DealiiField<dim, Vector, component_count, spacedim>::find(
    const dealii::FiniteElement<dim, spacedim>& fe) -> Components {
    Components result;
    const unsigned per_vertex = fe.n_dofs_per_vertex();
    for (std::size_t c = 0; c < which_.size(); ++c) {
        if (which_[c] >= fe.n_components()) {
            throw InvalidInput("the finite element has " + std::to_string(fe.n_components()) +
                               " components and no number " + std::to_string(which_[c]));
        }
        // The first degree of freedom of the component. Those at vertices come first of all.
        unsigned first = 0;
        while (
            first < fe.n_dofs_per_cell() &&
            (!fe.is_primitive(first) || fe.system_to_component_index(first).first != which_[c])) {
            ++first;
        }
        const std::string name = "component " + std::to_string(which_[c]) + " of " + fe.get_name();
        if (first == fe.n_dofs_per_cell()) throw InvalidInput(name + " has no nodes");
        const unsigned base = fe.system_to_base_index(first).first.first;
        if (!fe.base_element(base).has_support_points() || fe.base_element(base).degree == 0) {
            throw InvalidInput(name + " has no nodal values at vertices");
        }
        if (first >= per_vertex) discontinuous_ = name;
        result.offset[c] = first;
        result.nodes[c] = find_nodes(fe, which_[c], base);
        result.degree = std::max(result.degree, static_cast<int>(fe.base_element(base).degree));
    }
    return result;
}

/// The degrees of freedom of a component, which is one of the base element with this number.
template <int dim, class Vector, int component_count, int spacedim>
auto DealiiField<dim, Vector, component_count, spacedim>::find_nodes(
    const dealii::FiniteElement<dim, spacedim>& fe, unsigned component, unsigned of_element) const
    -> std::vector<Node> {
    std::vector<Node> nodes;
    const auto& places = fe.base_element(of_element).get_unit_support_points();
    for (unsigned i = 0; i < fe.n_dofs_per_cell(); ++i) {
        if (!fe.is_primitive(i) || fe.system_to_component_index(i).first != component) continue;
        Node node{i, {0, 0, 0}};
        for (unsigned d = 0; d < dim; ++d) {
            node.at[d] = places[fe.system_to_base_index(i).second][d];
        }
        nodes.push_back(node);
    }
    std::ranges::sort(nodes, [](const Node& a, const Node& b) {
        for (std::size_t d = dim; d-- > 0;) {
            if (std::abs(a.at[d] - b.at[d]) > 1e-9) return a.at[d] < b.at[d];
        }
        return false;
    });
    return nodes;
}

template <int dim, class Vector, int component_count, int spacedim>
bool DealiiField<dim, Vector, component_count, spacedim>::are_at(std::span<const Node> nodes,
                                                                 std::span<const Point> places) {
    return std::equal(
        nodes.begin(), nodes.end(), places.begin(), places.end(),
        [](const Node& node, const Point& place) { return norm(node.at - place) < 1e-12; });
}

/// The base of deal.II's pyramid is twice as long, and its apex lies above the middle.
template <int dim, class Vector, int component_count, int spacedim>
dealii::Point<dim> DealiiField<dim, Vector, component_count, spacedim>::to_unit_cell(
    const dealii::FiniteElement<dim, spacedim>& fe, const Point& x) {
    dealii::Point<dim> to;
    const bool pyramid = fe.reference_cell() == dealii::ReferenceCells::Pyramid;
    for (unsigned d = 0; d < dim; ++d) to[d] = pyramid && d < 2 ? 2 * x[d] - (1 - x[2]) : x[d];
    return to;
}

template <int dim, class Vector, int component_count, int spacedim>
void DealiiField<dim, Vector, component_count, spacedim>::evaluate(
    const typename Grid::Element& leaf, std::span<const Point> reference,
    std::span<value_type> out) const {
    const DofCell cell(&grid_->triangulation(), leaf.level, leaf.index, dofs_);
    const auto& fe = cell->get_fe();
    const Components& of_cell = elements_[cell->active_fe_index()];
    std::vector<dealii::types::global_dof_index> dof(fe.n_dofs_per_cell());
    cell->get_dof_indices(dof);
    const std::size_t stride = which_.size();
    for (std::size_t c = 0; c < stride; ++c) {
        const std::vector<Node>& nodes = of_cell.nodes[c];
        if (are_at(nodes, reference)) {
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                out[i * stride + c] = entry(dof[nodes[i].dof]);
            }
            continue;
        }
        for (std::size_t i = 0; i < reference.size(); ++i) {
            const dealii::Point<dim> at = to_unit_cell(fe, reference[i]);
            double sum = 0;
            for (const Node& node : nodes) {
                sum += fe.shape_value_component(node.dof, at, which_[c]) *
                       static_cast<double>(entry(dof[node.dof]));
            }
            out[i * stride + c] = static_cast<value_type>(sum);
        }
    }
}

}  // namespace nestgrid
