// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/base_walk.hpp>

#include <algorithm>
#include <deque>
#include <map>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

PartKeys part_keys(const CornerKeys& corners, const ShapeParts& shape) {
    CornerKeys mixed;
    for (std::size_t k = 0; k < shape.corners; ++k) mixed[k] = nestgrid::detail::mix(corners[k]);
    PartKeys keys;
    for (std::size_t p = 0; p < shape.parts.size(); ++p) {
        const ShapePart& part = shape.parts[p];
        NodeKey sum = 0;
        for (std::size_t i = 0; i < part.count; ++i) sum += mixed[part.corner[i]];
        keys[p] = nestgrid::detail::mix(sum);
    }
    return keys;
}

RedSplitKeys split_keys_of(const CornerKeys& corners, const Rule& rule) {
    RedSplitKeys keys;
    const auto count = static_cast<std::size_t>(rule.corner_count());
    std::copy_n(corners.begin(), count, keys.begin());
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        keys[count + n] = derived_key(rule.new_nodes[n], keys.data());
    }
    return keys;
}

/// The memory of one walk. References stay valid while it grows.
struct BaseWalk::Way {
    const Function* function;
    Positions positions;
    std::unique_ptr<Task> task;
    const WayToLeaf* from;  // null: all leaves
    std::size_t left;       // leaves to be visited
    std::vector<BaseElement> elements;
    std::deque<Family> families;
    std::map<const Rule*, std::vector<InFather>> children;
    // The rule that divided the last element, and its children, which most next ones share.
    std::pair<const Rule*, const std::vector<InFather>*> last{};
};

BaseWalk::BaseWalk(const Hierarchy<double>& base) : base_{&base} {
    if (base.facts().dimension != 2 && base.facts().dimension != 3) {
        throw InvalidInput("data of higher degree need a grid of dimension 2 or 3");
    }
}

std::string BaseWalk::name(std::span<const BaseElement> way) {
    std::string name = "element";
    for (std::size_t i = 0; i < way.size(); ++i) {
        name += (i == 0 ? " " : "/") + std::to_string(way[i].number);
    }
    return name;
}

void BaseWalk::for_each(const Function& function, Positions positions) const {
    Way way{
        &function, positions, base_->open(), nullptr, std::numeric_limits<std::size_t>::max(), {},
        {},        {}};
    run(way);
}

void BaseWalk::for_each(const Function& function, const WayToLeaf& from, std::size_t count) const {
    Way way{&function, Positions::no, base_->open(), &from, count, {}, {}, {}};
    run(way);
}

void BaseWalk::run(Way& way) const {
    way.families.resize(1);
    const std::size_t first = way.from == nullptr ? 0 : way.from->front();
    for (std::size_t i = first; i < base_->coarse_count() && way.left > 0; ++i) {
        Coarse coarse;
        Family& family = way.families[0];
        base_->coarse(way.task.get(), i, coarse, family);
        BaseElement e{family.members.data(),
                      &parts_of(coarse.shape),
                      nullptr,
                      {},
                      coarse.corners,
                      0,
                      coarse_path(i),
                      i};
        for (std::size_t k = 0; k < e.shape->corners; ++k) e.key[k] = coarse_key(coarse.ids[k]);
        way.elements.assign(1, e);
        visit(way, 0, way.from != nullptr && i == first);
    }
}

/// Puts positions of the corners and, behind them, the new nodes of an element that is divided.
/// \return the greatest distance of a new node from the mean of its parents
double BaseWalk::put_positions(Way& way, const BaseElement& e, std::span<Point> x) const {
    const Rule& rule = *e.member->rule;
    const std::span made = x.subspan(e.shape->corners, rule.new_nodes.size());
    std::copy_n(e.x.begin(), e.shape->corners, x.begin());
    const bool given = base_->offers(Feature::new_positions);
    if (given) base_->new_positions(way.task.get(), e.member->element, rule.all(), made);
    double off = 0;
    for (std::size_t n = 0; n < made.size(); ++n) {
        const Point mean = nestgrid::detail::interpolate(rule.new_nodes[n], x.data());
        if (!given) made[n] = mean;
        off = std::max(off, norm(made[n] - mean));
    }
    return off;
}

/// Visits the last element on the way, and all below it.
/// \param is_first whether it is on the way to the first leaf that is visited
void BaseWalk::visit(Way& way, std::size_t level, bool is_first) const {
    const BaseElement e = way.elements.back();
    std::size_t first = 0;
    bool begins = true;
    if (is_first && level + 1 < way.from->size()) {
        first = (*way.from)[level + 1];
        const auto below = way.from->begin() + static_cast<std::ptrdiff_t>(level) + 1;
        begins = std::all_of(below, way.from->end(), [](std::size_t c) { return c == 0; });
    }
    if (begins) (*way.function)(way.task.get(), way.elements);
    if (e.member->rule == nullptr) {
        --way.left;
        return;
    }
    const Rule& rule = *e.member->rule;
    const std::vector<InFather>& children = children_of(way, rule);
    if (way.families.size() < level + 2) way.families.resize(level + 2);
    Family& family = way.families[level + 1];
    base_->enter(way.task.get(), e.member->element, rule, 0, nullptr, ~NodeMask{0}, family);
    const RedSplitKeys keys = split_keys_of(e.key, rule);
    std::array<Point, max_split_nodes> x{};
    const double moved = e.moved + (way.positions == Positions::yes ? put_positions(way, e, x) : 0);
    for (std::size_t c = first; c < rule.children.size() && way.left > 0; ++c) {
        const Child& of = rule.children[c];
        BaseElement child{&family.members[c],
                          &parts_of(of.shape),
                          &children[c],
                          {},
                          {},
                          moved,
                          child_path(e.path, c),
                          c};
        for (std::size_t k = 0; k < child.shape->corners; ++k) {
            child.key[k] = keys[of.corner[k]];
            child.x[k] = x[of.corner[k]];
        }
        way.elements.push_back(child);
        visit(way, level + 1, is_first && c == first);
        way.elements.pop_back();
    }
}

/// \throw InvalidInput where the rule of the last element on the way does not divide red
const std::vector<InFather>& BaseWalk::children_of(Way& way, const Rule& rule) {
    if (way.last.first == &rule) return *way.last.second;
    auto at = way.children.find(&rule);
    if (at == way.children.end()) {
        if (!divides_red(rule)) {
            throw InvalidInput(name(way.elements) + " is divided by the rule '" + rule.name +
                               "'; beside leaves of higher degree elements are halved in all "
                               "directions, as red_rule() does");
        }
        at = way.children.emplace(&rule, children_in_father(rule)).first;
    }
    way.last = {&rule, &at->second};
    return at->second;
}

}  // namespace nestgrid::engine
