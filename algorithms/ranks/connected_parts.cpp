// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/connected_parts.hpp>

#include <algorithm>

#include <nestgrid/detail/union_find.hpp>

namespace nestgrid::engine {

void ConnectedParts::connect(Ranks& ranks, std::vector<Pair> pairs) {
    const auto drop_twice = [](auto& list) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    drop_twice(pairs);
    Bytes own;
    for (const Pair& pair : pairs) put(own, pair);
    std::vector<Pair> all;
    std::vector<Part> parts;
    for (const Bytes& told : ranks.gather(std::move(own))) {
        for (Reader in(told); in.more();) {
            all.push_back(in.get<Pair>());
            parts.insert(parts.end(), all.back().begin(), all.back().end());
        }
    }
    drop_twice(parts);
    const auto number = [&](const Part& part) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(parts, part) - parts.begin());
    };
    nestgrid::detail::UnionFind wholes(parts.size());
    for (const Pair& pair : all) wholes.join(number(pair[0]), number(pair[1]));
    // The least part of a whole, which stands for it, is on its least rank.
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
        const Part& whole = parts[wholes.root(i)];
        if (parts[i].rank == ranks.rank()) rank_[parts[i].number] = whole.rank;
        if (whole.rank == ranks.rank() && parts[i] != whole)
            members_.push_back({parts[i], whole.number});
    }
}

}  // namespace nestgrid::engine
