// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The walk over bisections known at compile time (bisection_walk.hpp) with virtual functions
// between grid and visitor: one call decides about an element or about parts of eight patches, and
// one call hands over a batch with all that the visitor needs to extract from it.
#pragma once

#include <cstring>

#include <nestgrid/detail/operations.hpp>
#include <nestgrid/hierarchy.hpp>
#include <patches/bisection_walk.hpp>
#include <patches/edge_pieces.hpp>
#include <patches/mean_values.hpp>

namespace nestgrid::engine {

/// A PatchBatch of any grid whose patches are maubach_patch<dim>. Members have the names and
/// meanings that they have there.
template <int dim, class Real>
class ErasedPatches {
public:
    static constexpr const auto& pattern = maubach_patch<dim>;

    virtual Point position(std::size_t place) const = 0;
    virtual void cuts(std::span<const BatchEdge> edges, const CutLevel& cut,
                      WidePoint* to) const = 0;
    /// Sets to[i] to a piece of edges[i] (edge_pieces.hpp), not in a walk over MeanValues.
    virtual void pieces(std::span<const BatchEdge> edges, const PieceQuestion& question,
                        EdgePiece* to) const = 0;
    /// Sets to[i] to what a vertex at places[i] carries, in a walk over MeanValues.
    virtual void carried(std::span<const std::uint16_t> places, double* to) const = 0;
    virtual Handle element(std::size_t id, std::size_t part) const = 0;
    virtual unsigned boundary(std::size_t id, std::size_t part) const = 0;

    bool mirrored(std::size_t id) const { return orientations[id] != 0; }

    const int level;
    const std::size_t element_count;

    /// Rows of one kind of numbers.
    template <class T>
    struct Rows {
        const T* all;

        const T* operator[](std::size_t row) const { return all + row * most_patches; }
    };
    const Rows<NodeKey> keys;
    const Rows<Real> values;
    const Rows<SubtreeNode> in_subtree;
    const std::uint8_t* const orientations;
    const Real* const greatest_bounds;
    const std::uint8_t* const ends;
    const std::uint8_t* const undivided;
    const MaskOf<Real>* const stops;
    const std::uint16_t* const element_levels;
    const Rows<Real> bounds;

protected:
    template <class Batch>
    explicit ErasedPatches(const Batch& batch)
        : level{batch.level},
          element_count{batch.element_count},
          keys{batch.keys[0]},
          values{batch.values[0]},
          in_subtree{batch.in_subtree[0]},
          orientations{batch.orientations.data()},
          greatest_bounds{batch.greatest_bounds.data()},
          ends{batch.ends.data()},
          undivided{batch.undivided.data()},
          stops{batch.stops.data()},
          element_levels{batch.element_levels.data()},
          bounds{batch.bounds[0].data()} {}
    ~ErasedPatches() = default;
};

/// A visitor of BisectionWalk and PatchWalk with virtual functions, and the begin of its walk.
template <int dim, class Real>
class ErasedBisectionVisitor : public detail::PatchVisitor {
public:
    struct Start {
        const Real* values;  ///< at the corners of the element, borrowed
        int level;
        int orientation;
        /// Means at new nodes that are within it of 0 become 0; negative where values are the
        /// field's.
        double tolerance = -1;
    };
    struct Glance {
        Visit visit;
        Real bound;
    };

    const Start& start() const { return start_; }

    virtual Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level,
                          bool outside) = 0;
    virtual bool glance_at_leaf(Real lo, Real hi) = 0;
    virtual void tick(std::uint64_t looked_at, std::uint64_t visited) = 0;
    /// Takes the counts of the whole walk, at its end.
    virtual void end(std::uint64_t looked_at, std::uint64_t visited) = 0;
    // The parts of maubach_patch<dim>: inner ones, and ends.
    virtual PackedSight<Real> see_within(const PackedPatches<Real>& patches) = 0;
    virtual PackedSight<Real> see_ends(const PackedPatches<Real>& patches) = 0;
    virtual void prefetch(const NodeKey* nodes, std::size_t rows) const = 0;
    virtual bool names_edges() const = 0;
    virtual void begin_subtrees(std::uint32_t numbers) = 0;
    virtual unsigned extract(const ErasedPatches<dim, Real>& patches,
                             const BatchSelection& selection) = 0;

protected:
    explicit ErasedBisectionVisitor(const Start& start)
        : detail::PatchVisitor(start.tolerance >= 0), start_{start} {}
    ~ErasedBisectionVisitor() = default;

private:
    Start start_;
};

/// A visitor for BisectionWalk that forwards all calls to an ErasedBisectionVisitor.
template <HasMaubachPatches Grid, class Field>
class BisectionForwarder {
    static constexpr int dim = Grid::dimension;
    using Real = typename Field::value_type;

public:
    BisectionForwarder(const Field& field, ErasedBisectionVisitor<dim, Real>& to)
        : field_{&field}, to_{&to} {}

    auto glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside) {
        return to_->glance(lo, hi, rule, node, level, outside);
    }
    bool glance_at_leaf(Real lo, Real hi) { return to_->glance_at_leaf(lo, hi); }
    void tick(std::uint64_t looked_at, std::uint64_t visited) { to_->tick(looked_at, visited); }
    bool names_edges() const { return to_->names_edges(); }
    void begin_subtrees(std::uint32_t numbers) { to_->begin_subtrees(numbers); }
    template <PatchParts which>
    PackedSight<Real> see(const PackedPatches<Real>& patches) {
        return which == PatchParts::ends ? to_->see_ends(patches) : to_->see_within(patches);
    }
    void prefetch(const NodeKey* nodes, std::size_t rows) const { to_->prefetch(nodes, rows); }
    template <class Batch>
    unsigned extract(const Batch& batch, const BatchSelection& selection) {
        return to_->extract(Patches<Batch>(batch, *field_), selection);
    }

private:
    template <class Batch>
    struct Patches final : ErasedPatches<dim, Real> {
        Patches(const Batch& batch, const Field& on)
            : ErasedPatches<dim, Real>(batch), of{&batch}, field{&on} {}

        Point position(std::size_t place) const override { return of->position(place); }
        void cuts(std::span<const BatchEdge> edges, const CutLevel& cut,
                  WidePoint* to) const override {
            of->cuts(edges, cut, to);
        }
        void pieces(std::span<const BatchEdge> edges, const PieceQuestion& question,
                    EdgePiece* to) const override {
            if constexpr (!GivesMeans<Field>) find_pieces(*of, *field, edges, question, to);
        }
        void carried(std::span<const std::uint16_t> places, double* to) const override {
            if constexpr (GivesMeans<Field>) {
                constexpr std::size_t at_once = 128;
                std::array<typename Grid::Node, at_once> some;
                std::array<NodeKey, at_once> names;
                for (; !places.empty(); places = places.subspan(std::min(places.size(), at_once))) {
                    const std::size_t count = std::min(places.size(), at_once);
                    for (std::size_t i = 0; i < count; ++i) {
                        some[i] = of->nodes.all[places[i]];
                        names[i] = of->keys.all[places[i]];
                    }
                    field->carried().values_at(std::span(some).first(count),
                                               std::span(names).first(count), {to, count});
                    to += count;
                }
            }
        }
        Handle element(std::size_t id, std::size_t part) const override {
            Handle handle;
            detail::set_handle(handle, of->element(id, part));
            return handle;
        }
        unsigned boundary(std::size_t id, std::size_t part) const override {
            return of->boundary(id, part);
        }

        const Batch* of;
        const Field* field;
    };

    const Field* field_;
    ErasedBisectionVisitor<dim, Real>* to_;
};

/// Walks the bisections below an element, and tells the visitor the counts of the walk at its end.
template <class Grid, class Field, class Real>
void walk_for(ErasedBisectionVisitor<Grid::dimension, Real>& visitor, const Grid& grid,
              const Field& field, const ElementOf<Grid>& e) {
    BisectionForwarder<Grid, Field> forward(field, visitor);
    const auto& start = visitor.start();
    walk_bisections(grid, field, forward, e, start.values, start.level, start.orientation,
                    [&](const auto& walk) { visitor.end(walk.looked_at(), walk.visited()); });
}

/// Hierarchy::bisect() of a grid and a field with known bisections: with the values of the field
/// or, for a visitor that takes means, with those of a function of position.
template <class Grid, class Field>
void bisect_for(detail::PatchVisitor& visitor, const Grid& grid, const Field& field,
                const ElementOf<Grid>& e) {
    using Real = typename Field::value_type;
    // Rows of floats are widened before (position_functions.hpp).
    constexpr bool as_doubles = !AnswersInRows<Grid> || std::is_same_v<Real, double>;
    if constexpr (Grid::dimension == 3 && as_doubles) {
        if (visitor.takes_means()) {
            auto& to = static_cast<ErasedBisectionVisitor<3, double>&>(visitor);
            const CarriedField<Grid, Field> carried(field);
            return walk_for(to, grid, MeanValues<Grid>(to.start().tolerance, carried), e);
        }
    }
    walk_for(static_cast<ErasedBisectionVisitor<Grid::dimension, Real>&>(visitor), grid, field, e);
}

}  // namespace nestgrid::engine
