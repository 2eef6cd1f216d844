// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The triangles of a block, sorted into the cells of a lattice.
#pragma once

#include <distances/box_tree.hpp>

namespace nestgrid::engine {

/// A triangle with the box that it had when it was put into cells.
struct BoxedTriangle {
    std::uint32_t triangle;
    std::array<float, 3> low;
    std::array<float, 3> high;

    /// Rounds the box outwards.
    BoxedTriangle(std::uint32_t number, const Box& box);
};

class TriangleCells {
public:
    TriangleCells() = default;
    explicit TriangleCells(std::span<const BoxedTriangle> triangles);

    /// How many times triangles were put into cells.
    std::size_t entry_count() const { return sorted_.size() + added_.size(); }
    /// Adds a triangle, or tells where one lies that has changed.
    void add(const BoxedTriangle& triangle);
    /// Calls function(triangle) for those whose box meets another box, or did before they changed.
    template <class Function>
    void for_each_near(const Box& box, const Function& function) const {
        const BoxedTriangle query(0, box);
        for_each_cell(query, [&](std::size_t cell, const Index& at) {
            const auto look = [&](const BoxedTriangle& t) {
                for (std::size_t d = 0; d < 3; ++d) {
                    if (!(t.low[d] <= query.high[d] && query.low[d] <= t.high[d])) return;
                }
                // Of the cells that both boxes meet, one tells of the triangle.
                for (std::size_t d = 0; d < 3; ++d) {
                    if (cell_of(std::max(t.low[d], query.low[d]), d) != at[d]) return;
                }
                function(t.triangle);
            };
            for (std::size_t i = first_[cell]; i < first_[cell + 1]; ++i) look(sorted_[i]);
            for (std::uint32_t i = last_added_[cell]; i != none; i = added_[i].before) {
                look(added_[i].triangle);
            }
        });
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    using Index = std::array<std::size_t, 3>;
    struct Added {
        BoxedTriangle triangle;
        std::uint32_t before;  // the one that was added to the cell before it
    };

    std::size_t cell_of(float x, std::size_t axis) const {
        const float at = (x - low_[axis]) * per_edge_;
        return at > 0 ? std::min(static_cast<std::size_t>(at), cells_[axis] - 1) : 0;
    }

    template <class Function>
    void for_each_cell(const BoxedTriangle& t, const Function& function) const {
        Index from{};
        Index to{};
        for (std::size_t d = 0; d < 3; ++d) {
            from[d] = cell_of(t.low[d], d);
            to[d] = cell_of(t.high[d], d);
        }
        Index at{};
        for (at[2] = from[2]; at[2] <= to[2]; ++at[2]) {
            for (at[1] = from[1]; at[1] <= to[1]; ++at[1]) {
                const std::size_t row = (at[2] * cells_[1] + at[1]) * cells_[0];
                for (at[0] = from[0]; at[0] <= to[0]; ++at[0]) function(row + at[0], at);
            }
        }
    }

    std::array<float, 3> low_{};
    float per_edge_ = 1;
    Index cells_{};
    std::vector<std::size_t> first_;  // by cell: its first one of those sorted at first
    std::vector<BoxedTriangle> sorted_;
    std::vector<std::uint32_t> last_added_;  // by cell
    std::vector<Added> added_;
};

}  // namespace nestgrid::engine
