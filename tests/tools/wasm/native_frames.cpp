// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes volumes to the folder given, as NRRD files, of samples that are computed with as float and
// as double. Beside each, writes the requests and frames of an Explorer as this machine computes
// them: name.requests, one a line, and name.0, name.1, ... for frames_test.mjs.
#include <cmath>
#include <fstream>
#include <string>

#include <view/explored_samples.hpp>
#include <view/explorer.hpp>

namespace {

using nestgrid::LatticeGeometry;
using nestgrid::view::Explorer;

/// Two balls that melt into each other, by sums and products alone, which all machines round alike.
double two_balls(double x, double y, double z) {
    const auto ball = [&](double at) {
        const double r = (x - at) * (x - at) + (y - 0.5) * (y - 0.5) + (z - 0.4) * (z - 0.4);
        return 1 / (1 + 30 * r);
    };
    return ball(0.3) + 0.8 * ball(0.7);
}

template <class Sample>
std::vector<Sample> samples_of(const LatticeGeometry<3>& g) {
    const double scale = std::is_floating_point_v<Sample> ? 1 : 80;
    const auto coordinate = [&](int i, std::size_t d) { return i / (g.samples[d] - 1.0); };
    std::vector<Sample> samples;
    for (int z = 0; z < g.samples[2]; ++z) {
        for (int y = 0; y < g.samples[1]; ++y) {
            for (int x = 0; x < g.samples[0]; ++x) {
                const double value =
                    two_balls(coordinate(x, 0), coordinate(y, 1), coordinate(z, 2));
                samples.push_back(static_cast<Sample>(scale * value));
            }
        }
    }
    return samples;
}

void write_nrrd(const std::string& path, const std::string& type, const LatticeGeometry<3>& g,
                std::span<const std::byte> bytes) {
    std::ofstream file(path, std::ios::binary);
    file.precision(17);
    const auto axis = [&](std::size_t d) {
        file << " (";
        for (std::size_t r = 0; r < 3; ++r) {
            file << (r > 0 ? "," : "") << g.direction[r][d] * g.spacing[d];
        }
        file << ")";
    };
    file << "NRRD0004\ntype: "
         << (type == "float32"   ? "float"
             : type == "float64" ? "double"
                                 : type)
         << "\ndimension: 3\nsizes: " << g.samples[0] << " " << g.samples[1] << " " << g.samples[2]
         << "\nspace dimension: 3\nspace directions:";
    for (std::size_t d = 0; d < 3; ++d) axis(d);
    file << "\nspace origin: (" << g.origin[0] << "," << g.origin[1] << "," << g.origin[2]
         << ")\nencoding: raw\nendian: little\n\n";
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

/// What the page asks for, at a scale of values.
std::vector<std::string> requests(double scale) {
    const auto at = [&](double value) { return std::to_string(value * scale); };
    std::vector<std::string> list;
    for (const char* const indicator : {"offset", "visual", "numerical", "wavelet"}) {
        for (const double threshold : {0.0, 0.01, 0.05}) {
            list.push_back("isovalue=" + at(0.6) + "&threshold=" + at(threshold) +
                           "&indicator=" + indicator + "&normals=float32");
        }
    }
    list.push_back("isovalue=" + at(0.5) + "&triangles=1500&motion=settled&normals=int8");
    for (int i = 0; i < 5; ++i) {
        list.push_back("isovalue=" + at(0.5 + 0.05 * i) +
                       "&triangles=1500&motion=moving&normals=int8");
    }
    for (const char* const more : {"", "&motion=moving", "&collapse=on", "&axis=z&at=0.4"}) {
        list.push_back("isovalue=" + at(0.6) + "&error=" + at(0.03) + "&normals=int8" + more);
    }
    list.push_back("isovalue=" + at(0.6) + "&distance=0.01");
    list.push_back("isovalue=" + at(0.62) + "&distance=0.01&motion=moving");
    list.push_back("axis=z&at=0.4&threshold=" + at(0.02) + "&outlines=on");
    list.push_back("isovalue=" + at(0.6) + "&plane=0.4,0.5,0.4,1,2,3&triangles=2000");
    list.push_back("isovalue=" + at(0.6) + "&threshold=0&lens=0.5,0.5,0.4,0.1&slope=1");
    list.push_back("isovalue=" + at(1000) + "&threshold=0");
    const std::string sphere = "&sphere=0.5,0.5,0.4,0.3";
    list.push_back("band=" + at(0.5) + "," + at(0.6) + "&threshold=" + at(0.01) + "&report=on");
    list.push_back("isovalue=" + at(0.6) + "&threshold=" + at(0.02) + "&blend=2&at_nodes=on");
    list.push_back("isovalue=" + at(0.6) + "&threshold=" + at(0.05) +
                   "&box=0.2,0.5,0.2,0.6,0,1&box_threshold=" + at(0.001) + "&cuts=linear");
    list.push_back("isovalue=" + at(0.6) + "&distance=0.02&distance_field=on&measure=on");
    list.push_back("threshold=" + at(0.02) + sphere + "&lines=" + at(0.5) + "," + at(0.7) +
                   "&colour_tolerance=" + at(0.01));
    list.push_back("error=" + at(0.03) + sphere + "&collapse=on&slice_distance=0.02");
    return list;
}

template <class Sample>
void write(const std::string& folder, const std::string& type, const LatticeGeometry<3>& g) {
    const std::string name = folder + "/" + type + "_" + std::to_string(g.samples[0]);
    const std::vector<Sample> samples = samples_of<Sample>(g);
    write_nrrd(name + ".nrrd", type, g, std::as_bytes(std::span(samples)));
    const nestgrid::SequentialExecutor executor;
    Explorer explorer(nestgrid::view::explored_samples(g, std::span<const Sample>(samples)),
                      executor);
    std::ofstream texts(name + ".requests");
    int count = 0;
    for (const std::string& request : requests(std::is_floating_point_v<Sample> ? 1 : 80)) {
        texts << request << "\n";
        const std::vector<std::byte> frame = explorer.frame(request);
        std::ofstream(name + "." + std::to_string(count++), std::ios::binary)
            .write(reinterpret_cast<const char*>(frame.data()),
                   static_cast<std::streamsize>(frame.size()));
    }
}

}  // namespace

int main(int, char** argv) {
    LatticeGeometry<3> whole;
    whole.samples = {33, 33, 33};
    whole.spacing = {1.0 / 32, 1.0 / 32, 1.0 / 32};
    LatticeGeometry<3> padded;
    padded.samples = {20, 24, 18};
    padded.spacing = {1.0 / 16, 1.0 / 16, 1.0 / 16};
    padded.origin = {-0.25, 0.125, 0};
    // Left-handed, with axes across those of space.
    padded.direction = {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}};
    for (const LatticeGeometry<3>& g : {whole, padded}) {
        write<std::uint8_t>(argv[1], "uint8", g);
        write<std::int32_t>(argv[1], "int32", g);
        write<float>(argv[1], "float32", g);
        write<double>(argv[1], "float64", g);
    }
    return 0;
}
