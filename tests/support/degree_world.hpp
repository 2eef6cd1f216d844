// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Quadtrees and octrees whose leaves have polynomials of degrees of their own: random frames and
// mirror images of the coarse cells, unbalanced refinement, any degrees, jumps where they are asked
// for. A function is interpolated in each leaf's own frame, so that neighbours differ in their last
// bits, and, where degrees or sizes differ, in more.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#include <nestgrid/grid.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid_test {

using nestgrid::NodeMask;
using nestgrid::Point;

struct WorldOptions {
    std::size_t cells = 2;  ///< coarse cells along each direction, of [-1, 1]
    int levels = 0;         ///< of refinement, at most
    double refined = 0.3;   ///< how many of the cells of each level are
    int least_degree = 4;
    int greatest_degree = 4;
    double noise = 0;  ///< by how much data jump between leaves, at most
    unsigned seed = 1;
    bool mirrored = true;
    /// In the place of chance, where they are given: whether a cell is refined, and the degree of a
    /// leaf, by its middle and its level.
    std::function<bool(const Point& middle, int level)> divides{};
    std::function<int(const Point& middle, int level)> degree{};
};

/// Polynomial of degree p through values at the tensor product of p + 1 points in [0, 1].
template <int dim>
class TensorPolynomial {
public:
    TensorPolynomial() = default;
    TensorPolynomial(int degree, const std::function<double(const Point&)>& f) {
        for (int i = 0; i <= degree; ++i) {
            nodes_.push_back(0.5 - 0.5 * std::cos(std::acos(-1.0) * i / degree));
        }
        for (const double at : nodes_) {
            double scale = 1;
            for (const double other : nodes_) scale *= other == at ? 1 : 1 / (at - other);
            scale_.push_back(scale);
        }
        std::size_t count = 1;
        for (int d = 0; d < dim; ++d) count *= nodes_.size();
        for (std::size_t i = 0; i < count; ++i) {
            Point x{0, 0, 0};
            for (std::size_t d = 0, left = i; d < std::size_t{dim}; ++d, left /= nodes_.size()) {
                x[d] = nodes_[left % nodes_.size()];
            }
            values_.push_back(f(x));
        }
    }
    int degree() const { return static_cast<int>(nodes_.size()) - 1; }
    double operator()(const Point& x) const {
        const std::size_t n = nodes_.size();
        std::array<double, 9 * 9 * 9> left;
        std::copy(values_.begin(), values_.end(), left.begin());
        std::size_t count = values_.size();
        for (std::size_t d = 0; d < std::size_t{dim}; ++d) {
            std::array<double, 9> weight;
            for (std::size_t i = 0; i < n; ++i) {
                weight[i] = scale_[i];
                for (std::size_t k = 0; k < n; ++k) {
                    if (k != i) weight[i] *= x[d] - nodes_[k];
                }
            }
            count /= n;
            for (std::size_t row = 0; row < count; ++row) {
                double sum = 0;
                for (std::size_t i = 0; i < n; ++i) sum += weight[i] * left[row * n + i];
                left[row] = sum;
            }
        }
        return left[0];
    }

private:
    std::vector<double> nodes_;
    std::vector<double> scale_;  // of the Lagrange polynomials
    std::vector<double> values_;
};

template <int dim>
class DegreeWorld {
public:
    struct Element {
        std::uint32_t cell;
    };
    static constexpr int dimension = dim;
    static constexpr std::size_t corners = std::size_t{1} << dim;
    using Function = std::function<double(const Point&)>;

    DegreeWorld(const WorldOptions& options, Function f) : options_{options}, f_{std::move(f)} {
        std::mt19937 random(options.seed);
        std::size_t count = 1;
        for (int d = 0; d < dim; ++d) count *= options.cells;
        for (std::size_t i = 0; i < count; ++i) {
            Frame frame;
            std::iota(frame.direction.begin(), frame.direction.end(), std::size_t{0});
            if (options.mirrored) {
                std::shuffle(frame.direction.begin(), frame.direction.begin() + dim, random);
            }
            for (std::size_t d = 0, left = i; d < std::size_t{dim}; ++d, left /= options.cells) {
                frame.low[d] = left % options.cells;
                frame.flipped[d] = options.mirrored && random() % 2 == 0;
            }
            frames_.push_back(frame);
            cells_.push_back({static_cast<std::uint32_t>(i), 0, {}, 0, {}});
        }
        coarse_ = count;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            const Point middle = position(cells_[i], {0.5, 0.5, 0.5});
            const bool by_chance = cells_[i].level < options.levels &&
                                   random() % 1000 < static_cast<unsigned>(1000 * options.refined);
            const bool divides =
                options.divides ? options.divides(middle, cells_[i].level) : by_chance;
            if (divides) {
                cells_[i].first_child = static_cast<std::uint32_t>(cells_.size());
                for (std::size_t c = 0; c < corners; ++c) {
                    Cell child{cells_[i].coarse, cells_[i].level + 1, {}, 0, {}};
                    for (std::size_t d = 0; d < dim; ++d) {
                        child.low[d] = 2 * cells_[i].low[d] + (c >> d & 1U);
                    }
                    cells_.push_back(child);
                }
                continue;
            }
            const int spread = options.greatest_degree - options.least_degree + 1;
            int degree =
                options.least_degree + static_cast<int>(random() % static_cast<unsigned>(spread));
            if (options.degree) degree = options.degree(middle, cells_[i].level);
            const auto noise = [&] {
                return options.noise * (2 * (static_cast<double>(random()) / 4294967296.0) - 1);
            };
            cells_[i].u = {degree, [&](const Point& x) {
                               return f_(position(cells_[i], x)) +
                                      (options.noise > 0 ? noise() : 0);
                           }};
        }
    }

    std::size_t coarse_count() const { return coarse_; }
    nestgrid::CoarseElement<Element> coarse(std::size_t i) const {
        nestgrid::CoarseElement<Element> c;
        c.element = {static_cast<std::uint32_t>(i)};
        c.shape = rule().parent;
        for (std::size_t k = 0; k < corners; ++k) {
            const Point x = nestgrid::topology(c.shape).reference[k];
            c.corners[k] = position(cells_[i], x);
            std::uint64_t id = 0;
            for (std::size_t d = dim; d-- > 0;) {
                id = id * (options_.cells + 1) +
                     static_cast<std::uint64_t>(std::llround((c.corners[k][d] + 1) / 2 *
                                                             static_cast<double>(options_.cells)));
            }
            c.ids[k] = id;
        }
        if (dim == 3) {
            c.orientation =
                nestgrid::measure(c.shape, std::span(c.corners).first(corners)) > 0 ? 1 : -1;
        } else {
            const Point area =
                nestgrid::measure_vector(c.shape, std::span(c.corners).first(corners));
            c.orientation = area[2] > 0 ? 1 : -1;
        }
        return c;
    }
    const nestgrid::Rule* split(const Element& e) const {
        return cells_[e.cell].first_child == 0 ? nullptr : &rule();
    }
    void children(const Element& e, std::span<Element> out) const {
        for (std::uint32_t c = 0; c < out.size(); ++c) out[c] = {cells_[e.cell].first_child + c};
    }

    static const nestgrid::Rule& rule() {
        return nestgrid::dyadic_rule(dim == 3 ? nestgrid::Shape::hexahedron
                                              : nestgrid::Shape::quadrilateral);
    }
    static nestgrid::Shape shape(const Element&) { return rule().parent; }
    Point position(const Element& e, const Point& x) const { return position(cells_[e.cell], x); }
    /// The function that was interpolated, at a point of the reference element.
    double f(const Element& e, const Point& x) const { return f_(position(cells_[e.cell], x)); }
    const TensorPolynomial<dim>& polynomial(const Element& e) const { return cells_[e.cell].u; }
    /// The data at a point: those of the leaf that the point lies in.
    double operator()(const Point& x) const {
        std::size_t at = 0;
        for (std::size_t d = dim; d-- > 0;) {
            const auto cells = static_cast<double>(options_.cells);
            const double place = std::clamp((x[d] + 1) / 2 * cells, 0.0, cells - 1e-9);
            at = at * options_.cells + static_cast<std::size_t>(place);
        }
        Point local = reference(cells_[at], x);
        while (cells_[at].first_child != 0) {
            std::size_t c = 0;
            for (std::size_t d = 0; d < dim; ++d) {
                const bool upper = local[d] >= 0.5;
                c |= std::size_t{upper} << d;
                local[d] = 2 * local[d] - (upper ? 1 : 0);
            }
            at = cells_[at].first_child + c;
        }
        return cells_[at].u(local);
    }
    std::size_t leaf_count() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(cells_, [](const Cell& cell) { return cell.first_child == 0; }));
    }

private:
    struct Frame {
        std::array<std::size_t, 3> direction{};  // of space, by direction of the cell
        std::array<bool, 3> flipped{};
        std::array<std::size_t, 3> low{};  // by direction of space
    };
    struct Cell {
        std::uint32_t coarse;
        int level;
        std::array<std::size_t, 3> low;  // in the coarse cell
        std::uint32_t first_child;       // 0 on a leaf
        TensorPolynomial<dim> u;
    };

    Point position(const Cell& cell, const Point& x) const {
        const Frame& frame = frames_[cell.coarse];
        Point result{0, 0, 0};
        for (std::size_t d = 0; d < dim; ++d) {
            const double t = std::ldexp(static_cast<double>(cell.low[d]) + x[d], -cell.level);
            const std::size_t to = frame.direction[d];
            result[to] =
                -1 + 2 * (static_cast<double>(frame.low[to]) + (frame.flipped[d] ? 1 - t : t)) /
                         static_cast<double>(options_.cells);
        }
        return result;
    }
    Point reference(const Cell& cell, const Point& x) const {
        const Frame& frame = frames_[cell.coarse];
        Point result{0, 0, 0};
        for (std::size_t d = 0; d < dim; ++d) {
            const std::size_t from = frame.direction[d];
            const double t = (x[from] + 1) / 2 * static_cast<double>(options_.cells) -
                             static_cast<double>(frame.low[from]);
            result[d] = frame.flipped[d] ? 1 - t : t;
        }
        return result;
    }

    WorldOptions options_;
    Function f_;
    std::size_t coarse_ = 0;
    std::vector<Frame> frames_;
    std::vector<Cell> cells_;
};

/// The data of a world.
template <int dim>
class DegreeField {
public:
    using value_type = double;
    using Element = typename DegreeWorld<dim>::Element;

    explicit DegreeField(const DegreeWorld<dim>& world) : world_{&world} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto e = world_->coarse(i).element;
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k] = world_->f(e, nestgrid::topology(world_->rule().parent).reference[k]);
        }
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask, std::span<double> out) const {
        static const std::vector<Point> nodes = nestgrid::reference_nodes(DegreeWorld<dim>::rule());
        for (std::size_t n = 0; n < out.size(); ++n) {
            out[n] = world_->f(e, nodes[DegreeWorld<dim>::corners + n]);
        }
        return 0;
    }
    int degree(const Element& leaf) const { return world_->polynomial(leaf).degree(); }
    void evaluate(const Element& leaf, std::span<const Point> reference,
                  std::span<double> out) const {
        ++evaluated;
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = world_->polynomial(leaf)(reference[i]);
    }

    mutable std::size_t evaluated = 0;  ///< calls of evaluate()

private:
    const DegreeWorld<dim>* world_;
};

}  // namespace nestgrid_test
