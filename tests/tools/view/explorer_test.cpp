// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of the interactive page: the surfaces of the library, within the numbers of triangles that
// were asked for.
#include <gtest/gtest.h>

#include <explored_samples.hpp>
#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "families.hpp"
#include "frame_of.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;
using namespace nestgrid::view;

namespace {

template <class Family>
class Explored : public testing::Test {};
using FamiliesInSpace = testing::Types<BisectionTetrahedra, RedGreenTetrahedra, RedGreenMixed3,
                                       UnbalancedOctree, Prisms>;
TYPED_TEST_SUITE(Explored, FamiliesInSpace);

TYPED_TEST(Explored, FramesHaveTheBitsOfTheLibrary) {
    for_each_field_at_sphere<TypeParam>(2, 5, [](const auto& grid, const NodalSamples& samples) {
        using Grid = std::decay_t<decltype(grid)>;
        const NodeField<Grid, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const SequentialExecutor executor;
        Explorer explorer(borrowed_field(grid, samples.values), executor);
        const Plane plane({0.41, 0.5, 0.5}, {1, 0.2, 0.1});
        const double isovalue = 0;  // which the fields cross
        for (const double part : {0.0, 0.05}) {
            const double threshold = part * (indicator.greatest() - indicator.least());
            const Threshold s(&indicator, threshold);
            const auto surface = isosurface(grid, field, isovalue, under(s, indicator),
                                            {.cuts = Cuts::finest, .normals = true});
            const auto cut = slice(grid, field, plane, under(s, indicator));
            const Frame frame = frame_of(
                explorer, "isovalue=" + text_of(isovalue) + "&threshold=" + text_of(threshold) +
                              "&plane=0.41,0.5,0.5,1,0.2,0.1&normals=float32&outlines=on");
            expect_part(frame, "isosurface", surface.surface);
            expect_same_bits(frame.array<float>("isosurface", "normals"),
                             floats_of(surface.surface.normals), "normals");
            expect_part(frame, "slice", cut.surface);
            expect_same_bits(
                frame.array<float>("slice", "values"),
                std::vector<float>(cut.surface.attributes.begin(), cut.surface.attributes.end()),
                "values");
            expect_part(frame, "outlines", outlines(cut.surface));
            EXPECT_EQ(frame.number("error_bound", "isosurface"), surface.error_bound);
            EXPECT_EQ(frame.number("visited", "slice"), double(cut.counts.visited));
            EXPECT_EQ(frame.number("triangles"),
                      double(surface.surface.simplices.size() + cut.surface.simplices.size()));
        }
    });
}

LatticeGeometry<3> cube_of(int n) {
    const double h = 1.0 / (n - 1);
    return {.samples = {n, n, n}, .spacing = {h, h, h}};
}

/// The samples of a field in a cube, and what explores them.
class Volume {
public:
    explicit Volume(const SampledField& field, int n)
        : values_{field.values},
          explorer{explored_samples(cube_of(n), std::span<const float>(values_)), executor_} {}

private:
    std::vector<float> values_;
    SequentialExecutor executor_;

public:
    Explorer explorer;
};

SampledField field_named(const std::string& name, int n) {
    for (SampledField& field : sampled_fields({n, n, n})) {
        if (field.name == name) return std::move(field);
    }
    throw std::out_of_range(name);
}

/// Fields without the symmetries of the lattice, by which many triangles come at once.
std::vector<SampledField> generic_fields(int n) {
    const auto off_centre = [](double x, double y, double z) {
        return std::hypot(x - 0.47, 1.1 * (y - 0.51), 0.9 * (z - 0.44));
    };
    return {{"ellipsoid", sample({n, n, n}, off_centre), 0.37, 0.8},
            field_named("bucky ball", n),
            field_named("gyroid", n)};
}

TEST(MovingFrames, KeepWithinFivePercentOfTheTriangles) {
    for (const SampledField& field : generic_fields(65)) {
        const std::string& name = field.name;
        Volume volume(field, 65);
        for (const int goal : {10000, 30000}) {
            const std::string within = "triangles=" + std::to_string(goal) + "&isovalue=";
            const Frame settled =
                frame_of(volume.explorer, within + text_of(field.isovalue - 0.05 * field.range));
            EXPECT_LE(settled.number("triangles"), goal) << name;
            double draws = 0;
            for (int i = 0; i < 60; ++i) {
                const double isovalue = field.isovalue + 0.1 * field.range * (i - 30) / 60;
                const Frame frame =
                    frame_of(volume.explorer, within + text_of(isovalue) + "&motion=moving");
                EXPECT_NEAR(frame.number("triangles"), goal, 0.05 * goal) << name << ' ' << i;
                draws += frame.number("draws");
            }
            // A leap takes more than one draw.
            const Frame leap =
                frame_of(volume.explorer,
                         within + text_of(field.isovalue - 0.1 * field.range) + "&motion=moving");
            EXPECT_NEAR(leap.number("triangles"), goal, 0.05 * goal) << name;
            EXPECT_LT(draws, 60 * 1.3) << name << " at " << goal;
        }
    }
}

TEST(SettledFrames, HaveTheThresholdOfTheSearch) {
    for (const SampledField& field : sampled_fields({33, 33, 33})) {
        SCOPED_TRACE(field.name);
        Volume volume(field, 33);
        const LatticeBisection<3> grid(cube_of(33));
        const LatticeField samples(grid, std::span<const float>(field.values));
        const HierarchicalIndicator indicator(grid, samples);
        for (const std::uint64_t goal : {3000U, 700U, 20000U, 10000000U}) {
            std::string request =
                "triangles=" + std::to_string(goal) + "&isovalue=" + text_of(field.isovalue);
            frame_of(volume.explorer, request + "&motion=moving");
            const Frame frame = frame_of(volume.explorer, request);
            const TriangleBudget best = isosurface<3>(erase(grid, samples), field.isovalue,
                                                      under(indicator, {.max_triangles = goal}))
                                            .search;
            EXPECT_EQ(frame.number("triangles"), double(best.triangles)) << goal;
            EXPECT_EQ(frame.number("threshold"), best.threshold) << goal;
        }
    }
}

TEST(SettledFrames, AreTheFinestWithinTheTriangles) {
    const SampledField field = field_named("gyroid", 33);
    Volume volume(field, 33);
    const std::vector<std::pair<std::string, int>> cases{
        {"plane=0.3,0.4,0.5,3,2,1", 1500},
        {"isovalue=0.1&axis=x&at=0.52", 9000},
        {"isovalue=0.1&indicator=visual", 9000},
        {"isovalue=0.1&indicator=numerical", 9000},
        {"isovalue=0.1&indicator=wavelet", 9000},
        {"isovalue=0.1&lens=0.5,0.5,0.5,0.1&slope=2", 20000}};
    for (const auto& [what, goal] : cases) {
        const Frame frame = frame_of(volume.explorer, what + "&triangles=" + std::to_string(goal));
        const double threshold = frame.number("threshold");
        EXPECT_LE(frame.number("triangles"), goal) << what;
        EXPECT_GT(threshold, 0) << what;
        // The next threshold of 8 significant bits.
        const double less = threshold - std::exp2(std::ilogb(threshold) - 8);
        EXPECT_GT(
            frame_of(volume.explorer, what + "&threshold=" + text_of(less)).number("triangles"),
            goal)
            << what;
    }
}

TEST(Lenses, DrawTheFinestSurfaceInTheirBallAndNotElsewhere) {
    Volume volume(field_named("sphere", 65), 65);
    const auto in_ball = [](const Frame& frame) {
        std::vector<std::array<float, 3>> points;
        const auto x = frame.array<float>("isosurface", "positions");
        for (std::size_t v = 0; v < x.size(); v += 3) {
            if (std::hypot(x[v] - 0.87, x[v + 1] - 0.5, x[v + 2] - 0.5) < 0.08) {
                points.push_back({x[v], x[v + 1], x[v + 2]});
            }
        }
        std::ranges::sort(points);
        return points;
    };
    const std::string coarse = "isovalue=0.37&threshold=0.05";
    const Frame without = frame_of(volume.explorer, coarse);
    const Frame with = frame_of(volume.explorer, coarse + "&lens=0.87,0.5,0.5,0.2&slope=1");
    const Frame finest = frame_of(volume.explorer, "isovalue=0.37");
    EXPECT_EQ(in_ball(with), in_ball(finest));
    EXPECT_GT(in_ball(with).size(), 10 * in_ball(without).size());
    EXPECT_LT(with.number("triangles"), finest.number("triangles") / 2);
}

TYPED_TEST(Explored, FramesKeepErrors) {
    for_each_field_at_sphere<TypeParam>(2, 6, [](const auto& grid, const NodalSamples& samples) {
        using Grid = std::decay_t<decltype(grid)>;
        const NodeField<Grid, double> field(grid, samples.values);
        const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
        const SequentialExecutor executor;
        Explorer explorer(borrowed_field(grid, samples.values), executor);
        const double error = 0.1 * (deviations.greatest() - deviations.least());
        const auto surface = isosurface(grid, field, 0.0, under(deviations, error));
        const std::string what = "isovalue=0&threshold=" + text_of(error) + "&indicator=";
        const Frame frame = frame_of(explorer, what + "deviation");
        expect_part(frame, "isosurface", surface.surface);
        EXPECT_EQ(frame.number("error_bound", "isosurface"), surface.error_bound);
        EXPECT_TRUE(frame_of(explorer, what + "offset").has("isosurface"));
    });
}

/// A field on a grid of a family, and the error that is asked for.
template <class Family, class Function>
void for_each_error(const Function& function) {
    for_each_field_at_sphere<Family>(2, 6, [&](const auto& grid, const NodalSamples& samples) {
        using Grid = std::decay_t<decltype(grid)>;
        const NodeField<Grid, double> field(grid, samples.values);
        const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
        const SequentialExecutor executor;
        Explorer explorer(borrowed_field(grid, samples.values), executor);
        function(explorer, grid, field, deviations,
                 0.1 * (deviations.greatest() - deviations.least()));
    });
}

constexpr double at_zero = 0;  // an isovalue that the fields cross

TYPED_TEST(Explored, ErrorsAreThoseOfTheDataAndOfTheSurfaceOnceNothingMoves) {
    for_each_error<TypeParam>([](Explorer& explorer, const auto& grid, const auto& field,
                                 const HierarchicalIndicator& deviations, double error) {
        const std::string what = "isovalue=0&error=" + text_of(error);
        const auto of_data = isosurface(grid, field, at_zero, under(deviations, error));
        const Frame moving = frame_of(explorer, what + "&motion=moving");
        expect_part(moving, "isosurface", of_data.surface);
        EXPECT_FALSE(moving.has_number("distance"));
        const SweptIndicator cuts =
            cut_deviations({grid, field}, std::span(&at_zero, 1), deviations);
        const Threshold s(&cuts, error);
        const bool of_one = detail::cuts_are_errors(erase(grid, field).facts());
        const auto of_surface = isosurface(grid, field, at_zero, under(s, deviations));
        const Frame settled = frame_of(explorer, what);
        expect_part(settled, "isosurface", of_one ? of_surface.surface : of_data.surface);
        EXPECT_EQ(settled.number("error_bound"),
                  of_one ? of_surface.error_bound : of_data.error_bound);
        // A slice keeps the error of all data.
        const Frame sliced = frame_of(explorer, what + "&axis=x&at=0.41");
        expect_part(sliced, "isosurface", of_data.surface);
        EXPECT_TRUE(sliced.has("slice"));
    });
}

TYPED_TEST(Explored, DistancesAreThoseOfSlopes) {
    for_each_error<TypeParam>([](Explorer& explorer, const auto& grid, const auto& field,
                                 const HierarchicalIndicator& deviations, double error) {
        constexpr double distance = 0.04;
        const SweptIndicator slopes =
            slope_deviations({grid, field}, std::span(&at_zero, 1), deviations);
        const auto expected =
            isosurface(grid, field, at_zero, under(Threshold(&slopes, distance), deviations),
                       {.cuts = Cuts::finest});
        const auto at_distance = [&](double d) {
            return frame_of(explorer, "isovalue=0&distance=" + text_of(d));
        };
        const Frame frame = at_distance(distance);
        expect_part(frame, "isosurface", expected.surface);
        EXPECT_LE(frame.number("distance"), distance);
        // The distance that is told of an error drops all that the error drops, and a lesser one
        // does not.
        const Frame kept = frame_of(explorer, "isovalue=0&error=" + text_of(error));
        const double told = kept.number("distance");
        if (told == 0) return;  // all is drawn
        EXPECT_LE(at_distance(told).number("triangles"), kept.number("triangles"));
        EXPECT_EQ(at_distance(told).number("distance"), told);
        EXPECT_LT(at_distance(0.99 * told).number("distance"), told);
    });
}

TYPED_TEST(Explored, CollapsedFramesKeepTheError) {
    for_each_error<TypeParam>([](Explorer& explorer, const auto& grid, const auto& field,
                                 const HierarchicalIndicator& deviations, double error) {
        const std::string what = "isovalue=0&collapse=on&error=" + text_of(error);
        const SweptIndicator cuts =
            cut_deviations({grid, field}, std::span(&at_zero, 1), deviations);
        const bool of_one = detail::cuts_are_errors(erase(grid, field).facts());
        const Indicator& indicator = of_one ? static_cast<const Indicator&>(cuts) : deviations;
        auto drawn = isosurface(grid, field, at_zero,
                                under(Threshold(&indicator, collapse_start * error), deviations));
        collapse(drawn.surface, erase(grid, field), at_zero, deviations, {.error = error})
            .hand_to(drawn, drawn.surface_error);
        const Frame frame = frame_of(explorer, what);
        expect_part(frame, "isosurface", drawn.surface);
        EXPECT_EQ(frame.number("error_bound"), drawn.error_bound);
        EXPECT_FALSE(frame.has_number("distance"));
        // Nothing is collapsed while something moves.
        expect_part(frame_of(explorer, what + "&motion=moving"), "isosurface",
                    isosurface(grid, field, at_zero, under(deviations, error)).surface);
    });
}

TEST(MovingFrames, OfADistanceHaveTheTrianglesOfTheLastSettledOne) {
    for (const SampledField& field : generic_fields(65)) {
        SCOPED_TRACE(field.name);
        Volume volume(field, 65);
        const auto at = [&](double part, const std::string& motion) {
            return frame_of(volume.explorer, "distance=0.004&motion=" + motion + "&isovalue=" +
                                                 text_of(field.isovalue + part * field.range));
        };
        // Nothing is settled yet.
        EXPECT_GT(at(0, "moving").number("distance"), 0);
        const double goal = at(0, "settled").number("triangles");
        for (const double part : {0.01, 0.02, 0.03}) {
            const Frame frame = at(part, "moving");
            EXPECT_NEAR(frame.number("triangles"), goal, 0.05 * goal);
            EXPECT_FALSE(frame.has_number("distance"));
        }
        EXPECT_LE(at(0.03, "settled").number("distance"), 0.004);
    }
}

TEST(Times, GiveFramesThemselvesAndWhatLiesBetween) {
    const auto first = field_named("sphere", 33).values;
    const auto second = field_named("gyroid", 33).values;
    const SequentialExecutor executor;
    const std::vector<std::span<const float>> both{first, second};
    Explorer explorer(explored_samples(cube_of(33), both, {2, 6}), executor);
    Explorer alone(explored_samples(cube_of(33), both[1]), executor);
    const std::string what = "isovalue=0.4&threshold=0.02";
    const Frame last = frame_of(explorer, what + "&time=6");
    const Frame second_alone = frame_of(alone, what);
    expect_same_bits(last.array<float>("isosurface", "positions"),
                     second_alone.array<float>("isosurface", "positions"), "vertices");

    const LatticeBisection<3> grid(cube_of(33));
    const LatticeField a(grid, both[0]);
    const LatticeField b(grid, both[1]);
    const std::array weights{0.75F, 0.25F};
    const HierarchicalIndicator of_a(grid, a);
    const HierarchicalIndicator of_b(grid, b);
    const KeyFrames indicator({&of_a, &of_b}, weights);
    const Between between({&a, &b}, weights);
    const Threshold s(&indicator, 0.02);
    const IsosurfaceOptions finest{.cuts = Cuts::finest};
    expect_part(frame_of(explorer, what + "&time=3"), "isosurface",
                isosurface(grid, between, 0.4, under(s, indicator), finest).surface);

    EXPECT_TRUE(frame_of(explorer, what + "&time=6&indicator=wavelet").has("isosurface"));
    const SweptIndicator wavelets_of_a = wavelet_indicator({grid, a});
    const SweptIndicator wavelets_of_b = wavelet_indicator({grid, b});
    const SweptKeyFrames wavelets({&wavelets_of_a, &wavelets_of_b}, weights);
    expect_part(frame_of(explorer, what + "&time=3&indicator=wavelet"), "isosurface",
                isosurface(grid, between, 0.4, under(Threshold(&wavelets, 0.02), indicator), finest)
                    .surface);

    constexpr double isovalue = 0.4;
    const HierarchicalIndicator errors_of_a(grid, a, NodeError::deviation);
    const HierarchicalIndicator errors_of_b(grid, b, NodeError::deviation);
    const KeyFrames errors({&errors_of_a, &errors_of_b}, weights);
    // Between frames errors are those of the frames, without a walk for each time.
    expect_part(frame_of(explorer, "isovalue=0.4&error=0.05&time=3"), "isosurface",
                isosurface(grid, between, isovalue, under(errors, 0.05)).surface);
    const SweptIndicator slopes =
        slope_deviations({grid, between}, std::span(&isovalue, 1), errors);
    expect_part(frame_of(explorer, "isovalue=0.4&distance=0.01&time=3"), "isosurface",
                isosurface(grid, between, isovalue, under(Threshold(&slopes, 0.01), errors), finest)
                    .surface);
    EXPECT_TRUE(frame_of(explorer, what + "&time=3&indicator=visual").has("isosurface"));
    // The same isovalue at another time is another surface, as is another isovalue.
    for (const double value : {isovalue, 0.1}) {
        const SweptIndicator of_first =
            cut_deviations({grid, a}, std::span(&value, 1), errors_of_a);
        expect_part(
            frame_of(explorer, "isovalue=" + text_of(value) + "&error=0.005&time=2"), "isosurface",
            isosurface(grid, a, value, under(Threshold(&of_first, 0.005), errors_of_a)).surface);
    }
    expect_refused([&] { explorer.frame(what + "&time=7"); }, "7");
    expect_refused([&] { alone.frame(what + "&time=7"); }, "one frame");
}

TEST(Volumes, OfAnyTypeGiveTheSameSurface) {
    const std::size_t count = std::size_t{17} * 17 * 17;
    const SequentialExecutor executor;
    const auto positions = [&]<class Sample>(Sample) {
        std::vector<Sample> samples;
        for (std::size_t i = 0; i < count; ++i) samples.push_back(static_cast<Sample>(i * i % 101));
        Explorer explorer(explored_samples(cube_of(17), std::span<const Sample>(samples)),
                          executor);
        return frame_of(explorer, "isovalue=50.25&threshold=3")
            .template array<float>("isosurface", "positions");
    };
    const auto expected = positions(std::uint8_t{});
    EXPECT_GT(expected.size(), 1000U);
    expect_same_bits(positions(std::int16_t{}), expected, "int16");
    expect_same_bits(positions(float{}), expected, "float");
}

TEST(Explorers, KeepWhatTheyExploreAlive) {
    const SequentialExecutor executor;
    auto samples = std::make_shared<std::vector<float>>(field_named("sphere", 17).values);
    const std::weak_ptr<std::vector<float>> watch = samples;
    {
        Explorer explorer(explored_samples(cube_of(17), std::span<const float>(*samples), samples),
                          executor);
        samples.reset();
        EXPECT_FALSE(watch.expired());
        EXPECT_GT(frame_of(explorer, "isovalue=0.37").number("triangles"), 100);
    }
    EXPECT_TRUE(watch.expired());
}

TEST(Explorers, RefuseFieldsInThePlane) {
    const BisectionGrid<2> grid(triangles(1));
    const std::vector<double> values(grid.node_count(), 1.0);
    const SequentialExecutor executor;
    expect_refused([&] { Explorer(borrowed_field(grid, values), executor); }, "2 dimensions");
}

TEST(Info, TellsRangeBoxAndAnIsovalueThatIsMet) {
    for (const SampledField& field : sampled_fields({17, 17, 17})) {
        Volume volume(field, 17);
        const std::string info = volume.explorer.info();
        const std::size_t at = info.find("\"isovalue\":") + 11;
        const Frame frame =
            frame_of(volume.explorer, "isovalue=" + text_of(std::stod(info.substr(at))));
        EXPECT_GT(frame.number("triangles"), 0) << field.name;
        EXPECT_NE(info.find("\"box\":[[0,0,0],[1,1,1]]"), std::string::npos) << info;
    }
}

TEST(Info, TellsOfTheSamplesAndNotOfNodesBeyondThem) {
    constexpr int n = 20;
    std::vector<float> first;
    for (int i = 0; i < n * n * n; ++i) first.push_back(static_cast<float>(i % n));
    std::vector<float> second = first;
    second[5] = 40;
    const SequentialExecutor executor;
    const std::vector<std::span<const float>> both{first, second};
    const Explorer explorer(explored_samples(cube_of(n), both, {0, 1}), executor);
    const std::string info = explorer.info();
    for (const char* part : {"\"samples\":8000", "\"least\":0,\"greatest\":40",
                             "[\"norm\",\"offsets of all components"}) {
        EXPECT_NE(info.find(part), std::string::npos) << part << " in " << info;
    }
}

TEST(Frames, ForWhichNobodyWaitsEndAtOnceAndLeaveNoTrace) {
    const SampledField field = field_named("gyroid", 65);
    const TbbExecutor threads(2);
    const SequentialExecutor one;
    for (const Executor* executor :
         {static_cast<const Executor*>(&one), static_cast<const Executor*>(&threads)}) {
        const auto explored = [&] {
            return explored_samples(cube_of(65), std::span<const float>(field.values));
        };
        Explorer explorer(explored(), *executor);
        Explorer untouched(explored(), *executor);
        for (const std::string request :
             {"isovalue=0.1&indicator=numerical&threshold=0.1",
              "isovalue=0.1&indicator=visual&triangles=9000", "isovalue=0.1",
              "isovalue=0.1&triangles=9000", "axis=x&at=0.5",
              "isovalue=0.1&lens=0.5,0.5,0.5,0.1&triangles=20000", "isovalue=0.1&error=0.2",
              "isovalue=0.1&distance=0.01", "isovalue=0.1&error=0.2&collapse=on"}) {
            for (const int patience : {0, 1, 3, 10}) {
                int told = 0;
                bool over = false;
                const auto watch = [&](const FrameStep& step) {
                    EXPECT_FALSE(over) << request << " goes on";
                    EXPECT_STRNE(step.doing, "");
                    EXPECT_FALSE(step.share < 0 || step.share > 1) << step.share;
                    over = ++told > patience;
                    return !over;
                };
                try {
                    explorer.frame(request, watch);
                    EXPECT_LE(told, patience) << request;
                } catch (const FrameAbandoned&) {
                    EXPECT_TRUE(over) << request;
                }
            }
        }
        const std::string next = "isovalue=0.12&triangles=9000";
        const Frame frame = frame_of(explorer, next);
        const Frame expected = frame_of(untouched, next);
        EXPECT_EQ(frame.number("threshold"), expected.number("threshold"));
        expect_same_bits(frame.array<float>("isosurface", "positions"),
                         expected.array<float>("isosurface", "positions"), "vertices");
    }
}

}  // namespace
