// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include <nestgrid/algorithms/discontinuous_data.hpp>

namespace nestgrid::engine {

/// Finds the values at the corners of any element: those of the leaf below it in each corner.
class CornerValues {
public:
    /// Borrows the data.
    explicit CornerValues(const DiscontinuousData& data);

    /// Puts component c at corner k of an element into out[k * stride + c].
    /// \param rule that splits the element; null for a leaf
    /// \throw InvalidInput where a value is not finite
    void put(const Handle& element, const Rule* rule, Shape shape, double* out, std::size_t stride);

    std::size_t components() const { return components_; }
    /// The values at the corners of a leaf. Valid until the next call.
    /// \throw InvalidInput where one is not finite
    std::span<const double> of_leaf(const Handle& leaf, std::size_t corners);

private:
    /// Where the values at the corners of an element go; null for corners that are not asked for.
    using Places = std::array<double*, max_corners>;

    void put(const Handle& element, const Rule* rule, Shape shape, const Places& places,
             std::size_t depth);

    const DiscontinuousData* data_;
    std::size_t components_;
    std::unique_ptr<Task> task_;
    std::vector<double> of_leaf_;
    std::deque<Family> families_;  // by depth below the element
};

}  // namespace nestgrid::engine
