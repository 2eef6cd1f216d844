// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/hanging_nodes.hpp>

#include <algorithm>
#include <string>

#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/holes.hpp>
#include <nestgrid/detail/hanging_probe.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <walk/crossing_nodes.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// The element as check_grid names it: number of the coarse element and of children.
template <class Real>
std::string name_of(const ElementView<Real>& view) {
    if (view.father == nullptr) return std::to_string(view.coarse);
    return name_of(*view.father) + "/" + std::to_string(int{view.child});
}

template <class Real>
[[noreturn]] void refuse_face(const Walk<Real>& walk, const ElementView<Real>& view,
                              const Rule& rule, const detail::OneWayFace& face) {
    const bool gives_parents = walk.hierarchy().offers(Feature::hanging_parents);
    std::array<Point, max_corners + max_new_nodes> place{};
    walk.corners(view, nullptr, place.data());
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        place[view.corner_count() + n] =
            nestgrid::detail::interpolate(rule.new_nodes[n], place.data());
    }
    Point x{0, 0, 0};
    for (const std::uint8_t corner : face.corner) x = x + 0.25 * place[corner];
    throw GridError("elements on the two sides of the face around " + text_of(x) + " of element " +
                    name_of(view) +
                    " divide it in different directions first and one of them then across, so that "
                    "a node there hangs on " +
                    (gives_parents ? "edges in both directions, or the grid does not give its "
                                     "parents: refine both in the same order, or each in its own "
                                     "direction only"
                                   : "others than its parents: refine both in the same order, or "
                                     "each in its own direction only, or let the grid give these "
                                     "parents (hanging_parents)"));
}

/// Says where nodes hang on others than their parents, in a walk that carries positions, too.
/// Requires that there is such a face.
template <class Real>
void refuse_crossed_face(const Hierarchy<Real>& hierarchy, detail::HangingProbe& probe) {
    const Walk<Real> walk(hierarchy, {.values = false, .keys = true, .positions = true});
    SplitKeys keys;
    for_each_element(walk, true, [&](const ElementView<Real>& view, const Split& split) {
        if (split.rule == nullptr) return;
        const auto face = probe.crossed_face(*split.rule, walk.split_keys(view, split, keys));
        if (face) refuse_face(walk, view, *split.rule, *face);
    });
}

template <class Real>
[[noreturn]] void refuse_weights(const ElementView<Real>& view) {
    throw GridError("on an edge of a leaf on level " + std::to_string(view.level) +
                    " below coarse element " + std::to_string(view.coarse) +
                    " a node hangs that is not in its middle, as where a neighbour is divided by "
                    "three or graded: which nodes hang must be told by the operation constrained "
                    "of the grid");
}

}  // namespace

template <class Real>
HangingNodes derive_hanging_nodes(const Hierarchy<Real>& hierarchy) {
    const Walk<Real> walk(hierarchy, {.values = false, .keys = true});
    detail::HangingProbe probe;
    std::optional<CrossingSearch<Real>> crossing;
    if (hierarchy.offers(Feature::hanging_parents)) {
        crossing.emplace(walk);
        probe.rely_on_given_parents();
    }
    SplitKeys keys;
    for_each_element(walk, true, [&](const ElementView<Real>& view, const Split& split) {
        if (split.rule == nullptr) return;
        const std::span<const NodeKey> of = walk.split_keys(view, split, keys);
        probe.add_nodes(*split.rule, of, split.keys);
        if (crossing) crossing->add_split(*split.rule, of, probe);
    });
    probe.finish();
    const bool may_cross = probe.divides_one_way();
    bool crossed = false;
    for_each_element(walk, false, [&](const ElementView<Real>& view, const Split& split) {
        if (split.rule != nullptr) {
            crossed =
                crossed ||
                (may_cross && probe.crossed_face(*split.rule, walk.split_keys(view, split, keys)));
        } else if (view.member->hidden != Hidden::wholly) {
            walk.corners(view, keys.data(), nullptr);
            probe.probe_leaf(view.shape, keys);
            if (probe.hangs_at_weights()) refuse_weights(view);
        }
    });
    if (crossed) refuse_crossed_face(hierarchy, probe);
    HangingNodes hanging = probe.take();
    if (crossing) hanging.set_crossing(crossing->find(probe, hanging));
    return hanging;
}

template <class Real>
void find_unseen_nodes(const Hierarchy<Real>& hierarchy, HangingNodes& nodes) {
    if (const Holes<Real>* holes = nestgrid::detail::holes_of(hierarchy)) {
        return nodes.set_unseen(holes->hidden()->unseen());
    }
    const Walk<Real> walk(hierarchy, {.values = false, .keys = true});
    UnseenSearch search(hierarchy.facts().node_count);
    for_each_element(walk, false, [&](const ElementView<Real>& view, const Split& split) {
        const bool shown = split.rule == nullptr && view.member->hidden != Hidden::wholly;
        search.add(walk, view, split, shown);
    });
    nodes.set_unseen(search.found());
}

template HangingNodes derive_hanging_nodes(const Hierarchy<float>&);
template HangingNodes derive_hanging_nodes(const Hierarchy<double>&);
template void find_unseen_nodes(const Hierarchy<float>&, HangingNodes&);
template void find_unseen_nodes(const Hierarchy<double>&, HangingNodes&);

}  // namespace engine

HangingNodes derive_hanging_nodes(const Hierarchy<float>& hierarchy) {
    return engine::derive_hanging_nodes(hierarchy);
}

}  // namespace nestgrid
