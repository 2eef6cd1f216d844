// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of higher degree (paper, section 7) as an ordinary hierarchy with hanging nodes.
//     const HighOrder data(grid, field);                            once per solution
//     const VirtualRefinement fine(data, {.tolerance = 1e-3});
//     isosurface<3>(fine, 0.3, fine.criterion(), fine.bounds());
// For all shapes, divided by red_rule(); a field has degree() and evaluate(), a grid with curved
// leaves geometry_degree() and map() (optional.hpp). docs/high_order.md.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/virtual_options.hpp>
#include <nestgrid/detail/forwarding_hierarchy.hpp>

namespace nestgrid {
namespace engine {
struct HighOrderData;
class PolynomialPoints;
class VirtualHierarchy;
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
    int geometry_degree() const;  ///< the greatest of positions; 1: all leaves are straight
    /// How far leaves are apart on edges and faces that they share: rounding in a continuous field.
    double jump() const;
    double position_jump() const;  ///< the same of positions, in units of length
    /// The tolerance at which the most curved leaf is flat at the depth limit, if it is halved as
    /// often as VirtualOptions::depth is by default. Below it more and more elements meet the
    /// limit; budgets of triangles end there.
    /// \param position_tolerance that of VirtualOptions: where it is not 0, positions are within it
    ///        at any tolerance, and do not count
    double least_tolerance(double position_tolerance = 0) const;
    std::size_t memory_bytes() const;  ///< for all drawings, and of what was gathered last

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

/// Leaves halved until what is drawn is within the tolerance, or at the depth limit
/// (TraversalCounts::limited). Nothing is stored for virtual elements.
class VirtualRefinement final : public detail::ForwardingHierarchy<double> {
public:
    /// \throw InvalidInput for other options
    VirtualRefinement(const HighOrder& data, const VirtualOptions& options);
    const Criterion& criterion() const;  ///< where coarser elements of the hierarchy may stop
    const Bounds& bounds() const;

private:
    explicit VirtualRefinement(std::shared_ptr<const engine::VirtualHierarchy> made);
    std::shared_ptr<const engine::VirtualHierarchy> made_;
};

}  // namespace nestgrid
