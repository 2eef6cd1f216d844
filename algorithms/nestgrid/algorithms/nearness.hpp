// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// A surface, and how near to it another one is to be, there and back.
struct Nearness {
    const Surface<3>& whole;  ///< that of all data: isosurface() or slice() under Exact
    double distance;          ///< positive, in units of length

    /// \throw InvalidInput where the distance is not a positive number
    void require() const;
};

}  // namespace nestgrid
