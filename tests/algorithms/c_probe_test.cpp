// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points that C codes probe have the bits that C++ codes get.
#include <cstring>

#include <nestgrid/algorithms/probe.h>
#include <nestgrid/algorithms/probe.hpp>

#include "c_scenes.hpp"

namespace c_algorithms_test {

TEST(ProbesForC, AreTheSame) {
    for_each_scene([](auto& scene) {
        scene.ask_for_attribute();
        constexpr bool plane = std::remove_cvref_t<decltype(scene.grid)>::dimension == 2;
        std::vector<Point> points{{-3, 0, 0}};
        std::mt19937 random(3);
        std::uniform_real_distribution<double> any(0.1, 0.9);
        for (int i = 0; i < 50; ++i) {
            points.push_back({any(random), any(random), plane ? 0 : any(random)});
        }
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        for (const double threshold : {0.0, 0.2}) {
            scene.options.threshold = threshold;
            nestgrid_probed probed{};
            probed.size = sizeof(probed);
            ASSERT_EQ(
                nestgrid_probe(&scene.in_c.table, &scene.field, points[0].data(), points.size(),
                               &scene.options, &probed, scene.message.data(), 200),
                0)
                << scene.message.data();
            const ProbeResult direct =
                threshold == 0 ? probe(scene.grid, scene.both, points)
                               : probe(scene.grid, scene.both, points, under(offsets, threshold));
            ASSERT_EQ(probed.point_count, points.size());
            ASSERT_EQ(probed.component_count, 2U);
            EXPECT_EQ(probed.found, 50U);
            EXPECT_EQ(probed.levels[0], -1);
            EXPECT_EQ(probed.element_of[0], NESTGRID_NO_ELEMENT);
            EXPECT_TRUE(std::isnan(probed.values[0]));
            const auto elements = direct.elements.template as<std::uint32_t>();
            for (std::size_t i = 1; i < points.size(); ++i) {
                ASSERT_EQ(probed.values[2 * i], direct.values[2 * i]);
                ASSERT_EQ(probed.values[2 * i + 1], direct.values[2 * i + 1]);
                ASSERT_EQ(probed.levels[i], direct.level[i]);
                ASSERT_EQ(probed.reference[3 * i], direct.reference[i][0]);
                const std::uint32_t e = probed.element_of[i];
                ASSERT_EQ(e, direct.element_of[i]);
                ASSERT_EQ(std::memcmp(&probed.elements[e], &elements[e], sizeof(elements[e])), 0);
                ASSERT_EQ(probed.shapes[e], static_cast<int>(direct.shape_of[e]));
            }
            nestgrid_probed_free(&probed);
            EXPECT_EQ(probed.values, nullptr);
        }
    });
}

TEST(ResultsForC, AreWrittenAsFarAsTheirSizeSays) {
    Scene<3> scene(forests<3>()[0]);
    const Point x{0.5, 0.5, 0.5};
    nestgrid_probed probed{};
    probed.size = offsetof(nestgrid_probed, component_count);
    probed.component_count = 99;
    ASSERT_EQ(
        nestgrid_probe(&scene.in_c.table, &scene.field, x.data(), 1, nullptr, &probed, nullptr, 0),
        0);
    EXPECT_EQ(probed.found, 1U);
    EXPECT_EQ(probed.component_count, 99U);
    EXPECT_EQ(probed.size, offsetof(nestgrid_probed, component_count));
    nestgrid_probed_free(&probed);
    EXPECT_EQ(probed.component_count, 99U);
}

}  // namespace c_algorithms_test
