// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <cmath>

#include <nestgrid/algorithms/element_deviations.hpp>
#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <pieces/corner_values.hpp>
#include <projection/made_for_ranks.hpp>

namespace nestgrid {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Measures all elements, each after those below it.
class Measuring {
public:
    using Entries = std::vector<ElementDeviations::Entry>;

    Measuring(const DiscontinuousData& data, Entries& entries)
        : grid_{&data.grid()}, values_(data), task_{grid_->open()}, entries_{&entries} {
        engine::require_whole_grid(*grid_);
    }

    void run() {
        Coarse coarse;
        Family family;
        Corners corners;
        for (std::size_t i = 0; i < grid_->coarse_count(); ++i) {
            grid_->coarse(task_.get(), i, coarse, family);
            measure(family, 0, coarse.shape, corners, 0);
        }
    }

    double least() const { return least_; }
    double greatest() const { return greatest_; }

private:
    using Corners = std::array<double, max_corners>;  // component 0 at the corners of an element

    struct Frame {
        Family family;
        std::vector<Corners> child;
        std::array<double, max_corners + max_new_nodes> node;
    };

    double measure(const Family& family, std::size_t place, Shape shape, Corners& at,
                   std::size_t depth);
    static double greatest_gap(const Rule& rule, Frame& frame, const Corners& at,
                               std::span<const double> below);

    const Hierarchy<float>* grid_;
    engine::CornerValues values_;
    std::unique_ptr<Task> task_;
    Entries* entries_;
    std::deque<Frame> frames_;
    double least_ = infinity;
    double greatest_ = -infinity;
};

/// Measures one element and all below it.
/// \param at takes the values at its corners
/// \return its deviation; infinity where it, or any element below, is not to be drawn
double Measuring::measure(const Family& family, std::size_t place, Shape shape, Corners& at,
                          std::size_t depth) {
    const Member& member = family.members[place];
    const bool shown = ((family.split | family.leaves) >> place & 1U) != 0;
    if (!shown || member.hidden == Hidden::wholly) {
        at.fill(0);
        return infinity;
    }
    const std::size_t corners = topology(shape).corners;
    if (member.rule == nullptr) {
        const auto values = values_.of_leaf(member.element, corners);
        for (std::size_t k = 0; k < corners; ++k) at[k] = values[k * values_.components()];
        const auto [least, greatest] = std::ranges::minmax(std::span(at).first(corners));
        least_ = std::min(least_, least);
        greatest_ = std::max(greatest_, greatest);
        return 0;
    }
    const Rule& rule = *member.rule;
    const std::size_t entry = entries_->size();
    const bool counts = !rule.new_nodes.empty();
    if (counts) entries_->push_back({});
    if (frames_.size() <= depth) frames_.emplace_back();
    Frame& frame = frames_[depth];
    frame.child.resize(std::max(frame.child.size(), rule.children.size()));
    grid_->enter(task_.get(), member.element, rule, 0, nullptr, ~NodeMask{0}, frame.family);
    std::array<double, max_children> below;
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        below[c] = measure(frame.family, c, rule.children[c].shape, frame.child[c], depth + 1);
    }
    for (std::size_t k = 0; k < corners; ++k) {
        at[k] = frame.child[rule.old_corner[k].child][rule.old_corner[k].corner];
    }
    const double deviation =
        greatest_gap(rule, frame, at, std::span(below).first(rule.children.size()));
    if (counts) {
        const std::size_t subtree = entries_->size() - entry;
        (*entries_)[entry] = {float_above(deviation), static_cast<std::uint32_t>(subtree)};
    }
    return deviation;
}

/// The greatest sum of what a child deviates at its corners, and what is known to deviate below it.
/// \param at the values at the corners of the father
/// \param below the deviation of each child
double Measuring::greatest_gap(const Rule& rule, Frame& frame, const Corners& at,
                               std::span<const double> below) {
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    std::copy_n(at.begin(), corners, frame.node.begin());
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        frame.node[corners + n] = detail::interpolate(rule.new_nodes[n], frame.node.data(), 1);
    }
    double greatest = 0;
    for (std::size_t c = 0; c < below.size(); ++c) {
        if (below[c] == infinity) return infinity;
        const Child& child = rule.children[c];
        double gap = 0;
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            gap = std::max(gap, std::abs(frame.child[c][i] - frame.node[child.corner[i]]));
        }
        greatest = std::max(greatest, gap + below[c]);
    }
    return greatest;
}

}  // namespace

ElementDeviations::ElementDeviations(const DiscontinuousData& data) : epoch_{data.grid().epoch()} {
    Measuring measuring(data, entries_);
    measuring.run();
    least_ = measuring.least();
    greatest_ = measuring.greatest();
    entries_.shrink_to_fit();
}

}  // namespace nestgrid
