// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compressed values on octrees over samples: bytes a sample, beside gzip and zstd of the raw
// samples, which must be unpacked whole, and what decoding adds to an isosurface. Volumes: the
// bucky ball and noise; and NIfTI files of 8 bits that are named. One "name value" line per figure;
// --quick takes smaller ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <zlib.h>
#include <zstd.h>

#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/compressed_field.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "bucky_ball.hpp"
#include "contest.hpp"

namespace {

using namespace nestgrid;

struct Volume {
    std::string name;
    std::array<int, 3> samples;
    std::vector<float> values;
    double isovalue;
    bool bytes;  // integers of 8 bits
};

std::size_t gzip_size(const std::vector<unsigned char>& raw) {
    uLongf size = compressBound(static_cast<uLong>(raw.size()));
    std::vector<unsigned char> packed(size);
    compress2(packed.data(), &size, raw.data(), static_cast<uLong>(raw.size()), 6);
    return size;
}

std::size_t zstd_size(const std::vector<unsigned char>& raw) {
    std::vector<unsigned char> packed(ZSTD_compressBound(raw.size()));
    return ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), 19);
}

std::vector<unsigned char> raw_bytes(const Volume& volume) {
    std::vector<unsigned char> raw;
    if (volume.bytes) {
        for (const float value : volume.values) raw.push_back(static_cast<unsigned char>(value));
        return raw;
    }
    raw.resize(volume.values.size() * sizeof(float));
    std::memcpy(raw.data(), volume.values.data(), raw.size());
    return raw;
}

void measure(const Volume& volume, std::size_t rounds) {
    using Octree = LatticeOctree<3>;
    const auto [nx, ny, nz] = volume.samples;
    const Octree grid({.samples = {nx, ny, nz}});
    const LatticeField field(grid, std::span<const float>(volume.values));
    const auto samples = static_cast<double>(volume.values.size());
    const auto print = [&](const std::string& what, double value) {
        Contest::print_figure(volume.name + "_" + what, value);
    };
    const std::vector<unsigned char> raw = raw_bytes(volume);
    print("raw_bytes_a_sample", static_cast<double>(raw.size()) / samples);
    print("gzip_bytes_a_sample", static_cast<double>(gzip_size(raw)) / samples);
    print("zstd_bytes_a_sample", static_cast<double>(zstd_size(raw)) / samples);
    const CompressedValues<float> exact(erase(grid, field), {.step = volume.bytes ? 1.0 : 0.0});
    print("exact_bytes_a_sample", static_cast<double>(exact.memory_bytes()) / samples);
    if (!volume.bytes) {
        const CompressedValues<float> quantised(erase(grid, field), {.step = 0x1p-10});
        print("within_2_to_minus_11_bytes_a_sample",
              static_cast<double>(quantised.memory_bytes()) / samples);
    }
    const CompressedField<Octree, float> decoded(grid, exact);
    const HierarchicalIndicator indicator(grid, field);
    const Threshold criterion(&indicator, 0);
    std::size_t triangles = 0;
    Contest contest(rounds);
    contest.add("stored", [&] {
        triangles = isosurface(grid, field, volume.isovalue, under(criterion, indicator))
                        .surface.simplices.size();
    });
    contest.add("decoded",
                [&] { isosurface(grid, decoded, volume.isovalue, under(criterion, indicator)); });
    contest.add("preroll_of_decoded", [&] { HierarchicalIndicator of_decoded(grid, decoded); });
    contest.run();
    print("triangles", static_cast<double>(triangles));
    print("isosurface_decoded_to_stored", contest.time("decoded") / contest.time("stored"));
    print("decoded_ns_a_sample", contest.time("preroll_of_decoded") * 1e6 / samples);
}

Volume read(const std::string& file) {
    vtkNew<vtkNIFTIImageReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkImageData* image = reader->GetOutput();
    vtkDataArray* from = image->GetPointData()->GetScalars();
    const int* n = image->GetDimensions();
    Volume volume{"file", {n[0], n[1], n[2]}, {}, 95, true};
    for (vtkIdType i = 0; i < from->GetNumberOfTuples(); ++i) {
        volume.values.push_back(static_cast<float>(from->GetTuple1(i)));
    }
    return volume;
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
    const int n = quick ? 33 : 129;
    const std::size_t rounds = quick ? 1 : 5;
    Volume bucky{"bucky_ball", {n, n, n}, bucky_ball(n), 0.275, false};
    measure(bucky, rounds);
    for (float& value : bucky.values) value = std::round(255 * std::clamp(value, 0.0F, 1.0F));
    bucky.name = "bucky_ball_of_8_bits";
    bucky.isovalue = 70;
    bucky.bytes = true;
    measure(bucky, rounds);
    std::mt19937 random(1);
    Volume noise{"noise", {n, n, n}, bucky.values, 0.5, false};
    for (float& value : noise.values) value = static_cast<float>(random()) * 0x1p-32F;
    measure(noise, rounds);
    for (int i = quick ? 2 : 1; i < argc; ++i) measure(read(argv[i]), rounds);
    return 0;
}
