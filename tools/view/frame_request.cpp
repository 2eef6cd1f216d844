// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_request.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <nestgrid/error.hpp>

namespace nestgrid::view {

namespace {

constexpr std::size_t longest_request = 2000;
constexpr const char* known_keys =
    "isovalue, axis, at, plane, threshold, triangles, motion, indicator, lens, finest, coarsest, "
    "slope, time, normals and outlines";

/// A text of the request in quotes, cut short, without characters that a terminal obeys.
std::string quoted(std::string_view text) {
    std::string result = "'";
    for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > 40 ? "...'" : "'");
}

[[noreturn]] void refuse(std::string_view key, const std::string& what, std::string_view text) {
    throw InvalidInput(std::string(key) + " is " + what + ": " + quoted(text));
}

/// Finite numbers between commas.
std::vector<double> numbers_of(std::string_view key, std::string_view text, std::size_t count) {
    const std::string what =
        count == 1 ? "no finite number" : "not " + std::to_string(count) + " finite numbers";
    if (text.find_first_not_of("+-.,0123456789eE") != std::string_view::npos) {
        refuse(key, what, text);
    }
    const std::string copy(text);
    const char* at = copy.c_str();
    std::vector<double> numbers;
    while (numbers.size() < count) {
        char* end = nullptr;
        numbers.push_back(std::strtod(at, &end));
        const char expected = numbers.size() == count ? '\0' : ',';
        if (end == at || !std::isfinite(numbers.back()) || *end != expected) {
            refuse(key, what, text);
        }
        at = end + 1;
    }
    return numbers;
}

double number_of(std::string_view key, std::string_view text) {
    return numbers_of(key, text, 1).front();
}

double number_at_least_0(std::string_view key, std::string_view text) {
    const double number = number_of(key, text);
    if (number < 0) refuse(key, "negative", text);
    return number;
}

template <class Value>
struct Choice {
    const char* name;
    Value value;
};

template <class Value, std::size_t count>
Value choice_of(std::string_view key, std::string_view text,
                const std::array<Choice<Value>, count>& choices) {
    std::string names;
    for (const Choice<Value>& choice : choices) {
        if (text == choice.name) return choice.value;
        names += (names.empty() ? "" : ", ") + std::string(choice.name);
    }
    refuse(key, "none of " + names, text);
}

/// The keys and values of a request; each is asked for once.
class Entries {
public:
    explicit Entries(std::string_view text) {
        if (text.size() > longest_request) {
            throw InvalidInput("the request is longer than " + std::to_string(longest_request) +
                               " characters");
        }
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('&'), text.size());
            const std::string_view entry = text.substr(0, end);
            const std::size_t equals = entry.find('=');
            if (equals == std::string_view::npos) {
                throw InvalidInput("the request has " + quoted(entry) +
                                   " where key=value is expected");
            }
            const std::string_view key = entry.substr(0, equals);
            if (!values_.emplace(key, entry.substr(equals + 1)).second) {
                throw InvalidInput("the request has " + quoted(key) + " twice");
            }
            text.remove_prefix(std::min(end + 1, text.size()));
        }
    }

    /// Calls take(key, text) with the value of a key, where there is one.
    template <class Take>
    bool take(const char* key, Take&& take) {
        const auto found = values_.find(key);
        if (found == values_.end()) return false;
        take(std::string_view(key), found->second);
        values_.erase(found);
        return true;
    }
    void require_empty() const {
        if (values_.empty()) return;
        throw InvalidInput("the request has " + quoted(values_.begin()->first) +
                           ", but knows only " + known_keys);
    }

private:
    std::map<std::string_view, std::string_view> values_;
};

Point point_at(const std::vector<double>& numbers, std::size_t first) {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

void take_plane(Entries& entries, FrameRequest& request) {
    const bool plane = entries.take("plane", [&](auto key, auto text) {
        const std::vector<double> n = numbers_of(key, text, 6);
        request.plane = {point_at(n, 0), point_at(n, 3)};
        const Point& normal = request.plane->normal;
        if (normal == Point{0, 0, 0}) refuse(key, "a plane with the normal 0", text);
    });
    std::size_t d = 0;
    const bool axis = entries.take("axis", [&](auto key, auto text) {
        d = choice_of<std::size_t, 3>(key, text, {{{"x", 0}, {"y", 1}, {"z", 2}}});
    });
    double at = 0;
    const bool placed = entries.take("at", [&](auto key, auto text) { at = number_of(key, text); });
    if (axis != placed || (axis && plane)) {
        throw InvalidInput("a slice needs axis and at, or plane alone");
    }
    if (!axis) return;
    request.plane.emplace();
    request.plane->through[d] = at;
    request.plane->normal[d] = 1;
}

void take_threshold(Entries& entries, FrameRequest& request) {
    const bool threshold = entries.take("threshold", [&](auto key, auto text) {
        request.threshold = number_at_least_0(key, text);
    });
    const bool triangles = entries.take("triangles", [&](auto key, auto text) {
        const double number = number_of(key, text);
        if (number != std::floor(number) || number < 1 || number > 1e9) {
            refuse(key, "no count from 1 to 1000000000", text);
        }
        request.triangles = static_cast<std::uint64_t>(number);
    });
    if (threshold && triangles) {
        throw InvalidInput("the request has a threshold and a number of triangles: leave out one");
    }
}

void take_lens(Entries& entries, FrameRequest& request) {
    LensRequest lens;
    const bool ball = entries.take("lens", [&](auto key, auto text) {
        const std::vector<double> n = numbers_of(key, text, 4);
        if (n[3] < 0) refuse(key, "a ball with a negative radius", text);
        lens.centre = point_at(n, 0);
        lens.radius = n[3];
    });
    bool sized = false;
    for (const auto& [key, number] : {std::pair{"finest", &lens.finest},
                                      {"coarsest", &lens.coarsest},
                                      {"slope", &lens.slope}}) {
        sized |= entries.take(
            key, [to = number](auto name, auto text) { *to = number_at_least_0(name, text); });
    }
    if (sized && !ball) throw InvalidInput("finest, coarsest and slope need a lens");
    if (lens.coarsest < lens.finest) throw InvalidInput("coarsest is below finest");
    if (ball) request.lens = lens;
}

}  // namespace

FrameRequest parse_request(std::string_view text) {
    Entries entries(text);
    FrameRequest request;
    entries.take("isovalue",
                 [&](auto key, auto value) { request.isovalue = number_of(key, value); });
    take_plane(entries, request);
    take_threshold(entries, request);
    take_lens(entries, request);
    entries.take("motion", [&](auto key, auto value) {
        request.moving = choice_of<bool, 2>(key, value, {{{"moving", true}, {"settled", false}}});
    });
    entries.take("indicator", [&](auto key, auto value) {
        request.indicator = choice_of<IndicatorName, 4>(key, value,
                                                        {{{"offset", IndicatorName::offset},
                                                          {"visual", IndicatorName::visual},
                                                          {"numerical", IndicatorName::numerical},
                                                          {"wavelet", IndicatorName::wavelet}}});
    });
    entries.take("time", [&](auto key, auto value) { request.time = number_of(key, value); });
    entries.take("normals", [&](auto key, auto value) {
        request.normals = choice_of<NormalType, 3>(key, value,
                                                   {{{"none", NormalType::none},
                                                     {"int8", NormalType::int8},
                                                     {"float32", NormalType::float32}}});
    });
    entries.take("outlines", [&](auto key, auto value) {
        request.outlines = choice_of<bool, 2>(key, value, {{{"on", true}, {"off", false}}});
    });
    entries.require_empty();
    if (!request.isovalue && !request.plane) {
        throw InvalidInput("nothing is to be drawn: give isovalue, plane, or axis and at");
    }
    return request;
}

}  // namespace nestgrid::view
