// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Eight numbers at once, in vectors of the compiler as wide as the machine that is compiled for has
// them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <nestgrid/inlining.hpp>

namespace nestgrid {

/// Numbers in a pack.
inline constexpr std::size_t pack = 8;

/// The least multiple of `pack` that is not below `count`.
constexpr std::size_t packed(std::size_t count) { return (count + pack - 1) / pack * pack; }

/// What a comparison of numbers of a type gives: all bits, or none.
template <class T>
using MaskOf = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

template <class T>
concept Packable = std::is_arithmetic_v<T> && (sizeof(T) == 4 || sizeof(T) == 8);

template <Packable T>
class Pack {
#if defined(__AVX512F__) && defined(__AVX512VL__)
    static constexpr std::size_t widest_ = 64;
#elif defined(__AVX2__)
    static constexpr std::size_t widest_ = 32;
#else
    static constexpr std::size_t widest_ = 16;
#endif
#if defined(__GNUC__)
    static constexpr std::size_t bytes_ = std::min(widest_, pack * sizeof(T));
    using Vector [[gnu::vector_size(bytes_)]] = T;
    static constexpr std::size_t width_ = bytes_ / sizeof(T);
#else
    using Vector = T;
    static constexpr std::size_t width_ = 1;
#endif
    static constexpr std::size_t vectors_ = pack / width_;

public:
    using Mask = Pack<MaskOf<T>>;

    // Vector by vector: a copy of all of them goes through narrower ones, and waits for those.
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
    NESTGRID_INLINE Pack<U> as() const {
        Pack<U> p;
        unrolled<vectors_>([&](auto v) NESTGRID_INLINE_LAMBDA {
            std::memcpy(&p.v_[v].of, &v_[v].of, sizeof(Vector));
        });
        return p;
    }

    NESTGRID_INLINE friend Pack min(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA {
            return y < x ? y : x;
        });
    }
    NESTGRID_INLINE friend Pack max(const Pack& a, const Pack& b) {
        return combine(a, b, [](const Vector& x, const Vector& y) NESTGRID_INLINE_LAMBDA {
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

    NESTGRID_INLINE std::array<T, pack> numbers() const {
        std::array<T, pack> result;
        store(result.data());
        return result;
    }

private:
    template <Packable>
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
    std::array<Part, vectors_> v_;
};

}  // namespace nestgrid
