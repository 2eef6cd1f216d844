// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/patch_level_set.hpp>

#include <patches/told_bisections.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

namespace {

/// Answers the questions of a walk in patches and draws its batches.
template <int dimension, class Real>
class PatchLevelSet final : public ErasedBisectionVisitor<dimension, Real> {
    using Base = ErasedBisectionVisitor<dimension, Real>;

public:
    PatchLevelSet(const typename Base::Start& start, const LevelSearch<Real>& search,
                  const PatchTarget<dimension, Real>& target, PatchCounts& counts)
        : Base(start), search_{&search}, target_{&target}, counts_{&counts} {}

    typename Base::Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level,
                                 bool outside) override {
        const auto [visit, bound] = search_->glance(lo, hi, rule, node, level, outside);
        return {visit, bound};
    }
    bool glance_at_leaf(Real lo, Real hi) override { return search_->glance_at_leaf(lo, hi); }
    PackedSight<Real> see_within(const PackedPatches<Real>& patches) override {
        return see<maubach_patch<dimension>, PatchParts::inner>(patches, *search_);
    }
    PackedSight<Real> see_ends(const PackedPatches<Real>& patches) override {
        return see<maubach_patch<dimension>, PatchParts::ends>(patches, *search_);
    }
    void prefetch(const NodeKey* nodes, std::size_t rows) const override {
        search_->prefetch(nodes, rows);
    }
    bool names_edges() const override { return target_->surfaces.front().names_vertices(); }
    void begin_subtrees(std::uint32_t numbers) override {
        for (auto& surface : target_->surfaces) surface.within().begin_again(numbers);
    }
    unsigned extract(const ErasedPatches<dimension, Real>& patches,
                     const BatchSelection& selection) override {
        using Patches = ErasedPatches<dimension, Real>;
        return PatchDrawing<dimension, Real, Patches>(*target_, patches, selection).draw();
    }
    void tick(std::uint64_t calls, std::uint64_t visited) override {
        counts_->tick(calls, visited);
    }
    void end(std::uint64_t calls, std::uint64_t visited) override { counts_->add(calls, visited); }

private:
    const LevelSearch<Real>* search_;
    const PatchTarget<dimension, Real>* target_;
    PatchCounts* counts_;
};

}  // namespace

template <int dimension, class Real>
void draw_in_patches(const Walk<Real>& walk, const ElementView<Real>& view,
                     const LevelSearch<Real>& search, const PatchTarget<dimension, Real>& target,
                     PatchCounts& counts) {
    std::array<Real, 4> values{};
    double tolerance = -1;
    if (walk.function_count() > 0) {
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k] = view.value[k * walk.components()];
        }
        tolerance = walk.functions()->tolerance(0);
    }
    PatchLevelSet<dimension, Real> visitor(
        {tolerance < 0 ? view.value : values.data(), view.level, view.orientation, tolerance},
        search, target, counts);
    ErasedBisectionVisitor<dimension, Real>& seam = visitor;
    bisect(walk.hierarchy(), view.stack->task.get(), view.element(), seam);
}

template void draw_in_patches(const Walk<float>&, const ElementView<float>&,
                              const LevelSearch<float>&, const PatchTarget<2, float>&,
                              PatchCounts&);
template void draw_in_patches(const Walk<float>&, const ElementView<float>&,
                              const LevelSearch<float>&, const PatchTarget<3, float>&,
                              PatchCounts&);
template void draw_in_patches(const Walk<double>&, const ElementView<double>&,
                              const LevelSearch<double>&, const PatchTarget<2, double>&,
                              PatchCounts&);
template void draw_in_patches(const Walk<double>&, const ElementView<double>&,
                              const LevelSearch<double>&, const PatchTarget<3, double>&,
                              PatchCounts&);

}  // namespace nestgrid::engine
