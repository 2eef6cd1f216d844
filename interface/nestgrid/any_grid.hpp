// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Type erasure: a grid and a field as values around one flat table of functions each (nestgrid.h),
// never one heap object per element. The table is generated from any model (make_table), or written
// in C; either way AnyGrid is a model again.
#pragma once

#include <deque>
#include <memory>

#include <nestgrid/nestgrid.h>
#include <nestgrid/table.hpp>
#include <nestgrid/table_bisections.hpp>

namespace nestgrid {

/// A task's state of the erased grid.
class AnyContext {
public:
    AnyContext() = default;
    explicit AnyContext(const nestgrid_grid& table) : table_{&table} {
        if (table.make_context != nullptr) state_ = table.make_context(table.self);
    }
    AnyContext(const AnyContext&) = delete;
    AnyContext& operator=(const AnyContext&) = delete;
    ~AnyContext() {
        if (state_ != nullptr && table_->free_context != nullptr) {
            table_->free_context(table_->self, state_);
        }
    }
    void* state() const { return state_; }

private:
    const nestgrid_grid* table_ = nullptr;
    void* state_ = nullptr;
};

/// A grid of dimension `dim` behind a table. What it was made of must outlive it.
template <int dim>
class AnyGrid {
public:
    using Element = nestgrid_element;
    using Context = AnyContext;
    static constexpr int dimension = dim;

    /// \throw InvalidInput for a table of another dimension, without a required function, or with
    ///        a rule that make_rule refuses
    explicit AnyGrid(const nestgrid_grid& table);

    /// Around a model; it is borrowed.
    template <class Grid>
        requires(!std::same_as<Grid, nestgrid_grid> && !std::same_as<Grid, AnyGrid>)
    explicit AnyGrid(const Grid& grid) : AnyGrid(make_table(grid)) {}

    const nestgrid_grid& table() const { return *table_; }

    AnyContext make_context() const { return AnyContext(*table_); }
    std::size_t coarse_count() const {
        std::size_t count = 0;
        check(table_->coarse_count(table_->self, &count), "coarse_count");
        return count;
    }
    CoarseElement<Element> coarse(std::size_t i, AnyContext& c) const;
    CoarseElement<Element> coarse(std::size_t i) const {
        AnyContext c = make_context();
        return coarse(i, c);
    }
    const Rule* split(const Element& e, AnyContext& c) const;
    void children(const Element& e, std::span<Element> out, AnyContext& c) const {
        check(table_->children(table_->self, c.state(), &e, out.size(), out.data()), "children");
    }

    bool offers(Feature feature) const;
    void corner_keys(const Element& e, std::span<NodeKey> out, AnyContext& c) const {
        keys(table_->corner_keys, "corner_keys", e, out, c);
    }
    void new_keys(const Element& e, std::span<NodeKey> out, AnyContext& c) const {
        keys(table_->new_keys, "new_keys", e, out, c);
    }
    std::size_t node_count() const { return table_->node_count; }
    void corner_positions(const Element& e, std::span<Point> out, AnyContext& c) const {
        check(
            table_->corner_positions(table_->self, c.state(), &e, out.size(), detail::as_rows(out)),
            "corner_positions");
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out,
                       AnyContext& c) const {
        check(table_->new_positions(table_->self, c.state(), &e, which, out.size(),
                                    detail::as_rows(out)),
              "new_positions");
    }
    NodeMask constrained(const Element& e, AnyContext& c) const {
        return ask<std::uint64_t>(table_->constrained, "constrained", e, c);
    }
    bool conforming() const { return table_->conforming != 0; }
    bool masked(const Element& e, AnyContext& c) const {
        return ask<int>(table_->masked, "masked", e, c) != 0;
    }
    Hidden hidden(const Element& e, AnyContext& c) const;
    NodeMask outside(const Element& e, AnyContext& c) const {
        return ask<std::uint64_t>(table_->outside, "outside", e, c);
    }
    unsigned boundary_faces(const Element& e, AnyContext& c) const {
        return ask<unsigned>(table_->boundary_faces, "boundary_faces", e, c);
    }
    /// Where a field's is_told_bisections() says so: those of this grid.
    detail::TableBisections<dim> told_bisections(AnyContext& c) const {
        return detail::TableBisections<dim>(*table_, c.state());
    }
    bool knows_stars() const { return table_->library_star_rows != nullptr; }
    template <class Function>
    void for_each_star_row(Function&& function) const {
        const std::function<void(const StarRow&)> call(std::ref(function));
        table_->library_star_rows(table_->self, &call);
    }
    std::uint64_t epoch() const {
        std::uint64_t epoch = 0;
        if (table_->epoch != nullptr) check(table_->epoch(table_->self, &epoch), "epoch");
        return epoch;
    }

private:
    static void check(int code, const char* operation) {
        detail::check_code(code, "grid", operation);
    }
    template <class Answer, class Function>
    Answer ask(Function function, const char* operation, const Element& e, AnyContext& c) const {
        Answer answer{};
        check(function(table_->self, c.state(), &e, &answer), operation);
        return answer;
    }
    template <class Function>
    void keys(Function function, const char* operation, const Element& e, std::span<NodeKey> out,
              AnyContext& c) const;

    // Shared by copies, at one place: contexts point to it.
    std::shared_ptr<const nestgrid_grid> table_;
    std::shared_ptr<const std::deque<Rule>> rules_;
};

/// A field with values of type Real behind a table. What it was made of must outlive it.
template <class Real, int component_count = 1>
class AnyField {
public:
    using value_type = Real;
    static constexpr int components = component_count;

    /// \throw InvalidInput for a table with other values, or without a required function
    explicit AnyField(const nestgrid_field& table);

    /// Around a model on a grid of the type Grid; both are borrowed.
    template <class Grid, class Field>
    AnyField(const Grid& grid, const Field& field) : AnyField(make_table(grid, field)) {}

    NodeMask coarse_values(std::size_t i, std::span<Real> out, AnyContext& c) const {
        std::uint64_t missing = 0;
        check(table_.coarse_values(table_.self, c.state(), i, out.size() / components, out.data(),
                                   &missing),
              "coarse_values");
        return missing;
    }
    NodeMask new_values(const nestgrid_element& e, NodeMask which, std::span<Real> out,
                        AnyContext& c) const {
        std::uint64_t missing = 0;
        check(table_.new_values(table_.self, c.state(), &e, which, out.size() / components,
                                out.data(), &missing),
              "new_values");
        return missing;
    }
    bool offers(Feature feature) const {
        return feature == Feature::gradients && table_.corner_gradients != nullptr;
    }
    void corner_gradients(const nestgrid_element& e, std::span<Point> out, AnyContext& c) const {
        check(table_.corner_gradients(table_.self, c.state(), &e, out.size(), detail::as_rows(out)),
              "corner_gradients");
    }

    bool knows_stars() const { return table_.library_row_values != nullptr; }
    void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const {
        table_.library_row_values(table_.self, static_cast<std::uint64_t>(first), stride,
                                  out.size(), out.data());
    }
    /// Whether bisections below elements of this grid can be walked on the other side of the
    /// tables: of the library's own, or of such as tell theirs.
    template <int dim>
    bool bisects(const AnyGrid<dim>& grid) const {
        return is_told_bisections(grid) ||
               (table_.library_bisect != nullptr &&
                table_.library_bisect(table_.self, &grid.table(), nullptr, nullptr, 0, 0,
                                      nullptr) == 0);
    }
    /// Whether both tables tell bisections (nestgrid.h).
    template <int dim>
    bool is_told_bisections(const AnyGrid<dim>& grid) const {
        return components == 1 && table_.node_values != nullptr &&
               detail::TableBisections<dim>::are_in(grid.table());
    }
    /// Where bisects() says so, does it.
    /// \throw GridError for an element with a tag that does not exist
    template <int dim>
    void bisect(const AnyGrid<dim>& grid, AnyContext& c, const nestgrid_element& e,
                const Real* value, int level, int orientation,
                detail::ErasedBisectionVisitor<dim, Real>& visitor) const;
    /// Where is_told_bisections() says so: the values of their nodes.
    detail::TableValues<Real> told_values() const { return detail::TableValues<Real>(table_); }

private:
    static void check(int code, const char* operation) {
        detail::check_code(code, "field", operation);
    }
    nestgrid_field table_;
};

template <int dim, class Real>
bool knows_blocks(const AnyGrid<dim>& grid, const AnyField<Real>& field, const HierarchyFacts&) {
    return field.bisects(grid);
}
template <int dim, class Real>
void bisect_blocks(const AnyGrid<dim>& grid, const AnyField<Real>& field, AnyContext& context,
                   const nestgrid_element& e, const Real* values, int level, int orientation,
                   detail::ErasedBisectionVisitor<dim, Real>& visitor) {
    field.bisect(grid, context, e, values, level, orientation, visitor);
}

}  // namespace nestgrid

#include <nestgrid/any_grid_steps.hpp>
