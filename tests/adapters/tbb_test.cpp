// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// oneTBB's threads keep the contract of an executor.
#include <concepts>
#include <stdexcept>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "executor_laws.hpp"
#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

static_assert(std::derived_from<TbbExecutor, Executor>);

TEST(TbbExecutor, WorksOnceAndConsumesInOrder) {
    for (const int threads : {1, 2, 3, 0}) {
        const TbbExecutor executor(threads);
        expect_parts_once_and_in_order(executor);
    }
}

TEST(TbbExecutor, PassesExceptionsOn) {
    const TbbExecutor executor(2);
    const auto nothing = [](std::size_t) {};
    const auto fail_at_7 = [](std::size_t i) {
        if (i == 7) throw std::runtime_error("seven");
    };
    EXPECT_THROW(executor.run(100, fail_at_7, nothing), std::runtime_error);
    EXPECT_THROW(executor.run(100, nothing, fail_at_7), std::runtime_error);
    executor.run(0, fail_at_7, nothing);
}

TEST(TbbExecutor, ExtractsWhatOneThreadDoes) {
    const Samples n{33, 33, 33};
    const LatticeBisection<3> grid({.samples = n});
    for (const SampledField& data : sampled_fields(n)) {
        SCOPED_TRACE(data.name);
        const LatticeField field(grid, std::span<const float>(data.values));
        const HierarchicalIndicator indicator(grid, field);
        const IsosurfaceOptions options{.normals = true};
        const auto one =
            isosurface(grid, field, data.isovalue, under(indicator, 0.02 * data.range), options);
        const auto two = isosurface(grid, field, data.isovalue, under(indicator, 0.02 * data.range),
                                    options, {TbbExecutor(2)});
        EXPECT_EQ(one.surface.vertices, two.surface.vertices);
        EXPECT_EQ(one.surface.normals, two.surface.normals);
        EXPECT_EQ(one.surface.simplices, two.surface.simplices);
    }
}

}  // namespace
