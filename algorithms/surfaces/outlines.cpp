// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/outlines.hpp>

#include <algorithm>
#include <vector>

#include <nestgrid/error.hpp>

#include <surfaces/require_simplices.hpp>
#include <surfaces/vertex_numbers.hpp>

namespace nestgrid {

namespace {

using OrderedSide = std::array<std::uint32_t, 2>;

/// Finds the sides that exactly one triangle of a set has.
class UnpairedSides {
public:
    /// The sides that exactly one of the triangles has, turned as there. Valid until the next call.
    std::span<const OrderedSide> of(std::span<const std::array<std::uint32_t, 3>> triangles) {
        sides_.clear();
        for (const auto& [a, b, c] : triangles) {
            for (const OrderedSide side : {OrderedSide{a, b}, OrderedSide{b, c}, OrderedSide{c, a}})
                sides_.push_back(side);
        }
        std::ranges::sort(sides_, {}, ascending);
        auto kept = sides_.begin();
        for (auto first = sides_.begin(); first != sides_.end();) {
            const auto last = std::find_if(first, sides_.end(), [&](const OrderedSide& side) {
                return ascending(side) != ascending(*first);
            });
            if (last - first == 1) *kept++ = *first;
            first = last;
        }
        return std::span(sides_).first(static_cast<std::size_t>(kept - sides_.begin()));
    }

private:
    static OrderedSide ascending(const OrderedSide& side) {
        return {std::min(side[0], side[1]), std::max(side[0], side[1])};
    }

    std::vector<OrderedSide> sides_;
};

/// Gathers segments, each once, with the vertices they need.
class Outlines {
public:
    explicit Outlines(const Surface<3>& surface)
        : from_{&surface},
          stride_{surface.attributes.size() / std::max<std::size_t>(surface.vertices.size(), 1)},
          number_(surface.vertices.size(), none_) {}

    void add(const OrderedSide& side) {
        segments_.reserve(1);
        const auto next = static_cast<std::uint32_t>(to_.simplices.size());
        if (!segments_.find_or_add(segments_.name({side[0], side[1]}), next).is_new) return;
        to_.simplices.push_back({number_of(side[0]), number_of(side[1])});
    }
    Surface<2> take() { return std::move(to_); }

private:
    static constexpr std::uint32_t none_ = 0xFFFFFFFFU;

    std::uint32_t number_of(std::uint32_t v) {
        if (number_[v] != none_) return number_[v];
        number_[v] = static_cast<std::uint32_t>(to_.vertices.size());
        to_.vertices.push_back(from_->vertices[v]);
        if (!from_->normals.empty()) to_.normals.push_back(from_->normals[v]);
        for (const double a : std::span(from_->attributes).subspan(v * stride_, stride_)) {
            to_.attributes.push_back(a);
        }
        return number_[v];
    }

    const Surface<3>* from_;
    std::size_t stride_;                    // attributes of a vertex
    std::vector<std::uint32_t> number_;     // per vertex of the surface
    engine::VertexNumbers segments_{true};  // by the numbers of their ends in the surface
    Surface<2> to_;
};

void require_outlined(const Surface<3>& surface) {
    if (surface.element_of.size() != surface.simplices.size()) {
        throw InvalidInput("the surface does not keep the elements that its triangles come from");
    }
    engine::require_simplices(surface);
}

}  // namespace

Surface<2> outlines(const Surface<3>& surface) {
    require_outlined(surface);
    UnpairedSides sides;
    Outlines result(surface);
    const std::span triangles(surface.simplices);
    for (std::size_t first = 0; first < triangles.size();) {
        std::size_t last = first + 1;
        while (last < triangles.size() && surface.element_of[last] == surface.element_of[first]) {
            ++last;
        }
        for (const OrderedSide& side : sides.of(triangles.subspan(first, last - first))) {
            result.add(side);
        }
        first = last;
    }
    return result.take();
}

}  // namespace nestgrid
