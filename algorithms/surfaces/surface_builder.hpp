// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Puts a surface together: in a Surface, in the part of a surface that a task draws, or in chunks
// for a sink.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/keys.hpp>
#include <walk/unusable_values.hpp>

namespace nestgrid::engine {

/// A vertex on the edge from the lower to the higher of two nodes.
struct SurfaceCut {
    Point x;
    std::array<NodeKey, 2> node;
    double fraction;                     ///< of the way from the lower to the higher node
    std::span<const double> attributes;  ///< components 1 ... of the field there
};

/// A vertex of one part of a surface that other parts may contain, too.
struct SharedVertex {
    std::uint32_t number;
    std::array<NodeKey, 2> node;  ///< the node with the lower value first
    double fraction;              ///< of the way from the first node to the second
};

/// The node at which a vertex lies.
struct NodePlace {
    NodeKey key;
    Point x;
};

/// Vertices that lie at nodes where the level passes through them, each listed once.
struct VerticesAtNodes {
    std::vector<std::uint32_t> vertex;
    std::vector<NodePlace> node;     ///< of each
    std::vector<double> attributes;  ///< at each node, one after the other

    void add(std::uint32_t v, const NodePlace& at, std::span<const double> of_node) {
        vertex.push_back(v);
        node.push_back(at);
        attributes.insert(attributes.end(), of_node.begin(), of_node.end());
    }
    void clear() {
        vertex.clear();
        node.clear();
        attributes.clear();
    }
};

/// An element that contributes to a surface.
struct ExtractedElement {
    Handle element;
    Shape shape;
    int level;
    std::uint32_t simplices;  ///< number of simplices from it
};

/// A surface with vertex numbers of its own, drawn by one task. Vertices that other parts may have
/// are listed with the nodes they lie between.
template <int dimension>
struct SurfacePart {
    Surface<dimension> surface;
    std::vector<SharedVertex> shared;  ///< in the order of their numbers
};

/// Appends simplices.
/// \param all their corners, as indices into `vertices`
template <class Corners, std::size_t size>
void append_simplices(std::span<const std::uint32_t> vertices, std::span<const Corners> all,
                      std::vector<std::array<std::uint32_t, size>>& to) {
    std::array<std::array<std::uint32_t, size>, 64>
        some;  // a buffer, so that memory is written in wide words
    while (!all.empty()) {
        const std::size_t count = std::min(some.size(), all.size());
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < size; ++k) some[i][k] = vertices[all[i][k]];
        }
        to.insert(to.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
        all = all.subspan(count);
    }
}

template <int dimension>
class SurfaceBuilder {
public:
    using Target = Surface<dimension>;
    using Simplex = typename Target::Simplex;
    using Number = std::uint32_t;

    /// Fills a surface.
    /// \param elements whether to keep the elements and which simplex comes from which
    SurfaceBuilder(Target& surface, bool elements) : surface_{&surface}, elements_{elements} {}
    /// Fills a part of a surface.
    /// \param shared whether elements share vertices, which are then listed in the part
    SurfaceBuilder(SurfacePart<dimension>& part, bool shared, bool elements)
        : surface_{&part.surface},
          shared_{shared ? &part.shared : nullptr},
          shares_vertices_{shared},
          elements_{elements} {}
    /// Fills a sink in chunks.
    /// \param chunk the memory of a chunk
    SurfaceBuilder(MeshSink<dimension>& sink, Target& chunk)
        : surface_{&chunk}, mesh_{&sink}, chunk_{mesh_chunk_}, elements_{sink.keeps_elements()} {}
    /// Fills a sink in chunks, in which elements share no vertices.
    SurfaceBuilder(SimplexSink<dimension>& sink, Target& chunk)
        : surface_{&chunk},
          soup_{&sink},
          chunk_{soup_chunk_},
          shares_vertices_{false},
          elements_{sink.keeps_elements()},
          takes_batches_{sink.takes_batches() && !elements_} {}

    /// The surface that is filled, or null where a sink takes it in chunks.
    const Target* target() const {
        return mesh_ == nullptr && soup_ == nullptr ? surface_ : nullptr;
    }
    /// Calls function(surface) to change the surface that is filled. Requires target() != nullptr.
    template <class Function>
    void change(Function&& function) {
        function(*surface_);
    }
    /// Whether a sink takes simplices as they lie in a batch.
    bool takes_batches() const { return takes_batches_; }
    /// Hands the chunk, and a batch behind it, to the sink. Requires takes_batches().
    void take_batch(const SimplexBatch& batch) {
        flush();
        soup_->take_batch(batch);
    }
    /// Whether elements share vertices.
    bool shares_vertices() const { return shares_vertices_; }
    /// Whether the builder fills a part, and lists the vertices that other parts may contain.
    bool lists_shared() const { return shared_ != nullptr; }
    /// The number of the next vertex.
    Number next_vertex() const { return taken_ + static_cast<Number>(surface_->vertices.size()); }

    /// Adds a vertex that other parts may contain. Requires lists_shared().
    void add_shared(const std::array<NodeKey, 2>& node, double fraction, const Point& x,
                    std::span<const double> attributes) {
        shared_->push_back({static_cast<Number>(surface_->vertices.size()), node, fraction});
        add_vertex(x, attributes);
    }
    void add_vertex(const Point& x, std::span<const double> attributes) {
        surface_->vertices.push_back(x);
        for (const double a : attributes) surface_->attributes.push_back(a);
    }
    NESTGRID_INLINE void add_vertices(std::span<const Point> x,
                                      std::span<const double> attributes) {
        surface_->vertices.insert(surface_->vertices.end(), x.begin(), x.end());
        if (attributes.empty()) return;
        surface_->attributes.insert(surface_->attributes.end(), attributes.begin(),
                                    attributes.end());
    }
    NESTGRID_INLINE Point position(Number vertex) const {
        return vertex < taken_ ? mesh_->position(vertex) : surface_->vertices[vertex - taken_];
    }
    /// Whether attributes() of all vertices are at hand, which a sink may have taken.
    bool keeps_attributes() const { return chunk_ == std::numeric_limits<std::size_t>::max(); }
    /// The attributes of a vertex. Requires keeps_attributes().
    std::span<const double> attributes(Number vertex) const {
        const std::size_t count = surface_->attributes.size() / surface_->vertices.size();
        return std::span(surface_->attributes).subspan(vertex * count, count);
    }
    bool keeps_elements() const { return elements_; }
    void add_element(const Handle& element, Shape shape, int level) {
        if (!elements_) return;
        surface_->elements.append(element);
        surface_->shape_of.push_back(shape);
        surface_->level_of.push_back(static_cast<std::uint16_t>(level));
    }
    NESTGRID_INLINE void add_simplex(const Simplex& vertices, std::span<const Point> reference) {
        surface_->simplices.push_back(vertices);
        if (elements_) surface_->element_of.push_back(last_element());
        for (const Point& x : reference) surface_->reference.push_back(x);
    }
    /// Makes room for simplices that will be added to the surface that is filled, so that its
    /// memory is not copied meanwhile.
    void reserve_simplices(std::size_t more) {
        if (target() != nullptr) surface_->simplices.reserve(surface_->simplices.size() + more);
    }
    /// Adds several elements and all simplices from them, in their order. Where the builder does
    /// not keep elements, these may be left out.
    /// \param vertices, all the simplices, as for append_simplices()
    template <class Corners>
    void add_extracted(std::span<const ExtractedElement> elements, std::span<const Number> vertices,
                       std::span<const Corners> all) {
        append_simplices(vertices, all, surface_->simplices);
        if (!elements_) return;
        std::size_t simplex = surface_->element_of.size();
        surface_->element_of.resize(surface_->simplices.size());
        auto number = static_cast<std::uint32_t>(surface_->level_of.size());
        for (const ExtractedElement& e : elements) {
            for (const std::size_t end = simplex + e.simplices; simplex < end; ++simplex) {
                surface_->element_of[simplex] = number;
            }
            ++number;
            add_element(e.element, e.shape, e.level);
        }
    }
    /// Adds the elements, simplices and references of a part.
    /// \param numbers the numbers that the vertices of the part have here
    void add_part(const Target& part, std::span<const Number> numbers) {
        const auto append = [](const auto& from, auto& to) {
            to.insert(to.end(), from.begin(), from.end());
        };
        append_simplices(numbers, std::span<const Simplex>(part.simplices), surface_->simplices);
        append(part.reference, surface_->reference);
        if (!elements_) return;
        const auto elements = static_cast<std::uint32_t>(surface_->level_of.size());
        const std::size_t simplices = surface_->element_of.size();
        append(part.element_of, surface_->element_of);
        for (std::uint32_t& e : std::span(surface_->element_of).subspan(simplices)) e += elements;
        surface_->elements.append(part.elements);
        append(part.shape_of, surface_->shape_of);
        append(part.level_of, surface_->level_of);
    }
    /// Hands the chunk, and a part behind it, to the sink. Requires a sink to which elements share
    /// no vertices.
    void hand_over(const Target& part) {
        flush();
        require_numbers(part.attributes);
        if (!part.simplices.empty()) soup_->take(part);
    }
    void add_boundary(const typename Target::Ridge& vertices) {
        surface_->boundary.push_back(vertices);
    }
    /// Hands the chunk to the sink where there is one and the chunk is full: of simplices, or of
    /// vertices of elements that are put aside.
    void flush_if_full() {
        if (surface_->simplices.size() >= chunk_ || surface_->vertices.size() / 4 >= chunk_) {
            flush();
        }
    }
    /// Hands the rest to the sink where there is one.
    /// \throw UnusableValue where an attribute is no number
    void flush() {
        if (surface_->vertices.empty() && surface_->simplices.empty()) return;
        require_numbers(surface_->attributes);
        if (mesh_ != nullptr) {
            mesh_->take(*surface_);
            taken_ = next_vertex();
        } else if (soup_ != nullptr) {
            soup_->take(*surface_);
        } else {
            return;
        }
        surface_->clear();
    }
    void set_normals(std::vector<Point>&& normals) {
        if (mesh_ == nullptr) {
            surface_->normals = std::move(normals);
        } else {
            mesh_->set_normals(normals);
        }
    }
    /// Empties the surface, and keeps its memory.
    void clear() {
        surface_->clear();
        if (shared_ != nullptr) shared_->clear();
        taken_ = 0;
    }

private:
    // Simplices in a full chunk; a chunk of a soup stays in the nearest cache.
    static constexpr std::size_t mesh_chunk_ = 1024;
    static constexpr std::size_t soup_chunk_ = 128;

    std::uint32_t last_element() const {
        return static_cast<std::uint32_t>(surface_->level_of.size() - 1);
    }

    Target* surface_;
    std::vector<SharedVertex>* shared_ = nullptr;
    MeshSink<dimension>* mesh_ = nullptr;
    SimplexSink<dimension>* soup_ = nullptr;
    std::size_t chunk_ = std::numeric_limits<std::size_t>::max();
    Number taken_ = 0;  // vertices that the sink has
    bool shares_vertices_ = true;
    bool elements_;
    bool takes_batches_ = false;
};

}  // namespace nestgrid::engine
