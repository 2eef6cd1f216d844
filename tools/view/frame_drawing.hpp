// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the parts of one frame are drawn with.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "frame_request.hpp"
#include "watched_work.hpp"

namespace nestgrid::view {

struct FramePart {
    const char* kind;
    Isosurface<3> drawn;
    /// Of an isosurface; else not a number.
    double isovalue = std::numeric_limits<double>::quiet_NaN();
    /// An estimate, in units of length, of how far an isosurface is from that of all data: the
    /// greatest slope deviation of a node that it drops. Not a number where it was not asked
    /// for.
    double distance = std::numeric_limits<double>::quiet_NaN();
    std::optional<MeasuredError> measured{};  ///< of an isosurface, where it was asked for

    /// Whether it is coloured by the data.
    bool has_values() const { return is("slice") || is("boundary"); }
    bool is(std::string_view what) const { return kind == what; }
};

/// What a request is drawn with.
struct FrameCriteria {
    std::optional<Criteria> detail{};
    std::shared_ptr<const Bounds> bounds{};
    /// In the place of both: polynomials, of which each threshold is an error (high_order.hpp).
    std::shared_ptr<const HighOrder> polynomials{};
    /// Slope deviations, for FramePart::distance; or null.
    std::shared_ptr<const Indicator> slopes{};
};

/// What a request draws, at any threshold.
class FrameDrawing {
public:
    /// Borrows everything.
    FrameDrawing(const FrameRequest& request, const Prerolls& moment, const FrameCriteria& criteria,
                 const WatchedWork& work, WatchedSteps& steps);

    /// \throw FrameAbandoned where nobody waits for the frame
    std::vector<FramePart> draw(double threshold) const;
    /// Measures what was drawn against the isosurfaces of all data, where it was asked for.
    void measure(std::vector<FramePart>& parts) const;
    /// Whether a threshold gives no more triangles than asked for.
    bool fits(double threshold) const;

private:
    /// What is coloured by the data.
    struct Cut {
        const char* kind;
        std::shared_ptr<const LevelFunction> function;
        bool cap = false;
    };
    struct StoppedBy {
        const Criterion& criterion;
        const Bounds& bounds;
    };

    template <class Function>
    auto with(double threshold, const Function& function) const;
    template <class Real>
    std::vector<FramePart> draw_isosurfaces(const Hierarchy<Real>& hierarchy,
                                            const StoppedBy& by) const;
    std::vector<FramePart> draw_within_distance() const;
    template <class Real>
    FramePart draw_band(const Hierarchy<Real>& hierarchy, const StoppedBy& by) const;
    template <class Real>
    void collapse_edges(FramePart& part, const Hierarchy<Real>& hierarchy) const;
    template <class Real>
    FramePart draw_cut(const Cut& cut, const Hierarchy<Real>& hierarchy, const StoppedBy& by) const;
    FramePart draw_collapsed(const Cut& cut) const;
    void refine(FramePart& cut, double threshold) const;
    IsosurfaceOptions surface_options() const;
    void add_normals(FramePart& part) const;
    IsosurfaceOptions watched(IsosurfaceOptions options) const;

    const FrameRequest& request_;
    const Prerolls& moment_;
    const FrameCriteria& criteria_;
    std::vector<Cut> cuts_;
    const WatchedWork& work_;
    const Executor& executor_;
    WatchedSteps& steps_;
};

}  // namespace nestgrid::view
