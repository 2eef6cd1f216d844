// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "forest.hpp"

#include <numeric>

#include <nestgrid/algorithms/detail/node_means.hpp>

namespace nestgrid::python {

template <int dim, int factor>
Forest<dim, factor>::Forest(const OctreeArrays& arrays)
    : max_level_{arrays.max_level}, axes_{axes_of(arrays)} {
    check(arrays);
    read_leaves(arrays);
    sort_leaves();
    require_tiling();
    make_coarse(arrays);
    number_corners();
    masked_.resize(arrays.masked.size());
    for (std::size_t i = 0; i < masked_.size(); ++i) masked_[i] = arrays.masked[order_[i]];
    const auto are_of_leaves = [&](std::span<const double> values) {
        return values.size() == leaves_.size();
    };
    for (const auto& each : arrays.values) {
        if (are_of_leaves(each)) mask_missing(each);
    }
    for (const auto& each : arrays.values) {
        values_.push_back(are_of_leaves(each) ? average(each, arrays.rule) : gather(each));
    }
}

template <int dim, int factor>
bool Forest<dim, factor>::is_undivided(std::size_t leaf, int level,
                                       const std::array<int, 3>& steps) const {
    Place at = low_[leaf];
    std::size_t tree = 0;
    for (std::size_t d = size; d-- > 0;) {
        at[d] += steps[d] * width_of(level);
        const auto along = static_cast<std::int64_t>(trees_[d]);
        if (at[d] < 0 || at[d] >= along * width_of(0)) return false;
        tree = tree * trees_[d] + static_cast<std::size_t>(at[d] / width_of(0));
    }
    const auto [from, to] = std::equal_range(tree_.begin(), tree_.end(), tree);
    if (from == to) return false;
    const auto first = curve_.begin() + (from - tree_.begin());
    const auto last = curve_.begin() + (to - tree_.begin());
    const auto there = std::upper_bound(first, last, place_on_curve(at)) - curve_.begin() - 1;
    const auto found = static_cast<std::size_t>(there);
    return leaves_[found].level <= level && (masked_.empty() || masked_[found] == 0);
}

template <int dim, int factor>
void Forest<dim, factor>::check(const OctreeArrays& arrays) {
    const std::size_t count = arrays.leaves.size() / (size + 1);
    const int most_levels = factor == 2 ? 20 : 13;
    if (count == 0) throw InvalidInput("the octree has no leaves");
    if (count > std::size_t{1} << 28) throw InvalidInput("the octree has more than 2^28 leaves");
    for (const std::span<const double> values : arrays.values) {
        if (values.size() == count || values.size() == corners * count) continue;
        throw InvalidInput("there are " + std::to_string(values.size()) + " values for " +
                           std::to_string(count) + " leaves: one for each, or " +
                           std::to_string(corners) + " for the corners of each, are needed");
    }
    if (!arrays.masked.empty() && arrays.masked.size() != count) {
        throw InvalidInput("the mask has " + std::to_string(arrays.masked.size()) +
                           " entries for " + std::to_string(count) + " leaves");
    }
    if (arrays.max_level < 0 || arrays.max_level > most_levels) {
        throw InvalidInput("max_level is " + std::to_string(arrays.max_level) + ", not 0 to " +
                           std::to_string(most_levels));
    }
    std::size_t missing = 0;
    std::size_t present = 0;
    for (std::size_t f = 0; f < arrays.values.size(); ++f) {
        const std::span<const double> values = arrays.values[f];
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t leaf = i / (values.size() / count);
            if (!arrays.masked.empty() && arrays.masked[leaf] != 0) continue;  // nobody looks at it
            if (std::isinf(values[i])) {
                throw InvalidInput((f < arrays.names.size() ? arrays.names[f] + ": " : "") +
                                   "the value " + std::to_string(values[i]) + " of leaf " +
                                   std::to_string(leaf) +
                                   " is not finite; hide such leaves by masked");
            }
            ++(std::isnan(values[i]) ? missing : present);
        }
    }
    if (missing > 0 && present == 0) throw InvalidInput("no leaf has a value");
}

template <int dim, int factor>
std::array<std::size_t, 3> Forest<dim, factor>::axes_of(const OctreeArrays& arrays) {
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::stable_partition(axes.begin(), axes.end(), [&](std::size_t d) {
        return dim == 3 || arrays.coordinates[d].size() > 1;
    });
    return axes;
}

template <int dim, int factor>
void Forest<dim, factor>::read_leaves(const OctreeArrays& arrays) {
    const std::size_t count = arrays.leaves.size() / (size + 1);
    for (std::size_t d = 0; d < size; ++d) {
        const std::size_t along = arrays.coordinates[axes_[d]].size();
        if (along < 2) {
            throw InvalidInput("the trees need at least 2 coordinates along each direction");
        }
        trees_[d] = along - 1;
    }
    const std::int64_t tree_width = width_of(0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::span<const std::int64_t> row = arrays.leaves.subspan(i * (size + 1), size + 1);
        Place low{0, 0, 0};
        std::size_t tree = 0;
        for (std::size_t d = size; d-- > 0;) {
            low[d] = row[d];
            const std::int64_t at = row[d] / tree_width;
            if (row[d] < 0 || static_cast<std::size_t>(at) >= trees_[d]) {
                throw InvalidInput("leaf " + std::to_string(i) + " lies outside all trees");
            }
            tree = tree * trees_[d] + static_cast<std::size_t>(at);
        }
        if (row[size] < 0 || row[size] > max_level_) {
            throw InvalidInput("leaf " + std::to_string(i) + " has the level " +
                               std::to_string(row[size]) + ", not 0 to " +
                               std::to_string(max_level_));
        }
        const std::int64_t width = width_of(row[size]);
        for (std::size_t d = 0; d < size; ++d) {
            if (low[d] % width == 0) continue;
            throw InvalidInput("leaf " + std::to_string(i) +
                               " is not aligned to its level: " + std::to_string(low[d]) +
                               " is no multiple of " + std::to_string(width));
        }
        low_.push_back(low);
        tree_.push_back(tree);
        curve_.push_back(place_on_curve(low));
        leaves_.push_back(
            {low[0] % tree_width, low[1] % tree_width, low[2] % tree_width, row[size]});
    }
}

template <class T>
void reorder(std::vector<T>& all, const std::vector<std::size_t>& order) {
    std::vector<T> sorted(all.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = all[order[i]];
    all = std::move(sorted);
}

template <int dim, int factor>
void Forest<dim, factor>::sort_leaves() {
    order_.resize(leaves_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
        return tree_[a] != tree_[b] ? tree_[a] < tree_[b] : curve_[a] < curve_[b];
    });
    reorder(leaves_, order_);
    reorder(low_, order_);
    reorder(tree_, order_);
    reorder(curve_, order_);
    for (std::size_t i = 0; i < tree_.size(); ++i) {
        if (i == 0 || tree_[i] != tree_[i - 1]) first_.push_back(i);
    }
    first_.push_back(tree_.size());
}

/// Leaves are sorted, so that a leaf which overlaps others lies in the one before it.
/// \throw InvalidInput in the numbering of the arrays
template <int dim, int factor>
void Forest<dim, factor>::require_tiling() const {
    for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
        std::uint64_t filled = 0;
        for (std::size_t i = first_[t]; i < first_[t + 1]; ++i) {
            if (i > first_[t] && lies_in(low_[i], i - 1)) {
                throw InvalidInput(name_of(i) + " overlaps " + name_of(i - 1));
            }
            filled += Trees::cells_in(dim * (max_level_ - static_cast<int>(leaves_[i].level)));
        }
        if (filled == Trees::cells_in(dim * max_level_)) continue;
        std::string place;
        for (std::size_t d = 0; d < size; ++d) {
            place += (d == 0 ? "" : ", ") + std::to_string(low_[first_[t]][d] / width_of(0));
        }
        throw InvalidInput("the leaves of the root (" + place + ") do not fill it");
    }
}

template <int dim, int factor>
void Forest<dim, factor>::make_coarse(const OctreeArrays& arrays) {
    const auto position = [&](const std::array<std::size_t, 3>& x) {
        Point p{};
        for (std::size_t d = 0; d < 3; ++d) {
            const std::vector<double>& along = arrays.coordinates[axes_[d]];
            p[axes_[d]] = d < size ? along[x[d]] : (along.empty() ? 0.0 : along.front());
        }
        return p;
    };
    std::vector<Point> corners_of_trees;
    coarse_.dimension = dim;
    std::vector<std::uint32_t> number((trees_[0] + 1) * (trees_[1] + 1) * (trees_[2] + 1),
                                      ~std::uint32_t{0});
    for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
        const std::size_t tree = tree_[first_[t]];
        const std::array<std::size_t, 3> at{tree % trees_[0], tree / trees_[0] % trees_[1],
                                            tree / trees_[0] / trees_[1]};
        std::array<std::uint32_t, corners> nodes;
        for (std::size_t c = 0; c < corners; ++c) {
            const std::array<std::size_t, 3> x{at[0] + (c & 1U), at[1] + (c >> 1U & 1U),
                                               at[2] + (c >> 2U & 1U)};
            std::uint32_t& node = number[x[0] + (trees_[0] + 1) * (x[1] + (trees_[1] + 1) * x[2])];
            if (node == ~std::uint32_t{0}) {
                node = static_cast<std::uint32_t>(corners_of_trees.size());
                corners_of_trees.push_back(position(x));
            }
            nodes[c] = node;
        }
        coarse_.add(dim == 2 ? Shape::quadrilateral : Shape::hexahedron, nodes);
    }
    coarse_.nodes = Coordinates(std::move(corners_of_trees));
}

template <int dim, int factor>
void Forest<dim, factor>::number_corners() {
    std::vector<std::size_t> all(corners * leaves_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto key = [&](std::size_t i) {
        const Place p = corner(i / corners, i % corners);
        return std::array{p[2], p[1], p[0]};
    };
    std::sort(all.begin(), all.end(),
              [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    nodes_.resize(all.size());
    std::uint32_t node = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i > 0 && key(all[i]) != key(all[i - 1])) ++node;
        nodes_[all[i]] = node;
    }
    node_count_ = node + std::size_t{1};
}

/// Masks the leaves that have no value.
template <int dim, int factor>
void Forest<dim, factor>::mask_missing(std::span<const double> of_leaves) {
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        if (!std::isnan(of_leaves[order_[i]])) continue;
        masked_.resize(leaves_.size());
        masked_[i] = 1;
    }
}

/// Values at nodes as CellAverages has them, hidden leaves aside.
template <int dim, int factor>
std::vector<double> Forest<dim, factor>::average(std::span<const double> of_leaves,
                                                 CellRule rule) const {
    constexpr Shape shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;
    const detail::ForEachCell for_each_cell = [&](const auto& visit) {
        std::array<NodeKey, corners> keys;
        std::array<Point, corners> positions;
        for (std::size_t i = 0, tree = 0; i < leaves_.size(); ++i) {
            if (i == first_[tree + 1]) ++tree;
            if (!masked_.empty() && masked_[i] != 0) continue;
            for (std::size_t c = 0; c < corners; ++c) {
                keys[c] = nodes_[corners * i + c];
                positions[c] = position(tree, i, c);
            }
            visit({shape, keys, positions, of_leaves[order_[i]]});
        }
    };
    detail::NodeMeans means(dim, for_each_cell);
    if (rule != CellRule::smooth) {
        means.sharpen(dim, for_each_cell, rule == CellRule::sharp_centres ? 1.0 / 2 : 2.0 / 3);
    }
    std::vector<double> values(node_count_);
    for (std::size_t node = 0; node < values.size(); ++node) {
        const double* mean = means.find(node);
        values[node] = mean == nullptr ? means.middle() : *mean;
    }
    return values;
}

template <int dim, int factor>
std::vector<double> Forest<dim, factor>::gather(std::span<const double> of_corners) const {
    std::vector<double> values(node_count_);
    std::vector<bool> set(node_count_);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (!masked_.empty() && masked_[i / corners] != 0) continue;  // nobody looks at it
        const std::uint32_t node = nodes_[i];
        const double value = of_corners[corners * order_[i / corners] + i % corners];
        const bool both_missing = std::isnan(value) && std::isnan(values[node]);
        if (set[node] && values[node] != value && !both_missing) {
            throw InvalidInput("corner " + std::to_string(i % corners) + " of " +
                               name_of(i / corners) + " has the value " + std::to_string(value) +
                               ", but another leaf has " + std::to_string(values[node]) +
                               " at the same place");
        }
        set[node] = true;
        values[node] = value;
    }
    return values;
}

template <int dim, int factor>
OctreeLeaves Forest<dim, factor>::leaves() const {
    OctreeLeaves all;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        all.leaves.insert(all.leaves.end(), low_[i].begin(), low_[i].begin() + dim);
        all.leaves.push_back(leaves_[i].level);
    }
    for (const std::vector<double>& frame : values_) {
        std::vector<double>& values = all.values.emplace_back();
        for (const std::uint32_t node : nodes_) values.push_back(frame[node]);
    }
    all.masked = masked_;
    return all;
}

template class Forest<2, 2>;
template class Forest<2, 3>;
template class Forest<3, 2>;
template class Forest<3, 3>;

}  // namespace nestgrid::python
