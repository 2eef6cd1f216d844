// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The steps of the extraction; included by isosurface.hpp.
#pragma once

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid::detail {

template <class Grid, class Field, class S, class Indicator>
bool IsosurfaceVisitor<Grid, Field, S, Indicator>::of_interest(const State& s, double bound) const {
    double lo = std::numeric_limits<double>::infinity();
    double hi = -lo;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.corner_count()); ++i) {
        const double v = s.value[i * State::components];
        lo = std::min(lo, v);
        hi = std::max(hi, v);
    }
    // Rounding is monotone: a difference within the bound is never rounded beyond it.
    const bool reaches_up = hi >= iso_ || (bound > 0 && iso_ - hi <= bound);
    const bool reaches_down = lo < iso_ || (bound > 0 && lo - iso_ <= bound);
    if (!reaches_up) return false;
    if (reaches_down) return true;
    return options_->cap && walk_->boundary(s) != 0;
}

template <class Grid, class Field, class S, class Indicator>
Decision IsosurfaceVisitor<Grid, Field, S, Indicator>::inspect(const State& s, const Split& split) {
    TraversalCounts& counts = result_.counts;
    ++counts.calls;
    if ((counts.calls & 0xFFFFU) == 0 && options_->progress && !options_->progress(counts)) {
        throw Cancelled{};
    }
    element_bound_ = split.rule == nullptr ? 0.0 : indicator_->bound(split.keys);
    if (!of_interest(s, element_bound_)) return {Visit::skip, 0};
    ++counts.visited;
    if (split.rule == nullptr) return {Visit::stop, 0};
    const NodeMask interpolated =
        (*criterion_)(NewNodes{*split.rule, split.keys, s.level + 1, split.outside});
    return {interpolated == split.rule->all() ? Visit::stop : Visit::descend, interpolated};
}

template <class Grid, class Field, class S, class Indicator>
void IsosurfaceVisitor<Grid, Field, S, Indicator>::load(const State& s) {
    walk_->keys(s, key_);
    walk_->positions(s, x_);
    deepest_ = std::max(deepest_, s.level);
    double error = element_bound_;
    double corner = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.corner_count()); ++i) {
        if ((s.interpolated >> i & 1U) != 0) corner = std::max(corner, indicator_->stop(key_[i]));
    }
    error += corner;
    result_.error_bound = std::max(result_.error_bound, error);
}

template <class Grid, class Field, class S, class Indicator>
void IsosurfaceVisitor<Grid, Field, S, Indicator>::extract(const State& s) {
    if (!is_simplex(s.shape)) {
        throw GridError(
            "isosurfaces are extracted from triangles and tetrahedra, but an element "
            "on level " +
            std::to_string(s.level) + " below coarse element " + std::to_string(s.coarse) +
            " is a " + std::string(topology(s.shape).name));
    }
    const auto corners = static_cast<std::size_t>(s.corner_count());
    unsigned pattern = 0;
    for (std::size_t i = 0; i < corners; ++i) pattern |= unsigned{inside(s, i)} << i;
    const Contour& contour = contour_table(s.shape)[pattern];
    const unsigned boundary = options_->cap ? walk_->boundary(s) : 0U;
    if (contour.count == 0 && (pattern == 0 || boundary == 0)) return;
    load(s);
    if (options_->normals) load_gradients(s);
    const std::size_t before = result_.surface.simplices.size();
    if (contour.count > 0) add_contour(s, contour);
    if (boundary != 0) add_cap(s);
    if (result_.surface.simplices.size() == before) return;
    ++result_.counts.extracted;
    if (options_->elements) {
        result_.surface.elements.push_back(s.element);
        result_.surface.level_of.push_back(static_cast<std::uint16_t>(s.level));
    }
}

template <class Grid, class Field, class S, class Indicator>
void IsosurfaceVisitor<Grid, Field, S, Indicator>::add_simplex(
    typename Surface<dimension, ElementOf<Grid>>::Simplex simplex, const State& s) {
    if (s.orientation < 0) std::swap(simplex[0], simplex[1]);
    result_.surface.simplices.push_back(simplex);
    if (options_->elements) {
        result_.surface.element_of.push_back(static_cast<Index>(result_.surface.elements.size()));
    }
}

template <class Grid, class Field, class S, class Indicator>
void IsosurfaceVisitor<Grid, Field, S, Indicator>::add_contour(const State& s,
                                                               const Contour& contour) {
    const Topology& t = topology(s.shape);
    std::array<Index, 4> v{};
    for (std::size_t i = 0; i < contour.count; ++i) {
        const auto& edge = t.edge[contour.edge[i]];
        v[i] = edge_vertex(s, edge[0], edge[1]);
    }
    Surface<dimension, ElementOf<Grid>>& surface = result_.surface;
    const unsigned boundary = walk_->boundary(s);
    if constexpr (dimension == 2) {
        add_simplex({v[0], v[1]}, s);
        for (std::size_t i = 0; i < 2; ++i) {
            if ((boundary >> contour.face[i] & 1U) != 0) surface.boundary.push_back({v[i]});
        }
    } else {
        if (contour.count == 3) {
            add_simplex({v[0], v[1], v[2]}, s);
        } else {
            // The shorter diagonal; both lie inside the element, so neighbours do not care.
            const Point d02 = surface.vertices[v[2]] - surface.vertices[v[0]];
            const Point d13 = surface.vertices[v[3]] - surface.vertices[v[1]];
            const std::size_t a = dot(d02, d02) <= dot(d13, d13) ? 0 : 1;
            add_simplex({v[a], v[a + 1], v[a + 2]}, s);
            add_simplex({v[a + 2], v[(a + 3) % 4], v[a]}, s);
        }
        for (std::size_t i = 0; i < contour.count; ++i) {
            if ((boundary >> contour.face[i] & 1U) != 0) {
                surface.boundary.push_back({v[i], v[(i + 1) % contour.count]});
            }
        }
    }
}

/// The part of each boundary face where U >= C: in three dimensions a polygon, in two a segment.
template <class Grid, class Field, class S, class Indicator>
void IsosurfaceVisitor<Grid, Field, S, Indicator>::add_cap(const State& s) {
    const Topology& t = topology(s.shape);
    const unsigned boundary = walk_->boundary(s);
    for (std::size_t f = 0; f < t.faces; ++f) {
        if ((boundary >> f & 1U) == 0) continue;
        const FaceTopology& face = t.face[f];
        std::array<Index, 4> polygon{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < face.corners; ++i) {
            const std::size_t a = face.corner[i];
            const std::size_t b = face.corner[(i + 1) % face.corners];
            if (inside(s, a)) polygon[count++] = node_vertex(a);
            if (face.corners == 2 && i == 1) break;  // a segment has one edge, not two
            if (inside(s, a) != inside(s, b)) polygon[count++] = edge_vertex(s, a, b);
        }
        if constexpr (dimension == 2) {
            // Counterclockwise around the element the region is on the left, as on the contour.
            if (count == 2) add_simplex({polygon[0], polygon[1]}, s);
        } else {
            for (std::size_t i = 2; i < count; ++i) {
                add_simplex({polygon[0], polygon[i - 1], polygon[i]}, s);
            }
        }
    }
}

template <class Grid, class Field, class S, class Indicator>
auto IsosurfaceVisitor<Grid, Field, S, Indicator>::add_vertex(KeyPair key, const Point& x,
                                                              const Vertex& where) -> Index {
    std::vector<Point>& vertices = result_.surface.vertices;
    if (vertices.size() > std::numeric_limits<Index>::max() - 1) {
        throw GridError("the surface has more than 2^32 vertices");
    }
    const auto [at, is_new] = vertex_of_.insert(key, static_cast<Index>(vertices.size()));
    if (is_new) {
        vertices.push_back(x);
        if (options_->normals) where_.push_back(where);
    } else if (options_->verify && vertices[*at] != x) {
        throw GridError("two elements put the vertex " + std::to_string(*at) +
                        " at different places");
    }
    return *at;
}

template <class Grid, class Field, class S, class Indicator>
auto IsosurfaceVisitor<Grid, Field, S, Indicator>::node_vertex(std::size_t corner) -> Index {
    return add_vertex({key_[corner], key_[corner]}, x_[corner],
                      {slot_[corner], slot_[corner], 0.0});
}

template <class Grid, class Field, class S, class Indicator>
auto IsosurfaceVisitor<Grid, Field, S, Indicator>::edge_vertex(const State& s, std::size_t a,
                                                               std::size_t b) -> Index {
    const KeyPair key(key_[a], key_[b]);
    if (!options_->verify) {
        if (const Index* known = vertex_of_.find(key)) return *known;
    }
    if (inside(s, a)) std::swap(a, b);  // from the lower to the higher value
    const double lo = s.value[a * State::components];
    const double hi = s.value[b * State::components];
    constexpr double least = 0x1p-20;
    const double t = std::clamp((iso_ - lo) / (hi - lo), least, 1 - least);
    return add_vertex(key, x_[a] + t * (x_[b] - x_[a]), {slot_[a], slot_[b], t});
}

/// Section 8: the gradient as a vector-valued function, projected with the same S.
template <class Grid, class Field, class S, class Indicator>
Point IsosurfaceVisitor<Grid, Field, S, Indicator>::projected_gradient(const State& s,
                                                                       std::size_t corner) const {
    if ((s.interpolated >> corner & 1U) != 0 && s.father != nullptr) {
        const Child& child = s.made_by->children[s.child];
        return node_gradient(*s.father, *s.made_by, child.corner[corner]);
    }
    return own_gradients(s)[corner];
}

template <class Grid, class Field, class S, class Indicator>
auto IsosurfaceVisitor<Grid, Field, S, Indicator>::own_gradients(const State& s) const
    -> std::array<Point, max_corners> {
    std::array<Point, max_corners> g{};
    if constexpr (offers_corner_gradients<Field, Context<Grid>, const ElementOf<Grid>&,
                                          std::span<Point>>) {
        call_corner_gradients(
            walk_->field(), *s.context, s.element,
            std::span<Point>(g.data(), static_cast<std::size_t>(s.corner_count())));
    }
    return g;
}

template <class Grid, class Field, class S, class Indicator>
Point IsosurfaceVisitor<Grid, Field, S, Indicator>::node_gradient(const State& father,
                                                                  const Rule& rule,
                                                                  std::size_t node) const {
    const auto corners = static_cast<std::size_t>(father.corner_count());
    if (node < corners) return projected_gradient(father, node);
    const Stencil& stencil = rule.new_nodes[node - corners];
    std::array<Point, max_corners> parent;
    Stencil local = stencil;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        parent[i] = node_gradient(father, rule, stencil.parent[i]);
        local.parent[i] = static_cast<std::uint8_t>(i);
    }
    return interpolate(local, parent.data());
}

template <class Grid, class Field, class S, class Indicator>
void IsosurfaceVisitor<Grid, Field, S, Indicator>::load_gradients(const State& s) {
    const auto corners = static_cast<std::size_t>(s.corner_count());
    const bool own = offers_gradients<Grid, Field>(walk_->field());
    Point mean{0, 0, 0};
    if (!own && dimension == 3) {  // the constant gradient of the element, times six volumes
        for (std::size_t f = 0; f < corners; ++f) {
            const FaceTopology& face = topology(s.shape).face[f];
            const Point inward = -1.0 * cross(x_[face.corner[1]] - x_[face.corner[0]],
                                              x_[face.corner[2]] - x_[face.corner[0]]);
            mean = mean + (s.orientation * double(s.value[f * State::components])) * inward;
        }
    } else if (!own) {
        for (std::size_t f = 0; f < corners; ++f) {
            const FaceTopology& face = topology(s.shape).face[f];
            const Point e = x_[face.corner[1]] - x_[face.corner[0]];
            mean = mean +
                   (s.orientation * double(s.value[f * State::components])) * Point{-e[1], e[0], 0};
        }
    }
    std::array<Point, max_corners> exact;  // asked for once, where a node is met for the first time
    bool asked = false;
    for (std::size_t i = 0; i < corners; ++i) {
        const auto [at, is_new] =
            gradient_of_.insert(key_[i], static_cast<Index>(gradient_.size()));
        slot_[i] = *at;
        if (is_new) {
            const bool interpolated = (s.interpolated >> i & 1U) != 0;
            if (own && !interpolated && !asked) {
                exact = own_gradients(s);
                asked = true;
            }
            gradient_.push_back(!own           ? Point{0, 0, 0}
                                : interpolated ? projected_gradient(s, i)
                                               : exact[i]);
        }
        if (!own) gradient_[slot_[i]] = gradient_[slot_[i]] + mean;
    }
}

template <class Grid, class Field, class S, class Indicator>
void IsosurfaceVisitor<Grid, Field, S, Indicator>::compute_normals() {
    Surface<dimension, ElementOf<Grid>>& surface = result_.surface;
    surface.normals.assign(surface.vertices.size(), Point{0, 0, 0});
    std::vector<bool> flat(surface.vertices.size(), false);
    bool any_flat = false;
    for (std::size_t v = 0; v < where_.size(); ++v) {
        const Vertex& w = where_[v];
        const Point g = (1 - w.fraction) * gradient_[w.low] + w.fraction * gradient_[w.high];
        const double length = norm(g);
        if (length > 0) {
            surface.normals[v] = (-1 / length) * g;
        } else {
            flat[v] = any_flat = true;
        }
    }
    if (!any_flat) return;
    if constexpr (dimension == 3) {  // where the gradient vanishes: the triangles around
        for (const auto& t : surface.simplices) {
            const Point n = cross(surface.vertices[t[1]] - surface.vertices[t[0]],
                                  surface.vertices[t[2]] - surface.vertices[t[0]]);
            for (const Index v : t) {
                if (flat[v]) surface.normals[v] = surface.normals[v] + n;
            }
        }
    }
    for (std::size_t v = 0; v < flat.size(); ++v) {
        const double length = norm(surface.normals[v]);
        if (flat[v] && length > 0) surface.normals[v] = (1 / length) * surface.normals[v];
    }
}

template <class Grid, class Field, class S, class Indicator>
auto IsosurfaceVisitor<Grid, Field, S, Indicator>::take() -> Result {
    if (options_->normals) compute_normals();
    result_.table_bytes = vertex_of_.memory_bytes() + gradient_of_.memory_bytes() +
                          gradient_.capacity() * sizeof(Point) + where_.capacity() * sizeof(Vertex);
    result_.stack_bytes = static_cast<std::size_t>(deepest_ + 1) * sizeof(State);
    return std::move(result_);
}

}  // namespace nestgrid::detail
