// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The colours of a surface beside the data that they show.
#pragma once

#include <nestgrid/algorithms/refine_colours.hpp>

namespace nestgrid::engine {

/// A point of a triangle or a side: a weighted mean of vertices.
struct ColourSample {
    Surface<3>::Simplex vertices;
    std::array<double, 3> weights;
};

/// Attributes of a surface and the data, whose last components they are. Borrows both.
class ProbedColours {
public:
    /// Requires a surface with vertices.
    ProbedColours(Surface<3>& surface, const detail::ProbePoints& probe);

    /// The greatest difference between data and colours at each sample; 0 outside the domain.
    /// \throw InvalidInput where the surface has more attributes than the data have components
    std::vector<double> misses_at(std::span<const ColourSample> samples) const;
    /// Gives the data at their places to all vertices from a number on, but those outside the
    /// domain. \throw InvalidInput as misses_at()
    void colour_from(std::size_t first);

private:
    Point position(const ColourSample& sample) const;
    double colour(const ColourSample& sample, std::size_t attribute) const;
    ProbeResult probe(std::span<const Point> points) const;
    const double* values_of(const ProbeResult& probed, std::size_t point) const;

    Surface<3>& surface_;
    const detail::ProbePoints& probe_;
    std::size_t count_;  // attributes of a vertex
};

}  // namespace nestgrid::engine
