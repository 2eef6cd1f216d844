// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/star_sizes.hpp>

#include <algorithm>

#include <indicators/split_kinds.hpp>

namespace nestgrid::engine {

namespace {

using Offset = KeyOffset;
using Offsets = KeyOffsets;

/// Finer nodes that hand on by one distance.
struct FinerNodes {
    float reach;
    Offsets offsets;
};

std::vector<FinerNodes> by_reach(std::span<const Offset> finer, const auto& reach_of_offset) {
    std::vector<FinerNodes> groups;
    for (const Offset to : finer) {
        const float reach = reach_of_offset(to);
        auto group = std::ranges::find(groups, reach, &FinerNodes::reach);
        if (group == groups.end()) group = groups.insert(group, {reach, {}});
        group->offsets.push_back(to);
    }
    return groups;
}

/// The sizes of all nodes, row by row.
template <class Real>
class StarSizes {
public:
    StarSizes(const SplitKinds<Real>& kinds, const Spread& spread, std::size_t nodes)
        : kinds_{&kinds}, spread_{spread}, sizes_(nodes, 0) {}

    void add(const StarRow& row) { return row.gathers ? gather(row) : set(row); }
    std::vector<std::uint16_t> take() { return std::move(sizes_); }

private:
    void set(const StarRow& row) {
        const std::uint16_t own = bfloat16_above(float_above(kinds_->size(row.parents)));
        const auto finer = by_reach(row.finer, [&](Offset to) { return kinds_->reach(to); });
        for (std::size_t i = 0; i < row.count; ++i) {
            const std::size_t node = row.first + i * row.stride;
            std::uint16_t size = own;
            for (const FinerNodes& group : finer) {
                std::uint16_t greatest = greatest_of(sizes_, node, group.offsets);
                if (!gathered_.empty()) {
                    greatest = std::max(greatest, greatest_of(gathered_, node, group.offsets));
                }
                size = std::max(size, hand_on(spread_, greatest, group.reach));
            }
            sizes_[node] = i + row.outside < row.count ? size : bfloat16_infinity;
        }
    }

    void gather(const StarRow& row) {
        gathered_.resize(sizes_.size());
        for (std::size_t i = 0; i < row.count; ++i) {
            const std::size_t node = row.first + i * row.stride;
            gathered_[node] = greatest_of(sizes_, node, row.finer);
        }
    }

    static std::uint16_t greatest_of(const std::vector<std::uint16_t>& sizes, std::size_t node,
                                     std::span<const Offset> finer) {
        std::uint16_t greatest = 0;
        for (const Offset to : finer) {
            greatest = std::max(greatest, sizes[node + static_cast<std::size_t>(to)]);
        }
        return greatest;
    }

    const SplitKinds<Real>* kinds_;
    Spread spread_;
    std::vector<std::uint16_t> sizes_;     // bfloat16
    std::vector<std::uint16_t> gathered_;  // of nodes that stand for all of their element
};

}  // namespace

template <class Real>
SweptIndicator star_sizes(const Hierarchy<Real>& hierarchy, const Spread& spread) {
    require_spread(spread);
    const Walk<Real> walk(hierarchy, {.values = false, .keys = true, .positions = true});
    SplitKinds<Real> kinds(walk);
    walk.run(kinds);
    StarSizes<Real> sizes(kinds, spread, hierarchy.facts().node_count);
    hierarchy.star_rows([&](const StarRow& row) { sizes.add(row); });
    return {{sizes.take(), {}}, spread};
}

template SweptIndicator star_sizes(const Hierarchy<float>&, const Spread&);
template SweptIndicator star_sizes(const Hierarchy<double>&, const Spread&);

}  // namespace nestgrid::engine
