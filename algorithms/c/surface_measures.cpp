// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/surface_measures.h>

#include <algorithm>
#include <memory>
#include <vector>

#include <nestgrid/algorithms/join_pieces.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>

#include "calls.hpp"
#include "drawn.hpp"

using namespace nestgrid;

namespace {

struct OwnedMeasures {
    SurfaceMeasurement measured;
    std::vector<double> flux;                   // of each component, or none
    std::vector<nestgrid_measures> components;  // as C sees them
};

std::unique_ptr<OwnedMeasures> measure(const Drawn<3>& drawn, int flux_from) {
    const Surface<3>& surface = drawn.result.surface;
    auto owned = std::make_unique<OwnedMeasures>();
    const auto first = static_cast<std::size_t>(std::max(flux_from, 0));
    if (!drawn.part) {
        owned->measured = measure_surface(surface);
        if (flux_from >= 0) owned->flux = flux(surface, owned->measured, first);
        return owned;
    }
    const auto& shared = drawn.part->shared();
    const JoinedPiece joined = detail::join_pieces(surface, drawn.result.names, shared);
    owned->measured = detail::measure_pieces(surface, joined, shared);
    if (flux_from >= 0) owned->flux = detail::flux_of_pieces(surface, joined, shared, first);
    return owned;
}

nestgrid_measures told(const SurfaceMeasures& m, double flux) {
    nestgrid_measures result{};
    result.triangles = m.triangles;
    result.area = m.area;
    std::copy(m.area_vector.begin(), m.area_vector.end(), result.area_vector);
    result.volume = m.volume;
    result.flux = flux;
    if (!m.integrals.empty()) result.integrals = m.integrals.data();
    result.closed = m.closed ? 1 : 0;
    return result;
}

}  // namespace

extern "C" int nestgrid_measure_surface(const nestgrid_surface* surface, int flux_from,
                                        nestgrid_surface_measures* out, char* message,
                                        size_t message_size) {
    return without_exceptions(message, message_size, [&] {
        begin_result(out);
        if (surface == nullptr || surface->owner == nullptr) {
            throw InvalidInput("there is no surface to measure");
        }
        if (surface->dimension != 3) throw InvalidInput("only surfaces in space are measured");
        if (flux_from < -1) throw InvalidInput("no attribute has a number below 0");
        auto owned = measure(*static_cast<const Drawn<3>*>(surface->owner), flux_from);
        const SurfaceMeasurement& measured = owned->measured;
        nestgrid_surface_measures result{};
        double sum = 0;
        for (std::size_t i = 0; i < measured.components.size(); ++i) {
            const double through = flux_from >= 0 ? owned->flux[i] : 0;
            sum += through;
            owned->components.push_back(told(measured.components[i], through));
        }
        result.whole = told(measured.total, sum);
        result.component_count = owned->components.size();
        if (result.component_count > 0) result.components = owned->components.data();
        if (!measured.component_of.empty()) result.component_of = measured.component_of.data();
        result.owner = owned.release();
        write_result(result, out);
        return 0;
    });
}

extern "C" void nestgrid_surface_measures_free(nestgrid_surface_measures* measures) {
    delete static_cast<OwnedMeasures*>(measures->owner);
    write_result(nestgrid_surface_measures{}, measures);
}
