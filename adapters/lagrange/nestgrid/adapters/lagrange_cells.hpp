// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Types of cells as VTK numbers them, and where the points of each lie: what files of solutions
// are made of. Nothing of VTK is needed.
//
// A cell of degree p has nodes on a lattice: node (i, j, k) lies at (i, j, k) / p of the reference
// element (shape.hpp), with i + j <= p in triangles and prisms, i + j + k <= p in tetrahedra, i
// first. Points of a cell are such nodes in an order of VTK's own (lagrange_order.hpp). Quadratic
// cells have the first points of a Lagrange cell of degree 2; nodes without a point are blends of
// those around, as in their own shape functions. A pyramid has the nodes of a hexahedron whose
// upper face is collapsed to the apex: in x / (1 - z), y / (1 - z) and z its functions are those.
//
// A type that the library learns to draw is a row in the table of cell_types().
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nestgrid/adapters/lagrange_order.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/optional.hpp>

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
    LatticePlace at{};
    std::vector<Part> parts{};
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

/// The types that are known. Which shapes are drawn at degrees above 1, HighOrder says.
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
    CellType{31, "quadratic linear wedge", Shape::prism, 2, 12},
    CellType{32, "biquadratic quadratic wedge", Shape::prism, 2, 18},
    CellType{33, "biquadratic quadratic hexahedron", Shape::hexahedron, 2, 24},
    CellType{69, "Lagrange triangle", Shape::triangle, 0, 0},
    CellType{70, "Lagrange quadrilateral", Shape::quadrilateral, 0, 0},
    CellType{71, "Lagrange tetrahedron", Shape::tetrahedron, 0, 0},
    CellType{72, "Lagrange hexahedron", Shape::hexahedron, 0, 0},
    CellType{73, "Lagrange wedge", Shape::prism, 0, 0},
    CellType{74, "Lagrange pyramid", Shape::pyramid, 0, 0},
};

/// Types without a shape that is drawn, which are left out beside cells of higher dimension.
struct LowType {
    std::uint8_t number;
    int dimension;
};
inline constexpr std::array low_types{
    LowType{0, 0},  LowType{1, 0},  LowType{2, 0},                   // empty cells, points
    LowType{3, 1},  LowType{4, 1},  LowType{21, 1}, LowType{35, 1},  // lines
    LowType{68, 1}, LowType{75, 1},                                  // curves
    LowType{6, 2},  LowType{7, 2},  LowType{36, 2},                  // strips, polygons
    LowType{30, 2}, LowType{34, 2}, LowType{76, 2}, LowType{77, 2},  // other curved faces
};

/// The dimension of cells of a type; 4 where it is not known.
inline int dimension_of_type(std::uint8_t number) {
    const auto type = std::ranges::find(cell_types, number, &CellType::number);
    if (type != cell_types.end()) return topology(type->shape).dimension;
    const auto low = std::ranges::find(low_types, number, &LowType::number);
    return low == low_types.end() ? 4 : low->dimension;
}

/// A node of a quadratic cell: a point, or, where that is left out, a blend of those around it:
/// from one end to the other in each direction in which the node is inside; what is blended twice
/// is taken away, and what is blended thrice is added again. On a face that is half the sum of the
/// middles of edges less a quarter of that of the corners.
inline CellNode quadratic_node(Shape shape, const LatticePlace& at, std::size_t points) {
    const std::size_t own = lattice_point(shape, at, 2);
    if (own < points) return {at, {{static_cast<std::uint16_t>(own), 1.0}}};
    CellNode node{at, {}};
    const auto add = [&](const LatticePlace& from, double weight) {
        for (const CellNode::Part& part : quadratic_node(shape, from, points).parts) {
            const auto known = std::ranges::find(node.parts, part.point, &CellNode::Part::point);
            if (known == node.parts.end()) {
                node.parts.push_back({part.point, weight * part.weight});
            } else {
                known->weight += weight * part.weight;
            }
        }
    };
    const std::vector<std::pair<LatticePlace, LatticePlace>> ends = ends_around(shape, at);
    for (unsigned subset = 1; subset < 1U << ends.size(); ++subset) {
        const int count = std::popcount(subset);
        const double weight = (count % 2 == 1 ? 1.0 : -1.0) / (1 << count);
        for (unsigned upper = 0; upper < 1U << ends.size(); ++upper) {
            if ((upper & ~subset) != 0) continue;
            LatticePlace from = at;
            for (std::size_t i = 0; i < ends.size(); ++i) {
                if ((subset >> i & 1U) == 0) continue;
                const LatticePlace& to = (upper >> i & 1U) != 0 ? ends[i].second : ends[i].first;
                for (std::size_t d = 0; d < 3; ++d) from[d] += to[d] - at[d];
            }
            add(from, weight);
        }
    }
    return node;
}

/// The nodes of a pyramid of degree 1 or 2, of 5 or 13 points.
inline std::vector<CellNode> pyramid_nodes(int degree) {
    std::vector<CellNode> nodes;
    for (const LatticePlace& at : lattice(Shape::hexahedron, degree)) {
        CellNode& node = nodes.emplace_back(CellNode{at, {}});
        const auto [i, j, k] = at;
        if (k == degree) {
            node.parts = {{4, 1.0}};
            continue;
        }
        // Corners and middles of the base run around it, edges to the apex as the corners.
        const auto corner = [](int x, int y) {
            return x != 0 ? (y != 0 ? 2 : 1) : (y != 0 ? 3 : 0);
        };
        const auto add = [&](int point, double weight) {
            node.parts.push_back({static_cast<std::uint16_t>(point), weight});
        };
        if (i % degree == 0 && j % degree == 0) {
            add(corner(i, j) + (k == 1 ? 9 : 0), 1);
            continue;
        }
        // Inside a triangle, a square or the pyramid: all points around, each kind with one weight.
        for (int side = 0; side < 4; ++side) {
            const std::array<bool, 4> on{j == 0, i == 2, j == 2, i == 0};
            const bool in_plane = (i == 1 && j == 1) || on[static_cast<std::size_t>(side)];
            if (!in_plane) continue;
            const bool inside = i == 1 && j == 1;
            const int next = (side + 1) % 4;
            if (k == 0 && !inside) {
                add(5 + side, 1);
            } else if (k == 0) {
                add(side, -0.25);
                add(5 + side, 0.5);
            } else if (inside) {
                add(side, -0.25);
                add(5 + side, 0.25);
                add(9 + side, 0.25);
            } else {
                add(side, -0.125);
                add(next, -0.125);
                add(5 + side, 0.25);
                add(9 + side, 0.5);
                add(9 + next, 0.5);
            }
        }
    }
    return nodes;
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
    if (type.shape == Shape::pyramid) {
        kind.nodes = pyramid_nodes(degree);
        return kind;
    }
    if (degree == 1) {
        for (std::size_t k = 0; k < points; ++k) {
            kind.nodes.push_back({{}, {{kind.corner[k], 1.0}}});
        }
        return kind;
    }
    for (const LatticePlace& at : lattice(type.shape, degree)) {
        if (degree == 2) {
            kind.nodes.push_back(quadratic_node(type.shape, at, points));
        } else {
            const std::size_t point = lattice_point(type.shape, at, degree);
            kind.nodes.push_back({at, {{static_cast<std::uint16_t>(point), 1.0}}});
        }
    }
    return kind;
}

}  // namespace detail

/// The greatest dimension of a cell, 2 or 3: cells of lower ones are left out.
inline int dimension_of(const CellArrays& cells) {
    int greatest = 2;
    for (std::size_t i = 0; i < cells.types.size() && greatest == 2; ++i) {
        if (detail::dimension_of_type(cells.types[i]) > 2) greatest = 3;
    }
    return greatest;
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
        if (degree > 1 && type->shape == Shape::pyramid && type->degree == 0) {
            throw InvalidInput(described + " has degree " + std::to_string(degree) +
                               "; of pyramids linear and quadratic ones are drawn");
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
