// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// CGAL's edge collapses by Lindstrom and Turk, for bench_equal_triangles.py.
//     cgal_collapse <most triangles> <mesh.off> <simpler.off> [distance]
// With a distance, which needs Eigen, triangles stay in an envelope around the mesh, which is that
// far at most, and collapses go on as long as they do. Prints its processor time in seconds,
// without those of reading and writing.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#ifdef NESTGRID_WITH_EIGEN
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Polyhedral_envelope_filter.h>
#endif

namespace {

namespace simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

struct FewTriangles {
    std::size_t most;

    template <class Cost, class Profile>
    bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
        return profile.surface_mesh().number_of_faces() <= most;
    }
};

/// \return whether the program can do so
bool collapse_in_envelope([[maybe_unused]] Mesh& mesh, [[maybe_unused]] const FewTriangles& few,
                          [[maybe_unused]] double distance) {
#ifdef NESTGRID_WITH_EIGEN
    using Filter =
        simplification::Polyhedral_envelope_filter<Kernel,
                                                   simplification::Bounded_normal_change_filter<>>;
    const simplification::LindstromTurk_cost<Mesh> cost;
    const simplification::LindstromTurk_placement<Mesh> placement;
    simplification::edge_collapse(
        mesh, few,
        CGAL::parameters::get_cost(cost).filter(Filter(distance)).get_placement(placement));
    return true;
#else
    return false;
#endif
}

}  // namespace

int main(int argc, char** argv) {
    Mesh mesh;
    if (argc < 4 || argc > 5 || !CGAL::IO::read_OFF(argv[2], mesh)) {
        std::fprintf(stderr,
                     "cgal_collapse <most triangles> <mesh.off> <simpler.off> [distance]\n");
        return 1;
    }
    const FewTriangles few{std::strtoull(argv[1], nullptr, 10)};
    const std::clock_t start = std::clock();
    if (argc == 4) {
        simplification::edge_collapse(mesh, few);
    } else if (!collapse_in_envelope(mesh, few, std::strtod(argv[4], nullptr))) {
        std::fprintf(stderr, "cgal_collapse was built without Eigen, which envelopes need\n");
        return 1;
    }
    std::printf("%.3f\n", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    mesh.collect_garbage();
    return CGAL::IO::write_OFF(argv[3], mesh, CGAL::parameters::stream_precision(9)) ? 0 : 1;
}
