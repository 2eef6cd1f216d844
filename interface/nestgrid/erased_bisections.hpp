// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Walks over bisections known at compile time (bisection_walk.hpp) with grid and visitor on either
// side of a table: one call for an element that is looked at, or for all those within a block, and
// one that hands over all there is to know of what is to be extracted.
#pragma once

#include <cstring>

#include <nestgrid/nestgrid.h>
#include <nestgrid/bisection_walk.hpp>
#include <nestgrid/operations.hpp>

namespace nestgrid::detail {

/// A BisectedBlock of maubach_block.
template <int dim, class Real>
class ErasedBlock {
public:
    static constexpr const auto& pattern = maubach_block<dim>;

    virtual Point position(std::size_t i) const = 0;
    virtual void all_positions(std::array<Point, pattern.nodes>& x) const = 0;
    virtual nestgrid_element element(std::size_t part) const = 0;
    virtual unsigned boundary(std::size_t part) const = 0;

    const std::array<NodeKey, pattern.nodes>& key;
    const std::array<Real, pattern.nodes>& value;
    const std::array<SubtreeFaces, pattern.nodes>& faces;
    const int level;
    const int orientation;

protected:
    template <class Block>
    explicit ErasedBlock(const Block& block)
        : key{block.key},
          value{block.value},
          faces{block.faces},
          level{block.level},
          orientation{block.orientation} {}
    ~ErasedBlock() = default;
};

template <int dim, class Real>
class ErasedBisectionVisitor {
public:
    static constexpr std::size_t interior = maubach_block<dim>.ends - 2;
    struct Glance {
        Visit visit;
        Real bound;
    };

    virtual Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level,
                          bool outside) = 0;
    virtual bool glance_at_leaf(Real lo, Real hi) = 0;
    virtual void tick(std::uint64_t looked_at, std::uint64_t visited) = 0;
    virtual void end(std::uint64_t looked_at, std::uint64_t visited) = 0;
    virtual BlockGlance<Real, interior> glance_within(
        const BlockInterior<Real, interior>& elements) = 0;
    virtual void begin_subtree() = 0;
    virtual void extract_part(const ErasedBlock<dim, Real>& block, std::size_t part,
                              Real bound) = 0;
    virtual unsigned extract_block(const ErasedBlock<dim, Real>& block, unsigned entered) = 0;

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
    void begin_subtree() { to_->begin_subtree(); }

    template <std::size_t count>
    auto glance_within(const BlockInterior<Real, count>& elements) {
        return to_->glance_within(elements);
    }
    void extract_part(const BisectedBlock<Grid, Real>& block, std::size_t part, Real bound) {
        to_->extract_part(Block(block), part, bound);
    }
    unsigned extract_block(const BisectedBlock<Grid, Real>& block, unsigned entered) {
        return to_->extract_block(Block(block), entered);
    }

private:
    struct Block final : ErasedBlock<dim, Real> {
        using Original = BisectedBlock<Grid, Real>;
        explicit Block(const Original& block) : ErasedBlock<dim, Real>(block), of{&block} {}

        Point position(std::size_t i) const override { return of->position(i); }
        void all_positions(std::array<Point, Original::pattern.nodes>& x) const override {
            of->all_positions(x);
        }
        nestgrid_element element(std::size_t part) const override {
            return erased(of->element(part));
        }
        unsigned boundary(std::size_t part) const override { return of->boundary(part); }

        const Original* of;
    };

    const Grid* grid_;
    ErasedBisectionVisitor<dim, Real>* to_;
};

}  // namespace nestgrid::detail
