// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// OpenVDB's isosurface of samples, behind an interface without its headers.
#pragma once

#include <memory>
#include <vector>

class OpenVdbVolume {
public:
    /// n samples along each direction, x fastest, in a dense grid.
    OpenVdbVolume(const std::vector<float>& samples, int n);
    ~OpenVdbVolume();

    /// \return triangles, quadrilaterals counted as two
    std::size_t mesh(double isovalue) const;

private:
    struct Grid;
    std::unique_ptr<Grid> grid_;
};
