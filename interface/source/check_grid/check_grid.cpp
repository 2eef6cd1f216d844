// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/check_grid.hpp>

#include <limits>

#include "checking_walk.hpp"
#include "laws.hpp"
#include "widened.hpp"

namespace nestgrid {

namespace {

/// Where several laws are broken at one place, the first one here is named.
constexpr auto laws = {
    detail::coarse_shape_law,  detail::coarse_face_law,    detail::coarse_node_law,
    detail::coarse_volume_law, detail::coarse_contact_law, detail::depth_law,
    detail::own_corner_law,    detail::repetition_law,     detail::rule_law,
    detail::hidden_law,        detail::presence_law,       detail::stencil_law,
    detail::key_law,           detail::value_law,          detail::hanging_law,
    detail::degree_law,        detail::curved_law,
};

std::optional<GridViolation> find_violation(const Hierarchy<double>& hierarchy, double epsilon,
                                            const CheckOptions& options) {
    detail::Inspection inspection(hierarchy, epsilon, options);
    detail::GridLaws asked;
    for (const auto& make : laws) asked.push_back(make(inspection));
    try {
        detail::CheckingWalk(inspection, asked).run();
    } catch (const detail::ViolationFound& found) {
        return found.violation;
    }
    return std::nullopt;
}

}  // namespace

namespace detail {

void note_operations(const std::vector<std::string>& grid, const std::vector<std::string>& field,
                     std::vector<std::string>& notes) {
    const auto add = [&](const std::string& who, const std::vector<std::string>& names) {
        std::string list = names.empty() ? "none" : names[0];
        for (std::size_t i = 1; i < names.size(); ++i) list += ", " + names[i];
        notes.push_back("optional operations found in the " + who + ": " + list);
    };
    add("grid", grid);
    add("field", field);
}

}  // namespace detail

std::optional<GridViolation> check_hierarchy(const Hierarchy<float>& hierarchy,
                                             const CheckOptions& options) {
    constexpr double epsilon = std::numeric_limits<float>::epsilon();
    return find_violation(detail::Widened(hierarchy), epsilon, options);
}

std::optional<GridViolation> check_hierarchy(const Hierarchy<double>& hierarchy,
                                             const CheckOptions& options) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    return find_violation(hierarchy, epsilon, options);
}

}  // namespace nestgrid
