// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <projection/drawn_within.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include <nestgrid/error.hpp>

namespace nestgrid::engine {

void refuse_collapse(const Projection& projection, const char* drawing) {
    if (projection.collapse) {
        throw InvalidInput(std::string("edges of ") + drawing + " are not collapsed");
    }
}
void refuse_budget(const Projection& projection, const char* drawing) {
    if (projection.max_triangles > 0) {
        throw InvalidInput(std::string("no threshold is searched for a number of triangles of ") +
                           drawing);
    }
}
void refuse_distance(const Projection& projection) {
    if (projection.keeps_distance) {
        throw InvalidInput("distances are kept by isosurfaces in space only");
    }
}
void refuse_tolerance(const Projection& projection) {
    if (projection.colour_tolerance > 0) {
        throw InvalidInput(
            "triangles are split for their colours on slices, boundaries and shadings only");
    }
}
void refuse_slice_distance(const Projection& projection) {
    if (projection.slice_distance > 0) {
        throw InvalidInput("the distance of a slice without a cap is asked for, but none is drawn");
    }
}

void refuse_all_but_budgets(const Projection& projection, const char* drawing) {
    refuse_collapse(projection, drawing);
    refuse_distance(projection);
    refuse_slice_distance(projection);
    refuse_tolerance(projection);
}

void check_one_walk(const Prerolls& prerolls, const Projection& projection, const Work& work,
                    const char* drawing) {
    check_first(prerolls, projection, work, drawing, [&] {
        refuse_all_but_budgets(projection, drawing);
        refuse_budget(projection, drawing);
    });
}

Projection told(Projection projection) {
    projection.check();
    if (projection.draws_everything()) projection.threshold = 0;
    return projection;
}

std::shared_ptr<const HighOrder> polynomials_for(const Prerolls& prerolls,
                                                 const Projection& projection, const Work& work) {
    std::shared_ptr<const HighOrder> data;
    if (projection.asks_for_error()) data = prerolls.high_order(work);
    if (projection.position_error > 0 && (data == nullptr || data->geometry_degree() == 1)) {
        throw InvalidInput(
            "an error of positions is asked for, which is for curved cells that are drawn within "
            "an error");
    }
    if (data == nullptr) return data;
    projection.require_error_alone(data->greatest_degree());
    if (projection.least_threshold() == 0 && projection.max_triangles == 0) {
        throw InvalidInput("data of higher degree are drawn within an error, which is above 0");
    }
    return data;
}

double range_of(const HighOrder& data) {
    // Bounds are the same at any tolerance.
    const VirtualRefinement coarsest = polynomials_at(
        data, {}, std::numeric_limits<double>::infinity(), isosurfaces_at({}, false));
    return coarsest.bounds().greatest() - coarsest.bounds().least();
}

DrawnParts isosurfaces_at(std::span<const double> isovalues, bool cap) {
    DrawnParts parts;
    parts.values.emplace();
    for (const double isovalue : isovalues) {
        parts.values->push_back(
            {isovalue, cap ? std::numeric_limits<double>::infinity() : isovalue});
    }
    return parts;
}

DrawnParts zeros_of(std::span<const LevelFunction* const> functions, bool cap) {
    DrawnParts parts;
    parts.values.emplace();
    parts.functions.assign(functions.begin(), functions.end());
    parts.boundary = cap;
    return parts;
}

void check_collapse(const HighOrder& data, const Projection& projection) {
    if (data.geometry_degree() > 1) {
        throw InvalidInput("edges of what is drawn of curved cells are not collapsed");
    }
    if (projection.max_triangles > 0 || projection.slice_distance > 0) {
        throw InvalidInput(
            "edges of data of higher degree are collapsed within an error, by no number of "
            "triangles and no distance yet");
    }
    // Below it, leaves might not be halved as often as they must be.
    const int more = greatest_depth - VirtualOptions{}.depth;
    const double least = std::ldexp(data.least_tolerance(), -2 * more) / polynomial_share;
    const double error = projection.least_threshold();
    if (error >= least && std::isfinite(error)) return;
    std::ostringstream text;
    text << "edges of data of higher degree are collapsed within an error of at least " << least;
    throw InvalidInput(text.str());
}

VirtualRefinement polynomials_at(const HighOrder& data, const Projection& projection,
                                 double tolerance, const DrawnParts& parts, int depth) {
    return {data,
            {.tolerance = std::min(tolerance, std::numeric_limits<double>::max()),
             .depth = depth,
             .lens = projection.lens,
             .region = projection.region,
             .position_tolerance = projection.position_error,
             .values = parts.values,
             .functions = parts.functions,
             .boundary = parts.boundary}};
}

TriangleBudget find_tolerance(const HighOrder& data, const Projection& projection,
                              const CountWithin& count, const DrawnParts& parts) {
    const auto at = [&](double tolerance, std::uint64_t most) {
        return count(polynomials_at(data, projection, tolerance, parts), most);
    };
    return least_threshold(at, range_of(data), projection.max_triangles,
                           data.least_tolerance(projection.position_error));
}

}  // namespace nestgrid::engine
