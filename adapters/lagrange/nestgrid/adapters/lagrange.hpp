// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A conforming mesh of linear, quadratic or Lagrange cells, as files of solutions keep it, and a
// field that is a polynomial in each cell.
//
//     const LagrangeGrid<3> grid(arrays);
//     const LagrangeField<3> field(grid, values);
//     const HighOrder data(grid, field);                       (high_order.hpp)
//
// Cells may share points or have their own: corners at one place are one node, up to the rounding
// of single precision. So the two sides of a slit are one. Cells whose nodes lie elsewhere than
// between the corners are curved: their points are where the same polynomials put them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/adapters/lagrange_faces.hpp>
#include <nestgrid/adapters/lagrange_nodes.hpp>
#include <nestgrid/adapters/lagrange_polynomials.hpp>
#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/grid.hpp>

namespace nestgrid {

/// Cells that their corners alone do not place.
struct CurvedCells {
    std::size_t count = 0;
    double distance = 0;  ///< the greatest of a node from where the corners put it
};

/// Cells without a hierarchy: each is a leaf. Copies what it needs.
template <int dim>
class LagrangeGrid {
public:
    using Element = std::uint32_t;
    static constexpr int dimension = dim;

    /// Leaves out cells of a lower dimension, as the faces and edges beside cells in space.
    /// \throw InvalidInput as CellKinds::of(), for cells of a higher dimension, for points that are
    ///        not there or not finite, for flat cells, and where a face of one cell is divided on
    ///        its other side; with the number of the cell or of the point
    explicit LagrangeGrid(const CellArrays& cells);

    std::size_t coarse_count() const { return kind_.size(); }
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> cell{static_cast<Element>(i), mesh_.shapes[i], mesh_.positions(i)};
        std::ranges::copy(mesh_.element(i), cell.ids.begin());
        cell.orientation = mirrored_[i] ? std::int8_t{-1} : std::int8_t{1};
        return cell;
    }
    const Rule* split(Element) const { return nullptr; }
    void children(Element, std::span<Element> out) const { std::ranges::fill(out, 0U); }
    bool conforming() const { return true; }
    /// Curved leaves are told where there are any.
    bool offers(Feature feature) const {
        return feature != Feature::geometry_degree || curved_.count > 0;
    }
    int geometry_degree(Element cell) const { return is_curved_[cell] ? kind(cell).degree : 1; }
    void map(Element cell, std::span<const Point> reference, std::span<Point> out) const;

    std::size_t vertex_count() const { return mesh_.nodes.size(); }
    std::size_t point_count() const { return point_count_; }
    int greatest_degree() const { return greatest_degree_; }
    const CurvedCells& curved() const { return curved_; }
    std::size_t left_out() const { return left_out_; }
    const CellKind& kind(Element cell) const { return kinds_[kind_[cell]]; }
    /// The points of a cell, in VTK's order.
    std::span<const std::uint32_t> points(Element cell) const {
        return {points_.data() + first_[cell], points_.data() + first_[cell + 1]};
    }
    /// The nodes at its corners.
    std::span<const std::uint32_t> nodes(Element cell) const { return mesh_.element(cell); }

private:
    void copy(const CellArrays& cells);
    void merge_corners(const CellArrays& cells);
    bool look_at_places(const CellArrays& cells, Element cell);
    bool is_mirrored(Element cell) const;
    std::vector<Point> lattice_places(Element cell) const;

    CellKinds kinds_;
    std::vector<std::uint16_t> kind_;   // of each cell
    std::vector<std::size_t> numbers_;  // of each cell in the arrays
    std::size_t left_out_ = 0;
    std::vector<std::uint32_t> points_;
    std::vector<std::size_t> first_{0};
    CoarseGrid mesh_;
    std::vector<bool> mirrored_;
    std::vector<bool> is_curved_;
    std::vector<Point> place_;  // of the points, where cells are curved
    std::size_t point_count_ = 0;
    int greatest_degree_ = 1;
    CurvedCells curved_;
    double rounding_ = 0;  // of places
};

/// Values at the nodes of a mesh whose cells are all linear: where points with one node have
/// several values, their mean.
template <int dim>
class LagrangeCornerField {
public:
    using Grid = LagrangeGrid<dim>;
    using Element = std::uint32_t;
    using value_type = double;

    /// \param values of the points, one each
    LagrangeCornerField(const Grid& grid, std::span<const double> values);

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto nodes = grid_->nodes(static_cast<std::uint32_t>(i));
        for (std::size_t k = 0; k < nodes.size(); ++k) out[k] = mean_[nodes[k]];
        return 0;
    }
    NodeMask new_values(std::uint32_t, NodeMask, std::span<double> out) const {
        std::ranges::fill(out, 0.0);
        return ~NodeMask{0};
    }
    /// How far a value is from the mean at most.
    double jump() const { return jump_; }

private:
    const Grid* grid_;
    std::vector<double> mean_;
    double jump_ = 0;
};

/// The polynomials of all cells, from values at their points. Borrows the values.
template <int dim>
class LagrangeField {
public:
    using Grid = LagrangeGrid<dim>;
    using Element = std::uint32_t;
    using value_type = double;

    LagrangeField(const Grid& grid, std::span<const double> values)
        : grid_{&grid}, values_{values} {}

    /// Values of the cell's own polynomial at its corners: cells may disagree about a node.
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto cell = static_cast<std::uint32_t>(i);
        const auto points = grid_->points(cell);
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k] = values_[points[grid_->kind(cell).corner[k]]];
        }
        return 0;
    }
    NodeMask new_values(std::uint32_t, NodeMask, std::span<double> out) const {
        std::ranges::fill(out, 0.0);
        return ~NodeMask{0};
    }
    int degree(std::uint32_t cell) const { return grid_->kind(cell).degree; }
    void evaluate(std::uint32_t cell, std::span<const Point> reference,
                  std::span<double> out) const;

private:
    const Grid* grid_;
    std::span<const double> values_;
};

/// \throw InvalidInput where there is not one finite value for each point
inline void require_point_values(std::span<const double> values, std::size_t points,
                                 const std::string& name) {
    if (values.size() != points) {
        throw InvalidInput("'" + name + "' has " + std::to_string(values.size()) + " values for " +
                           std::to_string(points) + " points");
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isfinite(values[i])) continue;
        throw InvalidInput("'" + name + "' is not a finite number at point " + std::to_string(i));
    }
}

namespace detail {

inline Point place_of(const CellArrays& cells, std::uint32_t point) {
    const std::span<const double> x = cells.coordinates.subspan(std::size_t{3} * point, 3);
    return {x[0], x[1], x[2]};
}

}  // namespace detail

template <int dim>
LagrangeGrid<dim>::LagrangeGrid(const CellArrays& cells) : point_count_{cells.point_count()} {
    if (cells.types.empty()) throw InvalidInput("there are no cells");
    copy(cells);
    if (kind_.empty()) {
        throw InvalidInput("there are no cells of dimension " + std::to_string(dim));
    }
    merge_corners(cells);
    for (Element cell = 0; cell < kind_.size(); ++cell) {
        mirrored_.push_back(is_mirrored(cell));
        is_curved_.push_back(kind(cell).degree > 1 && look_at_places(cells, cell));
    }
    for (std::size_t i = 0; curved_.count > 0 && i < point_count_; ++i) {
        place_.push_back(detail::place_of(cells, static_cast<std::uint32_t>(i)));
    }
    detail::HangingFaces(mesh_, numbers_, 2 * rounding_).check();
}

/// Takes the kinds and the points of all cells.
template <int dim>
void LagrangeGrid<dim>::copy(const CellArrays& cells) {
    for (std::size_t i = 0; i < cells.coordinates.size(); ++i) {
        if (std::isfinite(cells.coordinates[i])) continue;
        throw InvalidInput("point " + std::to_string(i / 3) +
                           " has a coordinate that is not a finite number");
    }
    points_.reserve(cells.points.size());
    for (std::size_t i = 0; i < cells.types.size(); ++i) {
        if (detail::dimension_of_type(cells.types[i]) < dim) {
            ++left_out_;
            continue;
        }
        kind_.push_back(kinds_.of(cells, i));
        numbers_.push_back(i);
        const CellKind& kind = kinds_[kind_.back()];
        if (topology(kind.shape).dimension != dim) {
            throw InvalidInput("cell " + std::to_string(i) + " is a " +
                               std::string(topology(kind.shape).name) +
                               " among cells of dimension " + std::to_string(dim));
        }
        greatest_degree_ = std::max(greatest_degree_, kind.degree);
        for (std::int64_t at = cells.first[i]; at < cells.first[i + 1]; ++at) {
            const std::int64_t point = cells.points[static_cast<std::size_t>(at)];
            if (point < 0 || point >= static_cast<std::int64_t>(point_count_)) {
                throw InvalidInput("cell " + std::to_string(i) + " names the point " +
                                   std::to_string(point) + ", but there are " +
                                   std::to_string(point_count_));
            }
            points_.push_back(static_cast<std::uint32_t>(point));
        }
        first_.push_back(points_.size());
    }
}

/// Makes the mesh of corners. Nodes are as near as single precision rounds, and a hundredth of the
/// shortest edge at most.
template <int dim>
void LagrangeGrid<dim>::merge_corners(const CellArrays& cells) {
    double size = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (Element cell = 0; cell < kind_.size(); ++cell) {
        const Topology& shape = topology(kind(cell).shape);
        const auto corner = [&](std::size_t k) {
            return detail::place_of(cells, points(cell)[kind(cell).corner[k]]);
        };
        for (std::size_t e = 0; e < shape.edges; ++e) {
            const Point a = corner(shape.edge[e][0]);
            shortest = std::min(shortest, norm(corner(shape.edge[e][1]) - a));
            for (const double x : a) size = std::max(size, std::abs(x));
        }
    }
    if (!(shortest > 0)) throw InvalidInput("a cell has two corners at one place");
    rounding_ = std::min(2e-6 * size, 0.01 * shortest);
    detail::NodeMerger nodes(rounding_);
    std::vector<std::uint32_t> corners;
    mesh_.dimension = dim;
    for (Element cell = 0; cell < kind_.size(); ++cell) {
        const Shape shape = kind(cell).shape;
        corners.clear();
        for (std::size_t k = 0; k < topology(shape).corners; ++k) {
            const std::uint32_t point = points(cell)[kind(cell).corner[k]];
            corners.push_back(nodes.number(detail::place_of(cells, point)));
        }
        mesh_.add(shape, corners);
    }
    mesh_.nodes = Coordinates(nodes.take());
}

/// Whether the corners of a cell are numbered as in a mirror. Surfaces in space have no sides.
template <int dim>
bool LagrangeGrid<dim>::is_mirrored(Element cell) const {
    const auto x = mesh_.positions(cell);
    const Point across = measure_vector(mesh_.shapes[cell], x);
    double size = 0;
    for (std::size_t k = 1; k < nodes(cell).size(); ++k) size = std::max(size, norm(x[k] - x[0]));
    const double measure = dim == 3 ? across[2] : norm(across);
    if (!(std::abs(measure) > 1e-14 * std::pow(size, dim))) {
        throw InvalidInput("cell " + std::to_string(numbers_[cell]) + " is flat");
    }
    return (dim == 3 || (across[0] == 0 && across[1] == 0)) && across[2] < 0;
}

/// Whether the nodes of a cell lie elsewhere than its corners put them.
template <int dim>
bool LagrangeGrid<dim>::look_at_places(const CellArrays& cells, Element cell) {
    const CellKind& kind = this->kind(cell);
    const auto corners = mesh_.positions(cell);
    double off = 0;
    for (std::size_t n = 0; n < kind.nodes.size(); ++n) {
        Point x{0, 0, 0};
        for (const CellNode::Part& part : kind.nodes[n].parts) {
            x = x + part.weight * detail::place_of(cells, points(cell)[part.point]);
        }
        const auto [i, j, k] = kind.nodes[n].at;
        const double p = kind.degree;
        const double width = kind.shape == Shape::pyramid ? 1 - k / p : 1;
        const auto straight = detail::lattice_polynomial<Point>(
            kind.shape, 1, {i / p * width, j / p * width, k / p}, [&](std::size_t c) {
                return corners[std::min(c, topology(kind.shape).corners - std::size_t{1})];
            });
        off = std::max(off, norm(x - straight));
    }
    if (off <= 4 * rounding_) return false;
    ++curved_.count;
    curved_.distance = std::max(curved_.distance, off);
    return true;
}

/// Places of the lattice of a cell. Corners are those of the nodes.
template <int dim>
std::vector<Point> LagrangeGrid<dim>::lattice_places(Element cell) const {
    const CellKind& kind = this->kind(cell);
    const auto corners = mesh_.positions(cell);
    const auto end = kind.corner.begin() + topology(kind.shape).corners;
    std::vector<Point> places;
    for (const CellNode& node : kind.nodes) {
        Point x{0, 0, 0};
        for (const CellNode::Part& part : node.parts) {
            x = x + part.weight * place_[points(cell)[part.point]];
        }
        const auto corner = std::find(kind.corner.begin(), end, node.parts[0].point);
        if (node.parts.size() == 1 && corner != end) {
            x = corners[static_cast<std::size_t>(corner - kind.corner.begin())];
        }
        places.push_back(x);
    }
    return places;
}

template <int dim>
void LagrangeGrid<dim>::map(Element cell, std::span<const Point> reference,
                            std::span<Point> out) const {
    const CellKind& kind = this->kind(cell);
    const auto corners = mesh_.positions(cell);
    const std::vector<Point> lattice =
        is_curved_[cell] ? lattice_places(cell) : std::vector<Point>();
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = detail::lattice_polynomial<Point>(
            kind.shape, is_curved_[cell] ? kind.degree : 1, reference[i], [&](std::size_t n) {
                if (is_curved_[cell]) return lattice[n];
                return corners[std::min(n, topology(kind.shape).corners - std::size_t{1})];
            });
    }
}

template <int dim>
LagrangeCornerField<dim>::LagrangeCornerField(const Grid& grid, std::span<const double> values)
    : grid_{&grid}, mean_(grid.vertex_count()) {
    std::vector<std::uint32_t> count(grid.vertex_count());
    const auto for_each = [&](const auto& function) {
        for (std::uint32_t cell = 0; cell < grid.coarse_count(); ++cell) {
            const auto nodes = grid.nodes(cell);
            for (std::size_t k = 0; k < nodes.size(); ++k) {
                function(nodes[k], values[grid.points(cell)[grid.kind(cell).corner[k]]]);
            }
        }
    };
    // The first value, and how far the others are from it: equal ones keep their bits.
    std::vector<double> first(grid.vertex_count());
    for_each([&](std::uint32_t node, double value) {
        if (count[node]++ == 0) first[node] = value;
        mean_[node] += value - first[node];
    });
    for (std::size_t n = 0; n < mean_.size(); ++n) mean_[n] = first[n] + mean_[n] / count[n];
    for_each([&](std::uint32_t node, double value) {
        jump_ = std::max(jump_, std::abs(value - mean_[node]));
    });
}

template <int dim>
void LagrangeField<dim>::evaluate(std::uint32_t cell, std::span<const Point> reference,
                                  std::span<double> out) const {
    const CellKind& kind = grid_->kind(cell);
    const auto points = grid_->points(cell);
    std::vector<double> lattice(kind.nodes.size());
    for (std::size_t n = 0; n < lattice.size(); ++n) {
        for (const CellNode::Part& part : kind.nodes[n].parts) {
            lattice[n] += part.weight * values_[points[part.point]];
        }
    }
    for (std::size_t i = 0; i < reference.size(); ++i) {
        out[i] = detail::lattice_polynomial<double>(kind.shape, kind.degree, reference[i],
                                                    [&](std::size_t n) { return lattice[n]; });
    }
}

}  // namespace nestgrid
