// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How a level set is drawn: its tasks, what they hand over, and what is told of the result. What
// they draw of each element is in level_set_walk.cpp.
#include <level_sets/level_set.hpp>

#include <algorithm>
#include <limits>

#include <level_sets/error_bound.hpp>
#include <ranks/agreement.hpp>
#include <walk/unusable_values.hpp>

namespace nestgrid::engine {

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
    if (!keeps_memory_) freed_bytes_ = table_bytes();
    alone([&] {
        tally_.begin_later();
        for (std::size_t i = 0; i < surfaces_.size(); ++i) {
            if (records_) {
                at_hand_.cuts.set_level(search_->levels()[i]);
                at_hand_.aside.draw(surfaces_[i], transitions_[i], keeps_memory_);
            }
            surfaces_[i].builder().flush();
            if (!keeps_memory_) surfaces_[i].free_names();
        }
    });
    if (options_->normals) normals_.complete(walk_->hierarchy());
    if (options_->normals && ranks != nullptr) normals_.add_across();
    for (DrawnSurface<dimension>& surface : surfaces_) {
        surface.finish(options_->at_nodes && !surface.counts_only(), ranks);
    }
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::agree(Ranks& ranks) {
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        // What a criterion promises it knows of the nodes of this rank.
        surfaces_[i].report().raise_leaf_error(search_->surface_error(search_->levels()[i]));
        surfaces_[i].agree(ranks);
    }
    Base::agree(ranks);
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
    surface.report().add(more.report());
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
void LevelSet<dimension, Real>::flush() {
    for (DrawnSurface<dimension>& surface : surfaces_) surface.builder().flush();
}

template <int dimension, class Real>
void LevelSet<dimension, Real>::report(std::size_t i, Isosurface<dimension>& result) const {
    const DrawnReport& drawn = surfaces_[i].report();
    result.counts = counts_;
    result.counts.extracted = drawn.extracted;
    result.counts.limited = drawn.limited;
    result.range_bound = range_bound(search_->levels()[i], *search_);
    const double off_level = drawn.off_level;
    result.surface_error =
        off_level > 0 ? std::numeric_limits<double>::infinity()
                      : std::max(drawn.leaf_error, search_->surface_error(search_->levels()[i]));
    result.error_bound =
        std::min({drawn.error_bound + off_level, result.range_bound, result.surface_error});
    result.position_bound = drawn.position_bound;
    if (surfaces_[i].builder().target() != nullptr) result.names = surfaces_[i].vertex_names();
    result.stack_bytes = static_cast<std::size_t>(deepest_ + 1) * sizeof(View);
    result.table_bytes = std::max(freed_bytes_, table_bytes());
}

template <int dimension, class Real>
std::size_t LevelSet<dimension, Real>::table_bytes() const {
    std::size_t bytes = normals_.memory_bytes() + neighbours_.memory_bytes();
    for (const auto& surface : surfaces_) bytes += surface.memory_bytes();
    for (const auto& t : transitions_) {
        bytes += t.record.memory_bytes() + t.asides.memory_bytes();
    }
    return bytes;
}

template class LevelSet<2, float>;
template class LevelSet<2, double>;
template class LevelSet<3, float>;
template class LevelSet<3, double>;

}  // namespace nestgrid::engine
