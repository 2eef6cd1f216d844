// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An updated preroll has the bits of a new one, on every family.
#include <bit>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_field.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <walk/for_each_element.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace update_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A ball, by which values change.
struct Ball {
    Point centre;
    double radius;

    bool contains(const Point& x) const { return norm(x - centre) <= radius; }
    ChangedBox box() const {
        const Point r{radius, radius, radius};
        return {centre - r, centre + r};
    }
};

Ball random_ball(std::mt19937& random) {
    const Point centre{uniform(random), uniform(random), uniform(random)};
    return {centre, 0.15 * uniform(random)};
}

void expect_same_entries(const HierarchicalIndicator& a, const HierarchicalIndicator& b,
                         std::size_t nodes) {
    std::size_t different = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
        const auto node = static_cast<NodeKey>(i);
        different += a.stop(node) != b.stop(node) || a.bound(node) != b.bound(node) ? 1 : 0;
    }
    EXPECT_EQ(different, 0U) << "of " << nodes;
}

/// Changes the values in random balls, one after the other, and compares.
/// \param make make(values) is the field
template <class Grid, class Make>
void change_in_balls(const Grid& grid, std::vector<double> values,
                     const std::vector<Point>& positions, const Spread& spread, const Make& make,
                     std::mt19937& random) {
    HierarchicalIndicator updated(grid, make(values), spread);
    for (int i = 0; i < 4; ++i) {
        const Ball ball = random_ball(random);
        const double factor = i % 2 == 0 ? 0.0 : 2 * uniform(random);
        for (std::size_t node = 0; node < values.size(); ++node) {
            if (ball.contains(positions[node])) values[node] *= factor;
        }
        updated.update(grid, make(values), ball.box());
        const HierarchicalIndicator fresh(grid, make(values), spread);
        expect_same_entries(updated, fresh, values.size());
        EXPECT_LE(updated.least(), fresh.least());
        EXPECT_GE(updated.greatest(), fresh.greatest());
    }
}

template <class Family>
class UpdateOfFamily : public testing::Test {};
TYPED_TEST_SUITE(UpdateOfFamily, Families);

TYPED_TEST(UpdateOfFamily, HasTheBitsOfANewPreroll) {
    std::mt19937 random(21);
    for_each_field_at_sphere<TypeParam>(4, 22, [&](const auto& grid, const NodalSamples& samples) {
        const auto make = [&](const std::vector<double>& values) {
            return NodeField<typename TypeParam::Grid, double>(grid, values);
        };
        for (const Spread spread : {Spread{}, Spread{.factor = 1.5, .slope = 0.5}}) {
            change_in_balls(grid, samples.values, grid.node_positions(), spread, make, random);
        }
    });
}

TYPED_TEST(UpdateOfFamily, HasTheBitsOfANewPrerollOfErrors) {
    std::mt19937 random(23);
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 3 * TypeParam::steps);
    const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
    const NodeField<typename TypeParam::Grid, double> field(grid, values);
    const auto positions = grid.node_positions();
    Ball ball{{2, 2, 2}, 0};
    const LeafErrors errors = [&](const Handle& leaf) {
        const auto& element = detail::element_of<typename TypeParam::Grid::Element>(leaf);
        std::array<NodeKey, max_corners> corner{};
        grid.corner_keys(element, std::span(corner).first(3));
        return ball.contains(positions[static_cast<std::size_t>(corner[0])])
                   ? 0.0
                   : 1 + static_cast<double>(corner[1] % NodeKey{7});
    };
    const auto hierarchy = erase(grid, field);
    HierarchicalIndicator updated(hierarchy, errors);
    ball = {{0.3, 0.4, 0.5}, 0.1};
    updated.update(hierarchy, ball.box(), errors);
    expect_same_entries(updated, HierarchicalIndicator(hierarchy, errors), values.size());
    expect_refused([&] { updated.update(hierarchy, ball.box()); }, "errors of leaves");
}

/// A grid that lets the library derive the keys of its nodes, which refinement then keeps.
template <class Inner>
struct WithoutKeys {
    using Element = typename Inner::Element;
    using Context = typename Inner::Context;
    static constexpr int dimension = Inner::dimension;
    const Inner* inner;

    std::size_t coarse_count() const { return inner->coarse_count(); }
    auto coarse(std::size_t i) const { return inner->coarse(i); }
    Context make_context() const { return inner->make_context(); }
    const Rule* split(const Element& e, Context& context) const {
        return detail::call_split(*inner, context, e);
    }
    void children(const Element& e, std::span<Element> out, Context& context) const {
        detail::call_children(*inner, context, e, out);
    }
    std::uint64_t epoch() const { return inner->epoch(); }
};

using LeafCorners = std::set<std::vector<Point>>;

template <class Grid>
LeafCorners leaves_of(Grid& grid) {
    LeafCorners leaves;
    grid.adapt([&](const Leaf& leaf) {
        leaves.insert(std::vector<Point>(leaf.corners.begin(), leaf.corners.end()));
        return Mark::keep;
    });
    return leaves;
}

/// Whether places lie near a leaf that is in one of two sets only.
ChangedPlaces differing(const LeafCorners& a, const LeafCorners& b) {
    std::vector<ChangedBox> boxes;
    const auto add = [&](const LeafCorners& these, const LeafCorners& others) {
        for (const auto& leaf : these) {
            if (others.contains(leaf)) continue;
            ChangedBox box{leaf[0], leaf[0]};
            for (const Point& x : leaf) {
                for (std::size_t d = 0; d < 3; ++d) {
                    box.low[d] = std::min(box.low[d], x[d]);
                    box.high[d] = std::max(box.high[d], x[d]);
                }
            }
            boxes.push_back(box);
        }
    };
    add(a, b);
    add(b, a);
    return [boxes](std::span<const Point> points) {
        return std::ranges::any_of(boxes, [&](const ChangedBox& box) { return box(points); });
    };
}

TYPED_TEST(UpdateOfFamily, FollowsRefinement) {
    for (auto& grid : TypeParam::grids()) {
        constexpr int levels = TypeParam::Grid::dimension == 3 ? 2 : 3;
        refine_at_sphere(grid, levels * TypeParam::steps);
        const WithoutKeys<typename TypeParam::Grid> seen{&grid};
        std::vector<double> values;
        const auto field = [&] {
            values = sample_nodes(
                grid, [](const Point& x) { return std::sin(7 * x[0] + 5 * x[1]) * x[1] + x[2]; });
            return NodeField<typename TypeParam::Grid, double>(grid, values);
        };
        HierarchicalIndicator updated(seen, field());
        const Point middle{0.4, 0.6, 0.3};
        for (int i = 0; i < 2 + 4 * TypeParam::steps; ++i) {  // down to coarse leaves
            const Mark mark = i == 0 ? Mark::refine : Mark::coarsen;
            const LeafCorners before = leaves_of(grid);
            grid.adapt([&](const Leaf& leaf) {
                return norm(leaf.centre() - middle) < 0.5 ? mark : Mark::keep;
            });
            const ChangedPlaces changed = differing(before, leaves_of(grid));
            const auto now = field();
            updated.update(seen, now, changed);
            const HierarchicalIndicator fresh(seen, now);
            const auto hierarchy = erase(seen, now);
            const engine::Walk<double> walk(hierarchy, {.values = false}, fresh.hanging());
            engine::for_each_element(walk, false, [&](const auto& view, const auto& split) {
                engine::SplitKeys room;
                for (const NodeKey node : walk.split_keys(view, split, room)) {
                    EXPECT_EQ(updated.stop(node), fresh.stop(node));
                    EXPECT_EQ(updated.bound(node), fresh.bound(node));
                }
            });
        }
    }
}

template <class Grid>
void change_samples(std::mt19937& random) {
    const Samples n{33, 25, 17};
    const Grid grid({.samples = {33, 25, 17}});
    std::vector<Point> positions;
    for (std::size_t i = 0; i < grid.node_count(); ++i) {
        positions.push_back(grid.node_position(static_cast<NodeKey>(i)));
    }
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        std::vector<float> values = data.values;
        const auto make = [&] {
            return LatticeField<Grid, float>(grid, std::span<const float>(values));
        };
        HierarchicalIndicator updated(grid, make());
        for (int i = 0; i < 3; ++i) {
            const Point low{32 * uniform(random), 24 * uniform(random), 16 * uniform(random)};
            ChangedBox box{low, low + Point{4, 4, 4}};
            for (std::size_t d = 0; d < 3; ++d) {  // values beyond the border repeat those on it
                if (box.high[d] >= n[d] - 1) box.high[d] = infinity;
            }
            std::size_t at = 0;
            for (int z = 0; z < n[2]; ++z) {
                for (int y = 0; y < n[1]; ++y) {
                    for (int x = 0; x < n[0]; ++x, ++at) {
                        const std::array<Point, 1> sample{{{double(x), double(y), double(z)}}};
                        if (box(sample)) values[at] = -values[at] / 3;
                    }
                }
            }
            updated.update(grid, make(), box);
            expect_same_entries(updated, HierarchicalIndicator(grid, make()), grid.node_count());
        }
    }
}

TEST(Update, OfSamplesHasTheBitsOfANewPreroll) {
    std::mt19937 random(24);
    change_samples<LatticeBisection<3>>(random);
    change_samples<LatticeOctree<3>>(random);
}

/// A field that counts the values it is asked for.
template <class Field>
struct CountedField : Field {
    std::size_t* count;

    NodeMask new_values(const auto& e, NodeMask which, auto out) const {
        *count += static_cast<std::size_t>(std::popcount(which));
        return Field::new_values(e, which, out);
    }
};

/// Eight times as many samples add one level, and with it a few dirty nodes.
TEST(Update, DoesNotGrowWithTheGrid) {
    std::vector<std::size_t> asked;
    for (const int n : {17, 33, 65}) {
        const LatticeOctree<3> grid({.samples = {n, n, n}});
        std::vector<float> values = sample({n, n, n}, distance_to_centre);
        std::size_t count = 0;
        using Plain = LatticeField<LatticeOctree<3>, float>;
        const CountedField<Plain> field{Plain(grid, std::span<const float>(values)), &count};
        HierarchicalIndicator updated(grid, field);
        values[values.size() / 2] = 3;
        count = 0;
        const double middle = 0.5 * (n - 1);
        const Point x{middle, middle, middle};
        updated.update(grid, field, ChangedBox{x, x});
        asked.push_back(count);
    }
    const std::size_t a_level = asked[1] - asked[0];
    EXPECT_LE(asked[2], asked[1] + a_level + a_level / 2);
}

}  // namespace update_test
