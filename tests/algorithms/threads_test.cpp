// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What several threads extract is what one does: to the last bit, in the same order.
#include <limits>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <walk/for_each_element.hpp>
#include <walk/frontier.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace threads_test {

template <class Grid, class Field>
void expect_same_from_threads(const Grid& grid, const Field& field,
                              const std::vector<double>& isovalues, double threshold) {
    const HierarchicalIndicator indicator(grid, field);
    const Threshold criterion{&indicator, threshold};
    const IsosurfaceOptions everything{
        .normals = Grid::dimension == 3, .cap = true, .reference = true, .verify = true};
    for (const IsosurfaceOptions& options : {everything, IsosurfaceOptions{}}) {
        const auto alone =
            isosurfaces(grid, field, isovalues, under(criterion, indicator), options);
        for (const std::size_t threads : {2U, 3U}) {
            const auto together = isosurfaces(grid, field, isovalues, under(criterion, indicator),
                                              options, {ThreadExecutor(threads)});
            ASSERT_EQ(together.size(), alone.size());
            for (std::size_t i = 0; i < alone.size(); ++i) expect_same(alone[i], together[i]);
        }
        const auto triangles = [&](const Executor& executor) {
            const auto at = [&](double) { return Threshold(criterion); };
            return isosurface<Grid::dimension>(erase(grid, field), isovalues[0],
                                               under(at, indicator, {.max_triangles = 1000000}),
                                               options, {executor})
                .search.triangles;
        };
        EXPECT_EQ(triangles(SequentialExecutor{}), alone[0].surface.simplices.size());
        EXPECT_EQ(triangles(ThreadExecutor(2)), alone[0].surface.simplices.size());
    }
}

template <class Family>
class Threads : public testing::Test {};
TYPED_TEST_SUITE(Threads, Families);

TYPED_TEST(Threads, DrawWhatOneDraws) {
    for_each_field_at_sphere<TypeParam>(3, 7, [](const auto& grid, const auto& samples) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        for (const double threshold : {0.0, 0.1, 1.0}) {
            SCOPED_TRACE(threshold);
            expect_same_from_threads(grid, field, {0.0, 0.05}, threshold);
        }
    });
}

template <class Grid, class Field>
void expect_same_indicators(const Grid& grid, const Field& field, const HierarchicalIndicator& one,
                            const HierarchicalIndicator& other) {
    EXPECT_EQ(one.node_count(), other.node_count());
    EXPECT_EQ(one.least(), other.least());
    EXPECT_EQ(one.greatest(), other.greatest());
    EXPECT_EQ(one.finest_level(), other.finest_level());
    EXPECT_EQ(one.stops_conform(), other.stops_conform());
    EXPECT_EQ(one.hanging_violation(), other.hanging_violation());
    const auto hierarchy = erase(grid, field);
    const engine::Walk<typename Field::value_type> walk(hierarchy, {.keys = true}, one.hanging());
    std::size_t differ = 0;
    engine::for_each_element(walk, false, [&](const auto&, const engine::Split& split) {
        for (const NodeKey key : split.keys) {
            differ += one.stop(key) != other.stop(key) || one.bound(key) != other.bound(key);
        }
    });
    EXPECT_EQ(differ, 0U);
}

/// \param error of leaves, or nothing
template <class Grid, class Field, class... LeafError>
void expect_same_prerolls(const Grid& grid, const Field& field, const LeafError&... error) {
    const HierarchicalIndicator alone(grid, field, error...);
    EXPECT_GT(alone.node_count(), 50U);
    for (const std::size_t threads : {2U, 3U}) {
        const ThreadExecutor together(threads);
        expect_same_indicators(grid, field, alone,
                               HierarchicalIndicator(grid, field, error..., together));
    }
}

TYPED_TEST(Threads, PrepareWhatOnePrepares) {
    for_each_field_at_sphere<TypeParam>(3, 7, [](const auto& grid, const auto& samples) {
        expect_same_prerolls(grid,
                             NodeField<typename TypeParam::Grid, double>(grid, samples.values));
    });
}

TEST(ThreadsOnSamples, PrepareWhatOnePrepares) {
    const Samples n{34, 20, 33};
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeOctree<3> grid({.samples = n});
        const LatticeField field(grid, std::span<const float>(data.values));
        expect_same_prerolls(grid, field);
        expect_same_prerolls(grid, field,
                             [](const auto& e) { return 0.1 * static_cast<double>(e.low % 13); });
    }
}

TEST(ThreadsOnSamples, FindWhatCannotBeUsed) {
    const Samples n{17, 17, 17};
    const LatticeOctree<3> grid({.samples = n});
    std::vector<float> values = sampled_fields(n)[0].values;
    const LatticeField field(grid, std::span<const float>(values));
    const auto least = [](const auto& e) { return e.low == 0 ? -1.0 : 1.0; };
    const ThreadExecutor two(2);
    EXPECT_THROW(HierarchicalIndicator(grid, field, least, two), InvalidInput);
    values[1000] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(HierarchicalIndicator(grid, field, two), InvalidInput);
}

TEST(ThreadsOnSamples, DrawWhatOneDraws) {
    const Samples n{34, 20, 33};
    const LatticeBisection<3> tetrahedra({.samples = n});
    const LatticeOctree<3> hexahedra({.samples = n});
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const std::span<const float> samples(data.values);
        for (const double threshold : {0.0, 0.02}) {
            expect_same_from_threads(tetrahedra, LatticeField(tetrahedra, samples), {data.isovalue},
                                     threshold * data.range);
            expect_same_from_threads(hexahedra, LatticeField(hexahedra, samples), {data.isovalue},
                                     threshold * data.range);
        }
    }
}

struct SphereIn {
    Samples n{33, 33, 33};
    LatticeBisection<3> grid{{.samples = n}};
    SampledField data = sampled_fields(n)[0];
    LatticeField<LatticeBisection<3>, float> field{grid, std::span<const float>(data.values)};
    HierarchicalIndicator indicator{grid, field};
};

TEST(ThreadsOnStreams, HandOutTheSameTrianglesInTheSameOrder) {
    const SphereIn s;
    const auto triangles = [&](const Executor& executor) {
        std::vector<std::array<Point, 3>> all;
        const auto keep = [&](const std::array<Point, 3>& x) { all.push_back(x); };
        extract_isosurfaces(s.grid, s.field, std::span<const double>(&s.data.isovalue, 1),
                            std::vector{SimplexStream<3>(keep)},
                            under(Threshold{&s.indicator, 0.01}, s.indicator), {}, {executor});
        return all;
    };
    const auto alone = triangles(SequentialExecutor{});
    EXPECT_GT(alone.size(), 100U);
    EXPECT_EQ(alone, triangles(ThreadExecutor(2)));
}

template <class Grid>
void expect_same_in_parts(const Grid& grid, const std::vector<SampledField>& fields) {
    for (const SampledField& data : fields) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const HierarchicalIndicator indicator(grid, field);
        using Soup = SimplexSoup<Grid::dimension, double>;
        const std::vector<double> isovalues{data.isovalue, data.isovalue + 0.05 * data.range};
        const auto soups = [&](const Executor& executor) {
            std::vector<std::vector<typename Soup::Simplex>> all(2);
            std::vector<Soup> sinks;
            for (auto& soup : all) sinks.emplace_back(soup);
            const auto reports = extract_isosurfaces(
                grid, field, isovalues, std::move(sinks),
                under(Threshold{&indicator, 0.01 * data.range}, indicator), {}, {executor});
            EXPECT_EQ(reports.size(), 2U);
            return all;
        };
        const auto alone = soups(SequentialExecutor{});
        EXPECT_GT(alone[0].size() + alone[1].size(), 100U);
        for (const std::size_t threads : {2U, 3U}) {
            EXPECT_EQ(alone, soups(ThreadExecutor(threads)));
        }
    }
}

TEST(ThreadsOnSoups, FillPartsThatAreTheWhole) {
    const Samples n{33, 33, 33};
    expect_same_in_parts(LatticeBisection<3>({.samples = n}), sampled_fields(n));
    expect_same_in_parts(LatticeOctree<3>({.samples = n}), sampled_fields(n));
}

/// Triangles by their corners, and the elements they come from.
struct SoupOfElements {
    std::vector<std::array<Point, 3>> triangles;
    Surface<3> rest;  // everything but vertices and triangles
};

/// Puts the parts it takes behind each other, elements too.
class SoupWithElements final : public SimplexSink<3> {
public:
    explicit SoupWithElements(SoupOfElements& soup) : all_{&soup} {}

    void take(const Surface<3>& part) override {
        const auto append = [](const auto& from, auto& to) {
            to.insert(to.end(), from.begin(), from.end());
        };
        Surface<3>& rest = all_->rest;
        const auto elements = static_cast<std::uint32_t>(rest.elements.size());
        for (const auto& [a, b, c] : part.simplices) {
            all_->triangles.push_back({part.vertices[a], part.vertices[b], part.vertices[c]});
        }
        for (const std::uint32_t e : part.element_of) rest.element_of.push_back(elements + e);
        append(part.reference, rest.reference);
        rest.elements.append(part.elements);
        append(part.shape_of, rest.shape_of);
        append(part.level_of, rest.level_of);
    }
    bool keeps_elements() const override { return true; }

private:
    SoupOfElements* all_;
};

template <class Grid>
std::vector<NodeKey> corner_keys(const Grid& grid, const Elements& elements, Shape shape) {
    std::vector<NodeKey> keys;
    const std::size_t corners = topology(shape).corners;
    for (const ElementOf<Grid>& e : elements.as<ElementOf<Grid>>()) {
        keys.resize(keys.size() + corners);
        grid.corner_keys(e, std::span(keys).last(corners));
    }
    return keys;
}

template <class Grid>
void expect_same_elements_in_soups(const SampledField& data, const Samples& n) {
    const Grid grid({.samples = n});
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const Threshold criterion{&indicator, 0.01 * data.range};
    const std::span<const double> isovalue(&data.isovalue, 1);
    for (const bool reference : {false, true}) {
        const IsosurfaceOptions options{.reference = reference};
        const auto s =
            isosurface(grid, field, data.isovalue, under(criterion, indicator), options).surface;
        EXPECT_GT(s.simplices.size(), 100U);
        std::vector<std::array<Point, 3>> corners;
        for (const auto& [a, b, c] : s.simplices) {
            corners.push_back({s.vertices[a], s.vertices[b], s.vertices[c]});
        }
        const auto expect_same_with = [&](const Executor& executor) {
            SoupOfElements soup;
            extract_isosurfaces(grid, field, isovalue, std::vector{SoupWithElements(soup)},
                                under(criterion, indicator), options, {executor});
            EXPECT_EQ(soup.triangles, corners);
            EXPECT_EQ(soup.rest.element_of, s.element_of);
            expect_same_bits(soup.rest.reference, s.reference, "reference");
            EXPECT_EQ(corner_keys(grid, soup.rest.elements, s.shape_of[0]),
                      corner_keys(grid, s.elements, s.shape_of[0]));
            EXPECT_EQ(soup.rest.shape_of, s.shape_of);
            EXPECT_EQ(soup.rest.level_of, s.level_of);
        };
        expect_same_with(SequentialExecutor{});
        expect_same_with(ThreadExecutor(2));
    }
}

TEST(ThreadsOnSoups, TellTheSameElements) {
    const Samples n{33, 33, 33};
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        expect_same_elements_in_soups<LatticeBisection<3>>(data, n);
        expect_same_elements_in_soups<LatticeOctree<3>>(data, n);
    }
}

TEST(ThreadsOnSoups, KeepWhatAStreamHandsOut) {
    const SphereIn s;
    const Threshold criterion{&s.indicator, 0.01};
    const std::span<const double> isovalue(&s.data.isovalue, 1);
    std::vector<SimplexSoup<3, double>::Simplex> streamed;
    const auto keep = [&](const std::array<Point, 3>& x) {
        streamed.push_back(
            {x[0][0], x[0][1], x[0][2], x[1][0], x[1][1], x[1][2], x[2][0], x[2][1], x[2][2]});
    };
    extract_isosurfaces(s.grid, s.field, isovalue, std::vector{SimplexStream<3>(keep)},
                        under(criterion, s.indicator), {});
    std::vector<SimplexSoup<3, double>::Simplex> soup;
    std::vector<SimplexSoup<3, double>> sinks;
    sinks.emplace_back(soup);
    extract_isosurfaces(s.grid, s.field, isovalue, std::move(sinks), under(criterion, s.indicator),
                        {}, {ThreadExecutor(2)});
    EXPECT_GT(soup.size(), 100U);
    EXPECT_EQ(soup, streamed);
}

/// Puts the parts it takes behind each other.
class CollectingSink final : public MeshSink<3> {
public:
    explicit CollectingSink(Surface<3>& surface) : all_{&surface} {}

    void take(const Surface<3>& part) override {
        const auto append = [](const auto& from, auto& to) {
            to.insert(to.end(), from.begin(), from.end());
        };
        const auto elements = static_cast<std::uint32_t>(all_->elements.size());
        append(part.vertices, all_->vertices);
        append(part.attributes, all_->attributes);
        append(part.simplices, all_->simplices);
        for (const std::uint32_t e : part.element_of) all_->element_of.push_back(elements + e);
        append(part.reference, all_->reference);
        all_->elements.append(part.elements);
        append(part.shape_of, all_->shape_of);
        append(part.level_of, all_->level_of);
        append(part.boundary, all_->boundary);
    }
    Point position(std::uint32_t vertex) const override { return all_->vertices[vertex]; }
    bool keeps_elements() const override { return true; }
    void set_normals(std::span<const Point> normals) override {
        all_->normals.assign(normals.begin(), normals.end());
    }

private:
    Surface<3>* all_;
};

/// A sink without anything that is optional.
class PlainSink final : public MeshSink<3> {
public:
    explicit PlainSink(Surface<3>& surface) : all_{surface} {}

    void take(const Surface<3>& part) override { all_.take(part); }
    Point position(std::uint32_t vertex) const override { return all_.position(vertex); }

private:
    CollectingSink all_;
};

template <class Grid>
void expect_same_in_sinks(const Grid& grid, const SampledField& data) {
    const LatticeField field(grid, std::span<const float>(data.values));
    const HierarchicalIndicator indicator(grid, field);
    const Threshold criterion{&indicator, 0.01 * data.range};
    const std::span<const double> isovalue(&data.isovalue, 1);
    const IsosurfaceOptions everything{.normals = true, .cap = true, .reference = true};
    for (const IsosurfaceOptions& options : {everything, IsosurfaceOptions{}}) {
        const auto alone =
            isosurface(grid, field, data.isovalue, under(criterion, indicator), options);
        EXPECT_GT(alone.surface.simplices.size(), 100U);
        const auto expect_same_with = [&](const Executor& executor) {
            Surface<3> surface;
            auto results =
                extract_isosurfaces(grid, field, isovalue, std::vector{CollectingSink(surface)},
                                    under(criterion, indicator), options, {executor});
            results[0].surface = std::move(surface);
            expect_same(alone, results[0]);

            Surface<3> plain;
            extract_isosurfaces(grid, field, isovalue, std::vector{PlainSink(plain)},
                                under(criterion, indicator), options, {executor});
            EXPECT_EQ(plain.vertices, alone.surface.vertices);
            EXPECT_EQ(plain.simplices, alone.surface.simplices);
            EXPECT_EQ(plain.reference.size(), alone.surface.reference.size());
            EXPECT_TRUE(plain.normals.empty() && plain.element_of.empty());
            EXPECT_EQ(plain.elements.size() + plain.shape_of.size() + plain.level_of.size(), 0U);
        };
        expect_same_with(SequentialExecutor{});
        expect_same_with(ThreadExecutor(2));
    }
}

TEST(ThreadsOnMeshSinks, FillThemTheSame) {
    const Samples n{17, 17, 17};
    const SampledField data = sampled_fields(n)[0];
    expect_same_in_sinks(LatticeBisection<3>({.samples = n}), data);
    expect_same_in_sinks(LatticeOctree<3>({.samples = n}), data);
}

TEST(ThreadsOnBudgets, FindTheSameThreshold) {
    const SphereIn s;
    const auto one = isosurface<3>(erase(s.grid, s.field), s.data.isovalue,
                                   under(s.indicator, {.max_triangles = 1000}))
                         .search;
    const auto two =
        isosurface<3>(erase(s.grid, s.field), s.data.isovalue,
                      under(s.indicator, {.max_triangles = 1000}), {}, {ThreadExecutor(2)})
            .search;
    EXPECT_EQ(one.threshold, two.threshold);
    EXPECT_EQ(one.triangles, two.triangles);
}

class ThrowsBelow final : public Criterion {
public:
    explicit ThrowsBelow(int level) : level_{level} {}
    NodeMask holds(const NewNodes& nodes) const override {
        if (nodes.level > level_) throw GridError("too deep");
        return 0;
    }
    bool saturated() const override { return true; }

private:
    int level_;
};

TEST(ThreadsThatStop, CancelOrPassOnWhatWasThrown) {
    const SphereIn s;
    int asked = 0;
    const auto part = isosurface(s.grid, s.field, s.data.isovalue, under(s.indicator, 0),
                                 {.progress = [&](const TraversalCounts&) { return ++asked < 3; }},
                                 {ThreadExecutor(2)});
    EXPECT_TRUE(part.cancelled);
    const auto whole = isosurface(s.grid, s.field, s.data.isovalue, under(s.indicator, 0));
    EXPECT_GT(part.surface.simplices.size(), 0U);
    EXPECT_LT(part.surface.simplices.size(), whole.surface.simplices.size());

    EXPECT_THROW(isosurface(s.grid, s.field, s.data.isovalue, under(ThrowsBelow{11}, s.indicator),
                            {}, {ThreadExecutor(2)}),
                 GridError);
}

/// Counts what it is shown, by element.
template <class Grid>
struct Recorder final : engine::TaskVisitor<float> {
    using View = engine::ElementView<float>;
    int finest;
    std::vector<std::uint64_t> extracted;
    std::uint64_t calls = 0;

    explicit Recorder(int level) : finest{level} {}

    engine::Decision look(const View& view, const engine::Split&) override {
        return {view.level >= finest ? engine::Visit::stop : engine::Visit::descend, 0};
    }
    engine::Decision inspect(const View& view, const engine::Split& split) override {
        ++calls;
        return look(view, split);
    }
    void undo() override { --calls; }
    void restart() override { calls = 0; }
    void extract(const View& view) override {
        const auto& e = nestgrid::detail::element_of<ElementOf<Grid>>(view.element());
        extracted.push_back(std::uint64_t{e.low} << 8U | e.level);
    }
};

TEST(Frontiers, CutAWalkIntoPartsThatMissNothing) {
    const LatticeOctree<3> grid({.samples = {17, 17, 33}});
    const ZeroField<LatticeOctree<3>> zero;
    using R = Recorder<LatticeOctree<3>>;
    const auto hierarchy = erase(grid, zero);
    const engine::Walk<float> walk(hierarchy, {});
    for (const int finest : {0, 2, 9}) {
        R whole{finest};
        walk.run(whole);
        for (const std::size_t wanted : {1U, 3U, 50U, 100000U}) {
            R above{finest};
            const engine::Frontier<float> frontier(walk, above, wanted);
            for (const std::size_t parts : {1U, 2U, 7U}) {
                R in_parts{finest};
                in_parts.calls = above.calls;
                for (std::size_t i = 0; i < parts; ++i) {
                    frontier.run(walk, i * frontier.entry_count() / parts,
                                 (i + 1) * frontier.entry_count() / parts, in_parts);
                }
                EXPECT_EQ(in_parts.extracted, whole.extracted);
                EXPECT_EQ(in_parts.calls, whole.calls);
            }
        }
    }
}

}  // namespace threads_test
