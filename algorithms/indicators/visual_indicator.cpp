// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/visual_indicator.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <indicators/eta_source.hpp>
#include <indicators/normal_lanes.hpp>
#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid {

namespace engine {

namespace {

/// Boxes of the normals around each node.
class NormalSource final : public EtaSource {
public:
    explicit NormalSource(double tau) : tau_{tau}, two_{tau}, eight_{tau} {}

    std::string name() const override {
        return "the visual indicator with tau " + all_digits(tau_);
    }
    void agree(const SharedNodes& shared, NodeEtas& etas) override {
        const auto box = [&](NodeKey key) -> VectorBox& {
            const std::size_t node = etas.maxima().number(key);
            if (node >= boxes_.size()) boxes_.resize(node + 1);
            return boxes_[node];
        };
        shared.raise<VectorBox::Numbers>(
            [&](NodeKey key) { return box(key).numbers(); },
            [&](NodeKey key, const VectorBox::Numbers& told) { return box(key).raise(told); });
    }

    void split(const MeasuredSplit& split, std::span<const std::size_t> nodes,
               NodeEtas& etas) override {
        const std::size_t corners = split.corner_count();
        for (std::size_t n = 0; corners + n < nodes.size(); ++n) {
            const std::size_t node = nodes[corners + n];
            if (node >= boxes_.size()) boxes_.resize(node + 1);
            etas.raise(node, trace_of(split.offset(n)));
        }
        std::size_t normals = 0;
        for (const Child& child : split.rule.children) normals += gradient_count(child.shape);
        if (normals <= 2) return two_.add(split, nodes, boxes_);
        eight_.add(split, nodes, boxes_);
    }
    void finish(NodeEtas& etas) override {
        for (std::size_t node = 0; node < boxes_.size(); ++node) {
            etas.raise(node, std::min(2.0, boxes_[node].diagonal()));
        }
    }

private:
    double tau_;
    std::vector<VectorBox> boxes_;
    NormalLanes<2> two_;
    NormalLanes<8> eight_;
};

/// Finds the least and the greatest value of component 0, in a walk or in rows.
template <class Real>
class ValueRangeVisitor final : public Visitor<Real> {
public:
    using View = ElementView<Real>;

    explicit ValueRangeVisitor(std::size_t components) : components_{components} {}

    Real range() const { return least_ < greatest_ ? greatest_ - least_ : 0; }
    /// Takes the values of all ranks. Collective.
    void agree(Ranks& ranks) {
        double least = -static_cast<double>(least_);
        auto greatest = static_cast<double>(greatest_);
        std::array<double*, 2> all{&least, &greatest};
        take_greatest(ranks, all);
        least_ = static_cast<Real>(-least);
        greatest_ = static_cast<Real>(greatest);
    }

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
    ValueRangeVisitor<Real> visitor(static_cast<std::size_t>(hierarchy.facts().components));
    const HierarchyFacts& facts = hierarchy.facts();
    if (facts.knows_stars && facts.components == 1 && !facts.offers(Feature::hidden)) {
        std::vector<Real> values;
        hierarchy.star_rows([&](const StarRow& row) {
            values.resize(row.count);
            hierarchy.row_values(static_cast<NodeKey>(row.first), row.stride, values);
            visitor.add(values.data(), row.count);
        });
    } else {
        together(facts.shared, "the range of the data", [&] {
            const HangingNodes hanging = find_hanging_nodes(hierarchy);
            const bool keys = !hanging.empty() || facts.shared != nullptr;
            const Walk<Real> walk(hierarchy, {.keys = keys, .on_ranks = true}, &hanging);
            walk.run(visitor);
        });
        if (facts.shared != nullptr) visitor.agree(facts.shared->ranks());
    }
    return 0x1p-20 * static_cast<double>(visitor.range());
}

template <class Real>
SweptIndicator sweep_normals(const Hierarchy<Real>& hierarchy, const VisualOptions& options) {
    const auto asked = [&] {
        return options.tau ? "the visual indicator with tau " + all_digits(*options.tau)
                           : std::string("the visual indicator");
    };
    together(hierarchy.facts().shared, asked, [&] {
        if (!options.tau || (*options.tau >= 0 && std::isfinite(*options.tau))) return;
        throw InvalidInput("tau is a finite difference of data that is not negative, not " +
                           std::to_string(*options.tau));
    });
    NormalSource source(options.tau ? *options.tau : default_tau(hierarchy));
    return sweep_source(hierarchy, source, options.spread);
}

}  // namespace

}  // namespace engine

SweptIndicator visual_indicator(const FieldOnGrid& field, const VisualOptions& options) {
    return field.visit(
        [&](const auto& hierarchy) { return engine::sweep_normals(hierarchy, options); });
}

}  // namespace nestgrid
