// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of any_grid.hpp.
#pragma once

#include <nestgrid/any_grid.hpp>

namespace nestgrid {

namespace detail {

inline Rule rule_from_table(const nestgrid_rule& r) {
    const auto bad = [&](const std::string& what) {
        throw InvalidInput("rule '" + std::string(r.name == nullptr ? "" : r.name) + "': " + what);
    };
    const auto shape = [&](int s) {
        if (s <= 0 || s >= shape_count) bad("the shape " + std::to_string(s) + " does not exist");
        return static_cast<Shape>(s);
    };
    if (r.new_node_count < 0 || r.new_node_count > max_new_nodes) {
        bad(std::to_string(r.new_node_count) + " new nodes, not 0 to 64");
    }
    if (r.child_count < 1 || r.child_count > max_children) {
        bad(std::to_string(r.child_count) + " children, not 1 to 64");
    }
    if ((r.new_node_count > 0 && r.new_nodes == nullptr) || r.children == nullptr) {
        bad("its tables are NULL");
    }
    std::vector<Stencil> nodes;
    for (const nestgrid_stencil& s :
         std::span(r.new_nodes, static_cast<std::size_t>(r.new_node_count))) {
        if (s.count < 2 || s.count > max_corners) {
            bad("a stencil has " + std::to_string(s.count) + " parents, not 2 to 8");
        }
        if (s.number < 0 || s.number > 255) {
            bad("a stencil has the number " + std::to_string(s.number) + ", not 0 to 255");
        }
        Stencil stencil;
        stencil.count = static_cast<std::uint8_t>(s.count);
        stencil.number = static_cast<std::uint8_t>(s.number);
        for (std::size_t i = 0; i < stencil.count; ++i) {
            if (s.parent[i] < 0 || s.parent[i] > 255) bad("a parent is no node");
            stencil.parent[i] = static_cast<std::uint8_t>(s.parent[i]);
            stencil.weight[i] = s.weight[i];
        }
        nodes.push_back(stencil);
    }
    std::vector<Child> children;
    for (const nestgrid_child& c : std::span(r.children, static_cast<std::size_t>(r.child_count))) {
        Child child;
        child.shape = shape(c.shape);
        if (c.orientation != 1 && c.orientation != -1) {
            bad("a child has an orientation that is neither 1 nor -1");
        }
        child.orientation = static_cast<std::int8_t>(c.orientation);
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            if (c.corner[i] < 0 || c.corner[i] > 255) bad("a corner of a child is no node");
            child.corner[i] = static_cast<std::uint8_t>(c.corner[i]);
        }
        children.push_back(child);
    }
    return make_rule(r.name == nullptr ? "" : r.name, shape(r.shape), nodes, children);
}

}  // namespace detail

template <int dim>
AnyGrid<dim>::AnyGrid(const nestgrid_grid& given) {
    if (given.size < offsetof(nestgrid_grid, corner_keys)) {
        throw InvalidInput("the table of the grid is too small: its size says " +
                           std::to_string(given.size) + " bytes");
    }
    nestgrid_grid table{};
    std::memcpy(&table, &given, std::min(given.size, sizeof(table)));
    if (table.dimension != dim) {
        throw InvalidInput("the table is of a grid of dimension " +
                           std::to_string(table.dimension) + ", not " + std::to_string(dim));
    }
    const auto require = [](bool there, const char* name) {
        if (!there) {
            throw InvalidInput("the table of the grid lacks the function '" + std::string(name) +
                               "'");
        }
    };
    require(table.coarse_count != nullptr, "coarse_count");
    require(table.coarse != nullptr, "coarse");
    require(table.split != nullptr || table.library_split != nullptr, "split");
    require(table.children != nullptr, "children");
    if (table.library_split == nullptr) {
        if (table.rule_count < 0 || (table.rule_count > 0 && table.rules == nullptr)) {
            throw InvalidInput("the table of the grid lacks its rules");
        }
        auto rules = std::make_shared<std::deque<Rule>>();
        for (int i = 0; i < table.rule_count; ++i) {
            rules->push_back(detail::rule_from_table(table.rules[i]));
        }
        rules_ = rules;
    }
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
AnyField<Real, component_count>::AnyField(const nestgrid_field& given) : table_{} {
    if (given.size < offsetof(nestgrid_field, corner_gradients)) {
        throw InvalidInput("the table of the field is too small: its size says " +
                           std::to_string(given.size) + " bytes");
    }
    std::memcpy(&table_, &given, std::min(given.size, sizeof(table_)));
    if (table_.value_type != detail::value_type_code<Real>()) {
        throw InvalidInput(
            "the values of the field are of another type, float or double, than "
            "asked for");
    }
    if (table_.components != component_count) {
        throw InvalidInput("the field has " + std::to_string(table_.components) +
                           " components, not " + std::to_string(component_count));
    }
    if (table_.coarse_values == nullptr || table_.new_values == nullptr) {
        throw InvalidInput(
            "the table of the field lacks the function 'coarse_values' or 'new_values'");
    }
}

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
    detail::BisectionForwarder<detail::TableBisections<dim>, Real> forward(bisections, visitor);
    walk_bisections(bisections, told_values(), forward, e, value, level, orientation,
                    [&](const auto& walk) { visitor.end(walk.looked_at(), walk.visited()); });
}

}  // namespace nestgrid
