// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a level set draws of the elements of a walk, which is compiled here with all of it.
#include <level_sets/level_set.hpp>

#include <algorithm>
#include <bit>

#include <level_sets/element_contour_steps.hpp>
#include <level_sets/error_bound.hpp>
#include <level_sets/level_search_steps.hpp>
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
void LevelSet<dimension, Real>::walk_alone() {
    walk_->run_as(*this);
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::walk_below(const Walk<Real>& walk, const View& view) {
    walk.walk_below_as(view, *this);
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
    DrawnReport& report = surface.report();
    report.extracted += 1;
    const InnerBounds inner = at_hand_.cuts.view().inner_bounds();
    report.limited += inner.limited ? 1 : 0;
    report.raise_position_bound(static_cast<double>(inner.position_error));
    report.raise_off_level(at_hand_.cuts.off_level());
    const double bound = error_bound(at_hand_.cuts, *search_, at_hand_.bound);
    const View& view = at_hand_.cuts.view();
    report.raise_error_bound(bound);
    if (view.is_leaf() && view.interpolated == 0) report.raise_leaf_error(bound);
    if (options_->position_bounds != nullptr) {
        report.raise_position_bound(
            position_bound(at_hand_.cuts, *options_->position_bounds, at_hand_.position_bound));
    }
    if (!surface.counts_only()) surface.builder().flush_if_full();
}

template class LevelSet<2, float>;
template class LevelSet<2, double>;
template class LevelSet<3, float>;
template class LevelSet<3, double>;

}  // namespace nestgrid::engine
