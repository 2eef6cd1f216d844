// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// AMReX itself, of three dimensions: its MultiFabs in place, and the plotfile that it writes.
#include <filesystem>

#include <AMReX.H>
#include <AMReX_MultiFab.H>
#include <AMReX_PlotFileUtil.H>

#include <gtest/gtest.h>

#include <nestgrid/adapters/amrex.hpp>
#include <nestgrid/adapters/amrex_plotfile.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

namespace {

class Amrex : public testing::Environment {
public:
    void SetUp() override {
        int argc = 0;
        char** argv = nullptr;
        amrex::Initialize(argc, argv, false);
    }
    void TearDown() override { amrex::Finalize(); }
};
[[maybe_unused]] const auto* const amrex_is_there = testing::AddGlobalTestEnvironment(new Amrex);

amrex::Geometry geometry(int cells) {
    return {amrex::Box(amrex::IntVect(0), amrex::IntVect(cells - 1)),
            amrex::RealBox({0, 0, 0}, {1, 1, 1}),
            amrex::CoordSys::cartesian,
            {0, 0, 0}};
}

/// The distance from a sphere at centres, and nothing in ghost cells.
amrex::MultiFab sphere(const amrex::BoxArray& boxes, const amrex::Geometry& geom) {
    amrex::MultiFab result(boxes, amrex::DistributionMapping(boxes), 2, 1);
    result.setVal(std::numeric_limits<double>::quiet_NaN());
    for (amrex::MFIter at(result); at.isValid(); ++at) {
        const auto values = result.array(at);
        amrex::LoopOnCpu(at.validbox(), [&](int i, int j, int k) {
            const double h = geom.CellSize(0);
            values(i, j, k, 0) = 1;
            values(i, j, k, 1) =
                std::hypot((i + 0.5) * h - 0.45, (j + 0.5) * h - 0.5, (k + 0.5) * h - 0.5) - 0.3;
        });
    }
    return result;
}

TEST(RealAmrex, IsReadInPlaceAndFromItsPlotfile) {
    amrex::BoxArray coarse(geometry(32).Domain());
    coarse.maxSize(16);
    amrex::BoxArray fine(amrex::Box(amrex::IntVect(16), amrex::IntVect(47)));
    fine.maxSize(16);
    const amrex::Vector<amrex::Geometry> geoms{geometry(32), geometry(64)};
    const amrex::MultiFab level_0 = sphere(coarse, geoms[0]);
    const amrex::MultiFab level_1 = sphere(fine, geoms[1]);
    const amrex::Vector<const amrex::MultiFab*> levels{&level_0, &level_1};
    const amrex::Vector<amrex::IntVect> ratios{amrex::IntVect(2)};

    const nestgrid::BlockGrid<3> grid(nestgrid::amrex_blocks<3>(levels, geoms[0], ratios));
    const auto field = nestgrid::amrex_cells(grid, levels, 1);
    const auto surface = nestgrid::isosurface(grid, field, 0.0).surface;
    const auto report = nestgrid::surface_report(surface);
    EXPECT_EQ(report.open_edges, 0U);
    EXPECT_NEAR(report.area / (4 * std::acos(-1.0) * 0.09), 1, 0.02);

    const std::string folder = testing::TempDir() + "plt_of_amrex";
    amrex::WriteMultiLevelPlotfile(folder, 2, levels, {"one", "distance"}, geoms, 0.5, {3, 3},
                                   ratios);
    const nestgrid::AmrexPlotfile file(folder);
    EXPECT_EQ(file.time(), 0.5);
    const nestgrid::BlockGrid<3> read(file.blocks<3>());
    const nestgrid::BlockCells<3, double> mapped(read, file.arrays<3, double>(1));
    const auto again = nestgrid::isosurface(read, mapped, 0.0).surface;
    EXPECT_EQ(again.vertices, surface.vertices);
    EXPECT_EQ(again.simplices, surface.simplices);
}

}  // namespace
