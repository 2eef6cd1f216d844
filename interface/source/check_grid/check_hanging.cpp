// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// check_grid: hanging nodes.
//
// A node hangs on a leaf where it lies in it without being a corner. Such nodes are found by
// reference coordinates: each coarse element hands the nodes that lie in it down to the children
// that they lie in. So they are found whatever their keys and their parents are.
#include <algorithm>
#include <cmath>

#include <nestgrid/detail/shape_functions.hpp>

#include "grid_checker.hpp"

namespace nestgrid::detail {

namespace {

/// An element with flat faces, its boundary included.
class ClosedRegion {
public:
    /// \param x the corners
    ClosedRegion(Shape shape, std::span<const Point> x) {
        const Topology& t = topology(shape);
        Point middle{0, 0, 0};
        for (std::size_t k = 0; k < t.corners; ++k) middle = middle + (1.0 / t.corners) * x[k];
        for (std::size_t f = 0; f < t.faces; ++f) {
            const auto& c = t.face[f].corner;
            const Point along = x[c[1]] - x[c[0]];
            const Point normal = t.dimension == 1   ? x[1] - x[0]
                                 : t.dimension == 2 ? Point{along[1], -along[0], 0}
                                                    : cross(along, x[c[2]] - x[c[0]]);
            const double height = dot(normal, middle - x[c[0]]);
            sides_.push_back({(1 / height) * normal, x[c[0]]});
        }
    }

    bool contains(const Point& x) const {
        return std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
            return dot(side.inwards, x - side.corner) >= -1e-9;
        });
    }

private:
    struct Side {
        Point inwards;  // as long as makes the distance of the element's middle 1
        Point corner;
    };
    std::vector<Side> sides_;
};

}  // namespace

/// The nodes that lie in each coarse element, by their weights over ids.
void GridChecker::find_nodes_inside() {
    std::map<std::uint64_t, std::vector<std::size_t>> elements_at;
    for (std::size_t i = 0; i < coarse_ids_.size(); ++i) {
        for (const std::uint64_t id : coarse_ids_[i]) elements_at[id].push_back(i);
    }
    inside_.resize(coarse_ids_.size());
    for (std::size_t m = 0; m < made_.size(); ++m) {
        const Made& node = made_[m];
        const std::vector<std::uint64_t>& ids = coarse_ids_[node.coarse];
        std::vector<std::uint64_t> around;
        for (std::size_t k = 0; k < ids.size(); ++k) {
            if (node.weights[k] != 0) around.push_back(ids[k]);
        }
        for (const std::size_t i : elements_at[around.front()]) {
            const auto& of = coarse_ids_[i];
            if (std::all_of(around.begin(), around.end(), [&](std::uint64_t id) {
                    return std::find(of.begin(), of.end(), id) != of.end();
                })) {
                inside_[i].push_back(m);
            }
        }
    }
}

void GridChecker::walk_regions(std::size_t i) {
    State s = coarse_state(i);
    if (is_masked(coarse_family_, 0)) return;
    const Topology& t = topology(s.shape);
    for (std::size_t k = 0; k < t.corners; ++k) s.corner[k].position = t.reference[k];
    std::vector<Inside> inside;
    for (const std::size_t m : inside_[i]) {
        const Made& node = made_[m];
        Inside x{m, {0, 0, 0}};
        for (std::size_t k = 0; k < coarse_ids_[node.coarse].size(); ++k) {
            if (node.weights[k] == 0) continue;
            const auto* at =
                std::find(coarse_.ids.begin(), coarse_.ids.end(), coarse_ids_[node.coarse][k]);
            x.at = x.at + node.weights[k] *
                              t.reference[static_cast<std::size_t>(at - coarse_.ids.begin())];
        }
        inside.push_back(x);
    }
    check_region(s, inside);
}

/// \param inside the nodes that lie in the element, parents first
void GridChecker::check_region(const State& s, const std::vector<Inside>& inside) {
    const Rule* const rule = s.member->rule;
    if (met_ == rule_of_.size() || rule_of_[met_++] != rule) {
        fail(Law::split_repeats, "split() gives another rule when asked again in " + name(s.step));
    }
    if (rule == nullptr) {
        if (s.member->hidden == Hidden::wholly) return;
        check_leaf(s, inside);
        return check_degree(s);
    }
    std::vector<Corner> nodes(s.corner.begin(), s.corner.begin() + topology(s.shape).corners);
    for (std::size_t n = 0; n < rule->new_nodes.size(); ++n) make_node(*rule, n, nodes);
    Family& children = frame(s.level).children;
    hierarchy_->enter(task_.get(), s.member->element, *rule, 0, nullptr, ~NodeMask{0}, children);
    for (std::size_t k = 0; k < rule->children.size(); ++k) {
        if (is_masked(children, k)) continue;
        const State next = child_state(s, k, nodes);
        std::vector<Point> places;
        for (std::size_t i = 0; i < topology(next.shape).corners; ++i) {
            places.push_back(next.corner[i].position);
        }
        const ClosedRegion region(next.shape, places);
        std::vector<Inside> in_child;
        std::copy_if(inside.begin(), inside.end(), std::back_inserter(in_child),
                     [&](const Inside& x) { return region.contains(x.at); });
        check_region(next, in_child);
    }
}

/// The weights of a leaf's corners at the nodes in it, as far as these follow from stencils.
class GridChecker::LeafNodes {
public:
    explicit LeafNodes(const State& leaf) : shape_{leaf.shape} {
        for (std::size_t k = 0; k < topology(shape_).corners; ++k) {
            Weights corner{};
            corner[k] = 1;
            known_.insert(leaf.corner[k].place, corner);
        }
    }
    bool has(NodeKey place) const { return known_.find(place) != nullptr; }
    bool has_parents(const Made& node) const {
        const auto parents = std::span(node.parent).first(node.parents);
        return std::ranges::all_of(parents, [&](NodeKey place) { return has(place); });
    }
    /// Requires its parents.
    /// \return whether its value is that of the leaf's shape functions
    bool add(const Made& node) {
        Weights weights{};
        for (std::size_t p = 0; p < node.parents; ++p) {
            const Weights* parent = known_.find(node.parent[p]);
            for (std::size_t k = 0; k < max_corners; ++k) {
                weights[k] += node.weight[p] * (*parent)[k];
            }
        }
        Point at{0, 0, 0};
        const Topology& t = topology(shape_);
        for (std::size_t k = 0; k < t.corners; ++k) at = at + weights[k] * t.reference[k];
        const Weights wanted = shape_functions(shape_, at);
        for (std::size_t k = 0; k < t.corners; ++k) {
            if (std::abs(wanted[k] - weights[k]) > 1e-9) return false;
        }
        known_.insert(node.place, weights);
        return true;
    }

private:
    Shape shape_;
    KeyTable<NodeKey, Weights> known_;  // by place
};

void GridChecker::check_leaf(const State& s, const std::vector<Inside>& inside) {
    const auto* const end = s.corner.begin() + topology(s.shape).corners;
    const auto hangs = [&](const Inside& x) {
        return std::none_of(s.corner.begin(), end,
                            [&](const Corner& c) { return c.place == made_[x.node].place; });
    };
    if (std::none_of(inside.begin(), inside.end(), hangs)) return;
    LeafNodes nodes(s);
    std::vector<const Made*> left;
    for (const Inside& x : inside) {
        if (hangs(x)) left.push_back(&made_[x.node]);
    }
    while (!left.empty()) {
        // Parents that the grid gives may be made later than the node.
        const auto next =
            std::ranges::find_if(left, [&](const Made* made) { return nodes.has_parents(*made); });
        const bool interpolated = next != left.end() && nodes.add(**next);
        check_hanging_node(s, next == left.end() ? *left.front() : **next, interpolated);
        left.erase(next);
    }
}

/// \param interpolated whether its stencil gives the value that the leaf has there
void GridChecker::check_hanging_node(const State& leaf, const Made& made, bool interpolated) {
    const Node& node = *nodes_.find(made.place);
    const std::string who = "a node made by " + name(node.element) + " hangs on " + name(leaf.step);
    if (hierarchy_->facts().conforming) {
        fail(Law::conforming, who + ", but the grid says that it is conforming");
    }
    if (const auto two = two_stencils_.find(made.place);
        two != two_stencils_.end() && !made.given) {
        fail(Law::one_stencil, two->second + "; it hangs, and the grid does not give its parents");
    }
    if (!interpolated) {
        fail(Law::hanging_parents,
             who +
                 ", but its parents do not give it the value that it has there: refine both sides "
                 "of a face in the same order, or each in its own direction only");
    }
    const bool grid_knows = hierarchy_->offers(Feature::constrained);
    if (grid_knows && !node.constrained) {
        fail(Law::hanging_mask, who + ", but is not in the constrained mask");
    }
    if (!grid_knows && !hanging_.contains(made.key)) {
        fail(Law::hanging_parents, who +
                                       " at another place than the middle of an edge or face, and "
                                       "the grid does not offer 'constrained'");
    }
    if (options_->hanging_values && node.deviates && is_seen(made.place)) {
        fail(Law::hanging_value, who + ", but its value is not its interpolant");
    }
}

/// Puts the parents that the grid gives in the place of those in the rule.
void GridChecker::take_given_parents() {
    if (!hierarchy_->offers(Feature::hanging_parents)) return;
    for (Made& made : made_) {
        const std::array<NodeKey, 2> given = hierarchy_->hanging_parents(made.key);
        if (given[0] == given[1]) continue;
        Node& node = *nodes_.find(made.place);
        double mean = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            const NodeKey* parent = place_of_key_.find(given[i]);
            if (parent == nullptr) {
                fail(Law::hanging_parents,
                     "hanging_parents gives a key of no node to a node made by " +
                         name(node.element));
            }
            made.parent[i] = *parent;
            made.weight[i] = 0.5;
            mean += 0.5 * values_[nodes_.find(*parent)->first];
        }
        made.parents = 2;
        made.given = true;
        node.deviates = deviates(mean, values_[node.first]);
        probe_.add_parents(made.key, {given[0], given[1]});
    }
}

void GridChecker::check_hanging() {
    take_given_parents();
    probe_.finish();
    for (const Leaf& leaf : leaves_) probe_.probe_leaf(leaf.shape, leaf.keys);
    hanging_ = probe_.take();
    find_nodes_inside();
    for (std::size_t i = 0; i < inside_.size(); ++i) walk_regions(i);
}

}  // namespace nestgrid::detail
