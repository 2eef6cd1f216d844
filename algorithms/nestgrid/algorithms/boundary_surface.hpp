// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boundary of the domain of a hierarchy of dimension 3, coloured by the data. Where the data
// stop elements, the boundary is as coarse as they are; edges between boundary faces of different
// levels conform.
//
// A view of the domain cut open is no boundary but a slice with options.cap: the part of the domain
// on the positive side of the function.
#pragma once

#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid {

namespace detail {

/// A function without a zero, positive everywhere: its capped level set is the boundary.
class Everywhere final : public LevelFunction {
public:
    double value(const Point& /*x*/) const override { return 1; }
    double variation(const Point& /*centre*/, double /*radius*/) const override { return 0; }
    bool affine() const override { return true; }
};

inline IsosurfaceOptions capped(IsosurfaceOptions options) {
    options.cap = true;
    return options;
}

}  // namespace detail

/// The boundary, oriented outwards: a closed surface. Attribute c of a vertex is component c of the
/// field. As slice(), it needs no preroll where all data are asked for.
Projected<Slice> boundary_surface(const Prerolls& prerolls, const Projection& projection = {},
                                  const IsosurfaceOptions& options = {}, const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> Projected<Slice> boundary_surface(
        const Grid& grid, const Field& field, const Projection& projection = {},
        const IsosurfaceOptions& options = {}, const Work& work = {}) {
        return boundary_surface(Prerolls(grid, field), projection, options, work);
    }

}  // namespace nestgrid
