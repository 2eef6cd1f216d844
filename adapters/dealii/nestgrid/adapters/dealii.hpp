// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II's triangulations (Arndt et al. 2022), read in place; dealii_fields.hpp has the data on
// them.
//
// Elements are cells of any level, nodes are deal.II's vertices, whose indices are shared by all
// levels: they are the node keys. Quadrilaterals and hexahedra may be refined locally, simplices
// everywhere or locally; refinement must be isotropic.
// Kept beside the triangulation: one bit per vertex, whether it hangs; it follows every refinement,
// looked for by deal.II's own threads (dealii::MultithreadInfo).
//
// A grid of a parallel::distributed or parallel::shared triangulation tells by `presence` which
// leaves this process owns, one byte a cell, and distributed.hpp reaches the others. Numbers of
// vertices differ between processes, so the library derives the keys of nodes, and which of them
// hang. Such a grid does not follow refinements: it must be made anew.
#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/parallel.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>

#include <nestgrid/detail/made_for.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/optional.hpp>
#include <nestgrid/rule_table.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// A triangulation as a nested grid. It must outlive this object, which follows its refinements on
/// one process: what was derived from an earlier state (an indicator) is refused afterwards.
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

    /// \param mapping gives the positions of vertices, and those inside cells if it is a MappingQ
    ///        or a MappingFE; null: where the triangulation has them
    ///
    /// \throw InvalidInput for a triangulation that is refined in one direction only, or over
    ///        several processes fully distributed or with a mapping, on all processes alike
    explicit DealiiGrid(const Triangulation& triangulation,
                        const dealii::Mapping<dim, spacedim>* mapping = nullptr);
    /// The grid of the same triangulation, as it is now.
    DealiiGrid(const DealiiGrid& other) : DealiiGrid(*other.triangulation_, other.mapping_) {}
    DealiiGrid& operator=(const DealiiGrid&) = delete;

    /// Over several processes it says what is here, and neither keys nor which nodes hang.
    bool offers(Feature feature) const {
        const bool needs_whole = feature == Feature::own_keys || feature == Feature::dense_keys ||
                                 feature == Feature::constrained;
        if (feature == Feature::geometry_degree) return mapping_degree_ > 1;
        return feature == Feature::presence ? parted_ : !parted_ || !needs_whole;
    }

    std::size_t coarse_count() const { return triangulation_->n_cells(0); }
    /// \throw GridError as require_current()
    CoarseElement<Element> coarse(std::size_t i) const;
    const Rule* split(const Element& e) const {
        const Cell c = cell(e);
        if (!c->has_children()) return nullptr;
        return all_cubes_ ? halving_ : other_split(c);
    }
    void children(const Element& e, std::span<Element> out) const {
        const Cell c = cell(e);
        for (unsigned k = 0; k < out.size(); ++k) out[k] = {e.level + 1, c->child_index(k)};
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
            hanging |= NodeMask{hangs(child->vertex_index(corner))} << n;
        });
        return hanging;
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out) const;
    int geometry_degree(const Element&) const { return mapping_degree_; }
    void map(const Element& leaf, std::span<const Point> reference, std::span<Point> out) const;
    Presence presence(const Element& e) const {
        return presence_[static_cast<std::size_t>(e.level)][static_cast<std::size_t>(e.index)];
    }
    int rank_count() const {
        const auto processes =
            dealii::Utilities::MPI::n_mpi_processes(triangulation_->get_communicator());
        return static_cast<int>(processes);
    }
    std::uint64_t epoch() const { return epoch_; }

    const Triangulation& triangulation() const { return *triangulation_; }
    Cell cell(const Element& e) const { return Cell(triangulation_, e.level, e.index); }
    /// Number of a leaf in vectors of cell data, such as those of dealii::KellyErrorEstimator.
    unsigned leaf_index(const Element& e) const { return cell(e)->active_cell_index(); }
    /// \throw GridError over several processes, where the triangulation has changed since
    void require_current() const {
        if (!stale_) return;
        throw GridError(
            "the triangulation has changed since the grid was made for it: over several processes, "
            "make another DealiiGrid");
    }
    /// Whether leaves may be on other processes.
    bool is_parted() const { return parted_; }
    /// Whether this process owns the leaf in a corner of an element.
    bool has_leaf(Element e, unsigned corner) const {
        while (parted_ && presence(e) != Presence::here) {
            if (presence(e) == Presence::elsewhere) return false;
            e = {e.level + 1, cell(e)->child_index(static_cast<int>(corner))};
        }
        return true;
    }

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
    bool hangs(unsigned vertex) const { return (hangs_[vertex / 64] >> vertex % 64 & 1U) != 0; }
    const Rule* other_split(const Cell& c) const;
    static Shape shape(const Cell& c);
    Point position(const Cell& c, unsigned corner) const;
    static Point point(const dealii::Point<spacedim>& x) {
        Point result{0, 0, 0};
        for (unsigned d = 0; d < spacedim; ++d) result[d] = x[d];
        return result;
    }
    std::vector<PlacedChild> simplex_children(const Cell& c) const;
    template <class Function>
    void for_each_cell(Function&& f) const;
    template <class Object>
    void mark(const Object& line_or_face, int level, bool lines_too,
              const std::vector<std::uint8_t>& finest);
    void find_rules();
    void find_presence();
    static void require_isotropic(const Cell& c);
    void find_hanging();
    void update();

    const Triangulation* triangulation_;
    const dealii::Mapping<dim, spacedim>* mapping_;
    int mapping_degree_ = 1;
    const Rule* halving_ = nullptr;
    bool all_cubes_ = false;
    RuleTable simplex_rules_;
    const Rule* only_simplex_rule_ = nullptr;
    std::vector<std::uint64_t> hangs_;             // one bit a vertex
    bool parted_ = false;                          // over several processes
    bool stale_ = false;                           // and changed since
    std::vector<std::vector<Presence>> presence_;  // by level and index; of one process: none
    std::uint64_t epoch_ = 0;
    std::array<boost::signals2::scoped_connection, 4> changed_;
};

}  // namespace nestgrid

#include <nestgrid/adapters/dealii_fields.hpp>
#include <nestgrid/adapters/dealii_steps.hpp>
