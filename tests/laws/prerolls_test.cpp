// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projections of a field by name, and what its prerolls keep, on every family.
#include <atomic>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/frames.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"

using namespace nestgrid_test;

namespace prerolls_test {

/// Counts the questions that are asked, and ends the work from some question on.
class Counting final : public Watch {
public:
    explicit Counting(std::uint64_t most = ~std::uint64_t{0}) : most_{most} {}
    struct Ended {};
    void check() const override {
        if (++asked_ > most_) throw Ended{};
    }
    std::uint64_t asked() const { return asked_; }
    Work work() const { return {.watch = this}; }

private:
    std::uint64_t most_;
    mutable std::atomic<std::uint64_t> asked_{0};
};

constexpr std::array level{0.0};

/// Calls test(grid, fields) with the values of three fields on refined grids of a family.
template <class Family, class Test>
void for_each_grid(unsigned seed, Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, 2 * Family::steps);
        using Field = NodeField<typename Family::Grid, double>;
        std::vector<Field> fields;
        const auto samples = catching_fields(grid.node_positions(), seed);
        for (const std::size_t i : {0U, 1U, 6U}) fields.emplace_back(grid, samples[i].values);
        test(grid, fields);
    }
}

/// Three frames of one grid, which is borrowed.
template <class Grid, class Field>
Frames frames_on(const Grid& grid, const std::vector<Field>& fields) {
    return shared_frames(std::shared_ptr<const Grid>(std::shared_ptr<const Grid>{}, &grid), fields,
                         {0, 1, 2.5}, nullptr);
}

template <class Family>
class Projections : public testing::Test {};
TYPED_TEST_SUITE(Projections, Families);

/// Every indicator of the list, blended and through a lens or not, draws closed surfaces within
/// their bounds; one that the grid cannot use says so.
TYPED_TEST(Projections, AreSaturatedByEveryIndicatorOfTheList) {
    for_each_grid<TypeParam>(31, [](const auto& grid, const auto& fields) {
        constexpr int dimension = std::decay_t<decltype(grid)>::dimension;
        Prerolls prerolls(FieldOnGrid(grid, fields[1]));
        const LensRequest lens{.distance = Ball{{0.3, 0.3, 0.3}, 0.2}, .finest = 0.1};
        for (const IndicatorKind& kind : indicators()) {
            SCOPED_TRACE(std::string(kind.name));
            for (const double blend : {1.0, 2.0}) {
                for (const auto& in : {std::optional<LensRequest>{}, std::optional{lens}}) {
                    const Projection projection{
                        .indicator = std::string(kind.name), .blend = blend, .lens = in};
                    if (kind.needs && !prerolls.field().facts().offers(*kind.needs)) {
                        expect_refused([&] { Criteria(prerolls, projection, level, {}); },
                                       std::string(kind.needed_grids));
                        continue;
                    }
                    const Criteria criteria(prerolls, projection, level, {});
                    EXPECT_TRUE(criteria.at(0.1).saturated());
                    for (const double threshold : {0.05, 0.5}) {
                        const auto drawn = isosurface(
                            grid, fields[1], 0.0, under(criteria.at(threshold), criteria.bounds()),
                            IsosurfaceOptions{.verify = true});
                        expect_closed(drawn.surface);
                    }
                }
            }
        }
        static_assert(dimension >= 2);
    });
}

/// A projection draws what the functions draw of which it is made.
TYPED_TEST(Projections, DrawWhatTheirPartsDraw) {
    for_each_grid<TypeParam>(32, [](const auto& grid, const auto& fields) {
        constexpr int dimension = std::decay_t<decltype(grid)>::dimension;
        const auto& field = fields[0];
        const HierarchicalIndicator offsets(grid, field, Spread{.factor = 1.5});
        const HierarchicalIndicator bounds(grid, field);
        const SweptIndicator sizes = mesh_size(grid, {.factor = 1.5, .slope = 0.25});
        const Distance ball = Ball{{0.3, 0.3, 0.3}, 0.2};
        const auto parts =
            Blended(&offsets, 0.2, 1.5) && Lens(&sizes, ball, {.finest = 0.1, .blend = 1.5});
        Prerolls prerolls(FieldOnGrid(grid, field));
        const Projection projection{.threshold = 0.2,
                                    .blend = 1.5,
                                    .lens = LensRequest{ball, 0.1, LensOptions{}.coarsest, 0.25}};
        const Criteria criteria(prerolls, projection, {}, {});
        const auto hierarchy = erase(grid, field);
        const auto expected = isosurface<dimension>(hierarchy, 0.0, under(parts, offsets));
        const auto drawn =
            isosurface<dimension>(hierarchy, 0.0, under(criteria.criterion(), criteria.bounds()));
        expect_same(expected.surface, drawn.surface);
        EXPECT_EQ(expected.error_bound, drawn.error_bound);
        const Criteria plain(prerolls, Projection{.threshold = 0.1}, {}, {});
        const Threshold threshold(&bounds, 0.1);
        expect_same(isosurface<dimension>(hierarchy, 0.0, under(threshold, bounds)).surface,
                    isosurface<dimension>(hierarchy, 0.0, under(plain.criterion(), plain.bounds()))
                        .surface);
    });
}

/// What is there is not made again; what was ended is.
TYPED_TEST(Projections, KeepWhatIsMadeAndNothingOfWhatIsEnded) {
    for_each_grid<TypeParam>(33, [](const auto& grid, const auto& fields) {
        Prerolls prerolls(FieldOnGrid(grid, fields[1]));
        for (const IndicatorKind& kind : indicators()) {
            if (kind.needs) continue;
            SCOPED_TRACE(std::string(kind.name));
            prerolls.clear();
            const auto choose = [&](const Counting& watch) {
                return prerolls.choose(kind.name, 1, level, watch.work()).indicator;
            };
            const Counting ends(3);
            EXPECT_THROW(choose(ends), Counting::Ended);
            EXPECT_EQ(prerolls.memory_bytes(), 0U);
            const Counting first;
            const auto made = choose(first);
            EXPECT_GT(first.asked(), 3U);
            const Counting second;
            EXPECT_EQ(choose(second), made);
            EXPECT_EQ(second.asked(), 0U);
            prerolls.clear();
            EXPECT_NE(choose(second), made);
        }
    });
}

/// A time between frames costs no walk of the grid, where an indicator of the frames serves.
TYPED_TEST(Projections, OfTimesBetweenFramesAreSumsOfTheFrames) {
    for_each_grid<TypeParam>(34, [](const auto& grid, const auto& fields) {
        const Frames frames = frames_on(grid, fields);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(frames.at(linear_weights(frames.times(), frames.times()[i])), frames[i]);
        }
        for (const IndicatorKind& kind : indicators()) {
            if (!kind.between_frames) continue;
            SCOPED_TRACE(std::string(kind.name));
            for (std::size_t i = 0; i < 3; ++i) frames[i]->choose(kind.name, 1, {}, {});
            const Counting watch;
            const auto weights = catmull_rom_weights(frames.times(), 1.4);
            const auto moment = frames.at(weights);
            const ChosenIndicator chosen = moment->choose(kind.name, 1, {}, watch.work());
            EXPECT_EQ(watch.asked(), 0U);
            moment->field().visit([&](const auto& hierarchy) {
                constexpr int dimension = std::decay_t<decltype(grid)>::dimension;
                const auto drawn = isosurface<dimension>(
                    hierarchy, 0.0, under(Threshold(chosen.indicator.get(), 0.1), *chosen.bounds));
                expect_closed(drawn.surface);
            });
        }
    });
}

TEST(Prerolls, MakeOnceForManyThreads) {
    OctreeGrid<3> grid(hexahedra(3));
    refine_at_sphere(grid, 4);
    const auto fields = catching_fields(grid.node_positions(), 35);
    const NodeField<OctreeGrid<3>, double> field(grid, fields[1].values);
    Prerolls prerolls(FieldOnGrid(grid, field));
    const Counting alone;
    Prerolls(FieldOnGrid(grid, field)).choose("wavelet", 1, {}, alone.work());
    const Counting watch;
    std::vector<std::shared_ptr<const Indicator>> found(4);
    std::vector<std::thread> threads;
    for (auto& each : found) {
        threads.emplace_back(
            [&] { each = prerolls.choose("wavelet", 1, {}, watch.work()).indicator; });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& each : found) EXPECT_EQ(each, found.front());
    EXPECT_EQ(watch.asked(), alone.asked());
}

TEST(Prerolls, AreChosenByNamesThatDiffer) {
    std::set<std::string_view> names;
    for (const IndicatorKind& kind : indicators()) {
        EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
        EXPECT_EQ(&indicator_named(kind.name), &kind);
        EXPECT_NE(kind.measures, "");
        EXPECT_NE(kind.of_nodes.has_value(), kind.make != nullptr) << kind.name;
    }
    expect_refused([] { indicator_named("ofset"); }, "'ofset' is none of offset, deviation");
}

TEST(Projections, RefuseNumbersOutOfRange) {
    const LatticeBisection<2> grid({.samples = {5, 5}});
    const std::vector<float> values(25, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    Prerolls prerolls(FieldOnGrid(grid, field));
    const auto refused = [&](const Projection& projection, const std::string& part) {
        expect_refused([&] { Criteria(prerolls, projection, level, {}); }, part);
    };
    refused({.threshold = -1}, "threshold");
    refused({.blend = 0.5}, "blend");
    refused({.lens = LensRequest{.distance = Ball{{}, 1}, .slope = -1}}, "slope");
    refused({.indicator = "colour"}, "'colour' is none of");
    expect_refused([&] { prerolls.choose("cut", 1, {}, {}); }, "with given values");
    expect_refused([&] { Frames({}, {}, {}); }, "at least one field");
    expect_refused([&] { Frames({FieldOnGrid(grid, field)}, {0, 1}, {}); }, "a time for each");
}

}  // namespace prerolls_test
