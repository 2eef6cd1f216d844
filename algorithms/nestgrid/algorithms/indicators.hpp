// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The indicators of the library by name: the one list from which front ends offer them, and how
// each is made. One of your own needs no row here: make a Criterion of it (criterion.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// What thresholds of an indicator count.
enum class ThresholdUnit : std::uint8_t {
    data,    ///< units of the data, so that they may be given in percent of its range
    length,  ///< units of length of the grid
    none,    ///< pure numbers
};
/// "data", "length" or "none".
const char* unit_name(ThresholdUnit unit);

/// What an indicator is made of, beside the field.
struct IndicatorInput {
    double range = 0;                     ///< greatest less least value of the data
    Spread spread{};                      ///< as of measured_indicator()
    std::span<const double> isovalues{};  ///< of those of level sets (IndicatorKind::of_level_sets)
    const Bounds* bounds = nullptr;       ///< of the field; those of level sets need them
    const Executor& executor;
};

/// One indicator that the library offers.
struct IndicatorKind {
    std::string_view name;      ///< one word
    std::string_view measures;  ///< what it measures, in a few words
    ThresholdUnit unit = ThresholdUnit::data;
    /// Whether it holds for given isovalues only.
    bool of_level_sets = false;
    /// Whether the sum of those of frames, weighted like these, is one of the field between them
    /// (swept_key_frames.hpp).
    bool between_frames = false;
    /// What the grid must offer for the indicator to be above 0 anywhere, and the grids that do.
    std::optional<Feature> needs{};
    std::string_view needed_grids{};
    /// Where it is a HierarchicalIndicator: what that measures.
    std::optional<NodeError> of_nodes{};
    /// Makes the indicator where it is none.
    SweptIndicator (*make)(const FieldOnGrid& field, const IndicatorInput& input) = nullptr;

    /// \throw InvalidInput where the grid does not offer what the indicator needs
    void require(const HierarchyFacts& facts) const;
};

/// All of them, in the order in which lists name them. Their names differ.
std::span<const IndicatorKind> indicators();

/// \throw InvalidInput for a name of none, in a sentence that says which there are
const IndicatorKind& indicator_named(std::string_view name);

/// The indicator that keeps the error of isosurfaces with the fewest triangles: cut deviations on
/// simplices, elsewhere and between frames the deviations of elements (cuts_are_errors()).
const IndicatorKind& error_indicator(const HierarchyFacts& facts, bool between_frames);

namespace detail {

/// "a, b and c": the names, for sentences.
std::string indicator_names();

}  // namespace detail

}  // namespace nestgrid
