// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/leaf_records.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

namespace {

/// The corners of an element that make the frame of a part: that with the least key, then its
/// neighbours in the part, the one with the lesser key first.
std::array<std::uint8_t, 3> frame_corners(const CornerKeys& keys, const ShapePart& part) {
    std::array<std::uint8_t, 4> sorted = part.corner;
    const auto begin = sorted.begin();
    const auto end = begin + part.count;
    const std::uint8_t first =
        *std::min_element(begin, end, [&](auto a, auto b) { return keys[a] < keys[b]; });
    // Opposite to a corner of a quadrilateral lies the one with the other rank.
    const auto opposite = [&] {
        return part.corner[static_cast<std::size_t>(
            3 - (std::find(part.corner.begin(), part.corner.end(), first) - part.corner.begin()))];
    };
    const std::uint8_t left_out = part.count == 4 ? opposite() : first;
    std::array<std::uint8_t, 3> frame{first, first, first};
    std::size_t count = 1;
    for (auto k = begin; k != end; ++k) {
        if (*k != first && *k != left_out) frame[count++] = *k;
    }
    if (count == 3 && keys[frame[2]] < keys[frame[1]]) std::swap(frame[1], frame[2]);
    return frame;
}

}  // namespace

double* NetStore::add(std::size_t count, std::uint32_t needed_until, std::uint32_t now) {
    if (count > left_) {
        std::erase_if(blocks_, [&](const Block& block) {
            const bool goes = block.needed_until < now;
            if (goes) size_ -= block.size;
            return goes;
        });
        constexpr std::size_t most = std::size_t{1} << 14U;
        left_ = std::max(count, std::min(size_, most));
        blocks_.push_back({std::make_unique_for_overwrite<double[]>(left_), left_, 0});
        size_ += left_;
    }
    Block& block = blocks_.back();
    block.needed_until = std::max(block.needed_until, needed_until);
    double* const added = block.room.get() + (block.size - left_);
    left_ -= count;
    return added;
}

LeafRecords::LeafRecords(const LeafFunction& function, const BaseWalk& walk)
    : components_{function.components()}, drawn_{function.drawn()} {
    take_leaves(function, walk, nullptr);
}

/// Calls a function with the owners of the records on a leaf.
template <class Function>
void LeafRecords::for_each_owner(const LeafPolynomial& leaf, const Function& function) const {
    for (std::size_t part = 0; part < leaf.parts().parts.size(); ++part) {
        const std::int32_t record = of_part_[leaf.first + part].record;
        function(records_[static_cast<std::size_t>(record)].leaf);
    }
}

void LeafRecords::read_all(const LeafFunction& function, const BaseWalk& walk, LeafSummary& summary,
                           const std::function<void(std::uint32_t leaf)>& ready) {
    finish();
    std::vector<std::uint32_t> needed_until(leaves_.size());
    std::vector<std::array<std::uint32_t, 2>> late;  // when a leaf is ready, if not when it is read
    for (const LeafPolynomial& leaf : leaves_) {
        std::uint32_t when = leaf.number;
        for_each_owner(leaf, [&](std::uint32_t owner) { when = std::max(when, owner); });
        const auto need = [&](std::uint32_t of) {
            needed_until[of] = std::max(needed_until[of], when);
        };
        need(leaf.number);
        for_each_owner(leaf, need);
        if (when != leaf.number) late.push_back({when, leaf.number});
    }
    std::sort(late.begin(), late.end());
    auto next = late.begin();
    std::vector<bool> waits(leaves_.size());
    for (const auto& [when, leaf] : late) waits[leaf] = true;
    std::uint32_t number = 0;
    walk.for_each([&](Task* task, std::span<const BaseElement> way) {
        if (way.back().member->rule != nullptr) return;
        LeafPolynomial& leaf = leaves_[number];
        take_polynomial(function, task, way, leaf, needed_until[number]);
        summary.greatest_degree = std::max(summary.greatest_degree, int{leaf.degree});
        const std::size_t size = net_size(leaf.degree, leaf.factors());
        for (std::size_t c = 0; c < components_; ++c) {
            const auto [least, greatest] = std::minmax_element(net(leaf, c), net(leaf, c) + size);
            summary.least[c] = std::min(summary.least[c], *least);
            summary.greatest[c] = std::max(summary.greatest[c], *greatest);
        }
        if (!waits[number]) ready(number);
        for (; next != late.end() && (*next)[0] == number; ++next) ready((*next)[1]);
        ++number;
    });
}

LeafRecords::LeafRecords(const LeafFunction& function, const BaseWalk& walk,
                         const LeafChoice& choice, const LeafSummary& summary)
    : components_{function.components()}, drawn_{function.drawn()} {
    if (choice.size() == 0) return;
    take_leaves(function, walk, &choice);
    for (LeafPolynomial& leaf : leaves_) leaf.jump = summary.jumps[leaf.number];
    finish();
}

/// Takes leaves that are looked at and owners, and finds the records of the first ones.
/// \param choice null: all leaves, without polynomials
void LeafRecords::take_leaves(const LeafFunction& function, const BaseWalk& walk,
                              const LeafChoice* choice) {
    std::uint32_t number = 0;
    if (choice != nullptr) {
        leaves_.resize(choice->size());
        if (!choice->all()) record_of_ = choice->parts();
    }
    const auto chosen = [&](const BaseElement& e) {
        if (choice == nullptr) return number;
        const std::uint32_t* const at = choice->find(e.path);
        return at == nullptr ? LeafChoice::none : *at;
    };
    walk.for_each([&](Task* task, std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        if (e.member->rule != nullptr) return;
        const std::uint32_t own = chosen(e);
        const auto index =
            own == LeafChoice::none ? static_cast<std::uint32_t>(leaves_.size()) : own;
        const bool owns = claim_parts(function, task, way, choice, index);
        if (owns || own != LeafChoice::none) {
            if (index >= leaves_.size()) leaves_.emplace_back();
            LeafPolynomial& leaf = leaves_[index];
            leaf.number = number;
            leaf.shape = e.shape->shape;
            leaf.degree = static_cast<std::uint8_t>(degree_of(function, task, way));
            if (choice != nullptr) take_polynomial(function, task, way, leaf);
        }
        ++number;
    });
    if (record_of_.size() == 0) return;
    number = 0;
    walk.for_each([&](Task*, std::span<const BaseElement> way) {
        if (way.back().member->rule != nullptr) return;
        const std::uint32_t own = chosen(way.back());
        if (own != LeafChoice::none) add_parts(way, leaves_[own]);
        ++number;
    });
}

/// \throw GridError where a degree is not 1 to 8
int LeafRecords::degree_of(const LeafFunction& function, Task* task,
                           std::span<const BaseElement> way) {
    const int degree = function.degree(task, way.back().member->element);
    if (degree >= 1 && degree <= max_degree) return degree;
    throw GridError(BaseWalk::name(way) + " has the " + function.degree_name() + " " +
                    std::to_string(degree) + ", not 1 to " + std::to_string(max_degree));
}

/// Makes the last element on the way the owner of those of its parts that may have records, and no
/// owner that goes before it. \return whether there is one
bool LeafRecords::claim_parts(const LeafFunction& function, Task* task,
                              std::span<const BaseElement> way, const LeafChoice* choice,
                              std::uint32_t index) {
    const BaseElement& e = way.back();
    const bool all = choice == nullptr || choice->all();
    if (!all && !choice->may_have_record(e)) return false;
    int degree = 0;
    bool owns = false;
    for (std::size_t p = 0; p < e.shape->parts.size(); ++p) {
        const ShapePart& part = e.shape->parts[p];
        const NodeKey key = part_key(e.key, part);
        std::uint32_t* const number =
            all ? record_of_.insert(key, LeafChoice::none).first : record_of_.find(key);
        if (number == nullptr) continue;
        if (degree == 0) degree = degree_of(function, task, way);
        if (*number == LeafChoice::none) {
            *number = static_cast<std::uint32_t>(records_.size());
            records_.emplace_back();
        } else {
            const std::uint32_t owner = records_[*number].leaf;
            if (owner == index || leaves_[owner].degree <= degree) continue;
        }
        records_[*number] = {index, frame_corners(e.key, part), static_cast<std::uint8_t>(p)};
        owns = true;
    }
    return owns;
}

/// Takes the polynomial of the last element on the way.
void LeafRecords::take_polynomial(const LeafFunction& function, Task* task,
                                  std::span<const BaseElement> way, LeafPolynomial& leaf,
                                  std::uint32_t needed_until) {
    const BaseElement& e = way.back();
    const int degree = leaf.degree;
    const Factors& factors = e.shape->factors;
    thread_local std::map<std::pair<Shape, int>, std::vector<Point>> all_points;
    std::vector<Point>& points = all_points[{e.shape->shape, degree}];
    if (points.empty()) {
        points =
            e.shape->shape == Shape::pyramid ? pyramid_points(degree) : net_points(degree, factors);
    }
    thread_local std::vector<double> values;
    values.resize(points.size() * components_);
    function.evaluate(task, e.member->element, points, values);
    double* own = nets_.add(components_ * leaf.size(), needed_until, leaf.number);
    leaf.net = own;
    double jump = 0;
    for (std::size_t c = 0; c < components_; ++c, own += leaf.size()) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            own[i] = values[i * components_ + c];
            if (!std::isfinite(own[i])) {
                throw GridError(function.operation() + " gives no finite number in " +
                                BaseWalk::name(way));
            }
        }
        to_coefficients(own, degree, factors);
        if (leaf.shape != Shape::pyramid) continue;
        const double off = put_triangle_nets(own, degree, own + points.size());
        if (c < drawn_) jump = norm_of(2, [&](std::size_t i) { return i == 0 ? jump : off; });
    }
    leaf.jump = detail::float_above(jump);
}

/// Finds the records of the last element on the way, a leaf.
void LeafRecords::add_parts(std::span<const BaseElement> way, LeafPolynomial& leaf) {
    const ShapeParts& shape = leaf.parts();
    leaf.first = static_cast<std::uint32_t>(of_part_.size());
    for (const ShapePart& part : shape.parts) {
        const std::array<Place, 4> corners = corners_of(shape, part);
        // The frame of a quadrilateral is corner 0 and its two neighbours.
        const auto frame = std::span(corners).first(frame_size(part));
        const OnRecord on = around(way, frame);
        const PartFrame own = frame_between(frame);
        RecordMap map;
        map.shift = static_cast<std::uint8_t>(on.shift);
        for (std::size_t i = 0; i < 2; ++i) {
            std::int64_t low = on.at[0][i];
            for (std::size_t d = 0; d < 3; ++d) {
                std::int64_t step = 0;
                for (std::size_t k = 1; k < frame.size(); ++k) {
                    step += (on.at[k][i] - on.at[0][i]) * own.row[k - 1][d];
                }
                map.step[i][d] = static_cast<std::int8_t>(step);
                low -= step * own.origin[d];
            }
            map.low[i] = static_cast<std::int32_t>(low);
        }
        const auto [number, is_new] =
            map_number_.emplace(map, static_cast<std::uint32_t>(maps_.size()));
        if (is_new) maps_.push_back(map);
        of_part_.push_back({on.record, number->second});
    }
}

/// Looks for the largest edge or face of a leaf around, from the coarse element down.
OnRecord LeafRecords::around(std::span<const BaseElement> way,
                             std::span<const Place> points) const {
    OnRecord on;
    const auto finds = [&](const BaseElement& e, std::size_t number, std::span<const Place> at,
                           int level) {
        const ShapePart& part = e.shape->parts[number];
        const NodeKey key = part_key(e.key, part);
        const std::uint32_t* const record = record_of_.find(key);
        if (record == nullptr || *record == LeafChoice::none) return false;
        const std::array<Place, 3> corners = places_of(*e.shape, frame_corners(e.key, part));
        const PartFrame frame = frame_between(std::span(corners).first(frame_size(part)));
        on = {static_cast<std::int32_t>(*record), level, level, {}, points.size()};
        for (std::size_t i = 0; i < at.size(); ++i) on.at[i] = frame(at[i], level);
        return true;
    };
    look_around(way, points, finds);
    return on;
}

std::size_t LeafRecords::memory_bytes() const {
    return leaves_.capacity() * sizeof(LeafPolynomial) + nets_.memory_bytes() +
           records_.capacity() * sizeof(Record) + maps_.capacity() * sizeof(RecordMap) +
           of_part_.capacity() * sizeof(PartRecord);
}

void LeafRecords::finish() {
    leaves_.shrink_to_fit();
    records_.shrink_to_fit();
    maps_.shrink_to_fit();
    of_part_.shrink_to_fit();
    record_of_ = {};
    map_number_ = {};
}

}  // namespace nestgrid::engine
