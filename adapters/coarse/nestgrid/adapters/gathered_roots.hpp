// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A grid with many coarse elements, as the same grid with few: where the coarse elements are boxes
// on a lattice, cubes of 2^m of them become roots, which are halved m times down to the elements
// that the grid has. Every surface begins at the coarse elements, so that many of them cost each
// surface time, and no threshold can stop above them.
//
//     const HyperTreeGrid<3> trees(*vtk_trees);
//     const CellAverages values(trees, ...);
//     const GatheredRoots grid(trees);
//     isosurface(grid, GatheredField(grid, values), 0.5);
//
// Invariants: a cube is gathered only where the grid has all of its coarse elements, and m is the
// greatest number for which it has all or none of each cube. Nodes have the keys and values that
// the grid gives them, and its positions up to rounding: a surface of all data is that of the grid.
// Consequence: elements above the grid's own never hang, and are hidden as what they consist of.
// Where coarse elements are no lattice of boxes of one size, m is 0: the roots are the grid's own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include <nestgrid/detail/operations.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/optional.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid {

/// \tparam Grid of quadrilaterals or hexahedra on one process, without a context and without
///         positions of its own
template <class Grid>
class GatheredRoots {
    static constexpr auto size_ = static_cast<std::size_t>(Grid::dimension);
    static constexpr std::size_t corners_ = std::size_t{1} << size_;
    static constexpr bool has_keys_ = may_offer<Grid>(Feature::own_keys);
    static constexpr bool offers_any(std::initializer_list<Feature> features) {
        return std::any_of(features.begin(), features.end(),
                           [](Feature each) { return may_offer<Grid>(each); });
    }

public:
    static constexpr int dimension = Grid::dimension;
    static constexpr int max_corners = 1 << dimension;
    static constexpr int max_children = std::max(Grid::max_children, 1 << dimension);
    static constexpr int max_new_nodes = std::max(Grid::max_new_nodes, dimension == 2 ? 5 : 19);
    static constexpr Shape only_shape = Grid::only_shape;
    static_assert(only_shape == (dimension == 2 ? Shape::quadrilateral : Shape::hexahedron));
    static_assert(std::is_same_v<Context<Grid>, NoContext>);
    static_assert(!offers_any({Feature::presence, Feature::new_positions, Feature::own_positions,
                               Feature::masked, Feature::outside, Feature::boundary_faces,
                               Feature::hanging_parents, Feature::geometry_degree}));

    using Inner = ElementOf<Grid>;
    using Place = std::array<std::int32_t, size_>;
    struct Element {
        Inner inner{};           ///< where it is an element of the grid
        Place cell{};            ///< else its place, in cubes as large as this one
        std::uint8_t above = 0;  ///< how often it is halved down to a coarse element of the grid
    };

    /// \param grid borrowed
    ///
    /// \throw InvalidInput for a grid of more than 2^31 - 1 coarse elements
    explicit GatheredRoots(const Grid& grid);

    /// m: a root is 2^m coarse elements wide.
    int levels_above() const { return above_; }

    std::size_t coarse_count() const { return above_ == 0 ? grid_->coarse_count() : roots_.size(); }
    CoarseElement<Element> coarse(std::size_t i) const;
    const Rule* split(const Element& e) const {
        return e.above > 0 ? rule_ : grid_->split(e.inner);
    }
    void children(const Element& e, std::span<Element> out) const;

    void corner_keys(const Element& e, std::span<NodeKey> out) const requires has_keys_ {
        if (e.above == 0) return grid_->corner_keys(e.inner, out);
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = key_at(corner_at(e, k));
    }
    void new_keys(const Element& e, std::span<NodeKey> out) const requires has_keys_ {
        if (e.above == 0) return grid_->new_keys(e.inner, out);
        for (std::size_t n = 0; n < out.size(); ++n) out[n] = key_at(new_node_at(e, n));
    }
    std::size_t node_count() const requires(may_offer<Grid>(Feature::dense_keys)) {
        return grid_->node_count();
    }
    NodeMask constrained(const Element& e) const requires(may_offer<Grid>(Feature::constrained)) {
        return e.above > 0 ? 0 : grid_->constrained(e.inner);
    }
    Hidden hidden(const Element& e) const requires(may_offer<Grid>(Feature::hidden)) {
        return e.above == 0 ? grid_->hidden(e.inner) : hidden_[e.above][number_of(e.cell, e.above)];
    }
    std::uint64_t epoch() const { return nestgrid::epoch(*grid_); }

    // What GatheredField needs.
    const Grid& grid() const { return *grid_; }
    /// A node of the lattice, as a corner of a coarse element of the grid.
    struct Corner {
        std::size_t coarse;
        std::size_t corner;
    };
    /// \param e above the grid's own elements
    Corner corner_at(const Element& e, std::size_t k) const {
        Place node = e.cell;
        for (std::size_t d = 0; d < size_; ++d) {
            node[d] = (node[d] + static_cast<std::int32_t>(k >> d & 1U)) << e.above;
        }
        return at(node, e);
    }
    Corner new_node_at(const Element& e, std::size_t n) const {
        const ChildCorner place = rule_->new_corner[n];
        Place node = e.cell;
        for (std::size_t d = 0; d < size_; ++d) {
            const std::size_t halves = (place.child >> d & 1U) + (place.corner >> d & 1U);
            node[d] = (2 * node[d] + static_cast<std::int32_t>(halves)) << (e.above - 1);
        }
        return at(node, e);
    }

private:
    /// The lattice of the coarse elements: their numbers by place; empty where there is none.
    void find_lattice();
    /// How often cubes can be gathered.
    void find_levels();
    void find_hidden();
    bool read_place(const CoarseElement<Inner>& coarse, const CoarseElement<Inner>& first,
                    Place& place) const;

    /// The number of a cube at a place.
    std::size_t number_of(const Place& place, int above) const {
        std::size_t number = 0;
        for (std::size_t d = size_; d-- > 0;) {
            number = number * static_cast<std::size_t>(cells_[d] >> above) +
                     static_cast<std::size_t>(place[d]);
        }
        return number;
    }
    Place place_of(std::size_t number, int above) const {
        Place place{};
        for (std::size_t d = 0; d < size_; ++d) {
            const auto along = static_cast<std::size_t>(cells_[d] >> above);
            place[d] = static_cast<std::int32_t>(number % along);
            number /= along;
        }
        return place;
    }
    /// A node of a cube, as a corner of a coarse element in it.
    Corner at(const Place& node, const Element& e) const {
        Corner found{0, 0};
        Place place = node;
        for (std::size_t d = 0; d < size_; ++d) {
            if (node[d] != (e.cell[d] + 1) << e.above) continue;
            --place[d];
            found.corner |= std::size_t{1} << d;
        }
        found.coarse = static_cast<std::size_t>(numbers_[number_of(place, 0)]);
        return found;
    }
    NodeKey key_at(const Corner& at) const requires has_keys_ {
        std::array<NodeKey, corners_> keys;
        grid_->corner_keys(grid_->coarse(at.coarse).element, keys);
        return keys[at.corner];
    }

    const Grid* grid_;
    const Rule* rule_ = &dyadic_rule(only_shape);
    int above_ = 0;
    Place cells_{};                            // along each side of the lattice
    std::vector<std::int32_t> numbers_;        // of coarse elements by place, -1 for none
    std::vector<Place> roots_;                 // where above_ is not 0
    std::vector<std::vector<Hidden>> hidden_;  // of cubes, by how often they are halved
};

template <class Grid>
GatheredRoots(const Grid&) -> GatheredRoots<Grid>;

/// A field on the grid, as one on the gathered grid.
/// \tparam Field without components, gradients and degrees
template <class Grid, class Field>
class GatheredField {
public:
    using value_type = typename Field::value_type;
    using Element = typename GatheredRoots<Grid>::Element;
    static_assert(
        !requires(const Field& f, const ElementOf<Grid>& e, std::span<Point> out) {
            f.corner_gradients(e, out);
        } &&
        !requires(const Field& f, const ElementOf<Grid>& e) { f.degree(e); });

    /// Both are borrowed.
    GatheredField(const GatheredRoots<Grid>& grid, const Field& field)
        : grid_{&grid}, field_{&field} {}

    NodeMask coarse_values(std::size_t i, std::span<value_type> out) const {
        if (grid_->levels_above() == 0) return coarse_of(i, out);
        const Element e = grid_->coarse(i).element;
        NodeMask missing = 0;
        for (std::size_t k = 0; k < out.size(); ++k) {
            if (!value_at(grid_->corner_at(e, k), out[k])) missing |= NodeMask{1} << k;
        }
        return missing;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<value_type> out) const {
        if (e.above == 0) {
            NoContext none;
            if constexpr (requires { field_->new_values(e.inner, which, out, none); }) {
                return field_->new_values(e.inner, which, out, none);
            } else {
                return field_->new_values(e.inner, which, out);
            }
        }
        NodeMask missing = 0;
        for (std::size_t n = 0; n < out.size(); ++n) {
            if ((which >> n & 1U) == 0) continue;
            if (!value_at(grid_->new_node_at(e, n), out[n])) missing |= NodeMask{1} << n;
        }
        return missing;
    }

private:
    NodeMask coarse_of(std::size_t i, std::span<value_type> out) const {
        NoContext none;
        if constexpr (requires { field_->coarse_values(i, out, none); }) {
            return field_->coarse_values(i, out, none);
        } else {
            return field_->coarse_values(i, out);
        }
    }
    bool value_at(const typename GatheredRoots<Grid>::Corner& at, value_type& out) const {
        std::array<value_type, static_cast<std::size_t>(GatheredRoots<Grid>::max_corners)> values;
        const NodeMask missing = coarse_of(at.coarse, values);
        out = values[at.corner];
        return (missing >> at.corner & 1U) == 0;
    }

    const GatheredRoots<Grid>* grid_;
    const Field* field_;
};

template <class Grid>
GatheredRoots<Grid>::GatheredRoots(const Grid& grid) : grid_{&grid} {
    if (grid.coarse_count() >= std::size_t{1} << 31U) {
        throw InvalidInput("there are more than 2^31 - 1 coarse elements");
    }
    find_lattice();
    find_levels();
    if constexpr (may_offer<Grid>(Feature::hidden)) find_hidden();
}

/// Whether a coarse element is a box as large as the first one, on its lattice.
/// \param place from the first one; may be negative
template <class Grid>
bool GatheredRoots<Grid>::read_place(const CoarseElement<Inner>& coarse,
                                     const CoarseElement<Inner>& first, Place& place) const {
    const Point& low = first.corners[0];
    for (std::size_t d = 0; d < size_; ++d) {
        const double step = first.corners[corners_ - 1][d] - low[d];
        const double at = std::round((coarse.corners[0][d] - low[d]) / step);
        if (!(step > 0) || !(std::abs(at) < 0x1p30)) return false;
        place[d] = static_cast<std::int32_t>(at);
        for (std::size_t k = 0; k < corners_; ++k) {
            const double wanted = low[d] + step * (at + static_cast<double>(k >> d & 1U));
            if (!(std::abs(coarse.corners[k][d] - wanted) <= 1e-9 * step)) return false;
        }
    }
    for (std::size_t k = 0; k < corners_; ++k) {
        for (std::size_t d = size_; d < 3; ++d) {
            if (coarse.corners[k][d] != low[d]) return false;
        }
    }
    return coarse.orientation == 1;
}

template <class Grid>
void GatheredRoots<Grid>::find_lattice() {
    const std::size_t count = grid_->coarse_count();
    if (count < corners_) return;
    const CoarseElement<Inner> first = grid_->coarse(0);
    std::vector<Place> places(count);
    Place low{};
    Place high{};
    for (std::size_t i = 0; i < count; ++i) {
        if (!read_place(grid_->coarse(i), first, places[i])) return;
        for (std::size_t d = 0; d < size_; ++d) {
            low[d] = std::min(low[d], places[i][d]);
            high[d] = std::max(high[d], places[i][d]);
        }
    }
    double all = 1;
    double all_nodes = 1;
    for (std::size_t d = 0; d < size_; ++d) {
        cells_[d] = high[d] - low[d] + 1;
        all *= cells_[d];
        all_nodes *= cells_[d] + 1.0;
    }
    if (all > 8.0 * static_cast<double>(count)) return;
    numbers_.assign(static_cast<std::size_t>(all), -1);
    constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
    std::vector<std::uint64_t> ids(static_cast<std::size_t>(all_nodes), none);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t d = 0; d < size_; ++d) places[i][d] -= low[d];
        std::int32_t& number = numbers_[number_of(places[i], 0)];
        bool is_sound = number < 0;
        number = static_cast<std::int32_t>(i);
        const CoarseElement<Inner> coarse = grid_->coarse(i);
        for (std::size_t k = 0; k < corners_; ++k) {
            std::size_t node = 0;
            for (std::size_t d = size_; d-- > 0;) {
                node = node * (static_cast<std::size_t>(cells_[d]) + 1) +
                       static_cast<std::size_t>(places[i][d]) + (k >> d & 1U);
            }
            is_sound = is_sound && (ids[node] == none || ids[node] == coarse.ids[k]);
            ids[node] = coarse.ids[k];
        }
        if (is_sound) continue;
        numbers_.clear();  // elements that lie on each other, or the two sides of a slit
        return;
    }
}

template <class Grid>
void GatheredRoots<Grid>::find_levels() {
    if (numbers_.empty()) return;
    std::vector<bool> is_there;
    for (const std::int32_t number : numbers_) is_there.push_back(number >= 0);
    for (int above = 1; above < 30; ++above) {
        bool is_even = true;
        std::size_t cubes = 1;
        for (std::size_t d = 0; d < size_; ++d) {
            is_even = is_even && cells_[d] % (std::int32_t{1} << above) == 0;
            cubes *= static_cast<std::size_t>(cells_[d] >> above);
        }
        if (!is_even) break;
        std::vector<bool> of_cubes(cubes);
        for (std::size_t i = 0; is_even && i < cubes; ++i) {
            const Place cube = place_of(i, above);
            std::size_t parts = 0;
            for (std::size_t k = 0; k < corners_; ++k) {
                Place part = cube;
                for (std::size_t d = 0; d < size_; ++d) {
                    part[d] = 2 * cube[d] + static_cast<std::int32_t>(k >> d & 1U);
                }
                parts += is_there[number_of(part, above - 1)] ? 1U : 0U;
            }
            is_even = parts == 0 || parts == corners_;
            of_cubes[i] = parts == corners_;
        }
        if (!is_even) break;
        above_ = above;
        is_there = std::move(of_cubes);
    }
    if (above_ == 0) return;
    for (std::size_t i = 0; i < is_there.size(); ++i) {
        if (is_there[i]) roots_.push_back(place_of(i, above_));
    }
}

template <class Grid>
void GatheredRoots<Grid>::find_hidden() {
    if (above_ == 0) return;
    hidden_.resize(static_cast<std::size_t>(above_) + 1);
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
        const std::int32_t number = numbers_[i];
        hidden_[0].push_back(
            number < 0 ? Hidden::wholly
                       : grid_->hidden(grid_->coarse(static_cast<std::size_t>(number)).element));
    }
    for (int above = 1; above <= above_; ++above) {
        std::size_t cubes = 1;
        for (const std::int32_t n : cells_) cubes *= static_cast<std::size_t>(n >> above);
        const auto a = static_cast<std::size_t>(above);
        for (std::size_t i = 0; i < cubes; ++i) {
            const Place cube = place_of(i, above);
            Hidden all{};
            for (std::size_t k = 0; k < corners_; ++k) {
                Place part = cube;
                for (std::size_t d = 0; d < size_; ++d) {
                    part[d] = 2 * cube[d] + static_cast<std::int32_t>(k >> d & 1U);
                }
                const Hidden of_part = hidden_[a - 1][number_of(part, above - 1)];
                if (k == 0) all = of_part;
                if (of_part != all) all = Hidden::partly;
            }
            hidden_[a].push_back(all);
        }
    }
    hidden_[0] = {};
}

template <class Grid>
auto GatheredRoots<Grid>::coarse(std::size_t i) const -> CoarseElement<Element> {
    CoarseElement<Element> c;
    c.shape = only_shape;
    if (above_ == 0) {
        const CoarseElement<Inner> own = grid_->coarse(i);
        c.orientation = own.orientation;
        c.corners = own.corners;
        c.ids = own.ids;
        c.element.inner = own.element;
        return c;
    }
    c.element.cell = roots_[i];
    c.element.above = static_cast<std::uint8_t>(above_);
    for (std::size_t k = 0; k < corners_; ++k) {
        const Corner at = corner_at(c.element, k);
        const CoarseElement<Inner> own = grid_->coarse(at.coarse);
        c.corners[k] = own.corners[at.corner];
        c.ids[k] = own.ids[at.corner];
    }
    return c;
}

template <class Grid>
void GatheredRoots<Grid>::children(const Element& e, std::span<Element> out) const {
    if (e.above == 0) {
        std::array<Inner, static_cast<std::size_t>(Grid::max_children)> own;
        grid_->children(e.inner, std::span(own).first(out.size()));
        for (std::size_t c = 0; c < out.size(); ++c) out[c] = {own[c], {}, 0};
        return;
    }
    for (std::size_t c = 0; c < out.size(); ++c) {
        out[c] = {{}, e.cell, static_cast<std::uint8_t>(e.above - 1)};
        for (std::size_t d = 0; d < size_; ++d) {
            out[c].cell[d] = 2 * e.cell[d] + static_cast<std::int32_t>(c >> d & 1U);
        }
        if (e.above > 1) continue;
        const std::int32_t number = numbers_[number_of(out[c].cell, 0)];
        out[c].inner = grid_->coarse(static_cast<std::size_t>(number)).element;
        out[c].cell = {};
    }
}

}  // namespace nestgrid
