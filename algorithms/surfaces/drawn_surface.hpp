// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The surface of one level while it is drawn.
#pragma once

#include <deque>

#include <surfaces/node_gradients.hpp>
#include <surfaces/subtree_vertices.hpp>
#include <surfaces/surface_builder.hpp>
#include <surfaces/vertex_numbers.hpp>

namespace nestgrid {

class Ranks;
struct VertexCopy;

}  // namespace nestgrid

namespace nestgrid::engine {

class SharedNodes;

/// How the vertices of a surface get their normals.
struct VertexNormals {
    NodeGradients* gradients = nullptr;  ///< at nodes, between which they are interpolated; or null
    bool with_vertices = false;          ///< add_normal() is called for each new vertex
};

/// Counts and bounds of a surface while it is drawn.
struct DrawnReport {
    std::uint64_t extracted = 0;  ///< elements that contribute to the surface
    std::uint64_t limited = 0;    ///< of these: kept from being divided by a limit
    double error_bound = 0;       ///< of |U - level| on the surface
    double off_level = 0;         ///< of |P_S U - level| at the vertices on edges
    double leaf_error = 0;        ///< of |U - level| in leaves, as flat as without a criterion
    double position_bound = 0;    ///< of how far vertices are from their true positions

    void raise_error_bound(double bound) { error_bound = std::max(error_bound, bound); }
    void raise_off_level(double off) { off_level = std::max(off_level, std::abs(off)); }
    void raise_leaf_error(double bound) { leaf_error = std::max(leaf_error, bound); }
    void raise_position_bound(double bound) { position_bound = std::max(position_bound, bound); }
    /// Adds those of a part.
    void add(const DrawnReport& part) {
        extracted += part.extracted;
        limited += part.limited;
        raise_error_bound(part.error_bound);
        raise_off_level(part.off_level);
        raise_leaf_error(part.leaf_error);
        raise_position_bound(part.position_bound);
    }
};

/// Names vertices, numbers those that are new, and hands them and the simplices to a builder. A
/// vertex with a known name gets the number it has, where the builder shares vertices; else every
/// vertex is new.
template <int dimension>
class DrawnSurface {
public:
    using Builder = SurfaceBuilder<dimension>;
    using Simplex = typename Surface<dimension>::Simplex;
    using Number = std::uint32_t;
    using Name = VertexNumbers::Name;
    static constexpr Number none = std::numeric_limits<Number>::max();

    /// \param node_count number of dense node keys; 0 where keys are not dense
    DrawnSurface(Builder builder, std::size_t node_count)
        : builder_{std::move(builder)},
          numbers_{node_count > 0 && std::uint64_t{node_count} <= std::uint64_t{1} << 32U} {}

    /// Keeps the names of vertices, which then stand for them on other ranks (find_copies()). To be
    /// called after begin().
    /// \param rank this one
    void keep_names(int rank) {
        keeps_names_ = true;
        rank_ = rank;
    }
    /// Begins an empty surface, and keeps its memory.
    void begin(Builder builder, const VertexNormals& normals, bool verify);
    /// Does not complete normals, because another DrawnSurface does so for this part.
    void leave_normals() {
        keeps_names_ = false;
        normals_.gradients = nullptr;
        keeps_simplices_ = false;
    }
    /// Only counts from now on. The caller must drop simplices by forget_element().
    void count_only() {
        counts_only_ = true;
        keeps_names_ = false;
    }
    bool counts_only() const { return counts_only_; }
    void forget_element() { builder_.clear(); }

    Builder& builder() { return builder_; }
    const Builder& builder() const { return builder_; }
    SubtreeVertices& within() { return within_; }
    VertexNumbers& numbers() { return numbers_; }
    bool verifies() const { return verifies_; }

    /// Whether vertices have names.
    bool names_vertices() const { return builder_.shares_vertices() && !counts_only_; }
    /// Forgets the names of all vertices, and frees their memory: behind the last named one.
    void free_names() {
        numbers_.free_memory();
        within_ = {};
    }
    Name name(const KeyPair& nodes) const { return numbers_.name(nodes); }
    /// Fetches what vertex(name) reads into the cache.
    void prefetch(const Name& name) const { numbers_.prefetch(name); }

    /// The vertex with a name; make() returns its SurfaceCut where it is new.
    /// \throw GridError where vertices are verified and make() puts a known one elsewhere
    template <class Make>
    NESTGRID_INLINE Number vertex(const Name& name, Make&& make) {
        bool is_new = false;
        const Number number = numbers_.find(name, [&] {
            is_new = true;
            return add(make());
        });
        if (verifies_ && !is_new) verify(number, make().x);
        return number;
    }
    /// The vertex between two nodes, which is new where vertices have no names.
    template <class Make>
    Number vertex_between(const KeyPair& nodes, Make&& make) {
        return names_vertices() ? vertex(name(nodes), make) : add(make());
    }
    /// Adds a vertex on an edge.
    Number add(const SurfaceCut& cut);
    /// Adds vertices without names: inside one element, or of one task alone. \return the first one
    NESTGRID_INLINE Number add_unnamed(std::span<const Point> x,
                                       std::span<const double> attributes) {
        const Number first = builder_.next_vertex();
        if (none - first < x.size()) throw_too_many_vertices();
        if (normals_.gradients != nullptr) {
            where_.resize(where_.size() + x.size(), {none, none, 0.0});
        }
        builder_.add_vertices(x, attributes);
        if (keeps_names_) [[unlikely]]
            name_as_own(first, x.size());
        return first;
    }
    /// \throw GridError where a vertex lies elsewhere
    void verify(Number number, const Point& x) const;
    Point position(Number number) const { return builder_.position(number); }

    NESTGRID_INLINE void add_simplex(const Simplex& corners, std::span<const Point> reference) {
        builder_.add_simplex(corners, reference);
        if (keeps_simplices_) simplices_.push_back(corners);
    }
    /// Adds the normal of a new vertex, in the order of the vertices.
    /// \param gradient of the data there
    NESTGRID_INLINE void add_normal(const Point& gradient) {
        of_vertices_.push_back(short_normal(gradient));
    }
    /// Appends a part. Numbers its vertices in their order; those that earlier parts have keep
    /// their numbers.
    /// \param drawn what the part was drawn by, where this says more of vertices than the part
    /// \return the numbers that the vertices of the part have here, where elements share vertices
    std::vector<Number> add_part(const SurfacePart<dimension>& part,
                                 const DrawnSurface* drawn = nullptr);

    /// Whether it was noted that a vertex lies at a node.
    bool is_at_node(Number vertex) const {
        return vertex < is_at_node_.size() && is_at_node_[vertex];
    }
    /// Notes that a vertex lies at a node, unless this is known.
    void put_at_node(Number vertex, const NodePlace& node, std::span<const double> attributes) {
        if (is_at_node(vertex)) return;
        if (is_at_node_.size() <= vertex) is_at_node_.resize(vertex + std::size_t{1}, false);
        is_at_node_[vertex] = true;
        at_nodes_.add(vertex, node, attributes);
    }
    const VerticesAtNodes& at_nodes() const { return at_nodes_; }

    /// Counts and bounds of what was drawn.
    DrawnReport& report() { return report_; }
    const DrawnReport& report() const { return report_; }

    /// Takes the elements counted and the bounds of all ranks together. Collective.
    void agree(Ranks& ranks);

    /// Makes the normals, and merges the vertices at each node (merge_at_nodes.hpp), as far as each
    /// is wanted. Requires that everything is drawn; merging requires a surface of triangles.
    /// Collective where the grid is distributed, which requires keep_names().
    /// \param shared the nodes that other ranks have, too, or null
    void finish(bool merges_at_nodes, const SharedNodes* shared);
    /// The names of all vertices, after finish(); nothing where they were not kept.
    std::vector<std::array<NodeKey, 2>> vertex_names() const {
        std::vector<std::array<NodeKey, 2>> names;
        names.reserve(names_.size());
        for (const KeyPair& name : names_) names.push_back({name.low, name.high});
        return names;
    }
    std::size_t memory_bytes() const {
        return numbers_.memory_bytes() + within_.memory_bytes() + where_.size() * sizeof(Where) +
               of_vertices_.capacity() * sizeof(Normal) + simplices_.size() * sizeof(Simplex) +
               at_nodes_.node.capacity() * sizeof(NodePlace) + names_.capacity() * sizeof(KeyPair);
    }

private:
    struct Where {  // slots of the nodes that a vertex lies between; none inside an element
        Number low;
        Number high;
        double fraction;
    };
    using Normal = std::array<float, 3>;

    void name_as_own(Number first, std::size_t count);
    /// A gradient as a normal of unit length, rounded to floats; 0 where the gradient is 0. All
    /// ways to draw round normals by this, so that they have the same bits.
    NESTGRID_INLINE static Normal short_normal(const Point& gradient) {
        const double length = norm(gradient);
        const double scale = length > 0 ? -1 / length : 0;
        return {static_cast<float>(scale * gradient[0]), static_cast<float>(scale * gradient[1]),
                static_cast<float>(scale * gradient[2])};
    }
    bool makes_normals() const { return normals_.gradients != nullptr || normals_.with_vertices; }
    Point gradient_at(const Where& where) const;
    std::vector<Point> normals_from_gradients() const;
    std::vector<Point> normals_of_vertices() const;
    void settle(std::vector<Point>& normals, const SharedNodes* shared) const;
    void share(std::vector<Point>& normals, std::span<const VertexCopy> copies,
               const SharedNodes& shared) const;
    void merge_at_nodes(const SharedNodes* shared);

    Builder builder_;
    VertexNumbers numbers_;
    SubtreeVertices within_;  // vertices in subtrees of bisections
    VertexNormals normals_;
    std::deque<Where> where_;          // by vertex, where normals are interpolated between nodes
    std::vector<Normal> of_vertices_;  // by vertex, where they come with vertices
    VerticesAtNodes at_nodes_;
    std::vector<bool> is_at_node_;   // by vertex: whether it is among at_nodes_
    std::vector<KeyPair> names_;     // by vertex, where they are kept
    std::deque<Simplex> simplices_;  // all of them, where a sink takes them and normals are wanted
    DrawnReport report_;
    int rank_ = 0;
    bool keeps_names_ = false;
    bool keeps_simplices_ = false;
    bool verifies_ = false;
    bool counts_only_ = false;
};

}  // namespace nestgrid::engine
