// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far an isosurface is from that of all data, measured at points: what bounds promise before it
// is drawn, seen afterwards.
//
// Points stand at the corners of all triangles and, evenly, on them. Means are over the area. The
// greatest numbers are those of the points; a distance elsewhere is greater by `reach` at most.
#pragma once

#include <cstddef>

#include <nestgrid/algorithms/prerolls.hpp>
#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/algorithms/watch.hpp>

namespace nestgrid {

/// A number that is measured all over a surface; 0 where that is empty.
struct Measured {
    double greatest = 0;
    double mean = 0;
    double rms = 0;
};

/// How far an isosurface was found to be from the data and from the isosurface of all data.
struct MeasuredError {
    Measured value;     ///< |U - C| on what is drawn, in the units of the data
    Measured distance;  ///< from what is drawn to the surface of all data, in units of length
    Measured back;      ///< from the surface of all data to what is drawn
    double reach = 0;   ///< no point of the surfaces is farther from those that were measured
    std::size_t points = 0;
};

/// How far an isosurface is from the data and from that of all data. Distances are infinite where
/// only one of the surfaces is empty.
/// \param drawn the surface of a projection, perhaps with collapsed edges
/// \param whole the isosurface of all data: isosurface() without a projection
/// \param isovalue C
/// \param points about how many, on each surface; each has those at its triangles at least
/// \throw InvalidInput where the isovalue is not finite, `points` is 0, or the dimension is not 3
MeasuredError measure_error(const Prerolls& prerolls, const Surface<3>& drawn,
                            const Surface<3>& whole, double isovalue, std::size_t points = 200000,
                            const Work& work = {});
/// The same, which draws the isosurface of all data: of data of higher degree that within a tenth
/// of what they are found to be off.
MeasuredError measure_error(const Prerolls& prerolls, const Surface<3>& drawn, double isovalue,
                            std::size_t points = 200000, const Work& work = {});

}  // namespace nestgrid
