// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Walks over bisections known at compile time (bisection_walk.hpp) with grid and visitor on either
// side of a table: one call for an element that is looked at, or for eight, and one that
// hands over all there is to know of what is to be extracted.
#pragma once

#include <cstring>

#include <nestgrid/nestgrid.h>
#include <nestgrid/bisection_walk.hpp>
#include <nestgrid/operations.hpp>

namespace nestgrid::detail {

/// A BlockBatch of maubach_block.
template <int dim, class Real>
class ErasedBlocks {
public:
    static constexpr const auto& pattern = maubach_block<dim>;

    virtual Point position(std::size_t b, std::size_t node) const = 0;
    virtual void all_positions(std::size_t b, std::array<WidePoint, pattern.nodes>& x) const = 0;
    virtual void corner_positions(std::size_t b, std::size_t part,
                                  std::array<WidePoint, pattern.corners>& x) const = 0;
    virtual nestgrid_element element(std::size_t b, std::size_t part) const = 0;
    virtual unsigned boundary(std::size_t b, std::size_t part) const = 0;

    NodeKey key(std::size_t b, std::size_t node) const { return keys_[room_ * node + b]; }
    Real value(std::size_t b, std::size_t node) const { return values_[room_ * node + b]; }
    const Real* row(std::size_t node) const { return values_ + room_ * node; }
    SubtreeFaces faces(std::size_t b, std::size_t node) const { return sides_[room_ * node + b]; }
    bool mirrored(std::size_t b) const { return orientations_[b] != 0; }

    const int level;

protected:
    template <class Batch>
    explicit ErasedBlocks(const Batch& batch)
        : level{batch.level},
          room_{Batch::room},
          keys_{batch.keys[0].data()},
          values_{batch.values[0].data()},
          sides_{batch.sides[0].data()},
          orientations_{batch.orientations.data()} {}
    ~ErasedBlocks() = default;

private:
    std::size_t room_;
    const NodeKey* keys_;
    const Real* values_;
    const SubtreeFaces* sides_;
    const std::uint8_t* orientations_;
};

template <int dim, class Real>
class ErasedBisectionVisitor {
public:
    struct Glance {
        Visit visit;
        Real bound;
    };

    virtual Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level,
                          bool outside) = 0;
    virtual bool glance_at_leaf(Real lo, Real hi) = 0;
    virtual void tick(std::uint64_t looked_at, std::uint64_t visited) = 0;
    virtual void end(std::uint64_t looked_at, std::uint64_t visited) = 0;
    virtual PackedGlance<Real> glance(const PackedElements<Real>& e) = 0;
    virtual void expect(const NodeKey* nodes) const = 0;
    virtual void begin_subtrees() = 0;
    virtual bool extract_part(const ErasedBlocks<dim, Real>& blocks, std::size_t b,
                              std::size_t part, Real bound) = 0;
    virtual unsigned extract_blocks(const ErasedBlocks<dim, Real>& blocks, std::size_t first,
                                    std::size_t end, const std::uint8_t* entered) = 0;

protected:
    ErasedBisectionVisitor() = default;
    ~ErasedBisectionVisitor() = default;
};

template <class Element>
nestgrid_element erased(const Element& element) {
    nestgrid_element result{};
    std::memcpy(&result, &element, sizeof(element));
    return result;
}

/// The grid's side.
template <HasMaubachBlocks Grid, class Real>
class BisectionForwarder {
    static constexpr int dim = Grid::dimension;

public:
    BisectionForwarder(const Grid& grid, ErasedBisectionVisitor<dim, Real>& to)
        : grid_{&grid}, to_{&to} {}

    auto glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside) {
        return to_->glance(lo, hi, rule, node, level, outside);
    }
    bool glance_at_leaf(Real lo, Real hi) { return to_->glance_at_leaf(lo, hi); }
    void tick(std::uint64_t looked_at, std::uint64_t visited) { to_->tick(looked_at, visited); }
    void begin_subtrees() { to_->begin_subtrees(); }
    PackedGlance<Real> glance(const PackedElements<Real>& e) { return to_->glance(e); }
    void expect(const NodeKey* nodes) const { to_->expect(nodes); }
    template <class Batch>
    bool extract_part(const Batch& batch, std::size_t b, std::size_t part, Real bound) {
        return to_->extract_part(Blocks<Batch>(batch), b, part, bound);
    }
    template <class Batch>
    unsigned extract_blocks(const Batch& batch, std::size_t first, std::size_t end,
                            const std::uint8_t* entered) {
        return to_->extract_blocks(Blocks<Batch>(batch), first, end, entered);
    }

private:
    template <class Batch>
    struct Blocks final : ErasedBlocks<dim, Real> {
        explicit Blocks(const Batch& batch) : ErasedBlocks<dim, Real>(batch), of{&batch} {}

        Point position(std::size_t b, std::size_t node) const override {
            return of->position(b, node);
        }
        void all_positions(std::size_t b,
                           std::array<WidePoint, Batch::pattern.nodes>& x) const override {
            of->all_positions(b, x);
        }
        void corner_positions(std::size_t b, std::size_t part,
                              std::array<WidePoint, Batch::pattern.corners>& x) const override {
            of->corner_positions(b, part, x);
        }
        nestgrid_element element(std::size_t b, std::size_t part) const override {
            return erased(of->element(b, part));
        }
        unsigned boundary(std::size_t b, std::size_t part) const override {
            return of->boundary(b, part);
        }

        const Batch* of;
    };

    const Grid* grid_;
    ErasedBisectionVisitor<dim, Real>* to_;
};

}  // namespace nestgrid::detail
