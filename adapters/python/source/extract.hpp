// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One function for each extraction that the Python package offers. No type of Python occurs here.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/level_function.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/projection.hpp>

#include "source.hpp"

namespace nestgrid::python {

struct Drawn : ErrorBounds {
    Surface<3> surface;
    TraversalCounts counts;
    double threshold = 0;
    double position_bound = 0;                                       ///< as of Isosurface
    double surface_error = std::numeric_limits<double>::infinity();  ///< so, too
    std::string budget_reason;  ///< why there are fewer triangles than max_triangles, or empty
    bool cancelled = false;
};
struct DrawnLines : ErrorBounds {
    Polylines lines;
    TraversalCounts counts;
    double threshold = 0;
    double position_bound = 0;
    bool cancelled = false;
};

struct SurfaceRequest {
    bool normals = true;
    bool cap = false;
    bool elements = false;
    bool at_nodes = false;
    bool finest_cuts = false;
    /// Needs the indicator "error", or a distance that is kept; but for isosurfaces "deviation".
    bool collapses = false;
    bool keeps_distance = false;  ///< needs the indicator "slope"
    /// How far a collapsed slice may be from that of all data; 0 keeps its place.
    double slice_distance = 0;
};

/// \throw InvalidInput, GridError as isosurfaces(), and for a blend below 1
Drawn draw_isosurface(const Source& source, double isovalue, const SurfaceRequest& request,
                      const Projection& projection, const Call& call);
/// One for each value, in one walk.
/// \throw InvalidInput, GridError as isosurfaces(), and for collapses, distances that are kept and
///        numbers of triangles
std::vector<Drawn> draw_isosurfaces(const Source& source, std::span<const double> isovalues,
                                    const SurfaceRequest& request, const Projection& projection,
                                    const Call& call);
/// \throw InvalidInput, GridError as isoband()
Drawn draw_isoband(const Source& source, double low, double high, const SurfaceRequest& request,
                   const Projection& projection, const Call& call);
/// \throw InvalidInput, GridError as boundary_surface()
Drawn draw_boundary(const Source& source, const SurfaceRequest& request,
                    const Projection& projection, const Call& call);
/// \throw InvalidInput, GridError as slices()
Drawn draw_slice(const Source& source, const LevelFunction& function, const SurfaceRequest& request,
                 const Projection& projection, const Call& call);
/// \throw InvalidInput, GridError as isolines()
DrawnLines draw_isolines(const Source& source, std::span<const double> values,
                         const Projection& projection, const Call& call);
/// \param scale nothing: the shading in the plane
/// \throw InvalidInput, GridError as height_field()
Drawn draw_height_field(const Source& source, std::optional<double> scale, double flatness,
                        const SurfaceRequest& request, const Projection& projection,
                        const Call& call);
/// \throw InvalidInput, GridError as probe()
ProbeResult probe_points(const Source& source, std::span<const Point> points,
                         const Projection& projection, const Call& call);

}  // namespace nestgrid::python
