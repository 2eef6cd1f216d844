// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <vtkNew.h>
#include <vtkPNGWriter.h>

namespace {

constexpr std::uint32_t whole = 65535;

std::uint8_t byte_of(std::uint32_t part, std::uint32_t of) {
    if (of == 0) return 0;
    return static_cast<std::uint8_t>(std::min(255U, (255 * part + of / 2) / of));
}

}  // namespace

Canvas::Canvas(int width, int height, const std::optional<Colour>& background)
    : width_{width}, height_{height}, transparent_{!background} {
    Pixel ground{};
    for (std::size_t c = 0; background && c < 4; ++c) {
        const double part = c < 3 ? (*background)[c] : 1;
        ground[c] = static_cast<std::uint16_t>(std::lround(part * whole));
    }
    pixels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), ground);
}

void Canvas::lay(vtkImageData* part, int factor, int x, int y) {
    const auto* from = static_cast<const std::uint8_t*>(part->GetScalarPointer());
    const int columns = std::min(part->GetDimensions()[0] / factor, width_ - x);
    const int rows = std::min(part->GetDimensions()[1] / factor, height_ - y);
    const std::ptrdiff_t row = std::ptrdiff_t{4} * part->GetDimensions()[0];
    const auto samples = static_cast<std::uint32_t>(factor * factor);
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            std::array<std::uint32_t, 4> sum{};
            const std::uint8_t* block = from + j * factor * row + std::ptrdiff_t{4} * i * factor;
            for (int k = 0; k < factor; ++k, block += row) {
                for (int l = 0; l < 4 * factor; ++l) {
                    sum[static_cast<std::size_t>(l) % 4] += block[l];
                }
            }
            Pixel& below = pixels_[static_cast<std::size_t>(y + j) * std::size_t(width_) +
                                   static_cast<std::size_t>(x + i)];
            const std::uint32_t opacity = sum[3] * 257 / samples;
            for (std::size_t c = 0; c < 4; ++c) {
                const std::uint32_t covered = below[c] * (whole - opacity) / whole;
                below[c] =
                    static_cast<std::uint16_t>(std::min(whole, sum[c] * 257 / samples + covered));
            }
        }
    }
}

void Canvas::write(const std::filesystem::path& path) const {
    const vtkNew<vtkImageData> image;
    image->SetDimensions(width_, height_, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, transparent_ ? 4 : 3);
    auto* to = static_cast<std::uint8_t*>(image->GetScalarPointer());
    for (const Pixel& pixel : pixels_) {
        const std::uint32_t opacity = transparent_ ? pixel[3] : whole;
        for (std::size_t c = 0; c < 3; ++c) *to++ = byte_of(pixel[c], opacity);
        if (transparent_) *to++ = byte_of(opacity, whole);
    }
    const vtkNew<vtkPNGWriter> writer;
    writer->SetInputData(image);
    writer->SetFileName(path.c_str());
    writer->SetCompressionLevel(9);
    writer->Write();
}
