// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What changed is refused: what can be made for a grid and a field, and every way to use it after
// the grid has changed.
#pragma once

#include <functional>

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/count_triangles.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/discontinuous.hpp>
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/holes.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/node_levels.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/probe_line.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "refusal.hpp"

namespace nestgrid_test {

using namespace nestgrid;

using NamedUses = std::vector<std::pair<std::string, std::function<void()>>>;

/// What is made for a grid in one state, and lives on when the grid changes.
template <class Grid, class Field>
class MadeOnce {
public:
    static constexpr int dimension = Grid::dimension;
    using Real = typename Field::value_type;

    /// Both are borrowed.
    MadeOnce(const Grid& grid, const Field& field) : grid_{&grid}, field_{&field} {
        prerolls_.bounds({});
    }

    const HierarchicalIndicator& indicator() const { return indicator_; }

    /// What asks the field, the hierarchy, or data that were made for the grid.
    /// \param now a hierarchy of the grid as it is; borrowed
    NamedUses uses(const Hierarchy<Real>& now) {
        return {
            {"field", [&] { HierarchicalIndicator(*grid_, *field_); }},
            {"field, probed", [&] { probe(*grid_, *field_, middle_); }},
            {"field, along a line",
             [&] { probe_line(*grid_, *field_, middle_[0], middle_[0], 2); }},
            {"field between frames", [&] { HierarchicalIndicator(*grid_, between_); }},
            {"hierarchy", [&] { probe(hierarchy_, middle_); }},
            {"hierarchy, for a preroll", [&] { HierarchicalIndicator{hierarchy_}; }},
            {"holes", [&] { HierarchicalIndicator{holes_}; }},
            {"hidden elements", [&] { Holes<Real>(now, hidden_); }},
            {"series", [&] { series_.draw(0.1); }},
            {"prerolls",
             [&] {
                 const ChosenIndicator kept = prerolls_.choose("offset", 1, {}, {});
                 probe(hierarchy_, middle_,
                       under(Threshold(kept.indicator.get(), 0.1), *kept.bounds));
             }},
            {"data that jump", [&] { probe(jumping_, middle_); }},
        };
    }
    /// Draws data that jump by their deviations.
    /// \param grid as it is
    void draw_jumping(const Grid& grid) const {
        const DiscontinuousData now(grid, one);
        if constexpr (dimension == 2) {
            shading(now, {.deviations = &jumps_});
        } else {
            slice(now, Plane{{0.5, 0.5, 0.5}, {0.3, 0.5, 0.7}}, {.deviations = &jumps_});
        }
    }

    /// Everything that may be the criterion of a drawing.
    std::vector<std::pair<std::string, std::unique_ptr<Criterion>>> criteria() const {
        std::vector<std::pair<std::string, std::unique_ptr<Criterion>>> all;
        const auto add = [&](const std::string& name, const auto& criterion) {
            all.emplace_back(name, std::make_unique<std::decay_t<decltype(criterion)>>(criterion));
        };
        for (const auto& [name, indicator] : indicators()) add(name, Threshold(indicator, 0.1));
        const Threshold swept(&swept_[0], 0.1);
        add("blend", Blended(&swept_[0], 0.1, 1));
        add("lens", Lens(&sizes_, Ball{{0.5, 0.5, 0.5}, 0.1}, {.finest = 0.1}));
        add("region", fine_inside(region_, *indicators()[0].second, 0.1, 0.01));
        add("first of two", swept && Exact{});
        add("second of two", Exact{} || swept);
        add("one that insists", Unsaturated(swept));
        add("any criterion", AnyCriterion(swept));
        return all;
    }

    /// Everything that bounds a drawing.
    std::vector<std::pair<std::string, const Bounds*>> bounds() const {
        return {{"preroll", &indicator_}, {"preroll between frames", &key_frames_}};
    }

private:
    std::vector<std::pair<std::string, const Indicator*>> indicators() const {
        std::vector<std::pair<std::string, const Indicator*>> all{
            {"offsets", &indicator_},
            {"deviations", &deviations_},
            {"node levels", &levels_},
            {"key frames", &key_frames_},
            {"swept key frames", &swept_key_frames_}};
        for (std::size_t i = 0; i < swept_.size(); ++i) {
            all.emplace_back("swept indicator " + std::to_string(i), &swept_[i]);
        }
        return all;
    }
    std::vector<SweptIndicator> make_swept() const {
        const double isovalue = 0.1;
        const std::span<const double> isovalues(&isovalue, 1);
        const Measure one = [](const MeasuredSplit&, std::span<double> eta) {
            std::ranges::fill(eta, 1.0);
        };
        std::vector<SweptIndicator> all;
        all.push_back(wavelet_indicator(hierarchy_));
        all.push_back(visual_indicator(hierarchy_));
        all.push_back(numerical_indicator(hierarchy_));
        all.push_back(norm_indicator(hierarchy_));
        all.push_back(geometry_indicator(hierarchy_));
        all.push_back(mesh_size(hierarchy_, {}));
        all.push_back(measured_indicator(hierarchy_, one));
        all.push_back(cut_deviations(hierarchy_, isovalues, indicator_));
        all.push_back(slope_deviations(hierarchy_, isovalues, indicator_));
        return all;
    }
    static double one(const ElementOf<Grid>&) { return 1.0; }
    /// The middle of the first coarse element.
    std::vector<Point> middle() const {
        auto context = make_context(*grid_);
        const auto coarse = nestgrid::detail::call_coarse(*grid_, context, 0);
        const std::size_t corners = topology(coarse.shape).corners;
        Point sum{};
        for (std::size_t k = 0; k < corners; ++k) sum = sum + coarse.corners[k];
        return {(1.0 / double(corners)) * sum};
    }

    const Grid* grid_;
    const Field* field_;
    std::vector<Point> middle_ = middle();
    nestgrid::detail::ErasedHierarchy<Grid, Field> hierarchy_{*grid_, *field_};
    std::array<float, 2> weights_{0.5F, 0.5F};
    Between<Field> between_{{field_, field_}, weights_};
    std::shared_ptr<const HiddenElements> hidden_ =
        std::make_shared<const HiddenElements>(hierarchy_);
    Holes<Real> holes_{hierarchy_, hidden_};
    IsosurfaceSeries<dimension> series_{*grid_, *field_};
    DiscontinuousData jumping_{*grid_, one};
    ElementDeviations jumps_{jumping_};
    Prerolls prerolls_{FieldOnGrid(hierarchy_)};
    HierarchicalIndicator indicator_{hierarchy_};
    HierarchicalIndicator deviations_{hierarchy_, NodeError::deviation};
    NodeLevels levels_{*grid_};
    Region region_{*grid_, [](const Point& x) { return x[0] < 0.5; }};
    SweptIndicator sizes_ = mesh_size(*grid_, {.slope = 0.5});
    std::vector<SweptIndicator> swept_ = make_swept();
    KeyFrames key_frames_{{&indicator_, &deviations_}, weights_};
    SweptKeyFrames swept_key_frames_{{&swept_[0], &swept_[0]}, weights_};
};

/// Every way to draw under a criterion and bounds, for grids of dimension 2 and 3.
template <int dimension, class Real>
NamedUses drawings(const Hierarchy<Real>& hierarchy, const Criterion& s, const Bounds& bounds) {
    NamedUses all{
        {"isosurface", [&] { isosurface<dimension>(hierarchy, 0.1, under(s, bounds)); }},
        {"probe",
         [&] {
             probe(hierarchy, std::vector<Point>{{0.3, 0.4, 0}}, under(s, bounds));
         }},
    };
    if constexpr (dimension == 2) {
        all.emplace_back("height field", [&] { height_field(hierarchy, 1.0, under(s, bounds)); });
        all.emplace_back("shading", [&] { shading(hierarchy, under(s, bounds)); });
        all.emplace_back("count", [&] { count_triangles(hierarchy, under(s, bounds), 10); });
    } else {
        all.emplace_back("slice", [&] {
            slice(hierarchy, Plane{{0.5, 0.5, 0.5}, {0.3, 0.5, 0.7}}, under(s, bounds));
        });
        all.emplace_back("boundary", [&] { boundary_surface(hierarchy, under(s, bounds)); });
    }
    return all;
}

/// Ways to draw by a preroll alone.
template <int dimension, class Real>
NamedUses drawings_by(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator) {
    NamedUses all{
        {"isosurface", [&] { isosurface<dimension>(hierarchy, 0.1, under(indicator, 0)); }},
        {"threshold of a budget",
         [&] {
             isosurface<dimension>(hierarchy, 0.1, under(indicator, {.max_triangles = 1000000}))
                 .search;
         }},
        {"cut deviations", [&] { cut_deviations(hierarchy, std::array{0.1}, indicator); }},
    };
    if constexpr (dimension == 3) {
        all.emplace_back("collapse", [&] {
            Surface<3> nothing;
            collapse(nothing, hierarchy, 0.1, indicator, {.error = 0.1});
        });
        all.emplace_back("isosurface within", [&] {
            const Surface<3> whole = isosurface<3>(hierarchy, 0.1).surface;
            isosurface_within(hierarchy, 0.1, {whole, 0.5}, Exact{}, indicator);
        });
    }
    return all;
}

inline void expect_changed(const std::string& name, const std::function<void()>& use) {
    const std::string sentence = refusal<GridError>(use);
    const bool says_so = sentence.find("changed since") != std::string::npos ||
                         sentence.find("was adapted; its adapter") != std::string::npos;
    EXPECT_TRUE(says_so) << name << ": '" << sentence << "'";
}

/// All that was made before a change is refused, with the grid and the field as they are now.
template <class Grid, class Field>
void expect_refused_after_change(MadeOnce<Grid, Field>& before, const Grid& grid,
                                 const Field& field) {
    constexpr int dimension = Grid::dimension;
    const HierarchicalIndicator indicator(grid, field);
    const auto now = erase(grid, field);
    for (const auto& [name, use] : before.uses(now)) expect_changed(name, use);
    expect_changed("deviations of data that jump", [&] { before.draw_jumping(grid); });
    for (const auto& [of, criterion] : before.criteria()) {
        for (const auto& [name, use] : drawings<dimension>(now, *criterion, indicator)) {
            expect_changed(name + " by " + of, use);
        }
    }
    const Exact all;  // the uses borrow it
    for (const auto& [of, bounds] : before.bounds()) {
        for (const auto& [name, use] : drawings<dimension>(now, all, *bounds)) {
            expect_changed(name + " within the bounds of a " + of, use);
        }
    }
    for (const auto& [name, use] : drawings_by<dimension>(now, before.indicator())) {
        expect_changed(name + " by a preroll", use);
    }
}

/// All that is made for a grid as it is works.
template <class Grid, class Field>
void expect_usable(const Grid& grid, const Field& field) {
    constexpr int dimension = Grid::dimension;
    MadeOnce<Grid, Field> made(grid, field);
    const auto now = erase(grid, field);
    for (const auto& [name, use] : made.uses(now)) EXPECT_NO_THROW(use()) << name;
    EXPECT_NO_THROW(made.draw_jumping(grid));
    for (const auto& [of, criterion] : made.criteria()) {
        const auto uses = drawings<dimension>(now, *criterion, made.indicator());
        for (const auto& [name, use] : uses) EXPECT_NO_THROW(use()) << name << " by " << of;
    }
    const Exact all;  // the uses borrow it
    for (const auto& [of, bounds] : made.bounds()) {
        const auto uses = drawings<dimension>(now, all, *bounds);
        for (const auto& [name, use] : uses) EXPECT_NO_THROW(use()) << name << " in " << of;
    }
    for (const auto& [name, use] : drawings_by<dimension>(now, made.indicator())) {
        EXPECT_NO_THROW(use()) << name;
    }
}

}  // namespace nestgrid_test
