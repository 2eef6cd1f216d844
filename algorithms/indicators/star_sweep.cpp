// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/star_sweep.hpp>

#include <algorithm>
#include <optional>

#include <indicators/split_kinds.hpp>

namespace nestgrid::engine {

namespace {

/// Finer nodes that hand on by one distance.
struct FinerNodes {
    float reach;
    KeyOffsets offsets;
};

/// Hands etas on from finer nodes, row by row.
template <class Real>
class StarSweep {
public:
    using Etas = std::vector<std::uint16_t>;

    StarSweep(const Hierarchy<Real>& hierarchy, const Spread& spread, Etas& etas)
        : spread_{spread}, etas_{&etas} {
        if (spread.slope > 0) kinds_.emplace(hierarchy);
    }

    void sweep(const StarRow& row) { return row.gathers ? gather(row) : raise(row); }

private:
    void raise(const StarRow& row) {
        const std::vector<FinerNodes> groups = by_reach(row.finer);
        for (std::size_t i = 0; i < row.count; ++i) {
            const std::size_t node = row.first + i * row.stride;
            std::uint16_t eta = (*etas_)[node];
            for (const FinerNodes& group : groups) {
                std::uint16_t greatest = greatest_of(*etas_, node, group.offsets);
                if (!gathered_.empty()) {
                    greatest = std::max(greatest, greatest_of(gathered_, node, group.offsets));
                }
                eta = std::max(eta, hand_on(spread_, greatest, group.reach));
            }
            (*etas_)[node] = i + row.outside < row.count ? eta : detail::bfloat16_infinity;
        }
    }
    void gather(const StarRow& row) {
        gathered_.resize(etas_->size());
        for (std::size_t i = 0; i < row.count; ++i) {
            const std::size_t node = row.first + i * row.stride;
            gathered_[node] = greatest_of(*etas_, node, row.finer);
        }
    }

    std::vector<FinerNodes> by_reach(std::span<const KeyOffset> finer) const {
        std::vector<FinerNodes> groups;
        for (const KeyOffset to : finer) {
            const float reach = kinds_ ? kinds_->reach(to) : 0;
            auto group = std::find_if(groups.begin(), groups.end(),
                                      [&](const FinerNodes& g) { return g.reach == reach; });
            if (group == groups.end()) group = groups.insert(group, {reach, {}});
            group->offsets.push_back(to);
        }
        return groups;
    }
    static std::uint16_t greatest_of(const Etas& etas, std::size_t node,
                                     std::span<const KeyOffset> finer) {
        std::uint16_t greatest = 0;
        for (const KeyOffset to : finer) {
            greatest = std::max(greatest, etas[node + static_cast<std::size_t>(to)]);
        }
        return greatest;
    }

    std::optional<SplitKinds> kinds_;  // where distances count
    Spread spread_;
    Etas* etas_;
    Etas gathered_;  // of nodes that stand for all new nodes of their element
};

}  // namespace

template <class Real>
void sweep_rows(const Hierarchy<Real>& hierarchy, const Spread& spread,
                std::vector<std::uint16_t>& etas) {
    StarSweep<Real> sweep(hierarchy, spread, etas);
    hierarchy.star_rows([&](const StarRow& row) { sweep.sweep(row); });
}

template void sweep_rows(const Hierarchy<float>&, const Spread&, std::vector<std::uint16_t>&);
template void sweep_rows(const Hierarchy<double>&, const Spread&, std::vector<std::uint16_t>&);

}  // namespace nestgrid::engine
