// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

#include "drawing/moments.hpp"
#include "output/surface_file.hpp"

/// A box in the coordinates of the grid, and the threshold within it.
struct FineBox {
    std::array<double, 6> bounds;  ///< least and greatest x, y, z
    double threshold = 0;
};

struct Extraction;

struct ExtractionRequest {
    double isovalue = 0;
    std::vector<ThresholdText> thresholds{};
    ProjectionChoice projection{};
    /// Triangles at most, after collapses, beside which there are no thresholds.
    std::vector<std::uint64_t> budgets{};
    std::optional<FineBox> box{};
    std::optional<LensRequest> lens{};
    int threads = 0;  ///< 0: all
    bool cap = false;
    bool normals = true;
    bool at_nodes = false;
    /// Where edges are cut; nothing: on their finest pieces where `budgets` are asked for, but for
    /// deviations and collapses, whose error linear cuts keep.
    std::optional<nestgrid::Cuts> cuts{};
    /// Whether thresholds are distances that are kept there and back.
    bool keeps_distances = false;
    /// Whether edges are collapsed while the error, or where distances are kept these, keep within
    /// the thresholds. What is drawn first has a part of them.
    bool collapses = false;
    bool measures = false;       ///< against the surface of all data
    bool keep_surfaces = false;  ///< for files and pictures
    std::function<void(const std::string&)> progress{};
    /// Told that a preroll begins; or empty.
    std::function<void()> preroll{};
    /// Told how many of all surfaces are drawn; or empty.
    std::function<void(std::size_t done, std::size_t total)> share{};
    /// Told how much of a preroll or of the surface at hand is done, from 0 to 1; or empty.
    std::function<void(double share)> part{};
    /// Takes each surface as soon as it is drawn, and need not leave it; or empty.
    std::function<void(Extraction&)> drawn{};
};

/// One surface and what it cost.
struct Extraction {
    std::optional<double> label;  ///< of the part, where there are several
    std::optional<double> time;   ///< where it is between frames
    double threshold = 0;
    nestgrid::TriangleBudget search;  ///< of the threshold; max_triangles is 0 where none was
    double search_seconds = 0;
    vtkSmartPointer<vtkPolyData> surface;  ///< where it is kept
    nestgrid::TraversalCounts counts;
    nestgrid::ErrorBounds bounds;
    double surface_error = 0;                 ///< Isosurface::surface_error
    std::optional<std::uint64_t> far_points;  ///< drawn more finely, where distances are kept
    std::optional<nestgrid::Collapsed> collapsed;
    double collapse_seconds = 0;
    std::optional<nestgrid::MeasuredError> measured;
    double measure_seconds = 0;
    std::size_t stack_bytes = 0;
    nestgrid::SurfaceReport report;  ///< of isolines: vertices, and segments as triangles
    double seconds = 0;
    std::size_t peak_bytes = 0;  ///< beside the surface itself
};

struct ExtractionRun {
    int dimension = 3;
    double least = 0;
    double greatest = 0;
    std::size_t nodes = 0;
    std::size_t leaf_elements = 0;  ///< of the finest grid
    double preroll_seconds = 0;
    std::size_t preroll_peak_bytes = 0;
    std::size_t preroll_kept_bytes = 0;
    std::size_t expected = 1;  ///< how many surfaces will be drawn
    std::vector<Extraction> surfaces;
};

/// Draws the surfaces of a field, or at times between its frames, which need no preroll of their
/// own.
/// \param path of its file
/// \throw nestgrid::InvalidInput, nestgrid::GridError as Moments and isosurface()
ExtractionRun extract(const InputField& field, const TimeOptions& time,
                      const std::filesystem::path& path, const ExtractionRequest& request);

/// VTK's own contour of the same samples (vtkFlyingEdges3D, without normals), for comparison.
struct Contour {
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    std::size_t once_edges = 0;  ///< of one triangle only, those on the boundary included
    std::size_t nonmanifold_edges = 0;
    double seconds = 0;
};

Contour contour_with_vtk(const Volume& volume, double isovalue);

/// Seconds since some moment.
double now();
