// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkImageReader2Factory.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

#include <nestgrid/error.hpp>

#include "child_process.hpp"
#include "input_file.hpp"
#include "vtk_errors.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::InvalidInput;
using nestgrid::IoError;

/// \throw IoError where a portable grey map holds fewer bytes than its header says, which VTK does
///        not notice
void check_grey_map(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string magic;
    std::array<std::uintmax_t, 3> header{};  // width, height, greatest value
    file >> magic;
    if (magic != "P5") return;
    for (std::uintmax_t& number : header) {
        while (file >> std::ws && file.peek() == '#') std::getline(file, magic);
        file >> number;
    }
    file.get();
    const auto begin = static_cast<std::uintmax_t>(file.tellg());
    const auto& [width, height, greatest] = header;
    if (!file || width > 1U << 20U || height > 1U << 20U) {
        throw IoError(path.string() + " has a damaged header");
    }
    const std::uintmax_t needed = width * height * (greatest > 255 ? 2 : 1);
    if (fs::file_size(path) - begin < needed) {
        throw IoError(path.string() + " is cut off: it has " +
                      std::to_string(fs::file_size(path) - begin) + " bytes of pixels, not " +
                      std::to_string(needed));
    }
}

/// Puts the geometry and the samples of a picture into a parcel.
void read_picture(const fs::path& path, Parcel& parcel) {
    check_grey_map(path);
    const auto reader = vtkSmartPointer<vtkImageReader2>::Take(
        vtkImageReader2Factory::CreateImageReader2(path.c_str()));
    if (reader == nullptr) throw IoError(path.string() + " is no picture that can be read");
    const vtkNew<ErrorCollector> errors;
    reader->AddObserver(vtkCommand::ErrorEvent, errors);
    reader->AddObserver(vtkCommand::WarningEvent, errors);
    reader->SetFileName(path.c_str());
    reader->Update();
    if (!errors->message.empty()) throw IoError(path.string() + ": " + errors->message);
    vtkDataArray* pixels = reader->GetOutput()->GetPointData()->GetScalars();
    if (pixels == nullptr) throw IoError(path.string() + " holds no picture");
    if (pixels->GetNumberOfComponents() != 1) {
        throw InvalidInput(path.string() + " has " +
                           std::to_string(pixels->GetNumberOfComponents()) +
                           " numbers per pixel, not one grey value");
    }
    nestgrid::LatticeGeometry<2> geometry;
    const int* dims = reader->GetOutput()->GetDimensions();
    geometry.samples = {dims[0], dims[1]};
    std::copy_n(reader->GetOutput()->GetSpacing(), 2, geometry.spacing.begin());
    if (std::min(dims[0], dims[1]) < 2 || dims[2] != 1) {
        throw InvalidInput(path.string() + " has " + std::to_string(dims[0]) + " x " +
                           std::to_string(dims[1]) + " x " + std::to_string(dims[2]) +
                           " pixels; a height field needs at least 2 x 2");
    }
    std::vector<float> samples(static_cast<std::size_t>(pixels->GetNumberOfTuples()));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = static_cast<float>(pixels->GetComponent(static_cast<vtkIdType>(i), 0));
        if (std::isfinite(samples[i])) continue;
        const auto nx = static_cast<std::size_t>(dims[0]);
        throw InvalidInput(path.string() + ": the pixel at (" + std::to_string(i % nx) + ", " +
                           std::to_string(i / nx) + ") is not a finite number");
    }
    parcel.put(std::span<const nestgrid::LatticeGeometry<2>>(&geometry, 1));
    parcel.put(std::span<const float>(samples));
}

}  // namespace

bool is_raster(const fs::path& path) {
    constexpr std::array endings{".png", ".tif", ".tiff", ".jpg", ".jpeg", ".bmp", ".pgm", ".pnm"};
    const std::string ending = ending_of(path);
    return std::ranges::find(endings, ending) != endings.end();
}

Raster read_raster(const fs::path& path, double seconds) {
    require_file(path);
    if (!(seconds > 0)) seconds = reading_time(fs::file_size(path));
    const std::shared_ptr<const Parcel> parcel =
        run_apart(path.string(), seconds, [&](Parcel& to) { read_picture(path, to); });
    return {parcel, parcel->block<nestgrid::LatticeGeometry<2>>(0).front(),
            parcel->block<float>(1)};
}
