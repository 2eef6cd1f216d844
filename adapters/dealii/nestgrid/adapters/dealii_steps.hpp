// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of DealiiGrid. Included at the end of dealii.hpp.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>

namespace nestgrid {

template <int dim, int spacedim>
DealiiGrid<dim, spacedim>::DealiiGrid(const Triangulation& triangulation,
                                      const dealii::Mapping<dim, spacedim>* mapping)
    : triangulation_{&triangulation}, mapping_{mapping} {
    namespace mpi = dealii::Utilities::MPI;
    parted_ = mpi::job_supports_mpi() && mpi::n_mpi_processes(triangulation.get_communicator()) > 1;
    using Fully = dealii::parallel::fullydistributed::Triangulation<dim, spacedim>;
    if (parted_ && dynamic_cast<const Fully*>(&triangulation) != nullptr) {
        throw InvalidInput(
            "the triangulation is fully distributed, so that no process knows the whole coarse "
            "mesh, which is not supported: take parallel::distributed::Triangulation");
    }
    if (parted_ && mapping != nullptr) {
        throw InvalidInput(
            "a mapping gives no positions of cells of other processes: over several processes the "
            "vertices of the triangulation must be where they belong");
    }
    if (const auto* q = dynamic_cast<const dealii::MappingQ<dim, spacedim>*>(mapping)) {
        mapping_degree_ = static_cast<int>(q->get_degree());
    } else if (const auto* fe = dynamic_cast<const dealii::MappingFE<dim, spacedim>*>(mapping)) {
        mapping_degree_ = static_cast<int>(fe->get_degree());
    }
    halving_ = &dyadic_rule(dim == 1   ? Shape::segment
                            : dim == 2 ? Shape::quadrilateral
                                       : Shape::hexahedron);
    update();
    auto& signals = triangulation.signals;
    const auto follow = [this] {
        stale_ = parted_;
        update();
    };
    changed_ = {signals.any_change.connect(follow),
                signals.post_distributed_refinement.connect(follow),
                signals.post_distributed_repartition.connect(follow),
                signals.post_distributed_load.connect(follow)};
}

template <int dim, int spacedim>
auto DealiiGrid<dim, spacedim>::coarse(std::size_t i) const -> CoarseElement<Element> {
    require_current();
    const Cell c = cell({0, int(i)});
    CoarseElement<Element> result{{0, int(i)}, shape(c), {}, {}, 1};
    for (unsigned k = 0; k < c->n_vertices(); ++k) {
        result.corners[k] = position(c, k);
        result.ids[k] = c->vertex_index(k);
    }
    const Point v = measure_vector(result.shape, result.corners);
    if (dim == spacedim && v[dim == 1 ? 0 : 2] < 0) result.orientation = -1;
    return result;
}

template <int dim, int spacedim>
void DealiiGrid<dim, spacedim>::new_positions(const Element& e, NodeMask which,
                                              std::span<Point> out) const {
    if (mapping_ != nullptr) {
        for_each_new_node(e, [&](std::size_t n, const Cell& child, unsigned corner) {
            if ((which >> n & 1U) != 0) out[n] = position(child, corner);
        });
        return;
    }
    // All indices before all positions: none waits for another one's way through memory.
    std::array<NodeKey, max_new_nodes> vertex;
    new_keys(e, vertex);
    const auto& position_of = triangulation_->get_vertices();
    for (std::size_t n = 0; which >> n != 0; ++n) {
        if ((which >> n & 1U) == 0) continue;
        out[n] = point(position_of[static_cast<std::size_t>(vertex[n])]);
    }
}

template <int dim, int spacedim>
const Rule* DealiiGrid<dim, spacedim>::other_split(const Cell& c) const {
    if (c->n_vertices() == unsigned{max_corners}) return halving_;
    if (only_simplex_rule_ != nullptr) return only_simplex_rule_;
    return simplex_rules_.find(shape(c), simplex_children(c));
}

template <int dim, int spacedim>
Shape DealiiGrid<dim, spacedim>::shape(const Cell& c) {
    for (int s = 0; s < shape_count; ++s) {  // numbers of corners tell them apart
        const Topology& t = topology(static_cast<Shape>(s));
        if (t.dimension == dim && t.corners == c->n_vertices()) return static_cast<Shape>(s);
    }
    throw GridError("a cell of the triangulation has an unknown shape");
}

template <int dim, int spacedim>
Point DealiiGrid<dim, spacedim>::position(const Cell& c, unsigned corner) const {
    dealii::Point<spacedim> x = c->vertex(corner);
    if (mapping_ != nullptr) {  // which may know leaves alone: child k has corner k
        Cell leaf = c;
        while (leaf->has_children()) leaf = leaf->child(corner);
        x = mapping_->get_vertices(leaf)[corner];
    }
    return point(x);
}

template <int dim, int spacedim>
void DealiiGrid<dim, spacedim>::map(const Element& leaf, std::span<const Point> reference,
                                    std::span<Point> out) const {
    std::vector<dealii::Point<dim>> points(reference.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (unsigned d = 0; d < dim; ++d) points[i][d] = reference[i][d];
    }
    const Cell c = cell(leaf);
    const dealii::FE_Nothing<dim, spacedim> nothing(c->reference_cell());
    dealii::FEValues<dim, spacedim> at(*mapping_, nothing, dealii::Quadrature<dim>(points),
                                       dealii::update_quadrature_points);
    at.reinit(c);
    for (unsigned i = 0; i < points.size(); ++i) out[i] = point(at.quadrature_point(i));
}

/// How the children of a simplex lie in it: every new vertex is the middle of an edge.
template <int dim, int spacedim>
std::vector<PlacedChild> DealiiGrid<dim, spacedim>::simplex_children(const Cell& c) const {
    const Topology& t = topology(shape(c));
    std::vector<std::pair<unsigned, Point>> places;
    for (unsigned k = 0; k < c->n_vertices(); ++k) {
        places.emplace_back(c->vertex_index(k), t.reference[k]);
    }
    if constexpr (dim > 1) {
        for (unsigned l = 0; l < c->n_lines(); ++l) {
            Point middle{0, 0, 0};
            for (unsigned k = 0; k < c->n_vertices(); ++k) {
                for (const unsigned end : {0U, 1U}) {
                    if (c->line(l)->vertex_index(end) != c->vertex_index(k)) continue;
                    middle = middle + 0.5 * t.reference[k];
                }
            }
            places.emplace_back(c->line(l)->child(0)->vertex_index(1), middle);
        }
    }
    std::vector<PlacedChild> children(c->n_children());
    for (unsigned i = 0; i < children.size(); ++i) {
        children[i].shape = shape(c);
        for (unsigned k = 0; k < c->n_vertices(); ++k) {
            const unsigned vertex = c->child(i)->vertex_index(k);
            for (const auto& [at, x] : places) {
                if (at == vertex) children[i].corners[k] = x;
            }
        }
    }
    return children;
}

/// Marks the vertices inside a line or face of a leaf, where it is refined on another side.
/// \param finest level around each vertex: where it tells that nothing is refined twice, the middle
///        of a line, and of a face whose lines are marked already, is all there is
template <int dim, int spacedim>
template <class Object>
void DealiiGrid<dim, spacedim>::mark(const Object& object, int level, bool lines_too,
                                     const std::vector<std::uint8_t>& finest) {
    constexpr bool is_line = Object::AccessorType::structure_dimension == 1;
    if constexpr (!is_line) {
        for (unsigned l = 0; lines_too && l < object->n_lines(); ++l) {
            mark(object->line(l), level, true, finest);
        }
    }
    if (!object->has_children()) return;
    if (is_line || object->n_vertices() == 4) {
        const unsigned middle = object->child(0)->vertex_index(is_line ? 1 : 3);
        std::atomic_ref(hangs_[middle / 64])
            .fetch_or(std::uint64_t{1} << middle % 64, std::memory_order_relaxed);
        if (finest[middle] <= level + 1) return;
    }
    for (unsigned i = 0; i < object->n_children(); ++i) {
        mark(object->child(i), level + 1, true, finest);
    }
}

/// Calls f(cell) for the cells of all levels: several threads of deal.II do.
template <int dim, int spacedim>
template <class Function>
void DealiiGrid<dim, spacedim>::for_each_cell(Function&& f) const {
    using Accessor = dealii::CellAccessor<dim, spacedim>;
    for (unsigned level = 0; level < triangulation_->n_levels(); ++level) {
        dealii::parallel::apply_to_subranges(
            0U, triangulation_->n_raw_cells(level),
            [&](unsigned first, unsigned last) {
                for (unsigned i = first; i < last; ++i) {
                    if (Accessor(triangulation_, int(level), int(i)).used()) {
                        f(cell({int(level), int(i)}));
                    }
                }
            },
            4096);
    }
}

/// What divides the cells that are not all cubes.
template <int dim, int spacedim>
void DealiiGrid<dim, spacedim>::find_rules() {
    only_simplex_rule_ = nullptr;
    for (const auto& c : triangulation_->cell_iterators()) {
        if (!c->has_children() || c->n_vertices() == unsigned{max_corners}) continue;
        only_simplex_rule_ = &simplex_rules_.add(shape(c), simplex_children(c));
    }
    if (simplex_rules_.size() > 1) only_simplex_rule_ = nullptr;
}

/// Finds which leaves below each cell this process owns. Others may be coarser here than there.
template <int dim, int spacedim>
void DealiiGrid<dim, spacedim>::find_presence() {
    presence_.resize(triangulation_->n_levels());
    for (unsigned level = triangulation_->n_levels(); level-- > 0;) {
        presence_[level].resize(triangulation_->n_raw_cells(level), Presence::elsewhere);
        for (const auto& c : triangulation_->cell_iterators_on_level(level)) {
            Presence& of_cell = presence_[level][static_cast<std::size_t>(c->index())];
            if (!c->has_children()) {
                of_cell = c->is_locally_owned() ? Presence::here : Presence::elsewhere;
                continue;
            }
            require_isotropic(c);
            unsigned here = 0;
            unsigned elsewhere = 0;
            for (unsigned k = 0; k < c->n_children(); ++k) {
                const Presence below = presence({c->level() + 1, c->child_index(k)});
                here += below == Presence::here ? 1 : 0;
                elsewhere += below == Presence::elsewhere ? 1 : 0;
            }
            const Presence first = presence({c->level() + 1, c->child_index(0)});
            of_cell = here == c->n_children()           ? Presence::here
                      : elsewhere == c->n_children()    ? Presence::elsewhere
                      : first <= Presence::partly_first ? Presence::partly_first
                                                        : Presence::partly;
        }
    }
}

template <int dim, int spacedim>
void DealiiGrid<dim, spacedim>::update() {
    // The counts tell an adapter that was made after a change from one that was made before.
    for (const std::size_t count :
         {std::size_t{triangulation_->n_cells()}, std::size_t{triangulation_->n_vertices()}}) {
        epoch_ = static_cast<std::uint64_t>(detail::mix(NodeKey{epoch_} + NodeKey{count} + 1U));
    }
    if (stale_) return;
    all_cubes_ = triangulation_->all_reference_cells_are_hyper_cube();
    if (!all_cubes_) find_rules();
    if (parted_) {
        find_presence();
    } else {
        find_hanging();
    }
}

template <int dim, int spacedim>
void DealiiGrid<dim, spacedim>::require_isotropic(const Cell& c) {
    if (c->n_vertices() != unsigned{max_corners} || c->n_children() == unsigned{max_children}) {
        return;
    }
    throw InvalidInput("cell " + c->id().to_string() + " is refined in some directions only");
}

/// Finds the vertices that hang.
template <int dim, int spacedim>
void DealiiGrid<dim, spacedim>::find_hanging() {
    const auto corners_of = [&](const Cell& c) {
        return all_cubes_ ? unsigned{max_corners} : c->n_vertices();
    };
    hangs_.assign(triangulation_->n_vertices() / 64 + 1, 0);
    std::vector<std::uint8_t> finest(triangulation_->n_vertices(), 0);  // level around a vertex
    for_each_cell([&](const Cell& c) {
        if (!c->has_children()) {
            const auto level = static_cast<std::uint8_t>(c->level());
            for (unsigned k = 0; k < corners_of(c); ++k) {
                const std::atomic_ref at(finest[c->vertex_index(k)]);
                std::uint8_t known = at.load(std::memory_order_relaxed);
                while (known < level &&
                       !at.compare_exchange_weak(known, level, std::memory_order_relaxed)) {
                }
            }
        } else {
            require_isotropic(c);
        }
    });
    if constexpr (dim > 1) {
        // Corners of the lines and faces of a cube, one bit each.
        using Cube = dealii::GeometryInfo<dim>;
        std::array<unsigned, Cube::lines_per_cell> line{};
        std::array<unsigned, Cube::faces_per_cell> face{};
        for (unsigned l = 0; l < line.size(); ++l) {
            line[l] =
                1U << Cube::line_to_cell_vertices(l, 0) | 1U << Cube::line_to_cell_vertices(l, 1);
        }
        for (unsigned f = 0; f < face.size(); ++f) {
            for (unsigned k = 0; k < Cube::vertices_per_face; ++k) {
                face[f] |= 1U << Cube::face_to_cell_vertices(f, k);
            }
        }
        for_each_cell([&](const Cell& c) {
            if (c->has_children()) return;
            // Where an edge or a face is refined on another side, so are cells at all its corners.
            unsigned finer = 0;
            for (unsigned k = 0; k < corners_of(c); ++k) {
                finer |= unsigned{finest[c->vertex_index(k)] > c->level()} << k;
            }
            if (std::popcount(finer) < 2) return;
            const bool simplex = corners_of(c) != unsigned{max_corners};
            const auto may_be_refined = [&](unsigned corners) {
                return simplex || (finer & corners) == corners;
            };
            const unsigned lines = simplex ? c->n_lines() : unsigned{Cube::lines_per_cell};
            for (unsigned l = 0; l < lines; ++l) {
                if (may_be_refined(line[l])) mark(c->line(l), c->level(), true, finest);
            }
            if constexpr (dim > 2) {
                const unsigned faces = simplex ? c->n_faces() : unsigned{Cube::faces_per_cell};
                for (unsigned f = 0; f < faces; ++f) {
                    if (may_be_refined(face[f])) mark(c->face(f), c->level(), false, finest);
                }
            }
        });
    }
}

}  // namespace nestgrid
