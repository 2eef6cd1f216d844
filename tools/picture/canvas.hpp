// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <vtkImageData.h>

#include "picture/colour_map.hpp"

/// The pixels of a picture, upon which rendered parts are laid.
class Canvas {
public:
    /// \param background none: transparent
    Canvas(int width, int height, const std::optional<Colour>& background);

    /// Lays a part over what is there.
    /// \param part red, green, blue, each multiplied by the opacity, and the opacity, 8 bits each
    /// \param factor so many of its pixels on a side become one, their mean
    /// \param x, y where its lower left corner comes to lie
    void lay(vtkImageData* part, int factor, int x, int y);

    /// Writes a PNG, with opacity where the background is transparent.
    void write(const std::filesystem::path& path) const;

private:
    using Pixel = std::array<std::uint16_t, 4>;  ///< multiplied by the opacity, the last

    int width_;
    int height_;
    bool transparent_;
    std::vector<Pixel> pixels_;
};
