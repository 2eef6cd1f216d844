// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays of leaves of trees that are divided by two or three, sorted, with the values at nodes.
#pragma once

#include <algorithm>
#include <cmath>

#include <nestgrid/adapters/linear_octree.hpp>

#include "source.hpp"

namespace nestgrid::python {

/// A leaf in its tree, in cells of the finest level.
struct Leaf {
    std::int64_t x;
    std::int64_t y;
    std::int64_t z;
    std::int64_t level;
};

/// A place of the lattice of the finest level, over all trees.
using Place = std::array<std::int64_t, 3>;

/// The leaves and trees of a forest, sorted as LinearOctree takes them.
template <int dim, int factor>
class Forest {
public:
    static constexpr auto size = static_cast<std::size_t>(dim);
    static constexpr std::size_t corners = std::size_t{1} << size;
    using Trees = LinearOctree<dim, Leaf, factor>;

    /// \throw InvalidInput for leaves outside of all trees, and for arrays that do not fit together
    explicit Forest(const OctreeArrays& arrays);

    /// Borrows the leaves.
    Trees trees() const {
        std::vector<std::span<const Leaf>> trees;
        for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
            trees.push_back(std::span(leaves_).subspan(first_[t], first_[t + 1] - first_[t]));
        }
        return {coarse_, std::move(trees), max_level_};
    }
    std::span<const std::uint32_t> element_nodes() const { return nodes_; }
    /// At the nodes, for each frame.
    const std::vector<std::vector<double>>& values() const { return values_; }
    /// Of each leaf, or nothing.
    std::span<const std::uint8_t> masked() const { return masked_; }
    /// Whether nodes of leaves that are not masked have no value.
    bool any_missing() const {
        return std::any_of(values_.begin(), values_.end(), [](const std::vector<double>& frame) {
            return std::any_of(frame.begin(), frame.end(), [](double u) { return std::isnan(u); });
        });
    }
    /// Whether a leaf that is not masked fills the place of an element.
    /// \param leaf the first one of another element of this level
    /// \param steps to it, as long as the element along each direction
    bool is_undivided(std::size_t leaf, int level, const std::array<int, 3>& steps) const;
    OctreeLeaves leaves() const;

private:
    static void check(const OctreeArrays& arrays);
    /// The directions in space along which the leaves run.
    static std::array<std::size_t, 3> axes_of(const OctreeArrays& arrays);
    void read_leaves(const OctreeArrays& arrays);
    void sort_leaves();
    void require_tiling() const;
    void make_coarse(const OctreeArrays& arrays);
    void number_corners();
    void mask_missing(std::span<const double> of_leaves);
    std::vector<double> average(std::span<const double> of_leaves, CellRule rule) const;
    std::vector<double> gather(std::span<const double> of_corners) const;

    /// Finest cells along a side of a leaf of a level.
    std::int64_t width_of(std::int64_t level) const {
        return static_cast<std::int64_t>(Trees::cells_in(max_level_ - static_cast<int>(level)));
    }
    /// How many finest cells of a tree come before one of them, along the curve of the leaves.
    std::uint64_t place_on_curve(Place x) const {
        std::uint64_t place = 0;
        std::uint64_t cells = 1;
        for (int level = max_level_; level-- > 0;) {
            for (std::size_t d = 0; d < size; ++d, cells *= factor) {
                place += cells * static_cast<std::uint64_t>(x[d] % factor);
                x[d] /= factor;
            }
        }
        return place;
    }

    Place corner(std::size_t leaf, std::size_t c) const {
        const std::int64_t width = width_of(leaves_[leaf].level);
        Place p = low_[leaf];
        for (std::size_t d = 0; d < size; ++d) p[d] += (c >> d & 1U) != 0 ? width : 0;
        return p;
    }
    /// The position of a corner of a leaf, interpolated between the corners of its coarse element.
    Point position(std::size_t tree, std::size_t leaf, std::size_t c) const {
        const Point& first = coarse_.nodes[coarse_.element(tree).front()];
        const Point& last = coarse_.nodes[coarse_.element(tree).back()];
        const Place at = corner(leaf, c);
        const std::int64_t width = width_of(0);
        Point x = first;
        for (std::size_t d = 0; d < size; ++d) {
            const std::int64_t inside = at[d] - low_[leaf][d] / width * width;
            const std::size_t along = axes_[d];
            x[along] = std::lerp(first[along], last[along],
                                 static_cast<double>(inside) / static_cast<double>(width));
        }
        return x;
    }
    bool lies_in(const Place& x, std::size_t leaf) const {
        const std::int64_t width = width_of(leaves_[leaf].level);
        for (std::size_t d = 0; d < size; ++d) {
            if (x[d] < low_[leaf][d] || x[d] >= low_[leaf][d] + width) return false;
        }
        return true;
    }
    std::string name_of(std::size_t leaf) const { return "leaf " + std::to_string(order_[leaf]); }

    int max_level_;
    std::array<std::size_t, 3> axes_;
    std::vector<Leaf> leaves_;          // sorted by tree and along the curve
    std::vector<Place> low_;            // of each
    std::vector<std::size_t> order_;    // its place in the arrays
    std::vector<std::size_t> tree_;     // its tree
    std::vector<std::uint64_t> curve_;  // its place on the curve in its tree
    std::vector<std::size_t> first_;    // leaf of each tree that has leaves, and the end
    std::array<std::size_t, 3> trees_{1, 1, 1};
    CoarseGrid coarse_;
    std::vector<std::uint32_t> nodes_;  // corners of the leaves
    std::size_t node_count_ = 0;
    std::vector<std::vector<double>> values_;  // at the nodes, for each frame
    std::vector<std::uint8_t> masked_;
};

}  // namespace nestgrid::python
