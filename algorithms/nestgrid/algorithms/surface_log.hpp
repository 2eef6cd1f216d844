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

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/inlining.hpp>
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

/// A sink (surface.hpp) that keeps what it is told. Vertices come with the nodes they lie between,
/// by which a vertex is known to several tasks; those that only one can know come without.
template <int dimension, class Element, std::size_t attribute_count, bool is_indexed>
class SurfaceLog {
public:
    static constexpr bool logs = true;
    static constexpr bool indexed = is_indexed;
    using Cut = SurfaceCut<attribute_count>;
    using Simplex = std::array<std::uint32_t, static_cast<std::size_t>(dimension)>;
    using Ridge = std::array<std::uint32_t, static_cast<std::size_t>(dimension - 1)>;
    using Owner = ExtractedElement<Element>;

    /// \param elements whether the sink it is for keeps them
    explicit SurfaceLog(bool elements) : keeps_elements_{elements} {}

    /// A vertex that other tasks may know.
    NESTGRID_INLINE void add_cut(const Cut& cut) {
        shared_.push_back({x_.size(), cut.node, cut.fraction});
        add_vertex(cut.x, cut.attributes);
    }
    NESTGRID_INLINE void add_vertex(const Point& x, std::span<const double> attributes) {
        x_.push_back(x);
        for (std::size_t i = 0; i < attribute_count; ++i) attributes_.push_back(attributes[i]);
    }
    Point position(std::uint32_t vertex) const { return x_[vertex]; }
    bool keeps_elements() const { return keeps_elements_; }
    void add_element(const Element& element, Shape shape, int level) {
        if (keeps_elements_) elements_.push_back({element, shape, level, 0});
    }
    NESTGRID_INLINE void add_simplex(const Simplex& corners,
                                     std::span<const Point> reference) requires(is_indexed) {
        simplices_.push_back(corners);
        if (keeps_elements_) ++elements_.back().simplices;
        for (const Point& x : reference) reference_.push_back(x);
    }
    template <class Corners>
    void add_simplices(std::span<const std::uint32_t> vertices,
                       std::span<const Corners> all) requires(is_indexed) {
        detail::append_simplices(vertices, all, simplices_);
        if (keeps_elements_) elements_.back().simplices += static_cast<std::uint32_t>(all.size());
    }
    template <class Corners>
    void add_extracted(std::span<const Owner> elements, std::span<const std::uint32_t> vertices,
                       std::span<const Corners> all) requires(is_indexed) {
        detail::append_simplices(vertices, all, simplices_);
        elements_.insert(elements_.end(), elements.begin(), elements.end());
    }
    // Where there are no indices, corners are kept once for all that are put down together.
    NESTGRID_INLINE void add_simplex(
        const std::array<Point, static_cast<std::size_t>(dimension)>& corners,
        std::span<const Point> reference) requires(!is_indexed) {
        Simplex& simplex = simplices_.emplace_back();
        for (std::size_t k = 0; k < simplex.size(); ++k) {
            simplex[k] = static_cast<std::uint32_t>(x_.size());
            x_.push_back(corners[k]);
        }
        if (keeps_elements_) ++elements_.back().simplices;
        for (const Point& x : reference) reference_.push_back(x);
    }
    template <class Corners>
    void add_simplices(std::span<const WidePoint> x,
                       std::span<const Corners> all) requires(!is_indexed) {
        const auto first = static_cast<std::uint32_t>(x_.size());
        for (const WidePoint& corner : x) x_.push_back(Point(corner));
        for (const Corners& corners : all) {
            Simplex& simplex = simplices_.emplace_back();
            for (std::size_t k = 0; k < simplex.size(); ++k) simplex[k] = first + corners[k];
        }
        if (keeps_elements_) elements_.back().simplices += static_cast<std::uint32_t>(all.size());
    }
    void add_boundary(const Ridge& corners) { boundary_.push_back(corners); }

    /// As new, but for its memory.
    void clear(bool elements) {
        keeps_elements_ = elements;
        x_.clear();
        attributes_.clear();
        shared_.clear();
        elements_.clear();
        simplices_.clear();
        reference_.clear();
        boundary_.clear();
    }

    /// Repeats the calls, those for vertices before all others; corners are numbers of vertices in
    /// the order they were added here. Those that other tasks may know are announced by expect().
    /// Without indices there are points instead, all in one call.
    template <class Receiver>
    void repeat(Receiver&& to) const {
        constexpr std::size_t ahead = 16;
        const std::span<const Point> x(x_);
        const std::span<const double> attributes(attributes_);
        const auto others = [&](std::size_t first, std::size_t end) {
            if (first == end) return;
            to.vertices(
                x.subspan(first, end - first),
                attributes.subspan(first * attribute_count, (end - first) * attribute_count));
        };
        std::size_t next = 0;
        for (std::size_t i = 0; i < shared_.size(); ++i) {
            if (i + ahead < shared_.size()) to.expect(shared_[i + ahead].node);
            const Shared& vertex = shared_[i];
            others(next, vertex.number);
            Cut cut{x[vertex.number], vertex.node, vertex.fraction, {}};
            for (std::size_t k = 0; k < attribute_count; ++k) {
                cut.attributes[k] = attributes[vertex.number * attribute_count + k];
            }
            to.cut(cut);
            next = vertex.number + 1;
        }
        others(next, x.size());
        for (const Ridge& corners : boundary_) to.boundary(corners);
        const std::span<const Simplex> all(simplices_);
        if (reference_.empty()) {
            return elements_.empty() ? to.simplices(all)
                                     : to.extracted(std::span<const Owner>(elements_), all);
        }
        std::size_t from = 0;
        const auto some = [&](std::size_t count) {
            for (const std::size_t end = from + count; from < end; ++from) {
                to.simplex(all[from],
                           std::span<const Point>(reference_).subspan(from * dimension, dimension));
            }
        };
        for (const Owner& owner : elements_) {
            to.element(owner);
            some(owner.simplices);
        }
        some(all.size() - from);
    }

private:
    struct Shared {
        std::size_t number;  // of the vertex
        std::array<NodeKey, 2> node;
        double fraction;
    };

    bool keeps_elements_;
    std::vector<Point> x_;            // of the vertices, or of corners
    std::vector<double> attributes_;  // likewise
    std::vector<Shared> shared_;      // those that other tasks may know
    std::vector<Owner> elements_;
    std::vector<Simplex> simplices_;
    std::vector<Point> reference_;
    std::vector<Ridge> boundary_;
};

}  // namespace nestgrid
