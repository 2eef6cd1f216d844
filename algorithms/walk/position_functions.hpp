// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Functions of position that a walk carries as the first components, in front of those of the
// field.
//
// Invariants:
//   - a value is a function of the node, to the last bit: that of an affine function, where nodes
//     lie where eq. (1) puts them, is interpolated at every new node, whatever S says; others are
//     interpolated where P_S U is, and elsewhere those of the function at the node's position;
//   - values within `tolerance` of 0 are 0. Rounding to 0 is monotone and idempotent, so that the
//     mean of rounded values, rounded, still lies between them.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/level_function.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

class PositionFunctions {
public:
    /// Borrows the functions. Evaluates them at the corners of the coarse grid, which give the
    /// tolerances: 2^-40 of the range of the values there, and what rounding of coordinates adds.
    /// \param bounds the position_bounds() of the grid, borrowed, or null
    /// \throw InvalidInput where a value is not a finite number
    PositionFunctions(std::span<const LevelFunction* const> functions,
                      const Hierarchy<double>& hierarchy, const Indicator* bounds = nullptr);

    std::size_t count() const { return functions_.size(); }
    /// Whether the values of a component at new nodes are means of those at their parents.
    bool affine(std::size_t component) const { return bounded_ && functions_[component]->affine(); }
    /// Whether this holds of all components.
    bool affine() const;
    /// The value of a component, or 0 where it is within the tolerance.
    double rounded(std::size_t component, double value) const {
        return std::abs(value) <= tolerance_[component] ? 0 : value;
    }
    double tolerance(std::size_t component) const { return tolerance_[component]; }
    /// Puts the values at a position, component by component.
    /// \throw InvalidInput where one is not a finite number
    template <class Real>
    void put(const Point& x, Real* out) const {
        for (std::size_t i = 0; i < functions_.size(); ++i) out[i] = at<Real>(i, x);
    }
    /// The value of one component at a position.
    template <class Real>
    Real at(std::size_t component, const Point& x) const {
        return static_cast<Real>(rounded(component, value(component, x)));
    }
    /// A bound of how far nodes below an element may be from the convex hull of its corners:
    /// infinity where none is known.
    /// \param nodes the element's new nodes
    /// \param placed whether its corners are where the grid puts them, none is interpolated
    double distance_beyond_hull(std::span<const NodeKey> nodes, bool placed) const;
    struct Range {
        double least;
        double greatest;
    };
    /// Bounds of a component at points no farther than `distance` from the convex hull of some
    /// corners. \param at_corners its least and greatest value there \param at_first its value at
    /// the first corner
    Range range(std::size_t component, std::span<const Point> corners, const Range& at_corners,
                double at_first, double distance) const;

private:
    double value(std::size_t i, const Point& x) const;

    std::vector<const LevelFunction*> functions_;
    std::vector<double> tolerance_;  // one a function
    bool bounded_ = true;            // elements lie in the convex hulls of their corners
    const Indicator* bounds_;        // how far they leave these hulls otherwise, or null
};

/// A hierarchy whose values are doubles, with some components in front of those of the field. These
/// stay undefined: a walk with PositionFunctions sets them.
template <class Real>
class WidenedHierarchy final : public Hierarchy<double> {
public:
    /// Borrows the hierarchy.
    WidenedHierarchy(const Hierarchy<Real>& inner, std::size_t components_in_front);

    std::size_t coarse_count() const override { return inner_->coarse_count(); }
    std::uint64_t epoch() const override { return inner_->epoch(); }
    Elements make_elements() const override { return inner_->make_elements(); }
    std::unique_ptr<Task> open() const override;
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override;
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           double* out) const override;
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   double* values, NodeMask wanted, Family& children) const override;
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        double* values) const override;
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override;
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override;
    void corner_gradients(Task* /*task*/, const Handle& /*element*/,
                          std::span<Point> /*out*/) const override {}
    int degree(Task* task, const Handle& leaf) const override;
    void evaluate(Task* task, const Handle& leaf, std::span<const Point> reference,
                  double* out) const override;
    int geometry_degree(Task* task, const Handle& leaf) const override;
    void map(Task* task, const Handle& leaf, std::span<const Point> reference,
             std::span<Point> out) const override;
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const override {
        return inner_->hanging_parents(node);
    }
    const detail::BisectionRows<double>* bisection_rows() const override {
        return rows_ ? &*rows_ : nullptr;
    }
    void bisect(const Handle& element, detail::PatchVisitor& visitor) const override {
        inner_->bisect(element, visitor);
    }

private:
    struct WidenedTask;
    /// The rows of the inner hierarchy, with the field's values alone.
    class Rows final : public detail::BisectionRows<double> {
    public:
        explicit Rows(const detail::BisectionRows<Real>& inner) : inner_{&inner} {}

        void middles(std::span<const Node> a, std::span<const Node> b,
                     std::span<Node> out) const override {
            inner_->middles(a, b, out);
        }
        void keys(std::span<const Node> nodes, std::span<NodeKey> out) const override {
            inner_->keys(nodes, out);
        }
        void positions(std::span<const Node> nodes, std::span<Point> out) const override {
            inner_->positions(nodes, out);
        }
        void values(std::span<const Node> nodes, std::span<const NodeKey> keys,
                    std::span<double> out) const override;

    private:
        const detail::BisectionRows<Real>* inner_;
    };

    static WidenedTask& own(Task* task);
    void give_corners(const Rule& rule, const double* from, Real* to) const;
    void take_new(const Rule& rule, const Real* from, double* to) const;
    void copy(const Real* from, std::size_t nodes, double* to) const;

    const Hierarchy<Real>* inner_;
    std::optional<Rows> rows_;
    std::size_t front_;
    std::size_t inner_components_;
};

}  // namespace nestgrid::engine
