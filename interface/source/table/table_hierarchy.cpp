// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include <boost/container/small_vector.hpp>

#include <nestgrid/detail/erase.hpp>
#include <nestgrid/table.hpp>

#include "table_grid.hpp"

namespace nestgrid {

namespace detail {

template <class Real>
TableFields<Real>::TableFields(const nestgrid_field& first,
                               std::span<const nestgrid_field* const> more)
    : first_{first}, components_{first_.table().components} {
    for (const nestgrid_field* field : more) {
        if (field == nullptr) throw InvalidInput("the table of an attribute is NULL");
        if (field->value_type == NESTGRID_FLOAT) {
            more_.emplace_back(TableField<float>(*field));
        } else {
            more_.emplace_back(TableField<double>(*field));
        }
        const int components =
            std::visit([](const auto& f) { return f.table().components; }, more_.back());
        if (components > std::numeric_limits<int>::max() - components_) {
            throw InvalidInput("the fields have too many components");
        }
        components_ += components;
    }
}

template <class Real>
template <class Ask>
NodeMask TableFields<Real>::gather(std::span<Real> out, const Ask& ask) const {
    const auto all = static_cast<std::size_t>(components_);
    const std::size_t nodes = out.size() / all;
    std::size_t begin = 0;
    NodeMask missing = 0;
    const auto put = [&]<class Value>(const TableField<Value>& field) {
        const auto own = static_cast<std::size_t>(field.table().components);
        boost::container::small_vector<Value, 64> values(nodes * own);
        missing |= ask(field, std::span<Value>(values.data(), values.size()));
        for (std::size_t n = 0; n < nodes; ++n) {
            for (std::size_t c = 0; c < own; ++c) {
                out[n * all + begin + c] = static_cast<Real>(values[n * own + c]);
            }
        }
        begin += own;
    };
    put(first_);
    for (const AnyField& field : more_) std::visit(put, field);
    return missing;
}

namespace {

/// Dimension and components are numbers here: one class for all tables.
template <class Real>
class TableHierarchy final : public Hierarchy<Real>, private BisectionRows<Real> {
    using Node = typename BisectionRows<Real>::Node;
    static_assert(BisectionRows<Real>::no_node == NESTGRID_NO_NODE);
    static_assert(fits_handle<nestgrid_element>);

public:
    TableHierarchy(const nestgrid_grid& grid, const nestgrid_field& field,
                   std::span<const nestgrid_field* const> more)
        : Hierarchy<Real>({}), grid_{grid}, field_{field, more}, made_for_{grid_} {
        HierarchyFacts& facts = this->facts_;
        facts.dimension = grid_.table().dimension;
        facts.components = field_.components();
        for (unsigned bit = 1; bit <= static_cast<unsigned>(last_feature); bit <<= 1U) {
            const auto feature = static_cast<Feature>(bit);
            if (grid_.offers(feature) || field_.first().offers(feature)) facts.features |= bit;
        }
        if (!more.empty()) facts.features &= ~static_cast<unsigned>(Feature::degree);
        if (facts.offers(Feature::dense_keys)) facts.node_count = grid_.node_count();
        facts.conforming = grid_.conforming();
        facts.knows_patches = tells_rows();
        facts.bisects_means = tells_rows() && facts.dimension == 3;
        facts.gradients_at_nodes = tells_rows() && field_.first().tells_gradients();
        if (facts.gradients_at_nodes) {
            facts.features |= static_cast<unsigned>(Feature::gradients);
        }
        if (facts.offers(Feature::presence)) facts.drop_promises_of_whole_grids();
    }

    std::size_t coarse_count() const override { return grid_.coarse_count(); }
    std::uint64_t epoch() const override { return grid_.epoch(); }
    Elements make_elements() const override { return Elements::of<nestgrid_element>(); }
    std::unique_ptr<Task> open() const override {
        made_for_.require_same(grid_, "the hierarchy");
        return std::make_unique<OpenTask>(grid_);
    }

    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const override {
        const CoarseElement<nestgrid_element> from = grid_.coarse(i, context_of(task));
        coarse.shape = from.shape;
        coarse.orientation = from.orientation;
        coarse.corners = from.corners;
        coarse.ids = from.ids;
        family.begin(1);
        describe(context_of(task), from.element, family, 0);
    }
    NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                           Real* out) const override {
        return field_.coarse_values(i, values_at(out, corners), context_of(task));
    }
    NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                   Real* values, NodeMask wanted, Family& family) const override {
        const NodeMask missing = which == 0 ? 0 : new_values(task, element, rule, which, values);
        const std::size_t count = rule.children.size();
        family.begin(count);
        std::array<nestgrid_element, max_children> children;
        grid_.children(of(element), std::span(children).first(count), context_of(task));
        for (std::size_t c = 0; c < count; ++c) {
            if ((wanted >> c & 1U) != 0) describe(context_of(task), children[c], family, c);
        }
        return missing;
    }
    NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                        Real* values) const override {
        Real* const behind_corners =
            values + static_cast<std::size_t>(rule.corner_count() * this->facts().components);
        return field_.new_values(
            of(element), which, values_at(behind_corners, rule.new_nodes.size()), context_of(task));
    }
    void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                 Point* positions, unsigned* boundary) const override {
        TableContext& context = context_of(task);
        if (keys != nullptr && this->offers(Feature::own_keys)) {
            grid_.corner_keys(of(element), std::span(keys, count), context);
        }
        if (positions != nullptr && this->offers(Feature::own_positions)) {
            grid_.corner_positions(of(element), std::span(positions, count), context);
        }
        if (boundary != nullptr && this->offers(Feature::boundary_faces)) {
            *boundary = grid_.boundary_faces(of(element), context);
        }
    }
    void new_positions(Task* task, const Handle& element, NodeMask which,
                       std::span<Point> out) const override {
        if (!this->offers(Feature::new_positions)) return;
        grid_.new_positions(of(element), which, out, context_of(task));
    }
    void corner_gradients(Task* task, const Handle& element, std::span<Point> out) const override {
        if (!this->offers(Feature::gradients)) return;
        if (field_.first().offers(Feature::gradients)) {
            return field_.first().corner_gradients(of(element), out, context_of(task));
        }
        // An element that is told in rows is nothing but its corners.
        gradients(std::span(of(element).word).first(out.size()), out);
    }

    int degree(Task* task, const Handle& leaf) const override {
        if (!this->offers(Feature::degree)) return 1;
        return field_.first().degree(of(leaf), context_of(task));
    }
    void evaluate(Task* task, const Handle& leaf, std::span<const Point> reference,
                  Real* out) const override {
        if (!this->offers(Feature::degree)) return;
        field_.first().evaluate(of(leaf), reference, values_at(out, reference.size()),
                                context_of(task));
    }

    int geometry_degree(Task* task, const Handle& leaf) const override {
        if (!this->offers(Feature::geometry_degree)) return 1;
        return grid_.geometry_degree(of(leaf), context_of(task));
    }
    void map(Task* task, const Handle& leaf, std::span<const Point> reference,
             std::span<Point> out) const override {
        if (!this->offers(Feature::geometry_degree)) return;
        grid_.map(of(leaf), reference, out, context_of(task));
    }

    std::array<NodeKey, 2> hanging_parents(NodeKey node) const override {
        if (!this->offers(Feature::hanging_parents)) return {node, node};
        return grid_.hanging_parents(node);
    }

    const BisectionRows<Real>* bisection_rows() const override {
        return tells_rows() ? this : nullptr;
    }

private:
    struct OpenTask final : Task {
        explicit OpenTask(const TableGrid& grid) : context(grid.table()) {}
        TableContext context;
    };
    bool tells_rows() const {
        return grid_.tells_bisections() && field_.components() == 1 &&
               field_.first().tells_values();
    }
    static TableContext& context_of(Task* task) { return static_cast<OpenTask*>(task)->context; }
    static const nestgrid_element& of(const Handle& element) {
        return element_of<nestgrid_element>(element);
    }
    std::span<Real> values_at(Real* values, std::size_t nodes) const {
        return {values, nodes * static_cast<std::size_t>(this->facts_.components)};
    }

    void describe(TableContext& context, const nestgrid_element& e, Family& family,
                  std::size_t c) const {
        describe_member(grid_, this->facts_, context, e, family, c);
    }

    void middles(std::span<const Node> a, std::span<const Node> b,
                 std::span<Node> out) const override {
        grid_.middles(a, b, out);
    }
    void keys(std::span<const Node> nodes, std::span<NodeKey> out) const override {
        grid_.node_keys(nodes, out);
    }
    void positions(std::span<const Node> nodes, std::span<Point> out) const override {
        grid_.node_positions(nodes, out);
    }
    void values(std::span<const Node> nodes, std::span<const NodeKey> keys,
                std::span<Real> out) const override {
        field_.first().node_values(nodes, keys, out);
    }
    void gradients(std::span<const Node> nodes, std::span<Point> out) const override {
        field_.first().node_gradients(nodes, out);
    }

    TableGrid grid_;
    TableFields<Real> field_;
    MadeFor made_for_;
};

/// Zero everywhere.
nestgrid_field zero_field() {
    nestgrid_field t{};
    t.size = sizeof(t);
    t.value_type = NESTGRID_FLOAT;
    t.components = 1;
    t.coarse_values = [](const void*, void*, std::size_t, std::size_t count, void* out,
                         std::uint64_t* missing) {
        std::fill_n(static_cast<float*>(out), count, 0.0F);
        *missing = 0;
        return 0;
    };
    t.new_values = [](const void*, void*, const nestgrid_element*, std::uint64_t, std::size_t count,
                      void* out, std::uint64_t* missing) {
        std::fill_n(static_cast<float*>(out), count, 0.0F);
        *missing = 0;
        return 0;
    };
    return t;
}

}  // namespace

}  // namespace detail

template <class Real>
std::unique_ptr<const Hierarchy<Real>> open_table(const nestgrid_grid& grid,
                                                  const nestgrid_field& field) {
    return open_table<Real>(grid, field, {});
}
template std::unique_ptr<const Hierarchy<float>> open_table(const nestgrid_grid&,
                                                            const nestgrid_field&);
template std::unique_ptr<const Hierarchy<double>> open_table(const nestgrid_grid&,
                                                             const nestgrid_field&);

template <class Real>
std::unique_ptr<const Hierarchy<Real>> open_table(const nestgrid_grid& grid,
                                                  const nestgrid_field& field,
                                                  std::span<const nestgrid_field* const> more) {
    return std::make_unique<const detail::TableHierarchy<Real>>(grid, field, more);
}
template std::unique_ptr<const Hierarchy<float>> open_table(const nestgrid_grid&,
                                                            const nestgrid_field&,
                                                            std::span<const nestgrid_field* const>);
template std::unique_ptr<const Hierarchy<double>> open_table(
    const nestgrid_grid&, const nestgrid_field&, std::span<const nestgrid_field* const>);

std::unique_ptr<const Hierarchy<float>> open_table(const nestgrid_grid& grid) {
    return open_table<float>(grid, detail::zero_field());
}

}  // namespace nestgrid
