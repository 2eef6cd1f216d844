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

#include "calls.hpp"
#include "ranks_in_c.hpp"

namespace nestgrid {

/// Within a handler of what this rank alone throws: throws it on all ranks, with its number. Does
/// nothing without ranks, or where these cannot be reached.
void tell_other_ranks(const nestgrid_options* given);

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
    /// Calls draw(prerolls, work) with the prerolls that the caller keeps, or else with new ones;
    /// on ranks with what they share. From here on, what one rank throws all throw.
    /// \throw InvalidInput where the prerolls are of another grid or field
    template <class Draw>
    auto with_prerolls(const FieldOnGrid& whole, const Draw& draw) const {
        const FieldOnGrid field = as_it_is_drawn(whole);
        const Work work{.executor = executor(), .same_field = &field};
        if (options_.prerolls != nullptr) return draw(kept_prerolls(field), work);
        Prerolls own(field);
        return draw(own, work);
    }
    /// The nodes and values that ranks share; null without ranks, and before they are known.
    std::shared_ptr<const PartOnRanks> part() const { return part_; }
    /// Whether ranks have begun to talk to each other.
    bool talks() const { return talks_; }
    /// \throw InvalidInput with ranks, for what is made for one process. \param what "a measure"
    void require_one_process(const std::string& what) const;
    /// But for the threshold and the number of triangles.
    IsosurfaceOptions how_to_draw() const;

private:
    FieldOnGrid as_it_is_drawn(const FieldOnGrid& field) const;
    Prerolls& kept_prerolls(const FieldOnGrid& field) const;
    std::string indicator_for(const FieldOnGrid& field, bool level_sets) const;
    bool rules_of_simplices() const;

    nestgrid_options options_{};
    std::optional<LensRequest> lens_;
    std::optional<RegionRequest> region_;
    const nestgrid_grid* grid_;
    const nestgrid_field* field_;
    std::unique_ptr<const Executor> executor_;
    mutable std::shared_ptr<const PartOnRanks> part_;
    mutable bool talks_ = false;
};

/// Calls function(asked) with the options of a C code, and returns its code; exceptions become
/// codes and sentences. Where ranks have not begun to talk, what one of them throws all throw.
/// \param begin begin() is called before
template <class Begin, class Function>
int with_options(const nestgrid_options* given, const nestgrid_grid* grid,
                 const nestgrid_field* field, char* message, std::size_t message_size,
                 const Begin& begin, const Function& function) {
    return without_exceptions(message, message_size, [&] {
        std::optional<Asked> asked;
        try {
            begin();
            asked.emplace(given, grid, field);
            return function(*asked);
        } catch (...) {
            if (!asked || !asked->talks()) tell_other_ranks(given);
            throw;
        }
    });
}
template <class Function>
int with_options(const nestgrid_options* given, const nestgrid_grid* grid,
                 const nestgrid_field* field, char* message, std::size_t message_size,
                 const Function& function) {
    const auto nothing = [] {};
    return with_options(given, grid, field, message, message_size, nothing, function);
}

}  // namespace nestgrid
