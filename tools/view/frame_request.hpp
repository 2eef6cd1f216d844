// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a page asks for, as text: key=value between &, such as
//     isovalue=0.3,0.5&triangles=50000&motion=moving&normals=int8&axis=z&at=12
// The server and the WebAssembly module have no other parser.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nestgrid/algorithms/indicators.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/projection.hpp>

namespace nestgrid::view {

enum class NormalType { none, int8, float32 };

struct PlaneRequest {
    Point through{};
    Point normal{};
};

struct FrameRequest {
    std::vector<double> isovalues{};              ///< isovalue=NUMBER,..., of as many isosurfaces
    std::optional<std::array<double, 2>> band{};  ///< band=LOW,HIGH: the surface around it
    std::optional<PlaneRequest> plane{};  ///< plane=x,y,z,x,y,z, a point and the normal; or axis=x
                                          ///< (y, z) with at=COORDINATE
    std::optional<Ball> sphere{};         ///< sphere=x,y,z,r, a slice along it
    bool boundary = false;                ///< boundary=on: that of the domain, with values
    std::vector<double> lines{};          ///< lines=NUMBER,...: isolines on what has values
    // Detail is held at one of these, or all of it is drawn.
    double threshold = 0;         ///< threshold=NUMBER, in units of the indicator
    std::uint64_t triangles = 0;  ///< triangles=COUNT, a goal
    double error = 0;  ///< error=NUMBER that is kept, in units of the data; 0 where there is none
    double distance =
        0;  ///< distance=NUMBER, an estimate in units of length; 0 where there is none
    double position_error = 0;    ///< position_error=NUMBER, of curved leaves, in units of
                                  ///< length; 0: as VirtualOptions::position_tolerance
    bool cap = false;             ///< cap=on: isosurfaces are closed at the boundary
    bool collapse = false;        ///< collapse=on: fewer triangles of the same error
    double slice_distance = 0;    ///< slice_distance=NUMBER: slices are collapsed, too, and are
                                  ///< this far from those of all data at most
    bool distance_field = false;  ///< distance_field=on: the distance is kept there and back
    bool moving = false;          ///< motion=moving: the goal is missed by a few percent; or
                                  ///< motion=settled: it is not exceeded
    std::string indicator = "offset";   ///< indicator=offset (visual, ...), as of page_indicators()
    double blend = 1;                   ///< blend=FACTOR, as Projection::blend
    std::optional<LensRequest> lens{};  ///< lens=x,y,z,r with finest=, coarsest= and slope=
    /// box=x,x,y,y,z,z with box_threshold=, or 0.
    std::optional<RegionRequest> region{};
    std::optional<double> time{};  ///< time=NUMBER
    /// normals=none (int8, float32), of isosurfaces: from gradients, and from triangles while
    /// moving, or where there are caps.
    NormalType normals = NormalType::none;
    bool outlines = false;            ///< outlines=on or off: edges of extracted elements
    bool report = false;              ///< report=on: areas, volumes and cracks of isosurfaces
    bool measure = false;             ///< measure=on: settled isosurfaces against those of all data
    bool at_nodes = false;            ///< at_nodes=on, as IsosurfaceOptions::at_nodes
    std::optional<Cuts> cut_edges{};  ///< cuts=linear (finest)
    /// colour_tolerance=NUMBER, of settled slices and boundaries; 0 where there is none.
    double colour_tolerance = 0;

    /// Whether anything beside isosurfaces is drawn.
    bool cuts() const { return plane || sphere || boundary; }
    bool surfaces() const { return band || !isovalues.empty(); }
    /// The values of all level sets that are drawn.
    std::vector<double> level_sets() const {
        std::vector<double> all = isovalues;
        if (band) all.insert(all.end(), band->begin(), band->end());
        return all;
    }
    /// How finely it is drawn, at any threshold of an indicator.
    Projection projection(const std::string& of) const {
        return {.indicator = of, .blend = blend, .lens = lens, .region = region};
    }
    /// Edges are collapsed when nothing moves.
    bool collapses() const { return collapse && !moving; }
    /// Normals of isosurfaces are those of triangles.
    bool draws_quickly() const { return moving || collapses(); }
    /// Nor is a distance kept before.
    bool keeps_distance() const { return distance_field && !moving; }
};

/// The indicators that a page offers: those of the library for any surface and slice, on grids
/// that files hold.
std::vector<const IndicatorKind*> page_indicators();

/// \throw InvalidInput with one sentence for a key that is unknown or given twice, for a value that
///        is malformed or out of range, and where nothing is to be drawn
FrameRequest parse_request(std::string_view text);

}  // namespace nestgrid::view
