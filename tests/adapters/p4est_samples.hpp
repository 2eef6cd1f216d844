// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests for tests, refined at random with fixed seeds, and values at their nodes.
#pragma once

#include <functional>
#include <memory>

#include <p4est_bits.h>
#include <p4est_extended.h>
#include <p4est_geometry.h>
#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_geometry.h>

#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <walk/project.hpp>

#include "closedness.hpp"
#include "element_in.hpp"

namespace nestgrid_test {

/// The functions of p4est by dimension.
template <int dim>
struct P4est {
    static constexpr auto make = p4est_new;
    static constexpr auto destroy = p4est_destroy;
    static constexpr auto destroy_connectivity = p4est_connectivity_destroy;
    static constexpr auto refine = p4est_refine;
    static constexpr auto balance = p4est_balance;
    static constexpr auto full = P4EST_CONNECT_FULL;
    static constexpr auto make_ghost = p4est_ghost_new;
    static constexpr auto destroy_ghost = p4est_ghost_destroy;
    static constexpr auto make_nodes = p4est_lnodes_new;
    static constexpr auto destroy_nodes = p4est_lnodes_destroy;
    static constexpr auto save = p4est_save;
    static constexpr auto load = p4est_load;
};
template <>
struct P4est<3> {
    static constexpr auto make = p8est_new;
    static constexpr auto destroy = p8est_destroy;
    static constexpr auto destroy_connectivity = p8est_connectivity_destroy;
    static constexpr auto refine = p8est_refine;
    static constexpr auto balance = p8est_balance;
    static constexpr auto full = P8EST_CONNECT_FULL;
    static constexpr auto make_ghost = p8est_ghost_new;
    static constexpr auto destroy_ghost = p8est_ghost_destroy;
    static constexpr auto make_nodes = p8est_lnodes_new;
    static constexpr auto destroy_nodes = p8est_lnodes_destroy;
    static constexpr auto save = p8est_save;
    static constexpr auto load = p8est_load;
};

/// A forest with its connectivity.
template <int dim>
class Forest {
public:
    using Types = P4estTypes<dim>;
    using Api = P4est<dim>;
    using Quadrant = typename Types::Quadrant;
    using Pointer = std::unique_ptr<typename Types::Forest, void (*)(typename Types::Forest*)>;
    using Nodes = std::unique_ptr<typename Types::Nodes, void (*)(typename Types::Nodes*)>;

    explicit Forest(typename Types::Connectivity* connectivity, std::size_t data_size = 0)
        : connectivity_{connectivity, Api::destroy_connectivity},
          forest_{Api::make(sc_MPI_COMM_WORLD, connectivity, data_size, nullptr, nullptr),
                  Api::destroy} {}
    Forest(typename Types::Forest* forest, typename Types::Connectivity* connectivity)
        : connectivity_{connectivity, Api::destroy_connectivity}, forest_{forest, Api::destroy} {}

    typename Types::Forest* get() const { return forest_.get(); }
    typename Types::Connectivity& connectivity() const { return *connectivity_; }

    /// Refines every leaf, recursively, where `wanted` says so.
    void refine(const std::function<bool(const Quadrant&)>& wanted) {
        forest_->user_pointer = const_cast<void*>(static_cast<const void*>(&wanted));
        Api::refine(
            forest_.get(), 1,
            [](typename Types::Forest* f, p4est_topidx_t, Quadrant* q) -> int {
                return (*static_cast<const std::function<bool(const Quadrant&)>*>(f->user_pointer))(
                           *q)
                           ? 1
                           : 0;
            },
            nullptr);
    }
    void refine_at_random(unsigned seed, int depth) {
        std::mt19937 random(seed);
        refine([&](const Quadrant& q) {
            return q.level < depth && (q.level < 1 || random() % (dim == 2 ? 5 : 7) < 2);
        });
    }
    void balance() { Api::balance(forest_.get(), Api::full, nullptr); }
    Nodes nodes(int degree = 1) const {
        auto* ghost = Api::make_ghost(forest_.get(), Api::full);
        Nodes nodes(Api::make_nodes(forest_.get(), ghost, degree), Api::destroy_nodes);
        Api::destroy_ghost(ghost);
        return nodes;
    }

private:
    std::unique_ptr<typename Types::Connectivity, void (*)(typename Types::Connectivity*)>
        connectivity_;
    Pointer forest_;
};

/// Calls function(view, walk) for every leaf, with keys and positions.
template <class Grid, class Function>
void for_each_leaf(const Grid& grid, Function&& function) {
    const ZeroField<Grid> zero;
    const auto hierarchy = erase(grid, zero);
    const engine::Walk<float> walk(hierarchy, {.values = false, .positions = true});
    engine::project(walk, Exact{}, [&](const auto& view) { function(view, walk); });
}

/// The nodes of all leaves: places by key, scaled into the unit cube.
template <class Grid>
struct NodePlaces {
    std::vector<Point> places;
    KeyTable<NodeKey, std::size_t> number;

    explicit NodePlaces(const Grid& grid) {
        for_each_leaf(grid, [&](const auto& view, const auto& walk) {
            std::array<NodeKey, max_corners> keys;
            std::array<Point, max_corners> x;
            walk.corners(view, keys.data(), x.data());
            for (std::size_t i = 0; i < view.corner_count(); ++i) {
                if (number.insert(keys[i], places.size()).second) places.push_back(x[i]);
            }
        });
        for (std::size_t d = 0; d < 3; ++d) {
            double low = 1e300;
            double high = -1e300;
            for (const Point& x : places) {
                low = std::min(low, x[d]);
                high = std::max(high, x[d]);
            }
            for (Point& x : places) x[d] = high > low ? (x[d] - low) / (high - low) : 0;
        }
    }
};

/// Values by node key, also on forests without balance, which lnodes do not number.
template <class Grid>
class KeyedField {
public:
    using value_type = double;
    KeyedField(const Grid& grid, const NodePlaces<Grid>& nodes, std::span<const double> values)
        : grid_{&grid}, nodes_{&nodes}, values_{values} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        std::array<NodeKey, Grid::max_corners> keys;
        grid_->corner_keys(grid_->coarse(i).element, keys);
        return give(keys, out);
    }
    NodeMask new_values(const ElementOf<Grid>& e, NodeMask, std::span<double> out) const {
        std::array<NodeKey, Grid::max_new_nodes> keys;
        grid_->new_keys(e, keys);
        return give(keys, out);
    }

private:
    NodeMask give(std::span<const NodeKey> keys, std::span<double> out) const {
        NodeMask missing = 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const std::size_t* at = nodes_->number.find(keys[i]);
            if (at == nullptr) missing |= NodeMask{1} << i;
            if (at != nullptr) out[i] = values_[*at];
        }
        return missing;
    }

    const Grid* grid_;
    const NodePlaces<Grid>* nodes_;
    std::span<const double> values_;
};

/// Corners of a leaf that hang, one bit each, as p4est's own decoder and its diagrams say.
inline unsigned hanging_corners(const p4est_lnodes_t& nodes, std::size_t leaf) {
    std::array<int, P4EST_FACES> face{};
    unsigned hanging = 0;
    if (p4est_lnodes_decode(nodes.face_code[leaf], face.data()) == 0) return hanging;
    for (std::size_t f = 0; f < face.size(); ++f) {
        if (face[f] >= 0) hanging |= 1U << p4est_face_corners[f][1 - face[f]];
    }
    return hanging;
}
inline unsigned hanging_corners(const p8est_lnodes_t& nodes, std::size_t leaf) {
    std::array<int, P8EST_FACES> face{};
    std::array<int, P8EST_EDGES> edge{};
    unsigned hanging = 0;
    if (p8est_lnodes_decode(nodes.face_code[leaf], face.data(), edge.data()) == 0) return hanging;
    for (std::size_t f = 0; f < face.size(); ++f) {
        if (face[f] >= 0) hanging |= 1U << p8est_face_corners[f][3 - face[f]];
    }
    for (std::size_t e = 0; e < edge.size(); ++e) {
        if (edge[e] >= 0 && edge[e] < 4) hanging |= 1U << p8est_edge_corners[e][1 - edge[e] % 2];
    }
    return hanging;
}

/// Values of lnodes by a function of the place.
template <int dim, class Map, class Nodes, class Function>
auto nodal_values(const P4estGrid<dim, Map>& grid, const Nodes& nodes, Function&& function) {
    std::vector<std::decay_t<decltype(function(Point{}))>> values(
        static_cast<std::size_t>(nodes.num_local_nodes));
    for_each_leaf(grid, [&](const auto& view, const auto& walk) {
        std::array<Point, max_corners> x;
        walk.corners(view, nullptr, x.data());
        const std::size_t leaf = grid.leaf_index(element_in(grid, view));
        const unsigned hanging = hanging_corners(nodes, leaf);
        for (std::size_t c = 0; c < 1U << dim; ++c) {
            if ((hanging >> c & 1U) != 0) continue;
            values[static_cast<std::size_t>(nodes.element_nodes[(leaf << dim) + c])] =
                function(x[c]);
        }
    });
    return values;
}

}  // namespace nestgrid_test
