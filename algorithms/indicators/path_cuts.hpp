// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far a surface that is drawn in an element may be from that of the data, as the walk meets the
// elements (cut_indicator.hpp says what is measured).
//
// An element that stops draws I U, the interpolant of its corner values, up to the flatness of its
// triangles; where corners are dropped, some function between two interpolants. So each element
// begins the functions between which lies what it may draw, which the walk interpolates downwards
// (path_rows.hpp) and compares with the data on the leaves:
//   - a simplex begins I U;
//   - another element begins I U - 2 r and I U + 2 r. Triangles with their vertices on edges, at
//     I U = C, keep within 2 r, where r is the affine_residual(). This also covers children that
//     interpolate in another way than the element;
//   - a child of a split with several new nodes begins, for its father, the interpolants of the
//     least and of the greatest values that its corners may have while some are dropped.
// Why two functions are enough, L <= F <= H: where F = C, L <= C <= H. In a leaf t, (L, H, U) at a
// point lies in the convex hull of the triples at the corners. The part of the hull with
// L <= C <= H is convex; its corners are corners of t, or lie on a line between two of them at
// L = C or at H = C, because L <= H. |U - C| is greatest at one of these. Where U = C, L and H lie
// between those at the ends of such lines. So L and H are looked at one by one, on all lines
// between two corners of t, which in a simplex are its edges and make the numbers exact.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <indicators/cut_measure.hpp>
#include <indicators/path_rows.hpp>
#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid::engine {

/// What is measured of surfaces.
struct CutRequest {
    std::span<const double> isovalues;
    const Bounds* bounds;    ///< of the data
    bool distances = false;  ///< errors are divided by slopes
};

/// Measures along a walk in depth-first order, which may begin below other elements.
template <class Real>
class PathCuts {
public:
    using View = ElementView<Real>;
    /// Takes the number of an element that is left, and the keys of the new nodes of its split. The
    /// greatest numbers of all calls count.
    using Report = std::function<void(std::span<const NodeKey> made, double eta)>;

    /// \param walk must carry values and keys, and project nothing away; and positions where
    ///        elements are no simplices, and for distances
    PathCuts(const Walk<Real>& walk, const CutRequest& request, Report report)
        : walk_{&walk},
          request_{request},
          report_{std::move(report)},
          measure_{request.isovalues, request.distances} {}

    /// Called for each element: leaves those that are not above it, and measures a leaf.
    /// \return whether elements below it are to be shown
    bool enter(const View& view, const Split& split);
    /// Called when the children of an element are about to be shown that enter() wants to see.
    /// \param value of the corners and, behind them, of the new nodes
    void split(const Split& split, const Real* value);
    /// Whether an element is the one that was entered last.
    bool is_in(const View& view) { return rows_.depth() > 0 && rows_.last().is(view); }
    /// Leaves all elements.
    void finish() {
        while (rows_.depth() > 0) leave();
    }
    /// Forgets all elements.
    void clear() {
        rows_.clear();
        skipped_.level = -1;
    }

private:
    /// What is known of an element that the walk is in, beside its rows.
    struct Cuts {
        std::size_t own = 0;        // its own columns begin here, behind those for its father
        std::size_t for_above = 0;  // and these
        double below = 0;           // greatest number in the columns that its children begin for it
        std::vector<Real> least;    // by node, while other nodes are dropped
        std::vector<Real> greatest;
    };
    struct Place {
        std::size_t coarse = 0;
        int level = -1;
        NodeKey path = 0;
    };

    bool is_below_skipped(const View& view);
    bool enter_all(const View& view);
    bool enter_one(const View& view, const Split& split);
    void begin_for_above(const View& view);
    void begin_columns(const View& view, std::size_t own);
    void set_corners(const View& view);
    void leave();
    void leave_unsplit();

    const Walk<Real>* walk_;
    CutRequest request_;
    Report report_;
    PathRows<Real> rows_;
    std::vector<Cuts> cuts_;  // by element
    CutMeasure measure_;
    CutCorners corners_{};  // of the last element
    std::array<Point, max_corners> position_{};
    Place skipped_;  // the element that was left out last
};

}  // namespace nestgrid::engine
