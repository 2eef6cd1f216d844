// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The implicit hierarchy: the paper's numbers, the domain, no heap.
#include <set>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>
#include <walk/for_each_element.hpp>

#include "counting_allocator.hpp"
#include "element_in.hpp"
#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

class Census final : public engine::Visitor<float> {
public:
    std::size_t leaves = 0;
    std::size_t inner = 0;
    std::size_t greatest_depth = 0;
    std::uintptr_t base = 0;
    std::size_t stack = 0;

    engine::Decision inspect(const engine::ElementView<float>& view,
                             const engine::Split& split) override {
        if (split.rule != nullptr) ++inner;
        greatest_depth = std::max(greatest_depth, static_cast<std::size_t>(view.level));
        const char here = 0;
        const auto at = reinterpret_cast<std::uintptr_t>(&here);
        if (base == 0) base = at;
        stack = std::max<std::size_t>(stack, at > base ? at - base : base - at);
        return {};
    }
    void extract(const engine::ElementView<float>&) override { ++leaves; }
};

/// Walks a cubic lattice completely; fails where that touches the heap, but for some frames for
/// each level that the first walk makes.
Census take_census(int n) {
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<std::uint8_t> samples(grid.sample_count());
    const LatticeField field(grid, std::span<const std::uint8_t>(samples));
    EXPECT_EQ(grid.node_count(), samples.size());
    const auto hierarchy = erase(grid, field);
    const engine::Walk<float> walk(hierarchy, {.positions = true});
    Census first;
    std::size_t before = allocation_count();
    walk.run(first, 0, 1);
    EXPECT_LE(allocation_count() - before, 8 * (first.greatest_depth + 2));
    Census census;
    before = allocation_count();
    walk.run(census);
    EXPECT_EQ(allocation_count(), before);
    return census;
}

TEST(Lattice, HasThePapersGridAndWalksItWithoutHeap) {
    const Census paper = take_census(129);  // 2,146,689 nodes
    EXPECT_EQ(paper.leaves, 12582912U);
    EXPECT_EQ(paper.leaves + paper.inner, 25165818U);
    EXPECT_EQ(paper.greatest_depth, 21U);
    // The stack grows with the depth alone: from 15 to 21 levels.
    const Census small = take_census(33);
    EXPECT_EQ(small.greatest_depth, 15U);
    EXPECT_GT(small.stack, 0U);
    EXPECT_LE(double(paper.stack), 1.1 * 21 / 15 * double(small.stack));
}

TEST(Lattice, NodesAreCountedByTheirElements) {
    const LatticeBisection<3> grid({.samples = {17, 17, 17}});
    const std::vector<std::uint8_t> samples(grid.sample_count());
    const LatticeField field(grid, std::span<const std::uint8_t>(samples));
    const auto hierarchy = erase(grid, field);
    const engine::Walk<float> walk(hierarchy, {});
    std::set<NodeKey> nodes;
    for (int level = 0; level < engine::count_levels(walk); ++level) {
        engine::for_each_on_level(walk, level, [&](const auto& view, const engine::Split&) {
            std::array<NodeKey, 8> keys;
            walk.corners(view, keys.data(), nullptr);
            nodes.insert(keys.begin(), keys.begin() + 4);
        });
    }
    EXPECT_EQ(nodes.size(), 4913U);
}

class Volume final : public engine::Visitor<float> {
public:
    explicit Volume(const LatticeBisection<3>& grid) : grid_{&grid} {}

    double sum = 0;

    engine::Decision inspect(const engine::ElementView<float>&, const engine::Split&) override {
        return {};
    }
    void extract(const engine::ElementView<float>& view) override {
        std::array<Point, 4> x;
        grid_->corner_positions(element_in(*grid_, view), x);
        const double v = view.orientation * measure(Shape::tetrahedron, x);
        EXPECT_GT(v, 0);
        sum += v;
    }

private:
    const LatticeBisection<3>* grid_;
};

TEST(Lattice, LeavesFillTheDomainForAnyDimensions) {
    for (const Samples n : {Samples{2, 2, 2}, Samples{17, 17, 17}, Samples{5, 14, 23},
                            Samples{2, 30, 3}, Samples{18, 33, 20}}) {
        const LatticeBisection<3> grid({.samples = n,
                                        .spacing = {0.5, 2, -1},
                                        .direction = {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}}});
        const std::vector<float> samples(grid.sample_count(), 1.0F);
        const LatticeField field(grid, std::span<const float>(samples));
        const auto hierarchy = erase(grid, field);
        const engine::Walk<float> walk(hierarchy, {.keys = false});
        Volume volume(grid);
        walk.run(volume);
        const double whole = double(n[0] - 1) * (n[1] - 1) * (n[2] - 1);
        EXPECT_NEAR(volume.sum / whole, 1, 1e-12);
    }
}

TEST(Lattice, SkinOfPaddingIsThin) {
    // A plane in the middle of the domain never meets the padding: it costs nothing there.
    const Samples n{65 + 20, 65 + 20, 65};
    const LatticeBisection<3> padded({.samples = n, .block_levels = 5});
    const std::vector<float> values =
        sample(n, [](double, double, double z) { return z * z + 0.3 * z; });
    const LatticeField field(padded, std::span<const float>(values));
    const auto result = isosurface(padded, field, 0.4, {.threshold = 0.05});
    // Two thirds of the plane away from the two padded sides is coarse.
    EXPECT_LT(result.surface.simplices.size(), 6U * 85U * 20U);
}

TEST(Lattice, RefusesWhatIsNoLattice) {
    const auto make = [](LatticeGeometry<3> g) { return LatticeBisection<3>(g); };
    EXPECT_THROW(make({.samples = {1, 5, 5}}), InvalidInput);
    EXPECT_THROW(make({.samples = {5, 5, 2000000}}), InvalidInput);
    EXPECT_THROW(make({.samples = {5, 5, 5}, .spacing = {1, 0, 1}}), InvalidInput);
    EXPECT_THROW(make({.samples = {5, 5, 5}, .spacing = {1, std::nan(""), 1}}), InvalidInput);
    EXPECT_THROW(make({.samples = {5, 5, 5}, .direction = {{{1, 1, 0}, {1, 1, 0}, {0, 0, 1}}}}),
                 InvalidInput);
    EXPECT_THROW(make({.samples = {5, 5, 5}, .block_levels = 25}), InvalidInput);
    const LatticeBisection<3> grid({.samples = {5, 5, 5}});
    const std::vector<float> few(124);
    EXPECT_THROW(LatticeField(grid, std::span<const float>(few)), InvalidInput);
}

/// The 2-D sibling: closed isolines whose length converges to that of the circle.
double circle_length(int n) {
    const double h = 1.0 / (n - 1);
    const LatticeBisection<2> grid({.samples = {n, n}, .spacing = {h, h, 1}});
    std::vector<double> values;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) values.push_back(-std::hypot(x * h - 0.5, y * h - 0.5));
    }
    const LatticeField field(grid, std::span<const double>(values));
    const auto line = isosurface(grid, field, -0.4, {}, {.verify = true});
    std::vector<int> starts(line.surface.vertices.size());
    std::vector<int> ends(line.surface.vertices.size());
    double length = 0;
    double area = 0;
    for (const auto& s : line.surface.simplices) {
        ++starts[s[0]];
        ++ends[s[1]];
        const Point& a = line.surface.vertices[s[0]];
        const Point& b = line.surface.vertices[s[1]];
        length += norm(b - a);
        area += cross(a, b)[2] / 2;
    }
    EXPECT_EQ(starts, std::vector<int>(starts.size(), 1));
    EXPECT_EQ(ends, starts);
    EXPECT_GT(area, 0);  // the region above the isovalue is on the left
    return length;
}

TEST(Image, IsolinesConvergeWithOrderTwo) {
    const double exact = 2 * 3.14159265358979323846 * 0.4;
    // The error varies with the place of the circle on the lattice: order over four refinements.
    const double coarse = exact - circle_length(33);
    const double fine = exact - circle_length(513);
    EXPECT_NEAR(std::log2(coarse / fine) / 4, 2, 0.1);
}

TEST(Image, CappedIsolinesCloseAroundTheRegion) {
    for (const int n : {17, 22, 41}) {
        const LatticeBisection<2> grid({.samples = {n, n + 3}});
        std::mt19937 random(3);
        std::vector<float> values(grid.sample_count());
        for (float& v : values) v = static_cast<float>(random() % 5);
        const LatticeField field(grid, std::span<const float>(values));
        for (const double threshold : {0.0, 1.0, 3.0}) {
            const auto line = isosurface(grid, field, 2, {.threshold = threshold}, {.cap = true});
            std::vector<int> balance(line.surface.vertices.size());
            for (const auto& s : line.surface.simplices) {
                ++balance[s[0]];
                --balance[s[1]];
            }
            EXPECT_EQ(balance, std::vector<int>(balance.size(), 0));
        }
    }
}

}  // namespace
