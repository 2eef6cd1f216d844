// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/level_set.hpp>

#include <algorithm>
#include <bit>
#include <limits>

#include <level_sets/element_contour_steps.hpp>
#include <level_sets/error_bound.hpp>
#include <level_sets/level_search_steps.hpp>
#include <ranks/agreement.hpp>
#include <walk/unusable_values.hpp>
#include <walk/walk_steps.hpp>

namespace nestgrid::engine {

namespace {

/// std::popcount without the call that it is on processors that may lack the instruction.
constexpr std::uint64_t count_ones(std::uint64_t x) {
#if defined(__POPCNT__)
    return static_cast<std::uint64_t>(std::popcount(x));
#else
    x -= x >> 1U & 0x5555555555555555U;
    x = (x & 0x3333333333333333U) + (x >> 2U & 0x3333333333333333U);
    return ((x + (x >> 4U)) & 0x0F0F0F0F0F0F0F0FU) * 0x0101010101010101U >> 56U;
#endif
}

unsigned all_corners(std::size_t corners) { return (1U << corners) - 1; }

/// The faces whose corners are all among some, one bit each.
unsigned faces_among(const Topology& t, unsigned corners) {
    unsigned faces = 0;
    for (std::size_t f = 0; f < t.faces; ++f) {
        faces |= unsigned{signs_of(t.face[f], ~corners) == 0} << f;
    }
    return faces;
}

}  // namespace

template <int dimension, class Real>
LevelSet<dimension, Real>::LevelSet(const Walk<Real>& walk, const LevelSearch<Real>& search,
                                    std::span<const Builder> builders,
                                    const IsosurfaceOptions& options, std::size_t first_attribute)
    : Base(walk, options.progress),
      search_{&search},
      options_{&options},
      first_attribute_{first_attribute},
      transitions_(builders.size()),
      normals_{walk},
      at_hand_{walk, first_attribute, tally_, options} {
    const std::size_t keys = walk.hierarchy().facts().node_count;
    for (const Builder& builder : builders) surfaces_.emplace_back(builder, keys);
    for (Transitions<Real>& t : transitions_) {
        t.record.begin(at_hand_.cuts.attribute_count(), walk.hierarchy().make_elements());
        t.record.share(walk.hierarchy().facts().shared);
        t.asides.begin(walk.components(), walk.hierarchy().make_elements());
    }
    begin(search, builders);
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::begin(const LevelSearch<Real>& search,
                                      std::span<const Builder> builders) {
    search_ = &search;
    this->restart();
    tally_ = SimplexTally();
    deepest_ = 0;
    records_ = dimension == 3 && search.may_stop_apart();
    finest_level_ = records_ ? search.bounds().finest_level() : -1;
    at_hand_.plainly = draws_plainly();
    const bool suits = walk_->function_count() > 0 ? bisects_slices() : suits_patches();
    bisects_ = suits && search.fits_patches() && !records_ && !surfaces_.empty();
    finest_ = cuts_finest();
    at_hand_.cuts.set_finest(finest_);
    normals_.begin(false);
    VertexNormals normals;
    normals.with_vertices = options_->normals && bisects_;
    if (options_->normals && !bisects_) normals.gradients = &normals_.sums();
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        surfaces_[i].begin(builders[i], normals, options_->verify);
        if (shared() != nullptr) surfaces_[i].keep_names(shared()->ranks().rank());
        transitions_[i].record.clear();
        transitions_[i].record.know_by_names(knows_by_names(surfaces_[i]));
        transitions_[i].asides.clear();
    }
    at_hand_.loads_keys = records_ || options_->normals || options_->cap || options_->at_nodes ||
                          (!surfaces_.empty() && surfaces_[0].names_vertices());
}

/// Whether vertices on closed faces are known by names: where the surface does not number them, or
/// may not have them because hidden elements or other ranks record them, and where gaps need
/// attributes that a sink has taken.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::knows_by_names(DrawnSurface<dimension>& surface) const {
    const bool on_several_ranks = shared() != nullptr && shared()->count() > 0;
    return !surface.names_vertices() || on_several_ranks ||
           walk_->hierarchy().offers(Feature::hidden) ||
           (at_hand_.cuts.attribute_count() > 0 && !surface.builder().keeps_attributes());
}

/// Makes a task do as `leader` does.
template <int dimension, class Real>
void LevelSet<dimension, Real>::join(const LevelSet& leader) {
    normals_.begin(options_->normals);
    tally_ = SimplexTally(leader.tally_.limit());
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        surfaces_[i].leave_normals();
        if (leader.surfaces_[i].counts_only()) surfaces_[i].count_only();
        transitions_[i].record.know_by_names(leader.transitions_[i].record.by_names());
    }
    neighbours_ = leader.neighbours_;
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::count_only(std::uint64_t most) {
    Base::count_only(most);
    for (DrawnSurface<dimension>& surface : surfaces_) surface.count_only();
    for (Transitions<Real>& t : transitions_) t.record.know_by_names(true);
}

/// Whether the options ask for vertices, triangles and perhaps attributes, normals and bounds
/// alone.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::draws_plainly() const {
    return !options_->cap && !options_->reference;
}

/// Whether patches can draw what the options ask for.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::suits_patches() const {
    const HierarchyFacts& facts = walk_->hierarchy().facts();
    return facts.knows_patches && at_hand_.plainly && at_hand_.cuts.attribute_count() == 0 &&
           !options_->at_nodes && options_->position_bounds == nullptr &&
           (!options_->normals || facts.gradients_at_nodes);
}

/// Whether edges are cut on their finest pieces, which needs elements that stop to conform: else an
/// element beside finer ones would cut an edge at another place than these do.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::cuts_finest() const {
    if (options_->cuts != Cuts::finest || options_->at_nodes || search_->may_stop_apart()) {
        return false;
    }
    return std::ranges::none_of(search_->levels(),
                                [&](const Level<Real>& level) { return search_->is_slice(level); });
}

/// Whether slices by one affine function, and nothing else, are drawn, of a grid that bisects the
/// function itself.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::bisects_slices() const {
    if (!walk_->hierarchy().facts().bisects_means || !walk_->functions()->affine()) return false;
    const bool slices_only = std::ranges::all_of(
        search_->levels(), [&](const Level<Real>& level) { return search_->is_slice(level); });
    return slices_only && !options_->cap && !options_->normals && !options_->reference &&
           options_->position_bounds == nullptr;
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::run(const Executor& executor) {
    const SharedNodes* const ranks = shared();
    const auto alone = [&](const auto& part) {
        together(ranks, "isosurfaces",
                 [&] { with_places(walk_->hierarchy(), part, walk_->function_count()); });
    };
    alone([&] {
        find_hidden_faces();
        Base::walk_elements(executor);
    });
    for (Transitions<Real>& t : transitions_) {
        if (records_ && ranks != nullptr) t.record.exchange();
    }
    alone([&] {
        tally_.begin_later();
        for (std::size_t i = 0; i < surfaces_.size(); ++i) {
            if (records_) {
                at_hand_.cuts.set_level(search_->levels()[i]);
                at_hand_.aside.draw(surfaces_[i], transitions_[i]);
            }
            surfaces_[i].builder().flush();
        }
    });
    if (options_->normals && ranks != nullptr) normals_.add_across();
    for (DrawnSurface<dimension>& surface : surfaces_) {
        surface.finish(options_->at_nodes && !surface.counts_only(), ranks);
    }
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::agree(Ranks& ranks) {
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        // What a criterion promises it knows of the nodes of this rank.
        surfaces_[i].raise_leaf_error(search_->surface_error(search_->levels()[i]));
        surfaces_[i].agree(ranks);
    }
    Base::agree(ranks);
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::walk_alone() {
    walk_->run_as(*this);
}

template <int dimension, class Real>
auto LevelSet<dimension, Real>::begin_part(std::unique_ptr<Base> used) -> std::unique_ptr<Base> {
    std::unique_ptr<LevelSet> part(static_cast<LevelSet*>(used.release()));
    std::vector<SurfacePart<dimension>> parts(surfaces_.size());
    if (part) {
        parts = std::move(part->parts_);
    } else {
        for (auto& p : parts) p.surface.elements = walk_->hierarchy().make_elements();
    }
    std::vector<Builder> builders;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        const Builder& builder = surfaces_[i].builder();
        builders.emplace_back(parts[i], builder.shares_vertices(), builder.keeps_elements());
        builders.back().clear();
    }
    if (part) {
        part->begin(*search_, builders);
    } else {
        part = std::make_unique<LevelSet>(*walk_, *search_, builders, *options_, first_attribute_);
    }
    part->parts_ = std::move(parts);
    part->join(*this);
    return part;
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::add(Base& part) {
    const auto& drawn = static_cast<const LevelSet&>(part);
    deepest_ = std::max(deepest_, drawn.deepest_);
    tally_.add(drawn.tally_);
    normals_.append(drawn.normals_);
    for (std::size_t i = 0; i < surfaces_.size(); ++i) add_part(i, drawn);
}

/// Adds the part of one level.
template <int dimension, class Real>
void LevelSet<dimension, Real>::add_part(std::size_t level, const LevelSet& drawn) {
    DrawnSurface<dimension>& surface = surfaces_[level];
    const DrawnSurface<dimension>& more = drawn.surfaces_[level];
    surface.add_report(more);
    std::vector<std::uint32_t> numbers;
    if (!surface.counts_only()) numbers = surface.add_part(drawn.parts_[level], &more);
    if (records_) {
        Transitions<Real>& to = transitions_[level];
        const Transitions<Real>& from = drawn.transitions_[level];
        numbers = to.record.append(from.record, std::move(numbers));
        to.asides.append(from.asides, numbers);
    }
    if (!surface.counts_only()) surface.builder().flush_if_full();
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::walk_below(const Walk<Real>& walk, const View& view) {
    walk.walk_below_as(view, *this);
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::flush() {
    for (DrawnSurface<dimension>& surface : surfaces_) surface.builder().flush();
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::report(std::size_t i, Isosurface<dimension>& result) const {
    result.counts = counts_;
    result.counts.extracted = surfaces_[i].extracted();
    result.counts.limited = surfaces_[i].limited();
    result.range_bound = range_bound(search_->levels()[i], *search_);
    const double off_level = surfaces_[i].off_level();
    result.surface_error = off_level > 0 ? std::numeric_limits<double>::infinity()
                                         : std::max(surfaces_[i].leaf_error(),
                                                    search_->surface_error(search_->levels()[i]));
    result.error_bound = std::min(
        {surfaces_[i].error_bound() + off_level, result.range_bound, result.surface_error});
    result.position_bound = surfaces_[i].position_bound();
    if (surfaces_[i].builder().target() != nullptr) result.names = surfaces_[i].vertex_names();
    result.stack_bytes = static_cast<std::size_t>(deepest_ + 1) * sizeof(View);
    result.table_bytes = normals_.memory_bytes() + neighbours_.memory_bytes();
    for (const auto& surface : surfaces_) result.table_bytes += surface.memory_bytes();
    for (const auto& t : transitions_) {
        result.table_bytes += t.record.memory_bytes() + t.asides.memory_bytes();
    }
}

template <int dimension, class Real>
NESTGRID_INLINE Decision LevelSet<dimension, Real>::inspect(const View& view, const Split& split) {
    counted_ = counted(view);
    counts_.calls += counted_;
    if ((counts_.calls & 0xFFFFU) == 0) Base::tell(0, 0);
    const Decision decision = look(view, split);
    if (decision.visit != Visit::skip) counts_.visited += counted_;
    return decision;
}

template <int dimension, class Real>
NESTGRID_INLINE Decision LevelSet<dimension, Real>::look(const View& view, const Split& split) {
    const bool caps = options_->cap && may_cap_below(view);
    const bool hidden = view.member->hidden == Hidden::wholly;
    if (options_->cap && hidden && !caps) return {Visit::skip, 0};
    auto [decision, bound] = search_->look(view, split, caps, at_hand_.question);
    at_hand_.bound = bound;
    if (decision.visit == Visit::stop && stops_above_cap(view)) decision.visit = Visit::descend;
    if (options_->position_bounds != nullptr && decision.visit == Visit::stop) {
        at_hand_.position_bound =
            nestgrid::detail::greatest_eta(*options_->position_bounds, split.keys);
    }
    return decision;
}

/// With caps, inspects all leaves, because caps also lie in those that no level passes through.
template <int dimension, class Real>
NESTGRID_INLINE Leaves LevelSet<dimension, Real>::leaves(const Rule& rule, const Real* values,
                                                         NodeMask which, bool /*closed*/) {
    if (options_->cap) return {0, which};
    const Leaves leaves = search_->cut_leaves(rule, values, which);
    const std::uint64_t before = counts_.calls;
    add(count_ones(which & ~leaves.inspect), count_ones(leaves.extract));
    if ((before >> 16U) != (counts_.calls >> 16U)) Base::tell(0, 0);
    return leaves;
}

/// Walks the bisections below an element in patches, where elements that stop conform and the
/// options ask for vertices and triangles alone, or for a slice.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::takes(const View& view) {
    if (!bisects_ || (walk_->function_count() > 0 && is_near_boundary(view))) return false;
    const PatchTarget<dimension, Real> target{search_->levels(),
                                              surfaces_,
                                              &tally_,
                                              &deepest_,
                                              at_hand_.cuts.attribute_count() > 0,
                                              options_->at_nodes,
                                              options_->normals,
                                              finest_};
    draw_in_patches(*walk_, view, *search_, target, *this);
    return true;
}

/// Whether a face on the boundary lies so near to the slice by an affine function that faces below
/// it may lie in the slice (boundary_in_slice), which walks in patches do not draw. On a face that
/// is 2^-20 times as large and lies in the slice up to rounding, the function is less than 4 times
/// its tolerance from 0, and on the whole face less than 2^22 times.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::is_near_boundary(const View& view) const {
    const double near = 0x1p28 * walk_->functions()->tolerance(0);
    unsigned close = 0;
    for (std::size_t k = 0; k < view.corner_count(); ++k) {
        const auto value = static_cast<double>(view.value[k * walk_->components()]);
        close |= unsigned{std::abs(value) <= near} << k;
    }
    const unsigned faces = faces_among(view.topology(), close);
    return faces != 0 && (faces & walk_->boundary(view)) != 0;
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::extract(const View& view) {
    if (view.is_leaf()) {
        at_hand_.bound = 0;
        at_hand_.position_bound = 0;
    }
    const bool shown = view.member->hidden != Hidden::wholly;
    const unsigned boundary = options_->cap ? capped_faces(view) : 0U;
    const bool draws = shown || boundary != 0;
    if (!draws && (options_->cap || !view.closed.any_face)) return;
    const std::size_t corners = view.corner_count();
    at_hand_.loaded = false;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        const Level<Real>& level = search_->levels()[i];
        const unsigned inside = search_->inside(view.value, corners, level);
        const bool whole = inside == all_corners(corners);
        const bool lies_in = whole && !options_->cap && search_->is_slice(level);
        const unsigned faces = lies_in ? boundary_in_slice(view, level) : boundary;
        if (inside == 0 || (whole && faces == 0)) continue;
        extract(i, view, inside, faces, draws);
    }
}

/// The faces on the boundary of the domain that lie in a slice, one bit each, in an element that is
/// wholly inside. No element beyond them draws the slice there.
template <int dimension, class Real>
unsigned LevelSet<dimension, Real>::boundary_in_slice(const View& view,
                                                      const Level<Real>& level) const {
    unsigned above = 0;
    for (std::size_t k = 0; k < view.corner_count(); ++k) {
        const Real value = view.value[k * walk_->components() + level.component];
        above |= unsigned{value > level.least_inside} << k;
    }
    const unsigned faces = faces_among(view.topology(), ~above);
    return faces == 0 ? 0 : faces & walk_->boundary(view);
}

/// Draws one level in an element.
/// \param inside the corners inside the level, one bit each
/// \param boundary the faces to be capped
/// \param draws whether the element is shown or draws caps; otherwise it only records
template <int dimension, class Real>
NESTGRID_INLINE void LevelSet<dimension, Real>::extract(std::size_t level, const View& view,
                                                        unsigned inside, unsigned boundary,
                                                        bool draws) {
    load(view, draws);
    at_hand_.cuts.set_level(search_->levels()[level]);
    // What is recorded lies on closed faces; what caps record, also on closed edges.
    const bool may_record = boundary == 0 ? view.closed.any_face : view.closed.any;
    if (!records_ || (draws && view.level == finest_level_ && !may_record)) {
        return draw(level, inside, boundary);
    }
    draw_beside_finer(level, inside, boundary, draws);
}

/// Loads the corners of the element, and adds its gradients where it is drawn.
template <int dimension, class Real>
NESTGRID_INLINE void LevelSet<dimension, Real>::load(const View& view, bool draws) {
    if (at_hand_.loaded) return;
    at_hand_.loaded = true;
    const bool keys = at_hand_.loads_keys || view.closed.any || view.interpolated != 0;
    at_hand_.cuts.load(view, keys);
    deepest_ = std::max(deepest_, view.level);
    const bool shown = view.member->hidden != Hidden::wholly;
    if (options_->normals && draws && shown) normals_.add(at_hand_.cuts);
}

/// The contour of the element if it may be drawn plainly. Vertices that lie at corners may not,
/// where those at nodes are merged.
/// \param boundary the faces to be capped
template <int dimension, class Real>
NESTGRID_INLINE const Contour* LevelSet<dimension, Real>::plain_contour(unsigned inside,
                                                                        unsigned boundary) {
    if (!at_hand_.plainly || boundary != 0) return nullptr;
    if (options_->at_nodes && at_hand_.cuts.touches_level()) return nullptr;
    return at_hand_.contour.table(at_hand_.cuts.view().shape).plain(inside);
}

/// The faces of an element on the boundary of the domain, one bit each, where the surface keeps its
/// edges there.
template <int dimension, class Real>
NESTGRID_INLINE unsigned LevelSet<dimension, Real>::boundary_of(
    const DrawnSurface<dimension>& surface, const View& view) const {
    return surface.names_vertices() ? walk_->boundary(view) : 0;
}

/// Draws an element beside which no finer one draws.
template <int dimension, class Real>
NESTGRID_INLINE void LevelSet<dimension, Real>::draw(std::size_t level, unsigned inside,
                                                     unsigned boundary) {
    const View& view = at_hand_.cuts.view();
    DrawnSurface<dimension>& surface = surfaces_[level];
    auto& contour = at_hand_.contour;
    if (view.member->hidden == Hidden::wholly) {  // caps of leaves that are shown, on its faces
        contour.begin_beyond(surface);
        at_hand_.cap.draw(inside, boundary, {});
        if (surface.counts_only()) return surface.forget_element();
        return surface.builder().flush_if_full();
    }
    if (const Contour* const plain = plain_contour(inside, boundary)) {
        if (surface.counts_only()) return tally_.add(contour.simplices_of(*plain));
        contour.draw_plainly(surface, *plain, inside);
        return end_element(surface);
    }
    contour.begin(surface);
    const unsigned joins = contour.own_joins(contour.table(view.shape).alternating(inside));
    if (inside != all_corners(view.corner_count())) {
        contour.draw(inside, joins, boundary_of(surface, view));
    }
    if (boundary != 0) at_hand_.cap.draw(inside, boundary, {});
    if (contour.begun()) end_element(surface);
    if (surface.counts_only()) surface.forget_element();
}

/// Draws an element, or puts it aside, where elements may stop beside finer ones. Records what it
/// draws on its closed faces.
template <int dimension, class Real>
void LevelSet<dimension, Real>::draw_beside_finer(std::size_t level, unsigned inside,
                                                  unsigned boundary, bool draws) {
    const View& view = at_hand_.cuts.view();
    DrawnSurface<dimension>& surface = surfaces_[level];
    Transitions<Real>& transitions = transitions_[level];
    auto& aside = at_hand_.aside;
    const bool by_names = transitions.record.by_names();
    const bool at_once = view.level == finest_level_;
    const Contour* const plain = plain_contour(inside, boundary);
    aside.begin(inside, boundary, draws && !at_once);
    if (at_once && draws && plain != nullptr && !by_names) {
        at_hand_.contour.draw_plainly(surface, *plain, inside, &aside.vertices());
        aside.record(transitions.record);
        return end_element(surface);
    }
    by_names ? aside.find_vertices(transitions.record) : aside.find_vertices(surface, plain);
    aside.record(transitions.record);
    if (!draws) return;
    if (at_once) return draw(level, inside, boundary);
    aside.put_aside(surface, transitions, boundary_of(surface, view));
    if (view.member->hidden != Hidden::wholly) end_element(surface);
}

/// Finds where caps are drawn beside hidden elements.
template <int dimension, class Real>
void LevelSet<dimension, Real>::find_hidden_faces() {
    const Hierarchy<Real>& hierarchy = walk_->hierarchy();
    if (!options_->cap || !hierarchy.offers(Feature::hidden) || neighbours_.any()) return;
    neighbours_ = {*walk_, std::make_shared<const HiddenFaces>(hierarchy)};
}

/// The faces of an element that are to be capped, one bit each.
template <int dimension, class Real>
unsigned LevelSet<dimension, Real>::capped_faces(const View& view) {
    if (!neighbours_.any()) return walk_->boundary(view);
    const HiddenBeyond& beyond = neighbours_.of(view);
    if (view.member->hidden == Hidden::wholly) return beyond.leaf;
    return walk_->boundary(view) | beyond.whole;
}

/// Whether an element, or one below it, may have faces to be capped.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::may_cap_below(const View& view) {
    if (!neighbours_.any()) return walk_->boundary(view) != 0;
    if (view.member->hidden == Hidden::partly) return true;
    return capped_faces(view) != 0 || neighbours_.of(view).part != 0;
}

/// Whether an element that may stop has a face that elements below it cap in part.
template <int dimension, class Real>
bool LevelSet<dimension, Real>::stops_above_cap(const View& view) {
    if (!neighbours_.any() || view.is_leaf()) return false;
    return view.member->hidden == Hidden::not_at_all && neighbours_.of(view).part != 0;
}

/// Counts an element that was drawn, raises the error bound by its error, and hands a full chunk to
/// the sink.
template <int dimension, class Real>
NESTGRID_INLINE void LevelSet<dimension, Real>::end_element(DrawnSurface<dimension>& surface) {
    surface.add_extracted(1);
    const InnerBounds inner = at_hand_.cuts.view().inner_bounds();
    surface.add_limited(inner.limited ? 1 : 0);
    surface.raise_position_bound(static_cast<double>(inner.position_error));
    surface.raise_off_level(at_hand_.cuts.off_level());
    const double bound = error_bound(at_hand_.cuts, *search_, at_hand_.bound);
    const View& view = at_hand_.cuts.view();
    surface.raise_error_bound(bound);
    if (view.is_leaf() && view.interpolated == 0) surface.raise_leaf_error(bound);
    if (options_->position_bounds != nullptr) {
        surface.raise_position_bound(
            position_bound(at_hand_.cuts, *options_->position_bounds, at_hand_.position_bound));
    }
    if (!surface.counts_only()) surface.builder().flush_if_full();
}

template class LevelSet<2, float>;
template class LevelSet<2, double>;
template class LevelSet<3, float>;
template class LevelSet<3, double>;

}  // namespace nestgrid::engine
