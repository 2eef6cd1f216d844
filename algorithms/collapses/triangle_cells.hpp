// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The triangles of a block, sorted into the cells of a lattice.
#pragma once

#include <collapses/box_tree.hpp>

namespace nestgrid::engine {

class TriangleCells {
public:
    TriangleCells() = default;
    /// \param box of all triangles, \param count about how many there are
    TriangleCells(const Box& box, std::size_t count);

    /// How many times triangles were put into cells.
    std::size_t entry_count() const { return entries_.size(); }

    /// Adds a triangle, or tells where one lies that has changed.
    void add(std::uint32_t triangle, const Box& box);
    /// Calls function(triangle) once for those whose cells a box meets, or did before they changed.
    template <class Function>
    void for_each_near(const Box& box, const Function& function) {
        ++query_;
        for_each_cell(box, [&](std::size_t cell) {
            for (std::uint32_t i = first_[cell]; i != none; i = entries_[i].next) {
                const std::uint32_t triangle = entries_[i].triangle;
                if (seen_[triangle] == query_) continue;
                seen_[triangle] = query_;
                function(triangle);
            }
        });
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    struct Entry {
        std::uint32_t triangle;
        std::uint32_t next;
    };

    std::array<std::size_t, 3> cell_of(const Point& x) const;

    template <class Function>
    void for_each_cell(const Box& box, const Function& function) const {
        const auto from = cell_of(box.low);
        const auto to = cell_of(box.high);
        for (std::size_t z = from[2]; z <= to[2]; ++z) {
            for (std::size_t y = from[1]; y <= to[1]; ++y) {
                for (std::size_t x = from[0]; x <= to[0]; ++x) {
                    function((z * cells_[1] + y) * cells_[0] + x);
                }
            }
        }
    }

    Point low_{};
    double edge_ = 1;
    std::array<std::size_t, 3> cells_{};
    std::vector<std::uint32_t> first_;  // by cell: its first entry
    std::vector<Entry> entries_;
    std::vector<std::uint64_t> seen_;  // by triangle: the last query that met it
    std::uint64_t query_ = 0;
};

}  // namespace nestgrid::engine
