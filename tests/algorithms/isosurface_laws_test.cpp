// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an isosurface is compared with: the finest grid, the data, its mirror image, the sphere.
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace isosurface_laws_test {

/// The vertices of the surface on the finest grid, edge by edge, without any hierarchy.
std::vector<Point> finest_vertices(const SampledField& data, const Samples& n) {
    std::vector<Point> vertices;
    const auto index = [&](int x, int y, int z) {
        const int at = x + n[0] * (y + n[1] * z);
        return static_cast<std::size_t>(at);
    };
    for (int z = 0; z < n[2]; ++z) {
        for (int y = 0; y < n[1]; ++y) {
            for (int x = 0; x < n[0]; ++x) {
                // An edge from the corner where a cell's path starts, or onwards along the path:
                // its direction d is any of 0/1 vectors, mirrored with the parity of the cell.
                for (unsigned d = 1; d < 8; ++d) {
                    for (unsigned s = 0; s < 8; ++s) {
                        if ((s & ~d) != 0) continue;
                        std::array<int, 3> a{x, y, z};
                        std::array<int, 3> b = a;
                        bool valid = true;
                        for (std::size_t k = 0; k < 3; ++k) {
                            if ((d >> k & 1U) == 0) continue;
                            const bool up = (s >> k & 1U) != 0;
                            b[k] += up ? 1 : -1;
                            // Along the path every coordinate goes from even to odd.
                            valid = valid && a[k] % 2 == 0 && b[k] >= 0 && b[k] < n[k];
                        }
                        if (!valid) continue;
                        double va = data.values[index(a[0], a[1], a[2])];
                        double vb = data.values[index(b[0], b[1], b[2])];
                        if ((va >= data.isovalue) == (vb >= data.isovalue)) continue;
                        if (va > vb) {
                            std::swap(va, vb);
                            std::swap(a, b);
                        }
                        const double t =
                            std::clamp((data.isovalue - va) / (vb - va), 0x1p-20, 1 - 0x1p-20);
                        Point p{};
                        for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + t * (b[k] - a[k]);
                        vertices.push_back(p);
                    }
                }
            }
        }
    }
    return vertices;
}

TEST(ThresholdZero, GivesTheVerticesOfTheFinestGrid) {
    for (const Samples n : {Samples{17, 17, 17}, Samples{18, 21, 11}}) {
        const LatticeBisection<3> grid({.samples = n});
        for (const SampledField& data : sampled_fields(n)) {
            if (data.name == "integer noise" || data.name == "plateaus") continue;  // zero offsets
            SCOPED_TRACE(data.name);
            const LatticeField field(grid, std::span<const float>(data.values));
            auto result = isosurface(grid, field, data.isovalue);
            std::vector<Point> expected = finest_vertices(data, n);
            std::sort(expected.begin(), expected.end());
            std::sort(result.surface.vertices.begin(), result.surface.vertices.end());
            EXPECT_EQ(result.surface.vertices, expected);
            EXPECT_EQ(result.error_bound, 0);
        }
    }
}

TEST(ThresholdZero, GivesThePointSetOfTheFinestGridWhereOffsetsVanish) {
    const Samples n{17, 17, 17};
    const LatticeBisection<3> grid({.samples = n});
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const HierarchicalIndicator indicator(grid, field);
        const auto result = isosurface(grid, field, data.isovalue, under(indicator, 0));
        const auto finest = isosurface(grid, field, data.isovalue, under(Exact{}, indicator), {});
        const SurfaceReport a = surface_report(result.surface);
        const SurfaceReport b = surface_report(finest.surface);
        // Cuts are kept 2^-20 of an edge away from its ends, so areas agree to about that.
        EXPECT_NEAR(a.area, b.area, 1e-5 * b.area);
        EXPECT_EQ(a.components, b.components);
        EXPECT_EQ(a.euler, b.euler);
        EXPECT_LE(a.triangles, b.triangles);
    }
}

/// \param evaluate the finest grid: double(data, samples, point)
template <class Grid, class Evaluate>
void expect_error_bounds(const Evaluate& evaluate) {
    for (const Samples n : {Samples{17, 17, 17}, Samples{14, 20, 33}}) {
        const Grid grid({.samples = n});
        for (const SampledField& data : sampled_fields(n)) {
            const LatticeField field(grid, std::span<const float>(data.values));
            const HierarchicalIndicator indicator(grid, field);
            for (const double threshold : {0.3, 0.1, 0.02, 0.005, 0.0}) {
                SCOPED_TRACE(data.name + " at " + std::to_string(threshold));
                const auto result = isosurface(grid, field, data.isovalue,
                                               under(indicator, threshold * data.range));
                const auto& surface = result.surface;
                double worst = 0;
                for (const auto& t : surface.simplices) {
                    const Point centre =
                        (1.0 / 3) *
                        (surface.vertices[t[0]] + surface.vertices[t[1]] + surface.vertices[t[2]]);
                    for (const Point& p : {surface.vertices[t[0]], surface.vertices[t[1]],
                                           surface.vertices[t[2]], centre}) {
                        worst =
                            std::max(worst, std::abs(evaluate(data.values, n, p) - data.isovalue));
                    }
                }
                // Cuts are moved by up to 2^-20 of a coarse edge.
                EXPECT_LE(worst, result.error_bound + 1e-4 * data.range);
                if (threshold == 0.02 && data.name == "sphere") {
                    EXPECT_GT(worst, 0.0005) << "the bound is not put to the test";
                    EXPECT_LT(result.error_bound, 0.1 * data.range);
                }
            }
        }
    }
}

TEST(ErrorBound, HoldsOnSimplicesAgainstTheFinestGrid) {
    expect_error_bounds<LatticeBisection<3>>(
        [](const auto& values, const Samples& n, const Point& p) {
            return evaluate_leaves(values, n, p);
        });
}

TEST(ErrorBound, HoldsOnHexahedraAgainstTheFinestGrid) {
    expect_error_bounds<LatticeOctree<3>>(evaluate_cells);
}

TEST(Mirror, ReflectsTheSurface) {
    const Samples n{17, 20, 13};
    const LatticeBisection<3> grid({.samples = n});
    const LatticeBisection<3> mirrored(
        {.samples = n, .direction = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}});
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const LatticeField image(mirrored, std::span<const float>(data.values));
        const auto a = isosurface(grid, field, data.isovalue, {.threshold = 0.02}, {.cap = true});
        const auto b =
            isosurface(mirrored, image, data.isovalue, {.threshold = 0.02}, {.cap = true});
        ASSERT_EQ(a.surface.vertices.size(), b.surface.vertices.size());
        for (std::size_t i = 0; i < a.surface.vertices.size(); ++i) {
            const Point& p = a.surface.vertices[i];
            EXPECT_EQ(b.surface.vertices[i], (Point{-p[0], p[1], p[2]}));
        }
        EXPECT_NEAR(surface_report(a.surface).volume, surface_report(b.surface).volume, 1e-9);
        EXPECT_GT(surface_report(b.surface).volume, 0);
    }
}

/// The same coarse elements, in the opposite order and with other ids.
class Renumbered {
public:
    using Element = LatticeBisection<3>::Element;
    static constexpr int dimension = 3;

    explicit Renumbered(const LatticeBisection<3>& grid) : grid_{&grid} {}
    std::size_t coarse_count() const { return grid_->coarse_count(); }
    std::size_t other(std::size_t i) const { return coarse_count() - 1 - i; }
    CoarseElement<Element> coarse(std::size_t i) const {
        CoarseElement<Element> c = grid_->coarse(other(i));
        for (std::uint64_t& id : c.ids) id = 1000003 - 7 * id;
        return c;
    }
    const Rule* split(const Element& e) const { return grid_->split(e); }
    void children(const Element& e, std::span<Element> out) const { grid_->children(e, out); }

private:
    const LatticeBisection<3>* grid_;
};

class RenumberedField {
public:
    using value_type = float;

    RenumberedField(const Renumbered& grid, const LatticeField<LatticeBisection<3>, float>& field)
        : grid_{&grid}, field_{&field} {}
    NodeMask coarse_values(std::size_t i, std::span<float> out) const {
        return field_->coarse_values(grid_->other(i), out);
    }
    NodeMask new_values(const Renumbered::Element& e, NodeMask which, std::span<float> out) const {
        return field_->new_values(e, which, out);
    }

private:
    const Renumbered* grid_;
    const LatticeField<LatticeBisection<3>, float>* field_;
};

TEST(Renumbering, ChangesTheOrderAlone) {
    const Samples n{17, 9, 17};
    const LatticeBisection<3> grid({.samples = n, .block_levels = 3});
    const Renumbered renumbered(grid);
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const RenumberedField same(renumbered, field);
        auto a = isosurface(grid, field, data.isovalue, {.threshold = 0.03}, {.cap = true});
        auto b = isosurface(renumbered, same, data.isovalue, {.threshold = 0.03}, {.cap = true});
        const auto triangles = [](const auto& surface) {
            std::vector<std::array<Point, 3>> list;
            for (const auto& t : surface.simplices) {
                std::array<Point, 3> x{surface.vertices[t[0]], surface.vertices[t[1]],
                                       surface.vertices[t[2]]};
                std::rotate(x.begin(), std::min_element(x.begin(), x.end()), x.end());
                list.push_back(x);
            }
            std::sort(list.begin(), list.end());
            return list;
        };
        EXPECT_GT(a.surface.simplices.size(), 0U);
        EXPECT_EQ(triangles(a.surface), triangles(b.surface));
        EXPECT_EQ(a.counts.visited, b.counts.visited);
    }
}

struct SphereMeasure {
    double area;
    double volume;
};

SphereMeasure measure_sphere(int n) {
    const Samples samples{n, n, n};
    const double h = 1.0 / (n - 1);
    const LatticeBisection<3> grid({.samples = samples, .spacing = {h, h, h}});
    const std::vector<float> values =
        sample(samples, [](double x, double y, double z) { return -distance_to_centre(x, y, z); });
    const LatticeField field(grid, std::span<const float>(values));
    const auto result = isosurface(grid, field, -0.4);
    const SurfaceReport report = surface_report(result.surface);
    EXPECT_TRUE(report.closed());
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(report.components, 1U);
    return {report.area, report.volume};
}

TEST(Sphere, AreaAndVolumeConvergeWithOrderTwo) {
    const double pi = 3.14159265358979323846;
    const double area = 4 * pi * 0.16;
    const double volume = 4 * pi * 0.064 / 3;
    SphereMeasure before = measure_sphere(9);
    for (const int n : {17, 33, 65, 129}) {
        const SphereMeasure now = measure_sphere(n);
        EXPECT_NEAR(std::log2((area - before.area) / (area - now.area)), 2, 0.25) << n;
        EXPECT_NEAR(std::log2((volume - before.volume) / (volume - now.volume)), 2, 0.25) << n;
        before = now;
    }
}

TEST(Normals, PointDownhillAndAreThoseOfTheSphere) {
    const Samples n{33, 33, 33};
    const LatticeBisection<3> grid({.samples = n});
    const std::vector<float> values =
        sample(n, [](double x, double y, double z) { return distance_to_centre(x, y, z); });
    const LatticeField field(grid, std::span<const float>(values));
    for (const double threshold : {0.0, 0.01}) {
        const auto result =
            isosurface(grid, field, 0.4, {.threshold = threshold}, {.normals = true});
        const auto& surface = result.surface;
        ASSERT_EQ(surface.normals.size(), surface.vertices.size());
        for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
            const Point out = surface.vertices[v] - Point{16, 16, 16};
            EXPECT_NEAR(norm(surface.normals[v]), 1, 1e-12);
            EXPECT_LT(dot(surface.normals[v], out) / norm(out), -0.99);
        }
        for (const auto& t : surface.simplices) {
            const Point face = cross(surface.vertices[t[1]] - surface.vertices[t[0]],
                                     surface.vertices[t[2]] - surface.vertices[t[0]]);
            EXPECT_GT(dot(face, surface.normals[t[0]]), 0);
        }
    }
}

TEST(Isosurface, CarriesTheElementOfEveryTriangle) {
    const Samples n{17, 17, 17};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[2];
    const LatticeField field(grid, std::span<const float>(data.values));
    const auto result = isosurface(grid, field, data.isovalue, {.threshold = 0.05});
    const auto& surface = result.surface;
    ASSERT_EQ(surface.element_of.size(), surface.simplices.size());
    EXPECT_EQ(surface.elements.size(), result.counts.extracted);
    const auto elements = surface.elements.as<LatticeBisection<3>::Element>();
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& element = elements[surface.element_of[t]];
        std::array<Point, 4> x;
        grid.corner_positions(element, x);
        for (const std::uint32_t v : surface.simplices[t]) {
            for (std::size_t d = 0; d < 3; ++d) {
                const auto [lo, hi] = std::minmax({x[0][d], x[1][d], x[2][d], x[3][d]});
                EXPECT_GE(surface.vertices[v][d], lo);
                EXPECT_LE(surface.vertices[v][d], hi);
            }
        }
    }
}

TEST(Isosurface, OutsideTheRangeIsEmpty) {
    const Samples n{9, 9, 9};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[0];
    const LatticeField field(grid, std::span<const float>(data.values));
    const auto result = isosurface(grid, field, 7.0);
    EXPECT_TRUE(result.surface.vertices.empty());
    EXPECT_EQ(surface_report(result.surface).components, 0U);
    EXPECT_EQ(result.counts.visited, 0U);
}

TEST(Isosurface, RefusesWhatIsNoNumber) {
    const Samples n{9, 9, 9};
    const LatticeBisection<3> grid({.samples = n});
    SampledField data = sampled_fields(n)[0];
    const LatticeField field(grid, std::span<const float>(data.values));
    EXPECT_THROW(isosurface(grid, field, std::nan("")), InvalidInput);
    EXPECT_THROW(isosurface(grid, field, 0.4, {.threshold = -1}), InvalidInput);
    EXPECT_THROW(isosurface(grid, field, 0.4, {.threshold = std::nan("")}), InvalidInput);
    data.values[100] = std::nanf("");
    EXPECT_THROW(isosurface(grid, field, 0.4), InvalidInput);
}

TEST(Isosurface, CanBeCancelled) {
    const Samples n{65, 65, 65};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[3];
    const LatticeField field(grid, std::span<const float>(data.values));
    int calls = 0;
    const auto result = isosurface(grid, field, data.isovalue, {},
                                   {.progress = [&](const auto&) { return ++calls < 3; }});
    EXPECT_TRUE(result.cancelled);
    EXPECT_EQ(calls, 3);
}

}  // namespace isosurface_laws_test
