// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/polylines.hpp>

#include <algorithm>
#include <string>

#include <nestgrid/error.hpp>

#include <surfaces/require_simplices.hpp>
#include <surfaces/vertex_numbers.hpp>

namespace nestgrid {

namespace {

constexpr std::uint32_t no_vertex = 0xFFFFFFFFU;

/// Follows directed segments. Each segment is followed once.
class Chains {
public:
    explicit Chains(const Surface<2>& segments)
        : segments_{&segments},
          next_from_(segments.vertices.size(), no_vertex),
          next_(segments.simplices.size()),
          excess_(segments.vertices.size(), 0) {
        for (auto s = static_cast<std::uint32_t>(next_.size()); s-- > 0;) {
            const auto [from, to] = segments.simplices[s];
            next_[s] = next_from_[from];
            next_from_[from] = s;
            ++excess_[from];
            --excess_[to];
        }
    }

    /// Whether an unused segment starts at the vertex.
    bool leaves(std::uint32_t vertex) const { return next_from_[vertex] != no_vertex; }
    /// Whether more unused segments start than end at the vertex.
    bool begins(std::uint32_t vertex) const { return excess_[vertex] > 0; }

    /// Follows segments from a vertex until none leaves or the vertex is met again. Requires
    /// leaves(start).
    /// \param line gets the vertices on the way
    void follow(std::uint32_t start, std::vector<std::uint32_t>& line) {
        line.assign(1, start);
        std::uint32_t at = start;
        do {
            const std::uint32_t segment = next_from_[at];
            next_from_[at] = next_[segment];
            at = segments_->simplices[segment][1];
            line.push_back(at);
        } while (at != start && leaves(at));
        --excess_[start];
        ++excess_[at];
    }

private:
    const Surface<2>* segments_;
    std::vector<std::uint32_t> next_from_;  // per vertex, the first segment left that begins there
    std::vector<std::uint32_t> next_;       // per segment, the next one with the same beginning
    std::vector<std::int32_t> excess_;  // per vertex, segments left that begin less those that end
};

/// Appends lines through the vertices of segments.
class SegmentJoining {
public:
    SegmentJoining(Polylines& to, const Surface<2>& segments)
        : to_{&to}, from_{&segments}, number_(segments.vertices.size(), no_vertex) {}

    /// Appends a line without repeated positions, or nothing where only one is left.
    /// \param line vertices of the segments; a ring ends with its first one
    void add(std::vector<std::uint32_t>& line, double value) {
        const auto& x = from_->vertices;
        const bool ring = line.front() == line.back();
        const auto same = [&](std::uint32_t a, std::uint32_t b) { return x[a] == x[b]; };
        line.erase(std::unique(line.begin(), line.end(), same), line.end());
        if (line.size() < 2) return;
        if (ring) line.back() = line.front();
        for (const std::uint32_t v : line) to_->points.push_back(number_of(v));
        to_->first.push_back(to_->points.size());
        to_->value.push_back(value);
    }

private:
    std::uint32_t number_of(std::uint32_t v) {
        if (number_[v] != no_vertex) return number_[v];
        const std::size_t n = to_->attribute_count;
        const auto attributes = std::span(from_->attributes).subspan(v * n, n);
        if (to_->vertices.size() >= no_vertex) engine::throw_too_many_vertices();
        number_[v] = static_cast<std::uint32_t>(to_->vertices.size());
        to_->vertices.push_back(from_->vertices[v]);
        to_->attributes.insert(to_->attributes.end(), attributes.begin(), attributes.end());
        return number_[v];
    }

    Polylines* to_;
    const Surface<2>* from_;
    std::vector<std::uint32_t> number_;  // per vertex of the segments, its number in the lines
};

void require_joinable(const Polylines& to, const Surface<2>& segments, std::size_t attributes) {
    if (!to.vertices.empty() && to.attribute_count != attributes) {
        throw InvalidInput("the segments have " + std::to_string(attributes) +
                           " attributes, but the lines " + std::to_string(to.attribute_count));
    }
    engine::require_simplices(segments);
}

}  // namespace

double Polylines::length(std::size_t i) const {
    const std::span<const std::uint32_t> passed = line(i);
    double sum = 0;
    for (std::size_t k = 1; k < passed.size(); ++k) {
        sum += norm(vertices[passed[k]] - vertices[passed[k - 1]]);
    }
    return sum;
}

void detail::append_polylines(Polylines& to, const Surface<2>& segments, double value) {
    const std::size_t vertices = segments.vertices.size();
    const std::size_t attributes = vertices == 0 ? 0 : segments.attributes.size() / vertices;
    if (segments.simplices.empty()) return;
    require_joinable(to, segments, attributes);
    to.attribute_count = attributes;
    Chains chains(segments);
    SegmentJoining joining(to, segments);
    std::vector<std::uint32_t> line;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        while (chains.begins(v)) {
            chains.follow(v, line);
            joining.add(line, value);
        }
    }
    for (std::uint32_t v = 0; v < vertices; ++v) {
        while (chains.leaves(v)) {
            chains.follow(v, line);
            joining.add(line, value);
        }
    }
}

Polylines polylines(const Surface<2>& segments, double value) {
    Polylines result;
    detail::append_polylines(result, segments, value);
    return result;
}

}  // namespace nestgrid
