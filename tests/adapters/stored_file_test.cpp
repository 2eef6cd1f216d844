// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files of hierarchies: what is written is read back, what is damaged is refused.
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/stored_file.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"

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
StoredHierarchy<Family> read_back(const StoredGrid<Family>&, const std::filesystem::path& path,
                                  Encoded encoded = Encoded::decode) {
    return read_hierarchy<Family>(path, encoded);
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
    later[8] = 3;
    write_bytes(path, later);
    EXPECT_NE(refusal<IoError>(read).find("version 3"), std::string::npos);
    std::filesystem::remove(path);
}

/// Damages bytes behind the header, at places from `first` on, and makes the checksums correct.
std::vector<char> damaged(const std::vector<char>& sound, std::size_t first, int changes,
                          std::mt19937& random) {
    auto bytes = sound;
    for (int k = 0; k < changes; ++k) {
        const std::size_t at = first + random() % (bytes.size() - first);
        bytes[at] =
            random() % 3 == 0 ? static_cast<char>(random()) : static_cast<char>(bytes[at] + 1);
    }
    set_checksums(bytes);
    return bytes;
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
        write_bytes(path, damaged(sound, 56, 1 + i % 3, random));
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

/// Frames of two fields: waves that move, and their squares.
template <class Grid>
std::vector<NamedField> moving_fields(const Grid& grid, const std::vector<double>& times) {
    NamedField wave{"wave", {}};
    NamedField square{"square", {}};
    for (const double t : times) {
        for (const double value :
             sample_nodes(grid, [t](const Point& x) { return std::sin(9 * x[0] - t) + x[1]; })) {
            wave.values.push_back(value);
            square.values.push_back(value * value);
        }
    }
    return {wave, square};
}

/// The greatest difference at nodes that do not hang.
template <class Grid>
double difference(const Grid& grid, std::span<const double> a, std::span<const double> b) {
    double greatest = 0;
    grid.for_each_leaf([&](const Leaf& leaf) {
        for (const std::uint32_t node : leaf.nodes) {
            if (!grid.hangs(node)) greatest = std::max(greatest, std::abs(a[node] - b[node]));
        }
    });
    return greatest;
}

/// Files of one frame of plain values are those that earlier versions wrote and read.
TEST(StoredFile, HasTheLowestVersionThatHoldsIt) {
    const auto path = temporary(std::to_string(::getpid()) + "_version.nestgrid");
    const OctreeGrid<2> grid(quadrilaterals(1));
    const NamedField field{"f", std::vector<double>(grid.node_count(), 1)};
    const auto version = [&](const StoredFileOptions& options) {
        write_hierarchy(grid, path, {field}, options);
        return int{bytes_of(path)[8]};
    };
    EXPECT_EQ(version({}), 1);
    EXPECT_EQ(version({.times = {2}}), 2);
    EXPECT_EQ(version({.compression = CompressionOptions{}}), 2);
    std::filesystem::remove(path);
}

TYPED_TEST(StoredFiles, KeepFrames) {
    const auto path = temporary(std::to_string(::getpid()) + "_frames.nestgrid");
    const std::vector<double> times{-1, 0.5, 3};
    for (auto grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        const auto fields = moving_fields(grid, times);
        write_hierarchy(grid, path, fields, {.times = times});
        const auto back = read_back(grid, path);
        EXPECT_EQ(leaves(back.grid), leaves(grid));
        EXPECT_EQ(back.times, times);
        ASSERT_EQ(back.fields.size(), 2U);
        for (std::size_t f = 0; f < 2; ++f) {
            EXPECT_EQ(back.fields[f].name, fields[f].name);
            EXPECT_EQ(back.fields[f].values, fields[f].values);
        }
        const auto last = back.frame(back.fields[1], 2);
        EXPECT_TRUE(
            std::ranges::equal(last, std::span(fields[1].values).last(back.grid.node_count())));
    }
    std::filesystem::remove(path);
}

/// Encoded values are the values: bit for bit with step 0, within half a step otherwise, at all
/// nodes but those that hang. Those have the mean of their parents, as a CompressedField has it.
TYPED_TEST(StoredFiles, KeepEncodedValues) {
    using Grid = typename TypeParam::Grid;
    const auto path = temporary(std::to_string(::getpid()) + "_encoded.nestgrid");
    for (auto grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        const std::vector<double> times{0, 1};
        const auto fields = moving_fields(grid, times);
        for (const double step : {0.0, 0.01}) {
            write_hierarchy(grid, path, fields,
                            {.times = times, .compression = CompressionOptions{step}});
            const auto back = read_back(grid, path);
            const auto kept = read_back(grid, path, Encoded::keep);
            for (std::size_t f = 0; f < 2; ++f) {
                ASSERT_TRUE(kept.fields[f].values.empty());
                ASSERT_EQ(kept.fields[f].encoded.size(), 2U);
                for (std::size_t i = 0; i < 2; ++i) {
                    const auto values = back.frame(back.fields[f], i);
                    const auto first = i * grid.node_count();
                    const double off =
                        difference(grid, values, std::span(fields[f].values).subspan(first));
                    EXPECT_LE(off, step / 2 * (1 + 1e-9));
                    EXPECT_EQ(decode(kept.grid, kept.fields[f].encoded[i]),
                              std::vector<double>(values.begin(), values.end()));
                    const NodeField decoded(back.grid, values);
                    const auto violation = check_grid(back.grid, decoded);
                    EXPECT_FALSE(violation) << violation->sentence;
                    const CompressedField<Grid, double> direct(kept.grid,
                                                               kept.fields[f].encoded[i]);
                    expect_same(isosurface(kept.grid, direct, 0.4, {.threshold = 0.05}).surface,
                                isosurface(back.grid, decoded, 0.4, {.threshold = 0.05}).surface);
                }
            }
            // Encoded fields are written as they are.
            const std::vector<char> bytes = bytes_of(path);
            write_hierarchy(kept.grid, path, kept.fields, {.times = kept.times});
            EXPECT_EQ(bytes_of(path), bytes);
        }
    }
    std::filesystem::remove(path);
}

/// Damaged times, values and codes with correct checksums: refused, or values that algorithms take
/// or refuse.
TYPED_TEST(StoredFiles, SurviveMaliceInFrames) {
    const auto path = temporary(std::to_string(::getpid()) + "_malice_in_frames.nestgrid");
    auto grid = TypeParam::grids().front();
    refine_at_sphere(grid, 2 * TypeParam::steps);
    write_hierarchy(grid, path);
    const std::size_t of_grid = bytes_of(path).size();
    const std::vector<double> times{0, 1};
    const auto fields = moving_fields(grid, times);
    std::mt19937 random(5);
    std::size_t refused = 0;
    for (const double step : {-1.0, 0.0, 0.001}) {  // below 0: plain values
        StoredFileOptions options{.times = times};
        if (step >= 0) options.compression = CompressionOptions{step};
        write_hierarchy(grid, path, fields, options);
        const std::vector<char> sound = bytes_of(path);
        for (int i = 0; i < 100; ++i) {
            // Every other time among the numbers that tell how long arrays are.
            const std::size_t end = i % 2 == 0 ? sound.size() : of_grid + 100;
            std::vector<char> part(sound.begin(), sound.begin() + std::ptrdiff_t(end));
            part = damaged(part, of_grid - 8, 1 + i % 3, random);
            std::vector<char> bytes = sound;
            std::ranges::copy(part, bytes.begin());
            set_checksums(bytes);
            write_bytes(path, bytes);
            try {
                const auto back = read_back(grid, path);
                const auto kept = read_back(grid, path, Encoded::keep);
                EXPECT_EQ(back.fields.size(), kept.fields.size());
                for (const NamedField& field : back.fields) {
                    ASSERT_EQ(field.values.size(), back.times.size() * back.grid.node_count());
                    const NodeField values(back.grid, back.frame(field, back.times.size() - 1));
                    static_cast<void>(isosurface(back.grid, values, 0.1, {.threshold = 0.1}));
                }
            } catch (const IoError&) {
                ++refused;
            } catch (const InvalidInput&) {  // values that are no usable numbers
            }
        }
    }
    EXPECT_GT(refused, 75U);
    std::filesystem::remove(path);
}

TEST(StoredFile, GivesFramesDecodedOrEncoded) {
    const auto path = temporary(std::to_string(::getpid()) + "_page.nestgrid");
    OctreeGrid<3> grid(hexahedra(2));
    refine_at_sphere(grid, 3);
    const std::vector<double> values = moving_fields(grid, {0, 0.5})[0].values;
    // [frames]
    const StoredFileOptions options{.times = {0, 0.5},
                                    .compression = CompressionOptions{.step = 0.001}};
    write_hierarchy(grid, path, {{"u", values}}, options);

    const auto stored = read_hierarchy<Octree<3>>(path);
    const NodeField later(stored.grid, stored.frame(stored.fields[0], 1));  // decoded when read

    const auto packed = read_hierarchy<Octree<3>>(path, Encoded::keep);
    const CompressedField<OctreeGrid<3>, double> field(packed.grid, packed.fields[0].encoded[1]);
    // [frames]
    expect_same(isosurface(stored.grid, later, 0.4, {.threshold = 0.05}).surface,
                isosurface(packed.grid, field, 0.4, {.threshold = 0.05}).surface);
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
    const NamedField field{"f", std::vector<double>(2 * grid.node_count())};
    EXPECT_THROW(write_hierarchy(grid, path, {field}), InvalidInput);
    EXPECT_THROW(write_hierarchy(grid, path, {field}, {.times = {0, 1, 2}}), InvalidInput);
    EXPECT_THROW(write_hierarchy(grid, path, {field}, {.times = {1, 1}}), InvalidInput);
    EXPECT_THROW(write_hierarchy(grid, path, {field}, {.times = {0, NAN}}), InvalidInput);
    EXPECT_THROW(write_hierarchy(grid, path, {}, {.times = {}}), InvalidInput);
    const StoredFileOptions negative{.times = {0, 1}, .compression = CompressionOptions{-1}};
    EXPECT_THROW(write_hierarchy(grid, path, {field}, negative), InvalidInput);
    EXPECT_THROW(write_hierarchy(grid, "/nowhere/file.nestgrid", {}), IoError);
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
