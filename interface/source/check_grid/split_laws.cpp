// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of check_grid: elements and their children.
#include <set>

#include "laws.hpp"

namespace nestgrid::detail {

namespace {

class DepthLaw final : public GridLaw {
public:
    explicit DepthLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void visit(const CheckedElement& element) override {
        const int most = inspection_->options().max_depth;
        if (element.level <= most) return;
        Inspection::fail(Law::depth, inspection_->name(element.step) + " lies deeper than " +
                                         std::to_string(most) + " levels");
    }

private:
    const Inspection* inspection_;
};

/// What the grid itself says of the corners of an element is what its father said.
class OwnCornerLaw final : public GridLaw {
public:
    explicit OwnCornerLaw(Inspection& inspection)
        : inspection_{&inspection},
          own_keys_{inspection.offers(Feature::own_keys)},
          own_positions_{inspection.offers(Feature::own_positions)} {}

    void visit(const CheckedElement& element) override {
        if (!own_keys_ && !own_positions_) return;
        std::array<NodeKey, max_corners> key{};
        std::array<Point, max_corners> position{};
        const std::size_t corners = element.corners().size();
        inspection_->hierarchy().corners(inspection_->task(), element.member->element, corners,
                                         own_keys_ ? key.data() : nullptr,
                                         own_positions_ ? position.data() : nullptr, nullptr);
        for (std::size_t k = 0; k < corners; ++k) {
            if (own_keys_ && key[k] != element.corner[k].key) {
                Inspection::fail(Law::stable_key, "the key of " + corner_name(element, k) +
                                                      " is not the one its father gave");
            }
            if (own_positions_) check_position(element, k, position[k]);
        }
    }

private:
    struct OwnPosition {
        bool is_known = false;
        Point x{};
    };

    void check_position(const CheckedElement& element, std::size_t k, const Point& x) {
        const CheckedNode& corner = element.corner[k];
        const double tolerance = inspection_->options().position_tolerance * element.coarse_size;
        if (!(norm(x - corner.position) <= tolerance)) {
            Inspection::fail(Law::position, "the position of " + corner_name(element, k) +
                                                " is not that of eq. (1)");
        }
        OwnPosition& own = own_position(*inspection_->nodes().find(corner.place));
        if (own.is_known && own.x != x) {
            Inspection::fail(Law::position, "one node has two positions: as " +
                                                corner_name(element, k) + " and elsewhere");
        }
        own = {true, x};
    }
    std::string corner_name(const CheckedElement& element, std::size_t k) const {
        return "corner " + std::to_string(k) + " of " + inspection_->name(element.step);
    }
    OwnPosition& own_position(std::size_t node) {
        if (node >= positions_.size()) positions_.resize(inspection_->nodes().size());
        return positions_[node];
    }

    Inspection* inspection_;
    bool own_keys_;
    bool own_positions_;
    std::vector<OwnPosition> positions_;  // of nodes, by their numbers
};

/// Rules are sound, and refine elements of the shape that they are for into such as promised.
class RuleLaw final : public GridLaw {
public:
    explicit RuleLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void visit(const CheckedElement& element) override {
        if (element.is_leaf()) return;
        const Rule& rule = *element.member->rule;
        if (sound_.insert(&rule).second) {
            if (const auto violation = find_violation(rule)) {
                Inspection::fail(Law::rule,
                                 *violation + " (in " + inspection_->name(element.step) + ")");
            }
        }
        if (rule.parent != element.shape) {
            Inspection::fail(Law::rule_shape, inspection_->name(element.step) + " is a " +
                                                  std::string(topology(element.shape).name) +
                                                  ", but its rule '" + rule.name + "' refines a " +
                                                  std::string(topology(rule.parent).name));
        }
    }

    void visit(const CheckedSplit& split) override {
        const Shape only = inspection_->facts().only_shape;
        for (std::size_t k = 0; k < split.rule.children.size(); ++k) {
            const Shape shape = split.rule.children[k].shape;
            if (only == Shape::point || shape == only || is_masked(split.children, k)) continue;
            Inspection::fail(Law::rule_shape, "child " + std::to_string(k) + " of " +
                                                  inspection_->name(split.father.step) + " is a " +
                                                  std::string(topology(shape).name) +
                                                  inspection_->broken_promise());
        }
    }

private:
    const Inspection* inspection_;
    std::set<const Rule*> sound_;
};

/// split() answers the same when it is asked again.
class RepetitionLaw final : public GridLaw {
public:
    explicit RepetitionLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void visit(const CheckedElement& element) override { rules_.push_back(element.member->rule); }
    void revisit(const CheckedElement& element) override {
        if (met_ < rules_.size() && rules_[met_++] == element.member->rule) return;
        Inspection::fail(Law::split_repeats, "split() gives another rule when asked again in " +
                                                 inspection_->name(element.step));
    }

private:
    const Inspection* inspection_;
    std::vector<const Rule*> rules_;  // of the elements, in the order in which they are shown
    std::size_t met_ = 0;             // elements that have been shown again
};

/// An element is hidden as its children are, and no leaf is hidden in part.
class HiddenLaw final : public GridLaw {
public:
    explicit HiddenLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void visit(const CheckedElement& element) override {
        if (!element.is_leaf() || element.member->hidden != Hidden::partly) return;
        Inspection::fail(Law::hidden,
                         inspection_->name(element.step) + " is a leaf, but hidden in part");
    }

    void visit(const CheckedSplit& split) override {
        const Hidden hidden = split.father.member->hidden;
        if (hidden == Hidden::partly) return;
        for (std::size_t k = 0; k < split.rule.children.size(); ++k) {
            if (is_masked(split.children, k) || split.children.members[k].hidden == hidden) {
                continue;
            }
            Inspection::fail(Law::hidden, inspection_->name(split.father.step) + " is " +
                                              (hidden == Hidden::wholly ? "hidden, but not"
                                                                        : "not hidden, but") +
                                              " all that lies below it");
        }
    }

private:
    const Inspection* inspection_;
};

/// An element that is not elsewhere is here, or in part, as its children are; no leaf is in part.
class PresenceLaw final : public GridLaw {
public:
    explicit PresenceLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void visit(const CheckedElement& element) override {
        if (!element.is_leaf() || element.member->presence == Presence::here) return;
        Inspection::fail(Law::presence,
                         inspection_->name(element.step) + " is a leaf, but here in part");
    }

    void visit(const CheckedSplit& split) override {
        const Presence presence = split.father.member->presence;
        const std::vector<Member>& children = split.children.members;
        const std::size_t count = split.rule.children.size();
        const std::size_t here = count_children(split, Presence::here);
        const std::size_t elsewhere = count_children(split, Presence::elsewhere);
        const bool has_first = children[0].presence <= Presence::partly_first;
        const char* wrong = nullptr;
        if (presence == Presence::here && here < count) {
            wrong = " is here, but not all that lies below it";
        } else if (elsewhere == count) {
            wrong = " is here in part, but all that lies below it is elsewhere";
        } else if (presence != Presence::here && here == count) {
            wrong = " is here in part, but all that lies below it is here";
        } else if (presence == Presence::partly_first && !has_first) {
            wrong = " has its first leaf here, but its first child has not";
        } else if (presence == Presence::partly && has_first) {
            wrong = " does not have its first leaf here, but its first child has";
        }
        if (wrong == nullptr) return;
        Inspection::fail(Law::presence, inspection_->name(split.father.step) + wrong);
    }

private:
    static std::size_t count_children(const CheckedSplit& split, Presence presence) {
        std::size_t count = 0;
        for (std::size_t k = 0; k < split.rule.children.size(); ++k) {
            count += split.children.members[k].presence == presence ? 1 : 0;
        }
        return count;
    }

    const Inspection* inspection_;
};

}  // namespace

GridLawPointer depth_law(Inspection& inspection) { return std::make_unique<DepthLaw>(inspection); }
GridLawPointer own_corner_law(Inspection& inspection) {
    return std::make_unique<OwnCornerLaw>(inspection);
}
GridLawPointer rule_law(Inspection& inspection) { return std::make_unique<RuleLaw>(inspection); }
GridLawPointer repetition_law(Inspection& inspection) {
    return std::make_unique<RepetitionLaw>(inspection);
}
GridLawPointer hidden_law(Inspection& inspection) {
    return std::make_unique<HiddenLaw>(inspection);
}
GridLawPointer presence_law(Inspection& inspection) {
    return std::make_unique<PresenceLaw>(inspection);
}

}  // namespace nestgrid::detail
