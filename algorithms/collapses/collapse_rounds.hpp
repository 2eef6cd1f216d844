// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Collapses edges of a whole surface, block by block, and again with other blocks.
//
// In a round, triangles with corners in two blocks stay, and their vertices too. Everything else
// that a block changes lies in its region, so that blocks can be worked on at the same time, and
// the result does not depend on how many are. As triangles become fewer, there are fewer blocks,
// and in the last rounds a single one.
#pragma once

#include <nestgrid/algorithms/executor.hpp>

#include <collapses/block_mesh.hpp>
#include <collapses/blocks.hpp>
#include <collapses/collapse_checks.hpp>

namespace nestgrid::engine {

class CollapseRounds {
public:
    /// Borrows the rules and the surface, of which it changes vertices and triangles.
    CollapseRounds(Surface<3>& surface, const CollapseRules& rules, const Executor& executor);

    /// Lets vertices move anywhere but on borders, where they keep on the domain's boundary.
    /// \param unit of lengths, beside which colours count in units of their errors
    void keep_borders(const NearLeaves& leaves, double unit = 1);
    /// Lets vertices move on the planes of the surface.
    void keep_support();
    /// Lets attributes be colours. \param errors by attribute, which are the units of colours
    void keep_colours(std::span<const double> errors);
    /// The parts of another surface that are near to each triangle; none at first.
    std::vector<std::vector<NearPart>>& parts() { return parts_; }
    /// Fastens the vertices of a triangle for good.
    void fasten(std::size_t triangle) {
        for (const std::uint32_t v : triangles_[triangle]) vertices_[v].moves = false;
    }
    Collapsed run();
    /// Puts what is left into the surface: vertices, triangles, boundary edges, and attributes
    /// where they are colours.
    void finish();

private:
    using Corners = BlockMesh::Corners;

    void find_borders(const NearLeaves& leaves);
    void add_quadrics(double unit);
    void add_colours();
    void put_attributes();
    std::vector<Point> positions() const;
    void run_round(const Blocks& blocks, Collapsed& counts);
    void erase_gone();

    Surface<3>* surface_;
    const CollapseRules* rules_;
    const Executor* executor_;
    std::vector<CollapsingVertex> vertices_;
    std::vector<Corners> triangles_;
    std::vector<std::vector<NearPart>> parts_;  // by triangle, or empty
    std::vector<double> errors_;                // units of colours
};

/// Empties what a surface tells of the elements that it was drawn in.
inline void forget_elements(Surface<3>& surface) {
    surface.element_of.clear();
    surface.reference.clear();
    surface.elements = {};
    surface.shape_of.clear();
    surface.level_of.clear();
}

}  // namespace nestgrid::engine
