// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/kuhn_lattice.hpp>

#include <algorithm>
#include <cmath>

#include <boost/container/small_vector.hpp>

namespace nestgrid::engine {

namespace {

constexpr double lattice_rounding = 1e-9;  // of lattice coordinates
constexpr std::uint32_t no_brick = ~std::uint32_t{0};
constexpr int families = 9;

double family_at(int family, const Point& x) {
    switch (family) {
        case 0:
            return x[0];
        case 1:
            return x[1];
        case 2:
            return x[2];
        case 3:
            return 0.5 * (x[0] - x[1]);
        case 4:
            return 0.5 * (x[0] + x[1]);
        case 5:
            return 0.5 * (x[1] - x[2]);
        case 6:
            return 0.5 * (x[1] + x[2]);
        case 7:
            return 0.5 * (x[0] - x[2]);
        default:
            return 0.5 * (x[0] + x[2]);
    }
}

/// The edges of the lattice lie where a plane of the first family meets one of the others.
struct EdgeFamily {
    int first;
    std::array<int, 3> second;
    std::size_t count;
};
constexpr std::array<EdgeFamily, 5> edge_families{
    {{0, {1, 5, 6}, 3}, {1, {2, 7, 8}, 3}, {2, {0, 3, 4}, 3}, {3, {5, 6}, 2}, {4, {5, 6}, 2}}};

bool odd(int i) { return (i & 1) != 0; }

}  // namespace

auto KuhnLattice::index_of(const Point& x) const -> Index {
    Index at{};
    for (std::size_t d = 0; d < 3; ++d) {
        at[d] = static_cast<int>(std::lround((x[d] - low_[d]) / spacing_[d]));
    }
    return at;
}

/// Whether a leaf is one of the tetrahedra: its corners are lattice points on a way along the axes,
/// one step each, from one with only even to one with only odd coordinates.
bool KuhnLattice::takes(const NearLeaves& leaves, const NearLeaf& leaf) const {
    if (leaf.shape != Shape::tetrahedron) return false;
    std::array<Index, 4> corner;
    const auto nodes = leaves.nodes(leaf);
    for (std::size_t k = 0; k < 4; ++k) {
        const Point& x = leaves.position(nodes[k]);
        corner[k] = index_of(x);
        for (std::size_t d = 0; d < 3; ++d) {
            const double off = low_[d] + corner[k][d] * spacing_[d] - x[d];
            if (std::abs(off) > lattice_rounding * spacing_[d]) return false;
        }
    }
    // The number of odd coordinates of the corners of such a way: 0, 1, 2, 3, each once.
    std::array<int, 4> with_odd{-1, -1, -1, -1};
    for (int k = 0; k < 4; ++k) {
        std::size_t count = 0;
        for (std::size_t d = 0; d < 3; ++d) {
            count += odd(corner[static_cast<std::size_t>(k)][d] + shift_[d]) ? 1U : 0U;
        }
        with_odd[count] = k;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (with_odd[i] < 0 || with_odd[i + 1] < 0) return false;
        const Index& a = corner[static_cast<std::size_t>(with_odd[i])];
        const Index& b = corner[static_cast<std::size_t>(with_odd[i + 1])];
        if (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) != 1)
            return false;
    }
    const Topology& t = topology(leaf.shape);
    for (std::size_t f = 0; f < t.faces; ++f) {
        if ((leaf.boundary >> f & 1U) == 0) continue;
        bool on_box = false;
        for (std::size_t d = 0; d < 3; ++d) {
            for (const int side : {0, last_[d]}) {
                const auto& of_face = t.face[f].corner;
                on_box = on_box || (corner[of_face[0]][d] == side &&
                                    corner[of_face[1]][d] == side && corner[of_face[2]][d] == side);
            }
        }
        if (!on_box) return false;
    }
    return true;
}

std::optional<KuhnLattice> KuhnLattice::find(const NearLeaves& leaves) {
    if (leaves.leaves().empty() || leaves.may_hide()) return std::nullopt;
    KuhnLattice lattice(leaves.error());
    Box box;
    for (std::uint32_t n = 0; n < leaves.node_count(); ++n) box.add(leaves.position(n));
    const NearLeaf& first = leaves.leaves().front();
    std::array<Point, max_corners> room;
    const auto corners = leaves.corners(first, room);
    const Box cell = Box::around(corners);
    lattice.low_ = box.low;
    lattice.spacing_ = cell.high - cell.low;
    for (std::size_t d = 0; d < 3; ++d) {
        const double cells = (box.high[d] - box.low[d]) / lattice.spacing_[d];
        if (!(cells >= 1 && cells < 1 << 20)) return std::nullopt;
        lattice.last_[d] = static_cast<int>(std::lround(cells));
    }
    // The first corner that differs from another one in all coordinates gets even ones.
    for (const Point& a : corners) {
        for (const Point& b : corners) {
            const Index i = lattice.index_of(a);
            const Index j = lattice.index_of(b);
            if (i[0] == j[0] || i[1] == j[1] || i[2] == j[2]) continue;
            for (std::size_t d = 0; d < 3; ++d) lattice.shift_[d] = odd(i[d]) ? 1 : 0;
        }
    }
    for (const NearLeaf& leaf : leaves.leaves()) {
        if (!lattice.takes(leaves, leaf)) return std::nullopt;
    }
    lattice.keep_values(leaves);
    return lattice;
}

void KuhnLattice::keep_values(const NearLeaves& leaves) {
    std::size_t count = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        bricks_[d] = (last_[d] + shift_[d]) / 8 + 1;
        count *= static_cast<std::size_t>(bricks_[d]);
    }
    brick_.assign(count, no_brick);
    for (std::uint32_t n = 0; n < leaves.node_count(); ++n) {
        Index at = index_of(leaves.position(n));
        for (std::size_t d = 0; d < 3; ++d) at[d] += shift_[d];
        const int number = ((at[2] / 8) * bricks_[1] + at[1] / 8) * bricks_[0] + at[0] / 8;
        std::uint32_t& brick = brick_[static_cast<std::size_t>(number)];
        if (brick == no_brick) {
            brick = static_cast<std::uint32_t>(values_.size() / 512);
            values_.resize(values_.size() + 512, Box::infinity);
        }
        const int in_brick = ((at[2] & 7) * 8 + (at[1] & 7)) * 8 + (at[0] & 7);
        values_[brick * std::size_t{512} + static_cast<std::size_t>(in_brick)] = leaves.value(n);
    }
}

/// Lattice coordinates, shifted.
Point KuhnLattice::coordinates(const Point& x) const {
    Point at{};
    for (std::size_t d = 0; d < 3; ++d) at[d] = (x[d] - low_[d]) / spacing_[d] + shift_[d];
    return at;
}

/// U - C at a lattice point, infinite where it is not known.
NESTGRID_INLINE double KuhnLattice::value(const Index& at) const {
    const int number = ((at[2] >> 3) * bricks_[1] + (at[1] >> 3)) * bricks_[0] + (at[0] >> 3);
    const std::uint32_t brick = brick_[static_cast<std::size_t>(number)];
    if (brick == no_brick) return Box::infinity;
    const int in_brick = ((at[2] & 7) * 8 + (at[1] & 7)) * 8 + (at[0] & 7);
    return values_[brick * std::size_t{512} + static_cast<std::size_t>(in_brick)];
}

/// Whether |U - C| <= e at a point.
bool KuhnLattice::keeps_at(const Point& x, double& greatest) const {
    Index at{};
    std::array<std::pair<double, std::size_t>, 3> step;
    Index along{};
    for (std::size_t d = 0; d < 3; ++d) {
        const int cell = std::clamp(static_cast<int>(x[d]), shift_[d], last_[d] + shift_[d] - 1);
        const double part = std::clamp(x[d] - cell, 0.0, 1.0);
        const bool down = odd(cell);
        at[d] = down ? cell + 1 : cell;
        along[d] = down ? -1 : 1;
        step[d] = {down ? 1 - part : part, d};
    }
    if (step[0].first < step[1].first) std::swap(step[0], step[1]);
    if (step[1].first < step[2].first) std::swap(step[1], step[2]);
    if (step[0].first < step[1].first) std::swap(step[0], step[1]);
    double sum = 0;
    double rest = 1;
    // A corner without weight may be unknown.
    for (const auto& [part, axis] : step) {
        if (rest > part) sum += (rest - part) * value(at);
        at[axis] += along[axis];
        rest = part;
    }
    if (rest > 0) sum += rest * value(at);
    const double off = std::abs(sum);
    if (!(off <= error_)) return false;
    greatest = std::max(greatest, off);
    return true;
}

/// Whether |U - C| <= e where a segment meets planes of a family.
bool KuhnLattice::keeps_along(int family, const Point& a, const Point& b, double& greatest) const {
    const double at_a = family_at(family, a);
    const double at_b = family_at(family, b);
    const double high = std::max(at_a, at_b);
    for (int i = static_cast<int>(std::floor(std::min(at_a, at_b))) + 1; i < high; ++i) {
        const double t = (i - at_a) / (at_b - at_a);
        if (!keeps_at(a + t * (b - a), greatest)) return false;
    }
    return true;
}

/// Whether |U - C| <= e where the inside of a triangle meets edges of the lattice.
bool KuhnLattice::keeps_inside(const Triangle& x, double& greatest) const {
    for (const EdgeFamily& edges : edge_families) {
        std::array<double, 3> g{};
        for (std::size_t i = 0; i < 3; ++i) g[i] = family_at(edges.first, x[i]);
        const double high = std::max({g[0], g[1], g[2]});
        const double low = std::min({g[0], g[1], g[2]});
        for (int i = static_cast<int>(std::floor(low)) + 1; i < high; ++i) {
            std::array<Point, 2> end;
            std::size_t count = 0;
            for (std::size_t j = 0; j < 3 && count < 2; ++j) {
                const std::size_t k = (j + 1) % 3;
                if ((g[j] < i) == (g[k] < i)) continue;
                const double t = (i - g[j]) / (g[k] - g[j]);
                end[count++] = x[j] + t * (x[k] - x[j]);
            }
            if (count < 2) continue;
            for (std::size_t j = 0; j < edges.count; ++j) {
                if (!keeps_along(edges.second[j], end[0], end[1], greatest)) return false;
            }
        }
    }
    return true;
}

/// Whether lattice coordinates lie in the box around all leaves.
bool KuhnLattice::contains(const Point& at) const {
    for (std::size_t d = 0; d < 3; ++d) {
        const double from = at[d] - shift_[d];
        if (!(from >= -lattice_rounding && from <= last_[d] + lattice_rounding)) return false;
    }
    return true;
}

/// Whether |U - C| <= e where a segment meets any planes.
bool KuhnLattice::keeps_side(const Point& a, const Point& b, double& greatest) const {
    for (int family = 0; family < families; ++family) {
        if (!keeps_along(family, a, b, greatest)) return false;
    }
    return true;
}

bool KuhnLattice::keeps(const Triangle& x, double& greatest) const {
    Triangle at;
    double most = greatest;
    for (std::size_t i = 0; i < 3; ++i) {
        at[i] = coordinates(x[i]);
        if (!contains(at[i]) || !keeps_at(at[i], most)) return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (!keeps_side(at[i], at[(i + 1) % 3], most)) return false;
    }
    if (!keeps_inside(at, most)) return false;
    greatest = most;
    return true;
}

bool KuhnLattice::keeps_fan(const Fan& fan) const {
    double most = 0;
    const Point w = coordinates(fan.w);
    if (!contains(w) || !keeps_at(w, most)) return false;
    boost::container::small_vector<Point, 24> ring;
    for (const Point& x : fan.ring) {
        ring.push_back(coordinates(x));
        if (!keeps_side(w, ring.back(), most)) return false;
    }
    return std::all_of(fan.side.begin(), fan.side.end(), [&](const auto& side) {
        return keeps_inside({w, ring[side[0]], ring[side[1]]}, most);
    });
}

}  // namespace nestgrid::engine
