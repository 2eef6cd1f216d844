// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Linear, quadratic and Lagrange cells in arrays.
#include <algorithm>

#include <nestgrid/adapters/lagrange.hpp>

#include "source.hpp"

namespace nestgrid::python {

namespace {

/// Their range is that of the values at points.
class Cells final : public CellSource {
public:
    Cells(FieldOnGrid field, std::span<const double> values, int degree)
        : CellSource(std::make_shared<Prerolls>(std::move(field))), degree_{degree} {
        const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
        range_ = {*least, *greatest};
    }
    std::array<double, 2> range(const Call&) const override { return range_; }
    int degree() const override { return degree_; }

private:
    int degree_;
    std::array<double, 2> range_{};
};

template <int dim>
std::shared_ptr<CellSource> cells_of(const CellArrays& cells, std::span<const double> given) {
    const auto grid = std::make_shared<const LagrangeGrid<dim>>(cells);
    require_point_values(given, grid->point_count(), "values");
    const auto values = std::make_shared<const std::vector<double>>(given.begin(), given.end());
    const auto made = [&](auto field) {
        return std::make_shared<Cells>(shared_field(grid, std::move(field), values), given,
                                       grid->greatest_degree());
    };
    if (grid->greatest_degree() > 1) return made(LagrangeField<dim>(*grid, *values));
    return made(LagrangeCornerField<dim>(*grid, *values));
}

}  // namespace

std::shared_ptr<CellSource> make_cells(const CellArrays& cells, std::span<const double> values) {
    const std::size_t count = cells.types.size();
    const std::int64_t end = cells.first.empty() ? 0 : cells.first.back();
    if (cells.first.size() != count + 1 || cells.first.front() != 0 ||
        !std::ranges::is_sorted(cells.first) ||
        end != static_cast<std::int64_t>(cells.points.size())) {
        throw InvalidInput("offsets do not say where the points of each cell begin and end");
    }
    if (!cells.degrees.empty() && cells.degrees.size() != 3 * count) {
        throw InvalidInput("degrees has no three numbers for each cell");
    }
    return dimension_of(cells) == 2 ? cells_of<2>(cells, values) : cells_of<3>(cells, values);
}

}  // namespace nestgrid::python
