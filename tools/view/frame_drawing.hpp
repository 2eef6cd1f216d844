// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the parts of one frame are drawn with.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "drawing/frame_field.hpp"
#include "drawing/telling_executor.hpp"
#include "frame_request.hpp"
#include "frame_watch.hpp"

namespace nestgrid::view {

/// The field at the time of a request.
struct Moment {
    SharedHierarchy hierarchy;
    std::size_t frame = 0;                         ///< where it is that of a frame
    std::optional<KeyFrames> between;              ///< where it is not
    std::vector<float> weights;                    ///< of the frames
    const HierarchicalIndicator* alone = nullptr;  ///< of offsets or deviations, at a frame

    const Bounds& bounds() const {
        if (between) return *between;
        return *alone;
    }
};

struct FramePart {
    const char* kind;
    Isosurface<3> drawn;
    /// An estimate, in units of length, of how far an isosurface is from that of all data: the
    /// greatest slope deviation of a node that it drops. Not a number where it was not asked
    /// for.
    double distance = std::numeric_limits<double>::quiet_NaN();
};

/// The numbers that thresholds are compared with. Borrowed.
struct FrameIndicators {
    const Indicator* detail = nullptr;
    const SweptIndicator* size = nullptr;    ///< of elements, for a lens
    const SweptIndicator* slopes = nullptr;  ///< slope deviations, for FramePart::distance, or null
};

/// What a request draws, at any threshold.
class FrameDrawing {
public:
    /// Borrows everything.
    FrameDrawing(const FrameRequest& request, const Moment& moment,
                 const FrameIndicators& indicators, const Executor& executor, WatchedSteps& steps);

    /// \throw FrameAbandoned where nobody waits for the frame
    std::vector<FramePart> draw(double threshold) const;
    /// Whether a threshold gives no more triangles than asked for.
    bool fits(double threshold) const;

private:
    template <class Function>
    void with_criterion(double threshold, const Function& function) const;
    template <class Real>
    FramePart draw_isosurface(const Hierarchy<Real>& hierarchy, const Criterion& criterion) const;
    template <class Real>
    void collapse_edges(FramePart& part, const Hierarchy<Real>& hierarchy) const;
    template <class Real>
    Slice draw_slice(const Hierarchy<Real>& hierarchy, const Criterion& criterion) const;
    template <class Real>
    bool counts_at_most(std::uint64_t most, const Hierarchy<Real>& hierarchy,
                        const Criterion& criterion) const;
    IsosurfaceOptions watched(IsosurfaceOptions options) const;

    const FrameRequest& request_;
    const Moment& moment_;
    FrameIndicators indicators_;
    std::optional<Lens> lens_;
    std::optional<Plane> plane_;
    TellingExecutor executor_;
    WatchedSteps& steps_;
};

}  // namespace nestgrid::view
