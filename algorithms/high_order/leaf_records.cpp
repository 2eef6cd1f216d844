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

double* NetStore::add(std::size_t count) {
    if (count > left_) {
        constexpr std::size_t most = std::size_t{1} << 14U;
        left_ = std::max(count, std::min(size_, most));
        blocks_.push_back({std::make_unique_for_overwrite<double[]>(left_), left_});
        size_ += left_;
    }
    double* const added = blocks_.back().room.get() + (blocks_.back().size - left_);
    left_ -= count;
    return added;
}

void LeafRecords::claim(const LeafFunction& function, Task* task,
                        std::span<const BaseElement> way) {
    const auto number = static_cast<std::uint32_t>(leaves_.size());
    claim_parts(function, task, way, nullptr, number);
    LeafPolynomial& leaf = leaves_.emplace_back();
    leaf.number = number;
    leaf.shape = way.back().shape->shape;
    leaf.degree = static_cast<std::uint8_t>(degree_of(function, task, way));
}

void LeafRecords::end_claims() {
    leaves_.shrink_to_fit();
    records_.shrink_to_fit();
}

LeafRecords::LeafRecords(const LeafFunction& function, const BaseWalk& walk,
                         const LeafChoice& choice, const LeafSummary& summary)
    : components_{function.components()}, drawn_{function.drawn()} {
    if (choice.size() == 0) return;
    leaves_.resize(choice.size());
    if (!choice.all()) record_of_ = choice.parts();
    std::uint32_t number = 0;
    walk.for_each([&](Task* task, std::span<const BaseElement> way) {
        const BaseElement& e = way.back();
        if (e.member->rule != nullptr) return;
        const std::uint32_t* const own = choice.find(e.path);
        const auto index = own == nullptr ? static_cast<std::uint32_t>(leaves_.size()) : *own;
        const bool owns = claim_parts(function, task, way, &choice, index);
        if (owns || own != nullptr) {
            if (own == nullptr) leaves_.emplace_back();
            LeafPolynomial& leaf = leaves_[index];
            leaf.number = number;
            leaf.shape = e.shape->shape;
            leaf.degree = static_cast<std::uint8_t>(degree_of(function, task, way));
            read(function, task, way, index, nets_);
            leaf.jump = summary.jumps[number];
        }
        ++number;
    });
    if (record_of_.size() > 0) {
        RecordSearch search(*this);
        walk.for_each([&](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule != nullptr) return;
            const std::uint32_t* const own = choice.find(way.back().path);
            if (own != nullptr) add_parts(search, way, leaves_[*own]);
        });
    }
    end_claims();
    maps_.shrink_to_fit();
    of_part_.shrink_to_fit();
    record_of_ = {};
    map_number_ = {};
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
    const PartKeys keys = part_keys(e.key, *e.shape);
    for (std::size_t p = 0; p < e.shape->parts.size(); ++p) record_of_.prefetch(keys[p]);
    for (std::size_t p = 0; p < e.shape->parts.size(); ++p) {
        const ShapePart& part = e.shape->parts[p];
        std::uint32_t* const number =
            all ? record_of_.insert(keys[p], LeafChoice::none).first : record_of_.find(keys[p]);
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

void LeafRecords::read(const LeafFunction& function, Task* task, std::span<const BaseElement> way,
                       std::uint32_t number, NetStore& room) {
    const BaseElement& e = way.back();
    LeafPolynomial& leaf = leaves_[number];
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
    double* own = room.add(components_ * leaf.size());
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
void LeafRecords::add_parts(RecordSearch& search, std::span<const BaseElement> way,
                            LeafPolynomial& leaf) {
    const ShapeParts& shape = leaf.parts();
    leaf.first = static_cast<std::uint32_t>(of_part_.size());
    for (std::size_t p = 0; p < shape.parts.size(); ++p) {
        const std::array<Place, 4> corners = corners_of(shape, shape.parts[p]);
        // The frame of a quadrilateral is corner 0 and its two neighbours.
        const auto frame = std::span(corners).first(frame_size(shape.parts[p]));
        const OnRecord on = search.around(way, p, frame);
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

bool LeafRecords::coincides(const LeafPolynomial& leaf, const BaseElement& e, std::size_t part,
                            std::int32_t number) const {
    if (number < 0 || !leaf.parts().is_box) return false;
    const Record& record = records_[static_cast<std::size_t>(number)];
    const LeafPolynomial& owner = leaves_[record.leaf];
    if (&owner == &leaf) return true;
    if (!owner.parts().is_box || owner.degree != leaf.degree) return false;
    const std::size_t corners = frame_size(leaf.parts().parts[part]);
    const auto rows = [corners](const LeafPolynomial& of, const auto& frame) {
        const std::array<Place, 3> places = places_of(of.parts(), frame);
        return BoxRows(of.degree, of.factors(), std::span(places).first(corners));
    };
    const BoxRows own = rows(leaf, frame_corners(e.key, leaf.parts().parts[part]));
    const BoxRows other = rows(owner, record.corner);
    for (std::size_t c = 0; c < drawn_; ++c) {
        const double* const in_leaf = net(leaf, c);
        const double* const in_owner = net(owner, c);
        for (std::size_t j = 0; j < own.rows; ++j) {
            for (std::size_t i = 0; i < own.count; ++i) {
                if (in_leaf[own(i, j)] != in_owner[other(i, j)]) return false;
            }
        }
    }
    return true;
}

/// Looks from the coarse element down. What is found for parts of fathers serves all children.
auto RecordSearch::find(std::span<const BaseElement> way, PartOrCorner of) -> Found {
    const BaseElement& e = way.back();
    const bool is_part = of < e.shape->parts.size();
    const std::size_t level = way.size() - 1;
    if (is_part) {
        if (known_.size() <= level) known_.resize(level + 1);
        Known& known = known_[level];
        if (known.path != e.path) {
            known = {e.path, part_keys(e.key, *e.shape), {}};
            for (std::size_t p = 0; p < e.shape->parts.size(); ++p) {
                records_->record_of_.prefetch(known.key[p]);
            }
        }
        if (known.part[of].known) return known.part[of];
    }
    Found found;
    const int around = e.in_father == nullptr ? ShapeParts::inside : e.in_father->around[of];
    if (around != ShapeParts::inside) {
        found = find(way.first(level), static_cast<PartOrCorner>(around));
    }
    if (!is_part) return found;
    if (found.record == none) {
        const std::uint32_t* const record = records_->record_of_.find(known_[level].key[of]);
        if (record != nullptr && *record != LeafChoice::none) {
            found = {static_cast<std::int32_t>(*record), static_cast<std::uint32_t>(level),
                     static_cast<std::uint8_t>(of)};
        }
    }
    found.known = true;
    known_[level].part[of] = found;
    return found;
}

std::uint32_t RecordSearch::owner(std::span<const BaseElement> way, std::size_t part) {
    return records_->records_[static_cast<std::size_t>(find(way, part).record)].leaf;
}

std::int32_t RecordSearch::whole(std::span<const BaseElement> way, std::size_t part) {
    const Found found = find(way, part);
    return found.level + 1 == way.size() ? found.record : none;
}

OnRecord RecordSearch::around(std::span<const BaseElement> way, PartOrCorner of,
                              std::span<const Place> points) {
    const Found found = find(way, of);
    if (found.record == none) return {};
    const BaseElement& e = way[found.level];
    const int level = static_cast<int>(way.size() - 1 - found.level);
    const ShapePart& part = e.shape->parts[found.part];
    const std::array<Place, 3> corners = places_of(*e.shape, frame_corners(e.key, part));
    const PartFrame frame = frame_between(std::span(corners).first(frame_size(part)));
    OnRecord on{found.record, level, level, {}, points.size()};
    for (std::size_t i = 0; i < points.size(); ++i) {
        Place at = points[i];
        for (std::size_t j = way.size() - 1; j > found.level; --j) {
            at = (*way[j].in_father)(at, static_cast<int>(way.size() - 1 - j));
        }
        on.at[i] = frame(at, level);
    }
    return on;
}

std::size_t LeafRecords::memory_bytes() const {
    return leaves_.capacity() * sizeof(LeafPolynomial) + nets_.memory_bytes() +
           records_.capacity() * sizeof(Record) + maps_.capacity() * sizeof(RecordMap) +
           of_part_.capacity() * sizeof(PartRecord);
}

}  // namespace nestgrid::engine
