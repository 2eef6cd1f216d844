// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <patches/told_bisections.hpp>

#include <string>

namespace nestgrid::engine {

namespace {

/// \throw GridError where the element has a tag that does not exist
template <int dim>
const nestgrid_element& told_element(const Handle& element) {
    const auto& e = detail::element_of<nestgrid_element>(element);
    const std::uint64_t tag = e.word[std::size_t{dim} + 1];
    if (tag < 1 || tag > dim) {
        throw GridError("an element has the tag " + std::to_string(tag) + ", not 1 to " +
                        std::to_string(dim));
    }
    return e;
}

}  // namespace

template <int dim, class Real>
void bisect(const Hierarchy<Real>& hierarchy, Task* task, const Handle& element, const Real* values,
            int level, int orientation, detail::ErasedBisectionVisitor<dim, Real>& visitor) {
    if (hierarchy.bisection_rows() == nullptr) {
        return hierarchy.bisect(task, element, values, level, orientation, visitor);
    }
    using Grid = ToldBisections<dim, Real>;
    const Grid grid(hierarchy, task);
    const auto& e = told_element<dim>(element);
    const ToldValues<Real> field(*hierarchy.bisection_rows(), hierarchy.facts().gradients_at_nodes);
    walk_for(visitor, grid, field, e, values, level, orientation);
}

void bisect_means(const Hierarchy<double>& hierarchy, Task* task, const Handle& element,
                  const double* values, double tolerance, int level, int orientation,
                  detail::ErasedBisectionVisitor<3, double>& visitor) {
    const auto* const rows = hierarchy.bisection_rows();
    if (rows == nullptr) {
        return hierarchy.bisect_means(task, element, values, tolerance, level, orientation,
                                      visitor);
    }
    using Grid = ToldBisections<3, double>;
    const Grid grid(hierarchy, task);
    const ToldValues<double> told(*rows, false);
    const CarriedField<Grid, ToldValues<double>> carried(told);
    const MeanValues<Grid> field(tolerance, carried);
    walk_for(visitor, grid, field, told_element<3>(element), values, level, orientation);
}

#define NESTGRID_INSTANTIATE(dim, Real)                                                       \
    template void bisect(const Hierarchy<Real>&, Task*, const Handle&, const Real*, int, int, \
                         detail::ErasedBisectionVisitor<dim, Real>&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
