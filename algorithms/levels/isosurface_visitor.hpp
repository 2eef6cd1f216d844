// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws level sets while a hierarchy is traversed; isosurface.hpp says what holds of the result.
//
// Grids whose elements stop without conforming are walked twice. The first walk records what finer
// sides draw on closed faces (transition_contours.hpp), the second one draws. Elements that cannot
// have a finer neighbour are drawn in the first walk already, and the second one enters only what
// leads to the others.
#pragma once

#include <limits>
#include <memory>
#include <mutex>
#include <vector>

#include <contours/transition_contours.hpp>
#include <indicators/packed_entries.hpp>
#include <nestgrid/algorithms/contour_filling.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/erased_bisections.hpp>
#include <nestgrid/shape_functions.hpp>
#include <patches/block_drawing.hpp>
#include <patches/subtree_vertices.hpp>
#include <surfaces/node_gradients.hpp>
#include <surfaces/soup_builder.hpp>
#include <surfaces/surface_builder.hpp>
#include <surfaces/vertex_numbers.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

/// Thrown where options.progress ends a walk.
struct Cancelled {};
/// Thrown where more simplices are counted than the limit.
struct OverLimit {};

/// Draws the level sets of several isovalues in one traversal; each has a builder of its own.
template <int dimension, class Real, bool indexed>
class IsosurfaceVisitor final : public TaskVisitor<Real> {
public:
    using Value = Real;
    using View = ElementView<Real>;
    using Builder = std::conditional_t<indexed, SurfaceBuilder<dimension>, SoupBuilder<dimension>>;
    using Part = std::conditional_t<indexed, SurfacePart<dimension>, Soup<dimension>>;
    using Number = std::uint32_t;
    using Cut = SurfaceCut;
    static constexpr Shape simplex_shape = dimension == 2 ? Shape::triangle : Shape::tetrahedron;
    /// What the walk must carry.
    static constexpr Needs needs{.values = true, .keys = true, .positions = true, .closed = true};

    struct Level {
        double isovalue;
        Builder sink;
        std::uint64_t extracted = 0;
        double error_bound = 0;
    };

    /// All arguments are borrowed but the builders, of which there is one for each isovalue.
    IsosurfaceVisitor(const Walk<Real>& walk, std::span<const double> isovalues,
                      std::vector<Builder> sinks, const Criterion& criterion, const Bounds& bounds,
                      const IsosurfaceOptions& options);

    /// Makes the visitor as new for other isovalues, as many as before, and keeps its memory.
    void begin_again(std::span<const double> isovalues, std::vector<Builder>& sinks,
                     const Criterion& criterion);

    /// Counts simplices and draws nothing.
    /// \param most the traversal ends with OverLimit where there are more
    void count_only(std::uint64_t most) {
        counts_only_ = true;
        limit_ = most;
    }
    /// Number of simplices drawn so far.
    std::uint64_t simplices() const { return drawn_; }

    /// Whether elements may stop without conforming, so that there is something to record.
    bool must_record() const;
    /// Draws everything.
    /// \throw Cancelled, OverLimit, and what the grid, the field and the sinks throw
    void run(const Executor& executor);
    /// Hands all that is drawn to the sinks, also where a walk was cancelled.
    void flush() {
        for (Layer& layer : layers_) layer.sink.flush();
    }

    Decision inspect(const View& s, const Split& split) override;
    void extract(const View& s) override;
    /// The second walk enters the children that lead to what is not drawn yet.
    NodeMask children(const View& s) override {
        if (!finishing_) return ~NodeMask{0};
        const NodeMask* children = enter_->find(s.path);
        return children == nullptr ? 0 : *children;
    }
    Leaves leaves(const Rule& rule, const Real* values, NodeMask which, bool closed) override;
    /// The contours that hidden elements would draw on faces around them are recorded all the same.
    bool sees_hidden() const override { return recording_; }
    /// Simplices that conform are walked in blocks, where nothing but triangles is asked for.
    bool takes(const View& s) override;

    Decision look(const View& s, const Split& split) override;
    void undo() override;
    void restart() override;

    // What the walk in blocks asks for.
    struct Glance {
        Visit visit;
        Real bound;
    };
    Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside);
    bool glance_at_leaf(Real lo, Real hi) { return of_interest(lo, hi, Real(0), false); }
    template <std::size_t around>
    PackedGlance<Real, around> glance(const PackedElements<Real, around>& e);
    NESTGRID_INLINE void expect(const NodeKey* nodes, std::size_t rows) const {
        if (entries_ == nullptr) return;
        for (std::size_t row = 0; row < rows; ++row) {
            prefetch(*entries_, std::span<const NodeKey>(nodes + row * most_blocks, pack));
        }
    }
    bool names_edges() const { return indexed && !counts_only_; }
    void begin_subtrees(std::uint32_t numbers) {
        for (Layer& layer : layers_) layer.within.begin_again(numbers);
    }
    template <class Blocks>
    unsigned extract(const Blocks& blocks, const BatchSelection& selection);
    void tick(std::uint64_t calls, std::uint64_t visited) const;
    void count(std::uint64_t calls, std::uint64_t visited);

    /// What is known beside surface i.
    template <class Result>
    void report(std::size_t i, Result& result) const {
        result.counts = finishing_ ? all_counts_ : counts_;
        result.counts.extracted = layers_[i].extracted;
        result.error_bound = layers_[i].error_bound;
        result.table_bytes = table_bytes();
        result.stack_bytes = static_cast<std::size_t>(deepest_ + 1) * sizeof(View);
    }

private:
    friend class ContourFilling<IsosurfaceVisitor>;
    template <class, class>
    friend class BlockDrawing;

    using Transitions = TransitionContours;
    struct Where {  // the nodes a vertex lies between, for its normal
        Number low;
        Number high;
        double fraction;
        Point around{0, 0, 0};  // area vectors of the triangles at it
    };
    using Paths = KeyTable<NodeKey, NodeMask>;  // and children to enter below them
    struct Layer : Level {
        Real least_inside = 0;  // of the numbers that values can be
        Real greatest_outside = 0;
        VertexNumbers number_of;
        SubtreeVertices within{};  // subtrees of bisections
        Transitions transitions{};
        const Transitions* drawn_below = nullptr;  // that of all tasks
        std::vector<Where> where{};
        Number vertex_count = 0;
        std::array<MaskOf<Real>, 2 * most_blocks> signs{};  // of what is in a batch
        Pack<Real> packed_least_inside{};
        Pack<Real> packed_greatest_outside{};
    };
    using Vertex = std::conditional_t<indexed, Number, Point>;
    struct Unnamed {};
    using VertexName = std::conditional_t<indexed, VertexNumbers::Name, Unnamed>;
    static constexpr Number none = std::numeric_limits<Number>::max();

    // isosurface_steps.hpp
    void set_isovalues(const Criterion& criterion);
    std::size_t table_bytes() const;
    void count_simplices(std::size_t more) {
        drawn_ += more;
        if (drawn_ > limit_) throw OverLimit{};
    }
    bool limited() const { return limit_ != std::numeric_limits<std::uint64_t>::max(); }
    unsigned pattern(const Real* value, std::size_t corners, const Layer& layer) const;
    void extract(const View& s, Layer& layer, unsigned bits, unsigned boundary, bool draws);
    bool joined(const View& s, const FaceTopology& face) const;
    static FaceTopology loop_of(const View& s, std::size_t face);
    void load(const View& s, bool draws);
    void add_error(const View& s, Layer& layer) const;
    void forget_drawn(Layer& layer);
    void begin_drawing();
    void draw(const View& s, unsigned pattern, unsigned joins);

    // isosurface_inspection.hpp
    bool of_interest(Real lo, Real hi, Real bound, bool also_below) const;
    static Real as_real(double bound) {
        if constexpr (sizeof(Real) == sizeof(double)) return bound;
        return float_above(bound);
    }
    Real bound_of(const Rule& rule, std::span<const NodeKey> nodes) const;
    NodeMask holds(const NewNodes& nodes) const;
    NodeMask leaves_of_interest(const Rule& rule, const Real* values, NodeMask which) const;
    NodeMask cut_children(const Rule& rule, const Real* values, Real least_inside) const;

    // isosurface_transitions.hpp
    void record(const View& s, Layer& layer, unsigned pattern);
    unsigned recorded_faces(const View& s, const Layer& layer, unsigned pattern);
    unsigned choose(const View& s, Layer& layer, unsigned pattern, unsigned alternating);
    bool adopt(const View& s, Layer& layer, std::size_t on, std::size_t side, unsigned signs,
               bool& is_joined);
    void fill_gaps(Layer& layer);
    void leave_for_later(const View& s);

    // isosurface_plain.hpp
    const ContourTable& contours_of(Shape shape);
    const Contour* plain_contour(Shape shape, unsigned bits);
    static std::size_t simplices_of(const ContourLoop& loop);
    static std::size_t simplices_of(const Contour& contour);
    void draw_plainly(const View& s, Layer& layer, const Contour* contour, unsigned bits);
    NESTGRID_NOINLINE Vertex add_closed(const View& s, std::uint8_t edge, const VertexName& name);
    template <class Vertices>
    void put_triangle(const Vertices& v, const std::array<std::size_t, 3>& corner, bool mirrored);
    template <class Vertices>
    void put_loop(const Vertices& v, std::size_t count, bool mirrored);
    template <class Vertices, class Faces>
    void put_boundary(const Vertices& v, std::size_t count, const Faces& face, unsigned boundary);

    // isosurface_cap.hpp
    struct CapPoint {  // a corner of a polygon: corner `from` of the face, or its cut side `from`
        std::uint8_t from;
        bool cut;
    };
    struct CapPolygon {  // sides from each point to the next
        std::size_t count = 0;
        std::array<CapPoint, 8> point;
        std::array<std::uint8_t, 8> edge;  // of the element, under a side; or no_edge
    };
    template <class Function>
    void for_each_cap_polygon(const View& s, unsigned pattern, Function&& function) const;
    void record_cap(const View& s, Layer& layer, unsigned pattern);
    void draw_cap(const View& s, Layer& layer, unsigned pattern);
    std::vector<Number> cap_chain(const View& s, Layer& layer, const FaceTopology& face,
                                  const CapPolygon& polygon, std::size_t side);
    NodeKey side_key(const View& s, std::uint8_t edge, const FaceTopology& face, std::uint8_t from,
                     bool forward) const;

    // isosurface_vertices.hpp: cuts, vertices, and what ContourFilling asks
    KeyPair name(const View& s, std::uint8_t edge) const;
    Cut make_cut(const View& s, const Layer& layer, std::uint8_t edge) const;
    Cut make_node(const View& s, std::size_t corner) const;
    template <class Make>
    Vertex add(const KeyPair& name, Make&& make);
    template <class Make>
    Vertex add_named(const VertexName& name, Make&& make);
    Number add_new(const Cut& cut);
    void verify(const Layer& layer, Number number, const Point& x) const requires(indexed);
    Vertex add_unnamed(const Point& x, std::span<const double> attributes);
    void add_unnamed(std::span<const Point> x, std::span<const double> attributes);
    Number number_of(const Vertex& vertex, const Point& reference);
    Number vertex(std::uint8_t edge);
    Number node_vertex(std::size_t corner);
    Number recorded(Number index, const FaceTopology& face);
    std::span<const Number> chain(std::uint8_t edge) const;
    bool chained() const { return chained_ != 0; }
    Point position(Number local) const;
    bool wants_reference() const { return options_->reference || attribute_count_ > 0; }
    std::span<const double> attributes_at(const Point& reference) const;
    Number middle(std::span<const Number> of);
    Number inside(const Point& reference);
    void triangle(Number a, Number b, Number c);
    void simplex(const std::array<Number, static_cast<std::size_t>(dimension)>& locals);
    void put_simplex(const std::array<Vertex, static_cast<std::size_t>(dimension)>& v,
                     std::span<const Point> reference);
    void add_area(const std::array<Vertex, static_cast<std::size_t>(dimension)>& v);
    void add_boundary(const std::array<Number, static_cast<std::size_t>(dimension - 1)>& locals);

    // isosurface_normals.hpp
    void load_gradients(const View& s);
    std::array<Point, max_corners> own_gradients(const View& s) const;
    Point projected_gradient(const View& s, std::size_t corner) const;
    Point node_gradient(const View& father, const Rule& rule, std::size_t node) const;
    void add_gradient(Number slot, const CornerGradient& g);
    void set_normals(Layer& layer) requires(indexed);

    // isosurface_tasks.hpp
    void walk(const Executor& executor);
    std::unique_ptr<IsosurfaceVisitor> begin_task();
    void add_task(IsosurfaceVisitor& task);
    void add_part(Layer& layer, const SurfacePart<dimension>& part) requires(indexed);

    const Walk<Real>* walk_;
    const Criterion* criterion_ = nullptr;
    const Bounds* bounds_;
    const HierarchicalIndicator* own_bounds_;  // where the bounds are the library's own
    const detail::IndicatorEntries* entries_;  // theirs
    const IsosurfaceOptions* options_;
    std::size_t components_;
    std::size_t attribute_count_;
    bool own_gradients_;  // of the field
    std::vector<double> isovalues_;
    const Threshold* own_threshold_ = nullptr;  // where the criterion is one of own_bounds_
    Pack<float> packed_threshold_{};
    bool records_ = false;  // there is something to record
    bool plainly_ = false;  // nothing but vertices and triangles is asked for
    bool bisects_ = false;  // and bisections are walked in blocks
    bool is_task_ = false;  // draws parts_
    bool counts_only_ = false;
    std::array<const ContourTable*, shape_count> table_{};
    std::vector<Layer> layers_;
    TraversalCounts counts_;
    TraversalCounts all_counts_;  // of the first walk, where it meets everything
    bool recording_ = false;      // the first walk of two
    bool finishing_ = false;      // the second one, where the first one has drawn what it could
    std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t drawn_ = 0;  // simplices
    std::uint64_t later_ = 0;  // elements that are recorded and drawn later, one simplex at least
    int finest_ = -1;          // level on which no element has a finer neighbour; -1: not known
    Paths later_below_;        // paths of what lies above those elements, or is a coarse one
    const Paths* enter_ = nullptr;  // those of all tasks
    Real element_bound_ = 0;        // of the element inspected last
    int deepest_ = 0;
    NodeGradients gradients_;
    std::vector<std::pair<Number, CornerGradient>> gradient_log_;  // of a task
    std::vector<Part> parts_;                                      // likewise, one per layer
    struct {
        std::mutex mutex;
        std::vector<std::unique_ptr<IsosurfaceVisitor>> tasks;  // whose memory is free to be used
        IsosurfaceOptions silent;                               // options_ without progress
    } idle_;

    // The element being drawn; state_ is null while gaps are filled.
    const View* state_ = nullptr;
    Layer* layer_ = nullptr;
    bool loaded_ = false;
    bool begun_ = false;
    std::array<NodeKey, max_corners> key_{};
    std::array<Point, max_corners> x_{};
    std::array<double, max_corners> u_{};  // U - C at the corners
    std::vector<Vertex> local_;            // its vertices, by number
    std::vector<Point> reference_;         // where they lie in it, where wanted
    std::array<Number, max_edges> on_edge_{};
    std::array<Number, max_corners> on_corner_{};
    unsigned recorded_ = 0;  // cut faces on which a finer side recorded something, one bit each
    std::array<Number, max_faces> on_face_{};  // what, by face
    std::vector<Number> between_;
    std::uint16_t chained_ = 0;  // edges with a chain behind them
    std::array<std::vector<Number>, max_edges> chain_;
    mutable std::vector<double> attributes_;  // of the cut made last
};

}  // namespace nestgrid::engine
