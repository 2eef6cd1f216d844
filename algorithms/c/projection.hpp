// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Makes what the algorithms need of the options of a C code: a criterion, bounds and threads.
#pragma once

#include <memory>
#include <span>

#include <nestgrid/algorithms/options.h>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

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
    /// Whether the rules of the grid know simplices alone.
    bool rules_of_simplices() const;
    /// Prerolls of this grid and field that the caller keeps, or null.
    /// \throw InvalidInput where they are of others
    nestgrid_prerolls* prerolls() const;
    /// But for the threshold and the number of triangles.
    IsosurfaceOptions how_to_draw() const;

private:
    nestgrid_options options_{};
    const nestgrid_grid* grid_;
    const nestgrid_field* field_;
    std::unique_ptr<const Executor> executor_;
};

/// The indicator that was asked for, and the bounds beside it.
class Projection {
public:
    /// \param isovalues of the level sets; none for other drawings
    /// \throw InvalidInput where the indicator is not for the drawing or for the grid
    template <class Real>
    Projection(const Hierarchy<Real>& hierarchy, const Asked& asked,
               std::span<const double> isovalues);

    double threshold() const { return threshold_; }
    const HierarchicalIndicator& bounds() const { return *bounds_; }
    Threshold at(double threshold) const {
        if (swept_) return {&*swept_, threshold};
        return {&*bounds_, threshold};
    }

private:
    double threshold_;
    std::shared_ptr<const HierarchicalIndicator> bounds_;
    std::shared_ptr<const SweptIndicator>
        swept_;  // where another indicator than the bounds' was asked for
};

}  // namespace nestgrid
