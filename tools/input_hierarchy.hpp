// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The field of an input, on the hierarchy that the program gives it.
#pragma once

#include <nestgrid/detail/erase.hpp>

#include "command_line.hpp"
#include "field_pair.hpp"
#include "hierarchy.hpp"
#include "raster.hpp"

/// Calls function(hierarchy, name), with a nestgrid::Hierarchy<float> or <double> and the name of
/// the field. The samples of a volume or a picture are the corners of bisected boxes. \throw
/// nestgrid::IoError, nestgrid::InvalidInput as read_volume(), with_hierarchy() and
///        field_named()
template <class Function>
void with_field(Input& input, Function&& function) {
    const auto call = [&](const auto& grid, const auto& field, const std::string& name) {
        using Real = typename std::decay_t<decltype(field)>::value_type;
        const auto hierarchy = nestgrid::erase(grid, field);
        function(static_cast<const nestgrid::Hierarchy<Real>&>(hierarchy), name);
    };
    if (is_hierarchy(input.path)) {
        with_hierarchy(input.path, [&](const auto& stored) {
            const auto field_of = [&](const nestgrid::NamedField& named) {
                return nestgrid::NodeField(stored.grid, named.values);
            };
            const nestgrid::NamedField& named = field_named(stored.fields, input.array);
            const nestgrid::NamedField* const other = find_field(stored.fields, input.by);
            if (other == nullptr) return call(stored.grid, field_of(named), named.name);
            call(stored.grid, FieldPair(field_of(named), field_of(*other)), named.name);
        });
        return;
    }
    const std::string name = input.array.empty() ? std::string("value") : input.array;
    if (is_raster(input.path)) {
        const Raster raster = read_raster(input.path, input.read_limit);
        const nestgrid::LatticeBisection<2> grid(raster.geometry);
        call(grid, nestgrid::LatticeField(grid, raster.samples), name);
        return;
    }
    const Volume volume = read_volume(input);
    const nestgrid::LatticeBisection<3> grid(volume.geometry);
    with_samples(volume,
                 [&](auto samples) { call(grid, nestgrid::LatticeField(grid, samples), name); });
}
