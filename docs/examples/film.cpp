// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A film of a drop that moves, from three frames on three octrees, each refined at the drop of its
// time. Arguments: the number of pictures, at least 2, and a folder for them; without a folder, no
// files are written. Quoted in docs/time.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/adapters/union.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

namespace {

using namespace nestgrid;
using Grid = OctreeGrid<3>;
using Field = NodeField<Grid, double>;

/// Positive inside a drop around (time, 1/2, 1/2).
double drop(const Point& x, double time) {
    return 0.3 - norm(x - Point{0.35 + 0.15 * time, 0.5, 0.5 + 0.1 * std::sin(2 * time)});
}

CoarseGrid cube() {
    CoarseGrid grid;
    std::vector<Point> corners;
    for (unsigned k = 0; k < 8; ++k)
        corners.push_back({1.0 * (k & 1U), 1.0 * (k >> 1U & 1U), 1.0 * (k >> 2U)});
    grid.nodes = Coordinates(std::move(corners));
    grid.add(Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    return grid;
}

/// What a solver has at one time: an adaptive grid of its own, and values at its nodes.
struct Frame {
    explicit Frame(double at) : time{at} {
        for (int level = 0; level < 5; ++level) {
            grid.adapt([&](const Leaf& leaf) {
                const double size = norm(leaf.corners[7] - leaf.corners[0]);
                return level < 2 || std::abs(drop(leaf.centre(), time)) < size / 2 ? Mark::refine
                                                                                   : Mark::keep;
            });
        }
        for (const Point& x : grid.node_positions()) values.push_back(drop(x, time));
    }

    double time;
    Grid grid{cube()};
    std::vector<double> values;
};

/// Writes a file that appears complete, by rename, or not at all.
template <class Write>
void publish(const std::string& path, const Write& write) {
    if (!write(path + ".part")) throw IoError(path + " could not be written");
    std::filesystem::rename(path + ".part", path);
}

/// Pictures in a folder, and the list of them that ParaView opens.
class Film {
public:
    explicit Film(std::string folder) : folder_{std::move(folder)} {}

    void add(const Surface<3>& surface, double time) {
        char name[32];
        std::snprintf(name, sizeof name, "drop_%04d.vtp", count_++);
        list_ += "<DataSet timestep=\"" + std::to_string(time) + "\" file=\"" + name + "\"/>\n";
        if (folder_.empty()) return;
        publish(folder_ + "/" + name, [&](const std::string& path) {
            const vtkNew<vtkXMLPolyDataWriter> writer;
            writer->SetInputData(make_poly_data(surface));
            writer->SetFileName(path.c_str());
            return writer->Write() == 1 && writer->GetErrorCode() == 0;
        });
    }
    void finish() const {
        if (folder_.empty()) return;
        publish(folder_ + "/drop.pvd", [&](const std::string& path) {
            std::ofstream file(path);
            file << "<VTKFile type=\"Collection\"><Collection>\n"
                 << list_ << "</Collection></VTKFile>\n";
            return !file.flush().fail();
        });
    }

private:
    std::string folder_;
    std::string list_;
    int count_ = 0;
};

/// Draws the pictures at some times between two frames.
/// \return the number of open edges of all of them
std::size_t draw(const Frame& a, const Frame& b, const std::vector<double>& times, Film& film) {
    std::size_t open = 0;
    // [between]
    const Field first_values(a.grid, a.values);
    const Field second_values(b.grid, b.values);
    const Union both(a.grid, first_values, b.grid, second_values);  // a grid like any other
    const UnionFrame first = both.frame(0);
    const UnionFrame second = both.frame(1);
    const HierarchicalIndicator of_first(both, first);  // the only passes over the grids
    const HierarchicalIndicator of_second(both, second);
    for (const double t : times) {
        const std::vector<float> weights = linear_weights(std::array{a.time, b.time}, t);
        const KeyFrames indicator({&of_first, &of_second}, weights);
        const Between field({&first, &second}, weights);
        const Threshold s(&indicator, 0.005);
        const auto drawn = isosurface(both, field, 0.0, under(s, indicator));
        const SurfaceReport report = surface_report(drawn.surface);
        std::printf("time %.3f: %5zu triangles, volume %.5f, %zu open edges\n", t, report.triangles,
                    report.volume, report.open_edges);
        film.add(drawn.surface, t);
        open += report.open_edges;
    }
    // [between]
    return open;
}

/// \return exit status: 1 where a surface is open
int run(int pictures, const std::string& folder) {
    const std::vector<double> times{0, 1, 2};
    Film film(folder);
    auto before = std::make_unique<const Frame>(times[0]);
    std::size_t open = 0;
    for (std::size_t i = 1; i < times.size(); ++i) {
        auto after = std::make_unique<const Frame>(times[i]);
        std::vector<double> between;
        for (int k = 0; k < pictures; ++k) {
            const double t = times.back() * k / (pictures - 1);
            if (t >= times[i - 1] && (t < times[i] || i + 1 == times.size())) between.push_back(t);
        }
        open += draw(*before, *after, between, film);
        before = std::move(after);
    }
    film.finish();
    return open == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const int pictures = argc > 1 ? std::atoi(argv[1]) : 9;
    if (pictures < 2 || argc > 3) {
        std::fprintf(stderr, "usage: film [PICTURES, at least 2 [FOLDER]]\n");
        return 2;
    }
    try {
        return run(pictures, argc > 2 ? argv[2] : "");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "film: %s\n", error.what());
        return 1;
    }
}
