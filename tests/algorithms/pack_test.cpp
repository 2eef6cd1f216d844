// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is done to many numbers at once is what is done to each of them, to the last bit; what comes
// next in a patch is what a recursion meets; and numbers tell the edges of a subtree apart.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <nestgrid/detail/pack.hpp>
#include <patches/bisection_patch.hpp>
#include <patches/subtree_nodes.hpp>
#include <surfaces/wide_point.hpp>

using namespace nestgrid;
using namespace nestgrid::engine;

namespace pack_test {

template <class T>
auto bits_of(T x) {
    return std::bit_cast<MaskOf<T>>(x);
}

template <class T>
std::array<T, pack> random_numbers(std::mt19937_64& random) {
    std::array<T, pack> result;
    for (T& x : result) {
        if constexpr (std::is_floating_point_v<T>) {
            const std::array<T, 6> special{0,  -T{0},
                                           1,  std::numeric_limits<T>::infinity(),
                                           -1, std::numeric_limits<T>::denorm_min()};
            x = random() % 4 == 0 ? special[random() % special.size()]
                                  : std::uniform_real_distribution<T>(-2, 2)(random);
        } else {
            x = static_cast<T>(random());
        }
    }
    return result;
}

template <class T>
class Packs : public testing::Test {};
using Numbers = testing::Types<float, double, std::uint32_t, std::uint64_t>;
TYPED_TEST_SUITE(Packs, Numbers);

template <class T, std::size_t size>
void expect_packs_do_what_is_done_to_one() {
    using P = Pack<T, size>;
    std::mt19937_64 random(1);
    for (int round = 0; round < 1000; ++round) {
        const std::array<T, pack> a = random_numbers<T>(random);
        std::array<T, pack> b = random_numbers<T>(random);
        if (round % 3 == 0) b[1] = a[1];
        const P pa = P::load(a.data());
        const P pb = P::load(b.data());
        const auto expect = [&](const auto& result, auto&& of_one) {
            const auto numbers = result.numbers();
            for (std::size_t i = 0; i < size; ++i) {
                EXPECT_EQ(bits_of(numbers[i]), bits_of(of_one(a[i], b[i]))) << i;
            }
        };
        const auto all = ~MaskOf<T>{0};
        expect(min(pa, pb), [](T x, T y) { return std::min(x, y); });
        expect(max(pa, pb), [](T x, T y) { return std::max(x, y); });
        expect(pa + pb, [](T x, T y) { return static_cast<T>(x + y); });
        expect(pa - pb, [](T x, T y) { return static_cast<T>(x - y); });
        expect(at_most(pa, pb), [&](T x, T y) { return x <= y ? all : MaskOf<T>{0}; });
        P copy = pb;
        copy = pa;
        expect(copy, [](T x, T) { return x; });
        expect(P::all(a[0]), [&](T, T) { return a[0]; });
        // One of them known to the compiler.
        expect(min(pa, P::all(1)), [](T x, T) { return std::min(x, T{1}); });
        expect(max(pa, P::all(1)), [](T x, T) { return std::max(x, T{1}); });
        expect(P::make([&](auto i) { return b[i]; }), [](T, T y) { return y; });
        expect(pa.template as<MaskOf<T>>(), [](T x, T) { return bits_of(x); });
        if constexpr (std::is_integral_v<T>) {
            expect(pa & pb, [](T x, T y) { return x & y; });
            expect(pa | pb, [](T x, T y) { return x | y; });
            expect(without(pa, pb), [](T x, T y) { return x & ~y; });
            expect(pa << 5, [](T x, T) { return x << 5U; });
            expect(pa >> 5, [](T x, T) { return x >> 5U; });
        } else {
            expect(pa * pb, [](T x, T y) { return x * y; });
            expect(pa / P::all(3), [](T x, T) { return x / 3; });
        }
        if constexpr (std::is_same_v<T, std::uint64_t>) {
            expect(to_double(pa >> 12), [](T x, T) { return static_cast<double>(x >> 12U); });
        }
    }
}

TYPED_TEST(Packs, DoWhatIsDoneToOne) {
    expect_packs_do_what_is_done_to_one<TypeParam, pack>();
    expect_packs_do_what_is_done_to_one<TypeParam, 4>();
    expect_packs_do_what_is_done_to_one<TypeParam, 2>();
}

TEST(WidePoints, AreEqualToPoints) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-3, 3);
    const auto point = [&] { return Point{uniform(random), uniform(random), uniform(random)}; };
    for (int round = 0; round < 1000; ++round) {
        const Point a = point();
        const Point b = point();
        const double s = uniform(random);
        const WidePoint wa(a);
        const WidePoint wb(b);
        EXPECT_EQ(Point(wa), a);
        EXPECT_EQ(Point(wa + wb), a + b);
        EXPECT_EQ(Point(wa - wb), a - b);
        EXPECT_EQ(Point(s * wa), s * a);
        EXPECT_EQ(dot(wa, wb), dot(a, b));
    }
}

/// What a recursion meets in a patch, into `order`, and which of the bits it looked at.
template <const auto& pattern>
void descend(std::size_t part, unsigned entered, unsigned stops, std::vector<std::size_t>& order,
             unsigned& seen) {
    if (part >= pattern.ends) return order.push_back(part);
    const unsigned bit = 1U << (part - 2);
    seen |= bit;
    if ((entered & bit) != 0) {
        descend<pattern>(2 * part, entered, stops, order, seen);
        descend<pattern>(2 * part + 1, entered, stops, order, seen);
    } else if ((stops & bit) != 0) {
        order.push_back(part);
    }
}

template <const auto& pattern>
void expect_order() {
    constexpr unsigned parts = pattern.ends - 2;
    std::size_t met = 0;
    for (unsigned entered = 0; entered >> parts == 0; ++entered) {
        for (unsigned stops = 0; stops >> parts == 0; ++stops) {
            std::vector<std::size_t> order;
            unsigned seen = 0;
            descend<pattern>(2, entered, stops, order, seen);
            descend<pattern>(3, entered, stops, order, seen);
            if ((entered & stops) != 0 || ((entered | stops) & ~seen) != 0) continue;
            ++met;
            const auto& known = patch_orders<pattern>[entered | stops << parts];
            EXPECT_EQ(
                std::vector<std::size_t>(known.part.begin(), known.part.begin() + known.count),
                order);
        }
    }
    EXPECT_EQ(met, parts == 2 ? 9U : 121U);  // 3^2; (2 + 3^2)^2
}

/// Where the ends are split, and which parts a new node is of.
template <int dim>
void expect_new_nodes() {
    static constexpr const auto& pattern = maubach_patch<dim>;
    constexpr auto bisections = maubach_bisections<dim>();
    const auto sorted = [](std::size_t a, std::size_t b) {
        return std::array{std::min(a, b), std::max(a, b)};
    };
    std::map<std::array<std::size_t, 2>, std::size_t> node_of;
    std::array<std::size_t, 2 * pattern.ends> seen{};
    unrolled<pattern.all_nodes - pattern.corners>([&](auto n) {
        constexpr std::size_t node = pattern.corners + n;
        node_of[sorted(pattern.parent[node][0], pattern.parent[node][1])] = node;
        for (const std::size_t part : parts_around<pattern, node>) {
            ++seen[part];
            EXPECT_EQ(part >= pattern.ends, node >= pattern.nodes);
        }
    });
    for (std::size_t part = 1; part < seen.size(); ++part) {
        EXPECT_EQ(seen[part], 1U);
        const auto& corner = pattern.part[part].corner;
        const auto& between = bisections[pattern.part[part].bisection].parent;
        EXPECT_EQ((node_of[sorted(corner[between[0]], corner[between[1]])]),
                  pattern.part[part].middle);
    }
    EXPECT_EQ(node_of.size(), pattern.all_nodes - pattern.corners);
    // Ends lie around the middle of one of the smaller cubes that a simplex of Kuhn's meets.
    EXPECT_EQ(pattern.all_nodes - pattern.nodes, static_cast<std::size_t>(dim) + 1);
    for (std::size_t set = 0; set < end_orders<pattern>.size(); ++set) {
        const auto& order = end_orders<pattern>[set];
        std::size_t met = 0;
        for (std::size_t i = 0; i < order.count; ++i) {
            EXPECT_TRUE(i == 0 || order.part[i] > order.part[i - 1]);
            met |= std::size_t{1} << (order.part[i] - pattern.ends);
        }
        EXPECT_EQ(met, set);
    }
}

TEST(Patches, KnowTheirNewNodes) {
    expect_new_nodes<2>();
    expect_new_nodes<3>();
}

TEST(Patches, KnowWhatComesNext) {
    expect_order<maubach_patch<2>>();
    expect_order<maubach_patch<3>>();
}

/// A subtree of patches, refined to the same level everywhere.
template <const auto& pattern>
struct Subtree {
    using InSubtree = SubtreeNodes<pattern>;
    static constexpr std::size_t corners = pattern.corners;
    using Barycentric = std::array<int, corners>;  // of a whole
    static constexpr int whole = 1 << 12;
    struct Node {
        Barycentric x{};
        SubtreeNode word = 0;
    };
    using Element = std::array<Node, corners>;
    using Edge = std::set<Barycentric>;

    /// By level, what its elements' edges are told to be.
    std::vector<std::vector<std::pair<std::array<Node, 2>, Edge>>> edges;

    explicit Subtree(std::size_t number) {
        Element root;
        for (std::size_t i = 0; i < corners; ++i) {
            root[i].x[i] = whole;
            root[i].word = InSubtree::corner(InSubtree::root_corner(i), number, i);
        }
        walk(root, 0);
    }

private:
    void walk(const Element& of, std::size_t patches) {
        std::array<Node, pattern.most_nodes> node;
        std::copy(of.begin(), of.end(), node.begin());
        for (std::size_t n = corners; n < pattern.nodes; ++n) {
            const Node& a = node[pattern.parent[n][0]];
            const Node& b = node[pattern.parent[n][1]];
            for (std::size_t i = 0; i < corners; ++i) node[n].x[i] = (a.x[i] + b.x[i]) / 2;
            node[n].word = InSubtree::middle(a.word, b.word);
        }
        for (std::size_t p = patches == 0 ? 1 : 2; p < 2 * pattern.ends; ++p) {
            const auto& part = pattern.part[p];
            Element element;
            for (std::size_t i = 0; i < corners; ++i) element[i] = node[part.corner[i]];
            add(element, patches * pattern.height + part.depth);
            const bool is_end = p >= pattern.ends;
            if (is_end && patches + 1 < InSubtree::height) walk(element, patches + 1);
        }
    }
    void add(const Element& e, std::size_t level) {
        if (edges.size() <= level) edges.resize(level + 1);
        for (std::size_t i = 0; i < corners; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                edges[level].push_back({{e[i], e[j]}, Edge{e[i].x, e[j].x}});
            }
        }
    }
};

template <const auto& pattern>
void expect_numbers_of_edges() {
    using InSubtree = SubtreeNodes<pattern>;
    EXPECT_EQ(InSubtree::height, 3);
    std::vector<std::map<std::uint32_t, std::pair<std::size_t, typename Subtree<pattern>::Edge>>>
        known;
    for (const std::size_t number : {std::size_t{0}, std::size_t{1}, most_patches - 1}) {
        const Subtree<pattern> subtree(number);
        known.resize(subtree.edges.size());
        for (std::size_t level = 0; level < subtree.edges.size(); ++level) {
            for (const auto& [ends, edge] : subtree.edges[level]) {
                const auto& [a, b] = ends;
                const std::uint32_t told = InSubtree::edge_number(a.word, b.word);
                EXPECT_NE(told, InSubtree::no_number);
                EXPECT_LT(told, InSubtree::edge_numbers(number + 1));
                const auto [at, is_new] = known[level].try_emplace(told, number, edge);
                EXPECT_EQ(at->second, std::pair(number, edge)) << "level " << level;
                bool on_face = false;
                for (std::size_t i = 0; i < pattern.corners; ++i) {
                    on_face = on_face || (a.x[i] == 0 && b.x[i] == 0);
                }
                EXPECT_EQ(InSubtree::is_inside(a.word, b.word), !on_face);
                EXPECT_EQ(is_within_root(a.word, b.word), !on_face);  // here the same
            }
        }
    }
}

TEST(SubtreeEdges, HaveNumbersOfTheirOwn) {
    expect_numbers_of_edges<maubach_patch<2>>();
    expect_numbers_of_edges<maubach_patch<3>>();
}

/// Not even two nodes that are in none, or one that is and one that is not.
TEST(SubtreeEdges, OutsideSubtreesHaveNone) {
    using InSubtree = SubtreeNodes<maubach_patch<3>>;
    const SubtreeNode above = InSubtree::root_corner(0);
    for (std::size_t i = 0; i < 4; ++i) {
        const SubtreeNode corner = InSubtree::corner(above, most_patches - 1, i);
        const auto below =
            InSubtree::middle_below(Pack<SubtreeNode>::all(corner), Pack<SubtreeNode>::all(corner))
                .numbers()[0];
        for (const SubtreeNode node : {above, below, InSubtree::unknown}) {
            EXPECT_EQ(InSubtree::edge_number(node, corner), InSubtree::no_number);
            EXPECT_EQ(InSubtree::edge_number(node, above), InSubtree::no_number);
            EXPECT_FALSE(InSubtree::is_inside(node, corner));
            EXPECT_FALSE(InSubtree::is_inside(InSubtree::middle(node, above), above));
        }
    }
}

}  // namespace pack_test
