// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Any grid of Dune (Bastian et al. 2008) whose elements are refined into nested children, as a
// nested grid: UGGrid, AlbertaGrid, YaspGrid, and what else follows the interface of dune-grid.
// Nothing of it is copied but one seed per coarse element and each refinement rule once.
//
// Invariants:
//   - an element is Dune's own entity; children come in the order of the hierarchic iterator, and
//     corners keep their numbers, since Dune numbers them as nestgrid does;
//   - the rule of an element is found from where its children lie in it (geometryInFather);
//   - a node's key is Dune's id of the vertex or, where leaf indices hold on all levels, its index;
//     of ids of more than 64 bits it is a hash, with the odds of keys.hpp;
//   - positions are those of the vertices, so that parametrised boundaries are followed.
// Hanging nodes are derived, except on grids that are known to have none.
//
// Each of several processes lists its own coarse elements and those that it has beside them as
// overlap or ghosts, which are elsewhere: `presence` tells by Dune's partition types, and
// distributed.hpp reaches the others. Keys are ids that are the same on all processes.
#pragma once

#include <memory>
#include <string>
#include <thread>

#include <nestgrid/adapters/dune_alberta.hpp>
#include <nestgrid/adapters/dune_rules.hpp>
#include <nestgrid/adapters/dune_ug.hpp>
#include <nestgrid/adapters/dune_yasp.hpp>
#include <nestgrid/optional.hpp>

namespace nestgrid {

/// The grid must outlive this object. After it was adapted, make a new one.
/// \tparam DuneType of dimension 2 or 3, in a world of the same dimension
template <class DuneType, class Traits = DuneTraits<DuneType>>
class DuneGrid {
    static_assert(DuneType::dimension == 2 || DuneType::dimension == 3,
                  "A Dune grid must have dimension 2 or 3.");
    static_assert(DuneType::dimension == DuneType::dimensionworld,
                  "A Dune grid must be as high as the world it lies in.");

public:
    using Solver = DuneType;
    using Element = typename DuneType::template Codim<0>::Entity;
    static constexpr int dimension = DuneType::dimension;
    static constexpr int max_corners = dimension == 2 ? 4 : 8;
    static constexpr int max_children = Traits::max_children;
    static constexpr bool leaf_indices_on_branches = Traits::leaf_indices_on_branches;

    /// State of a task: what was found out about the element that was asked last.
    class Context {
        friend class DuneGrid;
        struct Opened {
            bool known = false;
            Element element;
            const Rule* rule = nullptr;
            std::vector<Element> children;
            std::vector<PlacedChild> placed;
        };
        Opened opened_;
        Opened below_;  // on the way to a leaf
    };

    /// Walks the whole hierarchy for its rules.
    /// \throw InvalidInput where the grid is periodic, or shows nothing beside what this process
    ///        has of it, or has elements of an unknown shape; where the children of an element do
    ///        not tile it, or lie on several processes
    explicit DuneGrid(const DuneType& grid);

    /// Over several processes it says what is here, and has no dense keys.
    bool offers(Feature feature) const {
        if (feature == Feature::presence) return parted_;
        return feature != Feature::dense_keys || !parted_;
    }

    std::size_t coarse_count() const { return coarse_.size(); }
    CoarseElement<Element> coarse(std::size_t i) const;
    /// \throw GridError where the grid was adapted since this object was made
    const Rule* split(const Element& e, Context& context) const {
        return e.isLeaf() ? nullptr : open(e, context.opened_).rule;
    }
    void children(const Element& e, std::span<Element> out, Context& context) const {
        const auto& opened = open(e, context.opened_);
        std::copy(opened.children.begin(), opened.children.end(), out.begin());
    }

    void corner_keys(const Element& e, std::span<NodeKey> out) const {
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = id(e, k);
    }
    void new_keys(const Element& e, std::span<NodeKey> out, Context& context) const {
        const auto& opened = open(e, context.opened_);
        for (std::size_t n = 0; n < out.size(); ++n) {
            const ChildCorner at = opened.rule->new_corner[n];
            out[n] = id(opened.children[at.child], at.corner);
        }
    }
    std::size_t node_count() const requires(leaf_indices_on_branches) {
        return static_cast<std::size_t>(grid_->leafIndexSet().size(dimension));
    }
    void new_positions(const Element& e, NodeMask which, std::span<Point> out,
                       Context& context) const {
        for_each_new_corner(e, which, context,
                            [&](std::size_t n, const Element& child, int corner) {
                                out[n] = Traits::corner(*grid_, child, corner);
                            });
    }
    bool conforming() const { return Traits::conforming; }
    Presence presence(const Element& e) const {
        return e.partitionType() == Dune::InteriorEntity ? Presence::here : Presence::elsewhere;
    }
    int rank_count() const { return grid_->comm().size(); }
    /// Where a coarse element is in the order of one process.
    std::uint64_t coarse_place(std::size_t i) const {
        return Traits::coarse_place(*grid_, coarse_entity(i));
    }
    /// From the numbers of elements and vertices, of all leaves and on each level: it does not
    /// notice that as many vanished on every level as came there.
    std::uint64_t epoch() const {
        auto sum = static_cast<NodeKey>(grid_->maxLevel());
        for (const int codimension : {0, dimension}) {
            sum = detail::mix(sum + static_cast<NodeKey>(grid_->leafIndexSet().size(codimension)));
            for (int level = 0; level <= grid_->maxLevel(); ++level) {
                sum = detail::mix(sum + static_cast<NodeKey>(grid_->size(level, codimension)));
            }
        }
        return static_cast<std::uint64_t>(sum);
    }
    /// \throw InvalidInput in another thread than that which made this object, where the Dune grid
    ///        does not allow several
    Context make_context() const {
        if (!Traits::several_threads && std::this_thread::get_id() != thread_) {
            throw InvalidInput(
                "this Dune grid can only be walked by the thread that made its adapter");
        }
        return {};
    }

    // What fields need.
    const DuneType& solver() const { return *grid_; }
    Element coarse_entity(std::size_t i) const { return grid_->entity(coarse_[i]); }
    const RuleTable& rules() const { return rules_->table(); }

    /// Calls f(n, child, corner) for every new node n in `which`: a child and its corner there.
    template <class Function>
    void for_each_new_corner(const Element& e, NodeMask which, Context& context,
                             Function&& f) const;

    /// Calls f(leaf, corner) with a leaf that has the given corner of e. O(depth) time.
    template <class Function>
    decltype(auto) at_leaf(const Element& e, int corner, Context& context, Function&& f) const;

private:
    using Opened = typename Context::Opened;

    const Opened& open(const Element& e, Opened& opened) const;
    void require_drawn() const;
    static std::pair<std::size_t, int> child_at_corner(const Rule& rule, int corner);
    std::uint64_t id(const Element& e, std::size_t corner) const {
        const auto i = static_cast<int>(corner);
        if (parted_) return detail::dune_id(grid_->globalIdSet().subId(e, i, dimension));
        if constexpr (leaf_indices_on_branches) {
            return static_cast<std::uint64_t>(grid_->leafIndexSet().subIndex(e, i, dimension));
        } else {
            return detail::dune_id(grid_->localIdSet().subId(e, i, dimension));
        }
    }

    const DuneType* grid_;
    bool parted_;  // over several processes
    std::thread::id thread_;
    std::vector<typename DuneType::template Codim<0>::EntitySeed> coarse_;
    std::shared_ptr<typename Traits::Rules> rules_;  // of all copies
};

template <class DuneType>
DuneGrid(const DuneType&) -> DuneGrid<DuneType>;

template <class DuneType, class Traits>
DuneGrid<DuneType, Traits>::DuneGrid(const DuneType& grid)
    : grid_{&grid},
      parted_{grid.comm().size() > 1},
      thread_{std::this_thread::get_id()},
      rules_{std::make_shared<typename Traits::Rules>()} {
    require_drawn();
    std::vector<Element> children;
    std::vector<PlacedChild> placed;
    const auto add_rule = [&](const Element& e) {
        if (e.isLeaf()) return;
        Traits::children(grid, e, children);
        rules_->add(e, children, placed);
    };
    const auto take = [&](const Element& e) {
        detail::dune_shape(e.type());
        coarse_.push_back(e.seed());
        if (presence(e) == Presence::elsewhere) {
            if (!parted_) throw InvalidInput("the Dune grid is periodic");
            return;
        }
        add_rule(e);
        for (const Element& d : descendantElements(e, grid.maxLevel())) {
            if (presence(d) == Presence::elsewhere) {
                throw InvalidInput(
                    "children of an element of the Dune grid are on several processes: whole "
                    "trees of elements must be distributed");
            }
            add_rule(d);
        }
    };
    std::string wrong;
    try {
        for (const Element& e : elements(grid.levelGridView(0))) take(e);
    } catch (const InvalidInput& error) {
        if (!parted_) throw;
        wrong = error.what();
    }
    if (parted_ && grid.comm().max(wrong.empty() ? 0 : 1) != 0) {
        throw InvalidInput(wrong.empty() ? "another process cannot walk its part of the Dune grid"
                                         : wrong);
    }
    grid.leafIndexSet();
}

/// \throw InvalidInput, on all processes alike
template <class DuneType, class Traits>
void DuneGrid<DuneType, Traits>::require_drawn() const {
    if (!parted_) return;
    if constexpr (requires { grid_->isPeriodic(0); }) {
        for (int d = 0; d < dimension; ++d) {
            if (grid_->isPeriodic(d)) throw InvalidInput("the Dune grid is periodic");
        }
    }
    const auto coarse = grid_->levelGridView(0);
    if (coarse.overlapSize(0) == 0 && coarse.ghostSize(0) == 0) {
        throw InvalidInput(
            "the Dune grid shows its processes nothing of what lies beside their elements: make "
            "it with an overlap of 1");
    }
}

template <class DuneType, class Traits>
auto DuneGrid<DuneType, Traits>::coarse(std::size_t i) const -> CoarseElement<Element> {
    CoarseElement<Element> c;
    c.element = coarse_entity(i);
    c.shape = detail::dune_shape(c.element.type());
    const std::size_t corners = topology(c.shape).corners;
    for (std::size_t k = 0; k < corners; ++k) {
        c.corners[k] = Traits::corner(*grid_, c.element, static_cast<int>(k));
        c.ids[k] = id(c.element, k);
    }
    if (dimension == 3 && measure(c.shape, std::span(c.corners).first(corners)) < 0) {
        c.orientation = -1;
    }
    return c;
}

template <class DuneType, class Traits>
auto DuneGrid<DuneType, Traits>::open(const Element& e, Opened& opened) const -> const Opened& {
    if (opened.known && opened.element == e) return opened;
    opened.known = false;
    Traits::children(*grid_, e, opened.children);
    opened.rule = rules_->find(e, opened.children, opened.placed);
    if (opened.rule == nullptr) {
        throw GridError("the Dune grid was adapted; its adapter must be made anew");
    }
    opened.element = e;
    opened.known = true;
    return opened;
}

template <class DuneType, class Traits>
std::pair<std::size_t, int> DuneGrid<DuneType, Traits>::child_at_corner(const Rule& rule,
                                                                        int corner) {
    for (std::size_t c = 0;; ++c) {
        const auto& corners = rule.children[c].corner;
        const int count = topology(rule.children[c].shape).corners;
        for (int i = 0; i < count; ++i) {
            if (corners[static_cast<std::size_t>(i)] == corner) return {c, i};
        }
    }
}

template <class DuneType, class Traits>
template <class Function>
void DuneGrid<DuneType, Traits>::for_each_new_corner(const Element& e, NodeMask which,
                                                     Context& context, Function&& f) const {
    const auto& opened = open(e, context.opened_);
    for (std::size_t n = 0; n < opened.rule->new_nodes.size(); ++n) {
        if ((which >> n & 1U) == 0) continue;
        const ChildCorner at = opened.rule->new_corner[n];
        f(n, opened.children[at.child], static_cast<int>(at.corner));
    }
}

template <class DuneType, class Traits>
template <class Function>
decltype(auto) DuneGrid<DuneType, Traits>::at_leaf(const Element& e, int corner, Context& context,
                                                   Function&& f) const {
    Element leaf = e;
    while (!leaf.isLeaf()) {
        const auto& opened = open(leaf, context.below_);
        const auto [child, at] = child_at_corner(*opened.rule, corner);
        leaf = Element(opened.children[child]);
        corner = at;
    }
    return f(leaf, corner);
}

}  // namespace nestgrid
