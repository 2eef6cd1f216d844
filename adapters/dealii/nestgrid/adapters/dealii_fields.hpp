// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodal data on a triangulation of deal.II, read in place. Included at the end of dealii.hpp.
#pragma once

namespace nestgrid {

/// Components of a finite element function, from the solver's own vector: at the vertices, and, of
/// elements of higher degree, everywhere (degree() and evaluate(), high_order.hpp).
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

    /// \throw GridError where the triangulation has changed since the field was made, or the vector
    ///        or the degrees of freedom have
    NodeMask coarse_values(std::size_t i, std::span<value_type> out) const {
        made_for_.require_same(*grid_, "the field");
        if (values_->size() != dofs_->n_dofs() || dofs_->n_dofs() != count_) {
            throw GridError(
                "the vector or the degrees of freedom have changed since the field "
                "was made for them: make another one");
        }
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

    /// The greatest degree of the components, the same on all leaves.
    int degree(const typename Grid::Element& /*leaf*/) const { return degree_; }
    /// Values at points of the reference element. Where these are the nodes of the components,
    /// entries of the vector are copied.
    void evaluate(const typename Grid::Element& leaf, std::span<const Point> reference,
                  std::span<value_type> out) const;

private:
    using DofCell = typename dealii::DoFHandler<dim, spacedim>::cell_iterator;

    void put(const DofCell& c, unsigned corner, std::span<value_type> out, std::size_t n) const {
        for (std::size_t i = 0; i < offset_.size(); ++i) {
            out[n * offset_.size() + i] = (*values_)(c->vertex_dof_index(corner, offset_[i]));
        }
    }

    /// A degree of freedom of a cell, and where it lies.
    struct Node {
        unsigned dof = 0;
        Point at{0, 0, 0};
    };

    void find_nodes(std::size_t component, unsigned of_element);
    static bool are_at(std::span<const Node> nodes, std::span<const Point> places);
    dealii::Point<dim> to_unit_cell(const Point& x) const;

    const Grid* grid_;
    const dealii::DoFHandler<dim, spacedim>* dofs_;
    const Vector* values_;
    dealii::types::global_dof_index count_;  // of degrees of freedom
    detail::MadeFor made_for_;
    std::array<unsigned, component_count> offset_{};  // among the degrees of freedom of a vertex
    int degree_ = 1;
    std::array<std::vector<Node>, component_count> nodes_{};  // first direction fastest
    std::array<unsigned, component_count> which_{};
};

template <int dim, class Vector, int component_count, int spacedim>
DealiiField<dim, Vector, component_count, spacedim>::DealiiField(
    const Grid& grid, const dealii::DoFHandler<dim, spacedim>& dofs, const Vector& values,
    const std::array<unsigned, component_count>& which)
    : grid_{&grid}, dofs_{&dofs}, values_{&values}, count_{dofs.n_dofs()}, made_for_{grid} {
    if (&dofs.get_triangulation() != &grid.triangulation()) {
        throw InvalidInput("the degrees of freedom are those of another triangulation");
    }
    if (dofs.has_hp_capabilities()) {
        throw InvalidInput("degrees of freedom of hp elements are not supported");
    }
    if (values.size() != dofs.n_dofs()) {
        throw InvalidInput("the vector has " + std::to_string(values.size()) + " entries for " +
                           std::to_string(dofs.n_dofs()) + " degrees of freedom");
    }
    const auto& fe = dofs.get_fe();
    which_ = which;
    const unsigned per_vertex = fe.n_dofs_per_vertex();
    for (std::size_t c = 0; c < which.size(); ++c) {
        if (which[c] >= fe.n_components()) {
            throw InvalidInput("the finite element has " + std::to_string(fe.n_components()) +
                               " components and no number " + std::to_string(which[c]));
        }
        bool found = false;
        for (unsigned i = 0; i < per_vertex && !found; ++i) {
            // A node of the component at the vertex itself.
            if (!fe.is_primitive(i) || fe.system_to_component_index(i).first != which[c]) continue;
            const unsigned base = fe.system_to_base_index(i).first.first;
            found = fe.base_element(base).has_support_points();
            offset_[c] = i;
        }
        if (!found) {
            throw InvalidInput("component " + std::to_string(which[c]) + " of " + fe.get_name() +
                               " has no nodal values at vertices");
        }
        find_nodes(c, fe.system_to_base_index(offset_[c]).first.first);
    }
}

/// Lists the degrees of freedom of a component. It is one of the base element with this number.
template <int dim, class Vector, int component_count, int spacedim>
void DealiiField<dim, Vector, component_count, spacedim>::find_nodes(std::size_t component,
                                                                     unsigned of_element) {
    const auto& fe = dofs_->get_fe();
    degree_ = std::max(degree_, static_cast<int>(fe.base_element(of_element).degree));
    std::vector<Node>& nodes = nodes_[component];
    for (unsigned i = 0; i < fe.n_dofs_per_cell(); ++i) {
        if (!fe.is_primitive(i) || fe.system_to_component_index(i).first != which_[component]) {
            continue;
        }
        Node node{i, {0, 0, 0}};
        const unsigned in_base = fe.system_to_base_index(i).second;
        const auto& places = fe.base_element(of_element).get_unit_support_points();
        for (unsigned d = 0; d < dim; ++d) node.at[d] = places[in_base][d];
        nodes.push_back(node);
    }
    std::ranges::sort(nodes, [](const Node& a, const Node& b) {
        for (std::size_t d = dim; d-- > 0;) {
            if (std::abs(a.at[d] - b.at[d]) > 1e-9) return a.at[d] < b.at[d];
        }
        return false;
    });
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
    const Point& x) const {
    dealii::Point<dim> to;
    const bool pyramid = dofs_->get_fe().reference_cell() == dealii::ReferenceCells::Pyramid;
    for (unsigned d = 0; d < dim; ++d) to[d] = pyramid && d < 2 ? 2 * x[d] - (1 - x[2]) : x[d];
    return to;
}

template <int dim, class Vector, int component_count, int spacedim>
void DealiiField<dim, Vector, component_count, spacedim>::evaluate(
    const typename Grid::Element& leaf, std::span<const Point> reference,
    std::span<value_type> out) const {
    const auto& fe = dofs_->get_fe();
    const DofCell cell(&grid_->triangulation(), leaf.level, leaf.index, dofs_);
    std::vector<dealii::types::global_dof_index> dof(fe.n_dofs_per_cell());
    cell->get_dof_indices(dof);
    const std::size_t stride = nodes_.size();
    for (std::size_t c = 0; c < stride; ++c) {
        const std::vector<Node>& nodes = nodes_[c];
        if (are_at(nodes, reference)) {
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                out[i * stride + c] = (*values_)(dof[nodes[i].dof]);
            }
            continue;
        }
        for (std::size_t i = 0; i < reference.size(); ++i) {
            const dealii::Point<dim> at = to_unit_cell(reference[i]);
            double sum = 0;
            for (const Node& node : nodes) {
                sum += fe.shape_value_component(node.dof, at, which_[c]) *
                       static_cast<double>((*values_)(dof[node.dof]));
            }
            out[i * stride + c] = static_cast<value_type>(sum);
        }
    }
}

}  // namespace nestgrid
