// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is not made for distributed grids is refused, on all ranks, before they talk to each other;
// docs/distributed.md lists the same.
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/discontinuous_data.hpp>
#include <nestgrid/algorithms/element_deviations.hpp>
#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/holes.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "distributed_judge.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace {

template <int dim>
using Grid = Distributed<CutGrid<dim>>;
template <int dim>
using Field = DistributedField<CutGrid<dim>, CutField<dim, double>>;

/// What one rank has.
template <int dim>
struct Scene {
    const Grid<dim>& grid;
    const Field<dim>& field;
    HierarchicalIndicator& indicator;

    auto hierarchy() const { return erase(grid, field); }
    void draw(const IsosurfaceOptions& options) const {
        isosurface(grid, field, 0.5, under(indicator, 0), options);
    }
    void draw(const Criterion& criterion, const Bounds& bounds) const {
        isosurface(grid, field, 0.5, under(criterion, bounds));
    }
};

template <int dim>
struct Refused {
    const char* what;
    std::function<void(const Scene<dim>&)> ask;
};

/// Bounds of a user's.
struct Wide final : Bounds {
    double offset_bound(NodeKey) const override { return 9; }
    double bound(const Rule&, std::span<const NodeKey>) const override { return 9; }
    const HangingNodes* hanging() const override { return nullptr; }
    bool made_for(std::uint64_t) const override { return true; }
};

struct LeafValues {
    static constexpr int components = 1;
    void leaf_values(const CutGrid<3>::Element&, std::span<double> out) const {
        std::fill(out.begin(), out.end(), 0.0);
    }
};

const std::vector<Refused<3>> in_space{
    {"normals", [](const auto& s) { s.draw({.normals = true, .at_nodes = true}); }},
    {"reference coordinates", [](const auto& s) { s.draw({.reference = true}); }},
    {"finest cuts", [](const auto& s) { s.draw({.cuts = Cuts::finest}); }},
    {"bounds of positions", [](const auto& s) { s.draw({.position_bounds = &s.indicator}); }},
    {"volume",
     [](const auto& s) {
         volume_between({s.grid, s.field}, 0.25, 0.5, under(s.indicator, 0));
     }},
    {"other bounds", [](const auto& s) { s.draw(Exact(), Wide()); }},
    {"unsaturated criteria",
     [](const auto& s) { s.draw(Unsaturated{Threshold(&s.indicator, 0.1)}, s.indicator); }},
    {"wavelet indicator",
     [](const auto& s) {
         wavelet_indicator({s.grid, s.field});
     }},
    {"hanging nodes",
     [](const auto& s) { derive_hanging_nodes(erase(s.grid, ZeroField<Grid<3>>{})); }},
    {"holes",
     [](const auto& s) {
         const auto all = s.hierarchy();
         const HiddenElements hidden(static_cast<const Hierarchy<double>&>(all));
     }},
    {"discontinuous data",
     [](const auto& s) {
         const LeafValues values;
         const DiscontinuousData data(s.grid, values);
         const ElementDeviations deviations(data);
     }},
    {"discontinuous data at points",
     [](const auto& s) {
         const LeafValues values;
         probe(DiscontinuousData(s.grid, values), std::vector<Point>{{0.3, 0.4, 0.5}});
     }},
    {"number of triangles after collapses",
     [](const auto& s) {
         isosurface<3>(s.hierarchy(), 0.5,
                       under(s.indicator, {.max_triangles = 50, .collapse = true}));
     }},
};

/// \return what each of two ranks says
template <int dim, class Family>
void expect_refused(const std::vector<Refused<dim>>& all, typename Family::Grid grid) {
    std::mt19937 random(7);
    refine_at_random(grid, random, 3, 4, 3, 200);
    const Whole whole(grid);
    const std::vector<int> owner = whole.partition(2, Whole::Cut::in_runs, random);
    std::vector<double> values(2 * whole.positions.size(), 0.25);
    for (std::size_t n = 0; n < whole.positions.size(); ++n) values[2 * n] = whole.positions[n][0];
    for (const Refused<dim>& each : all) {
        std::array<bool, 2> talked{};
        const auto ended = SimulatedRanks::run(2, [&](Ranks& ranks) {
            const Part part(whole, owner, ranks.rank());
            const CutGrid<dim> mine(whole, &part, true);
            const Grid<dim> distributed(mine, ranks);
            const Field<dim> field(distributed, {&mine, &values});
            HierarchicalIndicator indicator(distributed, field);
            const auto before = SimulatedRanks::traffic(ranks).exchanges;
            try {
                each.ask(Scene<dim>{distributed, field, indicator});
            } catch (const std::exception&) {
                talked[static_cast<std::size_t>(ranks.rank())] =
                    SimulatedRanks::traffic(ranks).exchanges != before;
                throw;
            }
        });
        for (const std::string& sentence : ended) {
            EXPECT_NE(sentence.find("not made for distributed grids yet"), std::string::npos)
                << each.what << ": '" << sentence << "'";
        }
        EXPECT_FALSE(talked[0] || talked[1]) << each.what;
    }
}

TEST(DistributedRefusals, WhatIsNotMadeForRanksSaysSo) {
    expect_refused<3, UnbalancedOctree>(in_space, UnbalancedOctree::grids()[0]);
}

}  // namespace
