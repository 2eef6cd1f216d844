// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an isosurface is drawn by while the hierarchy is traversed; included by isosurface.hpp,
// which says what holds of it.
//
// Grids whose elements stop without conforming are walked twice: first what the finer sides draw on
// closed faces is recorded (transition_contours.hpp), then everything is drawn. Where it is known
// that nothing is finer than an element, it is drawn in the first walk, and the second one enters
// only what leads to the others.
#pragma once

#include <limits>
#include <memory>
#include <mutex>

#include <nestgrid/algorithms/block_drawing.hpp>
#include <nestgrid/algorithms/contour_filling.hpp>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/frontier.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/node_gradients.hpp>
#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/algorithms/subtree_vertices.hpp>
#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/algorithms/surface_part.hpp>
#include <nestgrid/algorithms/transition_contours.hpp>
#include <nestgrid/algorithms/vertex_numbers.hpp>
#include <nestgrid/table.hpp>
#include <nestgrid/shape_functions.hpp>

namespace nestgrid::detail {

struct Cancelled {};
struct OverLimit {};

template <class Grid>
struct ContourOwner {
    ElementOf<Grid> element;
    Shape shape;
    int level;
};

/// Draws the level sets of several isovalues in one traversal; each has a sink of its own.
template <class Grid, class Field, class S, class Indicator, class Sink>
class IsosurfaceVisitor {
public:
    static constexpr Needs needs{.keys = true, .positions = true, .closed = true};
    static constexpr int dimension = Grid::dimension;
    static constexpr bool indexed = IndexedSink<Sink>;
    using Walk = Traversal<Grid, Field, needs>;
    using State = typename Walk::State;
    using Real = typename State::Real;
    static constexpr Shape simplex_shape = dimension == 2 ? Shape::triangle : Shape::tetrahedron;
    static constexpr bool knows_bisections =
        KnowsBisections<Grid, Field> && State::components == 1;
    static constexpr bool is_erased = requires(const Grid& grid, const Field& field) {
        field.bisects(grid);
    };
    static constexpr std::size_t attribute_count = State::components - 1;
    using Number = std::uint32_t;
    using Element = ElementOf<Grid>;
    using Cut = SurfaceCut<attribute_count>;
    static constexpr bool in_parts = !indexed && SinkInParts<Sink>;
    using Part = SurfacePart<dimension, Element>;
    using TaskSink = std::conditional_t<indexed, SurfaceSink<dimension, Element>,
                                        std::conditional_t<in_parts, Sink,
                                                           SimplexLog<dimension, Element>>>;
    using Task = IsosurfaceVisitor<Grid, Field, S, Indicator, TaskSink>;
    static constexpr bool may_be_task = std::is_same_v<Sink, TaskSink>;

    struct Level {
        double isovalue;
        Sink sink;
        std::uint64_t extracted = 0;
        double error_bound = 0;
    };

    IsosurfaceVisitor(const Walk& walk, std::span<const double> isovalues, std::vector<Sink> sinks,
                      const S& criterion, const Indicator& indicator,
                      const IsosurfaceOptions& options);

    /// Makes it as new for other isovalues, as many as before, and keeps its memory.
    void begin_again(std::span<const double> isovalues, std::vector<Sink>& sinks);

    /// Simplices are counted and nothing is drawn; a sink is asked for that can forget.
    /// \param most the traversal ends with OverLimit where there are more
    void count_only(std::uint64_t most)
        requires requires(Sink& sink) { sink.clear(); }
    {
        counts_only_ = true;
        limit_ = most;
    }
    /// Drawn so far.
    std::uint64_t simplices() const { return drawn_; }

    /// Whether elements may stop without conforming, so that there is something to record.
    bool must_record() const;
    template <class Executor>
    void run(const Executor& executor);

    Decision inspect(const State& s, const Split& split);
    void extract(const State& s);
    /// Where nothing is closed around a leaf it records nothing, and is only counted for a limit.
    bool passes_over_leaves() const { return recording_ && !limited() && finest_ < 0; }
    /// The second time, those that lead to what is not drawn yet.
    NodeMask children_to_enter(const State& s) const {
        if (!finishing_) return ~NodeMask{0};
        const NodeMask* children = enter_->find(s.path);
        return children == nullptr ? 0 : *children;
    }
    /// Caps also lie in leaves no level passes through.
    bool looks_ahead() const { return !options_->cap; }
    NodeMask leaves_of_interest(const Rule& rule, std::span<const Real> values) const;
    void count_leaf(bool of_interest);
    /// What hidden elements would draw on faces around them is recorded all the same.
    bool sees_hidden() const { return recording_; }

    // isosurface_bisections.hpp: simplices that conform, and nothing but triangles asked for.
    bool walks_bisections() const { return bisects_; }
    void walk_bisections(const State& s);
    struct Glance {
        Visit visit;
        Real bound;
    };
    Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside);
    bool glance_at_leaf(Real lo, Real hi) { return of_interest(lo, hi, Real(0), false); }
    template <std::size_t around>
    PackedGlance<Real, around> glance(const PackedElements<Real, around>& e);
    NESTGRID_INLINE void expect(const NodeKey* nodes, std::size_t rows) const {
        for (std::size_t row = 0; row < rows; ++row) {
            const std::span<const NodeKey> eight(nodes + row * most_blocks, pack);
            if constexpr (requires { indicator_->prefetch(eight); }) indicator_->prefetch(eight);
        }
    }
    bool names_edges() const { return indexed && !counts_only_; }
    void begin_subtrees(std::uint32_t numbers)
        requires(indexed)
    {
        for (Layer& layer : layers_) layer.within.begin_again(numbers);
    }
    template <class Blocks>
    unsigned extract(const Blocks& blocks, const BatchSelection& selection);
    void tick(std::uint64_t calls, std::uint64_t visited) const;
    void count(std::uint64_t calls, std::uint64_t visited);

    // What a Frontier asks for.
    Decision look(const State& s, const Split& split);
    void undo();
    void restart();

    /// What is known beside surface i.
    template <class Result>
    void report(std::size_t i, Result& result) const {
        result.counts = finishing_ ? all_counts_ : counts_;
        result.counts.extracted = layers_[i].extracted;
        result.error_bound = layers_[i].error_bound;
        result.table_bytes = table_bytes();
        result.stack_bytes = static_cast<std::size_t>(deepest_ + 1) * sizeof(State);
    }

private:
    friend class ContourFilling<IsosurfaceVisitor>;
    template <class, class>
    friend class BlockDrawing;
    template <class, class, class, class, class>
    friend class IsosurfaceVisitor;

    using Transitions = TransitionContours<Cut, ContourOwner<Grid>>;
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
    using VertexName = std::conditional_t<indexed, VertexNumbers::Name, Nothing>;
    static constexpr Number none = std::numeric_limits<Number>::max();

    // isosurface_steps.hpp
    void set_isovalues();
    std::size_t table_bytes() const;
    void count_simplices(std::size_t more) {
        drawn_ += more;
        if (drawn_ > limit_) throw OverLimit{};
    }
    bool limited() const { return limit_ != std::numeric_limits<std::uint64_t>::max(); }
    unsigned pattern(const Real* value, std::size_t corners, const Layer& layer) const;
    bool joined(const State& s, const FaceTopology& face) const;
    static FaceTopology loop_of(const State& s, std::size_t face);
    void load(const State& s, bool draws);
    void add_error(const State& s, Layer& layer) const;
    void forget_drawn(Layer& layer);
    void begin_drawing();
    void draw(const State& s, unsigned pattern, unsigned joins);

    // isosurface_inspection.hpp
    bool of_interest(Real lo, Real hi, Real bound, bool also_below) const;
    template <class Number>
    static Real as_real(Number bound) {
        if constexpr (sizeof(Number) <= sizeof(Real)) return bound;
        return float_above(bound);
    }
    Real bound_of(std::span<const NodeKey> nodes) const;
    Real bound_of(const Split& split) const;

    // isosurface_transitions.hpp
    void record(const State& s, Layer& layer, unsigned pattern);
    unsigned recorded_faces(const State& s, const Layer& layer, unsigned pattern);
    unsigned choose(const State& s, Layer& layer, unsigned pattern, unsigned alternating);
    bool adopt(const State& s, Layer& layer, std::size_t on, std::size_t side, unsigned signs,
               bool& is_joined);
    void fill_gaps(Layer& layer);
    void leave_for_later(const State& s);

    // isosurface_bisections.hpp
    bool knows_bisections_of_grid() const;

    // isosurface_plain.hpp
    const ContourTable& contours_of(Shape shape);
    const Contour* plain_contour(Shape shape, unsigned bits);
    static std::size_t simplices_of(const ContourLoop& loop);
    static std::size_t simplices_of(const Contour& contour);
    void draw_plainly(const State& s, Layer& layer, const Contour* contour, unsigned bits);
    NESTGRID_NOINLINE Vertex add_closed(const State& s, std::uint8_t edge, const VertexName& name);
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
    void for_each_cap_polygon(const State& s, unsigned pattern, Function&& function) const;
    void record_cap(const State& s, Layer& layer, unsigned pattern);
    void draw_cap(const State& s, Layer& layer, unsigned pattern);
    std::vector<Number> cap_chain(const State& s, Layer& layer, const FaceTopology& face,
                                  const CapPolygon& polygon, std::size_t side);
    NodeKey side_key(const State& s, std::uint8_t edge, const FaceTopology& face, std::uint8_t from,
                     bool forward) const;

    // isosurface_vertices.hpp: cuts, vertices, and what ContourFilling asks
    KeyPair name(const State& s, std::uint8_t edge) const;
    Cut make_cut(const State& s, const Layer& layer, std::uint8_t edge) const;
    Cut make_node(const State& s, std::size_t corner) const;
    template <class Make>
    Vertex add(const KeyPair& name, Make&& make);
    template <class Make>
    Vertex add_named(const VertexName& name, Make&& make);
    Number add_new(const Cut& cut);
    void verify(const Layer& layer, Number number, const Point& x) const;
    Vertex add_unnamed(const Point& x, std::span<const double> attributes);
    void add_unnamed(std::span<const Point> x, std::span<const double> attributes);
    Number number_of(const Vertex& vertex, const Point& reference);
    Number vertex(std::uint8_t edge);
    Number node_vertex(std::size_t corner);
    Number recorded(Number index, const FaceTopology& face);
    std::span<const Number> chain(std::uint8_t edge) const;
    bool chained() const { return chained_ != 0; }
    Point position(Number local) const;
    bool wants_reference() const { return options_->reference || attribute_count > 0; }
    std::array<double, attribute_count> attributes_at(const Point& reference) const;
    Number middle(std::span<const Number> of);
    Number inside(const Point& reference);
    void triangle(Number a, Number b, Number c);
    void simplex(const std::array<Number, static_cast<std::size_t>(dimension)>& locals);
    void put_simplex(const std::array<Vertex, static_cast<std::size_t>(dimension)>& v,
                     std::span<const Point> reference);
    void add_area(const std::array<Vertex, static_cast<std::size_t>(dimension)>& v);
    void add_boundary(const std::array<Number, static_cast<std::size_t>(dimension - 1)>& locals);

    // isosurface_normals.hpp
    void load_gradients(const State& s);
    std::array<Point, max_corners> own_gradients(const State& s) const;
    Point projected_gradient(const State& s, std::size_t corner) const;
    Point node_gradient(const State& father, const Rule& rule, std::size_t node) const;
    void add_gradient(Number slot, const CornerGradient& g);
    void set_normals(Layer& layer);

    // isosurface_tasks.hpp
    template <class Executor>
    void walk(const Executor& executor);
    std::unique_ptr<Task> begin_task();
    void add_task(Task& task);
    void add_part(Layer& layer, const Part& part);

    const Walk* walk_;
    const S* criterion_;
    const Indicator* indicator_;
    const IsosurfaceOptions* options_;
    std::vector<double> isovalues_;
    bool plainly_ = false;  // nothing but vertices and triangles is asked for
    bool bisects_ = false;  // and bisections are known at compile time
    bool is_task_ = false;  // draws parts_
    bool counts_only_ = false;
    std::array<const ContourTable*, shape_count> table_{};
    std::vector<Layer> layers_;
    decltype(packed_criterion(std::declval<const S&>())) packed_criterion_;
    TraversalCounts counts_;
    TraversalCounts all_counts_;  // of the first walk, where it meets everything
    bool recording_ = false;      // the first walk of two
    bool finishing_ = false;      // the second one, where the first one has drawn what it could
    std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t drawn_ = 0;   // simplices
    std::uint64_t later_ = 0;   // elements that are recorded and drawn later, one simplex at least
    int finest_ = -1;           // level on which no element has a finer neighbour; -1: not known
    Paths later_below_;         // paths of what lies above those elements, or is a coarse one
    const Paths* enter_ = nullptr;  // those of all tasks
    Real element_bound_ = 0;    // of the element inspected last
    int deepest_ = 0;
    NodeGradients gradients_;
    std::vector<std::pair<Number, CornerGradient>> gradient_log_;  // of a task
    std::vector<Part> parts_;                                      // likewise, one per layer
    struct {
        std::mutex mutex;
        std::vector<std::unique_ptr<Task>> tasks;  // whose memory is free to be used
        IsosurfaceOptions silent;                  // of theirs: options_ without progress
    } idle_;

    // The element being drawn; state_ is null while gaps are filled.
    const State* state_ = nullptr;
    Layer* layer_ = nullptr;
    bool loaded_ = false;
    bool begun_ = false;
    std::array<NodeKey, max_corners> key_{};
    std::array<Point, max_corners> x_{};
    std::array<double, max_corners> u_{};  // U - C at the corners
    std::vector<Vertex> local_;            // its vertices, by number
    std::vector<Point> reference_;         // where they lie in it, where wanted
    std::array<Number, State::Closed::edges> on_edge_{};
    std::array<Number, max_corners> on_corner_{};
    unsigned recorded_ = 0;      // cut faces on which a finer side recorded something, one bit each
    std::array<Number, max_faces> on_face_{};  // what, by face
    std::vector<Number> between_;
    std::uint16_t chained_ = 0;  // edges with a chain behind them
    std::array<std::vector<Number>, State::Closed::edges> chain_;
};

}  // namespace nestgrid::detail

#include <nestgrid/algorithms/isosurface_steps.hpp>
