// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/virtual_elements.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/error.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// \throw InvalidInput where it cannot be refined virtually
template <class Real>
const Hierarchy<Real>& checked(const Hierarchy<Real>& base) {
    if (!base.offers(Feature::degree)) {
        throw InvalidInput(
            "the field tells no polynomials: data of higher degree need degree() and evaluate()");
    }
    for (const Feature feature : {Feature::hidden, Feature::masked, Feature::outside}) {
        if (!base.offers(feature)) continue;
        throw InvalidInput(
            "leaves of higher degree are not drawn beside hidden or masked elements");
    }
    return base;
}

}  // namespace

HighOrderData::HighOrderData(const Hierarchy<float>& single)
    : widened{std::in_place, checked(single), 0},
      base{&*widened},
      walk{*base},
      records{*base, walk},
      nodes{*base, walk, records} {
    records.finish();
}

HighOrderData::HighOrderData(const Hierarchy<double>& from)
    : base{&checked(from)}, walk{*base}, records{*base, walk}, nodes{*base, walk, records} {
    records.finish();
}

const LeafCorners& HighOrderData::corners() const {
    std::call_once(corners_made_, [this] { corners_.emplace(walk, records); });
    return *corners_;
}

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
    // Pyramids have tetrahedra below them.
    facts.only_shape = base.only_shape == Shape::pyramid ? Shape::point : base.only_shape;
    return facts;
}

const VirtualElement& element_of(const Handle& handle) {
    static_assert(nestgrid::detail::fits_handle<VirtualElement>);
    return nestgrid::detail::element_of<VirtualElement>(handle);
}

}  // namespace

}  // namespace engine

HighOrder::HighOrder(const Hierarchy<float>& base)
    : data_{std::make_shared<const engine::HighOrderData>(base)} {}
HighOrder::HighOrder(const Hierarchy<double>& base)
    : data_{std::make_shared<const engine::HighOrderData>(base)} {}

int HighOrder::greatest_degree() const { return data_->records.greatest_degree(); }
double HighOrder::jump() const { return data_->records.jump(); }

double HighOrder::least_tolerance() const {
    const engine::LeafRecords& records = data_->records;
    double beta = 0;
    for (const engine::LeafPolynomial& leaf : records.leaves()) {
        const auto facts = engine::net_facts(records.net(leaf), leaf.degree, leaf.factors());
        beta = std::max(beta, facts.beta);
    }
    // A half of a part has a quarter of its beta.
    const double at_limit = std::ldexp(engine::flat_share * beta, -2 * VirtualOptions{}.depth);
    const double size = std::max(std::abs(records.least()), std::abs(records.greatest()));
    return std::max({at_limit, 2e-12 * size, double{std::numeric_limits<float>::min()}});
}

std::size_t HighOrder::memory_bytes() const {
    return data_->records.memory_bytes() + data_->nodes.memory_bytes();
}

VirtualRefinement::VirtualRefinement(const HighOrder& data, const VirtualOptions& options)
    : Hierarchy<double>(engine::facts_of(*data.data_)) {
    struct Kept {
        std::shared_ptr<const void> base;  // outlives the elements
        engine::VirtualElements elements;
    };
    const std::shared_ptr<const Kept> kept(
        new Kept{data.base_, engine::VirtualElements(data.data_, options)});
    elements_ = {kept, &kept->elements};
}

const Criterion& VirtualRefinement::criterion() const { return elements_->criterion(); }
const Bounds& VirtualRefinement::bounds() const { return elements_->data().nodes; }

std::size_t VirtualRefinement::coarse_count() const {
    return elements_->data().base->coarse_count();
}
std::uint64_t VirtualRefinement::epoch() const { return elements_->data().base->epoch(); }
Elements VirtualRefinement::make_elements() const { return Elements::of<engine::VirtualElement>(); }
std::unique_ptr<Task> VirtualRefinement::open() const { return elements_->open(); }

void VirtualRefinement::coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const {
    elements_->coarse(task, i, coarse, family);
}

NodeMask VirtualRefinement::coarse_values(Task* task, std::size_t i, std::size_t corners,
                                          double* out) const {
    return elements_->coarse_values(task, i,
                                    {out, corners * elements_->data().records.components()});
}

NodeMask VirtualRefinement::enter(Task* task, const Handle& element, const Rule& /*rule*/,
                                  NodeMask which, double* values, NodeMask wanted,
                                  Family& family) const {
    elements_->enter(task, engine::element_of(element), which, values, wanted, family);
    return 0;
}

NodeMask VirtualRefinement::new_values(Task* task, const Handle& element, const Rule& /*rule*/,
                                       NodeMask which, double* values) const {
    elements_->new_values(task, engine::element_of(element), which, values);
    return 0;
}

void VirtualRefinement::corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                                Point* /*positions*/, unsigned* boundary) const {
    const engine::VirtualElement& e = engine::element_of(element);
    if (keys != nullptr) std::copy_n(e.state->key.begin(), count, keys);
    if (boundary != nullptr && offers(Feature::boundary_faces)) {
        *boundary = elements_->boundary(task, e);
    }
}

void VirtualRefinement::new_positions(Task* task, const Handle& element, NodeMask which,
                                      std::span<Point> out) const {
    elements_->new_positions(task, engine::element_of(element), which, out);
}

}  // namespace nestgrid
