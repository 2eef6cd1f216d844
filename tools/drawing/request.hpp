// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is asked of a drawing, and what comes out of it.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "options/lens_options.hpp"
#include "options/time_options.hpp"

/// A box in the coordinates of the grid, and the threshold within it.
struct FineBox {
    std::array<double, 6> bounds;  ///< least and greatest x, y, z
    double threshold = 0;
};

/// What is drawn of a field. Where there is neither a function nor an isovalue, it is the grid, of
/// dimension 2.
struct DrawingRequest {
    /// A slice of a field in space, coloured by it; or null.
    const nestgrid::LevelFunction* function = nullptr;
    /// The isosurfaces with these values, in one walk: without a slice, or a single one beside it.
    std::vector<double> isovalues{};
    /// The surface around the band between the isovalue and this one, in its place.
    std::optional<double> upper{};
    /// What colours an isosurface without a slice; empty for one colour.
    std::string by{};
    double scale = 0;       ///< heights of a grid of dimension 2, in multiples of the field
    bool outlines = false;  ///< with the edges of elements
    /// Isolines on the surface, in the place of the surface in files: their values, or their
    /// number.
    std::vector<double> values{};
    int value_count = 0;

    bool cap = false;       ///< with the part of the boundary where the function is positive
    bool normals = true;    ///< of isosurfaces
    bool at_nodes = false;  ///< IsosurfaceOptions::at_nodes
    /// Where edges are cut; nothing: on their finest pieces where numbers of triangles are asked
    /// for, but for errors and collapses, which linear cuts keep.
    std::optional<nestgrid::Cuts> cuts{};
    std::optional<FineBox> box{};
    std::optional<nestgrid::LensRequest> lens{};
    /// Triangles are split until colours follow the data within this; 0 splits none.
    double colour_tolerance = 0;
    /// Whether edges are collapsed while the errors, or where distances are kept these, keep within
    /// the thresholds. What is drawn first has a part of them.
    bool collapses = false;
    /// How far a slice may be from that of all data, there and back, where edges are collapsed; 0
    /// keeps its place.
    double slice_distance = 0;
    bool keeps_distances = false;  ///< thresholds are distances that are kept there and back
    bool measures = false;         ///< the isosurface against that of all data

    bool flat = false;         ///< in a plane, to be looked at across it
    nestgrid::Point normal{};  ///< of that plane
    /// The sentence that refuses a first surface without triangles; where it is empty, such a
    /// surface is a result.
    std::string empty{};
    /// Told the field before anything is drawn, which it may refuse; or empty.
    std::function<void(const InputField& field)> look{};
    /// Adds what else there is to report; or empty.
    std::function<void(const InputField& field, Report& report)> add{};

    bool has_isovalue() const { return !isovalues.empty(); }
    bool has_several_isovalues() const { return isovalues.size() > 1; }
    bool in_one_colour() const { return has_isovalue() && function == nullptr && by.empty(); }
    bool has_two_surfaces() const { return has_isovalue() && function != nullptr; }
};

/// One surface and what it cost.
struct Drawn {
    std::optional<double> label;     ///< of the part, where there are several
    std::optional<double> time;      ///< where it is between frames
    std::optional<double> isovalue;  ///< where there are several
    /// Whether it was drawn in one walk with the surface before it, which has what that cost.
    bool shares_walk = false;
    double threshold = 0;
    int degree = 1;                   ///< of the polynomials within an error of which it is drawn
    bool curved = false;              ///< whether it is drawn of curved cells
    bool by_default = false;          ///< whether nobody has asked for that error
    nestgrid::TriangleBudget search;  ///< of the threshold; max_triangles is 0 where none was
    double search_seconds = 0;
    nestgrid::Isosurface<3> result;   ///< or a slice, or the grid; empty where it is not kept
    nestgrid::Surface<2> segments;    ///< in its place: the isolines of a field of dimension 2
    nestgrid::SurfaceReport report;   ///< of segments: vertices, and these as triangles
    nestgrid::Surface<3> isosurface;  ///< beside a slice
    nestgrid::SurfaceReport isosurface_report;
    nestgrid::Polylines isolines;
    double seconds = 0;
    std::optional<std::uint64_t> far_points;  ///< drawn more finely, where distances are kept
    std::optional<nestgrid::Collapsed> collapsed;
    double collapse_seconds = 0;
    std::optional<nestgrid::MeasuredError> measured;
    double measure_seconds = 0;
    std::size_t peak_bytes = 0;  ///< beside the surface itself
};

/// All surfaces of one field.
struct DrawnField {
    std::string name;         ///< of the colours
    std::string input_name;   ///< of the field that isosurfaces are of
    std::string length_unit;  ///< empty where it is unknown
    std::string space;        ///< such as RAS; empty where it is unknown
    int dimension = 3;
    std::size_t nodes = 0;
    std::size_t leaf_elements = 0;  ///< of the finest grid
    // The range of the colours, or of the data where there are no colours.
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();
    /// Why isosurfaces are empty, where that is because of their values.
    std::string outside{};
    double read_seconds = 0;
    double preroll_seconds = 0;
    std::size_t preroll_peak_bytes = 0;
    std::size_t preroll_kept_bytes = 0;
    double write_seconds = 0;
    double picture_seconds = 0;
    std::vector<Drawn> surfaces{};
    std::vector<double> values{};  ///< of isolines
};
