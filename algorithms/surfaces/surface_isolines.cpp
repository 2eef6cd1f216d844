// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <nestgrid/algorithms/surface_isolines.hpp>
#include <nestgrid/error.hpp>

#include <surfaces/require_simplices.hpp>
#include <surfaces/vertex_numbers.hpp>

namespace nestgrid {

namespace {

/// One attribute of a surface.
struct Attribute {
    const Surface<3>* surface;
    std::size_t number;
    std::size_t count;  ///< attributes of a vertex

    double at(std::uint32_t vertex) const { return surface->attributes[vertex * count + number]; }
};

/// Isovalues in ascending order, and for each vertex how many of them are at most its own value: so
/// many isolines have the vertex inside.
struct Ranks {
    Ranks(const Attribute& attribute, std::span<const double> values)
        : ascending(values.size()), of(attribute.surface->vertices.size()) {
        std::iota(ascending.begin(), ascending.end(), 0U);
        const auto value_of = [&](std::uint32_t i) { return values[i]; };
        std::ranges::stable_sort(ascending, {}, value_of);
        for (std::uint32_t v = 0; v < of.size(); ++v) {
            const auto above = std::ranges::upper_bound(ascending, attribute.at(v), {}, value_of);
            of[v] = static_cast<std::uint32_t>(above - ascending.begin());
        }
    }

    std::vector<std::uint32_t> ascending;  ///< numbers of isovalues
    std::vector<std::uint32_t> of;         ///< per vertex
};

/// The segments of one isoline. Triangles that share an edge share the vertex on it.
class IsolineSegments {
public:
    IsolineSegments(const Attribute& attribute, double value)
        : attribute_{attribute}, value_{value} {}

    const Surface<2>& segments() const { return segments_; }
    double value() const { return value_; }

    /// Adds the segment in a triangle. Requires vertices inside and outside.
    void add(const std::array<std::uint32_t, 3>& triangle) {
        std::array<std::uint32_t, 2> segment{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = triangle[i];
            const std::uint32_t b = triangle[(i + 1) % 3];
            const bool falls = attribute_.at(a) >= value_;
            if (falls == (attribute_.at(b) >= value_)) continue;
            segment[falls ? 0 : 1] = falls ? cut(b, a) : cut(a, b);
        }
        segments_.simplices.push_back(segment);
    }

private:
    /// The vertex between a lower and a higher one.
    std::uint32_t cut(std::uint32_t low, std::uint32_t high) {
        const auto add = [&] {
            const auto number = static_cast<std::uint32_t>(segments_.vertices.size());
            if (number == 0xFFFFFFFFU) engine::throw_too_many_vertices();
            add_vertex(low, high);
            return number;
        };
        return numbers_.find(numbers_.name({low, high}), add);
    }
    void add_vertex(std::uint32_t low, std::uint32_t high) {
        const Surface<3>& surface = *attribute_.surface;
        const double from = attribute_.at(low);
        const double s = (value_ - from) / (attribute_.at(high) - from);
        segments_.vertices.push_back((1 - s) * surface.vertices[low] + s * surface.vertices[high]);
        const std::size_t n = attribute_.count;
        for (std::size_t i = 0; i < n; ++i) {
            const double between =
                (1 - s) * surface.attributes[low * n + i] + s * surface.attributes[high * n + i];
            segments_.attributes.push_back(i == attribute_.number ? value_ : between);
        }
    }

    Attribute attribute_;
    double value_;
    Surface<2> segments_;
    engine::VertexNumbers numbers_{true};  // by the numbers of two vertices of the surface
};

void require_finite(std::span<const double> values) {
    for (const double value : values) {
        if (!std::isfinite(value)) throw InvalidInput("the isovalue is not a finite number");
    }
}

/// \throw InvalidInput where the surface has no such attribute, or a value of it is not finite
Attribute require_attribute(const Surface<3>& surface, std::size_t number) {
    const std::size_t vertices = surface.vertices.size();
    const Attribute attribute{&surface, number, surface.attributes.size() / vertices};
    if (number >= attribute.count) {
        throw InvalidInput("the surface has " + std::to_string(attribute.count) +
                           " attributes, so that there is no number " + std::to_string(number));
    }
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (!std::isfinite(attribute.at(v))) {
            throw InvalidInput("attribute " + std::to_string(number) + " of vertex " +
                               std::to_string(v) + " is not a finite number");
        }
    }
    return attribute;
}

}  // namespace

Polylines isolines(const Surface<3>& surface, std::size_t attribute,
                   std::span<const double> values) {
    require_finite(values);
    engine::require_simplices(surface);
    if (surface.vertices.empty()) return {};
    const Attribute function = require_attribute(surface, attribute);
    const Ranks rank(function, values);
    std::vector<IsolineSegments> found;
    found.reserve(values.size());
    for (const double value : values) found.emplace_back(function, value);
    for (const auto& triangle : surface.simplices) {
        const auto [a, b, c] = triangle;
        const auto [low, high] = std::minmax({rank.of[a], rank.of[b], rank.of[c]});
        for (std::uint32_t i = low; i < high; ++i) found[rank.ascending[i]].add(triangle);
    }
    Polylines result;
    for (const IsolineSegments& isoline : found) {
        detail::append_polylines(result, isoline.segments(), isoline.value());
    }
    return result;
}

}  // namespace nestgrid
