// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <nestgrid/detail/erase.hpp>
#include <nestgrid/table.hpp>

#include "table_grid.hpp"

namespace nestgrid {

namespace detail {

namespace {

/// Dimension and components are numbers here: one class for all tables.
template <class Real>
class TableHierarchy final : public Hierarchy<Real>, private BisectionRows<Real> {
    using Node = typename BisectionRows<Real>::Node;
    static_assert(BisectionRows<Real>::no_node == NESTGRID_NO_NODE);
    static_assert(fits_handle<nestgrid_element>);

public:
    TableHierarchy(const nestgrid_grid& grid, const nestgrid_field& field)
        : Hierarchy<Real>({}), grid_{grid}, field_{field}, made_for_{grid_} {
        HierarchyFacts& facts = this->facts_;
        facts.dimension = grid_.table().dimension;
        facts.components = field_.table().components;
        for (unsigned bit = 1; bit <= static_cast<unsigned>(last_feature); bit <<= 1U) {
            const auto feature = static_cast<Feature>(bit);
            if (grid_.offers(feature) || field_.offers(feature)) facts.features |= bit;
        }
        if (facts.offers(Feature::dense_keys)) facts.node_count = grid_.node_count();
        facts.conforming = grid_.conforming();
        facts.knows_patches = tells_rows();
        facts.bisects_means = tells_rows() && facts.dimension == 3;
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
        field_.corner_gradients(of(element), out, context_of(task));
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
        return grid_.tells_bisections() && field_.table().components == 1 &&
               field_.table().node_values != nullptr;
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
        field_.node_values(nodes, keys, out);
    }

    TableGrid grid_;
    TableField<Real> field_;
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
    return std::make_unique<const detail::TableHierarchy<Real>>(grid, field);
}
template std::unique_ptr<const Hierarchy<float>> open_table(const nestgrid_grid&,
                                                            const nestgrid_field&);
template std::unique_ptr<const Hierarchy<double>> open_table(const nestgrid_grid&,
                                                             const nestgrid_field&);

std::unique_ptr<const Hierarchy<float>> open_table(const nestgrid_grid& grid) {
    return open_table<float>(grid, detail::zero_field());
}

}  // namespace nestgrid
