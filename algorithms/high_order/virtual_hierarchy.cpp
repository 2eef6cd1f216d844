// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/virtual_hierarchy.hpp>

#include <algorithm>

namespace nestgrid {

namespace engine {

namespace {

HierarchyFacts facts_of(const HighOrderData& data) {
    const HierarchyFacts& base = data.base->facts();
    HierarchyFacts facts;
    facts.dimension = base.dimension;
    facts.components = base.components;
    facts.features = static_cast<unsigned>(Feature::constrained) |
                     static_cast<unsigned>(Feature::outside) |
                     (base.features & (static_cast<unsigned>(Feature::boundary_faces) |
                                       static_cast<unsigned>(Feature::new_positions)));
    facts.decodes = true;  // what is below an element depends on P_S U at its corners
    if (data.places) facts.features |= static_cast<unsigned>(Feature::new_positions);
    // Pyramids have tetrahedra below them.
    facts.only_shape = base.only_shape == Shape::pyramid ? Shape::point : base.only_shape;
    return facts;
}

const VirtualElement& element_of(const Handle& handle) {
    static_assert(nestgrid::detail::fits_handle<VirtualElement>);
    return nestgrid::detail::element_of<VirtualElement>(handle);
}

}  // namespace

VirtualHierarchy::VirtualHierarchy(std::shared_ptr<const void> base,
                                   std::shared_ptr<const HighOrderData> data,
                                   const VirtualOptions& options)
    : Hierarchy<double>(facts_of(*data)),
      base_{std::move(base)},
      elements_(std::move(data), options) {}

std::size_t VirtualHierarchy::coarse_count() const { return data().base->coarse_count(); }
std::uint64_t VirtualHierarchy::epoch() const { return data().base->epoch(); }
Elements VirtualHierarchy::make_elements() const { return Elements::of<VirtualElement>(); }
std::unique_ptr<Task> VirtualHierarchy::open() const { return elements_.open(); }

void VirtualHierarchy::coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const {
    elements_.coarse(task, i, coarse, family);
}

NodeMask VirtualHierarchy::coarse_values(Task* task, std::size_t i, std::size_t corners,
                                         double* out) const {
    return elements_.coarse_values(task, i, {out, corners * data().field.summary.components});
}

NodeMask VirtualHierarchy::enter(Task* task, const Handle& element, const Rule& /*rule*/,
                                 NodeMask which, double* values, NodeMask wanted,
                                 Family& family) const {
    elements_.enter(task, element_of(element), which, values, wanted, family);
    return 0;
}

NodeMask VirtualHierarchy::new_values(Task* task, const Handle& element, const Rule& /*rule*/,
                                      NodeMask which, double* values) const {
    elements_.new_values(task, element_of(element), which, values);
    return 0;
}

void VirtualHierarchy::corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                               Point* /*positions*/, unsigned* boundary) const {
    const VirtualElement& e = element_of(element);
    if (keys != nullptr) std::copy_n(e.state->key.begin(), count, keys);
    if (boundary != nullptr && offers(Feature::boundary_faces)) {
        *boundary = elements_.boundary(task, e);
    }
}

void VirtualHierarchy::new_positions(Task* task, const Handle& element, NodeMask which,
                                     std::span<Point> out) const {
    elements_.new_positions(task, element_of(element), which, out);
}

}  // namespace engine

VirtualRefinement::VirtualRefinement(const HighOrder& data, const VirtualOptions& options)
    : VirtualRefinement(
          std::make_shared<const engine::VirtualHierarchy>(data.base_, data.data_, options)) {}

VirtualRefinement::VirtualRefinement(std::shared_ptr<const engine::VirtualHierarchy> made)
    : ForwardingHierarchy(*made, made->facts()), made_{std::move(made)} {}

const Criterion& VirtualRefinement::criterion() const { return made_->criterion(); }
const Bounds& VirtualRefinement::bounds() const { return made_->data().field.nodes; }

}  // namespace nestgrid
