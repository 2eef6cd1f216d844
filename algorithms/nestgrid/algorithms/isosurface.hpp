// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Adaptive isosurfaces (isolines in two dimensions) on simplices (paper, sections 3, 4.4 and 8).
//
// Invariants:
//   - a node is inside where P_S U >= C; an edge is cut where its ends differ, from its lower to
//     its higher value, at a fraction kept in [2^-20, 1 - 2^-20] of its length;
//   - a vertex is named by the keys of the two nodes of the edge it cuts.
// Consequences, on a hierarchy whose elements conform and with a saturated criterion: every edge
// of the surface belongs to two triangles, or to one on the boundary of the domain; shared
// vertices are equal to the last bit; values equal to C are no special case, and no triangle
// degenerates to a point.
#pragma once

#include <functional>

#include <nestgrid/algorithms/contour_table.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/surface.hpp>

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
    /// Unit normals from gradients: the field's own where it offers them, else the mean of the
    /// gradients of the extracted elements around a node, weighted by volume.
    bool normals = false;
    /// Close the surface along the boundary of the domain, around the region U >= C.
    bool cap = false;
    /// Keep the extracted elements and which triangle comes from which.
    bool elements = true;
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
    /// On every triangle U differs from C by at most this, U being the data on the finest grid.
    double error_bound = 0;
    bool cancelled = false;       ///< by options.progress; the surface is then a part
    std::size_t table_bytes = 0;  ///< hash tables used while extracting
    std::size_t stack_bytes = 0;  ///< depth of the traversal times the size of one state
};

namespace detail {

struct Cancelled {};

template <class Grid, class Field, class S, class Indicator>
class IsosurfaceVisitor {
public:
    static constexpr Needs needs{.keys = true, .positions = true};
    static constexpr int dimension = Grid::dimension;
    using Walk = Traversal<Grid, Field, needs>;
    using State = typename Walk::State;
    using Result = Isosurface<dimension, ElementOf<Grid>>;

    IsosurfaceVisitor(const Walk& walk, double isovalue, const S& criterion,
                      const Indicator& indicator, const IsosurfaceOptions& options)
        : walk_{&walk},
          iso_{isovalue},
          criterion_{&criterion},
          indicator_{&indicator},
          options_{&options} {}

    Decision inspect(const State& s, const Split& split);
    void extract(const State& s);
    Result take();

private:
    using Index = std::uint32_t;

    struct Vertex {  // where it lies: on the edge from node `low` to node `high`
        Index low;
        Index high;
        double fraction;
    };

    bool inside(const State& s, std::size_t corner) const {
        return static_cast<double>(s.value[corner * State::components]) >= iso_;
    }

    bool of_interest(const State& s, double bound) const;
    Index node_vertex(std::size_t corner);
    Index edge_vertex(const State& s, std::size_t a, std::size_t b);
    Index add_vertex(KeyPair key, const Point& x, const Vertex& where);
    void add_simplex(typename Surface<dimension, ElementOf<Grid>>::Simplex simplex, const State& s);
    void add_contour(const State& s, const Contour& contour);
    void add_cap(const State& s);
    void load(const State& s);
    void load_gradients(const State& s);
    Point projected_gradient(const State& s, std::size_t corner) const;
    std::array<Point, max_corners> own_gradients(const State& s) const;
    Point node_gradient(const State& father, const Rule& rule, std::size_t node) const;
    void compute_normals();

    const Walk* walk_;
    double iso_;
    const S* criterion_;
    const Indicator* indicator_;
    const IsosurfaceOptions* options_;
    Result result_;
    double element_bound_ = 0;  // of the element inspected last
    int deepest_ = 0;
    KeyTable<KeyPair, Index> vertex_of_;
    std::array<NodeKey, max_corners> key_{};  // of the element being extracted
    std::array<Point, max_corners> x_{};
    std::array<Index, max_corners> slot_{};
    KeyTable<NodeKey, Index> gradient_of_;  // only for normals
    std::vector<Point> gradient_;
    std::vector<Vertex> where_;
};

}  // namespace detail

/// The isosurface U = isovalue of component 0 of the field under the projection with `criterion`.
/// \param indicator of the same grid and field: its bounds guide the search. HierarchicalIndicator,
///        or any class with its stop(), bound(), hanging() and epoch()
/// \throw GridError where an element that must be extracted is not a simplex, where the field has
///        no value, or where the grid has changed since the indicator was computed
/// \throw InvalidInput where the isovalue is not a number
template <class Grid, class Field, Criterion S, class Indicator>
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue, const S& criterion,
                                                        const Indicator& indicator,
                                                        const IsosurfaceOptions& options = {}) {
    static_assert(Grid::dimension >= 2, "isosurfaces need a grid of dimension 2 or 3");
    if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
    if (indicator.epoch() != epoch(grid)) {
        throw GridError("the grid has changed since its indicator was computed");
    }
    using Visitor = detail::IsosurfaceVisitor<Grid, Field, S, Indicator>;
    const typename Visitor::Walk walk(grid, field, indicator.hanging());
    Visitor visitor(walk, isovalue, criterion, indicator, options);
    try {
        walk.run(visitor);
    } catch (const detail::Cancelled&) {
        auto part = visitor.take();
        part.cancelled = true;
        return part;
    }
    return visitor.take();
}

/// The same with S from options.threshold.
/// \throw InvalidInput also where the threshold is negative or not a number
template <class Grid, class Field, class Indicator>
    requires requires(const Indicator& i) { i.stop(NodeKey{}); }
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue, const Indicator& indicator,
                                                        const IsosurfaceOptions& options = {}) {
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    const Threshold<Indicator> criterion{&indicator, options.threshold};
    return isosurface(grid, field, isovalue, criterion, indicator, options);
}

/// The same with its own preroll: one call for one surface.
template <class Grid, class Field>
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue,
                                                        const IsosurfaceOptions& options = {}) {
    const HierarchicalIndicator indicator(grid, field);
    return isosurface(grid, field, isovalue, indicator, options);
}

}  // namespace nestgrid

#include <nestgrid/algorithms/isosurface_steps.hpp>
