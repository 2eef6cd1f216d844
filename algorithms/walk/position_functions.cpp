// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/position_functions.hpp>

#include <algorithm>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

PositionFunctions::PositionFunctions(std::span<const LevelFunction* const> functions,
                                     const Hierarchy<double>& hierarchy, const Indicator* bounds)
    : functions_(functions.begin(), functions.end()),
      tolerance_(functions.size(), 0.0),
      bounded_{!hierarchy.offers(Feature::new_positions)},
      bounds_{hierarchy.offers(Feature::hanging_parents) ? nullptr : bounds} {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> least(functions.size(), infinity);
    std::vector<double> greatest(functions.size(), -infinity);
    // Corners at which the values of functions are least and greatest, and the one farthest from
    // the origin, which rounding moves most.
    std::vector<Point> at_least(functions.size());
    std::vector<Point> at_greatest(functions.size());
    Point farthest{};
    const std::unique_ptr<Task> task = hierarchy.open();
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < hierarchy.coarse_count(); ++i) {
        hierarchy.coarse(task.get(), i, coarse, family);
        for (std::size_t k = 0; k < topology(coarse.shape).corners; ++k) {
            if (norm(coarse.corners[k]) > norm(farthest)) farthest = coarse.corners[k];
            for (std::size_t f = 0; f < functions_.size(); ++f) {
                const double at = value(f, coarse.corners[k]);
                if (at < least[f]) {
                    least[f] = at;
                    at_least[f] = coarse.corners[k];
                }
                if (at > greatest[f]) {
                    greatest[f] = at;
                    at_greatest[f] = coarse.corners[k];
                }
            }
        }
    }
    for (std::size_t f = 0; f < functions_.size() && hierarchy.coarse_count() > 0; ++f) {
        // The function may be steep at one of these corners, but nodes are snapped everywhere.
        double rounding = infinity;
        for (const Point& x : {farthest, at_least[f], at_greatest[f]}) {
            rounding = std::min(rounding, functions_[f]->variation(x, 0x1p-50 * norm(farthest)));
        }
        tolerance_[f] =
            0x1p-40 * (greatest[f] - least[f]) + (std::isfinite(rounding) ? rounding : 0);
    }
}

bool PositionFunctions::affine() const {
    return bounded_ && std::ranges::all_of(functions_, [](auto* f) { return f->affine(); });
}

double PositionFunctions::value(std::size_t i, const Point& x) const {
    const double value = functions_[i]->value(x);
    if (std::isfinite(value)) return value;
    throw InvalidInput("the function of the slice has no finite value at " + text_of(x));
}

double PositionFunctions::distance_beyond_hull(std::span<const NodeKey> nodes, bool placed) const {
    if (bounded_) return 0;
    if (bounds_ == nullptr || !placed) return std::numeric_limits<double>::infinity();
    return nestgrid::detail::greatest_eta(*bounds_, nodes);
}

/// An affine function is between its values at the corners within their hull. Others are within
/// what they vary around the first corner.
auto PositionFunctions::range(std::size_t component, std::span<const Point> corners,
                              const Range& at_corners, double at_first, double distance) const
    -> Range {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (distance == infinity) return {-infinity, infinity};
    const LevelFunction& function = *functions_[component];
    if (function.affine()) {
        const double beyond = function.variation(corners[0], distance);
        return {at_corners.least - beyond, at_corners.greatest + beyond};
    }
    double radius = distance;
    for (const Point& x : corners.subspan(1)) {
        radius = std::max(radius, norm(x - corners[0]) + distance);
    }
    const double variation = function.variation(corners[0], radius);
    return {std::min(at_corners.least, at_first - variation),
            std::max(at_corners.greatest, at_first + variation)};
}

template <class Real>
struct WidenedHierarchy<Real>::WidenedTask final : Task {
    std::unique_ptr<Task> inner;
    std::vector<Real> values;  // of the inner hierarchy, before they are spread
};

namespace {

HierarchyFacts widened(HierarchyFacts facts, std::size_t front) {
    facts.bisects_means = facts.bisects_means && front == 1 && facts.components == 1;
    facts.components += static_cast<int>(front);
    facts.features &= ~static_cast<unsigned>(Feature::gradients);
    facts.knows_stars = facts.knows_star_positions = facts.knows_patches = false;
    facts.gradients_at_nodes = false;
    return facts;
}

}  // namespace

template <class Real>
WidenedHierarchy<Real>::WidenedHierarchy(const Hierarchy<Real>& inner,
                                         std::size_t components_in_front)
    : Hierarchy<double>(widened(inner.facts(), components_in_front)),
      inner_{&inner},
      front_{components_in_front},
      inner_components_{static_cast<std::size_t>(inner.facts().components)} {
    const auto* const rows = inner.bisection_rows();
    if (this->facts().bisects_means && rows != nullptr) rows_.emplace(*rows);
}

template <class Real>
void WidenedHierarchy<Real>::Rows::values(std::span<const Node> nodes,
                                          std::span<const NodeKey> keys,
                                          std::span<double> out) const {
    if constexpr (std::is_same_v<Real, double>) {
        inner_->values(nodes, keys, out);
    } else {
        std::array<Real, 64> some;
        for (std::size_t first = 0; first < out.size(); first += some.size()) {
            const std::size_t count = std::min(some.size(), out.size() - first);
            inner_->values(nodes.subspan(first, count), keys.subspan(first, count),
                           std::span(some).first(count));
            std::copy_n(some.begin(), count, out.begin() + static_cast<std::ptrdiff_t>(first));
        }
    }
}

template <class Real>
auto WidenedHierarchy<Real>::own(Task* task) -> WidenedTask& {
    return static_cast<WidenedTask&>(*task);
}

template <class Real>
std::unique_ptr<Task> WidenedHierarchy<Real>::open() const {
    auto task = std::make_unique<WidenedTask>();
    task->inner = inner_->open();
    task->values.resize((max_corners + max_new_nodes) * inner_components_);
    return task;
}

/// Spreads the values at some nodes.
template <class Real>
void WidenedHierarchy<Real>::copy(const Real* from, std::size_t nodes, double* to) const {
    for (std::size_t n = 0; n < nodes; ++n) {
        to += front_;
        for (std::size_t c = 0; c < inner_components_; ++c) *to++ = static_cast<double>(*from++);
    }
}

/// Copies the values at the corners of a split to where the inner hierarchy may need them.
template <class Real>
void WidenedHierarchy<Real>::give_corners(const Rule& rule, const double* from, Real* to) const {
    if (!inner_->facts().decodes) return;
    for (int k = 0; k < rule.corner_count(); ++k, from += front_ + inner_components_) {
        for (std::size_t c = 0; c < inner_components_; ++c) {
            *to++ = static_cast<Real>(from[front_ + c]);
        }
    }
}

/// Spreads the values at the new nodes of a split.
template <class Real>
void WidenedHierarchy<Real>::take_new(const Rule& rule, const Real* from, double* to) const {
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    copy(from + corners * inner_components_, rule.new_nodes.size(),
         to + corners * (front_ + inner_components_));
}

template <class Real>
void WidenedHierarchy<Real>::coarse(Task* task, std::size_t i, Coarse& coarse,
                                    Family& family) const {
    inner_->coarse(own(task).inner.get(), i, coarse, family);
}

template <class Real>
NodeMask WidenedHierarchy<Real>::coarse_values(Task* task, std::size_t i, std::size_t corners,
                                               double* out) const {
    WidenedTask& t = own(task);
    const NodeMask missing = inner_->coarse_values(t.inner.get(), i, corners, t.values.data());
    copy(t.values.data(), corners, out);
    return missing;
}

template <class Real>
NodeMask WidenedHierarchy<Real>::enter(Task* task, const Handle& element, const Rule& rule,
                                       NodeMask which, double* values, NodeMask wanted,
                                       Family& children) const {
    WidenedTask& t = own(task);
    if (values != nullptr) give_corners(rule, values, t.values.data());
    const NodeMask missing =
        inner_->enter(t.inner.get(), element, rule, which, t.values.data(), wanted, children);
    if (which != 0) take_new(rule, t.values.data(), values);
    return missing;
}

template <class Real>
NodeMask WidenedHierarchy<Real>::new_values(Task* task, const Handle& element, const Rule& rule,
                                            NodeMask which, double* values) const {
    WidenedTask& t = own(task);
    give_corners(rule, values, t.values.data());
    const NodeMask missing =
        inner_->new_values(t.inner.get(), element, rule, which, t.values.data());
    take_new(rule, t.values.data(), values);
    return missing;
}

template <class Real>
int WidenedHierarchy<Real>::degree(Task* task, const Handle& leaf) const {
    return inner_->degree(own(task).inner.get(), leaf);
}

template <class Real>
void WidenedHierarchy<Real>::evaluate(Task* task, const Handle& leaf,
                                      std::span<const Point> reference, double* out) const {
    std::vector<Real> values(reference.size() * inner_components_);
    inner_->evaluate(own(task).inner.get(), leaf, reference, values.data());
    copy(values.data(), reference.size(), out);
}

template <class Real>
int WidenedHierarchy<Real>::geometry_degree(Task* task, const Handle& leaf) const {
    return inner_->geometry_degree(own(task).inner.get(), leaf);
}

template <class Real>
void WidenedHierarchy<Real>::map(Task* task, const Handle& leaf, std::span<const Point> reference,
                                 std::span<Point> out) const {
    inner_->map(own(task).inner.get(), leaf, reference, out);
}

template <class Real>
void WidenedHierarchy<Real>::corners(Task* task, const Handle& element, std::size_t count,
                                     NodeKey* keys, Point* positions, unsigned* boundary) const {
    inner_->corners(own(task).inner.get(), element, count, keys, positions, boundary);
}

template <class Real>
void WidenedHierarchy<Real>::new_positions(Task* task, const Handle& element, NodeMask which,
                                           std::span<Point> out) const {
    inner_->new_positions(own(task).inner.get(), element, which, out);
}

template class WidenedHierarchy<float>;
template class WidenedHierarchy<double>;

}  // namespace nestgrid::engine
