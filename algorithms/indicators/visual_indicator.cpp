// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/visual_indicator.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <indicators/corner_axes.hpp>
#include <indicators/eta_source.hpp>
#include <indicators/gradient_lanes.hpp>
#include <indicators/vector_box.hpp>
#include <nestgrid/error.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// Boxes of the normals around each node.
class NormalSource final : public EtaSource {
public:
    explicit NormalSource(double tau) : tau_{tau} {}

    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               NodeEtas& etas) override {
        const std::size_t corners = split.corner_count();
        for (std::size_t n = 0; corners + n < nodes.size(); ++n) {
            const std::size_t node = nodes[corners + n];
            if (node >= boxes_.size()) boxes_.resize(node + 1);
            etas.raise(node, trace_of(split.offset(n)));
        }
        const double h = split.diameter();
        const std::vector<Child>& children = split.rule.children;
        for (std::size_t first = 0; first < children.size();) {
            std::size_t end = first;
            std::size_t lanes = 0;
            for (; end < children.size(); ++end) {
                const std::size_t more = gradient_count(children[end].shape);
                if (lanes + more > GradientLanes::count) break;
                put(split, children[end], lanes);
                lanes += more;
            }
            gradients_.solve(topology(split.rule.parent).dimension, h);
            for (std::size_t lane = 0, k = first; k < end; ++k) {
                if (children[k].shape == Shape::pyramid) average_apex(lane);
                lane += gradient_count(children[k].shape);
            }
            put_normals();
            for (std::size_t lane = 0; first < end; ++first) {
                add_normals(children[first], lane, nodes, corners);
                lane += gradient_count(children[first].shape);
            }
        }
    }
    void finish(NodeEtas& etas) override {
        for (std::size_t node = 0; node < boxes_.size(); ++node) {
            etas.raise(node, std::min(2.0, boxes_[node].diagonal()));
        }
    }

private:
    /// Puts the gradients of a child into the lanes from `lane` on.
    void put(const MeasuredSplit& split, const Child& child, std::size_t lane) {
        const auto& table = corner_axes_of[static_cast<std::size_t>(child.shape)];
        for (std::size_t i = 0; i < gradient_count(child.shape); ++i, ++lane) {
            for (std::size_t d = 0; d < topology(child.shape).dimension; ++d) {
                const std::size_t from = child.corner[table[i][d][0]];
                const std::size_t to = child.corner[table[i][d][1]];
                gradients_.set(
                    lane, d, split.positions[to] - split.positions[from],
                    split.values[to * split.components] - split.values[from * split.components]);
            }
        }
    }

    /// Adds the normals of a child to the boxes of its corners that are new.
    void add_normals(const Child& child, std::size_t lane, std::span<const std::size_t> nodes,
                     std::size_t corners) {
        const std::size_t end = lane + gradient_count(child.shape);
        VectorBox box;
        for (; lane < end; ++lane) {
            box.add({normals_[0][lane], normals_[1][lane], normals_[2][lane]});
        }
        for (std::size_t k = 0; k < topology(child.shape).corners; ++k) {
            if (child.corner[k] >= corners) boxes_[nodes[child.corner[k]]].add(box);
        }
    }
    /// Puts the mean of the gradients at the apex of a pyramid in the place of each of them.
    void average_apex(std::size_t lane) {
        for (auto& g : gradients_.result()) {
            const double mean = (g[lane + 4] + g[lane + 5] + g[lane + 6] + g[lane + 7]) / 4;
            for (std::size_t i = 4; i < 8; ++i) g[lane + i] = mean;
        }
    }
    void put_normals() {
        const auto& [x, y, z] = gradients_.result();
        GradientLanes::Lanes by;
        for (std::size_t l = 0; l < GradientLanes::count; ++l) {
            const double square = x[l] * x[l] + y[l] * y[l] + z[l] * z[l] + tau_ * tau_;
            by[l] = 1 / std::sqrt(std::max(square, std::numeric_limits<double>::min()));
        }
        for (std::size_t d = 0; d < 3; ++d) {
            for (std::size_t l = 0; l < GradientLanes::count; ++l) {
                normals_[d][l] = static_cast<float>(gradients_.result()[d][l] * by[l]);
            }
        }
    }

    double tau_;
    std::vector<VectorBox> boxes_;
    GradientLanes gradients_;
    std::array<std::array<float, GradientLanes::count>, 3> normals_{};  // by coordinate
};

/// Finds the least and the greatest value of component 0, in a walk or in rows.
template <class Real>
class RangeVisitor final : public Visitor<Real> {
public:
    using View = ElementView<Real>;

    explicit RangeVisitor(std::size_t components) : components_{components} {}

    Real range() const { return least_ < greatest_ ? greatest_ - least_ : 0; }

    /// \param value component 0 of the first node, and then every component
    void add(const Real* value, std::size_t nodes) {
        for (std::size_t i = 0; i < nodes; ++i) {
            least_ = std::min(least_, value[i * components_]);
            greatest_ = std::max(greatest_, value[i * components_]);
        }
    }

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule&, const Real*, NodeMask, bool) override { return {}; }
    Decision inspect(const View& view, const Split&) override {
        if (view.level == 0) add(view.value, view.corner_count());
        return {};
    }
    void extract(const View&) override {}
    void entered(const View& view, const Split& split, const Real* value) override {
        add(value + view.corner_count() * components_, split.rule->new_nodes.size());
    }

private:
    std::size_t components_;
    Real least_ = std::numeric_limits<Real>::max();
    Real greatest_ = std::numeric_limits<Real>::lowest();
};

/// 2^-20 of the range of component 0.
template <class Real>
double default_tau(const Hierarchy<Real>& hierarchy) {
    RangeVisitor<Real> visitor(static_cast<std::size_t>(hierarchy.facts().components));
    if (hierarchy.facts().knows_stars) {
        std::vector<Real> values;  // stars are known of fields of one component
        hierarchy.star_rows([&](const StarRow& row) {
            values.resize(row.count);
            hierarchy.row_values(static_cast<NodeKey>(row.first), row.stride, values);
            visitor.add(values.data(), row.count);
        });
    } else {
        const HangingNodes hanging = find_hanging_nodes(hierarchy);
        const Walk<Real> walk(hierarchy, {.keys = false}, &hanging);
        walk.run(visitor);
    }
    return 0x1p-20 * static_cast<double>(visitor.range());
}

template <class Real>
SweptIndicator sweep_normals(const Hierarchy<Real>& hierarchy, const VisualOptions& options) {
    if (options.tau && !(*options.tau >= 0 && std::isfinite(*options.tau))) {
        throw InvalidInput("tau is a finite difference of data that is not negative, not " +
                           std::to_string(*options.tau));
    }
    NormalSource source(options.tau ? *options.tau : default_tau(hierarchy));
    return sweep_source(hierarchy, source, options.spread);
}

}  // namespace

}  // namespace engine

SweptIndicator visual_indicator(const Hierarchy<float>& hierarchy, const VisualOptions& options) {
    return engine::sweep_normals(hierarchy, options);
}

SweptIndicator visual_indicator(const Hierarchy<double>& hierarchy, const VisualOptions& options) {
    return engine::sweep_normals(hierarchy, options);
}

}  // namespace nestgrid
