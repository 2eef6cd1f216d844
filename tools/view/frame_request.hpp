// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a page asks for, as text: key=value between &, such as
//     isovalue=0.3,0.5&triangles=50000&motion=moving&normals=int8&axis=z&at=12
// The server and the WebAssembly module have no other parser.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nestgrid/algorithms/indicators.hpp>
#include <nestgrid/algorithms/projection.hpp>

namespace nestgrid::view {

enum class NormalType { none, int8, float32 };

struct PlaneRequest {
    Point through{};
    Point normal{};
};

struct FrameRequest {
    std::vector<double> isovalues{};      ///< isovalue=NUMBER,..., of as many isosurfaces
    std::optional<PlaneRequest> plane{};  ///< plane=x,y,z,x,y,z, a point and the normal; or axis=x
                                          ///< (y, z) with at=COORDINATE
    std::optional<Ball> sphere{};         ///< sphere=x,y,z,r, a slice along it
    bool boundary = false;                ///< boundary=on: that of the domain, with values
    // Detail is held at one of these, or all of it is drawn.
    double threshold = 0;         ///< threshold=NUMBER, in units of the indicator
    std::uint64_t triangles = 0;  ///< triangles=COUNT, a goal
    double error = 0;  ///< error=NUMBER that is kept, in units of the data; 0 where there is none
    double distance =
        0;  ///< distance=NUMBER, an estimate in units of length; 0 where there is none
    double position_error = 0;          ///< position_error=NUMBER, of curved leaves, in units of
                                        ///< length; 0: as VirtualOptions::position_tolerance
    bool cap = false;                   ///< cap=on: isosurfaces are closed at the boundary
    bool collapse = false;              ///< collapse=on: fewer triangles of the same error
    bool moving = false;                ///< motion=moving: the goal is missed by a few percent; or
                                        ///< motion=settled: it is not exceeded
    std::string indicator = "offset";   ///< indicator=offset (visual, ...), as of page_indicators()
    std::optional<LensRequest> lens{};  ///< lens=x,y,z,r with finest=, coarsest= and slope=
    std::optional<double> time{};       ///< time=NUMBER
    /// normals=none (int8, float32), of isosurfaces: from gradients, and from triangles while
    /// moving, or where there are caps.
    NormalType normals = NormalType::none;
    bool outlines = false;  ///< outlines=on or off: edges of extracted elements
    bool report = false;    ///< report=on: areas, volumes and cracks of isosurfaces

    /// Whether anything beside isosurfaces is drawn.
    bool cuts() const { return plane || sphere || boundary; }
    /// Edges are collapsed when nothing moves.
    bool collapses() const { return collapse && !moving; }
};

/// The indicators that a page offers: those of the library for any surface and slice, on grids
/// that files hold.
std::vector<const IndicatorKind*> page_indicators();

/// \throw InvalidInput with one sentence for a key that is unknown or given twice, for a value that
///        is malformed or out of range, and where nothing is to be drawn
FrameRequest parse_request(std::string_view text);

}  // namespace nestgrid::view
