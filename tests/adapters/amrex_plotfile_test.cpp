// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plotfiles: mapped, and refused in a sentence where they are damaged.
#include <nestgrid/adapters/amrex_plotfile.hpp>

#include "amrex_plotfiles.hpp"
#include "closedness.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid_test;

namespace amrex_plotfile_test {

double wave(const Point& x, int field) {
    return std::sin(7 * x[0] + field) + std::cos(9 * x[1]) * (1 + x[2]) - 0.4;
}

std::filesystem::path folder(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) / name;
}

template <int dim, class Real>
void expect_same_as_blocks(const PlotfileWay& way) {
    for (unsigned seed = 1; seed < 5; ++seed) {
        Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .side = 4});
        for (std::size_t d = 0; d < dim; ++d) blocks.origin[d] = 0.5 * static_cast<double>(d) - 2;
        write_plotfile<dim, Real>(folder("plt00000"), blocks, {"density", "x velocity"}, wave, 1.25,
                                  way);
        const AmrexPlotfile file(folder("plt00000"));
        EXPECT_EQ(file.dimension(), dim);
        EXPECT_EQ(file.time(), 1.25);
        EXPECT_EQ(file.is_double(), sizeof(Real) == 8);
        EXPECT_EQ(file.fields(), (std::vector<std::string>{"density", "x velocity"}));
        EXPECT_EQ(file.level_count(), blocks.levels.size());
        const BlockGrid<dim> grid(file.blocks<dim>());
        const BlockGrid<dim> own(blocks);
        EXPECT_EQ(grid.epoch(), own.epoch());
        for (const std::size_t field : {0U, 1U}) {
            const BlockCells<dim, Real> mapped(grid, file.arrays<dim, Real>(field));
            const BlockData<dim, Real> data(
                blocks, [&](const Point& x) { return wave(x, static_cast<int>(field)); }, 0);
            const auto a = isosurface(grid, mapped, 0.0).surface;
            const auto b = isosurface(own, BlockCells<dim, Real>(own, data.arrays()), 0.0).surface;
            EXPECT_GT(a.simplices.size(), 0U);
            EXPECT_EQ(a.vertices, b.vertices);
            EXPECT_EQ(a.simplices, b.simplices);
        }
    }
}

TEST(AmrexPlotfile, IsReadInPlace) {
    expect_same_as_blocks<3, double>({});
    expect_same_as_blocks<3, float>({.ghosts = 1});
    expect_same_as_blocks<2, double>({.ghosts = 2});
    expect_same_as_blocks<2, float>({});
}

TEST(AmrexPlotfile, IsReadHoweverItIsWritten) {
    for (int version = 2; version <= 4; ++version) {
        expect_same_as_blocks<3, float>({.ghosts = version - 2, .version = version});
    }
    expect_same_as_blocks<3, double>({.is_reversed = true});
    expect_same_as_blocks<2, float>({.ghosts = 1, .is_reversed = true});
    expect_same_as_blocks<2, double>({.ghosts = 1, .version = 2, .is_reversed = true});
    expect_same_as_blocks<3, double>({.has_empty_level = true});
}

/// A name may have blanks within, but not at its end.
TEST(AmrexPlotfile, NamesFieldsAsTheyAreMeant) {
    Blocks<2> blocks;
    blocks.levels.push_back({{{{0, 0}, {3, 3}}}, {}});
    const auto zero = [](const Point&, int) { return 0.0; };
    write_plotfile<2, double>(folder("plt00003"), blocks, {"x velocity (m/s)  ", "b\t\r"}, zero, 0);
    const std::vector<std::string> expected{"x velocity (m/s)", "b"};
    EXPECT_EQ(AmrexPlotfile(folder("plt00003")).fields(), expected);
}

/// Cells that are free by less than the least part have no number, in either order of bytes; those
/// of a file that tells no such part, and the parts themselves, are as they are.
TEST(AmrexPlotfile, HidesWhatEmbeddedBoundariesCover) {
    const auto is_covered = [](const Point& x) { return x[0] + x[1] < 0.6; };
    const auto value = [&](const Point& x, int field) {
        return field == 1 ? (is_covered(x) ? 1e-9 : 0.5) : wave(x, 0);
    };
    Blocks<2> blocks;
    blocks.levels.push_back({{{{0, 0}, {3, 7}}, {{4, 0}, {7, 7}}}, {}});
    blocks.levels.push_back({{{{2, 2}, {5, 7}}, {{6, 2}, {7, 3}}}, {2, 2}});
    blocks.spacing = {0.125, 0.125, 1};
    for (const double least : {0.0, 1e-6}) {
        for (const bool is_reversed : {false, true}) {
            write_plotfile<2, double>(folder("plt00002"), blocks, {"u", "vfrac"}, value, 0,
                                      {.is_reversed = is_reversed, .least_fraction = least});
            const AmrexPlotfile file(folder("plt00002"));
            const CellsOfBlocks<2> cells(blocks);
            for (const std::size_t field : {0U, 1U}) {
                const auto arrays = file.arrays<2, double>(field);
                std::size_t hidden = 0;
                for (std::size_t l = 0; l < 2; ++l) {
                    for (std::size_t b = 0; b < 2; ++b) {
                        const BlockBox<2>& box = blocks.levels[l].boxes[b];
                        for_each_cell(box, [&](const Cell<2>& c) {
                            if (!cells.is_leaf(l, c)) return;
                            const Point x = cells.centre(l, c);
                            const double u =
                                arrays[l][b].at({c[0] - box.lower[0], c[1] - box.lower[1]});
                            if (least > 0 && field == 0 && is_covered(x)) {
                                EXPECT_TRUE(std::isnan(u));
                                ++hidden;
                            } else {
                                EXPECT_EQ(u, value(x, static_cast<int>(field)));
                            }
                        });
                    }
                }
                EXPECT_EQ(hidden > 5, least > 0 && field == 0);
            }
        }
    }
}

TEST(AmrexPlotfile, CountsCells) {
    Blocks<2> blocks;
    blocks.levels.push_back({{{{0, 0}, {7, 3}}}, {}});
    blocks.levels.push_back({{{{2, 2}, {5, 7}}, {{6, 2}, {7, 3}}}, {2, 2}});
    write_plotfile<2, double>(folder("plt00001"), blocks, {"u"}, wave);
    const AmrexPlotfile file(folder("plt00001"));
    EXPECT_EQ(file.cell_count(0), 32U);
    EXPECT_EQ(file.cell_count(1), 28U);
    EXPECT_EQ(file.box_count(1), 2U);
}

std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}
void put(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}
std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

Blocks<3> two_levels() {
    Blocks<3> blocks;
    blocks.levels.push_back({{{{0, 0, 0}, {3, 3, 3}}}, {}});
    blocks.levels.push_back({{{{2, 2, 2}, {5, 5, 5}}}, {2, 2, 2}});
    blocks.spacing = {0.25, 0.25, 0.25};
    return blocks;
}

TEST(AmrexPlotfile, SaysWhatIsWrong) {
    const InTestFolder here;
    RefusalRows rows("AMReX plotfiles");
    const std::filesystem::path name("plt");
    const auto add = [&](const std::string& state, const std::string& file, const std::string& what,
                         const std::string& by) {
        write_plotfile<3, double>(name, two_levels(), {"density"}, wave);
        put(name / file, replaced(content(name / file), what, by));
        rows.add<IoError>(state, [&] { AmrexPlotfile{name}; });
    };
    write_plotfile<3, double>(name, two_levels(), {"density"}, wave);
    rows.add<IoError>("no folder", [] { AmrexPlotfile("missing"); });
    put(name / "Header", "HyperCLaw-V1.1\n1\ndensity\n3\n0\n1\n");
    rows.add<IoError>("a header that is cut", [&] { AmrexPlotfile{name}; });
    add("a word in the place of a number", "Header", "\n3\n", "\nthree\n");
    add("spherical coordinates", "Header", "\n0\n0\n0 1", "\n2\n0\n0 1");
    add("a path out of the folder", "Header", "Level_1/", "../");
    add("another number of boxes", "Level_1/Cell_H", "(1 0\n", "(2 0\n");
    add("more boxes than a file holds", "Header", "\n0 1 0\n", "\n0 999999999999 0\n");
    add("an empty box", "Level_1/Cell_H", "((2,2,2) (5,5,5)", "((2,2,2) (5,1,5)");
    add("data of faces", "Level_1/Cell_H", "(5,5,5) (0,0,0)", "(5,5,5) (1,0,0)");
    add("records of another version", "Level_0/Cell_H", "1\n1\n1\n", "5\n1\n1\n");
    add("records without a type of numbers", "Level_0/Cell_H", "1\n1\n1\n", "2\n1\n1\n");
    add("a place behind the end of a file", "Level_1/Cell_H", "Cell_D_00000 0",
        "Cell_D_00000 9999");
    add("no record at a place", "Level_1/Cell_H", "Cell_D_00000 0", "Cell_D_00000 9");
    add("no order of bytes", "Level_0/Cell_D_00000", "8 7 6 5 4 3 2 1", "8 7 6 5 4 3 2 2");
    add("several orders of bytes", "Level_1/Cell_D_00000", "8 7 6 5 4 3 2 1", "1 2 3 4 5 6 7 8");
    add("a level without boxes", "Header", "\n0 1 0\n7\n0 1\n0 1\n0 1\n", "\n0 0 0\n7\n");
    add("numbers that are no IEEE numbers", "Level_0/Cell_D_00000", "64 11 52", "64 12 51");
    add("a box that is not in its record", "Level_0/Cell_D_00000", "((0,0,0) (3,3,3)",
        "((0,0,1) (3,3,4)");
    write_plotfile<3, double>(name, two_levels(), {"density"}, wave);
    std::filesystem::resize_file(name / "Level_1/Cell_D_00000", 400);
    rows.add<IoError>("numbers that are cut", [&] { AmrexPlotfile{name}; });
    write_plotfile<3, double>(name, two_levels(), {"density"}, wave);
    rows.add("another dimension", [&] { AmrexPlotfile(name).blocks<2>(); });
    rows.add("another type of numbers", [&] { AmrexPlotfile(name).arrays<3, float>(0); });
    rows.add("a field that is not there", [&] { AmrexPlotfile(name).arrays<3, double>(1); });
    put(name / "Header",
        replaced(content(name / "Header"), "((0,0,0) (7,7,7)", "((0,0,0) (8,7,7)"));
    rows.add("domains that do not fit together", [&] { AmrexPlotfile(name).blocks<3>(); });
    put(name / "Header",
        replaced(content(name / "Header"), "((0,0,0) (8,7,7)", "((8,0,0) (15,7,7)"));
    rows.add("a domain that begins elsewhere", [&] { AmrexPlotfile(name).blocks<3>(); });
}

/// Reads and draws what is there; a sentence where it is refused.
std::string drawn(const std::filesystem::path& name) {
    try {
        const AmrexPlotfile file(name);
        if (file.dimension() != 3 || !file.is_double()) return "";
        const BlockGrid<3> grid(file.blocks<3>());
        for (std::size_t field = 0; field < file.fields().size(); ++field) {
            const BlockCells<3, double> values(grid, file.arrays<3, double>(field));
            const auto surface = isosurface(grid, values, 0.0).surface;
            expect_closed(surface);
        }
    } catch (const IoError& error) {
        return error.what();
    } catch (const InvalidInput& error) {
        return error.what();
    } catch (const GridError& error) {
        return error.what();
    }
    return "";
}

/// Bytes changed, left out, doubled and cut, in the texts and in the first lines of records, of
/// files that were written in several ways: 800 times, of which most are noticed, and the others
/// are drawn.
void damage(const PlotfileWay& way) {
    const std::filesystem::path name = folder("damaged");
    const std::array<std::string, 5> files{"Header", "Level_0/Cell_H", "Level_1/Cell_H",
                                           "Level_0/Cell_D_00000", "Level_1/Cell_D_00000"};
    std::mt19937 random(1);
    write_plotfile<3, double>(
        name, two_levels(), {"density", "vfrac"},
        [](const Point& x, int field) { return field == 1 ? 1 : wave(x, 0); }, 0, way);
    ASSERT_EQ(drawn(name), "");
    std::array<std::string, 5> whole;
    for (std::size_t i = 0; i < files.size(); ++i) whole[i] = content(name / files[i]);
    std::size_t refused = 0;
    for (int i = 0; i < 200; ++i) {
        const std::size_t f = random() % files.size();
        std::string text = whole[f];
        const std::size_t room = std::min<std::size_t>(text.size(), f < 3 ? text.size() : 120);
        const std::size_t at = random() % room;
        const std::string_view likely = "0123456789-(), \n.e";
        switch (random() % 5) {
            case 0:
                text[at] = static_cast<char>(random() % 256);
                break;
            case 1:
                text[at] = likely[random() % likely.size()];
                break;
            case 2:
                text.erase(at, 1 + random() % 20);
                break;
            case 3:
                text.insert(at, text.substr(random() % room, 1 + random() % 20));
                break;
            default:
                text.resize(random() % text.size());
        }
        put(name / files[f], text);
        const std::string sentence = drawn(name);
        if (!sentence.empty()) ++refused;
        put(name / files[f], whole[f]);
    }
    EXPECT_GT(refused, way.version == 1 ? 100U : 70U);
    ASSERT_EQ(drawn(name), "");
}

TEST(AmrexPlotfile, ThatIsDamagedIsRefusedInASentence) {
    damage({});
    damage({.is_reversed = true});
    damage({.ghosts = 1, .version = 3, .has_empty_level = true});
    damage({.version = 2, .least_fraction = 1e-6});
}

}  // namespace amrex_plotfile_test
