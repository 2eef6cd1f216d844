// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/base_walk.hpp>

#include <algorithm>
#include <deque>

#include <nestgrid/error.hpp>

namespace nestgrid::engine {

namespace {

Shape box_of(int dimension) { return dimension == 3 ? Shape::hexahedron : Shape::quadrilateral; }

/// Whether two rules make the same children of the same nodes.
bool divide_alike(const Rule& a, const Rule& b) {
    return &a == &b ||
           (a.parent == b.parent && a.new_nodes == b.new_nodes &&
            std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(),
                       [](const Child& x, const Child& y) { return x.corner == y.corner; }));
}

}  // namespace

unsigned span_of(PartCode part, int dimension) {
    unsigned span = 0;
    for (int d = 0; d < dimension; ++d, part /= 3) span |= unsigned{part % 3 == 2} << d;
    return span;
}

unsigned low_corner_of(PartCode part, int dimension) {
    unsigned corner = 0;
    for (int d = 0; d < dimension; ++d, part /= 3) corner |= unsigned{part % 3 == 1} << d;
    return corner;
}

PartCode part_around(unsigned span, const BoxPlace& at, int level, int dimension) {
    PartCode part = 0;
    for (int d = dimension - 1; d >= 0; --d) {
        const std::uint32_t x = at[static_cast<std::size_t>(d)];
        const bool inside = (span >> d & 1U) != 0 || (x != 0 && x != std::uint32_t{1} << level);
        part = 3 * part + (inside ? 2U : x == 0 ? 0U : 1U);
    }
    return part;
}

NodeKey part_key(const BoxKeys& corners, PartCode part, int dimension) {
    const unsigned span = span_of(part, dimension);
    const unsigned low = low_corner_of(part, dimension);
    NodeKey sum = 0;
    for (unsigned k = 0; k < 1U << dimension; ++k) {
        if ((k & ~span) == low) sum += nestgrid::detail::mix(corners[k]);
    }
    return nestgrid::detail::mix(sum);
}

BoxSplitKeys split_keys_of(const BoxKeys& corners, const Rule& rule) {
    BoxSplitKeys keys;
    const auto count = static_cast<std::size_t>(rule.corner_count());
    std::copy_n(corners.begin(), count, keys.begin());
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        keys[count + n] = derived_key(rule.new_nodes[n], keys.data());
    }
    return keys;
}

std::vector<HalvedPart> halved_parts(const Rule& rule) {
    const std::vector<Point> nodes = reference_nodes(rule);
    std::vector<HalvedPart> parts;
    for (auto n = static_cast<std::size_t>(rule.corner_count()); n < nodes.size(); ++n) {
        HalvedPart part;
        for (std::size_t d = 0; d < topology(rule.parent).dimension; ++d) {
            if (nodes[n][d] == 0.5) part.span |= 1U << d;
            part.at[d] = nodes[n][d] > 0.5 ? 1 : 0;
        }
        parts.push_back(part);
    }
    return parts;
}

/// The memory of one walk. References stay valid while it grows.
struct BaseWalk::Way {
    const Function* function;
    std::unique_ptr<Task> task;
    std::vector<BaseElement> elements;
    std::deque<Family> families;
};

BaseWalk::BaseWalk(const Hierarchy<double>& base)
    : base_{&base}, dimension_{base.facts().dimension} {
    if (dimension_ != 2 && dimension_ != 3) {
        throw InvalidInput("data of higher degree need a grid of dimension 2 or 3");
    }
    rule_ = &dyadic_rule(box_of(dimension_));
}

std::string BaseWalk::name(std::span<const BaseElement> way) {
    std::string name = "element";
    for (std::size_t i = 0; i < way.size(); ++i) {
        name += (i == 0 ? " " : "/") + std::to_string(way[i].number);
    }
    return name;
}

void BaseWalk::for_each(const Function& function) const {
    Way way{&function, base_->open(), {}, {}};
    way.families.resize(1);
    for (std::size_t i = 0; i < base_->coarse_count(); ++i) {
        Coarse coarse;
        Family& family = way.families[0];
        base_->coarse(way.task.get(), i, coarse, family);
        if (coarse.shape != rule_->parent) {
            throw InvalidInput("coarse element " + std::to_string(i) + " is a " +
                               std::string(topology(coarse.shape).name) +
                               "; data of higher degree are drawn on quadrilaterals and hexahedra");
        }
        BaseElement e{family.members.data(), {}, coarse_path(i), i};
        for (std::size_t k = 0; k < std::size_t{1} << dimension_; ++k) {
            e.key[k] = coarse_key(coarse.ids[k]);
        }
        way.elements.assign(1, e);
        visit(way, 0);
    }
}

/// Visits the last element on the way, and all below it.
void BaseWalk::visit(Way& way, std::size_t level) const {
    (*way.function)(way.task.get(), way.elements);
    const BaseElement e = way.elements.back();
    if (e.member->rule == nullptr) return;
    if (!divide_alike(*e.member->rule, *rule_)) {
        throw InvalidInput(name(way.elements) + " is divided by the rule '" + e.member->rule->name +
                           "'; beside leaves of higher degree elements are halved in all "
                           "directions, as dyadic_rule() does");
    }
    if (way.families.size() < level + 2) way.families.resize(level + 2);
    Family& family = way.families[level + 1];
    base_->enter(way.task.get(), e.member->element, *e.member->rule, 0, nullptr, ~NodeMask{0},
                 family);
    const BoxSplitKeys keys = split_keys_of(e.key, *rule_);
    for (std::size_t c = 0; c < rule_->children.size(); ++c) {
        BaseElement child{&family.members[c], {}, child_path(e.path, c), c};
        for (std::size_t k = 0; k < std::size_t{1} << dimension_; ++k) {
            child.key[k] = keys[rule_->children[c].corner[k]];
        }
        way.elements.push_back(child);
        visit(way, level + 1);
        way.elements.pop_back();
    }
}

}  // namespace nestgrid::engine
