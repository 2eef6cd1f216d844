// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A surface of a field that tells degree 1 in all leaves, drawn as front ends do, and of the same
// field without degrees: count_instructions.py runs both under callgrind, and compares the
// instructions of each step. They draw the same bits.
//     bench_degree_one nodal|degrees [leaves]
#include <cstdio>
#include <cstring>
#include <string>

#include <nestgrid/algorithms/drawing.hpp>

#include "counted_steps.hpp"

using namespace nestgrid_test;

NESTGRID_COUNTED_STEP(step_first_surface)
NESTGRID_COUNTED_STEP(step_next_surface)
NESTGRID_COUNTED_STEP(step_coarse_surface)

namespace {

/// The multilinear function through the values at the corners of each leaf.
struct FieldOfDegreeOne : CutField<3, double> {
    using Element = CutGrid<3>::Element;

    static int degree(const Element& /*leaf*/) { return 1; }
    void evaluate(const Element& leaf, std::span<const Point> x, std::span<double> out) const {
        const std::span<const std::uint32_t> nodes =
            cut->table().nodes_of(cut->table().elements[leaf.at]);
        std::fill(out.begin(), out.end(), 0.0);
        for (std::size_t i = 0; i < out.size(); ++i) {
            for (std::size_t k = 0; k < 8; ++k) {
                double weight = 1;
                for (std::size_t d = 0; d < 3; ++d) {
                    const double t = x[i / components][d];
                    weight *= (k >> d & 1U) != 0 ? t : 1 - t;
                }
                out[i] += weight * (*values)[components * nodes[k] + i % components];
            }
        }
    }
};

/// A hash of the corners of all triangles, in order.
std::uint64_t hash_of(const Surface<3>& surface) {
    std::uint64_t hash = 1469598103934665603ULL;
    for (const auto& triangle : surface.simplices) {
        for (const auto v : triangle) {
            std::array<std::uint64_t, 3> bits;
            std::memcpy(bits.data(), surface.vertices[v].data(), sizeof bits);
            for (const std::uint64_t b : bits) hash = (hash ^ b) * 1099511628211ULL;
        }
    }
    return hash;
}

template <class Field>
void draw(const CutGrid<3>& grid, const Field& field) {
    const Prerolls prerolls(grid, field);
    const auto surface = [&](double isovalue, double error) {
        const auto drawn =
            isosurface<3>(prerolls, isovalue, {.threshold = error, .indicator = "error"});
        std::printf("triangles %zu\nhash %llx\n", drawn.surface.simplices.size(),
                    static_cast<unsigned long long>(hash_of(drawn.surface)));
    };
    step_first_surface([&] { surface(0.0, 1e-6); });
    step_next_surface([&] { surface(0.02, 1e-6); });
    step_coarse_surface([&] { surface(0.01, 0.01); });
}

}  // namespace

int main(int argc, char** argv) {
    const bool degrees = argc > 1 && std::string(argv[1]) == "degrees";
    const CountedWorld world(argc > 2 ? argv[2] : nullptr);
    const auto& [whole, values] = world;
    const CutGrid<3> grid(whole, nullptr, false);
    if (degrees) {
        draw(grid, FieldOfDegreeOne{{&grid, &values}});
    } else {
        draw(grid, CutField<3, double>{&grid, &values});
    }
    std::printf("leaves %u\n", whole.leaves);
}
