// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Adaptive isosurfaces (isolines in two dimensions) on any shapes (paper, sections 3, 4.4 and 8).
//
// Invariants:
//   - a node is inside where P_S U >= C; an edge is cut where its ends differ, from its lower to
//     its higher value, at a fraction kept in [2^-20, 1 - 2^-20] of its maximal edge;
//   - a vertex is named by the keys of the two nodes of the maximal edge it cuts;
//   - the contour on a face is a function of the face alone, or what the finer side draws there.
// Consequences, with a saturated criterion: every edge of the surface belongs to two triangles, or
// to one on the boundary of the domain; shared vertices are equal to the last bit; values equal to
// C are no special case, and no triangle degenerates to a point. The proof:
// docs/closed_surfaces.md.
//
// Grids whose elements stop without conforming are walked twice: first what the finer sides draw on
// closed faces is recorded (transition_contours.hpp), then everything is drawn. Where it is known
// that nothing is finer than an element, it is drawn in the first walk, and the second one enters
// only what leads to the others.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include <nestgrid/algorithms/block_drawing.hpp>
#include <nestgrid/algorithms/contour_filling.hpp>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/frontier.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/node_gradients.hpp>
#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/algorithms/subtree_vertices.hpp>
#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/algorithms/surface_log.hpp>
#include <nestgrid/algorithms/transition_contours.hpp>
#include <nestgrid/algorithms/vertex_numbers.hpp>
#include <nestgrid/table.hpp>
#include <nestgrid/shape_functions.hpp>

namespace nestgrid {

/// How many elements a traversal met.
struct TraversalCounts {
    std::uint64_t calls = 0;      ///< calls of Inspect(): elements looked at
    std::uint64_t visited = 0;    ///< elements that passed the test of interest
    std::uint64_t extracted = 0;  ///< elements that contribute to the surface
};

struct IsosurfaceOptions {
    /// epsilon, in the units of the data: offsets up to it are projected away.
    double threshold = 0;
    /// The largest number of triangles (segments), beside which `threshold` is not used: the least
    /// threshold that keeps within it is found (triangle_budget.hpp). 0 asks for none.
    std::uint64_t max_triangles = 0;
    /// Unit normals from gradients: the field's own where it offers them, else the mean of the
    /// gradients of the extracted elements around a node, weighted by volume.
    bool normals = false;
    /// Close the surface along the boundary of the domain, around the region U >= C.
    bool cap = false;
    /// Keep the extracted elements and which triangle comes from which.
    bool elements = true;
    /// Keep where the corners of each triangle lie in its element, in reference coordinates; not a
    /// number for the few that fill a gap in a face between two directions of refinement.
    bool reference = false;
    /// Compute every shared vertex again from every element and throw a GridError where one bit
    /// differs: finds keys and positions that do not belong together.
    bool verify = false;
    /// Called now and then with the counts so far; returning false ends the traversal.
    std::function<bool(const TraversalCounts&)> progress{};
};

template <int dimension, class Element>
struct Isosurface {
    Surface<dimension, Element> surface;
    TraversalCounts counts;
    /// On every triangle U differs from C by at most this, U being the data interpolated on the
    /// finest grid: what S projected away, and in shapes other than simplices what the flatness of
    /// the triangles adds. Exact as far as triangles lie in their elements, which curved faces of
    /// deformed elements do not quite allow.
    double error_bound = 0;
    bool cancelled = false;       ///< by options.progress; the surface is then a part
    std::size_t table_bytes = 0;  ///< hash tables used while extracting
    std::size_t stack_bytes = 0;  ///< depth of the traversal times the size of one state
};

namespace detail {

struct Cancelled {};
struct OverLimit {};

template <class Sink>
concept IndexedSink = !requires {
    requires !Sink::indexed;
};

template <class Grid>
struct ContourOwner {
    ElementOf<Grid> element;
    Shape shape;
    int level;
};

/// A criterion that is asked for eight nodes at once (criterion.hpp), where it can be.
template <class S>
auto packed_criterion(const S& criterion) {
    if constexpr (requires { criterion.packed(); }) {
        return criterion.packed();
    } else {
        return Nothing{};
    }
}

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
    static constexpr bool logs = requires { requires Sink::logs; };
    static constexpr bool in_parts = !indexed && SinkInParts<Sink>;
    using Log = SurfaceLog<dimension, ElementOf<Grid>, attribute_count, indexed>;
    using TaskSink = std::conditional_t<in_parts, Sink, Log>;
    using Task = IsosurfaceVisitor<Grid, Field, S, Indicator, TaskSink>;

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

    /// Ends the traversal with OverLimit when there are more simplices than that.
    void limit(std::uint64_t simplices) { limit_ = simplices; }
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
    PackedGlance<Real> glance(const PackedElements<Real>& e);
    NESTGRID_INLINE void expect(const NodeKey* nodes) const {
        const std::span<const NodeKey> eight(nodes, pack);
        if constexpr (requires { indicator_->prefetch(eight); }) indicator_->prefetch(eight);
    }
    static constexpr bool names_edges() { return indexed; }
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
    };
    struct PackedLevel {  // of bisections that are looked at eight at once
        Pack<Real> least_inside;
        Pack<Real> greatest_outside;
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
    bool of_interest(Real lo, Real hi, Real bound, bool also_below) const;
    template <class Number>
    static Real as_real(Number bound) {
        if constexpr (sizeof(Number) <= sizeof(Real)) return bound;
        return float_above(bound);
    }
    Real bound_of(std::span<const NodeKey> nodes) const;
    Real bound_of(const Split& split) const;
    bool joined(const State& s, const FaceTopology& face) const;
    static FaceTopology loop_of(const State& s, std::size_t face);
    void load(const State& s, bool draws);
    void add_error(const State& s, Layer& layer) const;
    void begin_drawing();
    void draw(const State& s, unsigned pattern, unsigned joins);

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
    void repeat(Layer& layer, const Log& log);

    const Walk* walk_;
    const S* criterion_;
    const Indicator* indicator_;
    const IsosurfaceOptions* options_;
    std::vector<double> isovalues_;
    bool plainly_ = false;  // nothing but vertices and triangles is asked for
    bool bisects_ = false;  // and bisections are known at compile time
    std::array<const ContourTable*, shape_count> table_{};
    std::vector<Layer> layers_;
    std::vector<PackedLevel> packed_levels_;
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

template <class Grid, class Indicator>
void require_drawable(const Grid& grid, std::span<const double> isovalues,
                      const Indicator& indicator) {
    for (const double isovalue : isovalues) {
        if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
    }
    if (indicator.epoch() != epoch(grid)) {
        throw GridError("the grid has changed since its indicator was computed");
    }
}

/// \return whether options.progress ended it
template <class Visitor, class Executor>
bool run_visitor(Visitor& visitor, const Executor& executor) {
    try {
        visitor.run(executor);
        return false;
    } catch (const Cancelled&) {
        return true;
    }
}

}  // namespace detail

/// The isosurfaces U = isovalues[i] of component 0 of the field under the projection with
/// `criterion`, in one traversal, each into its own sink (surface.hpp).
/// \param indicator of the same grid and field: its bounds guide the search. HierarchicalIndicator,
///        or any class with its offset_bound(), bound(), hanging() and epoch()
/// \return what is known beside the surfaces, one per isovalue; `surface` stays empty
/// \throw GridError where the field has no value, or where the grid has changed since the indicator
///        was computed
/// \throw InvalidInput where an isovalue is not a number or there is not one sink for each; for
///        normals into a sink without indices
/// \param executor of several threads, or of one (executor.hpp); the result does not depend on it
template <class Grid, class Field, Criterion S, class Indicator, class Sink,
          Executor E = SequentialExecutor>
std::vector<Isosurface<Grid::dimension, ElementOf<Grid>>> extract_isosurfaces(
    const Grid& grid, const Field& field, std::span<const double> isovalues,
    std::vector<Sink> sinks, const S& criterion, const Indicator& indicator,
    const IsosurfaceOptions& options = {}, const E& executor = {}) {
    static_assert(Grid::dimension >= 2, "isosurfaces need a grid of dimension 2 or 3");
    detail::require_drawable(grid, isovalues, indicator);
    if (sinks.size() != isovalues.size()) {
        throw InvalidInput(std::to_string(isovalues.size()) +
                           " isovalues need as many sinks, not " + std::to_string(sinks.size()));
    }
    if (!detail::IndexedSink<Sink> && options.normals) {
        throw InvalidInput("a stream of triangles has no normals");
    }
    using Visitor = detail::IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>;
    const typename Visitor::Walk walk(grid, field, indicator.hanging());
    Visitor visitor(walk, isovalues, std::move(sinks), criterion, indicator, options);
    const bool cancelled = detail::run_visitor(visitor, executor);
    std::vector<Isosurface<Grid::dimension, ElementOf<Grid>>> results(isovalues.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
        visitor.report(i, results[i]);
        results[i].cancelled = cancelled;
    }
    return results;
}

/// The same as indexed surfaces.
template <class Grid, class Field, Criterion S, class Indicator, Executor E = SequentialExecutor>
std::vector<Isosurface<Grid::dimension, ElementOf<Grid>>> isosurfaces(
    const Grid& grid, const Field& field, std::span<const double> isovalues, const S& criterion,
    const Indicator& indicator, const IsosurfaceOptions& options = {}, const E& executor = {}) {
    using Sink = SurfaceSink<Grid::dimension, ElementOf<Grid>>;
    std::vector<typename Sink::Target> surfaces(isovalues.size());
    std::vector<Sink> sinks;
    for (auto& surface : surfaces) sinks.emplace_back(surface, options.elements);
    auto results = extract_isosurfaces(grid, field, isovalues, std::move(sinks), criterion,
                                       indicator, options, executor);
    for (std::size_t i = 0; i < results.size(); ++i) results[i].surface = std::move(surfaces[i]);
    return results;
}

/// One isosurface.
template <class Grid, class Field, Criterion S, class Indicator, Executor E = SequentialExecutor>
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue, const S& criterion,
                                                        const Indicator& indicator,
                                                        const IsosurfaceOptions& options = {},
                                                        const E& executor = {}) {
    return std::move(isosurfaces(grid, field, std::span<const double>(&isovalue, 1), criterion,
                                 indicator, options, executor)
                         .front());
}

/// The same with S from options.threshold or options.max_triangles.
/// \throw InvalidInput also where the threshold is negative or not a number, and where even the
///        coarsest surface has more triangles than asked for
template <class Grid, class Field, class Indicator, Executor E = SequentialExecutor>
    requires requires(const Indicator& i) { i.stop(NodeKey{}); }
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue, const Indicator& indicator,
                                                        const IsosurfaceOptions& options = {},
                                                        const E& executor = {});

/// The same with its own preroll: one call for one surface.
template <class Grid, class Field, Executor E = SequentialExecutor>
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue,
                                                        const IsosurfaceOptions& options = {},
                                                        const E& executor = {}) {
    const HierarchicalIndicator indicator(grid, field, executor);
    return isosurface(grid, field, isovalue, indicator, options, executor);
}

}  // namespace nestgrid

#include <nestgrid/algorithms/isosurface_steps.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>
