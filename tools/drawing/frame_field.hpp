// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A field, or several frames of one on one grid, behind hierarchies that keep alive what they are
// made of.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/detail/erase.hpp>

using SharedHierarchy = std::variant<std::shared_ptr<const nestgrid::Hierarchy<float>>,
                                     std::shared_ptr<const nestgrid::Hierarchy<double>>>;

struct FrameField {
    std::string name = "value";
    std::vector<SharedHierarchy> frames;  ///< of one grid; at least one
    std::vector<double> times{0};         ///< of the frames, ascending
    /// Gives the field between frames, from one weight for each. Empty where there is one frame.
    std::function<SharedHierarchy(std::span<const float> weights)> between{};
};

/// Keeps the grid, the field and what both borrow from alive, with the hierarchy made of them.
template <class Grid, class Field>
std::shared_ptr<const nestgrid::Hierarchy<typename Field::value_type>> share(
    std::shared_ptr<const Grid> grid, Field field, std::shared_ptr<const void> memory) {
    struct Kept {
        Kept(std::shared_ptr<const Grid> g, Field f, std::shared_ptr<const void> m)
            : memory{std::move(m)},
              grid{std::move(g)},
              field{std::move(f)},
              hierarchy(nestgrid::erase(*grid, field)) {}
        std::shared_ptr<const void> memory;
        std::shared_ptr<const Grid> grid;
        Field field;
        decltype(nestgrid::erase(std::declval<const Grid&>(),
                                 std::declval<const Field&>())) hierarchy;
    };
    auto kept = std::make_shared<const Kept>(std::move(grid), std::move(field), std::move(memory));
    return {kept, &kept->hierarchy};
}

/// Makes fields on a grid the frames of a FrameField.
/// \param times one for each field, ascending
/// \param memory that the grid and the fields borrow from; may be null
template <class Grid, class Field>
void set_frames(FrameField& to, std::shared_ptr<const Grid> grid, std::vector<Field> fields,
                std::vector<double> times, std::shared_ptr<const void> memory) {
    to.times = std::move(times);
    for (const Field& field : fields) to.frames.emplace_back(share(grid, field, memory));
    if (fields.size() == 1) return;
    const auto kept = std::make_shared<const std::vector<Field>>(std::move(fields));
    to.between = [grid, kept, memory](std::span<const float> weights) -> SharedHierarchy {
        std::vector<const Field*> borrowed;
        for (const Field& field : *kept) borrowed.push_back(&field);
        using Parts = std::pair<std::shared_ptr<const std::vector<Field>>, decltype(memory)>;
        return share(grid, nestgrid::Between<Field>(std::move(borrowed), weights),
                     std::make_shared<const Parts>(kept, memory));
    };
}

/// Hides the elements at which a frame has no value (NaN), in all frames.
/// \throw nestgrid::GridError as nestgrid::HiddenElements
void hide_missing(FrameField& field);
