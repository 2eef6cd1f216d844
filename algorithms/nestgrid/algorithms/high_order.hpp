// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of higher degree (paper, section 7) as an ordinary hierarchy with hanging nodes.
//     const HighOrder data(grid, field);                            once per solution
//     const VirtualRefinement fine(data, {.tolerance = 1e-3});
//     isosurface<3>(fine, 0.3, fine.criterion(), fine.bounds());
// For all shapes, divided by red_rule(); the field has degree() and evaluate(), a grid with curved
// leaves geometry_degree() and map() (optional.hpp). The tolerance is one of component 0, beside
// one of positions. docs/high_order.md.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/level_function.hpp>
#include <nestgrid/algorithms/projection.hpp>

namespace nestgrid {
namespace engine {
struct HighOrderData;
class PolynomialPoints;
class VirtualElements;
}  // namespace engine

/// What all drawings of a solution need: 12 bytes a leaf, and its nodes. The polynomials, with
/// records of the edges and faces that leaves share, are those of a drawing
/// (VirtualOptions::values) and are kept until the next one needs others.
class HighOrder {
public:
    /// Borrows the hierarchy, or grid and field, which stay as they are. Asks the field once for
    /// each leaf, and in a drawing at most once for each that it looks at.
    /// \throw InvalidInput for other grids and fields, GridError for a wrong degree or value
    /// \param executor with it several threads may ask for leaves at a time (executor.hpp)
    explicit HighOrder(const Hierarchy<float>& base,
                       const Executor& executor = SequentialExecutor{});
    explicit HighOrder(const Hierarchy<double>& base,
                       const Executor& executor = SequentialExecutor{});
    template <class Grid, class Field>
    HighOrder(const Grid& grid, const Field& field, const Executor& executor = SequentialExecutor{})
        : HighOrder(std::make_shared<const detail::ErasedHierarchy<Grid, Field>>(grid, field),
                    executor) {}

    int greatest_degree() const;
    /// The greatest degree of positions; 1: all leaves are straight.
    int geometry_degree() const;
    /// How far leaves are apart on edges and faces that they share: rounding in a continuous field.
    double jump() const;
    /// The same of positions, in units of length.
    double position_jump() const;
    /// The tolerance at which the most curved leaf is flat at the depth limit, if it is halved as
    /// often as VirtualOptions::depth is by default. Below it more and more elements meet the
    /// limit; budgets of triangles end there.
    /// \param position_tolerance that of VirtualOptions: where it is not 0, positions are within it
    ///        at any tolerance, and do not count
    double least_tolerance(double position_tolerance = 0) const;
    /// Of what all drawings need, and of the polynomials that were gathered last.
    std::size_t memory_bytes() const;

private:
    friend class VirtualRefinement;
    friend class engine::PolynomialPoints;
    template <class Base>
    HighOrder(std::shared_ptr<const Base> base, const Executor& executor)
        : HighOrder(static_cast<const Hierarchy<typename Base::value_type>&>(*base), executor) {
        base_ = std::move(base);
    }
    std::shared_ptr<const void> base_;
    std::shared_ptr<const engine::HighOrderData> data_;
};

/// How finely leaves are divided.
struct VirtualOptions {
    double tolerance = 0;  ///< in the units of the data; at least 1e-12 of their range
    int depth = 8;         ///< leaves are halved at most this many times, 1 to 16
    /// Elements stop only where they are as small as the lens asks, too, or at the depth limit. Its
    /// `finest` is positive.
    std::optional<LensRequest> lens{};
    /// Elements in the region, or as near to it as three times their size, stop only within its
    /// threshold, which is another tolerance, too.
    std::optional<RegionRequest> region{};
    /// How far points of curved leaves may be from where they are drawn, in units of length; 0: the
    /// same share of the diameter of the domain as the tolerance is of the range of the data.
    double position_tolerance = 0;
    /// Level sets of component 0 that are drawn, each from a least to a greatest value: leaves that
    /// none passes through are not looked at. What is drawn in them all the same counts as met by
    /// the depth limit, with an error of the whole range. A cap takes all values from its isovalue
    /// on. Default: everything is drawn.
    std::optional<std::vector<std::array<double, 2>>> values{};
    /// With `values`: the functions whose zeros are drawn beside these, borrowed until the
    /// refinement is made, and whether the boundary of the domain is, all of it or in a part.
    std::vector<const LevelFunction*> functions{};
    bool boundary = false;
};

/// Leaves halved until what is drawn is within the tolerance, or at the depth limit
/// (TraversalCounts::limited). Nothing is stored for virtual elements.
class VirtualRefinement final : public Hierarchy<double> {
public:
    /// \throw InvalidInput for other options
    VirtualRefinement(const HighOrder& data, const VirtualOptions& options);
    const Criterion& criterion() const;  ///< where coarser elements of the hierarchy may stop
    const Bounds& bounds() const;
    std::size_t coarse_count() const override;
    std::uint64_t epoch() const override;
    Elements make_elements() const override;
    std::unique_ptr<Task> open() const override;
    void coarse(Task*, std::size_t i, Coarse&, Family&) const override;
    NodeMask coarse_values(Task*, std::size_t i, std::size_t corners, double* out) const override;
    NodeMask enter(Task*, const Handle&, const Rule&, NodeMask which, double* values,
                   NodeMask wanted, Family&) const override;
    NodeMask new_values(Task*, const Handle&, const Rule&, NodeMask, double*) const override;
    void corners(Task*, const Handle&, std::size_t, NodeKey*, Point*, unsigned*) const override;
    void new_positions(Task*, const Handle&, NodeMask, std::span<Point>) const override;
    void corner_gradients(Task*, const Handle&, std::span<Point>) const override {}

private:
    std::shared_ptr<const engine::VirtualElements> elements_;
};

}  // namespace nestgrid
