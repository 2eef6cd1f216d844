// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a second thread brings (oneTBB), on the bucky ball: triangles into a buffer that may be
// filled in parts, triangles handed to a function one by one, and an indexed surface, which is the
// same to the last bit; and the preroll of a stored octree. One "name value" line per figure;
// --quick takes 33^3 samples instead of 129^3, and two levels less.
#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>

#include "bucky_samples.hpp"
#include "sample_grids.hpp"

namespace {

using Soup = nestgrid::SimplexSoup<3, float>;

void fill(BuckySamples& bucky, float threshold, std::vector<Soup::Simplex>& soup,
          const nestgrid::Executor& executor) {
    soup.clear();
    const double isovalue = bucky_isovalue;
    std::vector<Soup> sinks;
    sinks.emplace_back(soup);
    const nestgrid::Threshold criterion{&bucky.indicator, threshold};
    nestgrid::extract_isosurfaces(bucky.grid, bucky.field, std::span<const double>(&isovalue, 1),
                                  std::move(sinks), under(criterion, bucky.indicator), {},
                                  {executor});
}

/// Of an octree refined at a sphere.
void compare_prerolls(int levels, const nestgrid::TbbExecutor& two, std::size_t rounds) {
    using Grid = nestgrid::OctreeGrid<3>;
    Grid grid(nestgrid_test::hexahedra(1));
    nestgrid_test::refine_at_sphere(grid, levels);
    const std::vector<double> values = nestgrid_test::sample_nodes(
        grid, [](const nestgrid::Point& x) { return nestgrid_test::to_sphere(x, 3); });
    const nestgrid::NodeField<Grid, double> field(grid, values);
    Contest contest(rounds);
    contest.add("one", [&] { nestgrid::HierarchicalIndicator(grid, field); });
    contest.add("two", [&] { nestgrid::HierarchicalIndicator(grid, field, two); });
    contest.run();
    Contest::print_figure("stored_octree_preroll_one_ms", contest.time("one"));
    Contest::print_figure("stored_octree_preroll_two_threads_speedup",
                          contest.time("one") / contest.time("two"));
}

void compare(int n, int levels, std::size_t rounds) {
    BuckySamples bucky(n);
    const nestgrid::TbbExecutor two(2);
    Contest::print_figure("threads", static_cast<double>(two.concurrency()));
    compare_prerolls(levels, two, rounds);
    std::vector<Soup::Simplex> soup;
    nestgrid::IsosurfaceSeries one_series(bucky.grid, bucky.field);
    nestgrid::IsosurfaceSeries two_series(bucky.grid, bucky.field);
    for (const float threshold : bucky_thresholds) {
        const nestgrid::Projection projection{.threshold = threshold};
        const nestgrid::IsosurfaceOptions options{.elements = false};
        Contest contest(rounds);
        contest.add("soup_one",
                    [&] { fill(bucky, threshold, soup, nestgrid::SequentialExecutor{}); });
        contest.add("soup_two", [&] { fill(bucky, threshold, soup, two); });
        contest.add("stream_one", [&] { bucky.draw_soup(bucky.grid, bucky.field, threshold); });
        contest.add("stream_two",
                    [&] { bucky.draw_soup(bucky.grid, bucky.field, threshold, nullptr, two); });
        contest.add("indexed_one",
                    [&] { one_series.draw(double{bucky_isovalue}, projection, options); });
        contest.add("indexed_two",
                    [&] { two_series.draw(double{bucky_isovalue}, projection, options, two); });
        contest.run();
        for (const std::string name : {"soup", "stream", "indexed"}) {
            Contest::print_figure(at_threshold(name + "_one_ms", threshold),
                                  contest.time(name + "_one"));
            Contest::print_figure(at_threshold(name + "_two_threads_speedup", threshold),
                                  contest.time(name + "_one") / contest.time(name + "_two"));
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const int levels = is_quick(argc, argv) ? 5 : 7;
    at_either_size(argc, argv, 15,
                   [levels](auto n, std::size_t rounds) { compare(n.value, levels, rounds); });
    return 0;
}
