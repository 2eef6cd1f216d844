// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files of hierarchies: what is written is read back, what is damaged is refused.
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/stored_file.hpp>
#include <nestgrid/check_grid.hpp>

#include "families.hpp"
#include "refusal.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

std::filesystem::path temporary(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) / ("stored_file_test_" + name);
}

std::vector<char> bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::filesystem::path& path, const std::vector<char>& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// All leaves: shapes, nodes and positions.
template <class Grid>
std::vector<double> leaves(const Grid& grid) {
    std::vector<double> all;
    grid.for_each_leaf([&](const Leaf& leaf) {
        all.push_back(static_cast<double>(leaf.shape));
        for (std::size_t i = 0; i < leaf.nodes.size(); ++i) {
            all.push_back(leaf.nodes[i]);
            all.insert(all.end(), leaf.corners[i].begin(), leaf.corners[i].end());
        }
    });
    return all;
}

template <class Family>
class StoredFiles : public testing::Test {};
TYPED_TEST_SUITE(StoredFiles, Families);

template <class Family>
StoredHierarchy<Family> read_back(const StoredGrid<Family>&, const std::filesystem::path& path) {
    return read_hierarchy<Family>(path);
}

TYPED_TEST(StoredFiles, ComeBackAsTheyWere) {
    const auto path = temporary(std::to_string(::getpid()) + ".nestgrid");
    for (auto grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        grid.adapt(
            [](const Leaf& leaf) { return leaf.centre()[0] < 0.4 ? Mark::coarsen : Mark::keep; });
        grid.renumber();
        const std::vector<NamedField> fields{
            {"x", sample_nodes(grid, [](const Point& x) { return x[0]; })}};
        write_hierarchy(grid, path, fields);
        auto back = read_back(grid, path);
        EXPECT_EQ(leaves(back.grid), leaves(grid));
        EXPECT_EQ(back.grid.leaf_count(), grid.leaf_count());
        EXPECT_EQ(back.grid.used_node_count(), grid.used_node_count());
        ASSERT_EQ(back.fields.size(), 1U);
        EXPECT_EQ(back.fields[0].name, "x");
        EXPECT_EQ(back.fields[0].values, fields[0].values);
        const auto violation = check_grid(back.grid, NodeField(back.grid, back.fields[0].values));
        EXPECT_FALSE(violation) << violation->sentence;
        // It can be adapted further, in the same way.
        refine_at_sphere(grid, 4 * TypeParam::steps);
        refine_at_sphere(back.grid, 4 * TypeParam::steps);
        EXPECT_EQ(leaves(back.grid), leaves(grid));
    }
    std::filesystem::remove(path);
}

void set_checksums(std::vector<char>& bytes) {
    boost::crc_32_type body;
    body.process_bytes(bytes.data() + 56, bytes.size() - 56);
    const std::uint32_t sum = body.checksum();
    std::memcpy(bytes.data() + 48, &sum, 4);
    boost::crc_32_type header;
    header.process_bytes(bytes.data(), 52);
    const std::uint32_t own = header.checksum();
    std::memcpy(bytes.data() + 52, &own, 4);
}

TEST(StoredFile, RefusesEveryDamage) {
    const auto path = temporary(std::to_string(::getpid()) + "_damaged.nestgrid");
    OctreeGrid<2> grid(quadrilaterals(2));
    refine_at_sphere(grid, 3);
    write_hierarchy(grid, path, {{"f", sample_nodes(grid, [](const Point& x) { return x[1]; })}});
    const std::vector<char> sound = bytes_of(path);
    const auto read = [&] { read_hierarchy<Octree<2>>(path); };

    EXPECT_NE(
        refusal<IoError>([&] { read_hierarchy<Octree<2>>(temporary("none")); }).find("opened"),
        std::string::npos);
    EXPECT_NE(refusal<IoError>([&] { read_hierarchy<Octree<3>>(path); }).find("dimension 2"),
              std::string::npos);
    for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{55},
                                     std::size_t{56}, sound.size() / 2, sound.size() - 1}) {
        write_bytes(path, {sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(length)});
        EXPECT_NE(refusal<IoError>(read), "") << length;
    }
    auto longer = sound;
    longer.push_back(0);
    write_bytes(path, longer);
    EXPECT_NE(refusal<IoError>(read).find("bytes long"), std::string::npos);
    for (std::size_t i = 0; i < sound.size(); ++i) {  // one bit anywhere
        auto bytes = sound;
        bytes[i] = static_cast<char>(bytes[i] ^ 1 << i % 8);
        write_bytes(path, bytes);
        EXPECT_NE(refusal<IoError>(read), "") << "byte " << i;
    }
    auto later = sound;
    later[8] = 2;
    write_bytes(path, later);
    EXPECT_NE(refusal<IoError>(read).find("version 2"), std::string::npos);
    std::filesystem::remove(path);
}

/// Damage with correct checksums: refused, or a grid that can be walked and adapted safely.
TYPED_TEST(StoredFiles, SurviveMalice) {
    const auto path = temporary(std::to_string(::getpid()) + "_malice.nestgrid");
    auto grid = TypeParam::grids().front();
    refine_at_sphere(grid, 2 * TypeParam::steps);
    write_hierarchy(grid, path, {});
    const std::vector<char> sound = bytes_of(path);
    std::mt19937 random(4);
    std::size_t refused = 0;
    constexpr int tries = 400;
    for (int i = 0; i < tries; ++i) {
        auto bytes = sound;
        for (unsigned k = 0; k <= static_cast<unsigned>(i % 3); ++k) {
            const std::size_t at = 56 + random() % (bytes.size() - 56);
            bytes[at] =
                random() % 3 == 0 ? static_cast<char>(random()) : static_cast<char>(bytes[at] + 1);
        }
        set_checksums(bytes);
        write_bytes(path, bytes);
        try {
            auto back = read_back(grid, path);
            std::size_t count = 0;
            back.grid.for_each_leaf([&](const Leaf&) { ++count; });
            EXPECT_EQ(count, back.grid.leaf_count());
            back.grid.adapt([](const Leaf& leaf) {
                return leaf.level < 3 && leaf.coarse % 2 == 0 ? Mark::refine : Mark::keep;
            });
        } catch (const IoError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, static_cast<std::size_t>(tries / 4));
    std::filesystem::remove(path);
}

/// Numbers that coarsening has left unused do not disturb.
TEST(StoredFile, KeepsNodeNumbersWithGaps) {
    const auto path = temporary(std::to_string(::getpid()) + "_gaps.nestgrid");
    BisectionGrid<2> grid(triangles(2));
    refine_at_sphere(grid, 12);
    for (int i = 0; i < 11; ++i) {
        grid.adapt(
            [](const Leaf& leaf) { return leaf.centre()[0] < 0.8 ? Mark::coarsen : Mark::keep; });
    }
    ASSERT_GT(grid.node_count(), 2 * grid.used_node_count());
    write_hierarchy(grid, path);
    const auto back = read_hierarchy<Bisection<2>>(path);
    EXPECT_EQ(leaves(back.grid), leaves(grid));
    EXPECT_EQ(back.grid.used_node_count(), grid.used_node_count());
    std::filesystem::remove(path);
}

TEST(StoredFile, RefusesFieldsOfTheWrongLength) {
    const OctreeGrid<2> grid(quadrilaterals(1));
    const auto path = temporary("never.nestgrid");
    EXPECT_THROW(write_hierarchy(grid, path, {{"f", {1, 2}}}), InvalidInput);
    EXPECT_THROW(write_hierarchy(grid, "/nowhere/file.nestgrid", {}), IoError);
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
