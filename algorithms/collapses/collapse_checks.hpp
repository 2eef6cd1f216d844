// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Judges collapses: each must keep the shape, what is asked for, be it the error and the sides, a
// distance, or the errors of colours, and must not let the surface cross itself. Where only colours
// are kept, the surface consists of the same points as before. BlockMesh judges whether the surface
// stays a manifold.
#pragma once

#include <nestgrid/algorithms/collapse.hpp>

#include <collapses/block_mesh.hpp>
#include <collapses/distance_check.hpp>
#include <collapses/field_check.hpp>
#include <collapses/strong_nodes.hpp>
#include <collapses/triangle_cells.hpp>

namespace nestgrid::engine {

/// The checks and limits that hold in all blocks. Borrows the checks.
struct CollapseRules {
    const FieldCheck* field;        ///< null where no error is kept
    const StrongNodes* strong;      ///< null where no sides are kept
    const DistanceCheck* distance;  ///< null where none is kept
    bool coloured;                  ///< vertices have colours, which the field check judges
    Point middle;                   ///< of the surface, from which positions in blocks are taken
    double least_cosine;
    double least_shape;

    /// Whether vertices keep on planes of the surface: nothing new can cross then.
    bool in_place() const { return coloured && distance == nullptr; }
    Triangle in_space(const Triangle& x) const {
        return {x[0] + middle, x[1] + middle, x[2] + middle};
    }
};

/// \param turn the greatest one of a triangle, in degrees
/// \param shape the least quality of one
/// \throw InvalidInput where one of them is out of range
void require_limits(double turn, double shape);

/// Why a collapse was refused; null where it was not.
using Refusal = std::size_t Collapsed::*;

class CollapseChecks {
public:
    /// \param region convex, where the block alone may change anything
    CollapseChecks(const BlockMesh& mesh, const CollapseRules& rules, const Box& region);

    /// Judges the collapse of an edge into a point.
    /// \param star of the edge
    Refusal refuse(std::uint32_t u, std::uint32_t v, const BlockMesh::Star& star,
                   const CollapsePlace& place);
    /// Tells that a collapse into a vertex was done, which refuse() was asked for last.
    /// \param mesh that of the constructor
    void note_done(const BlockMesh::Star& star, std::uint32_t vertex, BlockMesh& mesh);

private:
    using Swept = boost::container::small_vector<Tetrahedron, 24>;

    bool keeps_off_boundary(const Freedom& freedom, const BlockMesh::Star& star) const;
    bool keeps_shape(const BlockMesh::Star& star, const Point& w) const;
    bool keeps_error(const BlockMesh::Star& star, const CollapsePlace& place) const;
    bool keeps_field(const BlockMesh::Star& star, const Point& w) const;
    bool keeps_colours(const BlockMesh::Star& star, const CollapsePlace& place) const;
    bool keeps_sides(const BlockMesh::Star& star, const Point& w) const;
    bool keeps_distance(const BlockMesh::Star& star, const Point& w);
    bool keeps_domain(const BlockMesh::Star& star, const Point& w) const;
    Swept swept(const BlockMesh::Star& star, const Point& w) const;
    bool crosses_nothing(const BlockMesh::Star& star, const Point& w);
    void sort_into_cells();
    bool new_star_is_embedded(const BlockMesh::Star& star, const Point& w) const;

    const BlockMesh* mesh_;
    const CollapseRules* rules_;
    Box region_;
    std::optional<DistanceJudge> distance_;
    TriangleCells cells_;
    std::size_t most_entries_ = 0;       // of the cells, before they are made anew
    std::vector<std::uint8_t> in_star_;  // by triangle
};

}  // namespace nestgrid::engine
