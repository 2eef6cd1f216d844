// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <projection/made_for_ranks.hpp>

#include <algorithm>
#include <array>

#include <level_sets/leaf_bounds.hpp>
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

namespace {

/// The first coarse element of which this process lacks leaves, or their number.
template <class Real>
std::size_t find_partly_elsewhere(const Hierarchy<Real>& grid) {
    const std::unique_ptr<Task> task = grid.open();
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
        grid.coarse(task.get(), i, coarse, family);
        if (family.members[0].presence != Presence::here) return i;
    }
    return grid.coarse_count();
}

struct Refused {
    bool asked;
    const char* what;
};

void refuse_first(std::span<const Refused> all) {
    for (const Refused& each : all) {
        if (each.asked) refuse_on_ranks(each.what);
    }
}

}  // namespace

template <class Real>
bool has_all_leaves(const Hierarchy<Real>& hierarchy) {
    return !hierarchy.offers(Feature::presence) ||
           find_partly_elsewhere(hierarchy) == hierarchy.coarse_count();
}

template <class Real>
void require_made_for_parts(const Hierarchy<Real>& hierarchy, bool on_ranks) {
    if (on_ranks && hierarchy.facts().shared != nullptr) return;
    hierarchy.facts().require_one_process("what is asked for");
    const std::size_t i = find_partly_elsewhere(hierarchy);
    if (i == hierarchy.coarse_count()) return;
    throw GridError(
        "leaves of coarse element " + std::to_string(i) +
        " are on other processes, and the grid does not say how to reach them: write 'const "
        "Distributed grid(mine, ranks);' and 'const DistributedField field(grid, values);' "
        "(nestgrid/algorithms/distributed.hpp) and draw these");
}

template <class Real>
void require_same_state(const Hierarchy<Real>& hierarchy) {
    if (hierarchy.facts().shared->epoch() == hierarchy.epoch()) return;
    throw GridError(
        "the grid has changed since its ranks shared their nodes: make another Distributed of it");
}

template <class Real>
void require_drawn_on_ranks(const Hierarchy<Real>& grid) {
    const std::array refused{
        Refused{grid.offers(Feature::hidden), "a grid with hidden elements"},
        Refused{grid.offers(Feature::masked), "a grid with masked elements"},
        Refused{grid.offers(Feature::outside), "a grid that ends outside its coarse elements"},
        Refused{grid.offers(Feature::hanging_parents), "a grid with nodes that hang across"},
    };
    refuse_first(refused);
}

void require_drawn_on_ranks(const Criterion& criterion, const Bounds& bounds,
                            const IsosurfaceOptions& options, bool own_gradients) {
    const bool own = dynamic_cast<const HierarchicalIndicator*>(&bounds) != nullptr ||
                     dynamic_cast<const LeafBounds*>(&bounds) != nullptr ||
                     dynamic_cast<const KeyFrames*>(&bounds) != nullptr;
    const std::array refused{
        Refused{!own, "a surface under other bounds than those of offsets"},
        Refused{criterion.insists(), "a surface under a criterion that is not saturated"},
        Refused{options.normals && options.at_nodes,
                "a surface with normals and vertices at nodes"},
        Refused{options.normals && own_gradients, "a field with gradients of its own"},
        Refused{options.reference, "a surface with reference coordinates"},
        Refused{options.cuts != Cuts::linear, "a surface with cuts on the finest pieces"},
        Refused{options.position_bounds != nullptr, "a bound of positions"},
    };
    refuse_first(refused);
}

std::string name_of(const Criterion& criterion) {
    const Threshold* const threshold = criterion.as_threshold();
    return "threshold " + (threshold == nullptr ? "none" : all_digits(threshold->epsilon()));
}

template <class Real>
std::string asked_for(std::span<const Level<Real>> levels, const Criterion& criterion,
                      const IsosurfaceOptions& options) {
    std::string asked = "isosurfaces of ";
    for (const Level<Real>& level : levels) asked += all_digits(level.value) + ", ";
    asked += name_of(criterion);
    if (options.at_nodes) asked += ", with vertices at nodes";
    if (options.normals) asked += ", with normals";
    return asked + (options.cap ? ", with caps" : "");
}

template bool has_all_leaves(const Hierarchy<float>&);
template bool has_all_leaves(const Hierarchy<double>&);
template void require_made_for_parts(const Hierarchy<float>&, bool);
template void require_made_for_parts(const Hierarchy<double>&, bool);
template void require_same_state(const Hierarchy<float>&);
template void require_same_state(const Hierarchy<double>&);
template void require_drawn_on_ranks(const Hierarchy<float>&);
template void require_drawn_on_ranks(const Hierarchy<double>&);
template std::string asked_for(std::span<const Level<float>>, const Criterion&,
                               const IsosurfaceOptions&);
template std::string asked_for(std::span<const Level<double>>, const Criterion&,
                               const IsosurfaceOptions&);

}  // namespace nestgrid::engine
