// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Answers the requests of an interactive page: one request, one frame. Knows no files, sockets,
// threads of its own or pictures, so that a server and WebAssembly in the page use the same.
//
// Invariants:
//   - the isosurfaces of a frame are those of isosurfaces() with the same criterion, vertices
//     rounded to float, and its slice and boundary those of slice() and boundary_surface();
//   - a settled frame does not depend on the frames before it: the threshold of a number of
//     triangles is the least one of 8 significant bits at which the frame keeps within it, or,
//     where none does, the greatest one;
//   - a moving frame costs one extraction in most cases (FrameBudget); where it misses the number
//     of triangles by more than 5 %, it is drawn again, and then searched for like a settled one,
//     but not once a search has missed the number, too;
//   - a frame of an error keeps it. A settled one keeps it with fewer triangles where elements are
//     simplices and isosurfaces alone are drawn: cut deviations are measured anew for each
//     isovalue;
//   - slopes are measured for settled frames alone: a moving frame of a distance has the number of
//     triangles of the last settled one.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/frame_budget.hpp>

#include "explored_field.hpp"
#include "frame_drawing.hpp"
#include "frame_request.hpp"
#include "frame_watch.hpp"

namespace nestgrid::view {

class Explorer {
public:
    /// Makes the prerolls of all frames.
    /// \param executor borrowed
    /// \throw InvalidInput where the field is not one of dimension 3, and as HierarchicalIndicator
    /// \throw GridError as HierarchicalIndicator
    explicit Explorer(ExploredField field, const Executor& executor);

    /// What a page needs to begin with, as JSON: a title, the name of the field, its range, that
    /// of nearly all values (the same unless few lie far off), box,
    /// indicators (a name and what it measures), unit of length (empty where it is not known),
    /// times, a histogram, an isovalue to begin with, samples (0 where the field has none), nodes,
    /// degree (above 1 where polynomials are drawn within errors), and seconds of the preroll.
    std::string info() const;

    /// Draws a frame.
    /// \param request as parse_request() takes it
    /// \return the layout of frame_reply.hpp. The text has threshold, triangles, visited,
    ///         error_bound (the greatest of the parts), bound_says_nothing
    ///         (isosurface_options.hpp), distance (of a settled isosurface from that of all data,
    ///         an estimate, where an error or a distance is asked for and nothing is collapsed;
    ///         else null), seconds, draws (extractions that the frame took), and a list of parts:
    ///         kind (isosurface, band, slice, boundary, outlines or isolines), triangles
    ///         (segments), visited, error_bound, of isosurfaces isovalue and, where they are
    ///         measured, measured_error, measured_distance and measured_back, the greatest
    ///         numbers of a MeasuredError, of them and of bands in a report area, volume (null
    ///         where it is not closed) and open_edges, and arrays: positions, three float32 a
    ///         vertex; indices, three uint32 a triangle, two a segment; normals, four int8 (times
    ///         1/127; the last is 0) or three float32 a vertex; values, one float32 a vertex
    /// \param watch told what is being done; where it returns false, the next frame is drawn as if
    ///        this one had not been asked for
    /// \throw FrameAbandoned where it does
    /// \throw InvalidInput with one sentence where the request is malformed, asks for a time
    ///        outside the frames
    std::vector<std::byte> frame(std::string_view request, const FrameWatch& watch = {});

private:
    struct Drawn;

    FrameRequest at_last_detail(FrameRequest request) const;
    Prerolls& moment_at(const FrameRequest& request);
    FrameCriteria criteria_for(const FrameRequest& request, Prerolls& moment, const Work& work,
                               WatchedSteps& steps) const;
    static FrameCriteria polynomials_for(const FrameRequest& request, Prerolls& moment,
                                         const Work& work, WatchedSteps& steps);
    double greatest_threshold(const IndicatorKind& indicator) const;
    Drawn draw(const FrameRequest& request, const FrameDrawing& drawing);
    Drawn draw_to_goal(const FrameRequest& request, const FrameDrawing& drawing);

    ExploredField field_;
    const Executor* executor_;
    std::size_t nodes_ = 0;  // of a frame
    int degree_ = 1;
    bool curved_ = false;
    double jump_ = 0;   // between elements, of data of higher degree
    double least_ = 0;  // of all frames
    double greatest_ = 0;
    std::array<double, 2> usual_range_{};  // of the values, or of nearly all
    double preroll_seconds_ = 0;

    /// The field at the time of the last request, and what was made for it.
    std::shared_ptr<Prerolls> moment_;
    std::vector<float> weights_;               // of the frames, there
    std::uint64_t triangles_of_distance_ = 0;  // of the last settled frame of a distance
    struct Budget {
        std::string indicator;
        FrameBudget thresholds;
        bool in_steps;  ///< no threshold gives the number of triangles: integer data, say
    };
    std::optional<Budget> budget_;
};

}  // namespace nestgrid::view
