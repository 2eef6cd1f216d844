// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Results of the library in C++, with which those of the Python package are compared bit by bit.
// Writes each array as a file of raw numbers into the folder that it is given: NAME.vertices,
// NAME.triangles, ..., and NAME.numbers: error bound, threshold, calls, visited, extracted.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/linear_octree.hpp>
#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/adapters/stored_file.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

namespace {

using namespace nestgrid;

std::filesystem::path folder;

template <class T>
void write(const std::string& name, std::span<const T> numbers) {
    std::ofstream file(folder / name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size_bytes()));
}
template <class T>
void write(const std::string& name, const std::vector<T>& numbers) {
    write(name, std::span<const T>(numbers));
}

void write_numbers(const std::string& name, double bound, double threshold,
                   const TraversalCounts& counts) {
    write(name + ".numbers",
          std::vector<double>{bound, threshold, static_cast<double>(counts.calls),
                              static_cast<double>(counts.visited),
                              static_cast<double>(counts.extracted)});
}

template <class Result>
void write_surface(const std::string& name, const Result& result, double threshold) {
    write(name + ".vertices", result.surface.vertices);
    write(name + ".triangles", result.surface.simplices);
    write(name + ".normals", result.surface.normals);
    write(name + ".attributes", result.surface.attributes);
    write_numbers(name, result.error_bound, threshold, result.counts);
}

void write_lines(const std::string& name, const Polylines& lines) {
    write(name + ".vertices", lines.vertices);
    write(name + ".points", lines.points);
    write(name + ".first", lines.first);
    write(name + ".values", lines.value);
}

/// A gyroid with a third index of its own, so that no two indices can be taken for each other.
double wave(double i, double j, double k, double t) {
    return std::sin(0.5 * i + t) * std::cos(0.4 * j) + std::sin(0.4 * j) * std::cos(0.3 * k) +
           std::sin(0.3 * k) * std::cos(0.5 * i + t) + 0.01 * k;
}

constexpr std::array<int, 3> shape{20, 17, 23};
constexpr Point spacing{1, 0.5, 2};
constexpr Point origin{-3, 1, 0.25};

/// Samples of a type in Fortran or in C order.
template <class Sample, std::size_t dim>
std::vector<Sample> sample(bool c_order, double scale, double shift, double t = 0) {
    std::vector<Sample> samples;
    const std::array<int, 3> count{shape[0], shape[1], dim == 3 ? shape[2] : 1};
    const auto push = [&](int i, int j, int k) {
        samples.push_back(static_cast<Sample>(std::floor(scale * wave(i, j, k, t)) + shift));
    };
    if (c_order) {
        for (int i = 0; i < count[0]; ++i)
            for (int j = 0; j < count[1]; ++j)
                for (int k = 0; k < count[2]; ++k) push(i, j, k);
    } else {
        for (int k = 0; k < count[2]; ++k)
            for (int j = 0; j < count[1]; ++j)
                for (int i = 0; i < count[0]; ++i) push(i, j, k);
    }
    return samples;
}

template <int dim>
LatticeGeometry<dim> geometry(bool c_order) {
    LatticeGeometry<dim> g;
    g.origin = {origin[0], origin[1], dim == 3 ? origin[2] : 0};
    for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
        const std::size_t index = c_order ? static_cast<std::size_t>(dim) - 1 - d : d;
        g.samples[d] = shape[index];
        g.spacing[d] = spacing[index];
        for (std::size_t r = 0; r < 3; ++r) g.direction[r][d] = r == index ? 1 : 0;
    }
    return g;
}

template <class Grid, class Field>
void write_isosurfaces(const std::string& name, const Grid& grid, const Field& field,
                       const HierarchicalIndicator& offsets) {
    const IsosurfaceOptions options{.normals = true};
    const auto draw = [&](const std::string& which, const Criterion& s, double threshold,
                          const IsosurfaceOptions& o) {
        write_surface(name + which, isosurface(grid, field, 40, under(s, offsets), o), threshold);
    };
    draw("_full", Threshold(&offsets, 0), 0, options);
    draw("_coarse", Threshold(&offsets, 12), 12, options);
    draw("_cap", Threshold(&offsets, 12), 12, {.normals = false, .cap = true, .at_nodes = true});
    const double found =
        isosurface<3>(erase(grid, field), 40, under(offsets, {.max_triangles = 1500}), options)
            .search.threshold;
    const IsosurfaceOptions finest{.cuts = Cuts::finest, .normals = true};
    draw("_budget", Threshold(&offsets, found), found, finest);
    draw("_finest", Threshold(&offsets, 12), 12, finest);
    const HierarchicalIndicator spread(grid, field, Spread{.factor = 2});
    write_surface(name + "_blend",
                  isosurface(grid, field, 40, under(Blended(&spread, 9, 2), spread), options), 9);
    const auto visual =
        visual_indicator({grid, field}, {.tau = 0x1p-20 * (offsets.greatest() - offsets.least())});
    draw("_visual", Threshold(&visual, 0.4), 0.4, options);
    const auto numerical = numerical_indicator({grid, field});
    draw("_numerical", Threshold(&numerical, 30), 30, options);
    const auto wavelet = wavelet_indicator({grid, field});
    draw("_wavelet", Threshold(&wavelet, 8), 8, options);
    const auto size = mesh_size(grid, Spread{.slope = 0.5});
    const Lens lens(&size, Ball{{4, 4, 20}, 3}, {.finest = 1});
    const double any = std::numeric_limits<double>::infinity();
    draw("_lens", Threshold(&offsets, any) && lens, any, options);
    const auto result = isosurface(grid, field, 40, under(offsets, 12), {.elements = true});
    const Surface<2> edges = outlines(result.surface);
    write(name + "_outlines.vertices", edges.vertices);
    write(name + "_outlines.segments", edges.simplices);
}

template <class Grid, class Field>
void write_slices(const std::string& name, const Grid& grid, const Field& field,
                  const HierarchicalIndicator& offsets) {
    const Plane plane({4, 4, 20}, {1, 2, 0.5});
    const Sphere sphere({4, 4, 20}, 5);
    const Cylinder cylinder({4, 4, 20}, {0, 0, 1}, 2);
    const Threshold s(&offsets, 12);
    write_surface(name + "_plane", slice(grid, field, plane), 0);
    write_surface(name + "_sphere", slice(grid, field, sphere, under(s, offsets)), 12);
    write_surface(name + "_cylinder",
                  slice(grid, field, cylinder, under(s, offsets), {.normals = true}), 12);
    const auto at = [&](double threshold) { return Threshold(&offsets, threshold); };
    const double found =
        slice(erase(grid, field), plane, under(at, offsets, {.max_triangles = 300}))
            .search.threshold;
    const auto budget = slice(grid, field, plane, under(at(found), offsets));
    write_surface(name + "_budget_slice", budget, found);
    const std::vector<double> values{-50, 0, 50};
    write_lines(name + "_slice_lines", isolines(budget.surface, 0, values));
}

template <class Grid, class Field>
void write_probes(const std::string& name, const Grid& grid, const Field& field,
                  const HierarchicalIndicator& offsets) {
    std::vector<Point> points;
    for (int i = 0; i < 100; ++i) points.push_back({-3 + 0.2 * i, 1 + 0.07 * i, 0.25 + 0.45 * i});
    write(name + "_probe.points", points);
    write(name + "_probe.values", probe(grid, field, points).values);
    write(name + "_probe_coarse.values", probe(grid, field, points, under(offsets, 12)).values);
}

void write_volumes() {
    for (const bool c_order : {false, true}) {
        const std::string name = c_order ? "c" : "f";
        const LatticeBisection<3> grid(geometry<3>(c_order));
        const auto samples = sample<float, 3>(c_order, 100, 0);
        const LatticeField field(grid, std::span<const float>(samples));
        const HierarchicalIndicator offsets(grid, field);
        write(name + ".samples", samples);
        write_isosurfaces(name, grid, field, offsets);
        write_slices(name, grid, field, offsets);
        write_probes(name, grid, field, offsets);

        const auto later = sample<float, 3>(c_order, 100, 0, 0.5);
        write(name + "_later.samples", later);
        const LatticeField field_later(grid, std::span<const float>(later));
        const HierarchicalIndicator offsets_later(grid, field_later);
        const SweptIndicator wavelets = wavelet_indicator({grid, field});
        const SweptIndicator wavelets_later = wavelet_indicator({grid, field_later});
        for (const bool cubic : {false, true}) {
            const std::array times{0.0, 1.0, 2.0};
            const auto weights =
                cubic ? catmull_rom_weights(times, 0.7) : linear_weights(times, 0.7);
            const KeyFrames frames({&offsets, &offsets_later, &offsets}, weights);
            const Between between({&field, &field_later, &field}, weights);
            write_surface(name + (cubic ? "_cubic" : "_between"),
                          isosurface(grid, between, 40, under(frames, 12),
                                     IsosurfaceOptions{.normals = true}),
                          12);
            const SweptKeyFrames swept({&wavelets, &wavelets_later, &wavelets}, weights);
            write_surface(name + (cubic ? "_cubic" : "_between") + "_wavelet",
                          isosurface(grid, between, 40, under(Threshold(&swept, 8), frames),
                                     IsosurfaceOptions{.normals = true}),
                          8);
        }
    }
}

/// Signed samples lie around 0, unsigned ones around 100.
template <class Sample>
void write_type(const std::string& type) {
    const double shift = std::is_signed_v<Sample> ? 0 : 100;
    for (const bool c_order : {false, true}) {
        const std::string name = type + (c_order ? "_c" : "_f");
        const auto samples = sample<Sample, 3>(c_order, 30, shift);
        write(name + ".samples", samples);
        const LatticeBisection<3> grid(geometry<3>(c_order));
        const LatticeField field(grid, std::span<const Sample>(samples));
        write_surface(name,
                      isosurface(grid, field, shift + 9.5, {.threshold = 3}, {.normals = true}), 3);
        const auto flat = sample<Sample, 2>(c_order, 30, shift);
        write(name + "_flat.samples", flat);
        const LatticeBisection<2> plane(geometry<2>(c_order));
        const LatticeField values(plane, std::span<const Sample>(flat));
        write_lines(
            name + "_lines",
            isolines(plane, values, std::array{shift, shift + 9.5}, {.threshold = 2}).lines);
        write_surface(name + "_height", height_field(plane, values, 0.1, {.threshold = 2}), 2);
        write_surface(name + "_shading", shading(plane, values, {.threshold = 2}), 2);
    }
}

struct OctreeLeaf {
    std::int64_t x, y, z, level;
};

/// Leaves in the order of the Morton curve, fine where the centre lies near a sphere.
void refine(std::vector<OctreeLeaf>& leaves, const OctreeLeaf& leaf, int deepest) {
    const double width = std::ldexp(1.0, deepest - static_cast<int>(leaf.level));
    const auto from_centre = [&](std::int64_t x) {
        return (static_cast<double>(x) + width / 2) / std::ldexp(1.0, deepest) - 0.5;
    };
    const double r = norm(Point{from_centre(leaf.x), from_centre(leaf.y), from_centre(leaf.z)});
    if (leaf.level == deepest || std::abs(r - 0.4) * std::ldexp(1.0, deepest) > 1.5 * width) {
        leaves.push_back(leaf);
        return;
    }
    const std::int64_t half = std::int64_t{1} << (deepest - leaf.level - 1);
    for (int c = 0; c < 8; ++c) {
        refine(leaves,
               {leaf.x + (c & 1) * half, leaf.y + (c >> 1 & 1) * half, leaf.z + (c >> 2) * half,
                leaf.level + 1},
               deepest);
    }
}

void write_octree() {
    constexpr int deepest = 5;
    std::vector<OctreeLeaf> leaves;
    refine(leaves, {0, 0, 0, 0}, deepest);
    CoarseGrid coarse;
    std::vector<Point> corners;
    for (unsigned c = 0; c < 8; ++c) {
        corners.push_back({1 + 16.0 * (c & 1U), 2 + 32.0 * (c >> 1U & 1U), 3 + 8.0 * (c >> 2U)});
    }
    coarse.nodes = Coordinates(corners);
    coarse.add(Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    const LinearOctree<3, OctreeLeaf> grid(coarse, {leaves}, deepest);
    std::vector<double> values;
    std::vector<std::uint32_t> nodes;
    for (const OctreeLeaf& leaf : leaves) {
        const auto width = std::int64_t{1} << (deepest - leaf.level);
        for (int c = 0; c < 8; ++c) {
            nodes.push_back(static_cast<std::uint32_t>(values.size()));
            values.push_back(wave(0.3 * static_cast<double>(leaf.x + (c & 1) * width),
                                  0.3 * static_cast<double>(leaf.y + (c >> 1 & 1) * width),
                                  0.3 * static_cast<double>(leaf.z + (c >> 2) * width), 0));
        }
    }
    write("octree.leaves", leaves);
    write("octree.samples", values);
    const LinearOctreeField<LinearOctree<3, OctreeLeaf>, double, std::uint32_t> field(grid, nodes,
                                                                                      values);
    write_surface("octree", isosurface(grid, field, 0.3, {.threshold = 0.05}, {.normals = true}),
                  0.05);
}

void write_stored() {
    CoarseGrid coarse;
    std::vector<Point> corners;
    for (unsigned c = 0; c < 8; ++c) {
        corners.push_back({1.0 * (c & 1U), 1.0 * (c >> 1U & 1U), 1.0 * (c >> 2U)});
    }
    coarse.nodes = Coordinates(corners);
    coarse.add(Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    OctreeGrid<3> grid(coarse);
    for (int i = 0; i < 4; ++i) {
        grid.adapt(
            [](const Leaf& leaf) { return leaf.corners[0][0] < 0.5 ? Mark::refine : Mark::keep; });
    }
    std::vector<double> values;
    for (const Point& x : grid.node_positions()) {
        values.push_back(wave(9 * x[0], 9 * x[1], 9 * x[2], 0));
    }
    write_hierarchy(grid, folder / "stored.nestgrid", {{"wave", values}, {"again", values}});
    std::vector<double> later = values;
    for (double& value : later) value = 0.5 * value + 0.2;
    write_hierarchy(grid, folder / "later.nestgrid", {{"wave", later}});
    NamedField both{"wave", values};
    both.values.insert(both.values.end(), later.begin(), later.end());
    write_hierarchy(grid, folder / "frames.nestgrid", {both},
                    {.times = {1, 3}, .compression = CompressionOptions{}});
    const NodeField field(grid, values);
    write_surface("stored", isosurface(grid, field, 0.3, {.threshold = 0.05}, {.normals = true}),
                  0.05);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: reference FOLDER\n";
        return 1;
    }
    folder = argv[1];
    write_volumes();
    write_type<std::uint8_t>("uint8");
    write_type<std::int8_t>("int8");
    write_type<std::uint16_t>("uint16");
    write_type<std::int16_t>("int16");
    write_type<std::uint32_t>("uint32");
    write_type<std::int32_t>("int32");
    write_type<std::uint64_t>("uint64");
    write_type<std::int64_t>("int64");
    write_type<float>("float32");
    write_type<double>("float64");
    write_octree();
    write_stored();
    return 0;
}
