// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <walk/walk.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// The visitor of for_each_split().
template <class Real, class Met>
class SplitVisitor final : public engine::Visitor<Real> {
public:
    SplitVisitor(const engine::Walk<Real>& walk, const Met& met) : walk_{&walk}, met_{&met} {}
    engine::Decision inspect(const engine::ElementView<Real>&, const engine::Split&) override {
        return {};
    }
    void extract(const engine::ElementView<Real>&) override {}
    void entered(const engine::ElementView<Real>& view, const engine::Split& split,
                 const Real* values) override {
        engine::SplitKeys keys;
        (*met_)(view, split, walk_->split_keys(view, split, keys), values);
    }

private:
    const engine::Walk<Real>* walk_;
    const Met* met_;
};

/// Calls met(view, split, keys, values) for every split of a hierarchy, depth first: keys and true
/// values of the corners and, behind them, of the new nodes.
template <class Real, class Met>
void for_each_split(const Hierarchy<Real>& hierarchy, const HangingNodes* hanging, const Met& met) {
    const engine::Walk<Real> walk(hierarchy, {.values = true, .keys = true}, hanging);
    SplitVisitor<Real, Met> visitor(walk, met);
    walk.run(visitor);
}

}  // namespace nestgrid_test
