// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures, read by VTK: samples in a plane; the pages of a TIFF file are samples in space.
#include <array>
#include <fstream>

#include <vtkImageReader2.h>
#include <vtkImageReader2Factory.h>
#include <vtkPointData.h>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/volumes/vtk_reading.hpp"

namespace {

using nestgrid::IoError;
namespace fs = std::filesystem;

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

FileSamples read_picture(const fs::path& path, const WantedSamples& /*wanted*/) {
    check_grey_map(path);
    const auto reader = vtkSmartPointer<vtkImageReader2>::Take(
        vtkImageReader2Factory::CreateImageReader2(path.c_str()));
    if (reader == nullptr) throw IoError(path.string() + " is no picture that can be read");
    const VtkReading reading(path);
    reading.listen(reader);
    reader->SetFileName(path.c_str());
    const vtkSmartPointer<vtkImageData> image = reading.read_samples(reader);
    vtkDataArray* const pixels = image->GetPointData()->GetScalars();
    if (pixels == nullptr) throw IoError(path.string() + " holds no picture");
    FileSamples samples{.path = path};
    set_geometry(samples, image);
    set_numbers(samples, pixels);
    constexpr std::array kinds{"", "grey and opacity", "colour", "colour and opacity"};
    const std::size_t count = samples.components.count;
    if (count >= 1 && count <= kinds.size()) samples.component_kind = kinds[count - 1];
    return samples;
}

const RegisteredFormat picture({.name = "picture",
                                .endings = {".png", ".tif", ".tiff", ".jpg", ".jpeg", ".bmp",
                                            ".pgm", ".pnm"},
                                .holds = "samples in a plane; pages of .tif in space",
                                .read_samples = read_picture});

}  // namespace
