// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Patterns: how an element is refined, as the economical store sees it.
//
// A pattern is a rule, or a tree of rules that span several levels (a patch of bisections). Its
// leaves are its exits.
// Invariants:
//   - every new node lies in one entity of the refined element: inside an edge, a quadrilateral
//     face or the element itself, and at most one in each;
//   - the entities of all exits are numbered together, those shared by two exits once.
// Consequence: a set of entities says which nodes are made by the refinement of all exits, each
// named once although several exits share it.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// Entities of a shape that can carry a new node: edges, quadrilateral faces (in three
/// dimensions), the element itself.
inline constexpr int max_entities = 128;

/// How a rule's new node is recognised on the elements that share it.
struct NodeRecipe {
    enum class Kind : std::uint8_t { edge, face, cell };
    Kind kind = Kind::edge;
    /// Nodes of the rule: the two ends; the midpoints of two opposite edges, then of the other
    /// two; the first and the last corner.
    std::array<std::uint8_t, 4> of{};
};

/// A rule of a family, named by a number that means the same in every file and process.
struct StoredRule {
    std::uint64_t descriptor = 0;
    std::shared_ptr<const Rule> rule;
    bool temporary = false;  ///< made by the closure: its children are never refined
    std::vector<NodeRecipe> nodes;
    std::vector<std::uint8_t> carrier;  ///< corners that each new node depends on, one bit each
};

/// The elements between a refined element and its children, as a tree.
struct Pattern {
    struct Target {
        bool exit = false;
        std::uint8_t number = 0;  ///< of the exit or of the inner element
    };
    struct Inner {
        std::uint16_t rule = 0;
        std::vector<std::uint8_t> entity;  ///< of the refined element, for each new node
        std::vector<Target> child;
    };
    struct Exit {
        Shape shape = Shape::point;
        std::vector<std::uint8_t> entity;  ///< number in the pattern, for each of the shape's
    };

    Shape shape = Shape::point;
    std::vector<std::uint16_t> tree;        ///< rules in preorder, 0 for an exit
    std::vector<Inner> inner;               ///< in preorder
    std::vector<Exit> exits;                ///< in preorder
    std::vector<std::uint8_t> node_entity;  ///< entity of each new node
    int entity_count = 0;                   ///< of all exits together

    std::size_t code_words() const { return (exits.size() + 1) / 2; }
    std::size_t mask_words() const { return static_cast<std::size_t>(entity_count + 31) / 32; }
};

/// Rules and patterns a grid has met. Pattern number s, below shape_count, is the unrefined shape
/// s itself, with one exit: the parent of the coarse elements.
class PatternTable {
public:
    PatternTable();

    /// Number of a rule; new ones are added by `make()`, which returns the rule.
    template <class Make>
    std::uint16_t rule(std::uint64_t descriptor, bool temporary, Make&& make) {
        const auto found = rule_number_.find(descriptor);
        if (found != rule_number_.end()) return found->second;
        return add_rule(descriptor, temporary, make());
    }

    /// Number of the pattern with a tree of rules in preorder.
    std::uint16_t pattern(const std::vector<std::uint16_t>& tree);

    const StoredRule& rule(std::size_t number) const { return rules_[number]; }
    const Pattern& operator[](std::size_t number) const { return patterns_[number]; }
    std::size_t rule_count() const { return rules_.size(); }
    std::size_t size() const { return patterns_.size(); }

private:
    std::uint16_t add_rule(std::uint64_t descriptor, bool temporary,
                           std::shared_ptr<const Rule> rule);

    std::vector<StoredRule> rules_;  // number 0 is no rule
    std::vector<Pattern> patterns_;
    std::map<std::uint64_t, std::uint16_t> rule_number_;
    std::map<std::vector<std::uint16_t>, std::uint16_t> pattern_number_;
    KeyTable<std::uint64_t, std::uint16_t> short_number_;  // of small trees
};

}  // namespace nestgrid
