// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/base_walk.hpp>

#include <algorithm>
#include <deque>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

NodeKey part_key(const CornerKeys& corners, const ShapePart& part) {
    NodeKey sum = 0;
    for (std::size_t i = 0; i < part.count; ++i) {
        sum += nestgrid::detail::mix(corners[part.corner[i]]);
    }
    return nestgrid::detail::mix(sum);
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
    std::vector<BaseElement> elements;
    std::deque<Family> families;
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
    Way way{&function, positions, base_->open(), {}, {}};
    way.families.resize(1);
    for (std::size_t i = 0; i < base_->coarse_count(); ++i) {
        Coarse coarse;
        Family& family = way.families[0];
        base_->coarse(way.task.get(), i, coarse, family);
        BaseElement e{family.members.data(), &parts_of(coarse.shape), {},
                      coarse.corners,        coarse_path(i),          i};
        for (std::size_t k = 0; k < e.shape->corners; ++k) e.key[k] = coarse_key(coarse.ids[k]);
        way.elements.assign(1, e);
        visit(way, 0);
    }
}

/// Puts positions of the corners and, behind them, the new nodes of an element that is divided.
void BaseWalk::put_positions(Way& way, const BaseElement& e, std::span<Point> x) const {
    const Rule& rule = *e.member->rule;
    const std::span made = x.subspan(e.shape->corners, rule.new_nodes.size());
    std::copy_n(e.x.begin(), e.shape->corners, x.begin());
    if (base_->offers(Feature::new_positions)) {
        base_->new_positions(way.task.get(), e.member->element, rule.all(), made);
        return;
    }
    for (std::size_t n = 0; n < made.size(); ++n) {
        made[n] = nestgrid::detail::interpolate(rule.new_nodes[n], x.data());
    }
}

/// Visits the last element on the way, and all below it.
void BaseWalk::visit(Way& way, std::size_t level) const {
    (*way.function)(way.task.get(), way.elements);
    const BaseElement e = way.elements.back();
    if (e.member->rule == nullptr) return;
    const Rule& rule = *e.member->rule;
    if (&rule != e.shape->rule && !divides_red(rule)) {
        throw InvalidInput(name(way.elements) + " is divided by the rule '" + rule.name +
                           "'; beside leaves of higher degree elements are halved in all "
                           "directions, as red_rule() does");
    }
    if (way.families.size() < level + 2) way.families.resize(level + 2);
    Family& family = way.families[level + 1];
    base_->enter(way.task.get(), e.member->element, rule, 0, nullptr, ~NodeMask{0}, family);
    const RedSplitKeys keys = split_keys_of(e.key, rule);
    std::array<Point, max_split_nodes> x{};
    if (way.positions == Positions::yes) put_positions(way, e, x);
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        const Child& of = rule.children[c];
        BaseElement child{
            &family.members[c], &parts_of(of.shape), {}, {}, child_path(e.path, c), c};
        for (std::size_t k = 0; k < child.shape->corners; ++k) {
            child.key[k] = keys[of.corner[k]];
            child.x[k] = x[of.corner[k]];
        }
        way.elements.push_back(child);
        visit(way, level + 1);
        way.elements.pop_back();
    }
}

}  // namespace nestgrid::engine
