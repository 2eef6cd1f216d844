// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells around nodes that several ranks have, for means at nodes (node_means.hpp).
//
// Each rank tells its cells to those that have a corner of them. So it has all cells around the
// corners of its own cells. Of other corners of these cells it knows what it is told: a rank with
// such a cell has all cells around them, and tells what it finds.
#pragma once

#include <algorithm>
#include <set>
#include <utility>

#include <nestgrid/algorithms/detail/node_means.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

/// The cells of other ranks; none, and nothing is exchanged, where there are no ranks.
class CellsAcross {
public:
    using Cell = nestgrid::detail::CellWithValue;
    /// A value that was found at a node.
    struct Found {
        NodeKey node;
        double value;
    };

    /// Collective, one exchange.
    /// \param shared null where there are no ranks
    CellsAcross(const SharedNodes* shared, const nestgrid::detail::ForEachCell& for_each_cell)
        : shared_{shared} {
        if (shared_ == nullptr) return;
        Outbox box(shared_->ranks().size());
        together(shared_, "means of cells at nodes", [&] {
            std::uint32_t number = 0;
            for_each_cell([&](const Cell& cell) { write(cell, number++, box); });
            std::sort(told_.begin(), told_.end());
            told_.erase(std::unique(told_.begin(), told_.end()), told_.end());
        });
        std::set<std::pair<int, std::uint32_t>> seen;
        shared_->send(box, [&](int rank, Reader& in) {
            while (in.more()) {
                const auto number = in.get<std::uint32_t>();
                read(in, seen.insert({rank, number}).second);
            }
        });
    }
    bool any() const { return shared_ != nullptr; }

    /// Calls function(cell) for those of other ranks.
    template <class Function>
    void for_each(const Function& function) const {
        std::size_t first = 0;
        for (const auto& [shape, value] : cells_) {
            const std::size_t corners = topology(shape).corners;
            function(Cell{shape, std::span(keys_).subspan(first, corners),
                          std::span(positions_).subspan(first, corners), value});
            first += corners;
        }
    }
    /// Tells values at nodes to those who have cells of this rank there, and calls take(node,
    /// value) for what they tell. Collective, one exchange.
    /// \param found values that have not been told
    template <class Take>
    void tell(std::span<const Found> found, const Take& take) const {
        if (shared_ == nullptr) return;
        Outbox box(shared_->ranks().size());
        for (const Found& each : found) {
            auto to = std::lower_bound(told_.begin(), told_.end(),
                                       std::pair(each.node, SharedNodes::all_ranks));
            for (; to != told_.end() && to->first == each.node; ++to) {
                put(to->second == SharedNodes::all_ranks ? box.to_all() : box.to(to->second), each);
            }
        }
        shared_->send(box, [&](int, Reader& in) {
            while (in.more()) {
                const auto told = in.get<Found>();
                take(told.node, told.value);
            }
        });
    }
    /// Whether it is so on any rank. Collective.
    bool any_rank(bool is) const {
        if (shared_ == nullptr) return is;
        std::uint64_t any = is ? 1 : 0;
        shared_->ranks().reduce(std::span(&any, 1), Ranks::Reduction::max);
        return any != 0;
    }
    /// Numbers that become the greatest of all ranks. Collective.
    void take_greatest(std::span<double*> numbers) const {
        if (shared_ != nullptr) engine::take_greatest(shared_->ranks(), numbers);
    }

private:
    void write(const Cell& cell, std::uint32_t number, Outbox& box) {
        std::vector<int> to;
        for (const NodeKey key : cell.keys) {
            shared_->route(std::span(&key, 1), box, [&](Bytes&, int rank) {
                if (std::find(to.begin(), to.end(), rank) == to.end()) to.push_back(rank);
            });
        }
        for (const int rank : to) {
            Bytes& out = rank == SharedNodes::all_ranks ? box.to_all() : box.to(rank);
            put(out, number);
            put(out, cell.shape);
            put(out, cell.value);
            for (const NodeKey key : cell.keys) {
                put(out, key);
                told_.emplace_back(key, rank);
            }
            for (const Point& x : cell.positions) put(out, x);
        }
    }
    /// \param is_new whether it was not read before
    void read(Reader& in, bool is_new) {
        const auto shape = in.get<Shape>();
        const auto value = in.get<double>();
        const std::size_t corners = topology(shape).corners;
        const std::size_t before = keys_.size();
        for (std::size_t k = 0; k < corners; ++k) keys_.push_back(in.get<NodeKey>());
        for (std::size_t k = 0; k < corners; ++k) positions_.push_back(in.get<Point>());
        if (is_new) return cells_.push_back({shape, value});
        keys_.resize(before);
        positions_.resize(before);
    }

    struct Known {
        Shape shape;
        double value;
    };

    const SharedNodes* shared_;
    std::vector<std::pair<NodeKey, int>> told_;  // corners of cells that other ranks know
    std::vector<Known> cells_;                   // of other ranks
    std::vector<NodeKey> keys_;                  // of their corners
    std::vector<Point> positions_;
};

}  // namespace nestgrid::engine
