// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables written in C are checked here before anything asks them.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "table_grid.hpp"

namespace nestgrid::detail {

namespace {

/// Checks one rule of a table.
class TableRule {
public:
    explicit TableRule(const nestgrid_rule& rule) : rule_{&rule} {}

    Rule make() const {
        check_counts();
        std::vector<Stencil> nodes;
        for (const nestgrid_stencil& s :
             std::span(rule_->new_nodes, static_cast<std::size_t>(rule_->new_node_count))) {
            nodes.push_back(stencil(s));
        }
        std::vector<Child> children;
        for (const nestgrid_child& c :
             std::span(rule_->children, static_cast<std::size_t>(rule_->child_count))) {
            children.push_back(child(c));
        }
        return make_rule(name(), shape(rule_->shape), nodes, children);
    }

private:
    std::string name() const { return rule_->name == nullptr ? "" : rule_->name; }

    [[noreturn]] void refuse(const std::string& what) const {
        throw InvalidInput("rule '" + name() + "': " + what);
    }

    void check_counts() const {
        if (rule_->new_node_count < 0 || rule_->new_node_count > max_new_nodes) {
            refuse(std::to_string(rule_->new_node_count) +
                   " new nodes, not 0 to 64; where it "
                   "would need more, refine in several steps");
        }
        if (rule_->child_count < 1 || rule_->child_count > max_children) {
            refuse(std::to_string(rule_->child_count) +
                   " children, not 1 to 64; where it would "
                   "need more, refine in several steps");
        }
        if ((rule_->new_node_count > 0 && rule_->new_nodes == nullptr) ||
            rule_->children == nullptr) {
            refuse("its tables are NULL");
        }
    }

    Shape shape(int number) const {
        if (number <= 0 || number >= shape_count) {
            refuse("the shape " + std::to_string(number) + " does not exist");
        }
        return static_cast<Shape>(number);
    }

    Stencil stencil(const nestgrid_stencil& s) const {
        if (s.count < 2 || s.count > max_corners) {
            refuse("a stencil has " + std::to_string(s.count) + " parents, not 2 to 8");
        }
        if (s.number < 0 || s.number > 255) {
            refuse("a stencil has the number " + std::to_string(s.number) + ", not 0 to 255");
        }
        Stencil stencil;
        stencil.count = static_cast<std::uint8_t>(s.count);
        stencil.number = static_cast<std::uint8_t>(s.number);
        for (std::size_t i = 0; i < stencil.count; ++i) {
            if (s.parent[i] < 0 || s.parent[i] > 255) refuse("a parent is no node");
            stencil.parent[i] = static_cast<std::uint8_t>(s.parent[i]);
            stencil.weight[i] = s.weight[i];
        }
        return stencil;
    }

    Child child(const nestgrid_child& c) const {
        Child child;
        child.shape = shape(c.shape);
        if (c.orientation != 1 && c.orientation != -1) {
            refuse("a child has an orientation that is neither 1 nor -1");
        }
        child.orientation = static_cast<std::int8_t>(c.orientation);
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            if (c.corner[i] < 0 || c.corner[i] > 255) refuse("a corner of a child is no node");
            child.corner[i] = static_cast<std::uint8_t>(c.corner[i]);
        }
        return child;
    }

    const nestgrid_rule* rule_;
};

/// Copies as much of a table as it says there is.
template <class Table>
Table copy(const Table& given, std::size_t least_size, const std::string& what) {
    if (given.size < least_size) {
        throw InvalidInput("the table of the " + what + " is too small: its size says " +
                           std::to_string(given.size) + " bytes");
    }
    Table table{};
    std::memcpy(&table, &given, std::min(given.size, sizeof(table)));
    return table;
}

void require(bool there, const char* name) {
    if (there) return;
    throw InvalidInput("the table of the grid lacks the function '" + std::string(name) + "'");
}

}  // namespace

nestgrid_grid checked_table(const nestgrid_grid& given) {
    const nestgrid_grid table = copy(given, offsetof(nestgrid_grid, corner_keys), "grid");
    if (table.dimension != 2 && table.dimension != 3) {
        throw InvalidInput("the table is of a grid of dimension " +
                           std::to_string(table.dimension) + ", not 2 or 3");
    }
    require(table.coarse_count != nullptr, "coarse_count");
    require(table.coarse != nullptr, "coarse");
    require(table.split != nullptr, "split");
    require(table.children != nullptr, "children");
    if ((table.geometry_degree == nullptr) != (table.map == nullptr)) {
        throw InvalidInput("the table of the grid has one of 'geometry_degree' and 'map' alone");
    }
    return table;
}

nestgrid_field checked_table(const nestgrid_field& given, int value_type) {
    const nestgrid_field table = copy(given, offsetof(nestgrid_field, corner_gradients), "field");
    if (table.value_type != NESTGRID_FLOAT && table.value_type != NESTGRID_DOUBLE) {
        throw InvalidInput("the value_type " + std::to_string(table.value_type) +
                           " of the field is neither float nor double");
    }
    if (table.value_type != value_type) {
        throw InvalidInput(
            "the values of the field are of another type, float or double, than "
            "asked for");
    }
    if (table.components < 1) {
        throw InvalidInput("the field has " + std::to_string(table.components) + " components");
    }
    if (table.coarse_values == nullptr || table.new_values == nullptr) {
        throw InvalidInput(
            "the table of the field lacks the function 'coarse_values' or 'new_values'");
    }
    if ((table.degree == nullptr) != (table.evaluate == nullptr)) {
        throw InvalidInput("the table of the field has one of 'degree' and 'evaluate' alone");
    }
    return table;
}

std::deque<Rule> rules_of_table(const nestgrid_grid& table) {
    if (table.rule_count < 0 || (table.rule_count > 0 && table.rules == nullptr)) {
        throw InvalidInput("the table of the grid lacks its rules");
    }
    std::deque<Rule> rules;
    for (int i = 0; i < table.rule_count; ++i) {
        rules.push_back(TableRule(table.rules[i]).make());
    }
    return rules;
}

}  // namespace nestgrid::detail
