// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What one task draws, to be repeated into the sinks of all tasks in the order of one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <nestgrid/key_table.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid {

/// A vertex of a surface, on the edge from the lower to the higher of two nodes.
template <std::size_t attribute_count>
struct SurfaceCut {
    Point x;
    std::array<NodeKey, 2> node;
    double fraction;
    std::array<double, attribute_count> attributes;
};

/// A sink (surface.hpp) that keeps the calls in their order. Vertices come with the nodes they lie
/// between, by which a vertex is known to several tasks; those inside one element come without.
template <int dimension, class Element, std::size_t attribute_count, bool is_indexed>
class SurfaceLog {
public:
    static constexpr bool logs = true;
    static constexpr bool indexed = is_indexed;
    using Cut = SurfaceCut<attribute_count>;
    using Corner = std::conditional_t<is_indexed, std::uint32_t, Point>;
    using Simplex = std::array<Corner, static_cast<std::size_t>(dimension)>;
    using Ridge = std::array<Corner, static_cast<std::size_t>(dimension - 1)>;
    struct Owner {
        Element element;
        Shape shape;
        int level;
    };

    /// \param alone no other task knows it
    void add_cut(const Cut& cut, bool alone) {
        calls_.push_back(alone ? Call::cut_alone : Call::cut);
        cuts_.push_back(cut);
    }
    void add_vertex(const Point& x, std::span<const double> attributes) {
        calls_.push_back(Call::vertex);
        cuts_.push_back({x, {}, 0, {}});
        for (std::size_t i = 0; i < attribute_count; ++i)
            cuts_.back().attributes[i] = attributes[i];
    }
    Point position(std::uint32_t vertex) const { return cuts_[vertex].x; }
    void add_element(const Element& element, Shape shape, int level) {
        calls_.push_back(Call::element);
        elements_.push_back({element, shape, level});
    }
    void add_simplex(const Simplex& corners, std::span<const Point> reference) {
        calls_.push_back(Call::simplex);
        simplices_.push_back(corners);
        reference_.insert(reference_.end(), reference.begin(), reference.end());
    }
    void add_boundary(const Ridge& corners) {
        calls_.push_back(Call::boundary);
        boundary_.push_back(corners);
    }

    /// Repeats the calls; corners are numbers of vertices in the order they were added here.
    template <class Receiver>
    void repeat(Receiver&& to) const {
        auto cut = cuts_.begin();
        auto element = elements_.begin();
        auto simplex = simplices_.begin();
        auto boundary = boundary_.begin();
        std::span<const Point> reference(reference_);
        const std::size_t step = reference_.empty() ? 0 : dimension;
        for (const Call call : calls_) {
            switch (call) {
                case Call::cut:
                    to.cut(*cut++);
                    break;
                case Call::cut_alone:
                    to.cut_alone(*cut++);
                    break;
                case Call::vertex:
                    to.vertex(*cut++);
                    break;
                case Call::element:
                    to.element(*element++);
                    break;
                case Call::simplex:
                    to.simplex(*simplex++, reference.first(step));
                    reference = reference.subspan(step);
                    break;
                case Call::boundary:
                    to.boundary(*boundary++);
                    break;
            }
        }
    }

private:
    enum class Call : std::uint8_t { cut, cut_alone, vertex, element, simplex, boundary };

    std::vector<Call> calls_;
    std::vector<Cut> cuts_;
    std::vector<Owner> elements_;
    std::vector<Simplex> simplices_;
    std::vector<Point> reference_;
    std::vector<Ridge> boundary_;
};

}  // namespace nestgrid
