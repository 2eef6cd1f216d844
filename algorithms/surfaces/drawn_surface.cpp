// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/drawn_surface.hpp>

#include <algorithm>
#include <numeric>
#include <string>

#include <ranks/agreement.hpp>
#include <ranks/merge_across.hpp>
#include <ranks/normals_across.hpp>
#include <surfaces/merge_at_nodes.hpp>
#include <surfaces/settle_normals.hpp>

namespace nestgrid::engine {

namespace {

/// A unit normal; 0 where that is 0.
Point unit(const std::array<float, 3>& normal) {
    const Point n{normal[0], normal[1], normal[2]};
    const double length = norm(n);
    return length > 0 ? (1 / length) * n : n;
}

}  // namespace

template <int dimension>
void DrawnSurface<dimension>::begin(Builder builder, const VertexNormals& normals, bool verify) {
    builder_ = std::move(builder);
    normals_ = normals;
    verifies_ = verify;
    counts_only_ = false;
    numbers_.clear();
    within_.begin_again(0);
    where_.clear();
    of_vertices_.clear();
    simplices_.clear();
    at_nodes_.clear();
    is_at_node_.clear();
    names_.clear();
    keeps_names_ = false;
    keeps_simplices_ = makes_normals() && builder_.target() == nullptr;
    report_ = {};
}

template <int dimension>
auto DrawnSurface<dimension>::add(const SurfaceCut& cut) -> Number {
    const Number number = builder_.next_vertex();
    if (number == none) throw_too_many_vertices();
    if (builder_.lists_shared()) {
        builder_.add_shared(cut.node, cut.fraction, cut.x, cut.attributes);
        return number;
    }
    builder_.add_vertex(cut.x, cut.attributes);
    if (keeps_names_) names_.emplace_back(cut.node[0], cut.node[1]);
    if (normals_.gradients != nullptr) {
        where_.push_back({normals_.gradients->slot(cut.node[0]),
                          normals_.gradients->slot(cut.node[1]), cut.fraction});
    }
    return number;
}

/// Gives vertices without names such of this rank.
template <int dimension>
void DrawnSurface<dimension>::name_as_own(Number first, std::size_t count) {
    for (Number v = first; v < first + count; ++v) names_.push_back(own_name(rank_, v));
}

template <int dimension>
void DrawnSurface<dimension>::agree(Ranks& ranks) {
    std::array<double*, 3> greatest{&report_.error_bound, &report_.off_level, &report_.leaf_error};
    take_greatest(ranks, greatest);
    std::array<std::uint64_t*, 1> sum{&report_.extracted};
    take_sums(ranks, sum);
}

template <int dimension>
void DrawnSurface<dimension>::verify(Number number, const Point& x) const {
    if (position(number) == x) return;
    throw GridError("two elements put the vertex " + std::to_string(number) +
                    " at different places");
}

template <int dimension>
auto DrawnSurface<dimension>::add_part(const SurfacePart<dimension>& part,
                                       const DrawnSurface* drawn) -> std::vector<Number> {
    const Surface<dimension>& surface = part.surface;
    if (!builder_.shares_vertices()) {
        builder_.hand_over(surface);
        return {};
    }
    constexpr std::size_t ahead = 16;
    const std::span<const Point> x(surface.vertices);
    const std::size_t stride = x.empty() ? 0 : surface.attributes.size() / x.size();
    const auto attributes = [&](std::size_t first, std::size_t end) {
        return std::span<const double>(surface.attributes)
            .subspan(first * stride, (end - first) * stride);
    };
    std::vector<Number> number;  // by vertex of the part: its number here
    number.reserve(x.size());
    const auto add_own = [&](std::size_t end) {
        const std::size_t first = number.size();
        if (first == end) return;
        const Number next = add_unnamed(x.subspan(first, end - first), attributes(first, end));
        if (normals_.with_vertices) {
            const auto from = drawn->of_vertices_.begin();
            of_vertices_.insert(of_vertices_.end(), from + static_cast<std::ptrdiff_t>(first),
                                from + static_cast<std::ptrdiff_t>(end));
        }
        number.resize(end);
        std::iota(number.data() + first, number.data() + end, next);
    };
    const auto name_of = [&](const SharedVertex& v) { return name({v.node[0], v.node[1]}); };
    for (std::size_t i = 0; i < part.shared.size(); ++i) {
        if (i + ahead < part.shared.size()) prefetch(name_of(part.shared[i + ahead]));
        const SharedVertex& v = part.shared[i];
        add_own(v.number);
        number.push_back(vertex(name_of(v), [&] {
            if (normals_.with_vertices) of_vertices_.push_back(drawn->of_vertices_[v.number]);
            return SurfaceCut{x[v.number], v.node, v.fraction,
                              attributes(v.number, v.number + std::size_t{1})};
        }));
    }
    add_own(x.size());
    for (auto ridge : surface.boundary) {
        for (Number& v : ridge) v = number[v];
        builder_.add_boundary(ridge);
    }
    const VerticesAtNodes none_at_nodes;
    const VerticesAtNodes& at_nodes = drawn == nullptr ? none_at_nodes : drawn->at_nodes_;
    for (std::size_t i = 0; i < at_nodes.vertex.size(); ++i) {
        put_at_node(number[at_nodes.vertex[i]], at_nodes.node[i],
                    std::span(at_nodes.attributes).subspan(i * stride, stride));
    }
    builder_.add_part(surface, number);
    for (auto simplex :
         keeps_simplices_ ? std::span(surface.simplices) : std::span<const Simplex>()) {
        for (Number& v : simplex) v = number[v];
        simplices_.push_back(simplex);
    }
    return number;
}

/// The gradient at a vertex, interpolated between its nodes; 0 where neither node has a gradient.
template <int dimension>
Point DrawnSurface<dimension>::gradient_at(const Where& where) const {
    const bool low = where.low != none && normals_.gradients->known(where.low);
    const bool high = where.high != none && normals_.gradients->known(where.high);
    if (!low && !high) return {0, 0, 0};
    const Point a = normals_.gradients->mean(low ? where.low : where.high);
    const Point b = normals_.gradients->mean(high ? where.high : where.low);
    return (1 - where.fraction) * a + where.fraction * b;
}

/// Unit normals; 0 where no gradient is known, or where it is 0.
template <int dimension>
std::vector<Point> DrawnSurface<dimension>::normals_from_gradients() const {
    std::vector<Point> normals;
    normals.reserve(where_.size());
    for (const Where& where : where_) normals.push_back(unit(short_normal(gradient_at(where))));
    return normals;
}

/// The normals that came with the vertices.
template <int dimension>
std::vector<Point> DrawnSurface<dimension>::normals_of_vertices() const {
    std::vector<Point> normals;
    normals.reserve(of_vertices_.size());
    for (const Normal& n : of_vertices_) normals.push_back(unit(n));
    return normals;
}

/// Takes the normals of ranks that know more of vertices that both have.
template <int dimension>
void DrawnSurface<dimension>::share(std::vector<Point>& normals, std::span<const VertexCopy> copies,
                                    const SharedNodes& shared) const {
    const auto knows = [&](Number slot) { return slot != none && normals_.gradients->known(slot); };
    std::vector<std::uint8_t> known;
    known.reserve(where_.size());
    for (const Where& where : where_) {
        known.push_back(static_cast<std::uint8_t>(knows(where.low) + knows(where.high)));
    }
    share_normals(shared.ranks(), copies, known, normals);
}

template <int dimension>
void DrawnSurface<dimension>::settle(std::vector<Point>& normals, const SharedNodes* shared) const {
    std::vector<Simplex> kept;
    const Surface<dimension>* const surface = builder_.target();
    if (surface == nullptr) kept.assign(simplices_.begin(), simplices_.end());
    const std::span<const Simplex> simplices =
        surface == nullptr ? std::span<const Simplex>(kept) : surface->simplices;
    std::vector<VertexCopy> copies;
    if (shared != nullptr) {
        copies = find_copies(shared->ranks(), simplices, names_);
        share(normals, copies, *shared);
    }
    if constexpr (dimension == 3) {
        std::vector<Point> x;
        if (surface == nullptr) {
            for (Number v = 0; v < normals.size(); ++v) x.push_back(position(v));
        }
        const std::span<const Point> at =
            surface == nullptr ? std::span<const Point>(x) : surface->vertices;
        if (shared == nullptr) {
            settle_normals(simplices, at, normals, extent_of(at));
        } else {
            settle_normals_across(shared->ranks(), copies, simplices, at, normals);
        }
    }
}

template <>
void DrawnSurface<2>::merge_at_nodes(const SharedNodes*) {}
template <>
void DrawnSurface<3>::merge_at_nodes(const SharedNodes* shared) {
    builder_.change([&](Surface<3>& surface) {
        if (shared == nullptr) {
            engine::merge_at_nodes(surface, at_nodes_);
        } else {
            merge_at_nodes_across(surface, at_nodes_, names_, *shared);
        }
    });
}

template <int dimension>
void DrawnSurface<dimension>::finish(bool merges_at_nodes, const SharedNodes* shared) {
    std::vector<Point> normals;
    if (makes_normals()) {
        normals = normals_.with_vertices ? normals_of_vertices() : normals_from_gradients();
    }
    if (merges_at_nodes) {
        builder_.set_normals(std::move(normals));
        merge_at_nodes(shared);
        builder_.change([&](auto& surface) { normals = std::move(surface.normals); });
    }
    if (!makes_normals()) return;
    settle(normals, shared);
    together(shared, "normals", [&] { builder_.set_normals(std::move(normals)); });
}

template class DrawnSurface<2>;
template class DrawnSurface<3>;

}  // namespace nestgrid::engine
