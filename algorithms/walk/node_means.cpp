// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/detail/node_means.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <nestgrid/detail/mean.hpp>
#include <ranks/cells_across.hpp>
#include <walk/linear_fit.hpp>

namespace nestgrid::detail {

namespace {

// Pulls are counted in whole steps, so that the order in which they are added does not matter.
constexpr double pull_steps = 0x1p36;
// A mean that lies off its node by less than this part of the size of a cell lies at the node.
constexpr std::int64_t least_pull = 64;
// Rounds in which values go on from the inside: walls, edges and corners of a box take three.
constexpr int rounds = 6;
// Steps in which a plane is sought that has all centres on one side.
constexpr int plane_steps = 32;

using Numbers = std::array<double, max_corners>;

double sorted_sum(std::span<double> x) {
    std::sort(x.begin(), x.end());
    double sum = 0;
    for (const double each : x) sum += each;
    return sum;
}

/// Mean of the corners in a coordinate, in any order of them.
double mean_coordinate(std::span<const Point> x, std::size_t d) {
    Numbers here{};
    for (std::size_t i = 0; i < x.size(); ++i) here[i] = x[i][d];
    return sorted_sum(std::span(here).first(x.size())) / static_cast<double>(x.size());
}

/// The centre of gravity; of a hexahedron whose faces are not parallel, the mean of its corners.
Point centre_of(Shape shape, std::span<const Point> x) {
    Point centre{};
    for (std::size_t d = 0; d < 3; ++d) {
        centre[d] = shape == Shape::pyramid ? 0.75 * mean_coordinate(x.first(4), d) + 0.25 * x[4][d]
                                            : mean_coordinate(x, d);
    }
    return centre;
}

/// One over the root mean square distance of the corners from the centre; 0 for a cell without any
/// extent.
double inverse_size(const Point& centre, std::span<const Point> x) {
    Numbers squares{};
    for (std::size_t i = 0; i < x.size(); ++i) squares[i] = dot(x[i] - centre, x[i] - centre);
    const double size =
        std::sqrt(sorted_sum(std::span(squares).first(x.size())) / static_cast<double>(x.size()));
    return size > 0 ? 1 / size : 0;
}

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

/// What a cell gives to a node: its value and its weight.
struct Share {
    double value;
    double weight;
};

/// The weighted mean, or not a number where a value is not finite.
double mean_of_shares(std::span<const Share> shares, std::vector<double>& scratch) {
    Range range;
    scratch.clear();
    for (const Share& s : shares) {
        if (!std::isfinite(s.value)) return std::numeric_limits<double>::quiet_NaN();
        range.add(s.value);
        scratch.push_back(s.weight);
    }
    const double total = sorted_sum(scratch);
    if (total <= 0) return range.low;
    scratch.clear();
    for (const Share& s : shares) scratch.push_back(s.weight / total * s.value);
    return ordered_sum(std::span(scratch), range.low, range.high);
}

/// A cell with a corner at which the mean of cells does not lie.
struct RimCell {
    double value;
    double weight;
    Point centre;
    std::array<Point, max_corners> position;
    std::array<std::uint32_t, max_corners> node;
    std::uint8_t corners;
};

/// A cell around a node of the rim.
struct RimCorner {
    std::uint32_t node;
    std::uint32_t cell;
    std::uint8_t corner;
};

/// Nodes and their values.
using Settled = std::vector<std::pair<std::uint32_t, double>>;

/// Brings means to their nodes by gradients.
class Rim {
public:
    /// \param known of each node, whether its value is right
    /// \param own how many nodes are settled here; the others come behind them
    /// \param limits of all values
    Rim(int dimension, Range limits, const std::vector<RimCell>& cells, std::vector<double>& values,
        std::vector<bool>& known, std::size_t own)
        : dimension_{dimension}, limits_{limits}, cells_{&cells}, values_{&values}, known_{&known} {
        for (std::uint32_t c = 0; c < cells.size(); ++c) {
            for (std::uint8_t k = 0; k < cells[c].corners; ++k) {
                const std::uint32_t node = cells[c].node[k];
                if (node < own && !known[node]) around_.push_back({node, c, k});
            }
        }
        std::sort(around_.begin(), around_.end(), [](const RimCorner& a, const RimCorner& b) {
            return a.node != b.node ? a.node < b.node : a.cell < b.cell;
        });
    }

    /// \param tell tell(settled), of node numbers and values, takes what other ranks have settled
    ///        and returns whether any rank has
    template <class Tell>
    void settle(const Tell& tell) {
        for (int round = 0; round < rounds && tell(settle_some(false)); ++round) {
        }
        settle_some(true);
    }

private:
    using Around = std::span<const RimCorner>;

    /// Settles the nodes that can be, all by the values of the round before.
    /// \param all also those around which too little is known
    /// \return these
    Settled settle_some(bool all) {
        Settled settled;
        for (std::size_t i = 0; i < around_.size();) {
            std::size_t end = i;
            while (end < around_.size() && around_[end].node == around_[i].node) ++end;
            const std::uint32_t node = around_[i].node;
            if (!(*known_)[node] && std::isfinite((*values_)[node])) {
                look_around(Around(around_).subspan(i, end - i));
                settle_node(node, all, settled);
            }
            i = end;
        }
        for (const auto& [node, value] : settled) {
            (*values_)[node] = value;
            (*known_)[node] = true;
        }
        return settled;
    }

    /// Gathers the cells around a node and what is known at their other corners, in an order that
    /// no numbering decides.
    void look_around(Around around) {
        centres_.clear();
        samples_.clear();
        defect_ = {0, 0, 0};
        for (const RimCorner& at : around) add_cell((*cells_)[at.cell], at.corner);
        std::sort(centres_.begin(), centres_.end());
        std::sort(samples_.begin(), samples_.end());
        samples_.erase(std::unique(samples_.begin(), samples_.end()), samples_.end());
        has_corners_ = !samples_.empty();
        put_centres();
    }
    void add_cell(const RimCell& cell, std::uint8_t corner) {
        const Point& x = cell.position[corner];
        centres_.push_back({{cell.centre - x, cell.value}, cell.weight});
        for (std::uint8_t k = 0; k < cell.corners; ++k) {
            if (!(*known_)[cell.node[k]] || k == corner) continue;
            const engine::FitSample sample{cell.position[k] - x, (*values_)[cell.node[k]]};
            if (norm(sample.offset) > 0) samples_.push_back(sample);
        }
    }
    /// Adds the centres to the samples, and their weighted mean.
    void put_centres() {
        double total = 0;
        cells_range_ = {};
        for (const auto& [sample, weight] : centres_) {
            total += weight;
            defect_ = defect_ + weight * sample.offset;
            cells_range_.add(sample.value);
            if (norm(sample.offset) > 0) samples_.push_back(sample);
        }
        if (total > 0) defect_ = (1 / total) * defect_;
    }

    void settle_node(std::uint32_t node, bool all, Settled& settled) const {
        if (samples_.empty()) return;
        const bool beyond = lies_beyond();
        if (!all && beyond && !has_corners_) return;
        const engine::LinearFit fit = engine::fit_linear(samples_, dimension_);
        if (!all && fit.rank < dimension_) return;
        const double value = (*values_)[node] - dot(fit.gradient, defect_);
        const double room = beyond ? 2 * spread() : 0;
        const double low = std::max(cells_range_.low - room, limits_.low);
        const double high = std::min(cells_range_.high + room, limits_.high);
        if (std::isfinite(value)) settled.emplace_back(node, std::clamp(value, low, high));
    }

    /// Whether a plane through the node has all centres on one side.
    bool lies_beyond() const {
        Point normal = defect_;
        for (int step = 0; step < plane_steps; ++step) {
            bool separates = true;
            for (const auto& [sample, weight] : centres_) {
                if (dot(normal, sample.offset) > 1e-9 * norm(normal) * norm(sample.offset))
                    continue;
                separates = false;
                normal = normal + sample.offset;
            }
            if (separates) return true;
        }
        return false;
    }
    /// By how much the samples differ.
    double spread() const {
        Range range;
        for (const engine::FitSample& s : samples_) range.add(s.value);
        return range.high - range.low;
    }

    int dimension_;
    Range limits_;
    const std::vector<RimCell>* cells_;
    std::vector<double>* values_;
    std::vector<bool>* known_;
    std::vector<RimCorner> around_;
    // Around the node that is looked at:
    std::vector<std::pair<engine::FitSample, double>> centres_;  // with their weights
    std::vector<engine::FitSample> samples_;                     // corners, then centres
    Point defect_{};                                             // from the node to the mean
    Range cells_range_;
    bool has_corners_ = false;
};

/// The nodes of all cells, numbered as they are met.
class Nodes {
public:
    explicit Nodes(KeyTable<NodeKey, std::uint32_t>& number) : number_{&number} {}

    /// Counts a cell at its corners.
    void count(const CellWithValue& cell) {
        const Point centre = centre_of(cell.shape, cell.positions);
        const double weight = inverse_size(centre, cell.positions);
        for (std::size_t k = 0; k < cell.keys.size(); ++k) {
            Node& node = at(cell.keys[k]);
            ++node.count;
            const Point pull = (weight * pull_steps) * (centre - cell.positions[k]);
            for (std::size_t d = 0; d < 3; ++d) node.pull[d] += std::llround(pull[d]);
        }
    }
    /// Of all cells that have been counted.
    std::size_t node_count() const { return nodes_.size(); }
    /// Ends the counting.
    void make_room() {
        first_.assign(1, 0);
        for (const Node& node : nodes_) {
            first_.push_back(first_.back() + node.count);
            known_.push_back(lies_at_its_mean(node));
        }
        shares_.resize(first_.back());
        nodes_ = {};
    }
    /// Adds a cell that was counted, and keeps it where some mean is to be brought to its node.
    void add(const CellWithValue& cell) {
        RimCell rim{};
        rim.value = cell.value;
        rim.centre = centre_of(cell.shape, cell.positions);
        rim.weight = inverse_size(rim.centre, cell.positions);
        rim.corners = static_cast<std::uint8_t>(cell.keys.size());
        if (std::isfinite(cell.value)) range_.add(cell.value);
        bool is_rim = false;
        for (std::size_t k = 0; k < cell.keys.size(); ++k) {
            rim.position[k] = cell.positions[k];
            rim.node[k] = *number_->find(cell.keys[k]);
            shares_[first_[rim.node[k]]++] = {cell.value, rim.weight};
            is_rim = is_rim || !known_[rim.node[k]];
        }
        if (is_rim) rim_.push_back(rim);
    }
    /// \param own how many nodes are corners of cells of this rank, in front of the others
    std::vector<double> values(int dimension, std::size_t own, const engine::CellsAcross& across) {
        std::vector<double> values(known_.size());
        std::vector<double> scratch;
        std::size_t begin = 0;
        for (std::size_t n = 0; n < values.size(); ++n) {
            values[n] =
                mean_of_shares(std::span(shares_).subspan(begin, first_[n] - begin), scratch);
            if (!std::isfinite(values[n]) || n >= own) known_[n] = false;
            begin = first_[n];
        }
        shares_ = {};
        agree_on_range(across);
        const double length = range_.high - range_.low;
        const Range limits{range_.low - length, range_.high + length};
        const auto tell = [&, key = keys(across)](const Settled& settled) {
            std::vector<engine::CellsAcross::Found> found;
            for (const auto& [node, value] : settled) {
                if (across.any()) found.push_back({key[node], value});
            }
            across.tell(found, [&](NodeKey node, double value) {
                const std::uint32_t* const number = number_->find(node);
                if (number == nullptr || *number < own) return;
                values[*number] = value;
                known_[*number] = true;
            });
            return across.any_rank(!settled.empty());
        };
        Settled inside;
        for (std::uint32_t n = 0; across.any() && n < own; ++n) {
            if (known_[n]) inside.emplace_back(n, values[n]);
        }
        tell(inside);
        Rim(dimension, limits, rim_, values, known_, own).settle(tell);
        return values;
    }
    double middle() const {
        return range_.low <= range_.high ? midpoint(range_.low, range_.high) : 0;
    }

private:
    struct Node {
        std::array<std::int64_t, 3> pull{};
        std::uint32_t count = 0;
    };

    /// The range of the cells of all ranks.
    void agree_on_range(const engine::CellsAcross& across) {
        double low = -range_.low;
        std::array<double*, 2> both{&low, &range_.high};
        across.take_greatest(both);
        range_.low = -low;
    }
    /// The keys of all nodes, where there are ranks.
    std::vector<NodeKey> keys(const engine::CellsAcross& across) const {
        std::vector<NodeKey> keys(across.any() ? known_.size() : 0);
        if (across.any()) number_->for_each([&](NodeKey key, std::uint32_t n) { keys[n] = key; });
        return keys;
    }
    Node& at(NodeKey key) {
        const auto [number, is_new] =
            number_->insert(key, static_cast<std::uint32_t>(nodes_.size()));
        if (is_new) nodes_.emplace_back();
        return nodes_[*number];
    }
    static bool lies_at_its_mean(const Node& node) {
        return std::all_of(node.pull.begin(), node.pull.end(), [&](std::int64_t pull) {
            return std::abs(pull) <= least_pull * static_cast<std::int64_t>(node.count);
        });
    }

    KeyTable<NodeKey, std::uint32_t>* number_;
    std::vector<Node> nodes_;
    std::vector<std::size_t> first_;  // share of each node; while they are added, the next one
    std::vector<Share> shares_;
    std::vector<bool> known_;
    std::vector<RimCell> rim_;
    Range range_;  // of all finite values of cells
};

}  // namespace

NodeMeans::NodeMeans(int dimension, const ForEachCell& for_each_cell,
                     const engine::SharedNodes* shared)
    : shared_{shared} {
    const engine::CellsAcross across(shared, for_each_cell);
    Nodes nodes(number_);
    engine::together(shared, "means of cells at nodes", [&] {
        for_each_cell([&](const CellWithValue& cell) { nodes.count(cell); });
        own_ = nodes.node_count();
        across.for_each([&](const CellWithValue& cell) { nodes.count(cell); });
        nodes.make_room();
        for_each_cell([&](const CellWithValue& cell) { nodes.add(cell); });
        across.for_each([&](const CellWithValue& cell) { nodes.add(cell); });
    });
    values_ = nodes.values(dimension, own_, across);
    middle_ = nodes.middle();
}

}  // namespace nestgrid::detail
