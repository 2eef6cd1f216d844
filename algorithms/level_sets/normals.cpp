// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/normals.hpp>

#include <nestgrid/detail/interpolate.hpp>

namespace nestgrid::engine {

namespace {

using Gradients = std::array<Point, max_corners>;

template <class Real>
Gradients own_gradients(const Walk<Real>& walk, const ElementView<Real>& view) {
    Gradients g{};
    walk.gradients(view, std::span(g).first(view.corner_count()));
    return g;
}

/// The gradients of the field at the corners of an element and of one of its ancestors, mostly its
/// father, asked for once: all interpolated corners have the same fathers.
template <class Real>
class OwnGradients {
public:
    OwnGradients(const Walk<Real>& walk, const ElementView<Real>& element)
        : walk_{walk}, element_{element} {}

    const Point& at(const ElementView<Real>& view, std::size_t corner) {
        const std::size_t i = &view == &element_ ? 0 : 1;
        if (asked_[i] != &view) gradients_[i] = own_gradients(walk_, view);
        asked_[i] = &view;
        return gradients_[i][corner];
    }

private:
    const Walk<Real>& walk_;
    const ElementView<Real>& element_;
    std::array<const ElementView<Real>*, 2> asked_{};
    std::array<Gradients, 2> gradients_;
};

template <class Real>
Point node_gradient(OwnGradients<Real>& own, const ElementView<Real>& father, const Rule& rule,
                    std::size_t node);

/// The projected gradient at a corner: a vector-valued function, projected with the same S as the
/// values (paper, section 8).
template <class Real>
Point projected_gradient(OwnGradients<Real>& own, const ElementView<Real>& view,
                         std::size_t corner) {
    if ((view.interpolated >> corner & 1U) != 0 && view.father != nullptr) {
        const Child& child = view.made_by->children[view.child];
        return node_gradient(own, *view.father, *view.made_by, child.corner[corner]);
    }
    return own.at(view, corner);
}

/// The projected gradient at a corner or new node of a split that interpolates it.
template <class Real>
Point node_gradient(OwnGradients<Real>& own, const ElementView<Real>& father, const Rule& rule,
                    std::size_t node) {
    const std::size_t corners = father.corner_count();
    if (node < corners) return projected_gradient(own, father, node);
    const Stencil& stencil = rule.new_nodes[node - corners];
    Gradients parent;
    Stencil local = stencil;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        parent[i] = node_gradient(own, father, rule, stencil.parent[i]);
        local.parent[i] = static_cast<std::uint8_t>(i);
    }
    return detail::interpolate(local, parent.data());
}

/// The interpolated corners that name vertices of the element, one bit each: those that lie inside
/// no maximal edge.
template <class Real>
NodeMask named_interpolated(const ElementCuts<Real>& element) {
    const ElementView<Real>& view = element.view();
    const Topology& t = view.topology();
    NodeMask named = 0;
    for (std::uint8_t e = 0; e < t.edges; ++e) {
        const KeyPair name = element.name(e);
        for (const std::uint8_t corner : t.edge[e]) {
            const NodeKey key = element.keys()[corner];
            named |= NodeMask{key == name.low || key == name.high} << corner;
        }
    }
    return named & view.interpolated;
}

}  // namespace

template <class Real>
void Normals<Real>::begin(bool logs) {
    logs_ = logs;
    sums_.clear();
    log_.clear();
    of_shared_.clear();
}

template <class Real>
void Normals<Real>::add(const ElementCuts<Real>& element) {
    const View& view = element.view();
    if (by_key_ && view.interpolated == 0) return;
    const NodeMask wanted = by_key_ ? named_interpolated(element) : ~NodeMask{0};
    const std::size_t corners = view.corner_count();
    const std::size_t components = element.walk().components();
    std::array<CornerGradient, max_corners> drawn;
    OwnGradients<Real> own(element.walk(), view);
    std::array<double, max_corners> value;
    if (!own_) {
        for (std::size_t i = 0; i < corners; ++i) value[i] = view.value[i * components];
        corner_gradients(view.topology(), std::span(element.positions()).first(corners),
                         std::span(value).first(corners), std::span(drawn).first(corners));
    }
    if (shared_ != nullptr) log_shared(element, std::span(drawn).first(corners));
    for (std::size_t i = 0; i < corners; ++i) {
        if ((wanted >> i & 1U) == 0) continue;
        const Slot slot = sums_.slot(element.keys()[i]);
        if (!own_) {
            add(slot, drawn[i]);
        } else if (!sums_.known(slot)) {
            add(slot, {projected_gradient(own, view, i), 1});
        }
    }
}

/// Logs the terms at nodes that other ranks have, too.
template <class Real>
void Normals<Real>::log_shared(const ElementCuts<Real>& element,
                               std::span<const CornerGradient> drawn) {
    WalkPlace place;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (!shared_->is_shared(element.keys()[i])) continue;
        if (place.empty()) place = walk_place_of(element.view(), *shared_);
        of_shared_.add(element.keys()[i], place, drawn[i]);
    }
}

/// Adds a gradient at a node. Adds a gradient of the field only once, because it is the same from
/// every element.
template <class Real>
void Normals<Real>::add(Slot slot, const CornerGradient& gradient) {
    if (own_ && sums_.known(slot)) return;
    sums_.add(slot, gradient);
    if (logs_) log_.emplace_back(slot, gradient);
}

template <class Real>
void Normals<Real>::append(const Normals& other) {
    std::vector<Slot> slot;
    slot.reserve(other.sums_.count());
    for (Slot i = 0; i < other.sums_.count(); ++i) slot.push_back(sums_.slot(other.sums_.node(i)));
    for (const auto& [at, gradient] : other.log_) add(slot[at], gradient);
    of_shared_.append(other.of_shared_);
}

template <class Real>
void Normals<Real>::complete(const Hierarchy<Real>& hierarchy) {
    if (!by_key_) return;
    constexpr std::size_t most = 256;
    std::array<Slot, most> slots;
    std::array<NodeKey, most> nodes;
    std::array<Point, most> gradients;
    const auto end = static_cast<Slot>(sums_.count());
    for (Slot next = 0; next < end;) {
        std::size_t count = 0;
        for (; next < end && count < most; ++next) {
            if (sums_.known(next)) continue;
            slots[count] = next;
            nodes[count++] = sums_.node(next);
        }
        hierarchy.node_gradients(std::span(nodes).first(count), gradients);
        for (std::size_t i = 0; i < count; ++i) sums_.add(slots[i], {gradients[i], 1});
    }
}

template class Normals<float>;
template class Normals<double>;

}  // namespace nestgrid::engine
