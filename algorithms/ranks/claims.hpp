// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Checks that each leaf of a distributed grid is on one rank alone.
//
// Each coarse element has a random number, and shares it out among its children, these among
// theirs. So the numbers of the elements that ranks say they have wholly add up to those of all
// coarse elements, unless leaves are on several ranks or on none: one number is reduced.
#pragma once

#include <algorithm>
#include <string>

#include <nestgrid/error.hpp>
#include <nestgrid/hierarchy.hpp>
#include <ranks/wire.hpp>

namespace nestgrid::engine {

/// The way to an element: the number of its coarse element; then, for each step down, the number of
/// the child and how many children there are.
using ClaimPath = std::vector<std::uint32_t>;

/// Calls function(path) for the elements that this rank has wholly, and whose fathers it has not.
template <class Function>
void for_each_claim(const Hierarchy<float>& grid, const Function& function) {
    const std::unique_ptr<Task> task = grid.open();
    ClaimPath path;
    const auto visit = [&](const Member& member, const auto& again) -> void {
        if (member.presence == Presence::here) return function(path);
        if (member.presence == Presence::elsewhere || member.rule == nullptr) return;
        const std::size_t count = member.rule->children.size();
        Family family;
        grid.enter(task.get(), member.element, *member.rule, 0, nullptr,
                   ~NodeMask{0} >> (8 * sizeof(NodeMask) - count), family);
        for (std::size_t c = 0; c < count; ++c) {
            path.push_back(static_cast<std::uint32_t>(c));
            path.push_back(static_cast<std::uint32_t>(count));
            again(family.members[c], again);
            path.resize(path.size() - 2);
        }
    };
    Coarse coarse;
    for (std::size_t i = 0; i < grid.coarse_count(); ++i) {
        Family family;
        grid.coarse(task.get(), i, coarse, family);
        path.assign(1, static_cast<std::uint32_t>(i));
        visit(family.members[0], visit);
    }
}

/// The share of an element in the random numbers of coarse elements.
inline std::uint64_t share_of(const ClaimPath& path) {
    std::uint64_t share = nestgrid::detail::mix64(path[0] + std::uint64_t{1});
    for (std::size_t i = 1; i < path.size(); i += 2) {
        const auto of_child = [father = share](std::uint64_t c) {
            return nestgrid::detail::mix64(father + c + 1);
        };
        if (path[i] + 1 < path[i + 1]) {
            share = of_child(path[i]);
            continue;
        }
        for (std::uint64_t c = 0; c < path[i]; ++c) share -= of_child(c);
    }
    return share;
}

/// All claims of all ranks, where some are wrong.
class AllClaims {
public:
    /// Collective. \param own of this rank
    AllClaims(Ranks& ranks, const std::vector<ClaimPath>& own) {
        Bytes told;
        for (const ClaimPath& path : own) {
            put(told, static_cast<std::uint32_t>(path.size()));
            for (const std::uint32_t step : path) put(told, step);
        }
        const std::vector<Bytes> all = ranks.gather(std::move(told));
        for (std::size_t rank = 0; rank < all.size(); ++rank) {
            for (Reader in(all[rank]); in.more();) {
                ClaimPath path(in.get<std::uint32_t>());
                for (std::uint32_t& step : path) step = in.get<std::uint32_t>();
                claims_.push_back({std::move(path), rank});
            }
        }
        std::sort(claims_.begin(), claims_.end());
    }
    /// Names the first element that is on several ranks or on none, and these ranks.
    std::string first_wrong(std::size_t coarse_count) const {
        for (std::uint32_t i = 0; i < coarse_count; ++i) {
            const std::string wrong = wrong_below({i}, claims_);
            if (!wrong.empty()) return wrong;
        }
        return "ranks have different elements";
    }

private:
    using Claim = std::pair<ClaimPath, std::size_t>;  // of a rank

    /// \param claims in which those of the element and of what is below it follow each other
    static std::string wrong_below(const ClaimPath& element, std::span<const Claim> claims) {
        const auto is_below = [&](const Claim& claim) {
            return claim.first.size() >= element.size() &&
                   std::equal(element.begin(), element.end(), claim.first.begin());
        };
        const auto begin = std::find_if(claims.begin(), claims.end(), is_below);
        const auto end = std::find_if_not(begin, claims.end(), is_below);
        if (begin == end) return name_of(element) + " is on no rank";
        claims = claims.subspan(static_cast<std::size_t>(begin - claims.begin()),
                                static_cast<std::size_t>(end - begin));
        if (claims[0].first == element) {
            if (claims.size() == 1) return {};
            return name_of(claims[1].first) + " is on ranks " + std::to_string(claims[0].second) +
                   " and " + std::to_string(claims[1].second);
        }
        const std::uint32_t children = claims[0].first[element.size() + 1];
        for (std::uint32_t c = 0; c < children; ++c) {
            ClaimPath child = element;
            child.push_back(c);
            child.push_back(children);
            const std::string wrong = wrong_below(child, claims);
            if (!wrong.empty()) return wrong;
        }
        return {};
    }
    /// As check_grid() names it.
    static std::string name_of(const ClaimPath& path) {
        std::string name = "element " + std::to_string(path[0]);
        for (std::size_t i = 1; i < path.size(); i += 2) name += "/" + std::to_string(path[i]);
        return name;
    }

    std::vector<Claim> claims_;
};

/// Collective. \param own of this rank, of a grid whose coarse elements all ranks list
///
/// \throw GridError, on all ranks alike, where an element is on several ranks or on none
inline void require_one_rank_each(Ranks& ranks, const std::vector<ClaimPath>& own,
                                  std::size_t coarse_count) {
    std::uint64_t sum = 0;
    for (const ClaimPath& path : own) sum += share_of(path);
    ranks.reduce(std::span(&sum, 1), Ranks::Reduction::sum);
    for (std::uint32_t i = 0; i < coarse_count; ++i) sum -= share_of({i});
    if (sum == 0) return;
    throw GridError("presence must give each leaf to one rank, but " +
                    AllClaims(ranks, own).first_wrong(coarse_count));
}

}  // namespace nestgrid::engine
