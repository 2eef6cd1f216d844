// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "table_grid.hpp"

#include <algorithm>
#include <vector>

#include <boost/container/small_vector.hpp>

namespace nestgrid::detail {

static_assert(NESTGRID_SEGMENT == static_cast<int>(Shape::segment));
static_assert(NESTGRID_TRIANGLE == static_cast<int>(Shape::triangle));
static_assert(NESTGRID_QUADRILATERAL == static_cast<int>(Shape::quadrilateral));
static_assert(NESTGRID_TETRAHEDRON == static_cast<int>(Shape::tetrahedron));
static_assert(NESTGRID_PYRAMID == static_cast<int>(Shape::pyramid));
static_assert(NESTGRID_PRISM == static_cast<int>(Shape::prism));
static_assert(NESTGRID_HEXAHEDRON == static_cast<int>(Shape::hexahedron));

namespace {

/// Lets ask(keys) write keys of 64 bits, as many as out.size(), and puts them into `out`.
template <class Key, class Ask>
void get_keys(std::span<Key> out, Ask&& ask) {
    if constexpr (std::is_same_v<Key, std::uint64_t>) {
        ask(out.data());
    } else {
        boost::container::small_vector<std::uint64_t, max_new_nodes> keys(out.size());
        ask(keys.data());
        std::copy(keys.begin(), keys.end(), out.begin());
    }
}

}  // namespace

void fail_in_table(int code, const char* what, const char* operation, const char* last_error) {
    const std::string why = last_error == nullptr ? "" : last_error;
    throw GridError("the operation '" + std::string(operation) + "' of the " + what + " failed" +
                    (why.empty() ? " with code " + std::to_string(code) : ": " + why));
}

TableContext::TableContext(const nestgrid_grid& table) : table_{&table} {
    if (table.make_context == nullptr) return;
    state_ = table.make_context(table.self);
    if (state_ != nullptr) return;
    const char* why = table.last_error == nullptr ? nullptr : table.last_error(table.self, nullptr);
    throw GridError("the operation 'make_context' of the grid failed" +
                    (why == nullptr || *why == '\0' ? "" : ": " + std::string(why)));
}

CoarseElement<nestgrid_element> TableGrid::coarse(std::size_t i, TableContext& c) const {
    nestgrid_coarse coarse{};
    check(table_.coarse(table_.self, c.state(), i, &coarse), "coarse", &c);
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

const Rule* TableGrid::split(const Element& e, TableContext& c) const {
    int rule = -1;
    check(table_.split(table_.self, c.state(), &e, &rule), "split", &c);
    if (rule < 0) return nullptr;
    if (rule >= table_.rule_count) {
        throw GridError("split gave rule " + std::to_string(rule) + " of " +
                        std::to_string(table_.rule_count));
    }
    return &rules_[static_cast<std::size_t>(rule)];
}

Hidden TableGrid::hidden(const Element& e, TableContext& c) const {
    const int part = ask<int>(table_.hidden, "hidden", e, c);
    if (part < 0 || part > 2) {
        throw GridError("hidden gave " + std::to_string(part) + ", not 0, 1 or 2");
    }
    return static_cast<Hidden>(part);
}

Presence TableGrid::presence(const Element& e, TableContext& c) const {
    const int which = ask<int>(table_.presence, "presence", e, c);
    if (which < 0 || which > 3) {
        throw GridError("presence gave " + std::to_string(which) + ", not 0, 1, 2 or 3");
    }
    return static_cast<Presence>(which);
}

bool TableGrid::offers(Feature feature) const {
    const bool keys = table_.corner_keys != nullptr && table_.new_keys != nullptr;
    switch (feature) {
        case Feature::own_keys:
            return keys;
        case Feature::dense_keys:
            return keys && table_.node_count > 0;
        case Feature::own_positions:
            return table_.corner_positions != nullptr;
        case Feature::new_positions:
            return table_.new_positions != nullptr;
        case Feature::constrained:
            return table_.constrained != nullptr;
        case Feature::masked:
            return table_.masked != nullptr;
        case Feature::hidden:
            return table_.hidden != nullptr;
        case Feature::outside:
            return table_.outside != nullptr;
        case Feature::boundary_faces:
            return table_.boundary_faces != nullptr;
        case Feature::geometry_degree:
            return table_.geometry_degree != nullptr;
        case Feature::hanging_parents:
            return keys && table_.hanging_parents != nullptr;
        case Feature::presence:
            return table_.presence != nullptr;
        default:
            return false;
    }
}

void TableGrid::keys(KeysFunction function, const char* operation, const Element& e,
                     std::span<NodeKey> out, TableContext& c) const {
    get_keys(out, [&](std::uint64_t* keys) {
        check(function(table_.self, c.state(), &e, out.size(), keys), operation, &c);
    });
}

std::array<NodeKey, 2> TableGrid::hanging_parents(NodeKey node) const {
    const auto key = static_cast<std::uint64_t>(node);  // own keys have 64 bits
    std::array<std::uint64_t, 2> parents{key, key};
    check(table_.hanging_parents(table_.self, key, parents.data()), "hanging_parents", nullptr);
    return {parents[0], parents[1]};
}

bool TableGrid::tells_bisections() const {
    const nestgrid_grid& t = table_;
    return t.middles != nullptr && t.node_keys != nullptr && t.node_positions != nullptr &&
           t.corner_keys != nullptr && t.new_keys != nullptr && t.corner_positions != nullptr &&
           t.boundary_faces != nullptr && t.conforming != 0 && t.constrained == nullptr &&
           t.masked == nullptr && t.hidden == nullptr && t.outside == nullptr &&
           t.presence == nullptr;
}

void TableGrid::node_keys(std::span<const std::uint64_t> nodes, std::span<NodeKey> out) const {
    get_keys(out, [&](std::uint64_t* keys) {
        check(table_.node_keys(table_.self, nodes.size(), nodes.data(), keys), "node_keys",
              nullptr);
    });
}

template <class Real>
void TableField<Real>::node_values(std::span<const std::uint64_t> nodes,
                                   std::span<const NodeKey> keys, std::span<Real> out) const {
    const auto ask = [&](const std::uint64_t* narrow) {
        check(table_.node_values(table_.self, nodes.size(), nodes.data(), narrow, out.data()),
              "node_values", nullptr);
    };
    if constexpr (std::is_same_v<NodeKey, std::uint64_t>) {
        ask(keys.data());
    } else {
        ask(std::vector<std::uint64_t>(keys.begin(), keys.end()).data());
    }
}

template class TableField<float>;
template class TableField<double>;

}  // namespace nestgrid::detail
