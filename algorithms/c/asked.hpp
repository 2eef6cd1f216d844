// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a C code asks for: its options, and what the algorithms need of them.
#pragma once

#include <memory>
#include <span>

#include <nestgrid/algorithms/options.h>
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid {

/// Options of one call, complete and in range.
class Asked {
public:
    /// \param given may be NULL
    /// \param grid that is drawn on, borrowed like its field; looked at once they are in order
    /// \throw InvalidInput where a number is out of range, or two contradict each other
    Asked(const nestgrid_options* given, const nestgrid_grid* grid, const nestgrid_field* field);

    const nestgrid_options& options() const { return options_; }
    std::span<const nestgrid_field* const> attributes() const {
        return {options_.attributes, options_.attribute_count};
    }
    const Executor& executor() const { return *executor_; }
    /// Whether all of the data are asked for.
    bool everything() const {
        return options_.threshold == 0 && options_.error == 0 && options_.max_triangles == 0;
    }
    /// The criteria that are asked for, from the prerolls that the caller keeps, if any.
    /// \param isovalues of the level sets; none for other drawings
    /// \throw InvalidInput where the indicator is not for the drawing or for the grid, and where
    /// the
    ///        prerolls are of others
    Criteria criteria(const FieldOnGrid& field, std::span<const double> isovalues) const;
    /// But for the threshold and the number of triangles.
    IsosurfaceOptions how_to_draw() const;

private:
    std::string indicator_for(const FieldOnGrid& field, bool level_sets) const;
    bool rules_of_simplices() const;

    nestgrid_options options_{};
    const nestgrid_grid* grid_;
    const nestgrid_field* field_;
    std::unique_ptr<const Executor> executor_;
};

}  // namespace nestgrid
