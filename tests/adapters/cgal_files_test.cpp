// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces from files, which OpenMesh writes: nothing lost, nothing read in part, nothing printed.
#include <cstring>
#include <filesystem>

#include <nestgrid/adapters/cgal_files.hpp>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include "coarse_samples.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
};
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

template <class Mesh>
Mesh to_openmesh(const CoarseGrid& grid) {
    Mesh mesh;
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const Point x = grid.nodes[i];
        using Scalar = typename Mesh::Scalar;
        mesh.add_vertex(
            {static_cast<Scalar>(x[0]), static_cast<Scalar>(x[1]), static_cast<Scalar>(x[2])});
    }
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        std::vector<OpenMesh::VertexHandle> loop;
        for (const auto n : grid.element(e)) {
            loop.push_back(mesh.vertex_handle(static_cast<unsigned>(n)));
        }
        if (loop.size() == 4) std::swap(loop[2], loop[3]);
        EXPECT_TRUE(mesh.add_face(loop).is_valid());
    }
    return mesh;
}

/// The same elements, each with the same loop, begun anywhere.
void expect_same_elements(const CoarseGrid& a, const CoarseGrid& b) {
    ASSERT_EQ(a.element_count(), b.element_count());
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t e = 0; e < a.element_count(); ++e) {
        ASSERT_EQ(a.shapes[e], b.shapes[e]);
        const auto loop = [e](const CoarseGrid& grid) {
            std::vector<std::uint32_t> l(grid.element(e).begin(), grid.element(e).end());
            if (l.size() == 4) std::swap(l[2], l[3]);
            std::rotate(l.begin(), std::min_element(l.begin(), l.end()), l.end());
            return l;
        };
        EXPECT_EQ(loop(a), loop(b));
    }
}

TEST(SurfaceFiles, KeepCommentsAndColoursOut) {
    const CoarseGrid grid = read_surface(
        write_file("extras.off",
                   "OFF # two faces\n4 2 0\n\n# points\n0 0 0\n1 0 0\n0 1 0\n1 1 0 # last\n"
                   "3 0 1 2 0.5 0.5 0\n3 1 3 2 255 0 0\n"));
    ASSERT_EQ(grid.element_count(), 2U);
    EXPECT_EQ(grid.element(1)[1], 3U);
    EXPECT_DOUBLE_EQ(total_measure(grid), 1);
}

class SurfaceFormats : public testing::TestWithParam<const char*> {};

TEST_P(SurfaceFormats, ComeBack) {
    const std::string ending = GetParam();
    const bool triangles = ending == ".stl";
    const CoarseGrid sample = torus(20, 10, !triangles);
    const auto mesh = to_openmesh<PolyMesh>(sample);
    for (const bool binary : {false, true}) {
        if (binary && (ending == ".obj" || ending == ".off")) continue;
        SCOPED_TRACE(binary);
        OpenMesh::IO::Options options;
        if (binary) options += OpenMesh::IO::Options::Binary;
        const std::string path = testing::TempDir() + "torus" + ending;
        ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, path, options, 9));
        CoarseGrid grid = read_surface(path);
        EXPECT_FALSE(grid.nodes.borrowed());
        EXPECT_EQ(grid.nodes.size(), sample.nodes.size());  // STL: vertices are one again
        EXPECT_EQ(grid.element_count(), sample.element_count());
        if (!triangles) expect_same_elements(grid, sample);
        EXPECT_NEAR(total_measure(grid), total_measure(sample), 2e-5);
        check_and_orient(grid);
        EXPECT_EQ(components(grid).second, 1);
    }
}

TEST_P(SurfaceFormats, AreNeverReadInPart) {
    const std::string ending = GetParam();
    const auto mesh = to_openmesh<PolyMesh>(torus(4, 3, ending != ".stl"));
    for (const bool binary : {false, true}) {
        if (binary && (ending == ".obj" || ending == ".off")) continue;
        OpenMesh::IO::Options options;
        if (binary) options += OpenMesh::IO::Options::Binary;
        const std::string path = testing::TempDir() + "cut" + ending;
        ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, path, options));
        std::ifstream file(path, std::ios::binary);
        const std::string all{std::istreambuf_iterator<char>(file), {}};
        const CoarseGrid whole = read_surface(path);
        for (std::size_t size = 0; size < all.size(); size += 3) {
            write_file("cut" + ending, all.substr(0, size));
            // What is cut within the last number or behind it cannot be told; a text without
            // counts (.obj) may end after any line.
            try {
                const CoarseGrid grid = read_surface(path);
                if (ending != ".obj") {
                    EXPECT_EQ(grid.element_count(), whole.element_count()) << size;
                    EXPECT_GT(size + 10, all.size());
                }
            } catch (const IoError& error) {
                EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
            } catch (const InvalidInput& error) {
                EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, SurfaceFormats, testing::Values(".off", ".obj", ".ply", ".stl"),
                         [](const auto& ending) { return std::string(ending.param).substr(1); });

TEST(SurfaceFileSentences, SayWhatIsWrongAndWhere) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    expect_sentence<IoError>([] { read_surface("/nowhere/x.off"); },
                             {"/nowhere/x.off", "cannot be opened"});
    for (const std::string ending : {".off", ".obj", ".ply", ".stl"}) {
        const std::string path = write_file("empty" + ending, " \n");
        expect_sentence<IoError>([&] { read_surface(path); }, {path, "is empty"});
    }
    const auto refused = [](const std::string& name, const std::string& content,
                            std::initializer_list<std::string> words) {
        const std::string path = write_file(name, content);
        expect_sentence<InvalidInput>([&] { read_surface(path); }, words);
    };
    const auto unreadable = [](const std::string& name, const std::string& content,
                               std::initializer_list<std::string> words) {
        const std::string path = write_file(name, content);
        expect_sentence<IoError>([&] { read_surface(path); }, words);
    };
    refused("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", {"none.off", "no faces"});
    refused("none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", {"none.obj", "no faces"});
    refused("none.stl", "solid x\nendsolid x\n", {"none.stl", "no faces"});
    unreadable("wild.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n",
               {"wild.off", "names a vertex that is not there"});
    refused("binary.off", "OFF BINARY\n", {"binary.off", "save it as text"});
    refused("four.off", "4OFF\n3 1 0\n", {"four.off", "other dimensions"});
    refused("wild.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
            {"face 0", "wild.obj", "names a vertex that is not there"});
    refused("five.off", "OFF\n5 1 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n5 0 1 3 4 2\n",
            {"five.off", "face 0", "5 corners"});
    unreadable("greedy.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", {"greedy.off", "truncated"});
    unreadable("greedy2.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n",
               {"greedy2.off", "truncated or damaged"});
    unreadable("words.off", "OFF\n3 1 0\n0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n",
               {"words.off", "truncated or damaged"});
    unreadable("picture.off", "P6 640 480 255\n", {"picture.off", "header"});
    unreadable("count.ply", "ply\nformat ascii 1.0\nelement face x\nend_header\n", {"count.ply"});
    unreadable("format.ply", "ply\nformat ascii\nelement face 1\nend_header\n", {"format.ply"});
    unreadable("corner.obj", "v 0 0 0\nf /1 1 1\n", {"corner.obj", "damaged"});
    unreadable("half.ply", "ply\nformat ascii 1.0\nelement ver", {"half.ply", "header"});
    unreadable("cut.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
               {"cut.stl", "truncated"});
    unreadable("surface.vtk", "# vtk DataFile Version 3.0\n", {"surface.vtk", "no .off"});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(SurfaceFileSentences, NameBadSurfaces) {
    CoarseGrid fins = read_surface(write_file(
        "fins.off", "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 1 0 3\n3 0 1 4\n"));
    EXPECT_EQ(fins.element_count(), 3U);
    expect_sentence<InvalidInput>([&] { check_and_orient(fins); },
                                  {"not a manifold", "0, 1 and 2", "edge 0-1"});

    CoarseGrid strip = read_surface(write_file("strip.off", off_file(moebius_strip(9))));
    EXPECT_EQ(strip.element_count(), 9U);
    expect_sentence<InvalidInput>([&] { check_and_orient(strip); },
                                  {"cannot be oriented", "Moebius", "edge "});

    CoarseGrid twice =
        read_surface(write_file("twice.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n1 0 0\n3 0 1 2\n"));
    expect_sentence<InvalidInput>([&] { check_and_orient(twice); },
                                  {"duplicate vertex", "1 and 3"});
    CoarseGrid nan =
        read_surface(write_file("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1e99 0\nf 1 2 3\n"));
    EXPECT_EQ(nan.element_count(), 1U);
}

TEST(Refusals, OfSurfacesInFiles) {
    RefusalRows rows("surfaces in files");
    const InTestFolder folder;
    const auto read = [](const std::string& name, const std::string& content) {
        return [name, content] {
            write_file(name, content);
            CoarseGrid grid = read_surface(name);
            check_and_orient(grid);
        };
    };
    rows.add<IoError>("no such file", [] { read_surface("missing.off"); });
    rows.add<IoError>("a file of another format", read("mesh.vtk", "x"));
    rows.add<IoError>("an empty file", read("empty.stl", " \n"));
    rows.add<IoError>("a corner without a vertex",
                      read("wild.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"));
    rows.add("no faces", read("none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
    rows.add("a binary file that is not read", read("binary.off", "OFF BINARY\n"));
    rows.add("a polygon of five corners",
             read("five.off", "OFF\n5 1 0\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n"));
    rows.add("an edge of three triangles",
             read("fins.off",
                  "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 1 0 "
                  "3\n3 0 1 4\n"));
    rows.add("two vertices at one place",
             read("twice.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n1 0 0\n3 0 1 2\n"));
    rows.add("a surface of one side", read("strip.off", off_file(moebius_strip(9))));
}

}  // namespace
