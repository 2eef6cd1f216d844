// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Virtual elements as a hierarchy, which VirtualRefinement hands every question on to.
#pragma once

#include <high_order/virtual_elements.hpp>

namespace nestgrid::engine {

class VirtualHierarchy final : public Hierarchy<double> {
public:
    /// \param base is kept as long as the elements
    /// \throw InvalidInput as VirtualElements
    VirtualHierarchy(std::shared_ptr<const void> base, std::shared_ptr<const HighOrderData> data,
                     const VirtualOptions& options);

    const HighOrderData& data() const { return elements_.data(); }
    const Criterion& criterion() const { return elements_.criterion(); }

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
    std::shared_ptr<const void> base_;
    VirtualElements elements_;
};

}  // namespace nestgrid::engine
