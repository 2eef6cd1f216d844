// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the face codes of lnodes tell; included by p4est.hpp.
#pragma once

#include <bit>
#include <string>

#include <nestgrid/adapters/p4est_trees.hpp>

namespace nestgrid::detail {

/// The face codes of lnodes of degree 1.
template <int dim>
class P4estFaceCodes {
public:
    using Nodes = typename P4estTypes<dim>::Nodes;

    /// \throw InvalidInput for lnodes of another degree or another forest
    P4estFaceCodes(const Nodes* nodes, std::size_t leaf_count) : nodes_{nodes} {
        if (nodes == nullptr) throw InvalidInput("there are no lnodes");
        if (nodes->degree != 1) {
            throw InvalidInput("the lnodes have degree " + std::to_string(nodes->degree) +
                               ", not 1");
        }
        if (static_cast<std::size_t>(nodes->num_local_elements) != leaf_count) {
            throw InvalidInput("the lnodes belong to another forest: they number " +
                               std::to_string(nodes->num_local_elements) +
                               " elements, but there are " + std::to_string(leaf_count) +
                               " leaves");
        }
    }
    /// 0 where no corner of the leaf hangs.
    unsigned operator[](std::size_t leaf) const {
        return static_cast<unsigned>(nodes_->face_code[leaf]);
    }
    /// The corner of a leaf that is one of its father's too.
    static unsigned own_corner(unsigned code) { return code & (corners_ - 1); }

    /// Whether the corner hangs that lies apart from that one in some directions, one bit each.
    /// Behind the own corner, bit i of a code stands for the father's face across direction i and,
    /// in three dimensions, a later one for its edge along it.
    static bool hangs(unsigned code, unsigned apart) {
        if (code == 0 || apart == 0 || apart == corners_ - 1) return false;
        if (dim == 3 && std::has_single_bit(apart)) return (code >> 6U & apart) != 0;
        return (code >> static_cast<unsigned>(dim) & (apart ^ (corners_ - 1))) != 0;
    }

private:
    static constexpr unsigned corners_ = 1U << dim;
    const Nodes* nodes_;
};

}  // namespace nestgrid::detail
