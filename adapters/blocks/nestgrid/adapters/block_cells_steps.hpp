// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of fields on blocks. Included at the end of block_fields.hpp.
#pragma once

#include <cmath>
#include <limits>
#include <utility>

namespace nestgrid {

namespace detail {

/// The number of a node among those of a split in tensor order.
/// \param half its place in halves of an edge
template <std::size_t size>
std::size_t number_in_split(const std::array<std::int32_t, size>& half) {
    std::size_t number = 0;
    for (std::size_t d = size; d-- > 0;) number = 3 * number + static_cast<std::size_t>(half[d]);
    return number;
}

/// Whether there are leaves of one level all around a node.
template <std::size_t count, int dim>
bool of_one_size(const std::array<BlockCell<dim>, count>& around) {
    bool same = true;
    for (const BlockCell<dim>& cell : around) {
        same = same && cell.box >= 0 && cell.level == around[0].level;
    }
    return same;
}

/// A mean and what a sharp rule adds, within the range of the cells. One function for all places
/// where it is computed, so that these have the same bits.
NESTGRID_NOINLINE inline double sharpened(double mean, double more, double low, double high) {
    return std::clamp(mean + more, std::min(low, mean), std::max(high, mean));
}

}  // namespace detail

template <int dim, class Real>
auto BlockCells<dim, Real>::hangs_on(const Around& around, const Place& node) const
    -> const BlockCell<dim>* {
    const BlockCell<dim>* largest = nullptr;
    for (const BlockCell<dim>& cell : around) {
        if (cell.box < 0 || (largest != nullptr && largest->level <= cell.level)) continue;
        const std::int32_t extent = reader_.grid().extent(static_cast<std::size_t>(cell.level));
        for (std::size_t d = 0; d < size_; ++d) {
            if ((node[d] & (extent - 1)) != 0) largest = &cell;
        }
    }
    return largest;
}

template <int dim, class Real>
template <class Use>
void BlockCells<dim, Real>::for_each_weight(const BlockCell<dim>& leaf, const Place& node,
                                            const Use& use) const {
    const std::int32_t extent = reader_.grid().extent(static_cast<std::size_t>(leaf.level));
    for (std::size_t k = 0; k < std::size_t{1} << size_; ++k) {
        double weight = 1;
        Place corner = leaf.low;
        for (std::size_t d = 0; d < size_; ++d) {
            const double part = static_cast<double>(node[d] - leaf.low[d]) / extent;
            weight *= (k >> d & 1U) != 0 ? part : 1 - part;
            corner[d] += (k >> d & 1U) != 0 ? extent : 0;
        }
        if (weight != 0) use(corner, weight);
    }
}

template <int dim, class Real>
template <class ValueAt>
double BlockCells<dim, Real>::interpolant(const BlockCell<dim>& leaf, const Place& node,
                                          const ValueAt& at) const {
    double sum = 0;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for_each_weight(leaf, node, [&](const Place& corner, double weight) {
        const double value = at(corner);
        sum += weight * value;
        low = std::min(low, value);
        high = std::max(high, value);
    });
    return std::isfinite(sum) ? std::clamp(sum, low, high) : sum;
}

/// The mean of leaves around a node, all of which have it for a corner.
template <int dim, class Real>
template <class ValueOf>
auto BlockCells<dim, Real>::mean(const Around& around, const ValueOf& of) const -> Mean {
    if (detail::of_one_size(around)) {
        detail::PatchNumbers<dim, 2> values;
        for (std::size_t k = 0; k < around.size(); ++k) values[k] = of(around[k]);
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        const double offset =
            reader_.grid().extent(static_cast<std::size_t>(around[0].level)) / 2.0;
        return {detail::means_in<dim, 2>(values)[0], offset, *low, *high};
    }
    double total = 0;
    int count = 0;
    std::array<double, static_cast<std::size_t>(1 << dim)> weight{};
    for (std::size_t k = 0; k < around.size(); ++k) {
        if (around[k].box < 0) continue;
        weight[k] = 1.0 / reader_.grid().extent(static_cast<std::size_t>(around[k].level));
        total += weight[k];
        ++count;
    }
    Mean mean;
    mean.offset = count / (2 * total);
    mean.low = std::numeric_limits<double>::infinity();
    mean.high = -mean.low;
    for (std::size_t k = 0; k < around.size(); ++k) {
        if (around[k].box < 0) continue;
        const double value = of(around[k]);
        mean.value += weight[k] / total * value;
        mean.low = std::min(mean.low, value);
        mean.high = std::max(mean.high, value);
    }
    // Equal values give that value, whatever the rounding of the weights.
    if (std::isfinite(mean.value)) mean.value = std::clamp(mean.value, mean.low, mean.high);
    return mean;
}

/// The mean lies as far inside from each wall. The next node inside lies as far as the largest leaf
/// reaches, so it has all leaves around it for a corner, and the mean lies at most half-way to it.
template <int dim, class Real>
template <class ValueOf>
auto BlockCells<dim, Real>::brought(const Place& node, const Around& around,
                                    const ValueOf& of) const -> Mean {
    Mean here = mean(around, of);
    const BlockCell<dim>* largest = nullptr;
    for (const BlockCell<dim>& cell : around) {
        if (cell.box < 0) continue;
        if (largest == nullptr || cell.level < largest->level) largest = &cell;
    }
    const std::int32_t extent = reader_.grid().extent(static_cast<std::size_t>(largest->level));
    const Place end = reader_.grid().finest_size();
    Place next = node;
    for (std::size_t d = 0; d < size_; ++d) {
        if (node[d] == 0 && extent < end[d]) next[d] = extent;
        if (node[d] == end[d] && extent < end[d]) next[d] = end[d] - extent;
    }
    if (next == node) return here;
    const double inside = mean(reader_.grid().leaves_around(next, *largest), of).value;
    const double slope = (here.value - inside) / (extent - here.offset);
    if (std::isfinite(slope)) here.value += here.offset * slope;
    return here;
}

template <int dim, class Real>
class BlockCells<dim, Real>::Smooth {
public:
    explicit Smooth(const BlockCells& cells) : cells_{&cells} {}

    bool is_missing = false;

    double at(const Node& node) {
        std::size_t slot = hash(node.place);
        for (; state_[slot] != State::free; slot = (slot + 1) % slots) {
            if (place_[slot] != node.place) continue;
            is_missing = is_missing || state_[slot] == State::missing;
            return value_[slot];
        }
        const bool was_missing = std::exchange(is_missing, false);
        const double value = cells_->smooth(node, *this);
        if (count_ < slots / 2) {
            ++count_;
            place_[slot] = node.place;
            value_[slot] = value;
            state_[slot] = is_missing ? State::missing : State::known;
        }
        is_missing = is_missing || was_missing;
        return value;
    }

private:
    enum class State : std::uint8_t { free, known, missing };
    static constexpr std::size_t slots = 512;  // around an element there are up to 5^3 nodes

    static std::size_t hash(const Place& place) {
        std::uint64_t all = 0;
        for (const std::int32_t x : place) all = detail::mix64(all + static_cast<std::uint32_t>(x));
        return static_cast<std::size_t>(all % slots);
    }

    const BlockCells* cells_;
    std::size_t count_ = 0;
    std::array<State, slots> state_{};
    std::array<Place, slots> place_;
    std::array<double, slots> value_;
};

template <int dim, class Real>
double BlockCells<dim, Real>::cell_value(const BlockCell<dim>& cell, Smooth& known) const {
    if (reader_.has(cell)) return static_cast<double>(reader_.read(cell));
    known.is_missing = true;
    return 0;
}

template <int dim, class Real>
double BlockCells<dim, Real>::smooth(const Node& node, Smooth& known) const {
    const Around around = reader_.grid().leaves_around(node.place, node.near);
    if (const BlockCell<dim>* leaf = hangs_on(around, node.place)) {
        return interpolant(*leaf, node.place, [&](const Place& x) {
            return smooth({x, *leaf}, known);
        });
    }
    return brought(node.place, around,
                   [&](const BlockCell<dim>& cell) { return cell_value(cell, known); })
        .value;
}

/// By what the value of a cell differs from the mean of its corners; 0 where one is not finite.
template <int dim, class Real>
double BlockCells<dim, Real>::residual(const BlockCell<dim>& cell, Smooth& known) const {
    const std::int32_t extent = reader_.grid().extent(static_cast<std::size_t>(cell.level));
    detail::PatchNumbers<dim, 2> values;
    for (std::size_t k = 0; k < values.size(); ++k) {
        Node corner{cell.low, cell};
        for (std::size_t d = 0; d < size_; ++d) {
            corner.place[d] += (k >> d & 1U) != 0 ? extent : 0;
        }
        values[k] = known.at(corner);
    }
    const double mean = detail::means_in<dim, 2>(values)[0];
    return std::isfinite(mean) ? cell_value(cell, known) - mean : 0;
}

template <int dim, class Real>
double BlockCells<dim, Real>::value(const Node& node, Smooth& known) const {
    if (rule_ == CellRule::smooth) return smooth(node, known);
    const Around around = reader_.grid().leaves_around(node.place, node.near);
    if (const BlockCell<dim>* leaf = hangs_on(around, node.place)) {
        return interpolant(*leaf, node.place, [&](const Place& x) {
            return value({x, *leaf}, known);
        });
    }
    const Mean means = brought(node.place, around,
                               [&](const BlockCell<dim>& cell) { return cell_value(cell, known); });
    if (!std::isfinite(means.value)) return means.value;
    const double more = brought(node.place, around, [&](const BlockCell<dim>& cell) {
                            return residual(cell, known);
                        }).value;
    return detail::sharpened(means.value, part() * more, means.low, means.high);
}

template <int dim, class Real>
NodeMask BlockCells<dim, Real>::smooth_in_patch(const Element& e, NodeMask which,
                                                std::span<Real> out) const {
    detail::PatchNumbers<dim, 4> cells;
    const detail::Patch patch = reader_.template read_patch<4>(e, cells);
    if (patch == detail::Patch::none) return which;
    const auto means = detail::means_in<dim, 4>(cells);
    NodeMask left = 0;
    for (std::size_t n = 0; n < out.size(); ++n) {
        if ((which >> n & 1U) == 0) continue;
        const double mean = means[detail::number_in_split(reader_.grid().half(n))];
        out[n] = static_cast<Real>(mean);
        if (patch != detail::Patch::all && !std::isfinite(mean)) left |= NodeMask{1} << n;
    }
    return left;
}

template <int dim, class Real>
NodeMask BlockCells<dim, Real>::sharp_in_patch(const Element& e, NodeMask which,
                                               std::span<Real> out) const {
    detail::PatchNumbers<dim, 6> cells;
    const detail::Patch patch = reader_.template read_patch<6>(e, cells);
    if (patch == detail::Patch::none) return which;
    const bool is_whole = patch == detail::Patch::all;
    const auto smooth = detail::means_in<dim, 6>(cells);
    const auto inner = detail::middle_of<dim, 6>(cells);
    auto residual = detail::means_in<dim, 5>(smooth);
    for (std::size_t i = 0; i < inner.size(); ++i) {
        if (!is_whole || std::isfinite(residual[i])) {
            residual[i] = inner[i] - residual[i];
        } else {
            residual[i] = 0;
        }
    }
    const auto means = detail::middle_of<dim, 5>(smooth);
    const auto more = detail::means_in<dim, 4>(residual);
    const auto low =
        detail::combined<dim, 4>(inner, [](double a, double b) { return std::min(a, b); });
    const auto high =
        detail::combined<dim, 4>(inner, [](double a, double b) { return std::max(a, b); });
    NodeMask left = 0;
    for (std::size_t n = 0; n < out.size(); ++n) {
        if ((which >> n & 1U) == 0) continue;
        const std::size_t at = detail::number_in_split(reader_.grid().half(n));
        const bool is_number = std::isfinite(means[at]);
        out[n] = static_cast<Real>(
            is_number ? detail::sharpened(means[at], part() * more[at], low[at], high[at])
                      : means[at]);
        if (!is_whole && !std::isfinite(means[at] + more[at])) left |= NodeMask{1} << n;
    }
    return left;
}

template <int dim, class Real>
bool BlockNodes<dim, Real>::write(const Place& node, const BlockCell<dim>& near, Real& out) const {
    const BlockCell<dim>* finest = nullptr;
    const auto around = reader_.grid().leaves_around(node, near);
    for (const BlockCell<dim>& cell : around) {
        if (cell.box < 0) continue;
        const std::int32_t extent = reader_.grid().extent(static_cast<std::size_t>(cell.level));
        bool is_corner = true;
        for (const std::int32_t x : node) is_corner = is_corner && (x & (extent - 1)) == 0;
        if (!is_corner) continue;
        if (finest == nullptr || cell.level > finest->level ||
            (cell.level == finest->level && cell.box < finest->box)) {
            finest = &cell;
        }
    }
    if (!reader_.has(*finest)) return false;
    const std::int32_t extent = reader_.grid().extent(static_cast<std::size_t>(finest->level));
    Place offset{};
    for (std::size_t d = 0; d < offset.size(); ++d) {
        offset[d] = (node[d] - finest->low[d]) / extent;
    }
    out = reader_.read(*finest, offset);
    return true;
}

}  // namespace nestgrid
