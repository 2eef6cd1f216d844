// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/pattern.hpp>

#include <algorithm>

namespace nestgrid {

namespace {

/// The corners of every entity of a shape, one bit each.
std::vector<std::uint8_t> entities(Shape shape) {
    const Topology& t = topology(shape);
    std::vector<std::uint8_t> result;
    for (std::size_t e = 0; e < t.edges; ++e) {
        result.push_back(static_cast<std::uint8_t>(1U << t.edge[e][0] | 1U << t.edge[e][1]));
    }
    for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
        if (t.face[f].corners != 4) continue;
        unsigned corners = 0;
        for (const std::uint8_t c : t.face[f].corner) corners |= 1U << c;
        result.push_back(static_cast<std::uint8_t>(corners));
    }
    if (!is_simplex(shape)) result.push_back(static_cast<std::uint8_t>((1U << t.corners) - 1U));
    return result;
}

std::uint8_t entity_of(Shape shape, std::uint8_t corners) {
    const std::vector<std::uint8_t> all = entities(shape);
    const auto found = std::find(all.begin(), all.end(), corners);
    if (found == all.end()) throw GridError("a new node lies in no edge, face or element");
    return static_cast<std::uint8_t>(found - all.begin());
}

/// Puts a pattern together from a tree of rules.
class PatternBuilder {
public:
    PatternBuilder(const std::vector<StoredRule>& rules, const std::vector<std::uint16_t>& tree)
        : rules_{rules}, tree_{tree} {
        pattern_.tree = tree;
    }

    Pattern build(Shape shape) {
        pattern_.shape = shape;
        corners_ = topology(shape).corners;
        std::vector<std::uint8_t> corner;
        for (unsigned i = 0; i < corners_; ++i) {
            corner.push_back(static_cast<std::uint8_t>(i));
            carrier_.push_back(static_cast<std::uint8_t>(1U << i));
        }
        add(shape, corner, false);
        if (at_ != tree_.size()) throw GridError("a tree of rules has branches left over");
        if (numbers_.size() > static_cast<std::size_t>(max_entities)) {
            throw GridError("a pattern has too many entities");
        }
        pattern_.entity_count = static_cast<int>(numbers_.size());
        return std::move(pattern_);
    }

private:
    Pattern::Target add(Shape shape, const std::vector<std::uint8_t>& corner, bool temporary) {
        if (at_ == tree_.size()) throw GridError("a tree of rules ends too early");
        const std::uint16_t number = tree_[at_++];
        if (number == 0) return add_exit(shape, corner, temporary);
        const StoredRule& stored = rules_.at(number);
        const Rule& rule = *stored.rule;
        if (rule.parent != shape || temporary) {
            throw GridError("the rule '" + rule.name + "' refines another shape");
        }
        const std::size_t place = pattern_.inner.size();
        pattern_.inner.emplace_back();
        pattern_.inner[place].rule = number;
        std::vector<std::uint8_t> nodes = corner;
        for (std::size_t k = 0; k < rule.new_nodes.size(); ++k) {
            unsigned on = 0;
            for (std::size_t i = 0; i < corner.size(); ++i) {
                if ((stored.carrier[k] >> i & 1U) != 0) on |= carrier_[corner[i]];
            }
            const std::uint8_t entity = entity_of(pattern_.shape, static_cast<std::uint8_t>(on));
            auto& known = pattern_.node_entity;
            const auto found = std::find(known.begin(), known.end(), entity);
            const auto node = static_cast<std::uint8_t>(found - known.begin());
            if (found == known.end()) {
                if (carrier_.size() == 64) throw GridError("a pattern has too many nodes");
                known.push_back(entity);
                carrier_.push_back(static_cast<std::uint8_t>(on));
            }
            pattern_.inner[place].entity.push_back(entity);
            nodes.push_back(static_cast<std::uint8_t>(corners_ + node));
        }
        for (const Child& child : rule.children) {
            std::vector<std::uint8_t> of_child;
            for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
                of_child.push_back(nodes[child.corner[i]]);
            }
            const Pattern::Target target = add(child.shape, of_child, stored.temporary);
            pattern_.inner[place].child.push_back(target);
        }
        return {false, static_cast<std::uint8_t>(place)};
    }

    Pattern::Target add_exit(Shape shape, const std::vector<std::uint8_t>& corner, bool temporary) {
        Pattern::Exit exit{shape, {}};
        const std::size_t number = pattern_.exits.size();
        for (const std::uint8_t corners : entities(shape)) {
            if (temporary) break;
            std::uint64_t nodes = 0;
            for (std::size_t i = 0; i < corner.size(); ++i) {
                if ((corners >> i & 1U) != 0) nodes |= std::uint64_t{1} << corner[i];
            }
            const auto next = static_cast<std::uint8_t>(numbers_.size());
            exit.entity.push_back(numbers_.emplace(nodes, next).first->second);
        }
        pattern_.exits.push_back(std::move(exit));
        return {true, static_cast<std::uint8_t>(number)};
    }

    const std::vector<StoredRule>& rules_;
    const std::vector<std::uint16_t>& tree_;
    std::size_t at_ = 0;
    std::size_t corners_ = 0;
    std::vector<std::uint8_t> carrier_;              // of every node of the pattern
    std::map<std::uint64_t, std::uint8_t> numbers_;  // of entities, by their nodes
    Pattern pattern_;
};

NodeRecipe recipe_of(const Rule& rule, const Stencil& stencil) {
    NodeRecipe recipe;
    if (stencil.count == 2) {
        recipe.of = {stencil.parent[0], stencil.parent[1], 0, 0};
        return recipe;
    }
    if (stencil.count == 8) {
        recipe.kind = NodeRecipe::Kind::cell;
        recipe.of = {0, static_cast<std::uint8_t>(rule.corner_count() - 1), 0, 0};
        return recipe;
    }
    recipe.kind = NodeRecipe::Kind::face;
    // Parents of a face stand in tensor order: its edges are 01, 23 and 02, 13.
    constexpr std::array<std::array<std::size_t, 2>, 4> edge{{{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::uint8_t a = stencil.parent[edge[i][0]];
        const std::uint8_t b = stencil.parent[edge[i][1]];
        for (std::size_t k = 0; k < rule.new_nodes.size(); ++k) {
            const Stencil& s = rule.new_nodes[k];
            if (s.count == 2 && std::minmax(s.parent[0], s.parent[1]) == std::minmax(a, b)) {
                recipe.of[i] = static_cast<std::uint8_t>(rule.corner_count() + static_cast<int>(k));
            }
        }
        if (recipe.of[i] == 0) throw GridError("a face is refined without its edges");
    }
    return recipe;
}

}  // namespace

PatternTable::PatternTable() : rules_(1) {
    const std::vector<std::uint16_t> exit{0};
    for (int s = 0; s < shape_count; ++s) {
        patterns_.push_back(PatternBuilder(rules_, exit).build(static_cast<Shape>(s)));
    }
}

std::uint16_t PatternTable::add_rule(std::uint64_t descriptor, bool temporary,
                                     std::shared_ptr<const Rule> rule) {
    StoredRule stored{descriptor, std::move(rule), temporary, {}, {}};
    const Rule& r = *stored.rule;
    std::vector<std::uint8_t> carrier;
    for (int i = 0; i < r.corner_count(); ++i) {
        carrier.push_back(static_cast<std::uint8_t>(1U << static_cast<unsigned>(i)));
    }
    for (const Stencil& s : r.new_nodes) {
        unsigned on = 0;
        for (std::size_t i = 0; i < s.count; ++i) on |= carrier[s.parent[i]];
        carrier.push_back(static_cast<std::uint8_t>(on));
        stored.nodes.push_back(recipe_of(r, s));
    }
    stored.carrier.assign(carrier.begin() + r.corner_count(), carrier.end());
    rules_.push_back(std::move(stored));
    const auto number = static_cast<std::uint16_t>(rules_.size() - 1);
    rule_number_.emplace(descriptor, number);
    return number;
}

namespace {

/// A tree of one rule, or of at most 15 entries below 16, as one number; 0 for others.
std::uint64_t short_name(const std::vector<std::uint16_t>& tree) {
    if (std::all_of(tree.begin() + 1, tree.end(), [](std::uint16_t r) { return r == 0; })) {
        return std::uint64_t{1} << 63U | tree[0];
    }
    if (tree.size() > 15) return 0;
    std::uint64_t name = 1;
    for (const std::uint16_t rule : tree) {
        if (rule >= 16) return 0;
        name = name << 4U | rule;
    }
    return name;
}

}  // namespace

std::uint16_t PatternTable::pattern(const std::vector<std::uint16_t>& tree) {
    const std::uint64_t name = short_name(tree);
    if (name != 0) {
        if (const std::uint16_t* known = short_number_.find(name)) return *known;
    }
    const auto found = pattern_number_.find(tree);
    if (found != pattern_number_.end()) return found->second;
    if (patterns_.size() >= 0x8000) throw GridError("too many patterns of refinement");
    const Shape shape = rules_.at(tree.at(0)).rule->parent;
    patterns_.push_back(PatternBuilder(rules_, tree).build(shape));
    const auto number = static_cast<std::uint16_t>(patterns_.size() - 1);
    pattern_number_.emplace(tree, number);
    if (name != 0) short_number_.insert(name, number);
    return number;
}

}  // namespace nestgrid
