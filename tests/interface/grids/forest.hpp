// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An explicit hierarchy of elements of any shape, refined by any rule, element by element and
// without closure: small random grids for tests, hanging nodes and level jumps included. It offers
// the required operations only.
#pragma once

#include <functional>
#include <random>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/grid.hpp>
#include <nestgrid/keys.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid_test {

using namespace nestgrid;

template <int dim>
class Forest {
public:
    using Element = std::uint32_t;
    static constexpr int dimension = dim;

    struct Cell {
        Shape shape = Shape::point;
        int tag = 0;  // for bisection
        const Rule* rule = nullptr;
        std::uint32_t first_child = 0;
        std::vector<std::uint32_t> nodes;  // corners, then new nodes
    };

    std::size_t coarse_count() const { return coarse_.size(); }
    CoarseElement<Element> coarse(std::size_t i) const { return coarse_[i]; }
    const Rule* split(Element e) const { return cells[e].rule; }
    void children(Element e, std::span<Element> out) const {
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k] = cells[e].first_child + static_cast<Element>(k);
        }
    }

    Element add_coarse(Shape shape, const std::vector<std::uint32_t>& corners, int orientation,
                       int tag = 0) {
        CoarseElement<Element> c;
        c.element = static_cast<Element>(cells.size());
        c.shape = shape;
        c.orientation = static_cast<std::int8_t>(orientation);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            c.corners[k] = positions[corners[k]];
            c.ids[k] = corners[k] + 1000;
        }
        coarse_.push_back(c);
        cells.push_back({shape, tag, nullptr, 0, corners});
        return c.element;
    }
    std::uint32_t add_node(const Point& x) {
        positions.push_back(x);
        keys.push_back(coarse_key(positions.size() - 1 + 1000));
        return static_cast<std::uint32_t>(positions.size() - 1);
    }

    void refine(Element e, const Rule& rule) {
        std::vector<std::uint32_t> nodes = cells[e].nodes;
        std::vector<NodeKey> local;
        for (const std::uint32_t n : nodes) local.push_back(keys[n]);
        for (const Stencil& s : rule.new_nodes) {
            const NodeKey key = derived_key(s, local.data());
            const auto [at, is_new] =
                by_key_.insert(key, static_cast<std::uint32_t>(positions.size()));
            const std::uint32_t node = *at;
            if (is_new) {
                Point x{0, 0, 0};
                for (std::size_t i = 0; i < s.count; ++i) {
                    x = x + s.weight[i] * positions[nodes[s.parent[i]]];
                }
                positions.push_back(x);
                keys.push_back(key);
            }
            nodes.push_back(node);
            local.push_back(key);
        }
        const int tag = cells[e].tag;
        cells[e].rule = &rule;
        cells[e].first_child = static_cast<std::uint32_t>(cells.size());
        cells[e].nodes = nodes;
        for (const Child& child : rule.children) {
            Cell cell{child.shape, tag == 1 ? dim : tag - 1, nullptr, 0, {}};
            for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
                cell.nodes.push_back(nodes[child.corner[i]]);
            }
            cells.push_back(cell);
        }
    }

    std::vector<Cell> cells;
    std::vector<Point> positions;
    std::vector<NodeKey> keys;

private:
    std::vector<CoarseElement<Element>> coarse_;
    KeyTable<NodeKey, std::uint32_t> by_key_;
};

/// A function at the nodes of a forest.
template <int dim>
class ForestField {
public:
    using value_type = double;
    using Function = std::function<double(const Point&)>;

    ForestField(const Forest<dim>& forest, const Function& f) : forest_{&forest} {
        for (const Point& x : forest.positions) values.push_back(f(x));
    }
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto& cell = forest_->cells[forest_->coarse(i).element];
        for (std::size_t k = 0; k < topology(cell.shape).corners; ++k)
            out[k] = values[cell.nodes[k]];
        return 0;
    }
    NodeMask new_values(std::uint32_t e, NodeMask which, std::span<double> out) const {
        const auto& cell = forest_->cells[e];
        const std::size_t corners = topology(cell.shape).corners;
        for (std::size_t n = 0; corners + n < cell.nodes.size(); ++n) {
            if ((which >> n & 1U) != 0) out[n] = values[cell.nodes[corners + n]];
        }
        return 0;
    }
    std::vector<double> values;

private:
    const Forest<dim>* forest_;
};

/// Refines random leaves by the standard rule of their shape.
template <int dim>
void refine_randomly(Forest<dim>& forest, std::mt19937& random, int steps) {
    for (int i = 0; i < steps; ++i) {
        const auto e = static_cast<std::uint32_t>(random() % forest.cells.size());
        const auto& cell = forest.cells[e];
        if (cell.rule != nullptr) continue;
        if (cell.tag > 0) {
            forest.refine(e, bisection_rule(cell.shape, cell.tag));
        } else if (cell.shape == Shape::tetrahedron) {
            forest.refine(e, red_tetrahedron_rule());
        } else {
            forest.refine(e, dyadic_rule(cell.shape));
        }
    }
}

/// n x n x n deformed hexahedra (dim 3) or quadrilaterals (dim 2), unbalanced when refined.
template <int dim>
Forest<dim> boxes(std::mt19937& random, std::uint32_t n) {
    Forest<dim> forest;
    const auto jitter = [&] { return double(random() % 100) / 400.0 - 0.125; };
    const std::uint32_t layers = dim == 3 ? n + 1 : 1;
    for (std::uint32_t z = 0; z < layers; ++z) {
        for (std::uint32_t y = 0; y <= n; ++y) {
            for (std::uint32_t x = 0; x <= n; ++x) {
                forest.add_node({x + jitter(), y + jitter(), dim == 3 ? z + jitter() : 0});
            }
        }
    }
    for (std::uint32_t z = 0; z < (dim == 3 ? n : 1); ++z) {
        for (std::uint32_t y = 0; y < n; ++y) {
            for (std::uint32_t x = 0; x < n; ++x) {
                std::vector<std::uint32_t> corners;
                for (std::uint32_t c = 0; c < 1U << dim; ++c) {
                    corners.push_back(x + (c & 1U) +
                                      (n + 1) * (y + (c >> 1U & 1U) + (n + 1) * (z + (c >> 2U))));
                }
                forest.add_coarse(dim == 3 ? Shape::hexahedron : Shape::quadrilateral, corners, 1);
            }
        }
    }
    return forest;
}

/// The Kuhn simplices of one box: tag = dim for bisection, 0 for red refinement.
template <int dim>
Forest<dim> kuhn(int tag) {
    Forest<dim> forest;
    for (std::uint32_t c = 0; c < 1U << dim; ++c) {
        forest.add_node({double(c & 1U), double(c >> 1U & 1U), double(c >> 2U)});
    }
    std::array<std::uint32_t, 3> path{1, 2, 4};
    do {
        std::vector<std::uint32_t> corners{0};
        for (std::size_t k = 0; k < dim; ++k) corners.push_back(corners.back() + path[k]);
        std::vector<Point> x;
        for (const std::uint32_t c : corners) x.push_back(forest.positions[c]);
        const Shape shape = dim == 3 ? Shape::tetrahedron : Shape::triangle;
        const Point v = measure_vector(shape, x);
        forest.add_coarse(shape, corners, v[2] > 0 ? 1 : -1, tag);
    } while (std::next_permutation(path.begin(), path.begin() + dim));
    return forest;
}

/// New nodes that are no plain means, one of them with another new node for a parent.
inline const Rule& thirds_rule() {
    static const Rule rule = make_rule("thirds", Shape::triangle,
                                       {weighted_mean_of({{0, 2.0 / 3}, {1, 1.0 / 3}}),
                                        weighted_mean_of({{0, 0.5}, {2, 0.3}, {3, 0.2}}, 1)},
                                       {{Shape::triangle, {0, 3, 4}, 1, {}},
                                        {Shape::triangle, {3, 2, 4}, 1, {}},
                                        {Shape::triangle, {2, 0, 4}, 1, {}},
                                        {Shape::triangle, {3, 1, 2}, 1, {}}});
    return rule;
}

}  // namespace nestgrid_test
