// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "check_table.hpp"

#include <nestgrid/check_grid.hpp>
#include <patches/check_bisections.hpp>
#include <patches/told_bisections.hpp>
#include <table/table_grid.hpp>

namespace nestgrid {

namespace {

/// A model of NestedGrid: BisectionCheck asks each operation alone, unlike a Hierarchy.
template <int dim>
class CheckedGrid : public detail::TableGrid {
public:
    using detail::TableGrid::TableGrid;
    static constexpr int dimension = dim;

    using detail::TableGrid::coarse;
    CoarseElement<nestgrid_element> coarse(std::size_t i) const {
        detail::TableContext context = make_context();
        return coarse(i, context);
    }
};

template <int dim, class Real>
std::optional<std::string> check(const Hierarchy<Real>& hierarchy, const nestgrid_grid& table,
                                 const nestgrid_field& values) {
    if (const auto violation = check_hierarchy(hierarchy)) return violation->sentence;
    if (hierarchy.bisection_rows() == nullptr) return std::nullopt;
    const CheckedGrid<dim> grid(table);
    const detail::TableField<Real> field(values);
    const auto task = hierarchy.open();
    const engine::ToldBisections<dim, Real> told(hierarchy, task.get());
    const engine::ToldValues<Real> told_values(*hierarchy.bisection_rows(),
                                               hierarchy.facts().gradients_at_nodes);
    detail::TableContext context = grid.make_context();
    return engine::BisectionCheck(grid, field, told, told_values, context).run();
}

}  // namespace

template <class Real>
std::optional<std::string> check_table(const Hierarchy<Real>& hierarchy, const nestgrid_grid& grid,
                                       const nestgrid_field& field) {
    return hierarchy.facts().dimension == 2 ? check<2>(hierarchy, grid, field)
                                            : check<3>(hierarchy, grid, field);
}
template std::optional<std::string> check_table(const Hierarchy<float>&, const nestgrid_grid&,
                                                const nestgrid_field&);
template std::optional<std::string> check_table(const Hierarchy<double>&, const nestgrid_grid&,
                                                const nestgrid_field&);

}  // namespace nestgrid
