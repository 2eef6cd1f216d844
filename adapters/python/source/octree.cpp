// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays of leaves as a forest of linear octrees (LinearOctree), sorted here.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <nestgrid/adapters/gathered_roots.hpp>
#include <nestgrid/adapters/linear_octree.hpp>
#include <nestgrid/algorithms/detail/node_means.hpp>

#include "source.hpp"

namespace nestgrid::python {

namespace {

/// A leaf in its tree, in cells of the finest level.
struct Leaf {
    std::int64_t x;
    std::int64_t y;
    std::int64_t z;
    std::int64_t level;
};

/// A place of the lattice of the finest level, over all trees.
using Place = std::array<std::int64_t, 3>;

/// A forest of which leaves may be hidden.
template <int dim>
class MaskedOctree : public LinearOctree<dim, Leaf> {
public:
    using Base = LinearOctree<dim, Leaf>;
    using Element = typename Base::Element;

    /// \param masked for each leaf of the whole array, or nothing
    MaskedOctree(CoarseGrid coarse, std::vector<std::span<const Leaf>> trees, int max_level,
                 std::span<const std::uint8_t> masked)
        : Base(std::move(coarse), std::move(trees), max_level) {
        if (masked.empty()) return;
        hidden_.push_back(0);
        for (const std::uint8_t each : masked) hidden_.push_back(hidden_.back() + (each != 0));
    }

    Hidden hidden(const Element& e) const {
        if (hidden_.empty()) return Hidden::not_at_all;
        const std::size_t count = hidden_[e.last] - hidden_[e.first];
        if (count == 0) return Hidden::not_at_all;
        return count == e.last - e.first ? Hidden::wholly : Hidden::partly;
    }

private:
    std::vector<std::size_t> hidden_;  // among the first leaves, so many
};

/// The leaves and trees of a forest, sorted as LinearOctree takes them.
template <int dim>
class Forest {
public:
    static constexpr auto size = static_cast<std::size_t>(dim);
    static constexpr std::size_t corners = std::size_t{1} << size;

    /// \throw InvalidInput for leaves outside of all trees, and for arrays that do not fit together
    explicit Forest(const OctreeArrays& arrays) : max_level_{arrays.max_level} {
        check(arrays);
        read_leaves(arrays);
        sort_leaves();
        require_tiling();
        make_coarse(arrays);
        number_corners();
        masked_.resize(arrays.masked.size());
        for (std::size_t i = 0; i < masked_.size(); ++i) masked_[i] = arrays.masked[order_[i]];
        if (arrays.values.size() == leaves_.size()) {
            mask_missing(arrays.values);
            average(arrays.values);
        } else {
            gather(arrays.values);
        }
    }

    MaskedOctree<dim> grid() const {
        std::vector<std::span<const Leaf>> trees;
        for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
            trees.push_back(std::span(leaves_).subspan(first_[t], first_[t + 1] - first_[t]));
        }
        return {coarse_, std::move(trees), max_level_, masked_};
    }
    std::span<const std::uint32_t> element_nodes() const { return nodes_; }
    std::span<const double> values() const { return values_; }
    /// Whether nodes of leaves that are not masked have no value.
    bool any_missing() const {
        return std::any_of(values_.begin(), values_.end(), [](double u) { return std::isnan(u); });
    }
    OctreeLeaves leaves() const;

private:
    static void check(const OctreeArrays& arrays);
    void read_leaves(const OctreeArrays& arrays);
    void sort_leaves();
    void require_tiling() const;
    void make_coarse(const OctreeArrays& arrays);
    void number_corners();
    void mask_missing(std::span<const double> of_leaves);
    void average(std::span<const double> of_leaves);
    void gather(std::span<const double> of_corners);

    Place corner(std::size_t leaf, std::size_t c) const {
        const std::int64_t width = std::int64_t{1} << (max_level_ - leaves_[leaf].level);
        Place p = low_[leaf];
        for (std::size_t d = 0; d < size; ++d) p[d] += (c >> d & 1U) != 0 ? width : 0;
        return p;
    }
    /// The position of a corner of a leaf, interpolated between the corners of its coarse element.
    Point position(std::size_t tree, std::size_t leaf, std::size_t c) const {
        const Point& first = coarse_.nodes[coarse_.element(tree).front()];
        const Point& last = coarse_.nodes[coarse_.element(tree).back()];
        const Place at = corner(leaf, c);
        const std::int64_t width = std::int64_t{1} << max_level_;
        Point x = first;
        for (std::size_t d = 0; d < size; ++d) {
            const std::int64_t inside = at[d] - (low_[leaf][d] >> max_level_) * width;
            x[d] = std::lerp(first[d], last[d],
                             static_cast<double>(inside) / static_cast<double>(width));
        }
        return x;
    }
    bool lies_in(const Place& x, std::size_t leaf) const {
        const std::int64_t width = std::int64_t{1} << (max_level_ - leaves_[leaf].level);
        for (std::size_t d = 0; d < size; ++d) {
            if (x[d] < low_[leaf][d] || x[d] >= low_[leaf][d] + width) return false;
        }
        return true;
    }
    std::string name_of(std::size_t leaf) const { return "leaf " + std::to_string(order_[leaf]); }

    int max_level_;
    std::vector<Leaf> leaves_;        // sorted by tree and along the Morton curve
    std::vector<Place> low_;          // of each
    std::vector<std::size_t> order_;  // its place in the arrays
    std::vector<std::size_t> tree_;   // its tree
    std::vector<std::size_t> first_;  // leaf of each tree that has leaves, and the end
    std::array<std::size_t, 3> trees_{1, 1, 1};
    CoarseGrid coarse_;
    std::vector<std::uint32_t> nodes_;  // corners of the leaves
    std::vector<double> values_;        // at the nodes
    std::vector<std::uint8_t> masked_;
};

template <int dim>
void Forest<dim>::check(const OctreeArrays& arrays) {
    const std::size_t count = arrays.leaves.size() / (size + 1);
    if (count == 0) throw InvalidInput("the octree has no leaves");
    if (count > std::size_t{1} << 28) throw InvalidInput("the octree has more than 2^28 leaves");
    if (arrays.values.size() != count && arrays.values.size() != corners * count) {
        throw InvalidInput("there are " + std::to_string(arrays.values.size()) + " values for " +
                           std::to_string(count) + " leaves: one for each, or " +
                           std::to_string(corners) + " for the corners of each, are needed");
    }
    if (!arrays.masked.empty() && arrays.masked.size() != count) {
        throw InvalidInput("the mask has " + std::to_string(arrays.masked.size()) +
                           " entries for " + std::to_string(count) + " leaves");
    }
    if (arrays.max_level < 0 || arrays.max_level > 20) {
        throw InvalidInput("max_level is " + std::to_string(arrays.max_level) + ", not 0 to 20");
    }
    std::size_t missing = 0;
    std::size_t present = 0;
    const std::size_t of_a_leaf = count == 0 ? 1 : arrays.values.size() / count;
    for (std::size_t i = 0; i < arrays.values.size(); ++i) {
        const std::size_t leaf = i / of_a_leaf;
        if (!arrays.masked.empty() && arrays.masked[leaf] != 0) continue;  // nobody looks at it
        if (std::isinf(arrays.values[i])) {
            throw InvalidInput("the value " + std::to_string(arrays.values[i]) + " of leaf " +
                               std::to_string(leaf) + " is not finite; hide such leaves by masked");
        }
        ++(std::isnan(arrays.values[i]) ? missing : present);
    }
    if (missing > 0 && present == 0) throw InvalidInput("no leaf has a value");
}

template <int dim>
void Forest<dim>::read_leaves(const OctreeArrays& arrays) {
    const std::size_t count = arrays.leaves.size() / (size + 1);
    for (std::size_t d = 0; d < size; ++d) {
        if (arrays.coordinates[d].size() < 2) {
            throw InvalidInput("the trees need at least 2 coordinates along each direction");
        }
        trees_[d] = arrays.coordinates[d].size() - 1;
    }
    const std::int64_t in_tree = (std::int64_t{1} << max_level_) - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const std::span<const std::int64_t> row = arrays.leaves.subspan(i * (size + 1), size + 1);
        Place low{0, 0, 0};
        std::size_t tree = 0;
        for (std::size_t d = size; d-- > 0;) {
            low[d] = row[d];
            const std::int64_t at = row[d] >> max_level_;
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
        const std::int64_t width = std::int64_t{1} << (max_level_ - row[size]);
        for (std::size_t d = 0; d < size; ++d) {
            if (low[d] % width == 0) continue;
            throw InvalidInput("leaf " + std::to_string(i) +
                               " is not aligned to its level: " + std::to_string(low[d]) +
                               " is no multiple of " + std::to_string(width));
        }
        low_.push_back(low);
        tree_.push_back(tree);
        leaves_.push_back({low[0] & in_tree, low[1] & in_tree, low[2] & in_tree, row[size]});
    }
}

/// The order of two places on the Morton curve.
bool before(const Place& a, const Place& b, std::size_t size) {
    std::size_t decides = size - 1;
    for (std::size_t d = size - 1; d-- > 0;) {
        const auto most = static_cast<std::uint64_t>(a[decides] ^ b[decides]);
        const auto here = static_cast<std::uint64_t>(a[d] ^ b[d]);
        if (most < here && most < (most ^ here)) decides = d;  // its highest bit is higher
    }
    return a[decides] < b[decides];
}

template <class T>
void reorder(std::vector<T>& all, const std::vector<std::size_t>& order) {
    std::vector<T> sorted(all.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = all[order[i]];
    all = std::move(sorted);
}

template <int dim>
void Forest<dim>::sort_leaves() {
    order_.resize(leaves_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
        return tree_[a] != tree_[b] ? tree_[a] < tree_[b] : before(low_[a], low_[b], size);
    });
    reorder(leaves_, order_);
    reorder(low_, order_);
    reorder(tree_, order_);
    for (std::size_t i = 0; i < tree_.size(); ++i) {
        if (i == 0 || tree_[i] != tree_[i - 1]) first_.push_back(i);
    }
    first_.push_back(tree_.size());
}

/// Leaves are sorted, so that a leaf which overlaps others lies in the one before it.
/// \throw InvalidInput in the numbering of the arrays
template <int dim>
void Forest<dim>::require_tiling() const {
    for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
        std::uint64_t filled = 0;
        for (std::size_t i = first_[t]; i < first_[t + 1]; ++i) {
            if (i > first_[t] && lies_in(low_[i], i - 1)) {
                throw InvalidInput(name_of(i) + " overlaps " + name_of(i - 1));
            }
            filled += std::uint64_t{1}
                      << size * static_cast<unsigned>(max_level_ - leaves_[i].level);
        }
        if (filled == std::uint64_t{1} << size * static_cast<unsigned>(max_level_)) continue;
        std::string place;
        for (std::size_t d = 0; d < size; ++d) {
            place += (d == 0 ? "" : ", ") + std::to_string(low_[first_[t]][d] >> max_level_);
        }
        throw InvalidInput("the leaves of the root (" + place + ") do not fill it");
    }
}

template <int dim>
void Forest<dim>::make_coarse(const OctreeArrays& arrays) {
    const auto coordinate = [&](std::size_t d, std::size_t i) {
        return d < size ? arrays.coordinates[d][i]
                        : (arrays.coordinates[d].empty() ? 0.0 : arrays.coordinates[d].front());
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
                corners_of_trees.push_back(
                    {coordinate(0, x[0]), coordinate(1, x[1]), coordinate(2, x[2])});
            }
            nodes[c] = node;
        }
        coarse_.add(dim == 2 ? Shape::quadrilateral : Shape::hexahedron, nodes);
    }
    coarse_.nodes = Coordinates(std::move(corners_of_trees));
}

template <int dim>
void Forest<dim>::number_corners() {
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
    values_.resize(node + std::size_t{1});
}

/// Masks the leaves that have no value.
template <int dim>
void Forest<dim>::mask_missing(std::span<const double> of_leaves) {
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        if (!std::isnan(of_leaves[order_[i]])) continue;
        masked_.resize(leaves_.size());
        masked_[i] = 1;
    }
}

/// Values at nodes as CellAverages has them, hidden leaves aside.
template <int dim>
void Forest<dim>::average(std::span<const double> of_leaves) {
    constexpr Shape shape = dim == 2 ? Shape::quadrilateral : Shape::hexahedron;
    const detail::NodeMeans means(dim, [&](const auto& visit) {
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
    });
    for (std::size_t node = 0; node < values_.size(); ++node) {
        const double* mean = means.find(node);
        values_[node] = mean == nullptr ? means.middle() : *mean;
    }
}

template <int dim>
void Forest<dim>::gather(std::span<const double> of_corners) {
    std::vector<bool> set(values_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (!masked_.empty() && masked_[i / corners] != 0) continue;  // nobody looks at it
        const std::uint32_t node = nodes_[i];
        const double value = of_corners[corners * order_[i / corners] + i % corners];
        const bool both_missing = std::isnan(value) && std::isnan(values_[node]);
        if (set[node] && values_[node] != value && !both_missing) {
            throw InvalidInput("corner " + std::to_string(i % corners) + " of " +
                               name_of(i / corners) + " has the value " + std::to_string(value) +
                               ", but another leaf has " + std::to_string(values_[node]) +
                               " at the same place");
        }
        set[node] = true;
        values_[node] = value;
    }
}

template <int dim>
OctreeLeaves Forest<dim>::leaves() const {
    OctreeLeaves all;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        all.leaves.insert(all.leaves.end(), low_[i].begin(), low_[i].begin() + dim);
        all.leaves.push_back(leaves_[i].level);
    }
    for (const std::uint32_t node : nodes_) all.values.push_back(values_[node]);
    all.masked = masked_;
    return all;
}

template <int dim>
class ForestSource final : public OctreeSource {
public:
    using Grid = MaskedOctree<dim>;
    using Field = LinearOctreeField<Grid, double, std::uint32_t>;

    ForestSource(const std::shared_ptr<const Forest<dim>>& forest, const Call& call)
        : OctreeSource(field_of(forest, call)), forest_{forest} {}

    OctreeLeaves leaves() const override { return forest_->leaves(); }

private:
    /// Many trees are gathered, so that a surface looks at those alone that it passes through.
    struct Kept {
        explicit Kept(const std::shared_ptr<const Forest<dim>>& from)
            : forest{from},
              grid(from->grid()),
              gathered(grid),
              field(grid, from->element_nodes(), from->values()) {}

        Kept(const Kept&) = delete;
        Kept& operator=(const Kept&) = delete;
        ~Kept() = default;

        std::shared_ptr<const Forest<dim>> forest;
        Grid grid;
        GatheredRoots<Grid> gathered;
        Field field;
    };

    static std::shared_ptr<Prerolls> field_of(const std::shared_ptr<const Forest<dim>>& forest,
                                              const Call& call) {
        const auto kept = std::make_shared<const Kept>(forest);
        const std::shared_ptr<const GatheredRoots<Grid>> grid(kept, &kept->gathered);
        const Frames one =
            shared_frames(grid, std::vector{GatheredField(*grid, kept->field)}, {0}, kept);
        return (forest->any_missing() ? one.without_missing(call.work()) : one)[0];
    }

    std::shared_ptr<const Forest<dim>> forest_;
};

template <int dim>
std::shared_ptr<OctreeSource> forest_source(const OctreeArrays& arrays, const Call& call) {
    return std::make_shared<ForestSource<dim>>(std::make_shared<const Forest<dim>>(arrays), call);
}

}  // namespace

std::shared_ptr<OctreeSource> make_octree(const OctreeArrays& arrays, const Call& call) {
    return arrays.dimension == 2 ? forest_source<2>(arrays, call) : forest_source<3>(arrays, call);
}

}  // namespace nestgrid::python
