// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where bisections are known at compile time, behind tables too, surfaces are those of the plain
// traversal.
#include <limits>

#include <gtest/gtest.h>

#include <indicators/packed_entries.hpp>
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <patches/check_bisections.hpp>

#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "table_in_c.hpp"
#include "walked_in_patches.hpp"

using namespace nestgrid;
using namespace nestgrid::engine;
using namespace nestgrid_test;

namespace isosurface_bisections_test {

template <int dim>
using Unknown = UnknownGrid<LatticeBisection<dim>>;
static_assert(KnowsBisections<LatticeBisection<3>, LatticeField<LatticeBisection<3>, float>>);
static_assert(!KnowsBisections<Unknown<3>, LatticeField<Unknown<3>, float>>);

/// The same grid, whose bisections are not known to come in patches.
template <int dim>
struct Unpatched : LatticeBisection<dim> {
    using LatticeBisection<dim>::LatticeBisection;
    static constexpr Nothing patch_height{};
};
static_assert(KnowsBisections<Unpatched<3>, LatticeField<Unpatched<3>, float>>);
static_assert(KnowsPatches<LatticeBisection<3>> && !KnowsPatches<Unpatched<3>>);
static_assert(HasMaubachPatches<LatticeBisection<2>> && HasMaubachPatches<LatticeBisection<3>>);

template <int dim, class Sample>
void expect_same_surfaces(const LatticeGeometry<dim>& geometry, const std::vector<Sample>& samples,
                          const std::vector<double>& isovalues, double range) {
    const LatticeBisection<dim> known(geometry);
    const Unknown<dim> unknown(geometry);
    const LatticeField known_field(known, std::span<const Sample>(samples));
    const LatticeField unknown_field(unknown, std::span<const Sample>(samples));
    const Unpatched<dim> unpatched(geometry);
    const LatticeField unpatched_field(unpatched, std::span<const Sample>(samples));
    const BehindTables tables(known, known_field);
    EXPECT_TRUE(erase(known, known_field).facts().knows_patches);
    EXPECT_FALSE(erase(unknown, unknown_field).facts().knows_patches);
    const HierarchicalIndicator indicator(known, known_field);
    const HierarchicalIndicator by_sweeps(*tables.hierarchy);
    for (NodeKey node = 0; node < known.node_count(); ++node) {
        ASSERT_EQ(by_sweeps.stop(node), indicator.stop(node));
        ASSERT_EQ(by_sweeps.bound(node), indicator.bound(node));
    }
    for (const double threshold : {0.0, 0.01, 0.1, 10.0}) {
        SCOPED_TRACE("threshold " + std::to_string(threshold));
        const auto draw = [&](const auto& grid, const auto& field, const auto& criterion) {
            return isosurfaces(grid, field, isovalues, under(criterion, indicator));
        };
        const Threshold by_offset{&indicator, threshold * range};
        const auto check = [&](const auto& criterion) {
            const auto a = draw(known, known_field, criterion);
            const auto b = draw(unknown, unknown_field, criterion);
            const auto c =
                isosurfaces<dim>(*tables.hierarchy, isovalues, under(criterion, indicator));
            const auto d = draw(unpatched, unpatched_field, criterion);
            for (std::size_t i = 0; i < a.size(); ++i) {
                expect_same(a[i], b[i]);
                expect_same(a[i], c[i]);
                expect_same(a[i], d[i]);
            }
        };
        check(by_offset);
        if constexpr (dim == 2) check(by_offset || DeepestLevel{7});
    }
}

std::vector<float> slice(const std::vector<float>& values, const Samples& n) {
    return {values.begin(), values.begin() + n[0] * n[1]};
}

TEST(KnownBisections, DrawWhatThePlainTraversalDraws) {
    for (const Samples& n : {Samples{17, 17, 17}, Samples{20, 9, 13}}) {
        const std::array<Point, 3> turned{{{0, -1, 0}, {1, 0, 0.25}, {0, 0, -1}}};
        for (const SampledField& data : sampled_fields(n)) {
            SCOPED_TRACE(data.name);
            const double c = data.isovalue;
            const std::vector<double> doubles(data.values.begin(), data.values.end());
            expect_same_surfaces<3>({.samples = n}, data.values, {c}, data.range);
            expect_same_surfaces<3>({.samples = n, .spacing = {0.5, 2, 0.3}, .direction = turned},
                                    doubles, {c, 0.9 * c, c}, data.range);
            expect_same_surfaces<2>({.samples = {n[0], n[1]}}, slice(data.values, n), {c, 1.1 * c},
                                    data.range);
        }
    }
}

enum class Mistake {
    none,
    orientation,
    corner,
    leaf,
    node,
    position,
    key,
    patch,
    nodes,
    keys,
    positions,
    whole
};

/// One whose bisections at compile time are not those of split() and children().
template <Mistake mistake>
struct Mistaken : LatticeBisection<3> {
    using LatticeBisection<3>::LatticeBisection;
    static constexpr auto bisections = [] {
        auto known = maubach_bisections<3>();
        if (mistake == Mistake::orientation) known[2].child[1].orientation = 1;
        if (mistake == Mistake::corner)
            std::swap(known[1].child[0].corner[0], known[1].child[0].corner[1]);
        return known;
    }();
    bool halved(Node a, Node b) const {
        return LatticeBisection<3>::halved(a, b) && (mistake != Mistake::leaf || a < b);
    }
    Node middle(Node a, Node b) const {
        return mistake == Mistake::node ? a : LatticeBisection<3>::middle(a, b);
    }
    using LatticeBisection<3>::middle;
    NodeKey middle_key(NodeKey a, NodeKey b) const {
        return mistake == Mistake::key ? a : LatticeBisection<3>::middle_key(a, b);
    }
    Pack<Node> middle(const Pack<Node>& a, const Pack<Node>& b) const {
        return mistake == Mistake::nodes ? a : LatticeBisection<3>::middle(a, b);
    }
    Pack<NodeKey> middle_key(const Pack<NodeKey>& a, const Pack<NodeKey>& b) const {
        return mistake == Mistake::keys ? a : LatticeBisection<3>::middle_key(a, b);
    }
    Point position(Node n) const {
        const Point x = LatticeBisection<3>::position(n);
        return mistake == Mistake::position ? Point{x[0], x[2], x[1]} : x;
    }
    template <std::size_t count, class Function>
    void with_packed_positions(Function&& function) const {
        LatticeBisection<3>::with_packed_positions<count>([&](const auto& positions) {
            function([&](const Pack<Node, count>& n) {
                auto x = positions(n);
                if (mistake == Mistake::positions) x[2] = x[1];
                return x;
            });
        });
    }
    using LatticeBisection<3>::whole;
    bool whole(const std::array<Node, 4>& n) const {
        return mistake == Mistake::whole || LatticeBisection<3>::whole(n);
    }
    const Rule* split(const Element& e) const {
        return mistake == Mistake::patch && e.tag == 2 ? nullptr : LatticeBisection<3>::split(e);
    }
};

template <Mistake mistake>
std::string complaint() {
    const Samples n{mistake == Mistake::whole ? 7 : 9, 9, 9};
    const std::vector<float> values = sampled_fields(n)[0].values;
    const Mistaken<mistake> grid({.samples = n});
    const LatticeField field(grid, std::span<const float>(values));
    NoContext none;
    return engine::BisectionCheck(grid, field, grid, field, none).run().value_or("");
}

TEST(KnownBisections, AreCheckedAgainstTheOperationsTheySpeakOf) {
    EXPECT_EQ(complaint<Mistake::none>(), "");
    EXPECT_NE(complaint<Mistake::orientation>().find("orientation"), std::string::npos);
    EXPECT_NE(complaint<Mistake::corner>().find("a child's node"), std::string::npos);
    EXPECT_NE(complaint<Mistake::leaf>().find("whether the element is split"), std::string::npos);
    EXPECT_NE(complaint<Mistake::node>().find("the new node"), std::string::npos);
    EXPECT_NE(complaint<Mistake::position>().find("the position"), std::string::npos);
    EXPECT_NE(complaint<Mistake::key>().find("the key between"), std::string::npos);
    EXPECT_NE(complaint<Mistake::patch>().find("of a patch"), std::string::npos);
    EXPECT_NE(complaint<Mistake::nodes>().find("pack of nodes"), std::string::npos);
    EXPECT_NE(complaint<Mistake::keys>().find("pack of keys"), std::string::npos);
    EXPECT_NE(complaint<Mistake::positions>().find("position of a pack"), std::string::npos);
    EXPECT_NE(complaint<Mistake::whole>().find("what is whole"), std::string::npos);
}

/// Patches of the finest level are leaves in half of the domain.
template <bool known>
struct HalfAsDeep : LatticeBisection<3> {
    using LatticeBisection<3>::LatticeBisection;
    static constexpr auto bisections = [] {
        if constexpr (known) return maubach_bisections<3>();
        if constexpr (!known) return Nothing{};
    }();
    /// The edge of a tetrahedron that begins a patch is the diagonal of a cube.
    bool halved(Node a, Node b) const {
        const auto steps = [&](std::size_t d) {
            return at(a, d) < at(b, d) ? at(b, d) - at(a, d) : at(a, d) - at(b, d);
        };
        const bool last = steps(0) == 2 && steps(1) == 2 && steps(2) == 2;
        return LatticeBisection<3>::halved(a, b) &&
               !(last && at(a, 0) + at(b, 0) < static_cast<std::uint32_t>(samples(0)));
    }
    const Rule* split(const Element& e) const {
        return halved(e.corner[0], e.corner[e.tag]) ? LatticeBisection<3>::split(e) : nullptr;
    }
};

template <class Known, class Unknown>
void expect_same_walks(const Samples& n, const SampledField& data) {
    const Known known({.samples = n});
    const Unknown unknown({.samples = n});
    const LatticeField known_field(known, std::span<const float>(data.values));
    const LatticeField unknown_field(unknown, std::span<const float>(data.values));
    static_assert(KnowsBisections<Known, decltype(known_field)> && KnowsPatches<Known>);
    static_assert(!KnowsBisections<Unknown, decltype(unknown_field)>);
    const HierarchicalIndicator indicator(known, known_field);
    for (const double threshold : {0.0, 0.003, 0.02, 0.1}) {
        SCOPED_TRACE("threshold " + std::to_string(threshold));
        const Threshold criterion{&indicator, threshold * data.range};
        const auto a = isosurface(known, known_field, data.isovalue, under(criterion, indicator));
        const auto b =
            isosurface(unknown, unknown_field, data.isovalue, under(criterion, indicator));
        EXPECT_GT(a.surface.simplices.size(), 0U);
        expect_same(a, b);
    }
}

TEST(KnownBisections, MayEndOnSeveralLevels) {
    const Samples n{17, 17, 17};
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        expect_same_walks<HalfAsDeep<true>, HalfAsDeep<false>>(n, data);
    }
}

/// More patches on a level, and more that stops, than are walked at once.
TEST(KnownBisections, FillWhatIsWalkedAtOnce) {
    const Samples n{33, 33, 33};
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        expect_same_walks<LatticeBisection<3>, Unknown<3>>(n, data);
    }
}

/// A field on a small grid, drawn without indices.
struct SmallField {
    Samples n{17, 17, 17};
    SampledField data = sampled_fields(n)[0];
    LatticeBisection<3> grid{{.samples = n}};
    LatticeField<LatticeBisection<3>, float> field{grid, std::span<const float>(data.values)};
    HierarchicalIndicator indicator{grid, field};
    std::array<double, 2> thresholds{0.0, 0.02 * data.range};

    template <class Sink>
    void extract(double threshold, Sink sink) const {
        const Threshold criterion{&indicator, threshold};
        std::vector<Sink> sinks;
        sinks.push_back(std::move(sink));
        extract_isosurfaces(grid, field, std::span<const double>(&data.isovalue, 1),
                            std::move(sinks), under(criterion, indicator));
    }
    auto surface(double threshold, bool verify = false) const {
        return isosurface(grid, field, data.isovalue, under(indicator, threshold),
                          {.verify = verify})
            .surface;
    }
};

/// A stream has no indices: its triangles are those of the surface, corner by corner.
TEST(KnownBisections, StreamTheSameTriangles) {
    const SmallField c;
    for (const double threshold : c.thresholds) {
        std::vector<std::array<Point, 3>> stream;
        const auto put = [&](const std::array<Point, 3>& x) { stream.push_back(x); };
        c.extract(threshold, SimplexStream<3>(put));
        const auto surface = c.surface(threshold, true);
        ASSERT_EQ(stream.size(), surface.simplices.size());
        EXPECT_GT(stream.size(), 100U);
        for (std::size_t i = 0; i < stream.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_EQ(stream[i][k], surface.vertices[surface.simplices[i][k]]);
            }
        }
    }
}

/// A soup takes many triangles at once.
TEST(KnownBisections, FillASoupWithTheSameTriangles) {
    const SmallField c;
    for (const double threshold : c.thresholds) {
        std::vector<std::array<float, 9>> soup;
        c.extract(threshold, SimplexSoup<3, float>(soup));
        const auto surface = c.surface(threshold);
        ASSERT_EQ(soup.size(), surface.simplices.size());
        for (std::size_t i = 0; i < soup.size(); ++i) {
            for (std::size_t k = 0; k < 9; ++k) {
                const Point& x = surface.vertices[surface.simplices[i][k / 3]];
                ASSERT_EQ(soup[i][k], static_cast<float>(x[k % 3]));
            }
        }
    }
}

/// Bounds that are too small, near the leaves or here and there, which hides some of what is there.
class TooSmall final : public Bounds {
public:
    /// \param one_in in how many nodes there is one whose bound is 0; or 0: nowhere else
    TooSmall(const HierarchicalIndicator& of, double least, unsigned one_in)
        : of_{&of}, least_{least}, one_in_{one_in} {}

    double offset_bound(NodeKey node) const override { return of_->stop(node); }
    double bound(const Rule& rule, std::span<const NodeKey> nodes) const override {
        const double bound = of_->bound(rule, nodes);
        const bool hides = one_in_ != 0 && (nodes[0] * 0x9e3779b97f4a7c15ULL >> 40U) % one_in_ == 0;
        return bound < least_ || hides ? 0 : bound;
    }
    const HangingNodes* hanging() const override { return of_->hanging(); }
    bool made_for(std::uint64_t epoch) const override { return of_->made_for(epoch); }
    bool stops_conform() const override { return true; }

private:
    const HierarchicalIndicator* of_;
    double least_;
    unsigned one_in_;
};

TEST(KnownBisections, DrawNoMoreThanIsEntered) {
    const Samples n{17, 17, 17};
    std::array<std::size_t, 2> hidden{};
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeBisection<3> known({.samples = n});
        const Unknown<3> unknown({.samples = n});
        const LatticeField known_field(known, std::span<const float>(data.values));
        const LatticeField unknown_field(unknown, std::span<const float>(data.values));
        const HierarchicalIndicator indicator(known, known_field);
        const std::array all{TooSmall{indicator, data.range, 0}, TooSmall{indicator, 0, 8}};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const TooSmall& bounds = all[i];
            for (const double threshold : {0.0, 0.003, 0.02}) {
                const Threshold criterion{&indicator, threshold * data.range};
                const auto draw = [&](const auto& grid, const auto& field, const auto& by) {
                    return isosurface(grid, field, data.isovalue, under(criterion, by));
                };
                const auto a = draw(known, known_field, bounds);
                EXPECT_GT(a.surface.simplices.size(), 0U);
                expect_same(a, draw(unknown, unknown_field, bounds));
                hidden[i] += draw(known, known_field, indicator).surface.simplices.size();
                hidden[i] -= a.surface.simplices.size();
            }
        }
    }
    for (const std::size_t count : hidden) EXPECT_GT(count, 0U);
}

/// Two nodes in a row have one key.
struct SharedKeys : LatticeBisection<3> {
    using LatticeBisection<3>::LatticeBisection;
    NodeKey key(Node n) const { return LatticeBisection<3>::key(n) & ~NodeKey{1}; }
    NodeKey middle_key(NodeKey a, NodeKey b) const {
        return LatticeBisection<3>::middle_key(a, b) & ~NodeKey{1};
    }
};

TEST(KnownBisections, AreVerifiedVertexByVertex) {
    const SmallField small;
    const SharedKeys grid({.samples = small.n});
    const LatticeField field(grid, std::span<const float>(small.data.values));
    const auto draw = [&](bool verify) {
        return isosurface(grid, field, small.data.isovalue, under(small.indicator, 0),
                          {.verify = verify});
    };
    EXPECT_GT(draw(false).surface.vertices.size(), 0U);
    try {
        draw(true);
        ADD_FAILURE() << "nothing was found";
    } catch (const GridError& error) {
        EXPECT_NE(std::string(error.what()).find("at different places"), std::string::npos);
    }
}

/// Isovalues between two numbers of the values' type, and at one.
TEST(KnownBisections, TellInsideFromOutsideInTheirOwnType) {
    const Samples n{9, 9, 9};
    std::vector<float> values = sampled_fields(n)[0].values;
    const float exact = values[200];
    for (const double c :
         {double{exact}, std::nextafter(double{exact}, 2.0), std::nextafter(double{exact}, -2.0)}) {
        expect_same_surfaces<3>({.samples = n}, values, {c}, 1);
    }
}

/// Thresholds at a number of the indicator's type, and beside it.
TEST(KnownBisections, AskForEightNodesWhatTheyAskForOne) {
    const Samples n{9, 9, 9};
    const std::vector<float> values = sampled_fields(n)[0].values;
    const LatticeBisection<3> grid({.samples = n});
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const HierarchicalIndicator another(grid, field);
    const double exact = indicator.stop(100);
    EXPECT_GT(exact, 0);
    const double least = std::numeric_limits<double>::denorm_min();
    for (const double epsilon : {exact, std::nextafter(exact, 0), std::nextafter(exact, 1), 0.0,
                                 least, -least, 1e300, std::nan("")}) {
        const Threshold criterion{&indicator, epsilon};
        const auto packed = Pack<float>::all(detail::float_below(epsilon));
        for (NodeKey first = 0; first + pack <= grid.node_count(); ++first) {
            std::array<NodeKey, pack> nodes;
            for (std::size_t i = 0; i < pack; ++i) nodes[i] = first + i;
            for (const HierarchicalIndicator* by : {&indicator, &another}) {
                const auto known = engine::look_up(by->entries(), nodes.data());
                const auto holds = at_most(known.stop(), packed).numbers();
                for (std::size_t i = 0; i < pack; ++i) {
                    const std::span<const NodeKey> one(&nodes[i], 1);
                    const NodeMask mask = criterion.holds({grid.rule(0), one, 1, 0});
                    ASSERT_EQ(holds[i], mask != 0 ? ~0U : 0U) << epsilon;
                    ASSERT_EQ(known.bound().numbers()[i], by->bound(nodes[i]));
                }
            }
        }
        // An indicator that is not the one of the bounds is asked for one node at a time.
        expect_same(isosurface(grid, field, 0.37, under(criterion, indicator)),
                    isosurface(grid, field, 0.37, under(criterion, another)));
    }
}

TEST(KnownBisections, ReportProgressAndStop) {
    const Samples n{65, 65, 65};
    const SampledField data = sampled_fields(n)[1];
    const LatticeBisection<3> grid({.samples = n});
    const LatticeField field(grid, std::span<const float>(data.values));
    std::uint64_t last = 0;
    const auto grows = [&](const TraversalCounts& counts) {
        EXPECT_GT(counts.calls, last);
        EXPECT_GT(counts.calls, counts.visited);
        last = counts.calls;
        return true;
    };
    const auto whole = isosurface(grid, field, data.isovalue, {}, {.progress = grows});
    EXPECT_GT(last, 0U);
    EXPECT_GT(whole.counts.calls, last);
    const auto part =
        isosurface(grid, field, data.isovalue, {}, {.progress = [](const auto&) { return false; }});
    EXPECT_TRUE(part.cancelled);
    EXPECT_LT(part.surface.simplices.size(), whole.surface.simplices.size());
}

}  // namespace isosurface_bisections_test
