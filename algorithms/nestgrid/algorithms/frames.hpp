// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of a field on one grid, and the field at any moment between them (paper, section 5.3).
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/prerolls.hpp>

namespace nestgrid {

/// One frame, or several at times, each with its prerolls.
class Frames {
public:
    /// Makes the field between the frames, from one weight for each.
    using Between = std::function<FieldOnGrid(std::span<const float> weights)>;

    /// No frames, until others are assigned.
    Frames() = default;
    /// \param times of the frames, ascending
    /// \param between may be empty where there is one frame
    /// \throw InvalidInput where there is no frame, or not one time for each
    Frames(std::vector<FieldOnGrid> frames, std::vector<double> times, Between between);

    std::size_t count() const { return prerolls_.size(); }
    const std::vector<double>& times() const { return times_; }
    const std::shared_ptr<Prerolls>& operator[](std::size_t frame) const {
        return prerolls_[frame];
    }

    /// The same frames without the elements at which any of them has no value (holes.hpp), with
    /// prerolls of their own; these frames where there are none.
    /// \param work may end the search for them
    /// \throw GridError as HiddenElements
    Frames without_missing(const Work& work = {}) const;

    /// The field where each frame counts by its weight, such as linear_weights(): that of a frame
    /// where its weight is 1 and the others are 0. It keeps the frames alive.
    /// \throw InvalidInput where there is not one finite weight for each frame
    std::shared_ptr<Prerolls> at(std::span<const float> weights) const;
    /// Makes of each frame what all times between them share: bounds, and the indicator where it
    /// serves between frames.
    /// \return the least and the greatest value of all frames
    /// \throw InvalidInput as Prerolls::choose()
    std::array<double, 2> prepare(const Projection& projection, const Work& work) const;
    /// Bytes of all that the prerolls of the frames keep.
    std::size_t memory_bytes() const;
    /// Drops what all prerolls keep.
    void clear();

private:
    std::vector<std::shared_ptr<Prerolls>> prerolls_;
    std::vector<double> times_;
    Between between_;
};

/// A field with all that it is made of, kept alive.
/// \param memory that the grid and the field borrow from; may be null
template <class Grid, class Field>
FieldOnGrid shared_field(std::shared_ptr<const Grid> grid, Field field,
                         std::shared_ptr<const void> memory) {
    using Erased = detail::ErasedHierarchy<Grid, Field>;
    struct Kept {
        Kept(std::shared_ptr<const Grid> g, Field f, std::shared_ptr<const void> m)
            : memory{std::move(m)},
              grid{std::move(g)},
              field{std::move(f)},
              hierarchy(*grid, field) {}
        std::shared_ptr<const void> memory;
        std::shared_ptr<const Grid> grid;
        Field field;
        Erased hierarchy;
    };
    const auto kept =
        std::make_shared<const Kept>(std::move(grid), std::move(field), std::move(memory));
    return std::shared_ptr<const Hierarchy<typename Field::value_type>>(kept, &kept->hierarchy);
}

/// Fields on one grid as frames.
/// \param fields one at least
/// \param times one for each field, ascending
/// \param memory that the grid and the fields borrow from; may be null
/// \throw InvalidInput as Frames
template <class Grid, class Field>
Frames shared_frames(const std::shared_ptr<const Grid>& grid, std::vector<Field> fields,
                     std::vector<double> times, const std::shared_ptr<const void>& memory) {
    std::vector<FieldOnGrid> frames;
    for (const Field& field : fields) frames.push_back(shared_field(grid, field, memory));
    const auto kept = std::make_shared<const std::vector<Field>>(std::move(fields));
    const auto between = [grid, kept, memory](std::span<const float> weights) {
        std::vector<const Field*> borrowed;
        for (const Field& field : *kept) borrowed.push_back(&field);
        using Parts =
            std::pair<std::shared_ptr<const std::vector<Field>>, std::shared_ptr<const void>>;
        return shared_field(grid, nestgrid::Between<Field>(std::move(borrowed), weights),
                            std::make_shared<const Parts>(kept, memory));
    };
    return {std::move(frames), std::move(times), between};
}

}  // namespace nestgrid
