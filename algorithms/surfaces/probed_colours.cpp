// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/probed_colours.hpp>

#include <algorithm>
#include <cmath>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

ProbedColours::ProbedColours(Surface<3>& surface, const detail::ProbePoints& probe)
    : surface_{surface},
      probe_{probe},
      count_{surface.attributes.size() / surface.vertices.size()} {}

Point ProbedColours::position(const ColourSample& sample) const {
    Point x{};
    for (std::size_t i = 0; i < 3; ++i) {
        x = x + sample.weights[i] * surface_.vertices[sample.vertices[i]];
    }
    return x;
}

double ProbedColours::colour(const ColourSample& sample, std::size_t attribute) const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        sum += sample.weights[i] * surface_.attributes[sample.vertices[i] * count_ + attribute];
    }
    return sum;
}

ProbeResult ProbedColours::probe(std::span<const Point> points) const {
    ProbeResult probed = probe_(points);
    if (probed.components < count_) {
        throw InvalidInput("the surface has more attributes than the field has components");
    }
    return probed;
}

/// The components that are attributes of the surface.
const double* ProbedColours::values_of(const ProbeResult& probed, std::size_t point) const {
    return &probed.values[(point + 1) * probed.components - count_];
}

std::vector<double> ProbedColours::misses_at(std::span<const ColourSample> samples) const {
    std::vector<Point> points;
    points.reserve(samples.size());
    for (const ColourSample& sample : samples) points.push_back(position(sample));
    const ProbeResult probed = probe(points);
    std::vector<double> misses(samples.size(), 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!probed.found(i)) continue;
        const double* values = values_of(probed, i);
        for (std::size_t k = 0; k < count_; ++k) {
            misses[i] = std::max(misses[i], std::abs(values[k] - colour(samples[i], k)));
        }
    }
    return misses;
}

void ProbedColours::colour_from(std::size_t first) {
    const std::span<const Point> points = std::span(surface_.vertices).subspan(first);
    const ProbeResult probed = probe(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!probed.found(i)) continue;
        std::copy_n(values_of(probed, i), count_, &surface_.attributes[(first + i) * count_]);
    }
}

}  // namespace nestgrid::engine
