// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the adapter of Dune knows of UGGrid (Bastian et al. 1997).
//
// UG computes geometryInFather by searching; it costs about a microsecond a child. But each of its
// nodes says what it was made from: a node, an edge, a side or the inside of an element one level
// coarser. The rule of an element is therefore found by what the corners of its children were made
// from, and by geometryInFather only where that is met for the first time.
#pragma once

#include <cmath>
#include <optional>

#include <nestgrid/adapters/dune_rules.hpp>

namespace Dune {
template <int dim>
class UGGrid;
template <int dim>
class UG_NS;
template <int codim, int dim, class GridImp>
class UGGridEntity;
}  // namespace Dune

namespace nestgrid {

namespace detail {

template <int dim>
class UGRules {
public:
    using Element = typename Dune::UGGrid<dim>::template Codim<0>::Entity;

    void add(const Element& e, std::span<const Element> children,
             std::vector<PlacedChild>& placed) {
        const std::optional<NodeKey> made = origin(e, children);
        if (made && by_origin_.find(*made) != nullptr) return;
        const Rule& rule = rules_.add(e, children, placed);
        if (made) by_origin_.insert(*made, &rule);
    }
    /// Null where there was no such rule.
    const Rule* find(const Element& e, std::span<const Element> children,
                     std::vector<PlacedChild>& placed) const {
        const std::optional<NodeKey> made = origin(e, children);
        if (!made) return rules_.find(e, children, placed);
        const Rule* const* const rule = by_origin_.find(*made);
        return rule == nullptr ? nullptr : *rule;
    }
    const RuleTable& table() const { return rules_.table(); }

private:
    using UG = Dune::UG_NS<dim>;
    using UGElement = typename UG::Element;
    using UGNode = typename UG::Node;
    enum NodeType : unsigned { corner, middle, side, centre };  // as UG numbers them

    /// Hash of what the corners of the children were made from, where all of them tell.
    static std::optional<NodeKey> origin(const Element& e, std::span<const Element> children) {
        const UGElement* const father = e.impl().getTarget();
        NodeKey sum = coarse_key(UG::Tag(father));
        for (const Element& child : children) {
            const UGElement* const son = child.impl().getTarget();
            const int corners = UG::Corners_Of_Elem(son);
            std::uint64_t word = 0;
            for (int i = 0; i < corners; ++i) {
                const std::optional<std::uint64_t> from = origin(father, UG::Corner(son, i));
                if (!from) return std::nullopt;
                word = word << 8U | *from;
            }
            sum = mix(mix(sum + word) + UG::Tag(son));
        }
        return sum;
    }

    /// What a node was made from, in 8 bits.
    static std::optional<std::uint64_t> origin(const UGElement* father, const UGNode* node) {
        const void* const from = node->father;
        switch (node->control & 7U) {
            case corner:
                return corner_number(father, from);
            case middle: {
                const auto* const edge = static_cast<const typename UG::Edge*>(from);
                const auto a = corner_number(father, edge->links[0].nbnode);
                const auto b = corner_number(father, edge->links[1].nbnode);
                if (!a || !b) return std::nullopt;
                return 8 + 8 * std::min(*a, *b) + std::max(*a, *b);
            }
            case side: {
                const auto place = place_of_side(father, node);
                if (!place) return std::nullopt;
                return 128 + *place;
            }
            case centre:
                return 255;
            default:
                return std::nullopt;
        }
    }

    static std::optional<std::uint64_t> corner_number(const UGElement* father, const void* node) {
        const int corners = UG::Corners_Of_Elem(father);
        for (int i = 0; i < corners; ++i) {
            if (UG::Corner(father, i) == node) return static_cast<std::uint64_t>(i);
        }
        return std::nullopt;
    }

    /// The quadrilateral side in whose middle a node lies: by the node's place in the element if it
    /// was made when that was refined, by the element behind the side if when that was. (UG's own
    /// number of the side is no help, since geometryInFather changes it, not always for the
    /// better.)
    static std::optional<std::uint64_t> place_of_side(const UGElement* father, const UGNode* node) {
        const auto& vertex = node->myvertex->iv;
        std::uint64_t place = 0;
        if (vertex.father == father) {
            for (const double x : vertex.xi) {
                place = 3 * place + static_cast<std::uint64_t>(std::lround(2 * x));
            }
            return place;
        }
        for (int i = 0; i < UG::Sides_Of_Elem(father); ++i) {
            if (UG::NbElem(father, i) != vertex.father) continue;
            if (place != 0) return std::nullopt;
            place = 27 + static_cast<std::uint64_t>(i);
        }
        return place == 0 ? std::nullopt : std::optional(place);
    }

    DuneRules<Element> rules_;
    KeyTable<NodeKey, const Rule*> by_origin_;
};

}  // namespace detail

/// Entities are bare pointers, and what a walk asks of them changes nothing.
template <int dim>
struct DuneTraits<Dune::UGGrid<dim>> : DuneDefaults<Dune::UGGrid<dim>> {
    using DuneType = Dune::UGGrid<dim>;
    using Element = typename DuneType::template Codim<0>::Entity;
    using Rules = detail::UGRules<dim>;
    static constexpr int max_children = 30;  // MAX_SONS
    static constexpr bool leaf_indices_on_branches = true;
    static constexpr bool several_threads = true;

    static void children(const DuneType& grid, const Element& e, std::vector<Element>& out) {
        using UG = Dune::UG_NS<dim>;
        typename UG::Element* sons[max_children];
        UG::GetSons(e.impl().getTarget(), sons);
        out.clear();
        for (int i = UG::nSons(e.impl().getTarget()); i-- > 0;) {
            out.push_back(Dune::UGGridEntity<0, dim, const DuneType>(sons[i], &grid));
        }
    }
};

}  // namespace nestgrid
