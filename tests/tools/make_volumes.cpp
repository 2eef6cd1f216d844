// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes volumes to the folder given: a small one of 8-bit samples in every format that the program
// reads, and some that it must refuse; or, with the further argument "large", one of 14 MB of
// 16-bit samples in every format that VTK writes, and bare.
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <vtkImageCast.h>
#include <vtkImageData.h>
#include <vtkMetaImageWriter.h>
#include <vtkNIFTIImageWriter.h>
#include <vtkNew.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "lagrange_meshes.hpp"

namespace {

constexpr int nx = 20;
constexpr int ny = 24;
constexpr int nz = 18;

template <class Writer>
void write(vtkImageData* image, const std::string& name) {
    const vtkNew<Writer> writer;
    writer->SetInputData(image);
    writer->SetFileName(name.c_str());
    writer->Write();
}

/// Bends the unit cube into a part of a shell of radius 1 to 2, the square into one of a ring.
nestgrid_test::Mesh bent(nestgrid_test::Mesh mesh) {
    for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) {
        double* const x = &mesh.coordinates[i];
        const double radius = 1 + x[0];
        const double along = 1.5 * x[1];
        const double up = x[2];
        x[0] = radius * std::cos(up) * std::cos(along);
        x[1] = radius * std::cos(up) * std::sin(along);
        x[2] = radius * std::sin(up);
    }
    return mesh;
}

/// A solution of degree p in hexahedra, or in quadrilaterals: in straight cells, or in curved ones.
void write_solution(const std::string& name, int dimension, int p, bool curved) {
    using nestgrid::Point;
    using nestgrid::operator-;
    const nestgrid_test::Mesh box =
        nestgrid_test::lagrange_box(dimension, 3, p, {.own_points = true});
    const nestgrid_test::Mesh mesh = curved ? bent(box) : box;
    const vtkNew<vtkUnstructuredGrid> cells;
    nestgrid_test::to_vtk(mesh, *cells);
    const auto bump = [](const Point& x) {
        const Point off = x - Point{0.35, 0.6, 0.4};
        return std::exp(-12 * nestgrid::dot(off, off)) + x[0] / 5;
    };
    nestgrid_test::add_values(*cells, "u", bump);
    nestgrid_test::add_values(*cells, "radius", [](const Point& x) { return nestgrid::norm(x); });
    if (curved) nestgrid_test::add_values(*cells, "stress", bump);
    const vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(cells);
    writer->SetFileName(name.c_str());
    writer->Write();
}

void write_solutions(const std::string& folder) {
    write_solution(folder + "solution.vtu", 3, 4, false);
    write_solution(folder + "plane.vtu", 2, 4, false);
    write_solution(folder + "shell.vtu", 3, 2, true);
    write_solution(folder + "ring.vtu", 2, 2, true);
}

/// A ball of radius 50 and value 600 around the centre, and noise.
int write_large(const std::string& folder) {
    constexpr int n = 256;
    constexpr int slices = 108;
    const vtkNew<vtkImageData> image;
    image->SetDimensions(n, n, slices);
    image->AllocateScalars(VTK_SHORT, 1);
    auto* samples = static_cast<short*>(image->GetScalarPointer());
    for (int z = 0, i = 0; z < slices; ++z) {
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x, ++i) {
                const unsigned noise = (static_cast<unsigned>(i) * 2654435761U) >> 30U;
                samples[i] =
                    static_cast<short>(1000 - 8 * std::hypot(x - 120, y - 125, z - 53) + noise);
            }
        }
    }
    const auto size = static_cast<std::streamsize>(sizeof(short)) * n * n * slices;
    std::ofstream(folder + "large.raw", std::ios::binary)
        .write(reinterpret_cast<char*>(samples), size);
    write<vtkXMLImageDataWriter>(image, folder + "large.vti");
    write<vtkMetaImageWriter>(image, folder + "large_packed.mhd");
    write<vtkMetaImageWriter>(image, folder + "large_packed.mha");
    write<vtkNIFTIImageWriter>(image, folder + "large.nii");
    write<vtkNIFTIImageWriter>(image, folder + "large.nii.gz");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string folder = std::string(argv[1]) + "/";
    if (argc > 2) return write_large(folder);
    const vtkNew<vtkImageData> image;
    image->SetDimensions(nx, ny, nz);
    image->SetSpacing(0.5, 1, 2);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
    auto* samples = static_cast<unsigned char*>(image->GetScalarPointer());
    for (int z = 0, i = 0; z < nz; ++z) {
        for (int y = 0; y < ny; ++y) {
            for (int x = 0; x < nx; ++x, ++i) {
                samples[i] =
                    static_cast<unsigned char>(250 - 20 * std::hypot(x - 9.0, y - 11.0, z - 8.0));
                if (std::hypot(x - 9.0, y - 11.0, z - 8.0) > 12) samples[i] = 10;
            }
        }
    }
    write<vtkXMLImageDataWriter>(image, folder + "v.vti");
    write<vtkMetaImageWriter>(image, folder + "v.mhd");
    write<vtkMetaImageWriter>(image, folder + "v.mha");
    write<vtkNIFTIImageWriter>(image, folder + "v.nii");
    write<vtkNIFTIImageWriter>(image, folder + "v.nii.gz");
    const auto size = static_cast<std::streamsize>(nx) * ny * nz;
    std::ofstream(folder + "v.raw", std::ios::binary).write(reinterpret_cast<char*>(samples), size);
    std::ofstream nrrd(folder + "v.nrrd", std::ios::binary);
    nrrd << "NRRD0004\ntype: unsigned char\ndimension: 3\nsizes: 20 24 18\n"
            "space: left-posterior-superior\nspace directions: (0.5,0,0) (0,1,0) (0,0,2)\n"
            "space origin: (0,0,0)\nencoding: raw\nendian: little\n\n";
    nrrd.write(reinterpret_cast<char*>(samples), size);
    std::ofstream(folder + "v.nhdr", std::ios::binary)
        << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 24 18\nspacings: 0.5 1 2\n"
           "encoding: raw\ndata file: v.raw\n\n";

    const vtkNew<vtkImageCast> cast;
    cast->SetInputData(image);
    cast->SetOutputScalarTypeToFloat();
    cast->Update();
    vtkImageData* real = cast->GetOutput();
    write<vtkXMLImageDataWriter>(real, folder + "float.vti");
    static_cast<float*>(real->GetScalarPointer())[5 + nx * (7 + ny * 3)] =
        std::numeric_limits<float>::quiet_NaN();
    write<vtkXMLImageDataWriter>(real, folder + "nan.vti");

    const vtkNew<vtkImageData> flat;
    flat->SetDimensions(5, 5, 1);
    flat->AllocateScalars(VTK_FLOAT, 1);
    write<vtkXMLImageDataWriter>(flat, folder + "flat.vti");
    const vtkNew<vtkImageData> colours;
    colours->SetDimensions(5, 5, 5);
    colours->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    write<vtkXMLImageDataWriter>(colours, folder + "colours.vti");
    write_solutions(folder);
    return 0;
}
