// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes meshes to the folder given: a torus of radii 3 and 1 as t.off, .obj, .ply and .stl; the
// unit cube as tetrahedra c.node and c.ele, and as a complex to be filled, p.poly and s.smesh.
// Second argument: the fineness, 1 for small files, 36 for files of 10 MB and more.
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace {

using Point = std::array<double, 3>;
using Face = std::array<int, 3>;

struct Surface {
    std::vector<Point> points;
    std::vector<Face> faces;
};

Surface torus(int around, int across) {
    Surface surface;
    const auto at = [&](int i, int k) { return i % around * across + k % across; };
    for (int i = 0; i < around; ++i) {
        for (int k = 0; k < across; ++k) {
            const double u = 2 * std::numbers::pi * i / around;
            const double v = 2 * std::numbers::pi * k / across;
            const double r = 3 + std::cos(v);
            surface.points.push_back({r * std::cos(u), r * std::sin(u), std::sin(v)});
            surface.faces.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            surface.faces.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return surface;
}

void write_points(std::ofstream& file, const std::string& before,
                  const std::vector<Point>& points) {
    for (const Point& p : points) file << before << p[0] << " " << p[1] << " " << p[2] << "\n";
}

void write_faces(std::ofstream& file, const std::string& before, const std::vector<Face>& faces,
                 int first) {
    for (const Face& f : faces) {
        file << before << f[0] + first << " " << f[1] + first << " " << f[2] + first << "\n";
    }
}

void write_stl(std::ofstream file, const Surface& surface) {
    const std::array<char, 80> header{};
    file.write(header.data(), header.size());
    const auto count = static_cast<std::uint32_t>(surface.faces.size());
    file.write(reinterpret_cast<const char*>(&count), sizeof(count));
    for (const Face& f : surface.faces) {
        std::array<float, 12> numbers{};
        for (std::size_t i = 0; i < 9; ++i) {
            const Point& p = surface.points[static_cast<std::size_t>(f[i / 3])];
            numbers[3 + i] = static_cast<float>(p[i % 3]);
        }
        file.write(reinterpret_cast<const char*>(numbers.data()), sizeof(numbers));
        file.write("\0", 2);
    }
}

void write_surface(const std::string& name, const Surface& surface) {
    const std::string counts =
        std::to_string(surface.points.size()) + " " + std::to_string(surface.faces.size());
    std::ofstream off(name + ".off");
    off << "OFF\n" << counts << " 0\n";
    write_points(off, "", surface.points);
    write_faces(off, "3 ", surface.faces, 0);
    std::ofstream obj(name + ".obj");
    write_points(obj, "v ", surface.points);
    write_faces(obj, "f ", surface.faces, 1);
    std::ofstream ply(name + ".ply");
    ply << "ply\nformat ascii 1.0\nelement vertex " << surface.points.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
        << surface.faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    write_points(ply, "", surface.points);
    write_faces(ply, "3 ", surface.faces, 0);
    write_stl(std::ofstream(name + ".stl", std::ios::binary), surface);
}

/// Tetrahedra between the diagonals of n x n x n cubes.
void write_tetrahedra(const std::string& name, int n) {
    std::ofstream node(name + ".node");
    std::ofstream ele(name + ".ele");
    node << (n + 1) * (n + 1) * (n + 1) << " 3 0 0\n";
    ele << 6 * n * n * n << " 4 0\n";
    const auto at = [&](std::array<int, 3> p) { return p[0] + (n + 1) * (p[1] + (n + 1) * p[2]); };
    constexpr std::array<std::array<std::size_t, 3>, 6> orders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};  // three are odd
    int count = 0;
    for (int i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i) {
        const std::array<int, 3> p{i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1)};
        node << i << " " << double(p[0]) / n << " " << double(p[1]) / n << " " << double(p[2]) / n
             << "\n";
        if (p[0] == n || p[1] == n || p[2] == n) continue;
        for (std::size_t k = 0; k < orders.size(); ++k) {
            std::array<int, 4> corners{at(p)};
            std::array<int, 3> corner = p;
            for (std::size_t step = 0; step < 3; ++step) {
                ++corner[orders[k][step]];
                corners[step + 1] = at(corner);
            }
            if (k >= 3) std::swap(corners[0], corners[1]);
            ele << count++;
            for (const int c : corners) ele << " " << c;
            ele << "\n";
        }
    }
}

/// The six faces of the unit cube, each of 2 x n x n triangles: they stay plane when points move.
void write_complex(const std::string& folder, int n) {
    std::map<std::array<int, 3>, int> number;
    std::vector<std::array<int, 3>> places;
    std::vector<Face> triangles;
    const auto node = [&](std::array<int, 3> p) {
        const auto [at, is_new] = number.try_emplace(p, static_cast<int>(places.size()) + 1);
        if (is_new) places.push_back(p);
        return at->second;
    };
    for (std::size_t side = 0; side < 6; ++side) {
        for (int i = 0; i < n * n; ++i) {
            std::array<int, 4> square{};
            for (std::size_t k = 0; k < 4; ++k) {
                std::array<int, 3> p{};
                p[side % 3] = side < 3 ? 0 : n;
                p[(side + 1) % 3] = i % n + (k == 1 || k == 2 ? 1 : 0);
                p[(side + 2) % 3] = i / n + (k > 1 ? 1 : 0);
                square[k] = node(p);
            }
            triangles.push_back({square[0], square[1], square[2]});
            triangles.push_back({square[0], square[2], square[3]});
        }
    }
    for (const bool simple : {false, true}) {
        std::ofstream file(folder + (simple ? "s.smesh" : "p.poly"));
        file << places.size() << " 3 0 0\n";
        for (std::size_t i = 0; i < places.size(); ++i) {
            file << i + 1;
            for (const int x : places[i]) file << " " << double(x) / n;
            file << "\n";
        }
        file << triangles.size() << " 0\n";
        write_faces(file, simple ? "3 " : "1\n3 ", triangles, 0);
        file << "0\n0\n";
    }
}

}  // namespace

int main(int, char** argv) {
    const std::string folder = std::string(argv[1]) + "/";
    const int fineness = std::stoi(argv[2]);
    write_surface(folder + "t", torus(12 * fineness, 10 * fineness));
    write_tetrahedra(folder + "c", fineness > 1 ? fineness + 4 : 2);
    write_complex(folder, fineness > 1 ? fineness : 2);
    return 0;
}
