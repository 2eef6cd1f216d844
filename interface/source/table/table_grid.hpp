// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Calls the functions of tables written in C (nestgrid.h), checks their answers, and throws where
// they fail. Answers `offers` as a model of the concepts does, but knows its dimension at run time.
#pragma once

#include <deque>
#include <string>
#include <variant>
#include <vector>

#include <nestgrid/nestgrid.h>
#include <nestgrid/error.hpp>
#include <nestgrid/grid.hpp>
#include <nestgrid/keys.hpp>
#include <nestgrid/optional.hpp>

namespace nestgrid::detail {

/// A copy of the table in which the functions that it is too short for are null.
/// \throw InvalidInput for a table without a required function, or of another dimension than 2 or 3
nestgrid_grid checked_table(const nestgrid_grid& given);

/// \throw InvalidInput for a table with other values than asked for, without components, or without
///        a required function
nestgrid_field checked_table(const nestgrid_field& given, int value_type);

/// The rules of a table whose functions are in order.
/// \throw InvalidInput for one that make_rule refuses
std::deque<Rule> rules_of_table(const nestgrid_grid& table);

/// \param last_error of the table, or null
/// \throw GridError with the table's own sentence, where it has one
[[noreturn]] void fail_in_table(int code, const char* what, const char* operation,
                                const char* last_error);

template <class Real>
constexpr int value_type_code() {
    return std::is_same_v<Real, float> ? NESTGRID_FLOAT : NESTGRID_DOUBLE;
}

using TableRows = double (*)[3];             // NOLINT(modernize-avoid-c-arrays)
using ConstTableRows = const double (*)[3];  // NOLINT(modernize-avoid-c-arrays)

inline TableRows as_rows(Point* points) {
    static_assert(sizeof(Point) == 3 * sizeof(double));
    return reinterpret_cast<TableRows>(points);
}

/// A task's state, which the table makes.
class TableContext {
public:
    /// \throw GridError where make_context fails
    explicit TableContext(const nestgrid_grid& table);
    TableContext(const TableContext&) = delete;
    TableContext& operator=(const TableContext&) = delete;
    ~TableContext() {
        if (state_ != nullptr && table_->free_context != nullptr) {
            table_->free_context(table_->self, state_);
        }
    }
    void* state() const { return state_; }

private:
    const nestgrid_grid* table_;
    void* state_ = nullptr;
};

/// Fails where an operation of a table returned a code.
/// \param what the table is of: "grid" or "field"
/// \param context that the operation was given, or null
template <class Table>
void require_success(const Table& table, const char* what, int code, const char* operation,
                     const TableContext* context) {
    if (code == 0) return;
    void* const state = context == nullptr ? nullptr : context->state();
    fail_in_table(code, what, operation,
                  table.last_error == nullptr ? nullptr : table.last_error(table.self, state));
}

/// The grid of a table. Contexts point to it.
class TableGrid {
public:
    using Element = nestgrid_element;
    using Context = TableContext;

    /// \throw InvalidInput as checked_table() and rules_of_table()
    explicit TableGrid(const nestgrid_grid& given)
        : table_{checked_table(given)}, rules_{rules_of_table(table_)} {}
    TableGrid(const TableGrid&) = delete;
    TableGrid& operator=(const TableGrid&) = delete;

    const nestgrid_grid& table() const { return table_; }
    TableContext make_context() const { return TableContext(table_); }

    std::size_t coarse_count() const {
        std::size_t count = 0;
        check(table_.coarse_count(table_.self, &count), "coarse_count", nullptr);
        return count;
    }
    CoarseElement<Element> coarse(std::size_t i, TableContext& c) const;
    const Rule* split(const Element& e, TableContext& c) const;
    void children(const Element& e, std::span<Element> out, TableContext& c) const {
        check(table_.children(table_.self, c.state(), &e, out.size(), out.data()), "children", &c);
    }

    bool offers(Feature feature) const;
    void corner_keys(const Element& e, std::span<NodeKey> out, TableContext& c) const {
        keys(table_.corner_keys, "corner_keys", e, out, c);
    }
    void new_keys(const Element& e, std::span<NodeKey> out, TableContext& c) const {
        keys(table_.new_keys, "new_keys", e, out, c);
    }
    std::size_t node_count() const { return table_.node_count; }
    void corner_positions(const Element& e, std::span<Point> out, TableContext& c) const {
        check(table_.corner_positions(table_.self, c.state(), &e, out.size(), as_rows(out.data())),
              "corner_positions", &c);
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out,
                       TableContext& c) const {
        check(table_.new_positions(table_.self, c.state(), &e, which, out.size(),
                                   as_rows(out.data())),
              "new_positions", &c);
    }
    NodeMask constrained(const Element& e, TableContext& c) const {
        return ask<std::uint64_t>(table_.constrained, "constrained", e, c);
    }
    std::array<NodeKey, 2> hanging_parents(NodeKey node) const;
    bool conforming() const { return table_.conforming != 0; }
    bool masked(const Element& e, TableContext& c) const {
        return ask<int>(table_.masked, "masked", e, c) != 0;
    }
    Hidden hidden(const Element& e, TableContext& c) const;
    Presence presence(const Element& e, TableContext& c) const;
    NodeMask outside(const Element& e, TableContext& c) const {
        return ask<std::uint64_t>(table_.outside, "outside", e, c);
    }
    unsigned boundary_faces(const Element& e, TableContext& c) const {
        return ask<unsigned>(table_.boundary_faces, "boundary_faces", e, c);
    }
    int geometry_degree(const Element& leaf, TableContext& c) const {
        return ask<int>(table_.geometry_degree, "geometry_degree", leaf, c);
    }
    void map(const Element& leaf, std::span<const Point> reference, std::span<Point> out,
             TableContext& c) const {
        check(table_.map(table_.self, c.state(), &leaf, reference.size(),
                         reinterpret_cast<ConstTableRows>(reference.data()), as_rows(out.data())),
              "map", &c);
    }
    std::uint64_t epoch() const {
        std::uint64_t epoch = 0;
        if (table_.epoch != nullptr) check(table_.epoch(table_.self, &epoch), "epoch", nullptr);
        return epoch;
    }

    /// Whether the table tells bisections in rows of nodes.
    bool tells_bisections() const;
    /// \param out NESTGRID_NO_NODE where an edge is not halved; may be a
    void middles(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b,
                 std::span<std::uint64_t> out) const {
        check(table_.middles(table_.self, out.size(), a.data(), b.data(), out.data()), "middles",
              nullptr);
    }
    void node_keys(std::span<const std::uint64_t> nodes, std::span<NodeKey> out) const;
    void node_positions(std::span<const std::uint64_t> nodes, std::span<Point> out) const {
        check(table_.node_positions(table_.self, nodes.size(), nodes.data(), as_rows(out.data())),
              "node_positions", nullptr);
    }

private:
    /// \param context that the operation was given, or null
    void check(int code, const char* operation, const TableContext* context) const {
        require_success(table_, "grid", code, operation, context);
    }
    template <class Answer, class Function>
    Answer ask(Function function, const char* operation, const Element& e, TableContext& c) const {
        Answer answer{};
        check(function(table_.self, c.state(), &e, &answer), operation, &c);
        return answer;
    }
    using KeysFunction = int (*)(const void*, void*, const nestgrid_element*, std::size_t,
                                 std::uint64_t*);
    void keys(KeysFunction function, const char* operation, const Element& e,
              std::span<NodeKey> out, TableContext& c) const;

    nestgrid_grid table_;
    std::deque<Rule> rules_;
};

/// The field of a table.
template <class Real>
class TableField {
public:
    using value_type = Real;

    /// \throw InvalidInput as checked_table()
    explicit TableField(const nestgrid_field& given)
        : table_{checked_table(given, value_type_code<Real>())} {}

    const nestgrid_field& table() const { return table_; }

    NodeMask coarse_values(std::size_t i, std::span<Real> out, TableContext& c) const {
        std::uint64_t missing = 0;
        check(table_.coarse_values(table_.self, c.state(), i, nodes_in(out), out.data(), &missing),
              "coarse_values", &c);
        return missing;
    }
    NodeMask new_values(const nestgrid_element& e, NodeMask which, std::span<Real> out,
                        TableContext& c) const {
        std::uint64_t missing = 0;
        check(table_.new_values(table_.self, c.state(), &e, which, nodes_in(out), out.data(),
                                &missing),
              "new_values", &c);
        return missing;
    }
    bool offers(Feature feature) const {
        return (feature == Feature::gradients && table_.corner_gradients != nullptr) ||
               (feature == Feature::degree && table_.degree != nullptr);
    }
    int degree(const nestgrid_element& leaf, TableContext& c) const {
        int degree = 1;
        check(table_.degree(table_.self, c.state(), &leaf, &degree), "degree", &c);
        return degree;
    }
    void evaluate(const nestgrid_element& leaf, std::span<const Point> reference,
                  std::span<Real> out, TableContext& c) const {
        check(table_.evaluate(table_.self, c.state(), &leaf, reference.size(),
                              reinterpret_cast<ConstTableRows>(reference.data()), out.data()),
              "evaluate", &c);
    }
    /// Whether the table gives values at nodes that the grid tells in rows, and gradients.
    bool tells_values() const { return table_.node_values != nullptr; }
    bool tells_gradients() const { return tells_values() && table_.node_gradients != nullptr; }
    void corner_gradients(const nestgrid_element& e, std::span<Point> out, TableContext& c) const {
        check(table_.corner_gradients(table_.self, c.state(), &e, out.size(), as_rows(out.data())),
              "corner_gradients", &c);
    }
    /// Values at nodes that the grid tells in rows.
    void node_values(std::span<const std::uint64_t> nodes, std::span<const NodeKey> keys,
                     std::span<Real> out) const;
    /// Gradients at such nodes.
    void node_gradients(std::span<const std::uint64_t> nodes, std::span<Point> out) const {
        check(table_.node_gradients(table_.self, nodes.size(), nodes.data(), as_rows(out.data())),
              "node_gradients", nullptr);
    }

private:
    std::size_t nodes_in(std::span<Real> values) const {
        return values.size() / static_cast<std::size_t>(table_.components);
    }
    void check(int code, const char* operation, const TableContext* context) const {
        require_success(table_, "field", code, operation, context);
    }

    nestgrid_field table_;
};

extern template class TableField<float>;
extern template class TableField<double>;

/// The fields of several tables, their components one behind the other.
template <class Real>
class TableFields {
public:
    /// \throw InvalidInput as checked_table(), and where a table is NULL
    TableFields(const nestgrid_field& first, std::span<const nestgrid_field* const> more);

    const TableField<Real>& first() const { return first_; }
    int components() const { return components_; }

    NodeMask coarse_values(std::size_t i, std::span<Real> out, TableContext& c) const {
        if (more_.empty()) return first_.coarse_values(i, out, c);
        return gather(
            out, [&](const auto& field, auto values) { return field.coarse_values(i, values, c); });
    }
    NodeMask new_values(const nestgrid_element& e, NodeMask which, std::span<Real> out,
                        TableContext& c) const {
        if (more_.empty()) return first_.new_values(e, which, out, c);
        return gather(out, [&](const auto& field, auto values) {
            return field.new_values(e, which, values, c);
        });
    }

private:
    using AnyField = std::variant<TableField<float>, TableField<double>>;

    /// Sets `out` from all fields, by ask(field, values) of each.
    /// \return the nodes that one of them could not give
    template <class Ask>
    NodeMask gather(std::span<Real> out, const Ask& ask) const;

    TableField<Real> first_;
    std::vector<AnyField> more_;
    int components_;
};

}  // namespace nestgrid::detail
