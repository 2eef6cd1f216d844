// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Types of cells as VTK numbers them, and where the points of each lie: what files of solutions
// are made of. Nothing of VTK is needed.
//
// A cell of degree p has nodes on a lattice: node (i, j, k) of a quadrilateral or hexahedron lies
// at (i, j, k) / p of the reference element (shape.hpp), i first. Points of a cell are such nodes
// in an order of VTK's own: corners, inner nodes of edges, of faces, of the cell. Quadratic cells
// have the first points of a Lagrange cell of degree 2; nodes without a point are blends of those
// around, as in their own shape functions.
//
// A type that the library learns to draw is a row in the table of cell_types(), and, where its
// lattice is another one, a function like box_point().
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nestgrid/error.hpp>
#include <nestgrid/optional.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid {

/// Cells and points in plain arrays, borrowed while they are read.
struct CellArrays {
    std::span<const double> coordinates;   ///< three of each point
    std::span<const std::uint8_t> types;   ///< of each cell, by VTK's number
    std::span<const std::int64_t> first;   ///< of each cell in `points`, and the end
    std::span<const std::int64_t> points;  ///< of all cells, in VTK's order
    /// VTK's array HigherOrderDegrees: three numbers for each cell; or none.
    std::span<const double> degrees{};

    std::size_t point_count() const { return coordinates.size() / 3; }
};

/// A node of a cell: a point of the cell, or a blend of several.
struct CellNode {
    struct Part {
        std::uint16_t point;
        double weight;
    };
    std::vector<Part> parts;
};

/// What all cells of one type and number of points have in common.
struct CellKind {
    Shape shape = Shape::point;
    int degree = 1;
    std::vector<CellNode> nodes;                     ///< in the order of the lattice
    std::array<std::uint8_t, max_corners> corner{};  ///< the point at each corner of the shape
};

namespace detail {

enum class CellOrder : std::uint8_t { vtk, tensor };

/// One type of VTK.
struct CellType {
    std::uint8_t number;
    std::string_view name;
    Shape shape;  ///< point: of no shape that is drawn
    int degree;   ///< 0: as the number of points says
    int points;   ///< 0: a node each
    CellOrder order = CellOrder::vtk;
};

/// The types that are known. Those of degrees above 1 are drawn on quadrilaterals and hexahedra.
inline constexpr std::array cell_types{
    CellType{5, "triangle", Shape::triangle, 1, 3},
    CellType{8, "pixel", Shape::quadrilateral, 1, 4, CellOrder::tensor},
    CellType{9, "quadrilateral", Shape::quadrilateral, 1, 4},
    CellType{10, "tetrahedron", Shape::tetrahedron, 1, 4},
    CellType{11, "voxel", Shape::hexahedron, 1, 8, CellOrder::tensor},
    CellType{12, "hexahedron", Shape::hexahedron, 1, 8},
    CellType{13, "wedge", Shape::prism, 1, 6},
    CellType{14, "pyramid", Shape::pyramid, 1, 5},
    CellType{22, "quadratic triangle", Shape::triangle, 2, 6},
    CellType{23, "quadratic quadrilateral", Shape::quadrilateral, 2, 8},
    CellType{24, "quadratic tetrahedron", Shape::tetrahedron, 2, 10},
    CellType{25, "quadratic hexahedron", Shape::hexahedron, 2, 20},
    CellType{26, "quadratic wedge", Shape::prism, 2, 15},
    CellType{27, "quadratic pyramid", Shape::pyramid, 2, 13},
    CellType{28, "biquadratic quadrilateral", Shape::quadrilateral, 2, 9},
    CellType{29, "triquadratic hexahedron", Shape::hexahedron, 2, 27},
    CellType{32, "biquadratic quadratic wedge", Shape::prism, 2, 18},
    CellType{33, "biquadratic quadratic hexahedron", Shape::hexahedron, 2, 24},
    CellType{34, "biquadratic triangle", Shape::triangle, 2, 7},
    CellType{69, "Lagrange triangle", Shape::triangle, 0, 0},
    CellType{70, "Lagrange quadrilateral", Shape::quadrilateral, 0, 0},
    CellType{71, "Lagrange tetrahedron", Shape::tetrahedron, 0, 0},
    CellType{72, "Lagrange hexahedron", Shape::hexahedron, 0, 0},
    CellType{73, "Lagrange wedge", Shape::prism, 0, 0},
    CellType{74, "Lagrange pyramid", Shape::pyramid, 0, 0},
};

constexpr bool is_box(Shape shape) {
    return shape == Shape::quadrilateral || shape == Shape::hexahedron;
}

/// How many nodes the lattice of a shape has.
constexpr std::size_t lattice_size(Shape shape, int degree) {
    const auto n = static_cast<std::size_t>(degree) + 1;
    const std::size_t square = n * n;
    switch (shape) {
        case Shape::triangle:
            return n * (n + 1) / 2;
        case Shape::quadrilateral:
            return square;
        case Shape::tetrahedron:
            return n * (n + 1) * (n + 2) / 6;
        case Shape::prism:
            return n * n * (n + 1) / 2;
        case Shape::pyramid:
            return n * (n + 1) * (2 * n + 1) / 6;
        case Shape::hexahedron:
            return square * n;
        default:
            return 0;
    }
}

/// The place of node (i, j, k) among the points of a quadrilateral or hexahedron of degree p.
inline std::size_t box_point(std::array<int, 3> at, int p, int dimension) {
    const auto inner = [&](int d) { return at[static_cast<std::size_t>(d)] % p != 0; };
    const auto high = [&](int d) { return at[static_cast<std::size_t>(d)] == p; };
    const int m = p - 1;  // inner nodes of an edge
    const auto loop = [](bool x, bool y) { return x ? (y ? 2 : 1) : (y ? 3 : 0); };
    const int inside = int{inner(0)} + int{inner(1)} + int{dimension == 3 && inner(2)};
    const int above = dimension == 3 && high(2) ? 1 : 0;
    const auto number = [&](int base, int i, int j = 0) {
        return static_cast<std::size_t>(base + i + m * j);
    };
    if (inside == 0) return number(loop(high(0), high(1)) + 4 * above, 0);
    const int edges = dimension == 3 ? 8 : 4;  // where their nodes begin
    if (inside == 1) {
        // Edges along x and y run around the lower face, then around the upper one.
        if (inner(0)) return number(edges + m * ((high(1) ? 2 : 0) + 4 * above), at[0] - 1);
        if (inner(1)) return number(edges + m * ((high(0) ? 1 : 3) + 4 * above), at[1] - 1);
        return number(edges + m * (8 + loop(high(0), high(1))), at[2] - 1);
    }
    const int faces = edges + m * (dimension == 3 ? 12 : 4);
    if (dimension == 2) return number(faces, at[0] - 1, at[1] - 1);
    if (inside == 3) return number(faces + 6 * m * m + m * m * (at[2] - 1), at[0] - 1, at[1] - 1);
    if (!inner(0)) return number(faces + m * m * int{high(0)}, at[1] - 1, at[2] - 1);
    if (!inner(1)) return number(faces + m * m * (2 + int{high(1)}), at[0] - 1, at[2] - 1);
    return number(faces + m * m * (4 + int{high(2)}), at[0] - 1, at[1] - 1);
}

/// Node `number` of the lattice of a quadrilateral or hexahedron.
inline std::array<int, 3> box_node(std::size_t number, int p) {
    const int n = p + 1;
    const int i = static_cast<int>(number);
    return {i % n, i / n % n, i / (n * n)};
}

/// A node of a quadratic cell: a point, or, where that is left out, a blend of those around: half
/// the sum of the middles of edges less a quarter of that of the corners, on faces, and so within.
inline CellNode quadratic_node(std::array<int, 3> at, std::size_t points, int dimension) {
    const std::size_t own = box_point(at, 2, dimension);
    if (own < points) return {{{static_cast<std::uint16_t>(own), 1.0}}};
    CellNode node;
    const auto add = [&](std::array<int, 3> from, double weight) {
        for (const CellNode::Part& part : quadratic_node(from, points, dimension).parts) {
            const auto known = std::ranges::find(node.parts, part.point, &CellNode::Part::point);
            if (known == node.parts.end()) {
                node.parts.push_back({part.point, weight * part.weight});
            } else {
                known->weight += weight * part.weight;
            }
        }
    };
    // Blended from one end to the other in each direction in which the node is inside; what is
    // blended twice or thrice is taken away, or added again.
    for (int subset = 1; subset < 1 << dimension; ++subset) {
        bool fits = true;
        int count = 0;
        for (int d = 0; d < dimension; ++d) {
            if ((subset >> d & 1) == 0) continue;
            fits = fits && at[static_cast<std::size_t>(d)] == 1;
            ++count;
        }
        if (!fits) continue;
        const double weight = (count % 2 == 1 ? 1.0 : -1.0) / (1 << count);
        for (int ends = 0; ends < 1 << dimension; ++ends) {
            if ((ends & ~subset) != 0) continue;
            std::array<int, 3> from = at;
            for (int d = 0; d < dimension; ++d) {
                if ((subset >> d & 1) != 0) from[static_cast<std::size_t>(d)] = 2 * (ends >> d & 1);
            }
            add(from, weight);
        }
    }
    return node;
}

/// The point at each corner of a linear cell.
inline std::array<std::uint8_t, max_corners> corner_points(const CellType& type) {
    std::array<std::uint8_t, max_corners> corner{0, 1, 2, 3, 4, 5, 6, 7};
    if (type.order == CellOrder::tensor) return corner;
    if (is_box(type.shape) || type.shape == Shape::pyramid) std::swap(corner[2], corner[3]);
    if (type.shape == Shape::hexahedron) std::swap(corner[6], corner[7]);
    return corner;
}

inline CellKind make_kind(const CellType& type, int degree, std::size_t points) {
    CellKind kind{type.shape, degree, {}, corner_points(type)};
    if (degree == 1) {
        for (std::size_t k = 0; k < points; ++k) kind.nodes.push_back({{{kind.corner[k], 1.0}}});
        return kind;
    }
    const int dimension = topology(type.shape).dimension;
    for (std::size_t n = 0; n < lattice_size(type.shape, degree); ++n) {
        const std::array<int, 3> at = box_node(n, degree);
        if (degree == 2) {
            kind.nodes.push_back(quadratic_node(at, points, dimension));
        } else {
            const auto point = static_cast<std::uint16_t>(box_point(at, degree, dimension));
            kind.nodes.push_back({{{point, 1.0}}});
        }
    }
    return kind;
}

}  // namespace detail

/// The dimension of the first cell whose type is known, which all are to have; 3 where none is.
inline int dimension_of(const CellArrays& cells) {
    for (const std::uint8_t number : cells.types) {
        const auto type = std::ranges::find(detail::cell_types, number, &detail::CellType::number);
        if (type != detail::cell_types.end()) return topology(type->shape).dimension;
    }
    return 3;
}

/// The kinds of cells that were met.
class CellKinds {
public:
    /// The number of the kind of a cell.
    ///
    /// \throw InvalidInput for a type that is not known or not drawn, and for a number of points
    ///        that does not fit it
    std::uint16_t of(const CellArrays& cells, std::size_t cell) {
        const Key key{cells.types[cell], points_of(cells, cell)};
        const auto known = std::ranges::find(keys_, key);
        const auto number = static_cast<std::uint16_t>(known - keys_.begin());
        if (known == keys_.end()) {
            kinds_.push_back(make(cells, cell));
            keys_.push_back(key);
        }
        require_degrees(cells, cell, kinds_[number]);
        return number;
    }
    const CellKind& operator[](std::uint16_t number) const { return kinds_[number]; }

private:
    struct Key {
        std::uint8_t type;
        std::size_t points;
        bool operator==(const Key&) const = default;
    };

    static std::size_t points_of(const CellArrays& cells, std::size_t cell) {
        return static_cast<std::size_t>(cells.first[cell + 1] - cells.first[cell]);
    }
    static CellKind make(const CellArrays& cells, std::size_t cell) {
        const std::string name = "cell " + std::to_string(cell);
        const auto type =
            std::ranges::find(detail::cell_types, cells.types[cell], &detail::CellType::number);
        if (type == detail::cell_types.end()) {
            throw InvalidInput(name + " is of VTK's type " + std::to_string(cells.types[cell]) +
                               ", which is not drawn: linear, quadratic and Lagrange cells are");
        }
        const std::string described = name + ", a " + std::string(type->name) + ",";
        const std::size_t points = points_of(cells, cell);
        const auto refuse = [&](const std::string& why) {
            throw InvalidInput(described + " has " + std::to_string(points) + " points" + why);
        };
        int degree = type->degree;
        if (degree == 0) {
            degree = 1;
            while (detail::lattice_size(type->shape, degree) < points) ++degree;
            if (detail::lattice_size(type->shape, degree) != points) {
                refuse(", which no one degree has");
            }
        } else if (static_cast<int>(points) != type->points) {
            refuse(", not " + std::to_string(type->points));
        }
        if (degree > max_degree) {
            throw InvalidInput(described + " has degree " + std::to_string(degree) +
                               "; degrees to " + std::to_string(max_degree) + " are drawn");
        }
        if (degree > 1 && !detail::is_box(type->shape)) {
            throw InvalidInput(described + " has degree " + std::to_string(degree) +
                               "; degrees above 1 are drawn on quadrilaterals and hexahedra");
        }
        return detail::make_kind(*type, degree, points);
    }
    /// VTK tells degrees of Lagrange cells only.
    static void require_degrees(const CellArrays& cells, std::size_t cell, const CellKind& kind) {
        if (cells.degrees.empty() || cells.types[cell] < 69) return;
        for (std::size_t d = 0; d < topology(kind.shape).dimension; ++d) {
            if (cells.degrees[3 * cell + d] == static_cast<double>(kind.degree)) continue;
            throw InvalidInput("cell " + std::to_string(cell) +
                               " has other degrees in HigherOrderDegrees than its points make it "
                               "have: one degree in all directions is drawn");
        }
    }

    std::vector<Key> keys_;
    std::vector<CellKind> kinds_;
};

}  // namespace nestgrid
