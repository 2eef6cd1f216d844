// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sinks of several surfaces.
#pragma once

#include <type_traits>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid::detail {

/// The sinks that take surfaces, one for each; without any, the results hold the surfaces.
template <int dimension>
struct SurfaceTargets {
    std::vector<MeshSink<dimension>*> meshes;
    std::vector<SimplexSink<dimension>*> soups;
};

/// \tparam Sink a MeshSink or a SimplexSink
template <int dimension, class Sink>
SurfaceTargets<dimension> targets_of(std::vector<Sink>& sinks) {
    SurfaceTargets<dimension> targets;
    for (Sink& sink : sinks) {
        if constexpr (std::is_convertible_v<Sink*, MeshSink<dimension>*>) {
            targets.meshes.push_back(&sink);
        } else {
            targets.soups.push_back(&sink);
        }
    }
    return targets;
}

}  // namespace nestgrid::detail
