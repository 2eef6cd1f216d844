// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/region.hpp>

#include <algorithm>
#include <utility>

#include <indicators/fine_to_coarse.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid {

namespace {

using Inside = std::function<bool(const Point&)>;

using Marks = engine::NodeMaxima<std::uint8_t>;

/// Marks the nodes of an element that lie inside, and adds its split.
template <class Real>
void add_element(const engine::Walk<Real>& walk, const engine::ElementView<Real>& view,
                 const engine::Split& split, const Inside& inside, Marks& marks) {
    const std::size_t corners = view.corner_count();
    std::array<NodeKey, max_corners> keys;
    std::array<Point, max_corners> x;
    std::array<std::size_t, max_corners + max_new_nodes> nodes;
    walk.corners(view, keys.data(), x.data());
    marks.find(std::span(keys).first(corners), nodes);
    marks.find(split.keys, std::span(nodes).subspan(corners));
    for (std::size_t i = 0; i < corners; ++i) {
        if (inside(x[i])) marks[nodes[i]] = 1;
    }
    if (split.rule == nullptr) return;
    marks.add_split(view.level, *split.rule, std::span(nodes).first(corners + split.keys.size()));
}

}  // namespace

Region::Region(const FieldOnGrid& field, const Inside& inside) {
    field.visit([&](const auto& hierarchy) {
        epoch_ = hierarchy.epoch();
        if (hierarchy.facts().knows_star_positions) {
            sweep_stars(hierarchy, inside);
        } else {
            sweep_levels(hierarchy, inside);
        }
    });
}

template <class Real>
void Region::sweep_stars(const Hierarchy<Real>& hierarchy, const Inside& inside) {
    constexpr std::uint8_t gathered = 2;  // marks nodes that stand for others
    dense_.assign(hierarchy.facts().node_count, 0);
    hierarchy.star_rows([&](const StarRow& row) {
        for (std::size_t i = 0; i < row.count; ++i) {
            const std::size_t node = row.first + i * row.stride;
            std::uint8_t finer = 0;
            for (const std::ptrdiff_t offset : row.finer) {
                finer |= dense_[node + static_cast<std::size_t>(offset)];
            }
            if (row.gathers) {
                if (finer != 0) dense_[node] |= gathered;
            } else {
                const bool is_inside = inside(hierarchy.node_position(static_cast<NodeKey>(node)));
                dense_[node] = is_inside || finer != 0 ? 1 : 0;
            }
        }
    });
    for (std::uint8_t& mark : dense_) mark &= 1U;
}

template <class Real>
void Region::sweep_levels(const Hierarchy<Real>& hierarchy, const Inside& inside) {
    const engine::SharedNodes* const shared = hierarchy.facts().shared;
    Marks marks(hierarchy.facts().node_count, 0);
    engine::together(shared, "a region", [&] {
        if (shared != nullptr) engine::require_same_state(hierarchy);
        const engine::Walk<Real> walk(
            hierarchy, {.values = false, .keys = true, .positions = true, .on_ranks = true});
        engine::for_each_element(
            walk, false, [&](const engine::ElementView<Real>& view, const engine::Split& split) {
                add_element(walk, view, split, inside, marks);
            });
    });
    marks.saturate(shared);
    std::vector<std::uint8_t> saturated = marks.take();
    if (hierarchy.facts().node_count != 0) {
        dense_ = std::move(saturated);
        return;
    }
    marks.for_each([&](NodeKey key, std::size_t node) {
        if (saturated[node] != 0) sparse_.insert(key, {});
    });
}

}  // namespace nestgrid
