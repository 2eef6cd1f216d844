// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Grids of triangles, tetrahedra, prisms, pyramids and boxes, side by side, whose leaves have
// polynomials of degrees of their own: corners in any order, unbalanced red refinement with any
// inner diagonals, any degrees, jumps where they are asked for. As degree_world.hpp, which is for
// boxes alone.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "closedness.hpp"
#include "degree_world.hpp"
#include "pyramid_functions.hpp"

namespace nestgrid_test {

using nestgrid::Shape;

/// What the unit cells of a ShapeWorld are cut into.
enum class Cells : std::uint8_t {
    simplices,   ///< two triangles, or six tetrahedra
    prisms,      ///< two prisms each
    columns,     ///< boxes, or triangles and prisms, at random
    all,         ///< columns below; tetrahedra above prisms, and nothing above hexahedra
    pyramids,    ///< boxes, or six pyramids around the middle, at random; those on the boundary of
                 ///< the domain are pyramids or two tetrahedra
    one_simplex  ///< one triangle or tetrahedron alone
};

/// Polynomial on a product of simplices, or a function of PyramidFunctions, by its values on the
/// principal lattice.
class LatticePolynomial {
public:
    LatticePolynomial() = default;
    LatticePolynomial(Shape shape, int degree, const std::function<double(const Point&)>& f)
        : degree_{degree} {
        switch (shape) {
            case Shape::pyramid: {
                pyramid_ = &PyramidFunctions::of(degree);
                for (const auto& [i, j, k] : pyramid_->places()) {
                    const double p = degree;
                    values_.push_back(f({i / p, j / p, k / p}));
                }
                values_ = pyramid_->factors(values_);
                return;
            }
            case Shape::triangle:
                factors_ = {2};
                break;
            case Shape::tetrahedron:
                factors_ = {3};
                break;
            case Shape::prism:
                factors_ = {2, 1};
                break;
            case Shape::quadrilateral:
                factors_ = {1, 1};
                break;
            default:
                factors_ = {1, 1, 1};
        }
        std::array<int, 3> at{};
        add(0, at, degree, f);
    }
    int degree() const { return degree_; }
    double operator()(const Point& x) const {
        double sum = 0;
        if (pyramid_ != nullptr) {
            const std::vector<double> at = pyramid_->values(x);
            return std::inner_product(at.begin(), at.end(), values_.begin(), 0.0);
        }
        for (std::size_t i = 0; i < values_.size(); ++i) {
            double weight = values_[i];
            for (std::size_t d = 0, axis = 0; d < factors_.size(); ++d) {
                double left = 1;
                int share = degree_;
                for (std::size_t k = 0; k < factors_[d]; ++k, ++axis) {
                    weight *= along(x[axis], points_[i][axis]);
                    left -= x[axis];
                    share -= points_[i][axis];
                }
                weight *= along(left, share);
            }
            sum += weight;
        }
        return sum;
    }

private:
    /// 1 at share / degree, 0 at lesser multiples.
    double along(double x, int share) const {
        double product = 1;
        for (int k = 0; k < share; ++k) product *= (degree_ * x - k) / (share - k);
        return product;
    }
    void add(std::size_t axis, std::array<int, 3> at, int left,
             const std::function<double(const Point&)>& f) {
        std::size_t end = 0;
        std::size_t factor = 0;
        while (factor < factors_.size() && end + factors_[factor] <= axis)
            end += factors_[factor++];
        if (factor == factors_.size()) {
            points_.push_back(at);
            values_.push_back(
                f({at[0] / double(degree_), at[1] / double(degree_), at[2] / double(degree_)}));
            return;
        }
        if (axis == end) left = degree_;
        for (int share = 0; share <= left; ++share) {
            at[axis] = share;
            add(axis + 1, at, left - share, f);
        }
    }

    int degree_ = 1;
    const PyramidFunctions* pyramid_ = nullptr;
    std::vector<std::size_t> factors_;
    std::vector<std::array<int, 3>> points_;
    std::vector<double> values_;
};

template <int dim>
class ShapeWorld {
public:
    struct Element {
        std::uint32_t cell;
    };
    static constexpr int dimension = dim;
    using Function = std::function<double(const Point&)>;

    ShapeWorld(Cells cells, const WorldOptions& options, Function f)
        : options_{options}, f_{std::move(f)} {
        std::mt19937 random(options.seed);
        const std::size_t n = options.cells;
        std::vector<bool> boxes(n * n);
        for (std::size_t i = 0; i < n * n; ++i) {
            const bool box_here = random() % 2 == 0;
            if (cells == Cells::columns || cells == Cells::pyramids) boxes[i] = box_here;
            // Whole rows, so that cells above do not touch in an edge alone.
            if (cells == Cells::all) boxes[i] = i % n == 0 ? box_here : boxes[i - 1];
        }
        for (std::size_t k = 0; k < (dim == 3 ? n : 1); ++k) {
            for (std::size_t i = 0; i < n * n; ++i) {
                const Vertex low{i % n, i / n, k};
                const bool above = cells == Cells::all && 2 * k >= n;
                if (above && boxes[i]) continue;
                if (boxes[cells == Cells::pyramids ? (i + k) % (n * n) : i]) {
                    add_coarse(box, std::span(&low, 1), random);
                } else if (cells == Cells::pyramids) {
                    add_pyramids(low, random);
                } else if (dim == 3 && (cells == Cells::simplices || above)) {
                    add_tetrahedra(low, random);
                } else {
                    add_triangles(low, random);
                }
            }
        }
        if (cells == Cells::one_simplex) {
            cells_.resize(0);
            std::array<std::array<std::size_t, 3>, 4> corners{
                {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
            add_coarse(simplex, std::span(corners).first(dim + 1), random);
        }
        coarse_ = cells_.size();
        for (std::size_t i = 0; i < cells_.size(); ++i) grow(i, random);
    }

    std::size_t coarse_count() const { return coarse_; }
    nestgrid::CoarseElement<Element> coarse(std::size_t i) const {
        const Cell& cell = cells_[i];
        nestgrid::CoarseElement<Element> c;
        c.element = {static_cast<std::uint32_t>(i)};
        c.shape = cell.shape;
        const std::size_t count = cell.corner.size();
        for (std::size_t k = 0; k < count; ++k) {
            c.corners[k] = cell.corner[k];
            c.ids[k] = 0;
            for (std::size_t d = dim; d-- > 0;) {
                c.ids[k] = c.ids[k] * (2 * options_.cells + 1) +
                           static_cast<std::uint64_t>(
                               std::llround((cell.corner[k][d] + 1) * double(options_.cells)));
            }
        }
        const auto corners = std::span(c.corners).first(count);
        const double size = dim == 3 ? nestgrid::measure(c.shape, corners)
                                     : nestgrid::measure_vector(c.shape, corners)[2];
        c.orientation = size > 0 ? 1 : -1;
        return c;
    }
    const nestgrid::Rule* split(const Element& e) const { return cells_[e.cell].rule; }
    void children(const Element& e, std::span<Element> out) const {
        for (std::uint32_t c = 0; c < out.size(); ++c) out[c] = {cells_[e.cell].first_child + c};
    }

    /// The function that was interpolated, at a node of an element.
    double f(const Element& e, const Point& reference) const {
        return f_(position(cells_[e.cell], reference));
    }
    Point position(const Element& e, const Point& x) const { return position(cells_[e.cell], x); }
    Shape shape(const Element& e) const { return cells_[e.cell].shape; }
    const LatticePolynomial& polynomial(const Element& e) const { return cells_[e.cell].u; }
    /// The data at a point: those of the leaf that the point lies in, or nothing outside.
    std::optional<double> at(const Point& x) const {
        std::size_t cell = nearest(0, coarse_, x);
        if (inside(cells_[cell], x) < -1e-7) return {};
        while (cells_[cell].rule != nullptr) {
            cell = nearest(cells_[cell].first_child, cells_[cell].rule->children.size(), x);
        }
        return cells_[cell].u(reference(cells_[cell], x));
    }
    double operator()(const Point& x) const { return at(x).value_or(0); }
    std::size_t leaf_count() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(cells_, [](const Cell& cell) { return cell.rule == nullptr; }));
    }

private:
    struct Cell {
        Shape shape;
        int level;
        std::vector<Point> corner;
        const nestgrid::Rule* rule = nullptr;
        std::uint32_t first_child = 0;
        LatticePolynomial u;
    };
    static constexpr Shape box = dim == 3 ? Shape::hexahedron : Shape::quadrilateral;
    static constexpr Shape simplex = dim == 3 ? Shape::tetrahedron : Shape::triangle;
    using Vertex = std::array<std::size_t, 3>;

    /// \param corners of the coarse element; of a box the lowest one alone
    void add_coarse(Shape shape, std::span<const Vertex> corners, std::mt19937& random) {
        std::vector<Vertex> all(corners.begin(), corners.end());
        if (shape == box) {
            for (std::size_t k = 1; k < std::size_t{1} << dim; ++k) {
                all.push_back({corners[0][0] + (k & 1U), corners[0][1] + (k >> 1U & 1U),
                               corners[0][2] + (k >> 2U)});
            }
        }
        if (shape == simplex) std::shuffle(all.begin(), all.end(), random);
        if (shape == Shape::prism) {
            std::array<std::size_t, 3> order{0, 1, 2};
            std::shuffle(order.begin(), order.end(), random);
            const std::size_t flip = random() % 2 == 0 ? 3 : 0;
            std::vector<Vertex> moved(6);
            for (std::size_t k = 0; k < 6; ++k) {
                moved[k] = all[order[k % 3] + (k / 3 * 3 + flip) % 6];
            }
            all = moved;
        }
        Cell cell{shape, 0, {}, nullptr, 0, {}};
        for (const Vertex& vertex : all) {
            cell.corner.push_back(
                position({double(vertex[0]), double(vertex[1]), double(vertex[2])}));
        }
        cells_.push_back(cell);
    }
    /// \param x in units of coarse cells
    Point position(const Point& x) const {
        Point at{0, 0, 0};
        for (std::size_t d = 0; d < dim; ++d) at[d] = -1 + 2 * x[d] / double(options_.cells);
        return at;
    }
    /// The six pyramids of a cell, bases in any order of corners.
    void add_pyramids(const Vertex& low, std::mt19937& random) {
        const Point middle =
            position({double(low[0]) + 0.5, double(low[1]) + 0.5, double(low[2]) + 0.5});
        for (std::size_t face = 0; face < 6; ++face) {
            const std::size_t across = face / 2;
            std::array<std::size_t, 2> along{(across + 1) % 3, (across + 2) % 3};
            if (random() % 2 == 0) std::swap(along[0], along[1]);
            const auto flip = static_cast<std::size_t>(random() % 4);
            std::vector<Point> corner;
            for (std::size_t k = 0; k < 4; ++k) {
                Vertex vertex = low;
                vertex[across] += face % 2;
                vertex[along[0]] += (k ^ flip) & 1U;
                vertex[along[1]] += (k ^ flip) >> 1U;
                corner.push_back(
                    position({double(vertex[0]), double(vertex[1]), double(vertex[2])}));
            }
            const std::size_t end = face % 2 == 0 ? 0 : options_.cells - 1;
            if (low[across] == end && random() % 3 == 0) {
                for (const std::size_t k : {std::size_t{0}, std::size_t{3}}) {
                    cells_.push_back({Shape::tetrahedron,
                                      0,
                                      {middle, corner[k], corner[1], corner[2]},
                                      nullptr,
                                      0,
                                      {}});
                }
                continue;
            }
            corner.push_back(middle);
            cells_.push_back({Shape::pyramid, 0, corner, nullptr, 0, {}});
        }
    }
    void add_tetrahedra(const Vertex& low, std::mt19937& random) {
        std::array<std::size_t, 3> order{0, 1, 2};
        do {
            std::vector<Vertex> corners{low};
            for (const std::size_t d : order) {
                corners.push_back(corners.back());
                ++corners.back()[d];
            }
            add_coarse(Shape::tetrahedron, corners, random);
        } while (std::next_permutation(order.begin(), order.end()));
    }
    /// The two triangles, or prisms, of a cell.
    void add_triangles(const Vertex& low, std::mt19937& random) {
        for (const std::size_t d : {std::size_t{0}, std::size_t{1}}) {
            std::vector<Vertex> corners(3, low);
            ++corners[1][d];
            ++corners[2][0];
            ++corners[2][1];
            if (dim == 2) {
                add_coarse(Shape::triangle, corners, random);
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                corners.push_back(corners[k]);
                ++corners.back()[2];
            }
            add_coarse(Shape::prism, corners, random);
        }
    }

    void grow(std::size_t i, std::mt19937& random) {
        Point middle{0, 0, 0};
        for (const Point& x : cells_[i].corner) {
            middle = middle + (1.0 / double(cells_[i].corner.size())) * x;
        }
        const bool by_chance = cells_[i].level < options_.levels &&
                               random() % 1000 < static_cast<unsigned>(1000 * options_.refined);
        if (options_.divides ? options_.divides(middle, cells_[i].level) : by_chance) {
            return divide(i, random);
        }
        const int spread = options_.greatest_degree - options_.least_degree + 1;
        int degree =
            options_.least_degree + static_cast<int>(random() % static_cast<unsigned>(spread));
        if (options_.degree) degree = options_.degree(middle, cells_[i].level);
        const auto noise = [&] {
            return options_.noise * (2 * (static_cast<double>(random()) / 4294967296.0) - 1);
        };
        cells_[i].u = {cells_[i].shape, degree, [&](const Point& x) {
                           return f_(position(cells_[i], x)) + (options_.noise > 0 ? noise() : 0);
                       }};
    }
    void divide(std::size_t i, std::mt19937& random) {
        const nestgrid::Rule& rule =
            cells_[i].shape == Shape::tetrahedron
                ? nestgrid::red_tetrahedron_rule(static_cast<int>(random() % 3))
                : nestgrid::red_rule(cells_[i].shape);
        cells_[i].rule = random() % 2 == 0 ? &rule : &shuffled(rule);
        cells_[i].first_child = static_cast<std::uint32_t>(cells_.size());
        std::vector<Point> nodes = cells_[i].corner;
        for (const nestgrid::Stencil& stencil : cells_[i].rule->new_nodes) {
            Point x{0, 0, 0};
            for (std::size_t k = 0; k < stencil.count; ++k) {
                x = x + stencil.weight[k] * nodes[stencil.parent[k]];
            }
            nodes.push_back(x);
        }
        for (const nestgrid::Child& child : cells_[i].rule->children) {
            Cell made{child.shape, cells_[i].level + 1, {}, nullptr, 0, {}};
            for (std::size_t k = 0; k < nestgrid::topology(child.shape).corners; ++k) {
                made.corner.push_back(nodes[child.corner[k]]);
            }
            cells_.push_back(made);
        }
    }

    /// The same rule of a simplex with nodes, children and their corners in another order.
    static const nestgrid::Rule& shuffled(const nestgrid::Rule& rule) {
        if (rule.parent != simplex) return rule;
        static std::map<const nestgrid::Rule*, nestgrid::Rule> known;
        const auto [at, is_new] = known.try_emplace(&rule);
        if (!is_new) return at->second;
        std::vector<nestgrid::Stencil> nodes(rule.new_nodes.rbegin(), rule.new_nodes.rend());
        std::vector<nestgrid::Child> children(rule.children.rbegin(), rule.children.rend());
        const auto last = static_cast<std::uint8_t>(2 * dim + 1 + rule.new_node_count());
        for (nestgrid::Child& child : children) {
            for (std::uint8_t& k : child.corner) {
                if (k > dim) k = static_cast<std::uint8_t>(last - k);
            }
            std::rotate(child.corner.begin(), child.corner.begin() + 1, child.corner.begin() + 3);
        }
        at->second = nestgrid::make_rule("shuffled " + rule.name, rule.parent, nodes, children);
        return at->second;
    }

    /// Corner 0 and what leads from it along each axis.
    static std::array<Point, 4> axes(const Cell& cell) {
        std::array<Point, 4> result{cell.corner[0], Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
        for (std::size_t k = 1; k < cell.corner.size(); ++k) {
            const Point& at = nestgrid::topology(cell.shape).reference[k];
            if (at[0] + at[1] + at[2] != 1) continue;
            const std::size_t axis = at[0] == 1 ? 0 : at[1] == 1 ? 1 : 2;
            result[axis + 1] = cell.corner[k] - cell.corner[0];
        }
        return result;
    }
    static Point position(const Cell& cell, const Point& x) {
        const std::array<Point, 4> a = axes(cell);
        Point result = a[0];
        for (std::size_t d = 0; d < dim; ++d) result = result + x[d] * a[d + 1];
        return result;
    }
    static Point reference(const Cell& cell, const Point& x) {
        const std::array<Point, 4> a = axes(cell);
        const Point r = x - a[0];
        const double det = dot(a[1], cross(a[2], a[3]));
        Point t{dot(r, cross(a[2], a[3])) / det, dot(a[1], cross(r, a[3])) / det,
                dot(a[1], cross(a[2], r)) / det};
        if (dim == 2) t[2] = 0;
        return t;
    }
    /// How far inside a cell a point lies, in reference coordinates.
    static double inside(const Cell& cell, const Point& x) {
        const Point t = reference(cell, x);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t d = 0; d < dim; ++d) least = std::min(least, t[d]);
        const bool triangle = cell.shape == Shape::triangle || cell.shape == Shape::prism;
        if (triangle) least = std::min(least, 1 - t[0] - t[1]);
        if (cell.shape == Shape::prism) least = std::min(least, 1 - t[2]);
        if (cell.shape == Shape::tetrahedron) least = std::min(least, 1 - t[0] - t[1] - t[2]);
        if (cell.shape == Shape::pyramid) least = std::min(least, 1 - t[2] - std::max(t[0], t[1]));
        for (std::size_t d = 0; cell.shape == box && d < dim; ++d)
            least = std::min(least, 1 - t[d]);
        return least;
    }
    std::size_t nearest(std::size_t first, std::size_t count, const Point& x) const {
        std::size_t best = first;
        double most = -std::numeric_limits<double>::infinity();
        for (std::size_t i = first; i < first + count; ++i) {
            const double here = inside(cells_[i], x);
            if (here > most) {
                most = here;
                best = i;
            }
        }
        return best;
    }

    WorldOptions options_;
    Function f_;
    std::size_t coarse_ = 0;
    std::vector<Cell> cells_;
};

/// The data of a world.
template <int dim>
class ShapeField {
public:
    using value_type = double;
    using Element = typename ShapeWorld<dim>::Element;

    explicit ShapeField(const ShapeWorld<dim>& world) : world_{&world} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto e = world_->coarse(i).element;
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k] = world_->f(e, nestgrid::topology(world_->shape(e)).reference[k]);
        }
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask, std::span<double> out) const {
        const std::vector<Point> nodes = nestgrid::reference_nodes(*world_->split(e));
        const std::size_t corners = nestgrid::topology(world_->shape(e)).corners;
        for (std::size_t n = 0; n < out.size(); ++n) out[n] = world_->f(e, nodes[corners + n]);
        return 0;
    }
    int degree(const Element& leaf) const { return world_->polynomial(leaf).degree(); }
    void evaluate(const Element& leaf, std::span<const Point> reference,
                  std::span<double> out) const {
        ++evaluated;
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = world_->polynomial(leaf)(reference[i]);
        }
    }

    mutable std::size_t evaluated = 0;  ///< calls of evaluate()

private:
    const ShapeWorld<dim>* world_;
};

}  // namespace nestgrid_test
