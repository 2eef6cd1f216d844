// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws level sets in a traversal of a hierarchy. isosurface.hpp states the properties of the
// result.
#pragma once

#include <memory>
#include <vector>

#include <drawing/drawing.hpp>
#include <level_sets/aside_contour.hpp>
#include <level_sets/hidden_neighbours.hpp>
#include <level_sets/normals.hpp>
#include <level_sets/patch_level_set.hpp>
#include <nestgrid/algorithms/ranks.hpp>

namespace nestgrid::engine {

/// Draws several levels in one traversal; each has a builder of its own.
template <int dimension, class Real>
class LevelSet final : public Drawing<Real>, private PatchCounts {
public:
    using Base = Drawing<Real>;
    using View = ElementView<Real>;
    using Builder = SurfaceBuilder<dimension>;
    /// What the walk must carry.
    static constexpr Needs needs{
        .values = true, .keys = true, .positions = true, .closed = true, .on_ranks = true};

    /// All arguments are borrowed but the builders, which are copied, one for each level.
    /// \param first_attribute the first of the components that vertices carry
    LevelSet(const Walk<Real>& walk, const LevelSearch<Real>& search,
             std::span<const Builder> builders, const IsosurfaceOptions& options,
             std::size_t first_attribute);

    /// Promises that begin() is not called again: memory is freed as soon as nothing needs it.
    void draw_once() { keeps_memory_ = false; }
    /// Begins anew with other levels, as many as before, and keeps its memory.
    void begin(const LevelSearch<Real>& search, std::span<const Builder> builders);
    void run(const Executor& executor) override;
    void flush() override;
    void agree(Ranks& ranks) override;
    void count_only(std::uint64_t most) override;
    /// Sets counts, error bound and memory in the result of level i.
    void report(std::size_t i, Isosurface<dimension>& result) const;

    // Answers to the walk (visitor.hpp, frontier.hpp).
    Decision inspect(const View& view, const Split& split) override;
    void extract(const View& view) override;
    Leaves leaves(const Rule& rule, const Real* values, NodeMask which, bool closed) override;
    /// Hidden elements are walked to record what they would draw on faces around them, and to draw
    /// caps on those faces which they divide more finely than the leaf that is shown.
    bool sees_hidden() const override { return records_ || neighbours_.hidden_elements_draw(); }
    bool takes(const View& view) override;
    Decision look(const View& view, const Split& split) override;
    void walk_below(const Walk<Real>& walk, const View& view) override;

private:
    using Base::counted_;
    using Base::counts_;
    using Base::shared;
    using Base::tally_;
    using Base::walk_;

    std::unique_ptr<Base> begin_part(std::unique_ptr<Base> used) override;
    void join(const LevelSet& leader);
    void add(Base& part) override;
    void add_part(std::size_t level, const LevelSet& drawn);
    std::size_t table_bytes() const;
    void walk_alone() override;
    bool knows_by_names(DrawnSurface<dimension>& surface) const;
    void extract(std::size_t level, const View& view, unsigned inside, unsigned boundary,
                 bool draws);
    void draw(std::size_t level, unsigned inside, unsigned boundary);
    void draw_beside_finer(std::size_t level, unsigned inside, unsigned boundary, bool draws);
    const Contour* plain_contour(unsigned inside, unsigned boundary);
    unsigned boundary_of(const DrawnSurface<dimension>& surface, const View& view) const;
    void end_element(DrawnSurface<dimension>& surface);
    void find_hidden_faces();
    unsigned capped_faces(const View& view);
    bool may_cap_below(const View& view);
    bool stops_above_cap(const View& view);
    void load(const View& view, bool draws);
    unsigned boundary_in_slice(const View& view, const Level<Real>& level) const;
    bool draws_plainly() const;
    bool suits_patches() const;
    bool cuts_finest() const;
    bool bisects_slices() const;
    bool is_near_boundary(const View& view) const;
    // Of PatchCounts.
    void tick(std::uint64_t calls, std::uint64_t visited) override { Base::tell(calls, visited); }
    void add(std::uint64_t calls, std::uint64_t visited) override { Base::count(calls, visited); }

    /// The element at hand.
    struct AtHand {
        ElementCuts<Real> cuts;
        ElementContour<dimension, Real> contour;
        CapContour<dimension, Real> cap;
        AsideContour<dimension, Real> aside;
        CriterionQuestion question;
        Real bound = 0;             // how far U may leave the range of its corners
        double position_bound = 0;  // how far true positions may be from the mapped ones, below it
        bool loaded = false;
        bool loads_keys = false;
        bool plainly = false;  // options ask for nothing but what draw_plainly() draws

        AtHand(const Walk<Real>& walk, std::size_t first_attribute, SimplexTally& tally,
               const IsosurfaceOptions& options)
            : cuts(walk, first_attribute),
              contour(cuts, tally, options),
              cap(cuts, contour),
              aside(cuts, contour, cap, tally, options) {}
    };

    const LevelSearch<Real>* search_;
    const IsosurfaceOptions* options_;
    std::size_t first_attribute_;
    std::vector<SurfacePart<dimension>> parts_;      // of a task: what its surfaces are drawn into
    std::vector<DrawnSurface<dimension>> surfaces_;  // one a level
    std::vector<Transitions<Real>> transitions_;     // one a level
    bool records_ = false;                           // elements may stop beside finer ones
    int finest_level_ = -1;              // a level on which no element has a finer neighbour, or -1
    HiddenNeighbours<Real> neighbours_;  // where caps are drawn beside hidden elements
    Normals<Real> normals_;
    AtHand at_hand_;
    int deepest_ = 0;
    std::size_t freed_bytes_ = 0;  // of tables, when all of them were there
    bool keeps_memory_ = true;
    bool bisects_ = false;  // takes() walks bisections in patches
    bool finest_ = false;   // edges are cut on their finest pieces
};

}  // namespace nestgrid::engine
