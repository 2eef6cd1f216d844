// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <deque>

#include <discontinuous/corner_values.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/algorithms/element_deviations.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <projection/made_for_ranks.hpp>

namespace nestgrid {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Corners = std::array<double, max_corners>;  // component 0 at the corners of an element

/// A part of the grid that is being walked: an element in its family.
struct At {
    const Family& family;
    std::size_t place;
    Shape shape;

    const Member& member() const { return family.members[place]; }
    /// Whether the element, as far as it alone is known, is drawn.
    bool shown() const {
        const bool exists = ((family.split | family.leaves) >> place & 1U) != 0;
        return exists && member().hidden != Hidden::wholly;
    }
    std::size_t corner_count() const { return topology(shape).corners; }
};

/// Walks the grid, and finds the values of leaves.
class Leaves {
public:
    explicit Leaves(const DiscontinuousData& data)
        : grid_{&data.grid()}, values_(data), task_{grid_->open()} {
        engine::require_whole_grid(*grid_);
    }

    template <class Visit>
    void for_each_coarse(const Visit& visit) {
        Coarse coarse;
        Family family;
        for (std::size_t i = 0; i < grid_->coarse_count(); ++i) {
            grid_->coarse(task_.get(), i, coarse, family);
            visit(At{family, 0, coarse.shape});
        }
    }
    /// The children of a split element; valid until the next call for this depth.
    const Family& enter(const At& at, std::size_t depth) {
        while (families_.size() <= depth) families_.emplace_back();
        grid_->enter(task_.get(), at.member().element, *at.member().rule, 0, nullptr, ~NodeMask{0},
                     families_[depth]);
        return families_[depth];
    }
    Corners of_leaf(const At& at) {
        const auto values = values_.of_leaf(at.member().element, at.corner_count());
        Corners corners{};
        for (std::size_t k = 0; k < at.corner_count(); ++k) {
            corners[k] = values[k * values_.components()];
        }
        return corners;
    }

private:
    const Hierarchy<float>* grid_;
    engine::CornerValues values_;
    std::unique_ptr<Task> task_;
    std::deque<Family> families_;  // by depth
};

/// Finds the values at the corners of all split elements, each after those below it.
class Gathering {
public:
    using Entries = std::vector<ElementDeviations::Entry>;

    Gathering(Leaves& leaves, Entries& entries) : leaves_{&leaves}, entries_{&entries} {
        leaves.for_each_coarse([&](const At& at) {
            Corners out;
            gather(at, out, 0);
        });
    }

    double least = infinity;
    double greatest = -infinity;
    std::vector<Corners> corners{};  ///< by entry

private:
    /// \param out takes the values at the corners
    /// \return whether the element and all below it are drawn
    bool gather(const At& at, Corners& out, std::size_t depth) {
        out.fill(0);
        if (!at.shown()) return false;
        const Rule* const rule = at.member().rule;
        if (rule == nullptr) {
            out = leaves_->of_leaf(at);
            const auto [low, high] = std::ranges::minmax(std::span(out).first(at.corner_count()));
            least = std::min(least, low);
            greatest = std::max(greatest, high);
            return true;
        }
        const std::size_t entry = entries_->size();
        const bool counts = !rule->new_nodes.empty();
        if (counts) {
            entries_->push_back({});
            corners.push_back({});
        }
        const Family& family = leaves_->enter(at, depth);
        std::array<Corners, max_children> child;
        bool drawn = true;
        for (std::size_t c = 0; c < rule->children.size(); ++c) {
            drawn &= gather({family, c, rule->children[c].shape}, child[c], depth + 1);
        }
        for (std::size_t k = 0; k < at.corner_count(); ++k) {
            out[k] = child[rule->old_corner[k].child][rule->old_corner[k].corner];
        }
        if (!counts) return drawn;
        corners[entry] = out;
        const std::size_t subtree = entries_->size() - entry;
        (*entries_)[entry] = {drawn ? 0 : static_cast<float>(infinity),
                              static_cast<std::uint32_t>(subtree)};
        return drawn;
    }

    Leaves* leaves_;
    Entries* entries_;
};

/// Measures all split elements at once, in one walk: each element carries, at its corners, what all
/// elements above it interpolate there, and leaves compare that with their own values.
class Measuring {
public:
    Measuring(Leaves& leaves, std::span<const Corners> corners,
              std::span<ElementDeviations::Entry> entries)
        : leaves_{&leaves}, corners_{corners}, entries_{entries} {}

    void run() {
        leaves_->for_each_coarse([&](const At& at) { measure(at, {}, 0); });
    }

private:
    /// What an element above interpolates at the corners of an element, and at its new nodes.
    using Row = std::array<double, max_corners + max_new_nodes>;

    /// \param above what each element above, the highest first, interpolates at the corners
    void measure(const At& at, std::span<const Corners> above, std::size_t depth) {
        if (!at.shown()) return;
        const Rule* const rule = at.member().rule;
        if (rule == nullptr) return compare(at, above);
        if (rows_.size() <= depth) rows_.emplace_back();
        std::vector<Row>& rows = rows_[depth];
        rows.resize(above.size());
        for (std::size_t a = 0; a < above.size(); ++a) {
            std::ranges::copy(above[a], rows[a].begin());
        }
        const std::size_t entry = next_;
        const bool counts = !rule->new_nodes.empty();
        if (counts) {
            ++next_;
            greatest_.push_back(0);
            std::ranges::copy(corners_[entry], rows.emplace_back().begin());
        }
        for (Row& row : rows) interpolate(*rule, at.corner_count(), row);
        descend(at, rows, depth);
        if (!counts) return;
        ElementDeviations::Entry& own = entries_[entry];
        own.deviation = std::max(own.deviation, detail::float_above(greatest_.back()));
        greatest_.pop_back();
    }
    static void interpolate(const Rule& rule, std::size_t corners, Row& row) {
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            row[corners + n] = detail::interpolate(rule.new_nodes[n], row.data(), 1);
        }
    }
    void descend(const At& at, const std::vector<Row>& rows, std::size_t depth) {
        const Rule& rule = *at.member().rule;
        const Family& family = leaves_->enter(at, depth);
        if (of_child_.size() <= depth) of_child_.emplace_back();
        std::vector<Corners>& below = of_child_[depth];
        below.resize(rows.size());
        for (std::size_t c = 0; c < rule.children.size(); ++c) {
            const Child& child = rule.children[c];
            for (std::size_t a = 0; a < rows.size(); ++a) {
                for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
                    below[a][i] = rows[a][child.corner[i]];
                }
            }
            measure({family, c, child.shape}, below, depth + 1);
        }
    }
    void compare(const At& leaf, std::span<const Corners> above) {
        if (above.empty()) return;
        const Corners values = leaves_->of_leaf(leaf);
        for (std::size_t a = 0; a < above.size(); ++a) {
            for (std::size_t k = 0; k < leaf.corner_count(); ++k) {
                greatest_[a] = std::max(greatest_[a], std::abs(values[k] - above[a][k]));
            }
        }
    }

    Leaves* leaves_;
    std::span<const Corners> corners_;
    std::span<ElementDeviations::Entry> entries_;
    std::size_t next_ = 0;                       // entry of the next split element
    std::vector<double> greatest_;               // by element above
    std::deque<std::vector<Row>> rows_;          // by depth, of the element there
    std::deque<std::vector<Corners>> of_child_;  // by depth, of the child that is looked at
};

}  // namespace

ElementDeviations::ElementDeviations(const DiscontinuousData& data) : epoch_{data.grid().epoch()} {
    Leaves leaves(data);
    Gathering gathered(leaves, entries_);
    least_ = gathered.least;
    greatest_ = gathered.greatest;
    Measuring(leaves, gathered.corners, entries_).run();
    entries_.shrink_to_fit();
}

}  // namespace nestgrid
