// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/make_hierarchy.hpp"

#include <algorithm>
#include <optional>

#include "expression/expression.hpp"
#include "formats.hpp"
#include "input/hierarchy.hpp"
#include "input/input_file.hpp"
#include "input/meshes/mesh_file.hpp"
#include "input/meshes/weld.hpp"

namespace {

using namespace nestgrid;

bool all_simplices(const CoarseGrid& coarse) {
    return std::all_of(coarse.shapes.begin(), coarse.shapes.end(), is_simplex);
}

/// Largest distance of the field from its interpolant at the midpoints of edges and the centre.
double interpolation_error(const Expression& f, double t, const Leaf& leaf) {
    std::array<double, max_corners> value{};
    double sum = 0;
    for (std::size_t i = 0; i < leaf.corners.size(); ++i) {
        value[i] = f(leaf.corners[i], t);
        sum += value[i];
    }
    double error = std::abs(f(leaf.centre(), t) - sum / static_cast<double>(leaf.corners.size()));
    const Topology& shape = topology(leaf.shape);
    for (std::size_t e = 0; e < shape.edges; ++e) {
        const auto [a, b] = shape.edge[e];
        error = std::max(error, std::abs(f(0.5 * (leaf.corners[a] + leaf.corners[b]), t) -
                                         0.5 * (value[a] + value[b])));
    }
    return error;
}

Expression expression_of(const std::string& text, const MeshRequest& request) {
    return Expression(text, request.times.empty() ? Expression::Variables::place
                                                  : Expression::Variables::place_and_time);
}

std::vector<double> times_of(const MeshRequest& request) {
    return request.times.empty() ? std::vector<double>{0} : request.times;
}

/// The values of a field at the nodes, frame after frame.
template <class Grid>
std::vector<double> sample(const Grid& grid, const Expression& f,
                           const std::vector<double>& times) {
    std::vector<double> values;
    for (const double t : times) {
        const std::size_t first = values.size();
        values.resize(first + grid.node_count(), 0);
        grid.for_each_leaf([&](const Leaf& leaf) {
            for (std::size_t i = 0; i < leaf.nodes.size(); ++i) {
                values[first + leaf.nodes[i]] = f(leaf.corners[i], t);
            }
        });
    }
    return values;
}

template <class Grid>
void refine_and_write(Grid grid, const MeshRequest& request) {
    const auto tell = [&](int step) {
        if (!request.progress) return;
        request.progress("step " + std::to_string(step) + ": " + std::to_string(grid.leaf_count()) +
                         " elements");
    };
    // Marks leaves, and stops where there would be too many.
    const auto refine_if = [&](auto&& wanted) {
        std::size_t expected = grid.leaf_count();
        return grid.adapt([&](const Leaf& leaf) {
            if (!wanted(leaf)) return Mark::keep;
            expected += static_cast<std::size_t>(Grid::max_new_nodes == 1 ? 1
                                                 : Grid::dimension == 2   ? 3
                                                                          : 7);
            if (expected > request.maximum_elements) {
                throw InvalidInput("refinement would make more than " +
                                   std::to_string(request.maximum_elements) +
                                   " elements (--max-elements)");
            }
            return Mark::refine;
        });
    };
    for (int i = 0; i < request.refine; ++i) {
        refine_if([](const Leaf&) { return true; });
        tell(i + 1);
    }
    const std::vector<double> times = times_of(request);
    std::vector<NamedField> fields;
    for (const std::string& name : request.fields) {
        const Expression f = expression_of(name, request);
        for (int step = 1; request.tolerance && fields.empty(); ++step) {
            const Adaptation done = refine_if([&](const Leaf& leaf) {
                return leaf.level < request.levels.value_or(30) &&
                       std::ranges::any_of(times, [&](double t) {
                           return interpolation_error(f, t, leaf) > *request.tolerance;
                       });
            });
            tell(step);
            if (done.marked == 0) break;
        }
        fields.push_back({name, sample(grid, f, times)});
    }
    write_hierarchy(grid, request.output, fields,
                    {.times = times, .compression = request.encoding.compression()});
}

void build(CoarseGrid coarse, const MeshRequest& request) {
    const bool plane = coarse.dimension == 2;
    if (request.family == "bisection") {
        return plane ? refine_and_write(BisectionGrid<2>(std::move(coarse)), request)
                     : refine_and_write(BisectionGrid<3>(std::move(coarse)), request);
    }
    if (request.family == "octree") {
        const bool balanced = !request.unbalanced;
        return plane ? refine_and_write(OctreeGrid<2>(std::move(coarse), {balanced}), request)
                     : refine_and_write(OctreeGrid<3>(std::move(coarse), {balanced}), request);
    }
    if (request.family == "prism") return refine_and_write(PrismGrid(std::move(coarse)), request);
    if (all_simplices(coarse)) {
        return plane ? refine_and_write(RedGreenSimplices<2>(std::move(coarse)), request)
                     : refine_and_write(RedGreenSimplices<3>(std::move(coarse)), request);
    }
    return plane ? refine_and_write(RedGreenGrid<2>(std::move(coarse)), request)
                 : refine_and_write(RedGreenGrid<3>(std::move(coarse)), request);
}

void check_fields(const MeshRequest& request) {
    for (const std::string& name : request.fields) {
        expression_of(name, request);  // throws where it is none
        if (std::ranges::count(request.fields, name) > 1) {
            throw InvalidInput("--field names '" + name + "' twice");
        }
    }
    if (request.fields.empty() && (!request.times.empty() || request.encoding.compression())) {
        throw InvalidInput("--times and --encode need a --field");
    }
    if (request.tolerance && request.fields.empty()) {
        throw InvalidInput("--tolerance needs a --field");
    }
    if (request.tolerance && !(*request.tolerance > 0)) {
        throw InvalidInput("--tolerance is not positive");
    }
    if (request.levels && !request.tolerance) {
        throw InvalidInput("--levels limits --tolerance, which is not given");
    }
    if (request.refine < 0) throw InvalidInput("--refine is negative");
    if (request.levels.value_or(0) < 0) throw InvalidInput("--levels is negative");
}

/// Options that are for some families and formats only.
void check_shape(const MeshRequest& request) {
    const auto require = [](bool met, const std::string& sentence) {
        if (!met) throw InvalidInput(sentence);
    };
    if (request.maximum_volume) {
        require(*request.maximum_volume > 0 && std::isfinite(*request.maximum_volume),
                "--max-volume is not a positive number");
        const Format* const format = format_of(request.input);
        require(format != nullptr && format->fills_complexes,
                "--max-volume is for .poly and .smesh, which are filled");
    }
    require(!request.weld || *request.weld >= 0, "--weld is negative or not a number");
    require(request.layers.empty() || request.family == "prism", "--layers are for --family prism");
    require(request.direction.empty() || !request.layers.empty(),
            "--direction is that of --layers, which are not given");
    require(!request.unbalanced || request.family == "octree",
            "--unbalanced is for --family octree");
}

void check(const MeshRequest& request) {
    check_fields(request);
    check_shape(request);
}

/// \throw InvalidInput where the mesh alone has too many elements
void check_size(const CoarseGrid& coarse, const MeshRequest& request) {
    if (coarse.shapes.size() <= request.maximum_elements) return;
    throw InvalidInput("it has " + std::to_string(coarse.shapes.size()) + " elements, more than " +
                       std::to_string(request.maximum_elements) + " (--max-elements)");
}

/// As check_and_orient(), with what helps where nodes stand for one.
void check_welded(CoarseGrid& coarse) {
    try {
        check_and_orient(coarse);
    } catch (const InvalidInput& error) {
        if (!has_nodes_in_one_place(coarse)) throw;
        throw InvalidInput(error.what() + std::string("; --weld TOLERANCE makes such nodes one"));
    }
}

}  // namespace

std::size_t make_hierarchy(const MeshRequest& request) {
    check(request);
    if (request.progress) request.progress("reading");
    MeshFromFile mesh =
        read_mesh(request.input, {request.maximum_volume}, request.weld, request.read_limit);
    CoarseGrid& coarse = mesh.grid;
    try {
        check_size(coarse, request);
        check_welded(coarse);
        // Neighbours in the mesh become neighbours in memory.
        coarse = reordered(coarse, reverse_cuthill_mckee(coarse));
        if (request.family == "prism" && coarse.dimension == 2) {
            if (request.layers.empty()) {
                throw InvalidInput(
                    "prisms are made of a surface: give the thickness of its "
                    "--layers");
            }
            std::optional<Point> direction;
            if (!request.direction.empty()) {
                direction = {request.direction[0], request.direction[1], request.direction[2]};
            }
            coarse = extrude(coarse, request.layers, direction);
        } else if (!request.layers.empty()) {
            throw InvalidInput("--layers are for surfaces: the mesh has elements in space already");
        }
        build(std::move(coarse), request);
    } catch (const InvalidInput& error) {
        throw InvalidInput("'" + request.input.string() + "': " + error.what());
    }
    return mesh.welded;
}
