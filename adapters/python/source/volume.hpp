// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Samples in memory as a bisected lattice. The array's order in memory becomes a permutation of
// the lattice's directions: nothing is copied, and results lie where the indices say.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include <nestgrid/adapters/bisection.hpp>

#include "source.hpp"

namespace nestgrid::python {

/// Gives the origin, spacing and axes of samples, the index first that moves fastest in memory.
/// \throw InvalidInput where the array has another dimension than dim
template <int dim>
LatticeGeometry<dim> lattice_geometry(const Samples& samples) {
    LatticeGeometry<dim> geometry;
    geometry.origin = samples.origin;
    geometry.direction = {};
    for (std::size_t d = 0; d < 3; ++d) {
        const bool has_index = d < static_cast<std::size_t>(dim);
        const std::size_t index = has_index ? static_cast<std::size_t>(samples.order[d]) : d;
        for (std::size_t r = 0; r < 3; ++r) {
            geometry.direction[r][d] = samples.direction[r][index];
        }
        geometry.spacing[d] = samples.spacing[index];
        if (has_index) geometry.samples[d] = samples.shape[index];
    }
    return geometry;
}

template <class Sample, class Grid>
LatticeField<Grid, Sample> lattice_field(const Grid& grid, const Samples& samples) {
    return {grid,
            std::span(static_cast<const Sample*>(samples.data), std::size_t{grid.sample_count()})};
}

/// Whether a sample has no value: is not a number (NaN).
/// \throw InvalidInput where none has a value
template <class Sample>
bool any_missing(const Samples& samples, std::size_t count) {
    if constexpr (std::is_floating_point_v<Sample>) {
        const std::span all(static_cast<const Sample*>(samples.data), count);
        const auto missing =
            std::ranges::count_if(all, [](Sample value) { return std::isnan(value); });
        if (static_cast<std::size_t>(missing) == count) {
            throw InvalidInput("no sample has a value");
        }
        return missing > 0;
    }
    return false;
}

/// The samples of several arrays of one layout as frames.
template <int dim, class Sample>
Frames lattice_frames(const std::vector<Samples>& frames, std::vector<double> times,
                      const Call& call) {
    using Grid = LatticeBisection<dim>;
    using Field = LatticeField<Grid, Sample>;
    const auto grid = std::make_shared<const Grid>(lattice_geometry<dim>(frames.front()));
    std::vector<Field> fields;
    const auto memory = std::make_shared<std::vector<std::shared_ptr<const void>>>();
    bool missing = false;
    for (const Samples& frame : frames) {
        missing = any_missing<Sample>(frame, grid->sample_count()) || missing;
        fields.push_back(lattice_field<Sample>(*grid, frame));
        memory->push_back(frame.memory);
    }
    Frames all = shared_frames(grid, std::move(fields), std::move(times), memory);
    return missing ? all.without_missing(call.work()) : all;
}

/// Calls function(Sample{}) with the type of a name.
/// \throw InvalidInput for a type that no field takes
template <class Function>
auto with_sample_type(const std::string& type, const Function& function) {
    if (type == "uint8") return function(std::uint8_t{});
    if (type == "int8") return function(std::int8_t{});
    if (type == "uint16") return function(std::uint16_t{});
    if (type == "int16") return function(std::int16_t{});
    if (type == "uint32") return function(std::uint32_t{});
    if (type == "int32") return function(std::int32_t{});
    if (type == "uint64") return function(std::uint64_t{});
    if (type == "int64") return function(std::int64_t{});
    if (type == "float32") return function(float{});
    if (type == "float64") return function(double{});
    throw InvalidInput("samples of the type " + type +
                       " are not taken: convert them to integers of 8 to 64 bits, float32 or "
                       "float64");
}

// Each is compiled by itself.
Frames make_frames_2(const std::vector<Samples>& frames, std::vector<double> times,
                     const Call& call);
Frames make_frames_3(const std::vector<Samples>& frames, std::vector<double> times,
                     const Call& call);

}  // namespace nestgrid::python
