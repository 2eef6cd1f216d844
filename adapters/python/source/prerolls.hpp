// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators of one field, made when they are first asked for, and kept.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

#include "call.hpp"

namespace nestgrid::python {

/// What a HierarchicalIndicator measures under this name; nothing for the name of another
/// indicator.
inline std::optional<NodeError> node_error(const std::string& name) {
    if (name == "offset") return NodeError::offset;
    if (name == "deviation") return NodeError::deviation;
    return std::nullopt;
}

/// Several threads may ask at once; the one that comes first computes. What a call makes is kept
/// only where the call was not stopped.
class Prerolls {
public:
    explicit Prerolls(const AnyHierarchy& hierarchy) : hierarchy_{hierarchy} {}

    /// Offsets or deviations.
    /// \param blend the factor of the spread
    /// \throw InvalidInput as HierarchicalIndicator
    std::shared_ptr<const HierarchicalIndicator> of_nodes(NodeError error, double blend,
                                                          const Call& call);
    std::shared_ptr<const HierarchicalIndicator> offsets(double blend, const Call& call) {
        return of_nodes(NodeError::offset, blend, call);
    }
    /// \param name visual, numerical, wavelet or geometry
    /// \throw InvalidInput for another name, and for geometry where the grid is not curved
    std::shared_ptr<const SweptIndicator> swept(const std::string& name, double blend,
                                                const Call& call);
    /// Sizes of elements, spread by a slope.
    std::shared_ptr<const SweptIndicator> sizes(double slope, const Call& call);
    /// Drops what is kept, as the data have changed. Extractions that run keep what they use.
    void clear();

private:
    AnyHierarchy hierarchy_;
    std::mutex mutex_;
    std::map<std::pair<NodeError, double>, std::shared_ptr<const HierarchicalIndicator>> of_nodes_;
    std::map<std::pair<std::string, double>, std::shared_ptr<const SweptIndicator>> swept_;
    std::map<double, std::shared_ptr<const SweptIndicator>> sizes_;
};

}  // namespace nestgrid::python
