// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the sources use of C++20 and libc++ 13, the library of Debian's Emscripten, lacks. Included
// before each source by toolchain.cmake; empty for a newer library.
#pragma once

#include <version>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <type_traits>
#include <utility>

// NOLINTBEGIN(cert-dcl58-cpp)
namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

template <class T>
unique_ptr<T> make_unique_for_overwrite(size_t count) {
    return unique_ptr<T>(new remove_extent_t<T>[count]);
}

namespace ranges {

/// Calls compare with the projections of its arguments.
template <class Compare, class Projection>
constexpr auto projected(Compare& compare, Projection& projection) {
    return [&](const auto& a, const auto& b) {
        return bool(invoke(compare, invoke(projection, a), invoke(projection, b)));
    };
}

struct MinMax {
    template <class T>
    struct Result {
        T min;
        T max;
    };
    template <class Range, class Projection = identity>
    constexpr auto operator()(const Range& range, std::less<> compare = {},
                              Projection projection = {}) const {
        const auto found =
            std::minmax_element(begin(range), end(range), projected(compare, projection));
        return Result<decay_t<decltype(*begin(range))>>{*found.first, *found.second};
    }
};
inline constexpr MinMax minmax;

template <class Range, class Predicate>
constexpr bool all_of(const Range& range, Predicate predicate) {
    return std::all_of(begin(range), end(range),
                       [&](const auto& x) { return bool(invoke(predicate, x)); });
}
template <class Iterator, class Predicate>
constexpr bool all_of(Iterator from, Iterator to, Predicate predicate) {
    return std::all_of(from, to, predicate);
}
template <class Range, class Predicate>
constexpr bool any_of(const Range& range, Predicate predicate) {
    return std::any_of(begin(range), end(range), predicate);
}
template <class Range, class Predicate>
constexpr bool none_of(const Range& range, Predicate predicate) {
    return std::none_of(begin(range), end(range), predicate);
}
template <class Range, class T>
constexpr auto count(const Range& range, const T& value) {
    return std::count(begin(range), end(range), value);
}
template <class Range, class Predicate>
constexpr auto count_if(const Range& range, Predicate predicate) {
    return std::count_if(begin(range), end(range), predicate);
}
template <class Range, class T>
constexpr auto find(Range&& range, const T& value) {
    return std::find(begin(range), end(range), value);
}
template <class Range, class Predicate>
constexpr auto find_if(Range&& range, Predicate predicate) {
    return std::find_if(begin(range), end(range), predicate);
}
template <class Range, class Out>
constexpr void copy(const Range& range, Out out) {
    std::copy(begin(range), end(range), out);
}
template <class Range, class T>
constexpr void fill(Range&& range, const T& value) {
    std::fill(begin(range), end(range), value);
}
template <class Range, class T>
constexpr void replace(Range&& range, const T& old_value, const T& value) {
    std::replace(begin(range), end(range), old_value, value);
}
template <class Range>
constexpr void reverse(Range&& range) {
    std::reverse(begin(range), end(range));
}
template <class Range, class Compare = std::less<>, class Projection = identity>
constexpr auto min_element(Range&& range, Compare compare = {}, Projection projection = {}) {
    return std::min_element(begin(range), end(range), projected(compare, projection));
}
template <class Range, class Compare = std::less<>, class Projection = identity>
constexpr auto max_element(Range&& range, Compare compare = {}, Projection projection = {}) {
    return std::max_element(begin(range), end(range), projected(compare, projection));
}
template <class Range>
constexpr auto max(const Range& range) {
    return *std::max_element(begin(range), end(range));
}
template <class Range, class Compare = std::less<>, class Projection = identity>
void sort(Range&& range, Compare compare = {}, Projection projection = {}) {
    std::sort(begin(range), end(range), projected(compare, projection));
}
template <class Range, class Compare = std::less<>, class Projection = identity>
void stable_sort(Range&& range, Compare compare = {}, Projection projection = {}) {
    std::stable_sort(begin(range), end(range), projected(compare, projection));
}
template <class Range, class T, class Compare = std::less<>, class Projection = identity>
constexpr auto lower_bound(Range&& range, const T& value, Compare compare = {},
                           Projection projection = {}) {
    return std::lower_bound(begin(range), end(range), value, [&](const auto& x, const T& v) {
        return invoke(compare, invoke(projection, x), v);
    });
}
template <class Range, class T, class Compare = std::less<>, class Projection = identity>
constexpr auto upper_bound(Range&& range, const T& value, Compare compare = {},
                           Projection projection = {}) {
    return std::upper_bound(begin(range), end(range), value, [&](const T& v, const auto& x) {
        return invoke(compare, v, invoke(projection, x));
    });
}

}  // namespace ranges
}  // namespace std
// NOLINTEND(cert-dcl58-cpp)

#endif
