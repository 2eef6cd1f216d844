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
void bisect(const Hierarchy<Real>& hierarchy, Task* task, const Handle& element,
            ErasedBisectionVisitor<dim, Real>& visitor) {
    const auto* const rows = hierarchy.bisection_rows();
    if (rows == nullptr) return hierarchy.bisect(element, visitor);
    const ToldBisections<dim, Real> grid(hierarchy, task);
    const ToldValues<Real> field(*rows, hierarchy.facts().gradients_at_nodes);
    bisect_for(visitor, grid, field, told_element<dim>(element));
}

#define NESTGRID_INSTANTIATE(dim, Real)                                \
    template void bisect(const Hierarchy<Real>&, Task*, const Handle&, \
                         ErasedBisectionVisitor<dim, Real>&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
