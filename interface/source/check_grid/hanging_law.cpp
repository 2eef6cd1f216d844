// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Law of check_grid: hanging nodes.
//
// A node hangs on a leaf where it lies in it without being a corner. Such nodes are found by
// reference coordinates: when elements are shown again, each coarse element hands the nodes that
// lie in it down to the children that they lie in. So they are found whatever their keys and their
// parents are.
#include <algorithm>
#include <cmath>
#include <map>

#include <nestgrid/detail/hanging_probe.hpp>

#include "laws.hpp"
#include "nodes_in_elements.hpp"

namespace nestgrid::detail {

namespace {

/// A node that hangs on a leaf gets from its parents the value that the leaf has there; the grid
/// says that it hangs, where it says so of any.
class HangingLaw final : public GridLaw {
public:
    explicit HangingLaw(Inspection& inspection) : inspection_{&inspection} {}

    void visit(const Coarse& coarse, std::size_t /*i*/) override {
        coarse_ids_.emplace_back(coarse.ids.begin(),
                                 coarse.ids.begin() + topology(coarse.shape).corners);
    }
    void visit(const CheckedElement& element) override;
    void visit(const CheckedSplit& split) override;
    void visit(const MadeNode& made) override;
    void finish() override;
    void revisit(const CheckedElement& element) override;

private:
    struct Inside {  // a node in an element
        const HangingCandidate* node;
        Point at;  // in reference coordinates of the coarse element
    };
    struct Leaf {
        Shape shape;
        std::array<NodeKey, max_corners> keys;
    };

    bool deviates(double mean, double value) const;
    void take_given_parents();
    NodeKey place_of(NodeKey key, const HangingCandidate& child);
    void mark_hanging();
    void find_nodes_inside();
    std::vector<Inside> nodes_inside(const CheckedElement& coarse) const;
    void check_leaf(const CheckedElement& leaf, const std::vector<Inside>& inside);
    void check_node(const CheckedElement& leaf, const HangingCandidate& node, bool interpolated);

    Inspection* inspection_;
    std::vector<HangingCandidate> made_;                   // parents first, but for given ones
    std::vector<std::vector<std::uint64_t>> coarse_ids_;   // of each coarse element
    std::vector<std::vector<std::size_t>> inside_coarse_;  // of made_, in each coarse element
    std::vector<std::vector<Inside>> inside_;  // the element on each level of the way down
    std::vector<Leaf> leaves_;
    HangingProbe probe_;
    HangingNodes hanging_;
};

void HangingLaw::visit(const CheckedElement& element) {
    if (!element.is_leaf() || element.member->hidden == Hidden::wholly) return;
    Leaf leaf{element.shape, {}};
    const auto corners = element.corners();
    for (std::size_t k = 0; k < corners.size(); ++k) leaf.keys[k] = corners[k].key;
    leaves_.push_back(leaf);
}

void HangingLaw::visit(const CheckedSplit& split) {
    std::vector<NodeKey> keys;
    for (const CheckedNode& node : split.nodes) keys.push_back(node.key);
    const std::span<const NodeKey> all(keys);
    const std::size_t corners = split.father.corners().size();
    probe_.add_nodes(split.rule, all.first(corners), all.subspan(corners));
}

void HangingLaw::visit(const MadeNode& made) {
    if (made.stencil == nullptr) return;
    const KnownNode& known = inspection_->nodes()[made.known];
    if (known.constrained != made.constrained) {
        const std::string where =
            "node " + std::to_string(made.number) + " of " + inspection_->name(made.element.step);
        Inspection::fail(Law::hanging_mask, "one node is constrained and not constrained: as " +
                                                where + " and in " +
                                                inspection_->name(known.element));
    }
    if (!made.is_new) return;
    HangingCandidate node;
    node.known = made.known;
    node.place = made.node().place;
    node.coarse = made.element.coarse;
    node.weights = made.node().weights;
    node.parents = made.stencil->count;
    double mean = 0;
    for (std::size_t i = 0; i < node.parents; ++i) {
        const CheckedNode& parent = made.nodes[made.stencil->parent[i]];
        node.parent[i] = parent.place;
        node.weight[i] = made.stencil->weight[i];
        mean += node.weight[i] * parent.value;
    }
    node.deviates = deviates(mean, made.node().value);
    made_.push_back(node);
}

/// Whether the value at a node is not the mean of its parents.
bool HangingLaw::deviates(double mean, double value) const {
    return std::abs(mean - value) >
           inspection_->tolerance(4) * inspection_->nodes().largest_value();
}

void HangingLaw::finish() {
    take_given_parents();
    probe_.finish();
    for (const Leaf& leaf : leaves_) probe_.probe_leaf(leaf.shape, leaf.keys);
    hanging_ = probe_.take();
    mark_hanging();
    find_nodes_inside();
}

/// Puts the parents that the grid gives in the place of those in the rule.
void HangingLaw::take_given_parents() {
    if (!inspection_->offers(Feature::hanging_parents)) return;
    const KnownNodes& nodes = inspection_->nodes();
    for (HangingCandidate& node : made_) {
        const NodeKey key = nodes[node.known].key;
        const std::array<NodeKey, 2> given = inspection_->hierarchy().hanging_parents(key);
        if (given[0] == given[1]) continue;
        double mean = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            node.parent[i] = place_of(given[i], node);
            node.weight[i] = 0.5;
            mean += 0.5 * nodes.values(*nodes.find(node.parent[i]), 1)[0];
        }
        node.parents = 2;
        node.given = true;
        node.deviates = deviates(mean, nodes.values(node.known, 1)[0]);
        probe_.add_parents(key, {given[0], given[1]});
    }
}

/// The place of a parent that the grid gives.
NodeKey HangingLaw::place_of(NodeKey key, const HangingCandidate& child) {
    const KnownNodes& nodes = inspection_->nodes();
    const std::size_t* const parent = nodes.find_key(key);
    if (parent != nullptr) return nodes[*parent].place;
    Inspection::fail(Law::hanging_parents,
                     "hanging_parents gives a key of no node to a node made by " +
                         inspection_->name(nodes[child.known].element));
}

void HangingLaw::mark_hanging() {
    KnownNodes& nodes = inspection_->nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].hangs = nodes[i].constrained || hanging_.contains(nodes[i].key);
    }
}

/// The nodes that lie in each coarse element, by their weights over ids.
void HangingLaw::find_nodes_inside() {
    std::map<std::uint64_t, std::vector<std::size_t>> elements_at;
    for (std::size_t i = 0; i < coarse_ids_.size(); ++i) {
        for (const std::uint64_t id : coarse_ids_[i]) elements_at[id].push_back(i);
    }
    inside_coarse_.resize(coarse_ids_.size());
    for (std::size_t m = 0; m < made_.size(); ++m) {
        const HangingCandidate& node = made_[m];
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
                inside_coarse_[i].push_back(m);
            }
        }
    }
}

/// The nodes in a coarse element, parents first.
auto HangingLaw::nodes_inside(const CheckedElement& coarse) const -> std::vector<Inside> {
    const std::vector<std::uint64_t>& here = coarse_ids_[coarse.coarse];
    std::vector<Inside> inside;
    for (const std::size_t m : inside_coarse_[coarse.coarse]) {
        const HangingCandidate& node = made_[m];
        const std::vector<std::uint64_t>& ids = coarse_ids_[node.coarse];
        Inside x{&node, {0, 0, 0}};
        for (std::size_t k = 0; k < ids.size(); ++k) {
            if (node.weights[k] == 0) continue;
            const auto at = std::find(here.begin(), here.end(), ids[k]) - here.begin();
            x.at = x.at +
                   node.weights[k] * topology(coarse.shape).reference[static_cast<std::size_t>(at)];
        }
        inside.push_back(x);
    }
    return inside;
}

void HangingLaw::revisit(const CheckedElement& element) {
    const auto level = static_cast<std::size_t>(element.level);
    if (inside_.size() <= level) inside_.resize(level + 1);
    std::vector<Inside>& inside = inside_[level];
    if (level == 0) {
        inside = nodes_inside(element);
    } else {
        const ClosedRegion region(element);
        inside.clear();
        for (const Inside& x : inside_[level - 1]) {
            if (region.contains(x.at)) inside.push_back(x);
        }
    }
    if (element.is_leaf() && element.member->hidden != Hidden::wholly) check_leaf(element, inside);
}

void HangingLaw::check_leaf(const CheckedElement& leaf, const std::vector<Inside>& inside) {
    const auto corners = leaf.corners();
    std::vector<const HangingCandidate*> left;
    for (const Inside& x : inside) {
        if (std::none_of(corners.begin(), corners.end(),
                         [&](const CheckedNode& c) { return c.place == x.node->place; })) {
            left.push_back(x.node);
        }
    }
    if (left.empty()) return;
    LeafNodes nodes(leaf);
    while (!left.empty()) {
        // Parents that the grid gives may be made later than the node.
        const auto next = std::find_if(left.begin(), left.end(), [&](const HangingCandidate* node) {
            return nodes.has_parents(*node);
        });
        const bool interpolated = next != left.end() && nodes.add(**next);
        check_node(leaf, next == left.end() ? *left.front() : **next, interpolated);
        left.erase(next);
    }
}

/// \param interpolated whether its stencil gives the value that the leaf has there
void HangingLaw::check_node(const CheckedElement& leaf, const HangingCandidate& node,
                            bool interpolated) {
    const KnownNode& known = inspection_->nodes()[node.known];
    const std::string who = "a node made by " + inspection_->name(known.element) + " hangs on " +
                            inspection_->name(leaf.step);
    if (inspection_->facts().conforming) {
        Inspection::fail(Law::conforming, who + ", but the grid says that it is conforming");
    }
    if (!node.given) {
        inspection_->finish_hanging(node.place,
                                    "; it hangs, and the grid does not give its parents");
    }
    if (!interpolated) {
        Inspection::fail(
            Law::hanging_parents,
            who +
                ", but its parents do not give it the value that it has there: refine both sides "
                "of a face in the same order, or each in its own direction only");
    }
    const bool grid_knows = inspection_->offers(Feature::constrained);
    if (grid_knows && !known.constrained) {
        Inspection::fail(Law::hanging_mask, who + ", but is not in the constrained mask");
    }
    if (!grid_knows && !hanging_.contains(known.key)) {
        Inspection::fail(Law::hanging_parents,
                         who +
                             " at another place than the middle of an edge or face, and "
                             "the grid does not offer 'constrained'");
    }
    if (inspection_->options().hanging_values && node.deviates && known.seen) {
        Inspection::fail(Law::hanging_value, who + ", but its value is not its interpolant");
    }
}

}  // namespace

GridLawPointer hanging_law(Inspection& inspection) {
    return std::make_unique<HangingLaw>(inspection);
}

}  // namespace nestgrid::detail
