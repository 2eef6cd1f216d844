// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a surface is kept in, and what else it can be poured into.
//
// A sink takes a surface while it is extracted. Vertices are numbered in the order they are added:
//     void add_vertex(const Point& x, std::span<const double> attributes)
//         attributes: components 1 ... of the field there
//     void add_vertices(std::span<const Point> x)
//         optional: several, where there are no attributes
//     Point position(std::uint32_t vertex) const
//     void add_element(const Element& element, Shape shape, int level)
//         before the first simplex from it
//     bool keeps_elements() const
//         optional; where it says no, add_element() may not be called
//     void add_simplex(const Simplex& vertices, std::span<const Point> reference)
//         reference: where they lie in the element; empty unless asked for
//     void add_simplices(std::span<const std::uint32_t> vertices, std::span<const Corners> all)
//         optional: several from one element, or from any where it keeps none; Corners is any array
//         of numbers that say which of the vertices are the corners, of a segment the first two
//     void add_extracted(std::span<const ExtractedElement<Element>> elements,
//                        std::span<const std::uint32_t> vertices, std::span<const Corners> all)
//         optional: several elements and all simplices from them, in their order
//     void add_part(const Surface& part, std::span<const std::uint32_t> numbers)
//         optional: all elements, simplices and references of a surface whose vertices have these
//         numbers here
//     void add_boundary(const Ridge& vertices)        on the boundary of the domain
//     void set_normal(std::uint32_t vertex, const Point& unit)   at the end, where asked for
// A sink with `static constexpr bool indexed = false` takes positions instead and nothing is kept:
//     void add_element(const Element& element, Shape shape, int level)
//     void add_simplex(const std::array<Point, dimension>& x, std::span<const Point> reference)
//     void add_simplices(std::span<const WidePoint> x, std::span<const Corners> all)
//         optional, likewise
// Such a sink may let several threads fill parts of it:
//     Sink part() const          an empty one of its kind
//     void append(Sink& part)    puts what is in a part behind what is here, and empties it
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <nestgrid/inlining.hpp>
#include <nestgrid/keys.hpp>
#include <nestgrid/shape.hpp>
#include <nestgrid/wide_point.hpp>

namespace nestgrid {

/// An indexed level set: triangles in three dimensions, segments in two.
/// Oriented: the normal (for segments, the right-hand side) points to where U is below the
/// isovalue, so the region U >= C has positive volume when the surface is closed.
template <int dimension, class Element>
struct Surface {
    using Simplex = std::array<std::uint32_t, static_cast<std::size_t>(dimension)>;
    using Ridge = std::array<std::uint32_t, static_cast<std::size_t>(dimension - 1)>;

    std::vector<Point> vertices;
    std::vector<Point> normals;      ///< unit length, one per vertex, where asked for
    std::vector<double> attributes;  ///< components 1 ... of the field, vertex by vertex
    std::vector<Simplex> simplices;
    std::vector<std::uint32_t> element_of;  ///< per simplex, an index into elements
    std::vector<Point> reference;           ///< per corner of a simplex, where asked for: where it
                                            ///< lies in the reference element
    std::vector<Element> elements;          ///< the extracted elements, in order of the traversal
    std::vector<Shape> shape_of;            ///< shape of each of them
    std::vector<std::uint16_t> level_of;    ///< level of each of them
    std::vector<Ridge> boundary;            ///< edges (points) on the boundary of the domain

    /// Forgets everything but its memory.
    void clear() {
        vertices.clear();
        normals.clear();
        attributes.clear();
        simplices.clear();
        element_of.clear();
        reference.clear();
        elements.clear();
        shape_of.clear();
        level_of.clear();
        boundary.clear();
    }

    std::size_t memory_bytes() const {
        const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
        return bytes(vertices) + bytes(normals) + bytes(attributes) + bytes(simplices) +
               bytes(element_of) + bytes(reference) + bytes(elements) + bytes(shape_of) +
               bytes(level_of) + bytes(boundary);
    }
};

/// An element that contributes to a surface.
template <class Element>
struct ExtractedElement {
    Element element;
    Shape shape;
    int level;
    std::uint32_t simplices;  ///< how many come from it
};

namespace detail {

/// A triangle surface where its vectors are: what compiled functions look at.
struct TriangleView {
    std::span<const Point> vertices;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::span<const std::array<std::uint32_t, 2>> boundary;
    std::span<const double> attributes;  ///< vertex by vertex
};

template <class Element>
TriangleView view(const Surface<3, Element>& surface) {
    return {surface.vertices, surface.simplices, surface.boundary, surface.attributes};
}

template <class Sink>
concept IndexedSink = !requires {
    requires !Sink::indexed;
};

/// Whether to tell a sink of the elements its simplices come from.
template <class Sink>
bool keeps_elements(const Sink& sink) {
    if constexpr (requires { sink.keeps_elements(); }) return sink.keeps_elements();
    return true;
}

/// Puts simplices into a sink whose corners are some of these vertices: numbers where it is
/// indexed, else points.
template <int dimension, class Sink, class Vertex, class Corners>
NESTGRID_INLINE void put_simplices(Sink& sink, std::span<const Vertex> v,
                                   std::span<const Corners> all) {
    if constexpr (requires { sink.add_simplices(v, all); }) {
        sink.add_simplices(v, all);
    } else {
        using Corner = std::conditional_t<std::is_same_v<Vertex, WidePoint>, Point, Vertex>;
        for (const Corners& corners : all) {
            std::array<Corner, static_cast<std::size_t>(dimension)> simplex;
            for (std::size_t k = 0; k < simplex.size(); ++k) simplex[k] = Corner(v[corners[k]]);
            sink.add_simplex(simplex, {});
        }
    }
}

/// The same with the elements they come from.
template <int dimension, class Sink, class Extracted, class Vertex, class Corners>
NESTGRID_INLINE void put_extracted(Sink& sink, std::span<const Extracted> elements,
                                   std::span<const Vertex> v, std::span<const Corners> all) {
    if constexpr (requires { sink.add_extracted(elements, v, all); }) {
        sink.add_extracted(elements, v, all);
    } else {
        for (const Extracted& e : elements) {
            sink.add_element(e.element, e.shape, e.level);
            put_simplices<dimension>(sink, v, all.first(e.simplices));
            all = all.subspan(e.simplices);
        }
    }
}

/// Simplices whose corners are some of these vertices, behind others.
template <class Corners, std::size_t size>
void append_simplices(std::span<const std::uint32_t> vertices, std::span<const Corners> all,
                      std::vector<std::array<std::uint32_t, size>>& to) {
    std::array<std::array<std::uint32_t, size>, 64> some;  // memory is written once, in wide words
    while (!all.empty()) {
        const std::size_t count = std::min(some.size(), all.size());
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < size; ++k) some[i][k] = vertices[all[i][k]];
        }
        to.insert(to.end(), some.begin(), some.begin() + count);
        all = all.subspan(count);
    }
}

/// Puts a surface into a sink where its vertices have these numbers.
template <int dimension, class Sink, class Element>
void put_part(Sink& sink, const Surface<dimension, Element>& part,
              std::span<const std::uint32_t> numbers) {
    if constexpr (requires { sink.add_part(part, numbers); }) {
        sink.add_part(part, numbers);
    } else {
        using Simplex = typename Surface<dimension, Element>::Simplex;
        constexpr auto corners = static_cast<std::size_t>(dimension);
        const std::span<const Simplex> all(part.simplices);
        const std::span<const std::uint32_t> element_of(part.element_of);
        for (std::size_t first = 0, end = all.size(); first < all.size(); first = end) {
            if (!element_of.empty()) {
                const std::uint32_t e = element_of[first];
                sink.add_element(part.elements[e], part.shape_of[e], part.level_of[e]);
                for (end = first + 1; end < all.size() && element_of[end] == e;) ++end;
            }
            if (part.reference.empty()) {
                put_simplices<dimension>(sink, numbers, all.subspan(first, end - first));
                continue;
            }
            for (std::size_t i = first; i < end; ++i) {
                Simplex simplex;
                for (std::size_t k = 0; k < corners; ++k) simplex[k] = numbers[all[i][k]];
                sink.add_simplex(
                    simplex, std::span<const Point>(part.reference).subspan(i * corners, corners));
            }
        }
    }
}

}  // namespace detail

/// A vertex of a part of a surface that other parts may know, by the nodes it lies between.
struct SharedVertex {
    std::uint32_t number;
    std::array<NodeKey, 2> node;  ///< the one with the lower value first
    double fraction;              ///< of the way to the other one
};

/// Fills a Surface.
template <int dimension, class Element>
class SurfaceSink {
public:
    using Target = Surface<dimension, Element>;

    /// \param elements whether to keep the elements and which simplex comes from which
    /// \param shared where the surface is a part of another one: to which add_shared() adds
    explicit SurfaceSink(Target& surface, bool elements = true,
                         std::vector<SharedVertex>* shared = nullptr)
        : surface_{&surface}, shared_{shared}, elements_{elements} {}

    /// A vertex, of a part, that other parts may know.
    void add_shared(const std::array<NodeKey, 2>& node, double fraction, const Point& x,
                    std::span<const double> attributes) {
        shared_->push_back({static_cast<std::uint32_t>(surface_->vertices.size()), node, fraction});
        add_vertex(x, attributes);
    }
    void add_vertex(const Point& x, std::span<const double> attributes) {
        surface_->vertices.push_back(x);
        for (const double a : attributes) surface_->attributes.push_back(a);
    }
    void add_vertices(std::span<const Point> x) {
        surface_->vertices.insert(surface_->vertices.end(), x.begin(), x.end());
    }
    Point position(std::uint32_t vertex) const { return surface_->vertices[vertex]; }
    bool keeps_elements() const { return elements_; }
    void add_element(const Element& element, Shape shape, int level) {
        if (!elements_) return;
        surface_->elements.push_back(element);
        surface_->shape_of.push_back(shape);
        surface_->level_of.push_back(static_cast<std::uint16_t>(level));
    }
    NESTGRID_INLINE void add_simplex(const typename Target::Simplex& vertices,
                                     std::span<const Point> reference) {
        surface_->simplices.push_back(vertices);
        if (elements_) {
            surface_->element_of.push_back(
                static_cast<std::uint32_t>(surface_->elements.size() - 1));
        }
        for (const Point& x : reference) surface_->reference.push_back(x);
    }
    template <class Corners>
    void add_simplices(std::span<const std::uint32_t> vertices, std::span<const Corners> all) {
        detail::append_simplices(vertices, all, surface_->simplices);
        if (elements_) {
            surface_->element_of.resize(surface_->simplices.size(),
                                        static_cast<std::uint32_t>(surface_->elements.size() - 1));
        }
    }
    template <class Corners>
    void add_extracted(std::span<const ExtractedElement<Element>> elements,
                       std::span<const std::uint32_t> vertices, std::span<const Corners> all) {
        detail::append_simplices(vertices, all, surface_->simplices);
        if (!elements_) return;
        std::size_t simplex = surface_->element_of.size();
        surface_->element_of.resize(surface_->simplices.size());
        for (const ExtractedElement<Element>& e : elements) {
            const auto number = static_cast<std::uint32_t>(surface_->elements.size());
            for (const std::size_t end = simplex + e.simplices; simplex < end; ++simplex) {
                surface_->element_of[simplex] = number;
            }
            add_element(e.element, e.shape, e.level);
        }
    }
    void add_part(const Target& part, std::span<const std::uint32_t> numbers) {
        const auto append = [](const auto& from, auto& to) {
            to.insert(to.end(), from.begin(), from.end());
        };
        detail::append_simplices(numbers, std::span<const typename Target::Simplex>(part.simplices),
                                 surface_->simplices);
        append(part.reference, surface_->reference);
        if (!elements_) return;
        const auto elements = static_cast<std::uint32_t>(surface_->elements.size());
        const std::size_t simplices = surface_->element_of.size();
        append(part.element_of, surface_->element_of);
        for (std::uint32_t& e : std::span(surface_->element_of).subspan(simplices)) e += elements;
        append(part.elements, surface_->elements);
        append(part.shape_of, surface_->shape_of);
        append(part.level_of, surface_->level_of);
    }
    void add_boundary(const typename Target::Ridge& vertices) {
        surface_->boundary.push_back(vertices);
    }
    /// Forgets everything but the memory.
    void clear() {
        surface_->clear();
        if (shared_ != nullptr) shared_->clear();
    }
    void set_normal(std::uint32_t vertex, const Point& unit) {
        surface_->normals.resize(surface_->vertices.size());
        surface_->normals[vertex] = unit;
    }

private:
    Target* surface_;
    std::vector<SharedVertex>* shared_;
    bool elements_;
};

/// Keeps nothing but the corners of every triangle (segment): what a renderer takes.
/// \tparam Real float or double
template <int dimension, class Real>
class SimplexSoup {
public:
    static constexpr bool indexed = false;
    using Simplex = std::array<Real, 3 * static_cast<std::size_t>(dimension)>;

    /// \param target to which they are added; borrowed
    explicit SimplexSoup(std::vector<Simplex>& target) : target_{&target} {}

    SimplexSoup part() const { return SimplexSoup(std::make_unique<std::vector<Simplex>>()); }
    void append(SimplexSoup& part) {
        target_->insert(target_->end(), part.target_->begin(), part.target_->end());
        part.target_->clear();
    }

    bool keeps_elements() const { return false; }
    template <class Element>
    void add_element(const Element&, Shape, int) {}
    NESTGRID_INLINE void add_simplex(
        const std::array<Point, static_cast<std::size_t>(dimension)>& x, std::span<const Point>) {
        Simplex& simplex = target_->emplace_back();
        for (std::size_t i = 0; i < simplex.size(); ++i) {
            simplex[i] = static_cast<Real>(x[i / 3][i % 3]);
        }
    }
    template <class Corners>
    void add_simplices(std::span<const WidePoint> x, std::span<const Corners> all) {
        for (const auto& corners : all) {
            Simplex simplex;
            for (std::size_t i = 0; i < simplex.size(); ++i) {
                simplex[i] = static_cast<Real>(Point(x[corners[i / 3]])[i % 3]);
            }
            target_->push_back(simplex);
        }
    }

private:
    explicit SimplexSoup(std::unique_ptr<std::vector<Simplex>> own)
        : own_{std::move(own)}, target_{own_.get()} {}

    std::unique_ptr<std::vector<Simplex>> own_;  // of a part
    std::vector<Simplex>* target_;
};

template <class Sink>
concept SinkInParts = requires(Sink& sink, const Sink& same) {
    { same.part() } -> std::same_as<Sink>;
    sink.append(sink);
};

/// Hands every triangle (segment) to a function and keeps nothing.
template <int dimension, class Function>
class SimplexStream {
public:
    static constexpr bool indexed = false;

    explicit SimplexStream(Function function) : function_{std::move(function)} {}

    bool keeps_elements() const { return false; }
    template <class Element>
    void add_element(const Element&, Shape, int) {}
    void add_simplex(const std::array<Point, static_cast<std::size_t>(dimension)>& x,
                     std::span<const Point>) {
        function_(x);
    }

private:
    Function function_;
};

}  // namespace nestgrid
