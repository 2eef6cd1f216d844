// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients of data of cells at nodes, by differences of numbers on a lattice around the node. The
// lattice has two layers of cubes as large as the largest leaf at the node. A cube that is a leaf
// has the number of it, and one of finer leaves the mean of those around its middle. The number of
// a cube is that of the function in its middle plus half a moment times the Laplacian, and moments
// are known. So, where levels meet, the Laplacian is estimated, and what the moments add is taken
// off: quadratic functions keep their gradients. Included by block_fields.hpp.
#pragma once

namespace nestgrid {

template <int dim, class Real>
class BlockCells<dim, Real>::Lattice {
public:
    /// \param middle a node, which does not hang
    Lattice(const BlockCells& cells, const Place& middle, const Around& around)
        : cells_{&cells}, middle_{middle}, around_{around} {
        for (const BlockCell<dim>& cell : around_) {
            if (cell.box >= 0) edge_ = std::max(edge_, extent_of(cell));
        }
    }

    /// The gradient per finest step; not finite where numbers are missing.
    std::array<double, size_> slope() {
        std::array<Number, size_> slope;
        bool is_even = true;  // all numbers stand for the same, but for their places
        for (std::size_t d = 0; d < size_; ++d) {
            slope[d] = over_rows(d, &Lattice::slope_along);
            is_even = is_even && slope[d].moment == 0;
        }
        const double half = is_even ? 0 : laplacian() / 2;
        std::array<double, size_> result{};
        for (std::size_t d = 0; d < size_; ++d) {
            result[d] = slope[d].value - half * slope[d].moment;
        }
        return result;
    }

private:
    /// The number of a cube of cells, or a sum of such numbers with factors.
    struct Number {
        double value = std::numeric_limits<double>::quiet_NaN();
        double moment = 0;  ///< how much of half the Laplacian is in it

        bool is_here() const { return std::isfinite(value); }
        friend Number operator+(const Number& a, const Number& b) {
            return {a.value + b.value, a.moment + b.moment};
        }
        friend Number operator*(double factor, const Number& a) {
            return {factor * a.value, factor * a.moment};
        }
    };

    std::int32_t extent_of(const BlockCell<dim>& cell) const {
        return cells_->reader_.grid().extent(static_cast<std::size_t>(cell.level));
    }
    double number_of(const BlockCell<dim>& cell) const {
        if (!cells_->reader_.has(cell)) return std::numeric_limits<double>::quiet_NaN();
        return static_cast<double>(cells_->reader_.read(cell));
    }
    /// \param cube from -2 to 1 in each direction: 0 and -1 touch the node
    const Number& number(const Place& cube) {
        std::size_t at = 0;
        for (const std::int32_t x : cube) at = 4 * at + static_cast<std::size_t>(x + 2);
        if ((read_ >> at & 1U) == 0) numbers_[at] = read(cube);
        read_ |= std::uint64_t{1} << at;
        return numbers_[at];
    }
    Number read(const Place& cube) const {
        const BlockGrid<dim>& grid = cells_->reader_.grid();
        const Place end = grid.finest_size();
        Place low = middle_;
        std::size_t corner = 0;  // of the node, near the cube
        for (std::size_t d = 0; d < size_; ++d) {
            low[d] += cube[d] * edge_;
            if (low[d] < 0 || low[d] >= end[d]) return {};
            corner |= cube[d] >= 0 ? std::size_t{1} << d : 0;
        }
        BlockCell<dim> leaf = around_[corner];
        if (extent_of(leaf) != edge_ || leaf.low != low) leaf = grid.leaf_at(low, leaf);
        const double own = cells_->rule_ == CellRule::sharp_means ? edge_ * edge_ / 12.0 : 0;
        if (extent_of(leaf) == edge_) return {number_of(leaf), own};
        if (extent_of(leaf) > edge_) return {};
        Place middle = low;
        for (std::int32_t& x : middle) x += edge_ / 2;
        const Around around = grid.leaves_around(middle, leaf);
        double sum = 0;
        double inverses = 0;
        for (const BlockCell<dim>& cell : around) {
            sum += extent_of(cell);
            inverses += 1.0 / extent_of(cell);
        }
        // Leaves reach from the middle in all directions, by weights 1/size.
        const double moment = sum / inverses / 4;
        const double value =
            cells_->mean(around, [&](const BlockCell<dim>& cell) { return number_of(cell); }).value;
        return {value, cells_->rule_ == CellRule::sharp_means ? moment * 4 / 3 : moment};
    }

    /// The numbers of four cubes in a row.
    using Row = std::array<Number, 4>;

    Number slope_along(const Row& row) const {
        const double per_step = 1.0 / edge_;
        if (row[1].is_here() && row[2].is_here()) return per_step * (row[2] + -1 * row[1]);
        // At walls from one side.
        return per_step * (row[2].is_here() ? row[3] + -1 * row[2] : row[1] + -1 * row[0]);
    }
    Number bend_along(const Row& row) const {
        const double per_step = 1.0 / edge_;
        return per_step * per_step / 2 * (row[0] + row[3] + -1 * (row[1] + row[2]));
    }
    /// The mean over the rows along a direction that have all numbers they need.
    Number over_rows(std::size_t direction, Number (Lattice::*along)(const Row&) const) {
        Number sum{0, 0};
        int rows = 0;
        for (std::size_t k = 0; k < std::size_t{1} << size_; ++k) {
            if ((k >> direction & 1U) != 0) continue;
            Place cube{};
            for (std::size_t d = 0; d < size_; ++d) cube[d] = (k >> d & 1U) != 0 ? 0 : -1;
            Row row;
            for (std::size_t i = 0; i < row.size(); ++i) {
                cube[direction] = static_cast<std::int32_t>(i) - 2;
                row[i] = number(cube);
            }
            const Number one = (this->*along)(row);
            if (!one.is_here()) continue;
            sum = sum + one;
            ++rows;
        }
        return rows == 0 ? Number{} : 1.0 / rows * sum;
    }
    double laplacian() {
        Number sum{0, 0};
        for (std::size_t d = 0; d < size_; ++d) {
            const Number one = over_rows(d, &Lattice::bend_along);
            if (one.is_here()) sum = sum + one;
        }
        return sum.value / (1 + sum.moment / 2);
    }

    const BlockCells* cells_;
    Place middle_;
    Around around_;
    std::int32_t edge_ = 1;   // of cubes, in finest steps
    std::uint64_t read_ = 0;  // a bit for each cube whose number was read
    std::array<Number, dim == 2 ? 16 : 64> numbers_;
};

/// The gradient per finest step among leaves of one size.
template <int dim, class Real>
auto BlockCells<dim, Real>::even_slope(const Around& around) const -> std::array<double, size_> {
    std::array<double, size_> sum{};
    for (std::size_t k = 0; k < around.size(); ++k) {
        if (!reader_.has(around[k])) return {std::numeric_limits<double>::quiet_NaN()};
        const auto number = static_cast<double>(reader_.read(around[k]));
        for (std::size_t d = 0; d < size_; ++d) sum[d] += (k >> d & 1U) != 0 ? number : -number;
    }
    const std::int32_t edge = reader_.grid().extent(static_cast<std::size_t>(around[0].level));
    for (double& each : sum) each /= static_cast<double>(around.size() / 2) * edge;
    return sum;
}

/// A node that hangs has the interpolant, as its value.
template <int dim, class Real>
Point BlockCells<dim, Real>::gradient(const Place& node, const Around& around) const {
    const BlockGrid<dim>& grid = reader_.grid();
    Point sum{0, 0, 0};
    if (const BlockCell<dim>* leaf = hangs_on(around, node)) {
        for_each_weight(*leaf, node, [&](const Place& corner, double weight) {
            sum = sum + weight * gradient(corner, grid.leaves_around(corner, *leaf));
        });
        return sum;
    }
    const auto slope =
        detail::of_one_size(around) ? even_slope(around) : Lattice(*this, node, around).slope();
    for (std::size_t d = 0; d < size_; ++d) {
        sum[grid.axis(d)] = slope[d] / grid.finest_spacing()[d];
    }
    return sum;
}

template <int dim, class Real>
void BlockCells<dim, Real>::corner_gradients(const Element& e, std::span<Point> out) const {
    const BlockGrid<dim>& grid = reader_.grid();
    BlockCell<dim> near = grid.split(e) == nullptr ? grid.cell_of(e) : BlockCell<dim>{};
    for (std::size_t k = 0; k < out.size(); ++k) {
        const Place node = grid.corner(e, k);
        const Around around = grid.leaves_around(node, near);
        out[k] = finite_gradient(node, around);
        for (const BlockCell<dim>& cell : around) {
            if (near.box < 0) near = cell;
        }
    }
}

}  // namespace nestgrid
