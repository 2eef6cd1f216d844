// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of any_grid.hpp.
#pragma once

#include <nestgrid/any_grid.hpp>

namespace nestgrid {

namespace detail {

/// A copy of the table in which the functions that it is too short for are null.
/// \throw InvalidInput for a table of another dimension or without a required function
nestgrid_grid checked_table(const nestgrid_grid& given, int dimension);

/// \throw InvalidInput for a table with other values than asked for, or without a required function
nestgrid_field checked_table(const nestgrid_field& given, int value_type, int components);

/// The rules of a table whose functions are in order.
/// \throw InvalidInput for one that make_rule refuses
std::shared_ptr<const std::deque<Rule>> rules_of_table(const nestgrid_grid& table);

}  // namespace detail

template <int dim>
AnyGrid<dim>::AnyGrid(const nestgrid_grid& given) {
    const nestgrid_grid table = detail::checked_table(given, dim);
    if (table.library_split == nullptr) rules_ = detail::rules_of_table(table);
    table_ = std::make_shared<const nestgrid_grid>(table);
}

template <int dim>
CoarseElement<nestgrid_element> AnyGrid<dim>::coarse(std::size_t i, AnyContext& c) const {
    nestgrid_coarse coarse{};
    check(table_->coarse(table_->self, c.state(), i, &coarse), "coarse");
    if (coarse.shape <= 0 || coarse.shape >= shape_count) {
        throw GridError("coarse element " + std::to_string(i) + " has the shape " +
                        std::to_string(coarse.shape) + ", which does not exist");
    }
    if (coarse.orientation != 1 && coarse.orientation != -1) {
        throw GridError("coarse element " + std::to_string(i) +
                        " has an orientation that is neither 1 nor -1");
    }
    CoarseElement<Element> result;
    result.element = coarse.element;
    result.shape = static_cast<Shape>(coarse.shape);
    for (std::size_t k = 0; k < max_corners; ++k) {
        std::copy_n(&coarse.corners[k][0], 3, result.corners[k].begin());
        result.ids[k] = coarse.ids[k];
    }
    result.orientation = static_cast<std::int8_t>(coarse.orientation);
    return result;
}

template <int dim>
const Rule* AnyGrid<dim>::split(const Element& e, AnyContext& c) const {
    if (table_->library_split != nullptr) {
        const void* known = nullptr;
        check(table_->library_split(table_->self, c.state(), &e, &known), "split");
        return static_cast<const Rule*>(known);
    }
    int rule = -1;
    check(table_->split(table_->self, c.state(), &e, &rule), "split");
    if (rule < 0) return nullptr;
    if (rule >= table_->rule_count) {
        throw GridError("split gave rule " + std::to_string(rule) + " of " +
                        std::to_string(table_->rule_count));
    }
    return &(*rules_)[static_cast<std::size_t>(rule)];
}

template <int dim>
Hidden AnyGrid<dim>::hidden(const Element& e, AnyContext& c) const {
    const int part = ask<int>(table_->hidden, "hidden", e, c);
    if (part < 0 || part > 2) {
        throw GridError("hidden gave " + std::to_string(part) + ", not 0, 1 or 2");
    }
    return static_cast<Hidden>(part);
}

template <int dim>
bool AnyGrid<dim>::offers(Feature feature) const {
    const bool keys = table_->corner_keys != nullptr && table_->new_keys != nullptr;
    switch (feature) {
        case Feature::own_keys:
            return keys;
        case Feature::dense_keys:
            return keys && table_->node_count > 0;
        case Feature::own_positions:
            return table_->corner_positions != nullptr;
        case Feature::new_positions:
            return table_->new_positions != nullptr;
        case Feature::constrained:
            return table_->constrained != nullptr;
        case Feature::masked:
            return table_->masked != nullptr;
        case Feature::hidden:
            return table_->hidden != nullptr;
        case Feature::outside:
            return table_->outside != nullptr;
        case Feature::boundary_faces:
            return table_->boundary_faces != nullptr;
        default:
            return false;
    }
}

template <int dim>
template <class Function>
void AnyGrid<dim>::keys(Function function, const char* operation, const Element& e,
                        std::span<NodeKey> out, AnyContext& c) const {
    if constexpr (std::is_same_v<NodeKey, std::uint64_t>) {
        check(function(table_->self, c.state(), &e, out.size(), out.data()), operation);
    } else {
        std::array<std::uint64_t, max_new_nodes> keys{};  // also holds the keys of the corners
        check(function(table_->self, c.state(), &e, out.size(), keys.data()), operation);
        std::copy_n(keys.begin(), out.size(), out.begin());
    }
}

template <class Real, int component_count>
AnyField<Real, component_count>::AnyField(const nestgrid_field& given)
    : table_{detail::checked_table(given, detail::value_type_code<Real>(), component_count)} {}

template <class Real, int component_count>
template <int dim>
void AnyField<Real, component_count>::bisect(
    const AnyGrid<dim>& grid, AnyContext& c, const nestgrid_element& e, const Real* value,
    int level, int orientation, detail::ErasedBisectionVisitor<dim, Real>& visitor) const {
    if (!is_told_bisections(grid)) {
        table_.library_bisect(table_.self, &grid.table(), &e, value, level, orientation, &visitor);
        return;
    }
    const auto bisections = grid.told_bisections(c);
    const std::uint64_t tag = e.word[dim + 1];
    if (tag < 1 || tag > dim) {
        throw GridError("an element has the tag " + std::to_string(tag) + ", not 1 to " +
                        std::to_string(dim));
    }
    detail::walk_for(visitor, bisections, told_values(), e, value, level, orientation);
}

}  // namespace nestgrid
