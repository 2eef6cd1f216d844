// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The walk of check_grid; included by check_grid.hpp.
#pragma once

#include <map>

#include <nestgrid/check_grid.hpp>

namespace nestgrid::detail {

struct WeightedPoint {
    double weight;
    Point x;
};

inline constexpr const char* in_tensor_order =
    "; its corners are numbered in tensor order, x fastest, and not around";

/// As many digits as tell apart any two numbers.
inline std::string all_digits(double number) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.17g", number);
    return text.data();
}

/// Walks once and compares every node with what is known of its place.
template <class Grid, class Field>
class GridChecker {
public:
    using Element = ElementOf<Grid>;
    using Real = typename Field::value_type;

    GridChecker(const Grid& grid, const Field& field, const CheckOptions& options)
        : grid_{grid}, field_{field}, options_{options}, context_{make_context(grid)} {
        own_keys_ = offers(grid, Feature::own_keys);
    }

    std::optional<GridViolation> run() {
        if (options_.notes != nullptr) note_operations(*options_.notes);
        try {
            for (std::size_t i = 0; i < grid_.coarse_count(); ++i) check_coarse(i);
            check_ids();
            for (std::size_t i = 0; i < grid_.coarse_count(); ++i) walk_coarse(i);
            check_hanging();
        } catch (const Found& found) {
            return found.violation;
        }
        return std::nullopt;
    }

private:
    static constexpr Shape only_ = only_shape<Grid>();
    const std::string promised_ =
        ", but the grid says that all elements are " + std::string(topology(only_).name) + "s";
    static constexpr std::size_t components_ = static_cast<std::size_t>(components_of<Field>());
    using Values = std::array<Real, components_>;
    using Weights = std::array<double, max_corners>;  // over the corners of the coarse element

    struct Found {
        GridViolation violation;
    };
    struct Corner {
        Weights weights{};
        NodeKey place = 0;    // hash of the weights over coarse ids
        NodeKey derived = 0;  // key
        NodeKey key = 0;      // own one, where the grid has such; else the derived one
        Point position{};     // by the rules
        Values value{};
    };
    /// How a node is made: what check_grid compares, and what it prints.
    struct Origin {
        NodeKey signature = 0;    // hash of the keys and weights of the parents
        std::size_t element = 0;  // that made the node first
        std::size_t first = 0;    // of its parents in parents_
        std::size_t count = 0;
    };
    struct Node {
        NodeKey key = 0;
        std::size_t element = 0;  // that made it first
        Values value{};
        bool constrained = false;
        bool deviates = false;  // from its interpolant
        bool has_position = false;
        Point own_position{};
    };
    struct Step {  // the way to an element
        std::size_t father;
        std::size_t number;
    };
    struct Made {  // a new node, by what made it first
        NodeKey place = 0;
        NodeKey derived = 0;
        std::size_t coarse = 0;  // number of the coarse element that the weights are of
        Weights weights{};
        std::size_t parents = 0;
        std::array<NodeKey, max_corners> parent{};  // places
        std::array<double, max_corners> weight{};
    };
    struct Inside {  // a new node in an element
        std::size_t node;
        Point at;  // in reference coordinates of the coarse element
    };
    class LeafNodes;
    struct Leaf {
        Shape shape;
        std::array<NodeKey, max_corners> keys;
    };
    struct State {
        Element element;
        Shape shape;
        std::size_t step;
        int level;
        std::array<Corner, max_corners> corner;
    };
    static constexpr std::size_t root_ = ~std::size_t{0};

    [[noreturn]] static void fail(Law law, const std::string& sentence) {
        throw Found{{law, sentence}};
    }
    std::string name(std::size_t step) const {
        std::string path;
        for (; step != root_; step = steps_[step].father) {
            path = "/" + std::to_string(steps_[step].number) + path;
        }
        return "element " + path.substr(1);
    }

    void note_operations(std::vector<std::string>& notes) const;
    void check_coarse(std::size_t i);
    void check_ids() const;
    void walk_coarse(std::size_t i);
    void walk(const State& s);
    void check_rule(const State& s, const Rule& rule);
    void make_node(const Rule& rule, std::size_t n, std::vector<Corner>& nodes);
    void check_stencil(const State& s, const Rule& rule, std::size_t n,
                       const std::vector<Corner>& nodes);
    void check_node(const State& s, std::size_t n, const Corner& c, bool constrained,
                    bool deviates);
    void check_same_value(const Values& a, const Values& b, const std::string& both) const;
    void check_new_nodes(const State& s, const Rule& rule, std::vector<Corner>& nodes);
    bool deviates_from_mean(const Stencil& stencil, const std::vector<Corner>& nodes,
                            Real value) const;
    void check_positions(const State& s);
    void check_own_keys(const State& s, std::span<const NodeKey> own);
    void check_values(std::size_t step, const char* which, std::size_t n, const Values& value);
    void add_made(const Corner& node, const Stencil& stencil, const std::vector<Corner>& nodes);
    void check_hanging();
    void find_nodes_inside();
    void walk_regions(std::size_t i);
    void check_region(const State& s, const std::vector<Inside>& inside);
    void check_leaf(const State& s, const std::vector<Inside>& inside);
    void check_hanging_node(const State& leaf, const Made& made, bool interpolated);
    NodeKey place_of(const Weights& weights) const;

    const Grid& grid_;
    const Field& field_;
    const CheckOptions& options_;
    Context<Grid> context_;
    bool own_keys_ = false;
    CoarseElement<Element> coarse_;
    std::size_t coarse_number_ = 0;
    double size_ = 0;  // of the coarse element
    double largest_value_ = 0;
    std::vector<Step> steps_;
    std::set<const Rule*> rules_;
    std::map<std::uint64_t, std::pair<Point, std::size_t>> coarse_nodes_;
    std::map<Point, std::uint64_t> id_at_;  // of the first coarse corner there
    std::set<Point> several_ids_at_;
    KeyTable<NodeKey, int> coarse_faces_;
    KeyTable<NodeKey, Node> nodes_;      // by place
    KeyTable<NodeKey, Origin> origins_;  // of new nodes, by place
    std::vector<WeightedPoint> parents_;
    KeyTable<NodeKey, NodeKey> place_of_key_;
    std::vector<Made> made_;                              // parents first
    std::vector<std::vector<std::uint64_t>> coarse_ids_;  // of each coarse element
    std::vector<std::vector<std::size_t>> inside_;        // new nodes in it, by number in made_
    std::vector<Leaf> leaves_;
    HangingProbe probe_;
    HangingNodes hanging_;  // by derived keys
};

template <class Grid, class Field>
void GridChecker<Grid, Field>::note_operations(std::vector<std::string>& notes) const {
    const auto add = [&](const std::string& who, const std::vector<std::string>& names) {
        std::string list = names.empty() ? "none" : names[0];
        for (std::size_t i = 1; i < names.size(); ++i) list += ", " + names[i];
        notes.push_back("optional operations found in the " + who + ": " + list);
    };
    add("grid", offered_operations(grid_));
    add("field", offered_field_operations<Grid>(field_));
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_coarse(std::size_t i) {
    const CoarseElement<Element> c = call_coarse(grid_, context_, i);
    const std::string who = "coarse element " + std::to_string(i);
    const Topology& t = topology(c.shape);
    if (t.dimension != Grid::dimension) {
        fail(Law::coarse_element, who + " is a " + std::string(t.name) +
                                      " on a grid of dimension " + std::to_string(Grid::dimension));
    }
    if (only_ != Shape::point && c.shape != only_) {
        fail(Law::coarse_element, who + " is a " + std::string(t.name) + promised_);
    }
    for (std::size_t k = 0; k < t.corners; ++k) {
        if (!std::isfinite(norm(c.corners[k]))) {
            fail(Law::coarse_element,
                 who + " has a corner " + std::to_string(k) + " whose coordinates are not finite");
        }
        for (std::size_t j = 0; j < k; ++j) {
            if (c.ids[j] == c.ids[k]) {
                fail(Law::coarse_element,
                     who + " has the node " + std::to_string(c.ids[k]) + " at two of its corners");
            }
        }
    }
    for (std::size_t k = 0; k < t.corners; ++k) {
        const auto [at, is_new] = coarse_nodes_.insert({c.ids[k], {c.corners[k], i}});
        if (!is_new && at->second.first != c.corners[k]) {
            fail(Law::coarse_node,
                 "coarse node " + std::to_string(c.ids[k]) + " is at one place in coarse element " +
                     std::to_string(at->second.second) + " and at another in " + who);
        }
        const std::uint64_t id_there = id_at_.try_emplace(c.corners[k], c.ids[k]).first->second;
        if (id_there != c.ids[k]) several_ids_at_.insert(c.corners[k]);
    }
    const double volume = measure(c.shape, std::span(c.corners).first(t.corners));
    if (c.orientation != 1 && c.orientation != -1) {
        fail(Law::coarse_element, who + " has an orientation that is neither 1 nor -1");
    }
    if (!((t.dimension == 3 ? c.orientation * volume : volume) > 0)) {
        fail(Law::coarse_element, who + " is flat or inverted under its orientation sign" +
                                      (is_simplex(c.shape) ? "" : in_tensor_order));
    }
    for (std::size_t f = 0; f < t.faces; ++f) {
        NodeKey sum = 0;
        for (std::size_t k = 0; k < t.face[f].corners; ++k) {
            sum += coarse_key(c.ids[t.face[f].corner[k]]);
        }
        if (++*coarse_faces_.insert(mean_key(sum, t.face[f].corners), 0).first > 2) {
            fail(Law::coarse_face, "face " + std::to_string(f) + " of " + who +
                                       " belongs to more than two coarse elements");
        }
    }
}

/// \param both the two elements
template <class Grid, class Field>
void GridChecker<Grid, Field>::check_same_value(const Values& a, const Values& b,
                                                const std::string& both) const {
    for (std::size_t q = 0; q < components_; ++q) {
        const double off = std::abs(static_cast<double>(a[q]) - static_cast<double>(b[q]));
        if (off <= options_.node_value_tolerance * largest_value_) continue;
        fail(Law::value_unique, "the field gives one node two values, " + all_digits(b[q]) +
                                    " and " + all_digits(a[q]) + ": as " + both);
    }
}

template <class Grid, class Field>
NodeKey GridChecker<Grid, Field>::place_of(const Weights& weights) const {
    NodeKey sum = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(topology(coarse_.shape).corners); ++k) {
        const auto quantised = static_cast<std::uint64_t>(std::llround(weights[k] * 0x1p40));
        if (quantised != 0) sum += mix(coarse_key(coarse_.ids[k]) + quantised);
    }
    return mix(sum);
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_values(std::size_t step, const char* which, std::size_t n,
                                            const Values& value) {
    for (const Real v : value) {
        if (!std::isfinite(v)) {
            fail(Law::value_finite, "the field's value at " + std::string(which) + " " +
                                        std::to_string(n) + " of " + name(step) +
                                        " is not a finite number");
        }
        largest_value_ = std::max(largest_value_, std::abs(static_cast<double>(v)));
    }
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::walk_coarse(std::size_t i) {
    coarse_ = call_coarse(grid_, context_, i);
    coarse_number_ = i;
    const auto* ids = coarse_.ids.data();
    coarse_ids_.emplace_back(ids, ids + topology(coarse_.shape).corners);
    State s;
    s.element = coarse_.element;
    s.shape = coarse_.shape;
    s.level = 0;
    s.step = steps_.size();
    steps_.push_back({root_, i});
    if constexpr (may_offer<Grid>(Feature::masked)) {
        if (offers(grid_, Feature::masked) && call_masked(grid_, context_, s.element)) return;
    }
    const auto corners = static_cast<std::size_t>(topology(s.shape).corners);
    std::array<Real, max_corners * components_> value;
    const NodeMask missing = call_coarse_values(
        field_, context_, i, std::span<Real>(value.data(), corners * components_));
    if (missing != 0)
        fail(Law::value_present, "the field lacks a value at a corner of " + name(s.step));
    std::array<NodeKey, max_corners> own{};
    if constexpr (may_offer<Grid>(Feature::own_keys)) {
        if (own_keys_) {
            call_corner_keys(grid_, context_, s.element, std::span<NodeKey>(own.data(), corners));
        }
    }
    size_ = 0;
    for (std::size_t k = 0; k < corners; ++k) {
        Corner& c = s.corner[k];
        c.weights[k] = 1;
        c.place = place_of(c.weights);
        c.derived = coarse_key(coarse_.ids[k]);
        c.key = own_keys_ ? own[k] : c.derived;
        c.position = coarse_.corners[k];
        std::copy_n(value.begin() + static_cast<std::ptrdiff_t>(k * components_), components_,
                    c.value.begin());
        size_ = std::max(size_, norm(c.position - coarse_.corners[0]));
        check_values(s.step, "corner", k, c.value);
        check_node(s, k, c, false, false);
    }
    walk(s);
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_node(const State& s, std::size_t n, const Corner& c,
                                          bool constrained, bool deviates) {
    const std::string where = "node " + std::to_string(n) + " of " + name(s.step);
    if (const std::size_t count = dense_key_count(grid_); count > 0 && c.key >= count) {
        fail(Law::dense_key, "the key of " + where + " is not below node_count()");
    }
    Node fresh;
    fresh.key = c.key;
    fresh.element = s.step;
    fresh.value = c.value;
    fresh.constrained = constrained;
    fresh.deviates = deviates;
    const auto [node, is_new] = nodes_.insert(c.place, fresh);
    if (is_new) {
        const auto [place, key_is_new] = place_of_key_.insert(c.key, c.place);
        if (!key_is_new) {
            fail(Law::key_place, where + " has the key of a node at another place, made by " +
                                     name(nodes_.find(*place)->element));
        }
        return;
    }
    const std::string both = where + " and in " + name(node->element);
    if (node->key != c.key) fail(Law::one_stencil, "one node has two keys: as " + both);
    check_same_value(node->value, c.value, both);
    if (node->constrained != constrained) {
        fail(Law::hanging_mask, "one node is constrained and not constrained: as " + both);
    }
}

}  // namespace nestgrid::detail

#include <nestgrid/detail/check_grid_hanging.hpp>
#include <nestgrid/detail/check_grid_walk.hpp>
