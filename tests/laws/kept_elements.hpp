// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The elements of a hierarchy with their values, kept for judges by brute force.
#pragma once

#include <vector>

#include <walk/hanging_nodes.hpp>
#include <walk/walk.hpp>

#include "closedness.hpp"

namespace nestgrid_test {

/// A split or a leaf as a walk meets it.
struct KeptElement {
    const Rule* rule;  // null for a leaf
    Shape shape;
    int level;
    std::vector<NodeKey> keys;  // of the corners and, behind them, of the new nodes
    std::vector<double> values;
};

/// All elements of a hierarchy but copies, depth first.
inline std::vector<KeptElement> elements_of(const Hierarchy<double>& h) {
    class Keep final : public engine::Visitor<double> {
        using View = engine::ElementView<double>;

    public:
        Keep(const engine::Walk<double>& walk, std::vector<KeptElement>& kept)
            : walk_{&walk}, kept_{&kept} {}
        bool sees_hidden() const override { return true; }
        engine::Decision inspect(const View&, const engine::Split&) override { return {}; }
        void extract(const View& view) override {
            std::array<NodeKey, max_corners> keys{};
            walk_->corners(view, keys.data(), nullptr);
            keep(view, nullptr, std::span(keys).first(view.corner_count()), view.value);
        }
        void entered(const View& view, const engine::Split& split, const double* u) override {
            engine::SplitKeys room;
            keep(view, split.rule, walk_->split_keys(view, split, room), u);
        }

    private:
        void keep(const View& view, const Rule* rule, std::span<const NodeKey> keys,
                  const double* u) {
            kept_->push_back({rule, view.shape, view.level, {keys.begin(), keys.end()}, {}});
            for (std::size_t i = 0; i < keys.size(); ++i) {
                kept_->back().values.push_back(u[i * walk_->components()]);
            }
        }
        const engine::Walk<double>* walk_;
        std::vector<KeptElement>* kept_;
    };
    const HangingNodes hanging = engine::find_hanging_nodes(h);
    const engine::Walk<double> walk(h, {.keys = true}, &hanging);
    std::vector<KeptElement> kept;
    Keep visitor(walk, kept);
    walk.run(visitor);
    return kept;
}

/// Those of them that are split.
inline std::vector<KeptElement> splits_of(const Hierarchy<double>& h) {
    std::vector<KeptElement> kept = elements_of(h);
    std::erase_if(kept, [](const KeptElement& e) { return e.rule == nullptr; });
    return kept;
}

}  // namespace nestgrid_test
