// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The table of a grid as a C code would fill it: rules as plain numbers, split() by their index,
// nothing of the library's own.
#pragma once

#include <vector>

#include <nestgrid/table.hpp>

namespace nestgrid_test {

template <class Grid>
class TableInC {
public:
    TableInC(const Grid& grid, const std::vector<const nestgrid::Rule*>& rules) {
        rules_ = rules;
        for (const nestgrid::Rule* rule : rules) {
            auto& nodes = stencils_.emplace_back();
            for (const nestgrid::Stencil& s : rule->new_nodes) {
                nestgrid_stencil& c = nodes.emplace_back();
                c.count = s.count;
                c.number = s.number;
                std::copy(s.parent.begin(), s.parent.end(), &c.parent[0]);
                std::copy(s.weight.begin(), s.weight.end(), &c.weight[0]);
            }
            auto& children = children_.emplace_back();
            for (const nestgrid::Child& child : rule->children) {
                nestgrid_child& c = children.emplace_back();
                c.shape = static_cast<int>(child.shape);
                c.orientation = child.orientation;
                std::copy(child.corner.begin(), child.corner.end(), &c.corner[0]);
            }
            in_c_.push_back({rule->name.c_str(), static_cast<int>(rule->parent),
                             rule->new_node_count(), nodes.data(), rule->child_count(),
                             children.data()});
        }
        table = nestgrid::make_table(grid);
        table.library_split = nullptr;
        table.split = split;
        table.rule_count = static_cast<int>(in_c_.size());
        table.rules = in_c_.data();
    }

    nestgrid_grid table;

private:
    static int split(const void* self, void* context, const nestgrid_element* e, int* number) {
        const void* rule = nullptr;
        const int code = nestgrid::detail::GridTable<Grid>::library_split(self, context, e, &rule);
        const auto at = std::find(rules_.begin(), rules_.end(), rule);
        *number = rule == nullptr ? -1 : static_cast<int>(at - rules_.begin());
        return code;
    }

    static inline std::vector<const nestgrid::Rule*> rules_;
    std::vector<std::vector<nestgrid_stencil>> stencils_;
    std::vector<std::vector<nestgrid_child>> children_;
    std::vector<nestgrid_rule> in_c_;
};

}  // namespace nestgrid_test
