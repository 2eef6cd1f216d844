// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// CGAL's edge collapses by Lindstrom and Turk, for bench_equal_triangles.py.
//     cgal_collapse <most triangles> <mesh.off> <simpler.off>
// Prints its processor time in seconds, without those of reading and writing.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <CGAL/IO/OFF.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace {

using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

struct FewTriangles {
    std::size_t most;

    template <class Cost, class Profile>
    bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
        return profile.surface_mesh().number_of_faces() <= most;
    }
};

}  // namespace

int main(int argc, char** argv) {
    Mesh mesh;
    if (argc != 4 || !CGAL::IO::read_OFF(argv[2], mesh)) {
        std::fprintf(stderr, "cgal_collapse <most triangles> <mesh.off> <simpler.off>\n");
        return 1;
    }
    const std::clock_t start = std::clock();
    CGAL::Surface_mesh_simplification::edge_collapse(
        mesh, FewTriangles{std::strtoull(argv[1], nullptr, 10)});
    std::printf("%.3f\n", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    mesh.collect_garbage();
    return CGAL::IO::write_OFF(argv[3], mesh, CGAL::parameters::stream_precision(9)) ? 0 : 1;
}
