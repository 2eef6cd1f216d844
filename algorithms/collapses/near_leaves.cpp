// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/near_leaves.hpp>

#include <functional>

#include <levels/draw.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>
#include <probes/inverse_map.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Goes down to the leaves that are wanted and keeps them.
template <class Real>
class NearLeaves::Search final : public Visitor<Real> {
    using View = ElementView<Real>;

public:
    /// Whether an element, and what is below it, may be wanted.
    using Wants = std::function<bool(const View&, const Split&)>;

    Search(const Walk<Real>& walk, double isovalue, Wants wants, NearLeaves& found)
        : walk_{walk}, isovalue_{isovalue}, wants_{std::move(wants)}, found_{found} {}

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
            found_.nodes_.push_back(number(key[k], x[k], view.value[k * walk_.components()]));
        }
        const bool affine = view.shape != Shape::pyramid && is_affine(view.shape, corners);
        const auto boundary = static_cast<std::uint8_t>(walk_.boundary(view));
        found_.leaves_.push_back({first, view.shape, affine, boundary});
        found_.tree_.add(Box::around(corners));
    }

private:
    std::uint32_t number(NodeKey key, const Point& x, Real value) {
        const auto next = static_cast<std::uint32_t>(found_.position_.size());
        const auto [at, is_new] = number_.insert(key, next);
        if (is_new) {
            found_.position_.push_back(x);
            found_.value_.push_back(static_cast<double>(value) - isovalue_);
        }
        return *at;
    }

    const Walk<Real>& walk_;
    double isovalue_;
    Wants wants_;
    NearLeaves& found_;
    KeyTable<NodeKey, std::uint32_t> number_;
};

/// \param wants wants(walk, view, split) is told of elements
template <class Real, class Wants>
NearLeaves NearLeaves::collect(const Hierarchy<Real>& hierarchy, double isovalue, double error,
                               const Bounds& bounds, const Wants& wants) {
    hierarchy.facts().require_dimension(3);
    require_same_epoch(hierarchy, bounds);
    NearLeaves found;
    found.error_ = error;
    found.may_hide_ = hierarchy.offers(Feature::hidden);
    const Walk<Real> walk(hierarchy, {.positions = true}, bounds.hanging());
    Search<Real> search(
        walk, isovalue,
        [&](const ElementView<Real>& view, const Split& split) { return wants(walk, view, split); },
        found);
    walk.run(search);
    found.tree_.finish();
    return found;
}

template <class Real>
NearLeaves NearLeaves::find(const Hierarchy<Real>& hierarchy, double isovalue, double error,
                            const Bounds& bounds) {
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
    return collect(hierarchy, isovalue, error, bounds, near);
}

template <class Real>
NearLeaves NearLeaves::find_at_boundary(const Hierarchy<Real>& hierarchy,
                                        const ClosestPoints& surface, double distance,
                                        const Bounds& bounds) {
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
    return collect(hierarchy, 0, 0, bounds, wanted);
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

}  // namespace nestgrid::engine
