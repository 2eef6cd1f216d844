// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tetrahedra from TetGen: its arrays in place, its files, its mesher.
#include <filesystem>

#include <nestgrid/adapters/tetgen.hpp>

#include "coarse_samples.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

/// Eight points of a box and its six faces, numbered from `first` on.
std::string box_points(int first, double low, double high) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
        text += std::to_string(first + i);
        for (int d = 0; d < 3; ++d) text += " " + std::to_string((i >> d & 1) != 0 ? high : low);
        text += "\n";
    }
    return text;
}
std::string box_faces(int first, const std::string& before) {
    const int faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
    std::string text;
    for (const auto& face : faces) {
        text += before + "4";
        for (const int corner : face) text += " " + std::to_string(first + corner);
        text += "\n";
    }
    return text;
}

/// The unit cube with a cubic cavity of width 1/2.
const std::string cavity_poly = "# a cube with a cavity\n16 3 0 0\n" + box_points(1, 0, 1) +
                                box_points(9, 0.25, 0.75) + "12 0\n" + box_faces(1, "1 0 1\n") +
                                box_faces(9, "1\n") + "1\n1 0.5 0.5 0.5\n0\n";

const std::string two_nodes = "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1 # the top\n";

/// Whether a function ran without a word on standard output.
template <class Function>
void expect_silence(Function&& function) {
    testing::internal::CaptureStdout();
    function();
    std::fflush(stdout);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(TetGen, LendsItsArrays) {
    for (const int first : {0, 1}) {
        tetgenio plc;
        detail::read_plc_file(write_file("cavity.poly", cavity_poly), false, plc);
        for (const std::string switches : {"pq1.4a.05", "po2"}) {
            tetgenio mesh;
            expect_silence([&] {
                tetrahedralize(plc, mesh, {.switches = switches + (first == 0 ? "z" : "")});
            });
            EXPECT_EQ(mesh.firstnumber, first);
            EXPECT_EQ(mesh.numberofcorners, switches == "po2" ? 10 : 4);
            CoarseGrid grid = coarse_from_tetgen(mesh);
            EXPECT_TRUE(grid.nodes.borrowed());
            EXPECT_EQ(grid.element_count(), std::size_t(mesh.numberoftetrahedra));
            check_and_orient(grid);
            EXPECT_NEAR(total_measure(grid), 1 - 0.125, 1e-10);
            mesh.pointlist[4] = 17;
            EXPECT_EQ(grid.nodes[1][1], 17);
            mesh.firstnumber = 2;
            expect_sentence<InvalidInput>([&] { coarse_from_tetgen(mesh); }, {"numbered from 2"});
        }
    }
    expect_sentence<InvalidInput>([] { coarse_from_tetgen(tetgenio()); }, {"no tetrahedra"});
}

TEST(TetGen, MeshesACubeWithACavity) {
    const std::string smesh = "16 3\n" + box_points(0, 0, 1) + box_points(8, 0.25, 0.75) +
                              "12 0\n" + box_faces(0, "") + box_faces(8, "") + "1\n1 0.5 0.5 0.5\n";
    for (const std::string& path :
         {write_file("cavity.poly", cavity_poly), write_file("cavity.smesh", smesh)}) {
        std::size_t coarser = 0;
        for (const char* switches : {"p", "pq1.4", "pq1.4a.002"}) {
            CoarseGrid grid;
            expect_silence([&] { grid = read_tetgen(path, {.switches = switches}); });
            EXPECT_FALSE(grid.nodes.borrowed());
            EXPECT_GT(grid.element_count(), coarser);
            coarser = grid.element_count();
            check_and_orient(grid);
            EXPECT_NEAR(total_measure(grid), 1 - 0.125, 1e-10);
            EXPECT_EQ(components(grid).second, 1);
        }
    }
    write_file("apart.node", "16 3\n" + box_points(0, 0, 1) + box_points(8, 0.25, 0.75));
    const std::string apart =
        write_file("apart.smesh", "0 3\n12 0\n" + box_faces(0, "") + box_faces(8, "") + "0\n");
    EXPECT_NEAR(std::abs(total_measure(read_tetgen(apart))), 1, 1e-10);
}

TEST(TetGen, ReadsPairsOfFiles) {
    for (const int first : {0, 1}) {
        std::string nodes = "5 3 1 1 # points\n\n";
        const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
        for (int i = 0; i < 5; ++i) {
            nodes += std::to_string(first + i);
            for (const double c : x[i]) nodes += " " + std::to_string(c);
            nodes += " 3.5 1\n";
        }
        const auto tetrahedron = [&](std::string name, std::initializer_list<int> corners) {
            for (const int c : corners) name += " " + std::to_string(first + c);
            return name + "\n";
        };
        const std::string path = write_file("pair.node", nodes);
        write_file("pair.ele",
                   "2 4 0\n" + tetrahedron("0", {0, 1, 2, 3}) + tetrahedron("1", {1, 2, 3, 4}));
        for (const std::string& name : {path, testing::TempDir() + "pair.ele"}) {
            CoarseGrid grid = read_tetgen(name);
            EXPECT_EQ(grid.element_count(), 2U);
            EXPECT_EQ(grid.nodes.size(), 5U);
            check_and_orient(grid);
            EXPECT_NEAR(total_measure(grid), 0.5, 1e-15);
        }
    }
}

TEST(TetGenSentences, NameBadGrids) {
    const auto refused = [](const std::string& nodes, const std::string& tetrahedra,
                            std::initializer_list<std::string> words) {
        write_file("bad.ele", tetrahedra);
        CoarseGrid grid = read_tetgen(write_file("bad.node", nodes));
        expect_sentence<InvalidInput>([&] { check_and_orient(grid); }, words);
    };
    const std::string nodes = "6 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n5 0 0 -1\n";
    refused(nodes, "3 4\n0 0 1 2 3\n1 1 3 2 4\n2 0 2 1 5\n", {"inverted element", "tetrahedron 1"});
    refused(nodes, "3 4\n0 0 1 2 3\n1 0 1 2 4\n2 0 1 2 5\n",
            {"not a manifold", "0, 1 and 2", "face 0-1-2"});
    refused(nodes, "1 4\n0 0 1 1 3\n", {"tetrahedron 0", "node 1 twice"});
    refused("5 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 0 0\n", "1 4\n0 0 1 2 3\n",
            {"duplicate vertex", "1 and 4"});
    refused("4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 1 1 0\n", "1 4\n0 0 1 2 3\n",
            {"tetrahedron 0 is flat"});
}

TEST(TetGenSentences, NameBadFiles) {
    expect_silence([] {
        expect_sentence<IoError>([] { read_tetgen("/nowhere/x.poly"); },
                                 {"/nowhere/x.poly", "cannot be opened"});
        expect_sentence<IoError>([] { read_tetgen("x.stl"); }, {"x.stl", "no .node"});
        const auto unreadable = [](const std::string& name, const std::string& content,
                                   std::initializer_list<std::string> words) {
            const std::string path = write_file(name, content);
            expect_sentence<IoError>([&] { read_tetgen(path); }, words);
        };
        for (const std::string ending : {".node", ".poly", ".smesh"}) {
            unreadable("empty" + ending, "", {"empty" + ending, "is empty"});
        }
        unreadable("lonely.node", two_nodes, {"lonely.ele", "cannot be opened"});
        unreadable("flat.node", "3 2\n0 0 0\n1 1 0\n2 0 1\n", {"flat.node", "3 coordinates"});
        unreadable("greedy.node", "2000000000 3\n0 0 0 0\n", {"greedy.node", "too short"});
        unreadable("negative.poly", "-4 3\n0 0 0 0\n", {"negative.poly', line 1", "integer"});
        unreadable("word.poly", "4 3\n0 0 0 0\n1 one 0 0\n", {"word.poly', line 3", "'one'"});
        unreadable("nan.poly", "4 3\n0 0 0 0\n1 nan 0 0\n", {"nan.poly', line 3", "'nan'"});
        unreadable("order.poly", "4 3\n0 0 0 0\n2 1 0 0\n", {"order.poly', line 3", "in order"});
        unreadable("wild.smesh", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n1\n3 1 2 9\n0\n",
                   {"wild.smesh', line 7", "from 0 to 3"});
        write_file("wild.ele", "1 4\n0 0 1 2 7\n");
        unreadable("wild.node", two_nodes, {"wild.ele', line 2", "from 0 to 4"});
        write_file("none.ele", "0 4\n");
        const std::string none = write_file("none.node", two_nodes);
        expect_sentence<InvalidInput>([&] { read_tetgen(none); }, {"none.node", "no tetrahedra"});
    });
}

TEST(TetGenSentences, EveryTruncatedFileIsRefused) {
    for (std::size_t size = 0; size < cavity_poly.size() - 10; size += 3) {
        const std::string path = write_file("cut.poly", cavity_poly.substr(0, size));
        expect_sentence<IoError>([&] { read_tetgen(path); }, {"cut.poly"});
    }
}

TEST(TetGenSentences, NameBadComplexes) {
    const auto refused = [](const std::string& name, const std::string& content,
                            std::initializer_list<std::string> words) {
        const std::string path = write_file(name, content);
        expect_silence([&] { expect_sentence<InvalidInput>([&] { read_tetgen(path); }, words); });
    };
    // Two boxes that intersect: facets 1 ... 6 and 7 ... 12.
    refused("crossing.smesh",
            "16 3\n" + box_points(0, 0, 1) + box_points(8, 0.5, 1.5) + "12 0\n" + box_faces(0, "") +
                box_faces(8, "") + "0\n",
            {"crossing.smesh", "intersects itself", "facets 2 4 6 7 9 11"});
    // A box without its lid.
    const std::string faces = box_faces(0, "");
    refused("open.smesh",
            "8 3\n" + box_points(0, 0, 1) + "5 0\n" + faces.substr(0, faces.rfind("4 4")) + "0\n",
            {"open.smesh", "do not close"});
    refused("eaten.smesh", "8 3\n" + box_points(0, 0, 1) + "6 0\n" + faces + "1\n1 .5 .5 .5\n",
            {"eaten.smesh", "holes take everything"});
    refused("few.smesh", "3 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n1\n3 0 1 2\n0\n", {"less than four"});
    refused("plane.smesh", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 1 1 0\n1\n3 0 1 2\n0\n",
            {"plane.smesh", "is flat"});
    refused("slope.smesh", "4 3\n0 0 0 0\n1 1 0 1\n2 0 1 0\n3 1 1 1\n1\n3 0 1 2\n0\n",
            {"slope.smesh", "flat"});
    refused("twice.smesh", "5 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 0 1 0\n1\n3 0 1 2\n0\n",
            {"twice.smesh", "duplicate vertex", "2 and 4"});
    refused("again.smesh", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n1\n3 0 1 1\n0\n",
            {"again.smesh", "facet 1 has the point 1 twice"});
    refused("bent.smesh", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n1\n4 0 1 2 3\n0\n",
            {"bent.smesh", "facet 1 is not plane"});
    const std::string path = write_file("cavity.poly", cavity_poly);
    expect_sentence<InvalidInput>([&] { read_tetgen(path, {.switches = "r"}); },
                                  {"cavity.poly", "switches 'r'"});
}

TEST(Refusals, OfTetGen) {
    RefusalRows rows("TetGen");
    const InTestFolder folder;
    const auto read = [](const std::string& name, const std::string& content) {
        return [name, content] {
            write_file(name, content);
            read_tetgen(name);
        };
    };
    const std::string points = "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";
    rows.add<IoError>("no such file", [] { read_tetgen("missing.poly"); });
    rows.add<IoError>("a file of another format", [] { read_tetgen("surface.stl"); });
    rows.add<IoError>("an empty file", read("empty.node", ""));
    rows.add<IoError>("a file that is cut", read("cut.poly", "9 3\n0 0 0 0\n"));
    rows.add<IoError>("a coordinate that is no number",
                      read("nan.poly", "4 3\n0 0 0 0\n1 nan 0 0\n"));
    rows.add<IoError>("a facet of a point that is not there",
                      read("wild.smesh", points + "1\n3 1 2 9\n0\n"));
    write_file("none.ele", "0 4\n");
    rows.add("no tetrahedra", read("none.node", two_nodes));
    rows.add("a facet that is not plane", read("bent.smesh", points + "1\n4 0 1 2 3\n0\n"));
    rows.add("a facet that has a point twice", read("again.smesh", points + "1\n3 0 1 1\n0\n"));
    const std::string faces = box_faces(0, "");
    const std::string box = "8 3\n" + box_points(0, 0, 1);
    rows.add("facets that do not close",
             read("open.smesh", box + "5 0\n" + faces.substr(0, faces.rfind("4 4")) + "0\n"));
    rows.add("facets that intersect",
             read("crossing.smesh", "16 3\n" + box_points(0, 0, 1) + box_points(8, 0.5, 1.5) +
                                        "12 0\n" + faces + box_faces(8, "") + "0\n"));
    rows.add("switches for something else", [&] {
        write_file("box.smesh", box + "6 0\n" + faces + "0\n");
        read_tetgen("box.smesh", {.switches = "r"});
    });
}

}  // namespace
