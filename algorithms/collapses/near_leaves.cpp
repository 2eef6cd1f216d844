// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/near_leaves.hpp>

#include <functional>

#include <drawing/requirements.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>
#include <probes/inverse_map.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

namespace {

constexpr std::array<double, 1> as_they_are{1};  // the units of component 0
constexpr double touching = 1e-9;                // of an element, by which it may miss a triangle

}  // namespace

/// Goes down to the leaves that are wanted and keeps them.
template <class Real>
class NearLeaves::Search final : public Visitor<Real> {
    using View = ElementView<Real>;

public:
    /// Whether an element, and what is below it, may be wanted.
    using Wants = std::function<bool(const View&, const Split&)>;

    Search(const Walk<Real>& walk, double isovalue, std::size_t first,
           std::span<const double> units, Wants wants, NearLeaves& found)
        : walk_{walk},
          isovalue_{isovalue},
          first_{first},
          units_{units},
          wants_{std::move(wants)},
          found_{found} {}

    Decision inspect(const View& view, const Split& split) override {
        return {wants_(view, split) ? Visit::descend : Visit::skip, 0};
    }
    void extract(const View& view) override {
        std::array<NodeKey, max_corners> key;
        std::array<Point, max_corners> x;
        walk_.corners(view, key.data(), x.data());
        const std::size_t count = view.corner_count();
        const std::span<const Point> corners(x.data(), count);
        const auto first = static_cast<std::uint32_t>(found_.nodes_.size());
        for (std::size_t k = 0; k < count; ++k) {
            found_.nodes_.push_back(number(key[k], x[k], view.value + k * walk_.components()));
        }
        const bool affine = view.shape != Shape::pyramid && is_affine(view.shape, corners);
        const auto boundary = static_cast<std::uint8_t>(walk_.boundary(view));
        found_.leaves_.push_back({first, view.shape, affine, boundary});
        found_.tree_.add(Box::around(corners));
    }

private:
    std::uint32_t number(NodeKey key, const Point& x, const Real* values) {
        const auto next = static_cast<std::uint32_t>(found_.position_.size());
        const auto [at, is_new] = number_.insert(key, next);
        if (is_new) {
            found_.position_.push_back(x);
            for (std::size_t c = 0; c < units_.size(); ++c) {
                found_.value_.push_back((static_cast<double>(values[first_ + c]) - isovalue_) /
                                        units_[c]);
            }
        }
        return *at;
    }

    const Walk<Real>& walk_;
    double isovalue_;
    std::size_t first_;              // component that is kept
    std::span<const double> units_;  // by component that is
    Wants wants_;
    NearLeaves& found_;
    KeyTable<NodeKey, std::uint32_t> number_;
};

/// \param wants wants(walk, view, split) is told of elements
template <class Real, class Wants>
NearLeaves NearLeaves::collect(const Hierarchy<Real>& hierarchy, double isovalue, std::size_t first,
                               std::span<const double> units, const Bounds& bounds,
                               const Wants& wants) {
    require_same_epoch(hierarchy, bounds);
    NearLeaves found;
    found.components_ = units.size();
    found.may_hide_ = hierarchy.offers(Feature::hidden);
    const Walk<Real> walk(hierarchy, {.positions = true}, bounds.hanging());
    Search<Real> search(
        walk, isovalue, first, units,
        [&](const ElementView<Real>& view, const Split& split) { return wants(walk, view, split); },
        found);
    walk.run(search);
    found.tree_.finish();
    return found;
}

template <class Real>
NearLeaves NearLeaves::find(const Hierarchy<Real>& hierarchy, double isovalue, double error,
                            const Bounds& bounds) {
    hierarchy.facts().require_dimension(3);
    const auto near = [&](const Walk<Real>& walk, const ElementView<Real>& view,
                          const Split& split) {
        const double bound = split.rule == nullptr ? 0 : bounds.bound(*split.rule, split.keys);
        double least = Box::infinity;
        double greatest = -Box::infinity;
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            const double off = static_cast<double>(view.value[k * walk.components()]) - isovalue;
            least = std::min(least, off);
            greatest = std::max(greatest, off);
        }
        return least - bound <= error && greatest + bound >= -error;
    };
    NearLeaves found = collect(hierarchy, isovalue, 0, as_they_are, bounds, near);
    found.error_ = error;
    return found;
}

template <class Real>
NearLeaves NearLeaves::find_at_boundary(const Hierarchy<Real>& hierarchy,
                                        const ClosestPoints& surface, double distance,
                                        const Bounds& bounds) {
    hierarchy.facts().require_dimension(3);
    std::uint32_t near = 0;
    const auto wanted = [&](const Walk<Real>& walk, const ElementView<Real>& view,
                            const Split& split) {
        if (walk.boundary(view) == 0) return false;
        if (split.rule != nullptr) return true;
        std::array<NodeKey, max_corners> key;
        std::array<Point, max_corners> x;
        walk.corners(view, key.data(), x.data());
        const Box box = Box::around(std::span(x).first(view.corner_count()));
        return surface.is_within(0.5 * (box.low + box.high), 0.5 * box.diameter() + distance, near);
    };
    return collect(hierarchy, 0, 0, as_they_are, bounds, wanted);
}

template <class Real>
NearLeaves NearLeaves::find_along(const Hierarchy<Real>& hierarchy, const Surface<3>& surface,
                                  std::span<const double> errors, double reach,
                                  const Bounds& bounds) {
    const auto components = static_cast<std::size_t>(hierarchy.facts().components);
    const std::size_t first = components - errors.size();
    std::vector<FlatTriangle> triangles;
    BoxTree tree;
    for (const auto& [a, b, c] : surface.simplices) {
        triangles.emplace_back(
            Triangle{surface.vertices[a], surface.vertices[b], surface.vertices[c]});
        tree.add(triangles.back().box);
    }
    tree.finish();
    // Unless the grid gives new nodes places of its own, an element lies between its corners.
    const bool nested = !hierarchy.offers(Feature::new_positions);
    const auto touched = [&](const Walk<Real>& walk, const ElementView<Real>& view,
                             const Split& split) {
        if (split.rule != nullptr && !nested) return true;
        std::array<NodeKey, max_corners> key;
        std::array<Point, max_corners> x;
        walk.corners(view, key.data(), x.data());
        Box box = Box::around(std::span(x).first(view.corner_count()));
        box.widen(reach + touching * box.diameter());
        return !tree.for_each([&](const Box& other) { return other.meets(box); },
                              [&](std::size_t t) { return !triangles[t].may_meet(box); });
    };
    NearLeaves found = collect(hierarchy, 0, first, errors, bounds, touched);
    found.error_ = 1;
    return found;
}

std::span<const Point> NearLeaves::corners(const NearLeaf& leaf,
                                           std::array<Point, max_corners>& out) const {
    const auto of = nodes(leaf);
    for (std::size_t k = 0; k < of.size(); ++k) out[k] = position_[of[k]];
    return std::span<const Point>(out).first(of.size());
}

std::size_t NearLeaves::memory_bytes() const {
    return position_.capacity() * sizeof(Point) + value_.capacity() * sizeof(double) +
           nodes_.capacity() * sizeof(std::uint32_t) + leaves_.capacity() * sizeof(NearLeaf) +
           tree_.memory_bytes();
}

template NearLeaves NearLeaves::find(const Hierarchy<float>&, double, double, const Bounds&);
template NearLeaves NearLeaves::find(const Hierarchy<double>&, double, double, const Bounds&);
template NearLeaves NearLeaves::find_at_boundary(const Hierarchy<float>&, const ClosestPoints&,
                                                 double, const Bounds&);
template NearLeaves NearLeaves::find_at_boundary(const Hierarchy<double>&, const ClosestPoints&,
                                                 double, const Bounds&);
template NearLeaves NearLeaves::find_along(const Hierarchy<float>&, const Surface<3>&,
                                           std::span<const double>, double, const Bounds&);
template NearLeaves NearLeaves::find_along(const Hierarchy<double>&, const Surface<3>&,
                                           std::span<const double>, double, const Bounds&);

}  // namespace nestgrid::engine
