// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The checks of check_grid, over any Hierarchy.
//
// The first walk compares every node with what is known of its place. The second one hands the
// nodes that lie in an element down to the children that they lie in, and checks those that hang on
// a leaf; it also checks that the hierarchy answers as it did before.
//
// Arrays that a grid or field fills have room for any rule: one that mistakes its rule for another
// is named, and writes nowhere else.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>

#include <nestgrid/check_grid.hpp>
#include <nestgrid/detail/hanging_probe.hpp>
#include <nestgrid/detail/union_find.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::detail {

class GridChecker {
public:
    /// Hierarchy and options are borrowed.
    /// \param epsilon of the type that the field has
    GridChecker(const Hierarchy<double>& hierarchy, double epsilon, const CheckOptions& options)
        : hierarchy_{&hierarchy},
          epsilon_{epsilon},
          options_{&options},
          components_{static_cast<std::size_t>(hierarchy.facts().components)},
          own_keys_{hierarchy.offers(Feature::own_keys)},
          task_{hierarchy.open()},
          pieces_(hierarchy.coarse_count()) {}

    std::optional<GridViolation> run();

private:
    using Weights = std::array<double, max_corners>;  // over the corners of the coarse element

    struct Found {
        GridViolation violation;
    };
    struct FaceUse {
        int count;              // of coarse elements that have the face
        std::uint32_t element;  // the first one
    };
    struct Corner {
        Weights weights{};
        NodeKey place = 0;  // hash of the weights over coarse ids
        NodeKey key = 0;    // own one, where the grid has such; else the derived one
        Point position{};   // by the rules
        double value = 0;   // of component 0
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
        std::size_t first = 0;    // of its values in values_
        bool constrained = false;
        bool deviates = false;  // from its interpolant
        bool has_position = false;
        Point own_position{};
    };
    struct WeightedPoint {
        double weight;
        Point x;
    };
    struct Step {  // the way to an element
        std::size_t father;
        std::size_t number;
    };
    struct Made {  // a new node, by what made it first
        NodeKey place = 0;
        NodeKey key = 0;
        std::size_t coarse = 0;  // number of the coarse element that the weights are of
        Weights weights{};
        std::size_t parents = 0;
        std::array<NodeKey, max_corners> parent{};  // places
        std::array<double, max_corners> weight{};
        bool given = false;  // parents by the grid, not by the rule
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
        const Member* member;
        const Family* family;  // that it is a member of
        Shape shape;
        std::size_t step;
        int level;
        std::array<Corner, max_corners> corner;
    };
    /// The split of an element on one level of the way down.
    struct Frame {
        Family children;
        std::vector<double> value;  // at the corners and new nodes
    };
    static constexpr std::size_t root_ = ~std::size_t{0};

    [[noreturn]] static void fail(Law law, const std::string& sentence) {
        throw Found{{law, sentence}};
    }
    std::string name(std::size_t step) const;
    std::string promise() const;
    static bool is_masked(const Family& family, std::size_t member) {
        return ((family.split | family.leaves) >> member & 1U) == 0;
    }
    Frame& frame(int level) {
        while (frames_.size() <= static_cast<std::size_t>(level)) frames_.emplace_back();
        return frames_[static_cast<std::size_t>(level)];
    }

    // Coarse elements (check_coarse.cpp).
    void check_coarse(std::size_t i);
    void check_corners(const std::string& who);
    void check_ids() const;
    void note_pieces();
    void check_contacts();

    // Coarse elements on the way down, and nodes (grid_checker.cpp).
    State coarse_state(std::size_t i);
    void walk_coarse(std::size_t i);
    NodeKey place_of(const Weights& weights) const;
    void check_node(const State& s, std::size_t n, const Corner& c, std::span<const double> values,
                    bool constrained, bool deviates);
    std::optional<std::size_t> find_other_value(const Node& node,
                                                std::span<const double> values) const;
    void check_values(std::size_t step, const char* which, std::size_t n, NodeKey place,
                      std::span<const double> values);
    void fail_unless_hidden(NodeKey place, Law law, const std::string& sentence);
    void check_seen_values() const;
    bool is_seen(NodeKey place) const { return seen_.find(place) != nullptr; }

    // Splits (check_splits.cpp).
    void walk(const State& s);
    void walk_children(const State& s, const std::vector<Corner>& nodes);
    State child_state(const State& s, std::size_t child, const std::vector<Corner>& nodes);
    void check_leaf_state(const State& s);
    void check_rule(const State& s, const Rule& rule);
    void check_missing(const State& s, const Rule& rule, NodeMask missing,
                       std::vector<Corner> nodes);
    void make_node(const Rule& rule, std::size_t n, std::vector<Corner>& nodes) const;
    void check_stencil(const State& s, const Rule& rule, std::size_t n,
                       const std::vector<Corner>& nodes);
    void put_corner_values(const State& s, Frame& frame) const;
    void check_new_nodes(const State& s, const Rule& rule, std::span<const double> values,
                         std::vector<Corner>& nodes);
    bool deviates(double mean, double value) const;
    bool deviates_from_mean(const Stencil& stencil, const std::vector<Corner>& nodes) const;
    void check_own(const State& s);
    void check_hidden(const State& s);
    void check_presence(const State& s);
    NodeMask values_that_count(std::span<double> values, NodeMask missing) const;
    void add_made(const Corner& node, const Stencil& stencil, const std::vector<Corner>& nodes);

    // Hanging nodes (check_hanging.cpp).
    void check_hanging();
    void take_given_parents();
    void find_nodes_inside();
    void walk_regions(std::size_t i);
    void check_region(const State& s, const std::vector<Inside>& inside);
    void check_leaf(const State& s, const std::vector<Inside>& inside);
    void check_hanging_node(const State& leaf, const Made& made, bool interpolated);

    // Leaves of higher degree (check_degree.cpp).
    void check_degree(const State& leaf);
    void check_corner_values(const State& leaf);
    void check_line(const State& leaf, int degree, Point from, std::size_t axis, double length);

    const Hierarchy<double>* hierarchy_;
    double epsilon_;
    const CheckOptions* options_;
    std::size_t components_;
    bool own_keys_;
    std::unique_ptr<Task> task_;
    Coarse coarse_;
    Family coarse_family_;
    std::size_t coarse_number_ = 0;
    double size_ = 0;  // of the coarse element
    double largest_value_ = 0;
    std::deque<Frame> frames_;
    std::vector<Step> steps_;
    std::vector<const Rule*> rule_of_;  // of the elements, in the order of the first walk
    std::size_t met_ = 0;               // elements that the second walk has met
    std::set<const Rule*> rules_;
    std::map<std::uint64_t, std::pair<Point, std::size_t>> coarse_nodes_;
    std::map<Point, std::uint64_t> id_at_;  // of the first coarse corner there
    std::set<Point> several_ids_at_;
    KeyTable<NodeKey, FaceUse> coarse_faces_;
    UnionFind pieces_;                   // coarse elements that share faces
    KeyTable<NodeKey, Node> nodes_;      // by place
    std::vector<double> values_;         // all components of each node
    KeyTable<NodeKey, Origin> origins_;  // of new nodes, by place
    std::vector<WeightedPoint> parents_;
    std::map<NodeKey, std::string> two_stencils_;  // sentences by place, where the grid may give
                                                   // parents
    KeyTable<NodeKey, NodeKey> place_of_key_;
    std::vector<Made> made_;                              // parents first
    std::vector<std::vector<std::uint64_t>> coarse_ids_;  // of each coarse element
    std::vector<std::vector<std::size_t>> inside_;        // new nodes in it, by number in made_
    std::vector<Leaf> leaves_;
    HangingProbe probe_;
    HangingNodes hanging_;
    // What is wrong with values at places, unless hidden leaves alone have them; in order.
    std::vector<std::pair<NodeKey, GridViolation>> unless_hidden_;
    KeyTable<NodeKey, bool> seen_;  // places of the corners of leaves that are not hidden
};

}  // namespace nestgrid::detail
