// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/high_order_data.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <high_order/function_ranges.hpp>
#include <nestgrid/detail/coarse_boundary.hpp>
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

HighOrderData::HighOrderData(const Hierarchy<float>& single, const Executor& executor)
    : widened{std::in_place, checked(single), 0},
      base{&*widened},
      walk{*base},
      epoch{base->epoch()},
      field{LeafField(*base), walk, epoch, executor} {
    look_at_places(executor);
}

HighOrderData::HighOrderData(const Hierarchy<double>& from, const Executor& executor)
    : base{&checked(from)},
      walk{*base},
      epoch{base->epoch()},
      field{LeafField(*base), walk, epoch, executor} {
    look_at_places(executor);
}

void HighOrderData::look_at_places(const Executor& executor) {
    if (!base->offers(Feature::geometry_degree)) return;
    bool curved = false;
    walk.for_each([&](Task* task, std::span<const BaseElement> way) {
        const Member& leaf = *way.back().member;
        curved |= leaf.rule == nullptr && base->geometry_degree(task, leaf.element) != 1;
    });
    if (curved) places.emplace(LeafPlaces(*base), walk, epoch, executor);
}

/// The same share of the diameter of the domain as the tolerance is of the range of the data.
double HighOrderData::default_position_tolerance(double tolerance) const {
    const double range = field.summary.extent();
    const double share = range > 0 ? tolerance / range : 1e-3;
    return std::min(share * places->summary.extent(), std::numeric_limits<double>::max());
}

const LeafCorners& HighOrderData::corners() const {
    std::call_once(corners_made_, [this] { corners_.emplace(walk); });
    return *corners_;
}

GatheredLeaves HighOrderData::gather(const LeafChoice::Chooses& chooses,
                                     LeafChoice::Needs needs) const {
    if (base->epoch() != epoch) {
        throw GridError("the grid has changed since its polynomials were read");
    }
    LeafChoice choice(walk, chooses, needs);
    LeafRecords of_field(LeafField(*base), walk, choice, field.summary);
    GatheredLeaves leaves{std::move(choice), std::move(of_field), std::nullopt};
    if (places) leaves.places.emplace(LeafPlaces(*base), walk, leaves.choice, places->summary);
    leaves.choice.finish();
    return leaves;
}

namespace {

/// Whether all of some leaves are among those that are kept.
bool covers(const std::vector<bool>& kept, const std::vector<bool>& leaves) {
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        if (leaves[i] && !kept[i]) return false;
    }
    return true;
}

/// Faces of the last element on the way that are on the boundary.
/// \param coarse those of the coarse elements
unsigned boundary_of(std::span<const BaseElement> way, std::span<const std::uint8_t> coarse) {
    unsigned faces = coarse[way[0].number];
    for (std::size_t j = 1; j < way.size() && faces != 0; ++j) {
        const Child& child = way[j - 1].member->rule->children[way[j].number];
        unsigned own = 0;
        for (std::size_t f = 0; f < topology(child.shape).faces; ++f) {
            const std::uint8_t around = child.parent_face[f];
            if (around != no_face) own |= (faces >> around & 1U) << f;
        }
        faces = own;
    }
    return faces;
}

}  // namespace

GatheredLeaves HighOrderData::gather_none() const {
    GatheredLeaves none{{}, LeafRecords(field.summary), std::nullopt};
    if (places) none.places.emplace(places->summary);
    return none;
}

std::vector<bool> HighOrderData::looked_at(const VirtualOptions& options) const {
    const LeafSummary& summary = field.summary;
    std::vector<bool> leaves(summary.ranges.size());
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
        leaves[leaf] = std::any_of(
            options.values->begin(), options.values->end(),
            [&](const auto& range) { return summary.may_take(leaf, range[0], range[1]); });
    }
    if (options.boundary || !options.functions.empty()) look_at_places(options, leaves);
    return leaves;
}

/// Adds the leaves that functions pass through, and those on the boundary.
void HighOrderData::look_at_places(const VirtualOptions& options, std::vector<bool>& leaves) const {
    const PositionFunctions functions(options.functions, *base);
    std::vector<std::uint8_t> coarse;
    if (options.boundary && !base->offers(Feature::boundary_faces)) {
        coarse = nestgrid::detail::coarse_boundary(*base);
    }
    const auto on_boundary = [&](Task* task, std::span<const BaseElement> way) {
        if (!options.boundary) return false;
        if (!coarse.empty()) return boundary_of(way, coarse) != 0;
        unsigned faces = 0;
        const BaseElement& e = way.back();
        base->corners(task, e.member->element, e.shape->corners, nullptr, nullptr, &faces);
        return faces != 0;
    };
    FunctionRanges ranges(functions, field.nodes, places ? &places->nodes : nullptr,
                          options.tolerance);
    std::size_t number = 0;
    const auto look = [&](Task* task, std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        ranges.enter(way);
        if (e.member->rule != nullptr) return;
        const double beyond =
            places ? static_cast<double>(places->summary.beyond_hull[number]) : e.moved;
        if (!leaves[number]) {
            leaves[number] = on_boundary(task, way) || ranges.pass(e, way.size() - 1, beyond);
        }
        ++number;
    };
    walk.for_each(look, BaseWalk::Positions::yes);
}

std::shared_ptr<const GatheredLeaves> HighOrderData::gathered(const VirtualOptions& options) const {
    const bool nothing =
        options.values && options.values->empty() && options.functions.empty() && !options.boundary;
    if (nothing) return std::make_shared<const GatheredLeaves>(gather_none());
    std::optional<std::vector<bool>> leaves;
    if (options.values) leaves = looked_at(options);
    const std::lock_guard lock(gathering_);
    const bool some = !leaves || std::find(leaves->begin(), leaves->end(), true) != leaves->end();
    if (last_ && (!last_leaves_ || (some && leaves && covers(*last_leaves_, *leaves)))) {
        return last_;
    }
    last_.reset();
    LeafChoice::Chooses chooses;
    if (leaves) chooses = [&](std::size_t leaf, const BaseElement&) { return (*leaves)[leaf]; };
    last_ = std::make_shared<const GatheredLeaves>(some ? gather(chooses) : gather_none());
    last_leaves_ = std::move(leaves);
    return last_;
}

std::size_t HighOrderData::memory_bytes() const {
    const std::lock_guard lock(gathering_);
    return field.memory_bytes() + (places ? places->memory_bytes() : 0) +
           (corners_ ? corners_->memory_bytes() : 0) + (last_ ? last_->memory_bytes() : 0);
}

}  // namespace engine

HighOrder::HighOrder(const Hierarchy<float>& base, const Executor& executor)
    : data_{std::make_shared<const engine::HighOrderData>(base, executor)} {}
HighOrder::HighOrder(const Hierarchy<double>& base, const Executor& executor)
    : data_{std::make_shared<const engine::HighOrderData>(base, executor)} {}

int HighOrder::greatest_degree() const { return data_->field.summary.greatest_degree; }
int HighOrder::geometry_degree() const {
    return data_->places ? data_->places->summary.greatest_degree : 1;
}
double HighOrder::jump() const { return data_->field.summary.jump(); }
double HighOrder::position_jump() const {
    return data_->places ? data_->places->summary.jump() : 0;
}

double HighOrder::least_tolerance(double position_tolerance) const {
    // A half of a part has a quarter of its beta.
    const auto at_limit = [](const engine::LeafSummary& all) {
        return std::ldexp(engine::flat_share * all.greatest_beta, -2 * VirtualOptions{}.depth);
    };
    const engine::LeafSummary& field = data_->field.summary;
    double least = std::max(at_limit(field), 2e-12 * field.magnitude());
    if (data_->places && position_tolerance == 0) {
        // Positions are within the same share of the domain.
        const double of_domain = data_->default_position_tolerance(1);
        least = std::max(least, at_limit(data_->places->summary) / of_domain);
    }
    return std::max(least, double{std::numeric_limits<float>::min()});
}

std::size_t HighOrder::memory_bytes() const { return data_->memory_bytes(); }

}  // namespace nestgrid
