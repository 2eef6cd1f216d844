// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/collapse_rounds.hpp>

#include <algorithm>

#include <collapses/block_collapse.hpp>
#include <collapses/support.hpp>
#include <surfaces/triangle_sides.hpp>

namespace nestgrid::engine {

namespace {

constexpr std::size_t most_vertices = std::size_t{1} << 14U;  // of a block
constexpr std::size_t most_rounds = 12;
constexpr double worth_a_round = 0.01;                  // part of the triangles that goes in one
constexpr std::array<double, 3> cuts{0.5, 0.37, 0.63};  // of blocks, by round

/// The edges that belong to one triangle only.
std::vector<OrientedSide> open_sides(std::span<const BlockMesh::Corners> triangles) {
    std::vector<OrientedSide> open;
    for_each_edge(sorted_sides(triangles), [&](std::span<const OrientedSide> edge) {
        if (edge.size() == 1) open.push_back(edge[0]);
    });
    return open;
}

/// One block while it is worked on, with the numbers that its parts have in the whole surface.
class BlockTask {
public:
    BlockTask(std::span<const CollapsingVertex> vertices,
              std::span<const BlockMesh::Corners> triangles, std::span<std::vector<NearPart>> parts,
              std::span<const std::uint32_t> own, std::span<const std::uint32_t> obstacles,
              const std::vector<std::uint8_t>& stays)
        : triangle_(own.begin(), own.end()) {
        for (const auto& list : {own, obstacles}) {
            for (const std::uint32_t t : list) {
                for (const std::uint32_t v : triangles[t]) vertex_.push_back(v);
            }
        }
        std::sort(vertex_.begin(), vertex_.end());
        vertex_.erase(std::unique(vertex_.begin(), vertex_.end()), vertex_.end());
        for (const std::uint32_t v : vertex_) {
            mesh_.vertices.push_back(vertices[v]);
            mesh_.vertices.back().moves &= stays[v] == 0;
        }
        for (const auto& list : {own, obstacles}) {
            for (const std::uint32_t t : list) {
                BlockMesh::Corners local = triangles[t];
                for (std::uint32_t& v : local) v = local_number(v);
                mesh_.triangles.push_back(local);
            }
        }
        mesh_.own = own.size();
        if (!parts.empty()) {
            for (const std::uint32_t t : own) mesh_.parts.push_back(std::move(parts[t]));
        }
        mesh_.connect();
    }

    void run(const CollapseRules& rules, const Box& region) {
        BlockCollapse work(mesh_, rules, region);
        work.run();
        counts_ = work.counts();
    }
    /// Writes what has changed, which no other block reads.
    void put_back(std::span<CollapsingVertex> vertices, std::span<BlockMesh::Corners> triangles,
                  std::span<std::vector<NearPart>> parts) {
        for (std::size_t v = 0; v < vertex_.size(); ++v) {
            if (mesh_.vertices[v].moves) vertices[vertex_[v]] = mesh_.vertices[v];
        }
        for (std::size_t t = 0; t < triangle_.size(); ++t) {
            BlockMesh::Corners corners = mesh_.triangles[t];
            if (corners[0] != BlockMesh::gone) {
                for (std::uint32_t& v : corners) v = vertex_[v];
            }
            triangles[triangle_[t]] = corners;
            if (!parts.empty()) parts[triangle_[t]] = std::move(mesh_.parts[t]);
        }
    }
    const Collapsed& counts() const { return counts_; }

private:
    std::uint32_t local_number(std::uint32_t v) const {
        return static_cast<std::uint32_t>(std::lower_bound(vertex_.begin(), vertex_.end(), v) -
                                          vertex_.begin());
    }

    std::vector<std::uint32_t> vertex_;    // in the whole surface, ascending
    std::vector<std::uint32_t> triangle_;  // of the block's own ones
    BlockMesh mesh_;
    Collapsed counts_;
};

void add_counts(Collapsed& sum, const Collapsed& part) {
    for (const auto count :
         {&Collapsed::collapses, &Collapsed::refused_by_manifold, &Collapsed::refused_by_shape,
          &Collapsed::refused_by_field, &Collapsed::refused_by_sides,
          &Collapsed::refused_by_distance, &Collapsed::refused_by_crossing}) {
        sum.*count += part.*count;
    }
}

}  // namespace

CollapseRounds::CollapseRounds(Surface<3>& surface, const CollapseRules& rules,
                               const Executor& executor)
    : surface_{&surface},
      rules_{&rules},
      executor_{&executor},
      vertices_(surface.vertices.size()),
      triangles_(surface.simplices) {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        vertices_[v].x = surface.vertices[v] - rules.middle;
        vertices_[v].drawn = static_cast<std::uint32_t>(v);
    }
    for (const auto& edge : surface.boundary) {
        for (const std::uint32_t v : edge) vertices_[v].at_boundary = true;
    }
    for (const OrientedSide& side : open_sides(triangles_)) {
        vertices_[side.low].on_border = vertices_[side.high].on_border = true;
    }
}

void CollapseRounds::keep_borders(const NearLeaves& leaves, double unit) {
    find_borders(leaves);
    add_quadrics(unit);
}

void CollapseRounds::keep_support() {
    const auto freedom = support_freedom(*surface_);
    for (std::size_t v = 0; v < vertices_.size(); ++v) vertices_[v].freedom = freedom[v];
}

void CollapseRounds::keep_colours(std::span<const double> errors) {
    errors_.assign(errors.begin(), errors.end());
    std::vector<double> values(errors_.size());
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        for (std::size_t c = 0; c < errors_.size(); ++c) {
            values[c] = surface_->attributes[v * errors_.size() + c] / errors_[c];
        }
        vertices_[v].colours = Colours(values);
    }
    add_colours();
}

/// Finds where vertices on the border may move: not at all at cracks inside the domain.
void CollapseRounds::find_borders(const NearLeaves& leaves) {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        CollapsingVertex& vertex = vertices_[v];
        if (!vertex.on_border) continue;
        if (vertex.at_boundary)
            vertex.freedom = border_freedom(leaves, surface_->vertices[v]);
        else
            vertex.freedom.fasten();
    }
}

/// The quadric of a vertex is that of the planes of its triangles, by area, and of planes at right
/// angles to these through edges of the border.
void CollapseRounds::add_quadrics(double unit) {
    const double weight = 1 / (unit * unit);
    const auto& x = vertices_;
    for (const Corners& c : triangles_) {
        const Point direction = cross(x[c[1]].x - x[c[0]].x, x[c[2]].x - x[c[0]].x);
        const double area = norm(direction);
        if (!(area > 0)) continue;
        const Point normal = (1 / area) * direction;
        Quadric quadric;
        quadric.add_plane(normal, dot(normal, x[c[0]].x), 0.5 * weight * area);
        for (const std::uint32_t v : c) vertices_[v].quadric.add(quadric);
    }
    for (const OrientedSide& side : open_sides(triangles_)) {
        const Corners& c = triangles_[side.triangle];
        const Point along = x[side.high].x - x[side.low].x;
        const Point direction = cross(along, cross(x[c[1]].x - x[c[0]].x, x[c[2]].x - x[c[0]].x));
        const double length = norm(direction);
        if (!(length > 0)) continue;
        const Point normal = (1 / length) * direction;
        Quadric quadric;
        quadric.add_plane(normal, dot(normal, x[side.low].x), weight * dot(along, along));
        for (const std::uint32_t v : c) vertices_[v].quadric.add(quadric);
    }
}

void CollapseRounds::add_colours() {
    const auto& x = vertices_;
    std::vector<ColourValues> values;
    for (const CollapsingVertex& vertex : x) values.push_back(vertex.colours.values());
    const auto of = [&](std::uint32_t v) { return std::span(values[v].data(), values[v].size()); };
    for (const Corners& c : triangles_) {
        const Triangle corners{x[c[0]].x, x[c[1]].x, x[c[2]].x};
        const double area = 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
        if (!(area > 0)) continue;
        for (const std::uint32_t v : c) {
            vertices_[v].colours.add_triangle(corners, area, {of(c[0]), of(c[1]), of(c[2])});
        }
    }
}

std::vector<Point> CollapseRounds::positions() const {
    std::vector<Point> x;
    x.reserve(vertices_.size());
    for (const CollapsingVertex& vertex : vertices_) x.push_back(vertex.x);
    return x;
}

Collapsed CollapseRounds::run() {
    Collapsed counts;
    for (std::size_t round = 0; round < most_rounds; ++round) {
        const std::size_t before = triangles_.size();
        const Blocks blocks(positions(), most_vertices, cuts[round % cuts.size()]);
        run_round(blocks, counts);
        erase_gone();
        const auto part = static_cast<double>(before - triangles_.size());
        if (part <= worth_a_round * static_cast<double>(before)) break;
    }
    return counts;
}

void CollapseRounds::run_round(const Blocks& blocks, Collapsed& counts) {
    std::vector<std::vector<std::uint32_t>> own(blocks.count());
    std::vector<std::vector<std::uint32_t>> obstacles(blocks.count());
    std::vector<std::uint8_t> stays(vertices_.size(), 0);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const auto& [a, b, c] = triangles_[t];
        const std::uint32_t block = blocks.block_of(a);
        if (blocks.block_of(b) == block && blocks.block_of(c) == block) {
            own[block].push_back(t);
            continue;
        }
        for (const std::uint32_t v : {a, b, c}) stays[v] = 1;
        const Triangle x{vertices_[a].x, vertices_[b].x, vertices_[c].x};
        blocks.for_each_meeting(Box::around(x),
                                [&](std::uint32_t met) { obstacles[met].push_back(t); });
    }
    std::vector<std::unique_ptr<BlockTask>> tasks(blocks.count());
    executor_->run(
        blocks.count(),
        [&](std::size_t i) {
            tasks[i] = std::make_unique<BlockTask>(vertices_, triangles_, parts_, own[i],
                                                   obstacles[i], stays);
            tasks[i]->run(*rules_, blocks.region(i));
        },
        [&](std::size_t i) {
            tasks[i]->put_back(vertices_, triangles_, parts_);
            add_counts(counts, tasks[i]->counts());
            tasks[i].reset();
        });
}

/// Leaves out triangles and vertices that are gone, and keeps the order of the others.
void CollapseRounds::erase_gone() {
    std::size_t left = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        if (triangles_[t][0] == BlockMesh::gone) continue;
        if (!parts_.empty()) parts_[left].swap(parts_[t]);
        triangles_[left++] = triangles_[t];
    }
    triangles_.resize(left);
    if (!parts_.empty()) parts_.resize(left);
    std::vector<std::uint32_t> number(vertices_.size(), 0);
    for (const Corners& c : triangles_) {
        for (const std::uint32_t v : c) number[v] = 1;
    }
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        if (number[v] == 0) continue;
        number[v] = count;
        vertices_[count++] = vertices_[v];
    }
    vertices_.resize(count);
    for (Corners& c : triangles_) {
        for (std::uint32_t& v : c) v = number[v];
    }
}

void CollapseRounds::put_attributes() {
    if (errors_.empty()) return;
    std::vector<double>& attributes = surface_->attributes;
    attributes.clear();
    for (const CollapsingVertex& vertex : vertices_) {
        for (std::size_t c = 0; c < errors_.size(); ++c) {
            attributes.push_back(errors_[c] * vertex.colours.values()[c]);
        }
    }
}

void CollapseRounds::finish() {
    erase_gone();
    Surface<3>& s = *surface_;
    put_attributes();
    std::vector<Point> x = positions();
    for (std::size_t v = 0; v < x.size(); ++v) {
        const std::uint32_t drawn = vertices_[v].drawn;
        x[v] = drawn == CollapsingVertex::moved ? x[v] + rules_->middle : s.vertices[drawn];
    }
    s.vertices = std::move(x);
    s.simplices = triangles_;
    s.boundary.clear();
    for (const OrientedSide& side : open_sides(triangles_)) {
        const bool at_boundary =
            vertices_[side.low].at_boundary && vertices_[side.high].at_boundary;
        if (at_boundary) s.boundary.push_back({side.low, side.high});
    }
}

}  // namespace nestgrid::engine
