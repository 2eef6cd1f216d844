// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the trees of a p4est or p8est connectivity share, from its topology alone.
//
// The boundary of a tree has parts: corners, edges, faces. Parts that the connectivity identifies,
// directly or through others, are one; the part of the first tree that has it is the canonical one,
// and every node on it is named by its coordinates there.
// Invariants, checked once:
//   - the corners of a tree are different nodes;
//   - a part is determined by its corners.
// Consequences: a node has one canonical name, whatever the tree it is met in, on every process;
// and the map between two trees follows from which of their corners are the same.
// Costs a few hundred bytes for each tree.
#pragma once

#include <bit>
#include <numeric>
#include <string>
#include <vector>

#include <p4est.h>
#include <p4est_bits.h>
#include <p4est_lnodes.h>
#include <p8est.h>
#include <p8est_bits.h>
#include <p8est_lnodes.h>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// The types of p4est (dim = 2) and p8est (dim = 3).
template <int dim>
struct P4estTypes {
    using Forest = p4est_t;
    using Tree = p4est_tree_t;
    using Quadrant = p4est_quadrant_t;
    using Connectivity = p4est_connectivity_t;
    using Nodes = p4est_lnodes_t;
    static constexpr int max_level = P4EST_MAXLEVEL;
    static constexpr int deepest_level = P4EST_QMAXLEVEL;

    static constexpr auto compare = p4est_quadrant_compare;
    static constexpr auto corner_across_face = p4est_connectivity_face_neighbor_corner;
    static constexpr auto& face_corners = p4est_face_corners;
};

/// The names of p8est.
template <>
struct P4estTypes<3> {
    using Forest = p8est_t;
    using Tree = p8est_tree_t;
    using Quadrant = p8est_quadrant_t;
    using Connectivity = p8est_connectivity_t;
    using Nodes = p8est_lnodes_t;
    static constexpr int max_level = P8EST_MAXLEVEL;
    static constexpr int deepest_level = P8EST_QMAXLEVEL;

    static constexpr auto compare = p8est_quadrant_compare;
    static constexpr auto corner_across_face = p8est_connectivity_face_neighbor_corner;
    static constexpr auto& face_corners = p8est_face_corners;
};

/// A node of a forest: a tree, and coordinates in it from 0 to 2^max_level.
struct P4estNode {
    std::uint32_t tree = 0;
    std::array<std::int32_t, 3> x{};
};

/// The trees of a forest with their corners and ids.
template <int dim>
class P4estTrees {
public:
    using Connectivity = typename P4estTypes<dim>::Connectivity;
    static constexpr unsigned corners = 1U << dim;
    static constexpr std::int32_t length = std::int32_t{1} << P4estTypes<dim>::max_level;

    /// \throw InvalidInput where a tree meets itself or two parts have the same corners, as in
    ///        periodic connectivities of few trees
    explicit P4estTrees(const Connectivity& connectivity)
        : count_{static_cast<std::size_t>(connectivity.num_trees)}, first_(count_ * parts_) {
        std::iota(first_.begin(), first_.end(), 0U);
        join_faces(connectivity);
        if constexpr (dim == 3) join_edges(connectivity);
        join_corners(connectivity);
        for (std::size_t i = 0; i < first_.size(); ++i) first_[i] = find(i);
        check_corners();
        for (std::size_t t = 0; t < count_; ++t) {
            for (unsigned part = 0; part < parts_; ++part) images_.push_back(image_of(t, part));
        }
        check_parts();
        first_ = {};
    }

    /// The same node in the first tree that has it.
    P4estNode canonical(const P4estNode& node) const {
        unsigned part = 0;
        for (unsigned d = dim; d-- > 0;) {
            part = 3 * part + (node.x[d] == 0 ? 0U : node.x[d] == length ? 2U : 1U);
        }
        if (part == inner_) return node;
        const Image& image = images_[node.tree * parts_ + part];
        P4estNode result{image.tree, {}};
        for (std::size_t d = 0; d < dim; ++d) {
            const unsigned from = image.from[d];
            const std::int32_t x = from < 6 ? node.x[from % 3] : 0;
            result.x[d] = from == low_ || from < 3 ? x : length - x;
        }
        return result;
    }

    /// Corner c of a tree.
    static P4estNode corner(std::size_t tree, unsigned c) {
        P4estNode node{static_cast<std::uint32_t>(tree), {}};
        for (unsigned d = 0; d < dim; ++d) node.x[d] = (c >> d & 1U) != 0 ? length : 0;
        return node;
    }
    /// Number of the corner of its tree that a node is.
    static unsigned corner_number(const P4estNode& node) {
        unsigned c = 0;
        for (unsigned d = 0; d < dim; ++d) c |= (node.x[d] != 0 ? 1U : 0U) << d;
        return c;
    }

private:
    // A part of a tree is a number of base 3: digit d is 0 or 2 at the ends of axis d, 1 between.
    static constexpr unsigned parts_ = dim == 2 ? 9 : 27;
    static constexpr unsigned inner_ = parts_ / 2;
    static constexpr std::array<unsigned, 3> power_{1, 3, 9};
    static constexpr std::uint8_t low_ = 6;
    static constexpr std::uint8_t high_ = 7;
    static constexpr int none_ = -1;
    /// Corners of one tree as those of another, or none_.
    using CornerMap = std::array<int, corners>;

    struct Image {
        std::uint32_t tree;
        /// By axis of that tree: an axis of this one, plus 3 if it runs backwards; or low_, high_.
        std::array<std::uint8_t, static_cast<std::size_t>(dim)> from;
    };

    static unsigned digit(unsigned part, unsigned d) { return part / power_[d] % 3; }
    static bool touches(unsigned part, unsigned corner) {
        for (unsigned d = 0; d < dim; ++d) {
            if (digit(part, d) != 1 && digit(part, d) / 2 != (corner >> d & 1U)) return false;
        }
        return true;
    }
    static unsigned part_of_corner(unsigned corner) {
        unsigned part = 0;
        for (unsigned d = 0; d < dim; ++d) part += 2 * (corner >> d & 1U) * power_[d];
        return part;
    }

    std::size_t find(std::size_t i) {
        while (first_[i] != i) i = first_[i] = first_[first_[i]];
        return i;
    }

    /// Joins every part of tree a whose corners are all mapped with its image in tree b.
    void join(std::size_t a, std::size_t b, const CornerMap& map) {
        for (unsigned part = 0; part < parts_; ++part) {
            unsigned ones = 0;
            unsigned zeros = 0;
            bool whole = true;
            for (unsigned c = 0; c < corners; ++c) {
                if (!touches(part, c)) continue;
                whole = whole && map[c] != none_;
                ones |= static_cast<unsigned>(map[c]);
                zeros |= ~static_cast<unsigned>(map[c]);
            }
            if (!whole) continue;
            unsigned image = 0;
            for (unsigned d = 0; d < dim; ++d) {
                const bool both = (ones >> d & zeros >> d & 1U) != 0;
                image += power_[d] * (both ? 1 : (ones >> d & 1U) * 2);
            }
            const std::size_t here = find(a * parts_ + part);
            const std::size_t there = find(b * parts_ + image);
            first_[std::max(here, there)] = std::min(here, there);
        }
    }

    void join_faces(const Connectivity& c) {
        constexpr int faces = 2 * dim;
        for (std::size_t t = 0; t < count_; ++t) {
            for (int f = 0; f < faces; ++f) {
                const std::size_t at = t * faces + static_cast<std::size_t>(f);
                const int across = c.tree_to_face[at];
                const auto other = static_cast<std::size_t>(c.tree_to_tree[at]);
                if (other == t && across == f) continue;  // on the boundary
                CornerMap map;
                map.fill(none_);
                for (const int k : P4estTypes<dim>::face_corners[f]) {
                    map[static_cast<std::size_t>(k)] =
                        P4estTypes<dim>::corner_across_face(k, f, across % faces, across / faces);
                }
                join(t, other, map);
            }
        }
    }

    void join_edges(const Connectivity& c) requires(dim == 3) {
        const auto ends = [&](p4est_topidx_t i) {
            const int edge = c.edge_to_edge[i] % P8EST_EDGES;
            std::array<int, 2> end{p8est_edge_corners[edge][0], p8est_edge_corners[edge][1]};
            if (c.edge_to_edge[i] >= P8EST_EDGES) std::swap(end[0], end[1]);
            return end;
        };
        for (p4est_topidx_t e = 0; e < c.num_edges; ++e) {
            for (auto i = c.ett_offset[e]; i + 1 < c.ett_offset[e + 1]; ++i) {
                CornerMap map;
                map.fill(none_);
                for (std::size_t k = 0; k < 2; ++k) {
                    map[static_cast<std::size_t>(ends(i)[k])] = ends(i + 1)[k];
                }
                join(static_cast<std::size_t>(c.edge_to_tree[i]),
                     static_cast<std::size_t>(c.edge_to_tree[i + 1]), map);
            }
        }
    }

    void join_corners(const Connectivity& c) {
        for (p4est_topidx_t k = 0; k < c.num_corners; ++k) {
            for (auto i = c.ctt_offset[k]; i + 1 < c.ctt_offset[k + 1]; ++i) {
                CornerMap map;
                map.fill(none_);
                map[static_cast<std::size_t>(c.corner_to_corner[i])] = c.corner_to_corner[i + 1];
                join(static_cast<std::size_t>(c.corner_to_tree[i]),
                     static_cast<std::size_t>(c.corner_to_tree[i + 1]), map);
            }
        }
    }

    std::size_t corner_class(std::size_t tree, unsigned corner) const {
        return first_[tree * parts_ + part_of_corner(corner)];
    }
    unsigned corner_of_class(std::size_t tree, std::size_t wanted) const {
        unsigned c = 0;
        while (c + 1 < corners && corner_class(tree, c) != wanted) ++c;
        return c;
    }

    Image image_of(std::size_t tree, unsigned part) const {
        const std::size_t there = first_[tree * parts_ + part] / parts_;
        Image image{static_cast<std::uint32_t>(there), {}};
        unsigned origin = 0;
        while (!touches(part, origin)) ++origin;
        const unsigned begin = corner_of_class(there, corner_class(tree, origin));
        for (unsigned d = 0; d < dim; ++d) image.from[d] = (begin >> d & 1U) != 0 ? high_ : low_;
        for (unsigned axis = 0; axis < dim; ++axis) {
            if (digit(part, axis) != 1) continue;
            const unsigned end = corner_of_class(there, corner_class(tree, origin | 1U << axis));
            const auto d = static_cast<unsigned>(std::countr_zero(begin ^ end));
            image.from[d] = static_cast<std::uint8_t>(axis + ((begin >> d & 1U) != 0 ? 3 : 0));
        }
        return image;
    }

    void check_corners() const {
        for (std::size_t t = 0; t < count_; ++t) {
            for (unsigned c = 1; c < corners; ++c) {
                if (corner_of_class(t, corner_class(t, c)) == c) continue;
                throw InvalidInput("tree " + std::to_string(t) +
                                   " has one node at two of its corners: the forest is periodic");
            }
        }
    }

    void check_parts() const {
        KeyTable<NodeKey, std::size_t> by_corners;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            const auto part = static_cast<unsigned>(i % parts_);
            if (first_[i] != i) continue;
            NodeKey sum = 0;
            for (unsigned c = 0; c < corners; ++c) {
                if (touches(part, c)) sum += detail::mix(corner_class(i / parts_, c));
            }
            const auto [other, is_new] = by_corners.insert(detail::mix(sum), i);
            if (is_new) continue;
            throw InvalidInput(
                "two different edges, faces or trees have the same corners, one in tree " +
                std::to_string(*other / parts_) + ", one in tree " + std::to_string(i / parts_) +
                ": the forest is periodic, or its connectivity must be refined");
        }
    }

    std::size_t count_;
    std::vector<std::size_t> first_;  // the first part joined with each; while it is built
    std::vector<Image> images_;
};

}  // namespace nestgrid
