// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/watch.hpp>

#include <nestgrid/detail/forwarding_hierarchy.hpp>

namespace nestgrid {

namespace {

/// Hands every question on to another hierarchy after a check.
template <class Real>
class WatchedHierarchy final : public detail::ForwardingHierarchy<Real> {
public:
    /// \param kept borrowed or shared, a hierarchy with values of type Real
    WatchedHierarchy(FieldOnGrid kept, const Hierarchy<Real>& inner, const Watch& watch)
        : detail::ForwardingHierarchy<Real>(inner, inner.facts()),
          kept_{std::move(kept)},
          watch_{watch} {}

    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        checked().coarse(task, i, coarse, family);
    }
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override {
        return checked().coarse_values(task, i, corners, out);
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& children) const override {
        return checked().enter(task, element, rule, which, values, wanted, children);
    }
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        Real* values) const override {
        return checked().new_values(task, element, rule, which, values);
    }
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override {
        checked().corners(task, element, count, keys, positions, boundary);
    }
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override {
        checked().new_positions(task, element, which, out);
    }
    void corner_gradients(Task* task, const Handle& element, std::span<Point> out) const override {
        checked().corner_gradients(task, element, out);
    }
    void star_rows(const std::function<void(const StarRow&)>& function) const override {
        this->inner().star_rows([&](const StarRow& row) {
            checked();
            function(row);
        });
    }
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const override {
        checked().row_values(first, stride, out);
    }
    Point node_position(NodeKey node) const override { return checked().node_position(node); }
    const detail::BisectionRows<Real>* bisection_rows() const override {
        return checked().bisection_rows();
    }
    void bisect(const Handle& element, detail::PatchVisitor& visitor) const override {
        checked().bisect(element, visitor);
    }

private:
    const Hierarchy<Real>& checked() const {
        watch_.check();
        return this->inner();
    }

    FieldOnGrid kept_;
    const Watch& watch_;
};

template <class Real>
FieldOnGrid watched_field(const FieldOnGrid& field, const Hierarchy<Real>& hierarchy,
                          const Watch& watch) {
    return std::shared_ptr<const Hierarchy<Real>>(
        std::make_shared<const WatchedHierarchy<Real>>(field, hierarchy, watch));
}
// clang 14 emits nothing that is instantiated by a generic lambda alone.
template FieldOnGrid watched_field(const FieldOnGrid&, const Hierarchy<float>&, const Watch&);
template FieldOnGrid watched_field(const FieldOnGrid&, const Hierarchy<double>&, const Watch&);

}  // namespace

FieldOnGrid detail::watched(const FieldOnGrid& field, const Watch& watch) {
    return field.visit(
        [&](const auto& hierarchy) { return watched_field(field, hierarchy, watch); });
}

void TellingExecutor::run(std::size_t count, const std::function<void(std::size_t)>& work,
                          const std::function<void(std::size_t)>& consume) const {
    inner_->run(count, work, [&](std::size_t i) {
        consume(i);
        if (tell_) tell_(static_cast<double>(i + 1) / static_cast<double>(count));
    });
}

const Executor& Work::sequential() {
    static const SequentialExecutor executor;
    return executor;
}

}  // namespace nestgrid
