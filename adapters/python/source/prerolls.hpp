// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators of one field, made when they are first asked for, and kept.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <variant>

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid::python {

/// A hierarchy with values of either type, borrowed.
using AnyHierarchy = std::variant<const Hierarchy<float>*, const Hierarchy<double>*>;

/// Calls function(hierarchy) with the Hierarchy<float> or Hierarchy<double>.
template <class Function>
decltype(auto) with(const AnyHierarchy& any, Function&& function) {
    return std::visit([&](const auto* hierarchy) -> decltype(auto) { return function(*hierarchy); },
                      any);
}

/// Several threads may ask at once; the one that comes first computes.
class Prerolls {
public:
    explicit Prerolls(const AnyHierarchy& hierarchy) : hierarchy_{hierarchy} {}

    /// \param blend the factor of the spread
    /// \throw InvalidInput as HierarchicalIndicator
    std::shared_ptr<const HierarchicalIndicator> offsets(double blend, const Executor& executor);
    /// \param name visual, numerical, wavelet or geometry
    /// \throw InvalidInput for another name, and for geometry where the grid is not curved
    std::shared_ptr<const SweptIndicator> swept(const std::string& name, double blend,
                                                const Executor& executor);
    /// Sizes of elements, spread by a slope.
    std::shared_ptr<const SweptIndicator> sizes(double slope);
    /// Drops what is kept, as the data have changed. Extractions that run keep what they use.
    void clear();

private:
    AnyHierarchy hierarchy_;
    std::mutex mutex_;
    std::map<double, std::shared_ptr<const HierarchicalIndicator>> offsets_;
    std::map<std::pair<std::string, double>, std::shared_ptr<const SweptIndicator>> swept_;
    std::map<double, std::shared_ptr<const SweptIndicator>> sizes_;
};

}  // namespace nestgrid::python
