// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files that ranks write of their pieces (mpi_files.hpp): read back, they are the surface of one
// process. Run under mpirun; prints what it compared, and returns 1 where something differs.
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>

#include <sys/resource.h>

#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "cut_grid.hpp"
#include "sample_grids.hpp"

using namespace nestgrid_test;

namespace {

namespace fs = std::filesystem;

/// A file of VTK with raw numbers, as these tests read it.
class RawFile {
public:
    explicit RawFile(const fs::path& path) {
        std::ifstream in(path, std::ios::binary);
        text_.assign(std::istreambuf_iterator<char>(in), {});
        const std::string mark = "<AppendedData encoding=\"raw\">\n_";
        data_ = text_.find(mark) + mark.size();
    }
    std::size_t number(const std::string& attribute) const {
        return std::stoul(text_.substr(text_.find(attribute + "=\"") + attribute.size() + 2));
    }
    template <class T>
    std::vector<T> array(const std::string& name) const {
        const std::size_t tag = text_.find("Name=\"" + name + "\"");
        if (tag == std::string::npos) return {};
        const std::string key = "offset=\"";
        const std::size_t at = data_ + std::stoul(text_.substr(text_.find(key, tag) + key.size()));
        std::uint64_t bytes = 0;
        std::memcpy(&bytes, text_.data() + at, sizeof bytes);
        std::vector<T> numbers(bytes / sizeof(T));
        std::memcpy(numbers.data(), text_.data() + at + sizeof bytes, bytes);
        return numbers;
    }
    bool ends_well() const { return text_.ends_with("</VTKFile>\n"); }

private:
    std::string text_;
    std::size_t data_ = 0;
};

using Corner = std::array<double, 7>;  // position, attribute, normal
using Triangle = std::array<Corner, 3>;

void sort(std::vector<Triangle>& all) {
    for (Triangle& t : all) std::ranges::rotate(t, std::ranges::min_element(t));
    std::ranges::sort(all);
}

std::vector<Triangle> triangles_of(const RawFile& file) {
    const auto x = file.array<double>("Points");
    const auto attribute = file.array<double>("attribute 1");
    const auto normal = file.array<double>("Normals");
    const auto corners = file.array<std::int64_t>("connectivity");
    std::vector<Triangle> all(corners.size() / 3);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto v = static_cast<std::size_t>(corners[i]);
        all[i / 3][i % 3] = {x[3 * v],      x[3 * v + 1],      x[3 * v + 2],     attribute[v],
                             normal[3 * v], normal[3 * v + 1], normal[3 * v + 2]};
    }
    return all;
}

std::vector<Triangle> triangles_of(const Surface<3>& surface) {
    std::vector<Triangle> all;
    for (const auto& t : surface.simplices) {
        Triangle& corners = all.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& x = surface.vertices[t[k]];
            const auto& n = surface.normals[t[k]];
            corners[k] = {x[0], x[1], x[2], surface.attributes[t[k]], n[0], n[1], n[2]};
        }
    }
    return all;
}

int wrong(bool is, const char* what) {
    if (is) std::printf("%s\n", what);
    return is ? 1 : 0;
}

class Scene {
public:
    explicit Scene(MpiRanks& ranks) : ranks_{&ranks} {
        auto grid = UnbalancedOctree::grids()[0];
        std::mt19937 random(3);
        refine_at_random(grid, random, 4, 5, 2, 2000);
        whole_.emplace(grid);
        owner_ = whole_->partition(ranks.size(), Whole::Cut::in_order, random);
        for (const Point& x : whole_->positions) {
            values_.push_back(norm(x - Point{0.2, 0.3, 0.1}) + 0.02 * std::sin(30 * x[0]));
            values_.push_back(x[1]);
        }
    }
    /// Isovalues of a great surface, of a little one, and of none.
    std::array<double, 3> isovalues() const {
        std::vector<double> sorted;
        for (std::size_t n = 0; n < values_.size(); n += 2) sorted.push_back(values_[n]);
        std::ranges::sort(sorted);
        const std::size_t few = sorted.size() / 50;
        return {sorted[sorted.size() / 2], (sorted[few] + sorted[few + 1]) / 2, sorted.back() + 1};
    }
    /// The surface of one process.
    Isosurface<3> draw_whole(double isovalue) const {
        const CutGrid<3> grid(*whole_, nullptr, true);
        return draw(grid, CutField<3, double>{&grid, &values_}, isovalue);
    }
    /// Calls write(piece, joined) on each rank.
    template <class Write>
    void with_piece(double isovalue, const Write& write) const {
        const Part part(*whole_, owner_, ranks_->rank());
        const CutGrid<3> mine(*whole_, &part, true);
        const Distributed grid(mine, *ranks_);
        const DistributedField field(grid, CutField<3, double>{&mine, &values_});
        const auto piece = draw(grid, field, isovalue);
        write(piece, join_pieces(piece, grid));
    }

private:
    template <class Grid, class Field>
    static Isosurface<3> draw(const Grid& grid, const Field& field, double isovalue) {
        const HierarchicalIndicator indicator(grid, field);
        return isosurface(grid, field, isovalue, under(indicator, 1e-4), {.normals = true});
    }

    MpiRanks* ranks_;
    std::optional<Whole> whole_;
    std::vector<int> owner_;
    std::vector<double> values_;
};

/// One file, against the surface of one process.
int compare_whole(const Scene& scene, MpiRanks& ranks, double isovalue, const fs::path& folder) {
    const fs::path path = folder / "surface.vtp";
    scene.with_piece(isovalue, [&](const auto& piece, const auto& joined) {
        write_vtp(ranks, piece, joined, path);
    });
    if (ranks.rank() != 0) return 0;
    const Isosurface<3> whole = scene.draw_whole(isovalue);
    const RawFile file(path);
    auto found = triangles_of(file);
    auto expected = triangles_of(whole.surface);
    sort(found);
    sort(expected);
    std::printf("%d ranks, isovalue %.2f: %zu triangles of %zu vertices in one file\n",
                ranks.size(), isovalue, found.size(), file.number("NumberOfPoints"));
    const bool any = isovalue < scene.isovalues()[2];
    return wrong(found != expected, "the file has other triangles") +
           wrong(expected.empty() == any, "nothing is compared") +
           wrong(file.number("NumberOfPoints") != whole.surface.vertices.size(),
                 "the file has another number of vertices") +
           wrong(file.number("NumberOfPolys") != expected.size(), "another number of polygons") +
           wrong(!file.ends_well() || fs::exists(path.string() + ".part"), "the file has no end");
}

/// Files of ranks, welded by their global numbers.
int compare_pieces(const Scene& scene, MpiRanks& ranks, double isovalue, const fs::path& folder) {
    std::uint64_t with_triangles = 0;
    scene.with_piece(isovalue, [&](const auto& piece, const auto& joined) {
        write_pvtp(ranks, piece, joined, folder / "surface.pvtp");
        with_triangles = piece.surface.simplices.empty() ? 0 : 1;
    });
    ranks.reduce(std::span(&with_triangles, 1), Ranks::Reduction::sum);
    if (ranks.rank() != 0) return 0;
    std::vector<Triangle> found;
    std::map<std::int64_t, int> owned;
    std::size_t files = 0;
    for (int r = 0; r < ranks.size(); ++r) {
        const fs::path path = folder / ("surface_" + std::to_string(r) + ".vtp");
        if (!fs::exists(path)) continue;
        ++files;
        const RawFile file(path);
        for (const Triangle& t : triangles_of(file)) found.push_back(t);
        const auto ids = file.array<std::int64_t>("GlobalPointIds");
        const auto copies = file.array<std::uint8_t>("vtkGhostType");
        for (std::size_t v = 0; v < ids.size(); ++v) owned[ids[v]] += copies[v] == 0 ? 1 : 0;
    }
    std::ifstream list(folder / "surface.pvtp");
    std::size_t listed = 0;
    for (std::string line; std::getline(list, line);) listed += line.starts_with("<Piece ") ? 1 : 0;
    const Isosurface<3> whole = scene.draw_whole(isovalue);
    auto expected = triangles_of(whole.surface);
    sort(found);
    sort(expected);
    bool once = owned.size() == whole.surface.vertices.size();
    for (const auto& [id, count] : owned) once = once && count == 1;
    std::printf("%d ranks, isovalue %.2f: %zu files\n", ranks.size(), isovalue, files);
    return wrong(found != expected, "the files have other triangles") +
           wrong(!once, "a vertex is not owned once") +
           wrong(files != with_triangles || listed != files, "ranks without triangles are listed");
}

/// What is wrong where this does not end all ranks with a sentence that has `part`.
template <class Write>
int expect_end(MpiRanks& ranks, const char* what, const std::string& part, const Write& write) {
    std::string said;
    try {
        write();
    } catch (const IoError& e) {
        said = e.what();
    }
    const int failed = wrong(said.find(part) == std::string::npos, what);
    if (failed != 0) std::printf("rank %d: '%s'\n", ranks.rank(), said.c_str());
    return failed;
}

/// Limits how long a file of this rank may get, as a full disk does, while it lives.
class FullDisk {
public:
    explicit FullDisk(bool is) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit little{is ? 2000 : before_.rlim_cur, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &little);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

private:
    rlimit before_{};
};

/// MPI may let one rank write for another one, so that a disk which is full for one rank does not
/// matter. All ranks end, or none, and then the file is whole. Removes it.
template <class Write>
int end_alike(MpiRanks& ranks, const fs::path& path, const Write& write) {
    std::string said;
    try {
        write(path);
    } catch (const IoError& e) {
        said = e.what();
    }
    std::array<std::uint64_t, 1> ended{said.starts_with("rank ") ? std::uint64_t{1} : 0};
    ranks.reduce(ended, Ranks::Reduction::sum);
    const bool all = ended[0] == static_cast<std::uint64_t>(ranks.size());
    int failed = wrong(!all && ended[0] != 0, "some ranks end where others do not");
    if (ranks.rank() == 0 && ended[0] == 0) {
        failed += wrong(!RawFile(path).ends_well(), "a file of a full disk has no end");
        fs::remove(path);
    }
    return failed;
}

/// A folder that is not there, a disk that takes 2,000 bytes from all ranks or from the last one,
/// and a name that another thing has: nothing is left on any rank.
int end_together(const Scene& scene, MpiRanks& ranks, const fs::path& folder) {
    int failed = 0;
    const int last = ranks.size() - 1;
    const std::string of_last = "rank " + std::to_string(last) + ": '";
    const fs::path nowhere = folder / "nowhere" / "surface.vtp";
    scene.with_piece(scene.isovalues()[0], [&](const auto& piece, const auto& joined) {
        const auto expect_nothing_left = [&](const char* what) {
            ranks.gather({});
            failed += wrong(ranks.rank() == 0 && !fs::is_empty(folder), what);
            ranks.gather({});
        };
        failed += expect_end(ranks, "no folder", "rank 0: '" + nowhere.string(),
                             [&] { write_vtp(ranks, piece, joined, nowhere); });
        failed += expect_end(ranks, "no folder for pieces", "could not be written", [&] {
            write_pvtp(ranks, piece, joined, folder / "nowhere" / "surface.pvtp");
        });
        failed += expect_end(ranks, "full disk", "rank ", [&] {
            const FullDisk full(true);
            write_vtp(ranks, piece, joined, folder / "full.vtp");
        });
        expect_nothing_left("something is left of a file that could not be written");
        for (const int of_rank : {0, last}) {
            failed += end_alike(ranks, folder / "half.vtp", [&](const fs::path& path) {
                const FullDisk full(ranks.rank() == of_rank);
                write_vtp(ranks, piece, joined, path);
            });
        }
        expect_nothing_left("something is left of a file that one rank could not write");
        failed += expect_end(ranks, "full disk of one rank", of_last, [&] {
            const FullDisk full(ranks.rank() == last);
            write_pvtp(ranks, piece, joined, folder / "full.pvtp");
        });
        expect_nothing_left("pieces are left where one could not be written");
        const fs::path taken = folder / ("taken_" + std::to_string(last) + ".vtp");
        if (ranks.rank() == 0) fs::create_directory(taken);
        ranks.gather({});
        failed += expect_end(ranks, "a folder of that name", of_last,
                             [&] { write_pvtp(ranks, piece, joined, folder / "taken.pvtp"); });
        ranks.gather({});
        if (ranks.rank() == 0) fs::remove(taken);
        expect_nothing_left("pieces are left where one could not be named");
    });
    return failed;
}

/// Pieces behind 2^28 vertices and triangles that nobody has: a file of 13 GB with holes, in which
/// each rank finds its points and triangles where the header says.
int write_far(const Scene& scene, MpiRanks& ranks, const fs::path& folder) {
    constexpr std::uint64_t before = std::uint64_t{1} << 28U;
    const fs::path path = folder / "far.vtp";
    int failed = 0;
    scene.with_piece(scene.isovalues()[0], [&](const auto& piece, const JoinedPiece& joined) {
        JoinedPiece far = joined;
        for (std::uint64_t* number :
             {&far.first_vertex, &far.vertices, &far.first_simplex, &far.simplices}) {
            *number += before;
        }
        for (std::uint64_t& number : far.number) number += before;
        write_vtp(ranks, piece, far, path);
        std::ifstream in(path, std::ios::binary);
        std::string header(5000, ' ');
        in.read(header.data(), static_cast<std::streamsize>(header.size()));
        const auto read = [&](const char* name, std::uint64_t at, auto& numbers) {
            const std::string key = "offset=\"";
            const std::string mark = "<AppendedData encoding=\"raw\">\n_";
            const std::size_t tag = header.find(key, header.find("Name=\"" + std::string(name)));
            const std::uint64_t begin =
                header.find(mark) + mark.size() + 8 + std::stoull(header.substr(tag + key.size()));
            in.seekg(static_cast<std::streamoff>(begin + at));
            in.read(reinterpret_cast<char*>(numbers.data()),
                    static_cast<std::streamsize>(numbers.size() * sizeof numbers[0]));
        };
        std::vector<Point> own;
        for (std::size_t v = 0; v < far.owner.size(); ++v) {
            if (far.owner[v] == ranks.rank()) own.push_back(piece.surface.vertices[v]);
        }
        std::vector<std::int64_t> corners;
        for (const auto& simplex : piece.surface.simplices) {
            for (const std::uint32_t v : simplex) {
                corners.push_back(static_cast<std::int64_t>(far.number[v]));
            }
        }
        std::vector<Point> points(own.size());
        std::vector<std::int64_t> connectivity(corners.size());
        read("Points", 24 * far.first_vertex, points);
        read("connectivity", 24 * far.first_simplex, connectivity);
        failed += wrong(!in, "the file ends too early");
        failed += wrong(points != own, "points are not where the header says");
        failed += wrong(connectivity != corners, "triangles are not where the header says");
        failed += wrong(fs::file_size(path) < std::uint64_t{13} << 30U, "the file is small");
    });
    return failed;
}

int run(const fs::path& folder) {
    MpiRanks ranks(MPI_COMM_WORLD);
    if (ranks.rank() == 0) {
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    ranks.gather({});
    const Scene scene(ranks);
    int failed = 0;
    for (const double isovalue : scene.isovalues()) {
        failed += compare_whole(scene, ranks, isovalue, folder);
        failed += compare_pieces(scene, ranks, isovalue, folder);
        ranks.gather({});
        if (ranks.rank() == 0) {
            for (const auto& entry : fs::directory_iterator(folder)) fs::remove(entry.path());
        }
        ranks.gather({});
    }
    failed += write_far(scene, ranks, folder);
    ranks.gather({});
    if (ranks.rank() == 0) fs::remove(folder / "far.vtp");
    ranks.gather({});
    failed += end_together(scene, ranks, folder);
    ranks.gather({});
    if (ranks.rank() == 0) fs::remove_all(folder);
    auto all = static_cast<std::uint64_t>(failed);
    ranks.reduce(std::span(&all, 1), Ranks::Reduction::sum);
    return all == 0 ? 0 : 1;
}

}  // namespace

/// How many of these do not refuse with such a sentence.
template <class Ask>
int expect_refused(const std::string& sentence, const Ask& ask) {
    try {
        ask();
    } catch (const InvalidInput& e) {
        if (e.what() == sentence) return 0;
    }
    std::printf("'%s' is not said\n", sentence.c_str());
    return 1;
}

int main(int argc, char** argv) {
    int failed = expect_refused("MPI was not initialised: call MPI_Init first",
                                [] { MpiRanks(MPI_COMM_WORLD).rank(); });
    MPI_Init(&argc, &argv);
    std::optional<MpiRanks> outlives(MPI_COMM_WORLD);
    failed += run(argc > 1 ? argv[1] : "mpi_files_test.folder");
    MPI_Finalize();
    constexpr const char* over = "MPI has been finalised";
    failed += expect_refused(over, [&] { outlives->gather({}); });
    failed += expect_refused(over, [&] { outlives->exchange({}); });
    failed += expect_refused(over, [] { MpiRanks(MPI_COMM_WORLD).rank(); });
    outlives.reset();
    return failed;
}
