// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A field in space, or several frames of one, as an Explorer takes it. What owns the grid and the
// values is kept alive by the field.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/detail/erase.hpp>

namespace nestgrid::view {

using SharedHierarchy =
    std::variant<std::shared_ptr<const Hierarchy<float>>, std::shared_ptr<const Hierarchy<double>>>;

/// How often values occur, in bins of equal width from the least value to the greatest one.
struct Histogram {
    static constexpr std::size_t bins = 128;

    double least = 0;
    double greatest = 0;
    std::array<double, bins> counts{};

    /// A value that parts the data in two, so that values vary little within both parts (Otsu
    /// 1979); the middle of the range where the data are constant or not known.
    double dividing_value() const;
};

/// \param at at(i) is value i; of many values every n-th is counted
template <class At>
Histogram histogram_of(std::size_t count, const At& at) {
    constexpr std::size_t most = 4000000;
    Histogram h;
    if (count == 0) return h;
    h.least = h.greatest = static_cast<double>(at(std::size_t{0}));
    const std::size_t step = (count + most - 1) / most;
    for (std::size_t i = 0; i < count; i += step) {
        const auto value = static_cast<double>(at(i));
        h.least = std::min(h.least, value);
        h.greatest = std::max(h.greatest, value);
    }
    const double width = h.greatest - h.least;
    if (!(width > 0)) return h;
    for (std::size_t i = 0; i < count; i += step) {
        const double part = (static_cast<double>(at(i)) - h.least) / width;
        const auto bin = static_cast<std::size_t>(part * Histogram::bins);
        ++h.counts[std::min(bin, Histogram::bins - 1)];
    }
    return h;
}

struct ExploredField {
    std::string title = "field";          ///< of the page: the name of a file, say
    std::string name = "value";           ///< of the field
    std::vector<SharedHierarchy> frames;  ///< of one grid; at least one
    std::vector<double> times{0};         ///< of the frames, ascending
    /// Gives the field between frames, from one weight for each. Empty where there is one frame.
    std::function<SharedHierarchy(std::span<const float> weights)> between{};
    std::array<Point, 2> box{};  ///< the least and the greatest coordinates of the domain
    Histogram histogram{};       ///< of the first frame
};

/// The box around the coarse grid.
template <class Real>
std::array<Point, 2> box_of(const Hierarchy<Real>& hierarchy);

/// Keeps the grid, the field and what both borrow from alive, with the hierarchy made of them.
template <class Grid, class Field>
std::shared_ptr<const Hierarchy<typename Field::value_type>> share(
    std::shared_ptr<const Grid> grid, Field field, std::shared_ptr<const void> memory) {
    struct Kept {
        Kept(std::shared_ptr<const Grid> g, Field f, std::shared_ptr<const void> m)
            : memory{std::move(m)},
              grid{std::move(g)},
              field{std::move(f)},
              hierarchy(erase(*grid, field)) {}
        std::shared_ptr<const void> memory;
        std::shared_ptr<const Grid> grid;
        Field field;
        decltype(erase(std::declval<const Grid&>(), std::declval<const Field&>())) hierarchy;
    };
    auto kept = std::make_shared<const Kept>(std::move(grid), std::move(field), std::move(memory));
    return {kept, &kept->hierarchy};
}

/// One field on a grid. Box and histogram are for the caller to set: those of the coarse grid, and
/// none.
/// \param memory that the grid and the field borrow from; may be null
template <class Grid, class Field>
ExploredField still_field(std::shared_ptr<const Grid> grid, const Field& field,
                          std::shared_ptr<const void> memory = nullptr) {
    ExploredField f;
    auto hierarchy = share(std::move(grid), field, std::move(memory));
    f.box = box_of(*hierarchy);
    f.frames.emplace_back(std::move(hierarchy));
    return f;
}

/// Several frames of one field on a grid; box and histogram likewise.
/// \param times one for each field, ascending
template <class Grid, class Field>
ExploredField moving_field(std::shared_ptr<const Grid> grid, std::vector<Field> fields,
                           std::vector<double> times,
                           std::shared_ptr<const void> memory = nullptr) {
    ExploredField f;
    f.times = std::move(times);
    for (const Field& field : fields) f.frames.emplace_back(share(grid, field, memory));
    f.box = std::visit([](const auto& first) { return box_of(*first); }, f.frames.front());
    const auto kept = std::make_shared<const std::vector<Field>>(std::move(fields));
    f.between = [grid, kept, memory](std::span<const float> weights) -> SharedHierarchy {
        std::vector<const Field*> borrowed;
        for (const Field& field : *kept) borrowed.push_back(&field);
        using Parts = std::pair<std::shared_ptr<const std::vector<Field>>, decltype(memory)>;
        return share(grid, Between<Field>(std::move(borrowed), weights),
                     std::make_shared<const Parts>(kept, memory));
    };
    return f;
}

}  // namespace nestgrid::view
