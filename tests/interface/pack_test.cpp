// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is done to many numbers at once is what is done to each of them, to the last bit; what comes
// next in a block is what a recursion meets.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include <nestgrid/bisection_block.hpp>
#include <nestgrid/pack.hpp>
#include <nestgrid/wide_point.hpp>

using namespace nestgrid;

namespace {

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

TYPED_TEST(Packs, DoWhatIsDoneToOne) {
    using T = TypeParam;
    using P = Pack<T>;
    std::mt19937_64 random(1);
    for (int round = 0; round < 1000; ++round) {
        const std::array<T, pack> a = random_numbers<T>(random);
        std::array<T, pack> b = random_numbers<T>(random);
        if (round % 3 == 0) b[1] = a[1];
        const P pa = P::load(a.data());
        const P pb = P::load(b.data());
        const auto expect = [&](const auto& result, auto&& of_one) {
            const auto numbers = result.numbers();
            for (std::size_t i = 0; i < pack; ++i) {
                EXPECT_EQ(bits_of(numbers[i]), bits_of(of_one(a[i], b[i]))) << i;
            }
        };
        const auto all = ~MaskOf<T>{0};
        expect(min(pa, pb), [](T x, T y) { return std::min(x, y); });
        expect(max(pa, pb), [](T x, T y) { return std::max(x, y); });
        expect(pa + pb, [](T x, T y) { return static_cast<T>(x + y); });
        expect(pa - pb, [](T x, T y) { return static_cast<T>(x - y); });
        expect(at_most(pa, pb), [&](T x, T y) { return x <= y ? all : MaskOf<T>{0}; });
        expect(P::all(a[0]), [&](T, T) { return a[0]; });
        expect(P::make([&](auto i) { return b[i]; }), [](T, T y) { return y; });
        expect(pa.template as<MaskOf<T>>(), [](T x, T) { return bits_of(x); });
        if constexpr (std::is_integral_v<T>) {
            expect(pa & pb, [](T x, T y) { return x & y; });
            expect(pa | pb, [](T x, T y) { return x | y; });
            expect(without(pa, pb), [](T x, T y) { return x & ~y; });
            expect(pa << 5, [](T x, T) { return x << 5U; });
            expect(pa >> 5, [](T x, T) { return x >> 5U; });
        }
    }
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

/// What a recursion meets in a block, into `order`, and which of the bits it looked at.
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
            const auto& known = block_orders<pattern>[entered | stops << parts];
            EXPECT_EQ(
                std::vector<std::size_t>(known.part.begin(), known.part.begin() + known.count),
                order);
        }
    }
    EXPECT_EQ(met, parts == 2 ? 9U : 121U);  // 3^2; (2 + 3^2)^2
}

TEST(Blocks, KnowWhatComesNext) {
    expect_order<maubach_block<2>>();
    expect_order<maubach_block<3>>();
}

}  // namespace
