// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A *pack*: several numbers side by side, eight unless a template argument says otherwise, on which
// an operation works at once. They lie in vectors of the compiler as wide as the machine that is
// compiled for has them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <nestgrid/detail/inlining.hpp>

namespace nestgrid {

/// Numbers in a pack, unless told otherwise.
inline constexpr std::size_t pack = 8;

/// The least multiple of `pack` that is not below `count`.
constexpr std::size_t packed(std::size_t count) { return (count + pack - 1) / pack * pack; }

/// What a comparison of numbers of a type gives: all bits, or none.
template <class T>
using MaskOf = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

template <class T>
concept Packable = std::is_arithmetic_v<T> &&(sizeof(T) == 4 || sizeof(T) == 8);

/// Bytes of the vectors that are used. Wider ones were slower (docs/speed.md).
#if defined(__AVX2__)
inline constexpr std::size_t widest_vector = 32;
#else
inline constexpr std::size_t widest_vector = 16;
#endif

inline constexpr std::size_t doubles_at_once = widest_vector / sizeof(double);

/// \tparam size a power of two
template <Packable T, std::size_t size = pack>
class Pack {
#if defined(__GNUC__)
    static constexpr std::size_t bytes_ = std::min(widest_vector, size * sizeof(T));
    using Vector [[gnu::vector_size(bytes_)]] = T;
    static constexpr std::size_t width_ = bytes_ / sizeof(T);
#else
    using Vector = T;
    static constexpr std::size_t width_ = 1;
#endif
    static constexpr std::size_t vectors_ = size / width_;
    static constexpr bool pairs_ = std::is_same_v<T, double> && width_ == 2;

public:
    using value_type = T;
    using Mask = Pack<MaskOf<T>, size>;

    // Vector by vector: a copy of all of them goes through narrower ones, and who reads a vector
    // then waits until these have reached the cache.
    Pack() = default;
    NESTGRID_INLINE Pack(const Pack& other) { *this = other; }
    // NOLINTNEXTLINE(bugprone-unhandled-self-assignment): then parts are copied to themselves
    NESTGRID_INLINE Pack& operator=(const Pack& other) {
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA { v_[v].of = other.v_[v].of; });
        return *this;
    }
    ~Pack() = default;
    NESTGRID_INLINE static Pack load(const T* from) {
        Pack p;
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA {
            std::memcpy(&p.v_[v].of, from + v * width_, sizeof(Vector));
        });
        return p;
    }
    NESTGRID_INLINE void store(T* to) const {
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA {
            std::memcpy(to + v * width_, &v_[v].of, sizeof(Vector));
        });
    }
    NESTGRID_INLINE static Pack all(T x) {
        Pack p;
        for (Part& part : p.v_) part.of = x - Vector{};  // -0 stays what it is
        return p;
    }
    /// function(std::integral_constant<std::size_t, i>) for each of them.
    template <class Function>
    NESTGRID_INLINE static Pack make(Function&& function) {
        Pack p;
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA {
#if defined(__GNUC__)
            p.v_[v].of = [&]<std::size_t... i>(std::index_sequence<i...>) NESTGRID_INLINE_LAMBDA {
                return Vector{function(std::integral_constant<std::size_t, v * width_ + i>{})...};
            }
            (std::make_index_sequence<width_>());
#else
            p.v_[v].of = function(v);
#endif
        });
        return p;
    }
    /// The same bits as numbers of another type.
    template <class U>
        requires(sizeof(U) == sizeof(T))
    NESTGRID_INLINE Pack<U, size> as()
    const {
        Pack<U, size> p;
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA {
            std::memcpy(&p.v_[v].of, &v_[v].of, sizeof(Vector));
        });
        return p;
    }

    NESTGRID_INLINE friend Pack min(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA {
#if defined(__SSE2__)  // where one of them is constant, the compiler does not find this
            if constexpr (pairs_) return __builtin_ia32_minpd(y, x);
#endif
            return y < x ? y : x;
        });
    }
    NESTGRID_INLINE friend Pack max(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA {
#if defined(__SSE2__)
            if constexpr (pairs_) return __builtin_ia32_maxpd(y, x);
#endif
            return x < y ? y : x;
        });
    }
    NESTGRID_INLINE friend Pack operator-(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA -> Vector {
            return x - y;
        });
    }
    NESTGRID_INLINE friend Pack operator&(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA -> Vector {
            return x & y;
        });
    }
    NESTGRID_INLINE friend Pack operator|(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA -> Vector {
            return x | y;
        });
    }
    /// The bits of a that are not in b.
    NESTGRID_INLINE friend Pack without(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA -> Vector {
            return x & ~y;
        });
    }
    NESTGRID_INLINE friend Pack operator+(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA -> Vector {
            return x + y;
        });
    }
    NESTGRID_INLINE friend Pack operator*(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA -> Vector {
            return x * y;
        });
    }
    NESTGRID_INLINE friend Pack operator/(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA -> Vector {
            return x / y;
        });
    }
    NESTGRID_INLINE Pack operator<<(int bits) const {
        Pack p;
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA { p.v_[v].of = v_[v].of << bits; });
        return p;
    }
    NESTGRID_INLINE Pack operator>>(int bits) const {
        Pack p;
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA { p.v_[v].of = v_[v].of >> bits; });
        return p;
    }
    /// Where a <= b.
    NESTGRID_INLINE friend Mask at_most(const Pack& a, const Pack& b) {
        Mask mask;
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA {
#if defined(__GNUC__)
            const auto bits = a.v_[v].of <= b.v_[v].of;
#else
            const MaskOf<T> bits = a.v_[v].of <= b.v_[v].of ? ~MaskOf<T>{0} : MaskOf<T>{0};
#endif
            std::memcpy(&mask.v_[v].of, &bits, sizeof bits);
        });
        return mask;
    }

    template <std::size_t i>
    NESTGRID_INLINE T number() const {
#if defined(__GNUC__)
        return v_[i / width_].of[i % width_];
#else
        return v_[i].of;
#endif
    }
    NESTGRID_INLINE std::array<T, size> numbers() const {
        std::array<T, size> result;
        store(result.data());
        return result;
    }

private:
    template <Packable, std::size_t>
    friend class Pack;

    template <class Function>
    NESTGRID_INLINE static Pack combine(const Pack& a, const Pack& b, Function&& function) {
        Pack p;
        unrolled<vectors_>(
            [&](auto v) NESTGRID_INLINE_LAMBDA { p.v_[v].of = function(a.v_[v].of, b.v_[v].of); });
        return p;
    }

    struct Part {  // a template argument would lose the attribute
        Vector of;
    };
    Part v_[vectors_];  // each element of a std::array would be a call to inline
};

/// x, y and z of several points.
template <std::size_t size>
using PackedPoint = std::array<Pack<double, size>, 3>;

template <std::size_t size>
NESTGRID_INLINE PackedPoint<size> packed_point(const std::array<double, 3>& x) {
    using Numbers = Pack<double, size>;
    return {Numbers::all(x[0]), Numbers::all(x[1]), Numbers::all(x[2])};
}

/// Whole numbers below 2^52.
template <std::size_t size>
NESTGRID_INLINE Pack<double, size> to_double(const Pack<std::uint64_t, size>& whole) {
    constexpr double ulp_is_one = 0x1p52;
    const auto bits = Pack<std::uint64_t, size>::all(std::bit_cast<std::uint64_t>(ulp_is_one));
    return (whole | bits).template as<double>() - Pack<double, size>::all(ulp_is_one);
}

}  // namespace nestgrid
