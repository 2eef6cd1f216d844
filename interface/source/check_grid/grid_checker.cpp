// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// check_grid: the way through a hierarchy, and what is compared at each node.
#include "grid_checker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "widened.hpp"

namespace nestgrid {

namespace detail {

namespace {

/// As many digits as tell apart any two numbers.
std::string all_digits(double number) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.17g", number);
    return text.data();
}

}  // namespace

std::optional<GridViolation> GridChecker::run() {
    try {
        const std::size_t count = hierarchy_->coarse_count();
        for (std::size_t i = 0; i < count; ++i) check_coarse(i);
        note_pieces();
        check_ids();
        check_contacts();
        for (std::size_t i = 0; i < count; ++i) walk_coarse(i);
        check_seen_values();
        check_hanging();
    } catch (const Found& found) {
        return found.violation;
    }
    return std::nullopt;
}

std::string GridChecker::name(std::size_t step) const {
    std::string path;
    for (; step != root_; step = steps_[step].father) {
        path = "/" + std::to_string(steps_[step].number) + path;
    }
    return "element " + path.substr(1);
}

std::string GridChecker::promise() const {
    const Topology& only = topology(hierarchy_->facts().only_shape);
    return ", but the grid says that all elements are " + std::string(only.name) + "s";
}

/// A hash of the coarse ids with weights; the coarse element is the one at hand.
NodeKey GridChecker::place_of(const Weights& weights) const {
    NodeKey sum = 0;
    for (std::size_t k = 0; k < topology(coarse_.shape).corners; ++k) {
        const auto quantised = static_cast<std::uint64_t>(std::llround(weights[k] * 0x1p40));
        if (quantised != 0) sum += mix(coarse_key(coarse_.ids[k]) + quantised);
    }
    return mix(sum);
}

/// Takes coarse element i to hand.
/// \return its state, with weights and places of the corners
auto GridChecker::coarse_state(std::size_t i) -> State {
    hierarchy_->coarse(task_.get(), i, coarse_, coarse_family_);
    coarse_number_ = i;
    State s{&coarse_family_.members[0], &coarse_family_, coarse_.shape, steps_.size(), 0, {}};
    steps_.push_back({root_, i});
    for (std::size_t k = 0; k < topology(s.shape).corners; ++k) {
        s.corner[k].weights[k] = 1;
        s.corner[k].place = place_of(s.corner[k].weights);
    }
    return s;
}

void GridChecker::walk_coarse(std::size_t i) {
    State s = coarse_state(i);
    const std::size_t corners = topology(s.shape).corners;
    coarse_ids_.emplace_back(coarse_.ids.begin(), coarse_.ids.begin() + corners);
    if (is_masked(coarse_family_, 0)) return;
    std::vector<double> values(max_corners * components_);
    const NodeMask missing = values_that_count(
        values, hierarchy_->coarse_values(task_.get(), i, corners, values.data()));
    for (std::size_t k = 0; k < corners; ++k) {
        if ((missing >> k & 1U) == 0) continue;
        fail_unless_hidden(s.corner[k].place, Law::value_present,
                           "the field lacks a value at a corner of " + name(s.step));
    }
    std::array<NodeKey, max_corners> own{};
    if (own_keys_) {
        hierarchy_->corners(task_.get(), s.member->element, corners, own.data(), nullptr, nullptr);
    }
    size_ = 0;
    for (std::size_t k = 0; k < corners; ++k) {
        Corner& c = s.corner[k];
        const auto value = std::span<const double>(values).subspan(k * components_, components_);
        c.key = own_keys_ ? own[k] : coarse_key(coarse_.ids[k]);
        c.position = coarse_.corners[k];
        c.value = value[0];
        size_ = std::max(size_, norm(c.position - coarse_.corners[0]));
        check_values(s.step, "corner", k, c.place, value);
        check_node(s, k, c, value, false, false);
    }
    walk(s);
}

void GridChecker::check_values(std::size_t step, const char* which, std::size_t n, NodeKey place,
                               std::span<const double> values) {
    for (const double v : values) {
        if (!std::isfinite(v)) {
            fail_unless_hidden(place, Law::value_finite,
                               "the field's value at " + std::string(which) + " " +
                                   std::to_string(n) + " of " + name(step) +
                                   " is not a finite number");
        } else {
            largest_value_ = std::max(largest_value_, std::abs(v));
        }
    }
}

/// Nobody looks at values of nodes that hidden leaves alone have. Which these are is known at the
/// end of the walk.
void GridChecker::fail_unless_hidden(NodeKey place, Law law, const std::string& sentence) {
    if (!hierarchy_->offers(Feature::hidden)) fail(law, sentence);
    unless_hidden_.push_back({place, {law, sentence}});
}

void GridChecker::check_seen_values() const {
    for (const auto& [place, violation] : unless_hidden_) {
        if (is_seen(place)) fail(violation.law, violation.sentence);
    }
}

/// Compares node n of an element with what is known of its place.
void GridChecker::check_node(const State& s, std::size_t n, const Corner& c,
                             std::span<const double> values, bool constrained, bool deviates) {
    const auto where = [&] { return "node " + std::to_string(n) + " of " + name(s.step); };
    if (const std::size_t count = hierarchy_->facts().node_count; count > 0 && c.key >= count) {
        fail(Law::dense_key, "the key of " + where() + " is not below node_count()");
    }
    Node fresh;
    fresh.key = c.key;
    fresh.element = s.step;
    fresh.first = values_.size();
    fresh.constrained = constrained;
    fresh.deviates = deviates;
    const auto found = nodes_.insert(c.place, fresh);
    const Node* const node = found.first;
    if (found.second) {
        values_.insert(values_.end(), values.begin(), values.end());
        const auto [place, key_is_new] = place_of_key_.insert(c.key, c.place);
        if (!key_is_new) {
            fail(Law::key_place, where() + " has the key of a node at another place, made by " +
                                     name(nodes_.find(*place)->element));
        }
        return;
    }
    const auto both = [&] { return where() + " and in " + name(node->element); };
    if (node->key != c.key) fail(Law::one_stencil, "one node has two keys: as " + both());
    if (const auto component = find_other_value(*node, values)) {
        fail_unless_hidden(c.place, Law::value_unique,
                           "the field gives one node two values, " +
                               all_digits(values[*component]) + " and " +
                               all_digits(values_[node->first + *component]) + ": as " + both());
    }
    if (node->constrained != constrained) {
        fail(Law::hanging_mask, "one node is constrained and not constrained: as " + both());
    }
}

/// The first component with another value than the node has.
/// \param values of the node in another element
std::optional<std::size_t> GridChecker::find_other_value(const Node& node,
                                                         std::span<const double> values) const {
    const double tolerance = options_->node_value_tolerance * largest_value_;
    for (std::size_t q = 0; q < components_; ++q) {
        if (!(std::abs(values[q] - values_[node.first + q]) <= tolerance)) return q;
    }
    return std::nullopt;
}

void note_operations(const std::vector<std::string>& grid, const std::vector<std::string>& field,
                     std::vector<std::string>& notes) {
    const auto add = [&](const std::string& who, const std::vector<std::string>& names) {
        std::string list = names.empty() ? "none" : names[0];
        for (std::size_t i = 1; i < names.size(); ++i) list += ", " + names[i];
        notes.push_back("optional operations found in the " + who + ": " + list);
    };
    add("grid", grid);
    add("field", field);
}

}  // namespace detail

std::optional<GridViolation> check_hierarchy(const Hierarchy<float>& hierarchy,
                                             const CheckOptions& options) {
    constexpr double epsilon = std::numeric_limits<float>::epsilon();
    return detail::GridChecker(detail::Widened(hierarchy), epsilon, options).run();
}

std::optional<GridViolation> check_hierarchy(const Hierarchy<double>& hierarchy,
                                             const CheckOptions& options) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    return detail::GridChecker(hierarchy, epsilon, options).run();
}

}  // namespace nestgrid
