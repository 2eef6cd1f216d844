// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Height fields of a live grid of dimension 2 at the head of a VTK pipeline.
#pragma once

#include <nestgrid/adapters/vtk_grid_source.hpp>
#include <nestgrid/algorithms/height_field.hpp>

namespace nestgrid {

// Functions are called as those of VTK.
// NOLINTBEGIN(readability-identifier-naming)

/// The grid as a conforming triangulation, lifted along z by a scale times component 0.
class HeightFieldSource : public GridSource {
public:
    using Superclass = GridSource;
    static HeightFieldSource* New() { VTK_STANDARD_NEW_BODY(HeightFieldSource); }

    /// Both must outlive the source.
    /// \param names of components 0 ... of the field, as point data
    template <class Grid, class Field>
    void SetGrid(const Grid& grid, const Field& field, std::vector<std::string> names = {}) {
        static_assert(Grid::dimension == 2, "height fields need a grid of dimension 2");
        set_grid(grid, field, [this, names](const auto& hierarchy, const auto& indicator) {
            const ShadingOptions options{.threshold = GetThreshold()};
            return make_poly_data(height_field(hierarchy, scale_, indicator(), options).surface,
                                  names);
        });
    }

    /// 0: flat, with colours.
    void SetScale(double scale) { set(scale_, scale); }
    double GetScale() const { return scale_; }

protected:
    HeightFieldSource() = default;
    const char* GetClassNameInternal() const override { return "HeightFieldSource"; }

private:
    double scale_ = 1;
};

// NOLINTEND(readability-identifier-naming)

}  // namespace nestgrid
