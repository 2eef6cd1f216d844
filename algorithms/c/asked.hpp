// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a C code asks for: its options, and what the algorithms need of them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include <nestgrid/algorithms/options.h>
#include <nestgrid/algorithms/drawing.hpp>
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
    /// How finely a field is drawn.
    /// \param level_sets whether level sets are drawn of it
    Projection projection(const FieldOnGrid& field, bool level_sets) const;
    /// Calls draw(prerolls, work) with the prerolls that the caller keeps, or else with new ones.
    /// \throw InvalidInput where the prerolls are of another grid or field
    template <class Draw>
    auto with_prerolls(const FieldOnGrid& field, const Draw& draw) const {
        const Work work{.executor = executor(), .same_field = &field};
        if (options_.prerolls != nullptr) return draw(kept_prerolls(field), work);
        Prerolls own(field);
        return draw(own, work);
    }
    /// But for the threshold and the number of triangles.
    IsosurfaceOptions how_to_draw() const;

private:
    Prerolls& kept_prerolls(const FieldOnGrid& field) const;
    std::string indicator_for(const FieldOnGrid& field, bool level_sets) const;
    bool rules_of_simplices() const;

    nestgrid_options options_{};
    std::optional<LensRequest> lens_;
    std::optional<RegionRequest> region_;
    const nestgrid_grid* grid_;
    const nestgrid_field* field_;
    std::unique_ptr<const Executor> executor_;
};

}  // namespace nestgrid
