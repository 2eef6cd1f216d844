// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/leaf_records.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

LeafRecords::LeafRecords(const Hierarchy<double>& base, const BaseWalk& walk)
    : base_{&base},
      dimension_{walk.dimension()},
      components_{static_cast<std::size_t>(base.facts().components)},
      least_{std::numeric_limits<double>::infinity()},
      greatest_{-std::numeric_limits<double>::infinity()} {
    std::vector<double> values;
    walk.for_each([&](Task* task, std::span<const BaseElement> way) {
        if (way.back().member->rule == nullptr) add_leaf(task, way, values);
    });
    std::size_t leaf = 0;
    walk.for_each([&](Task*, std::span<const BaseElement> way) {
        if (way.back().member->rule != nullptr) return;
        LeafPolynomial& to = leaves_[leaf++];
        for (PartCode part = 0; part + 1 < part_count(dimension_); ++part) {
            const unsigned span = span_of(part, dimension_);
            if (span == 0) continue;
            const unsigned low = low_corner_of(part, dimension_);
            to.part[part] = place_of(way, span, {low & 1U, low >> 1U & 1U, low >> 2U});
        }
    });
    find_jumps();
}

/// Takes the polynomial of the last element on the way.
void LeafRecords::add_leaf(Task* task, std::span<const BaseElement> way,
                           std::vector<double>& values) {
    const BaseElement& e = way.back();
    const int degree = base_->degree(task, e.member->element);
    if (degree < 1 || degree > max_degree) {
        throw GridError(BaseWalk::name(way) + " has the degree " + std::to_string(degree) +
                        ", not 1 to " + std::to_string(max_degree));
    }
    static const auto grids = [] {
        std::array<std::array<std::vector<Point>, max_degree + 1>, 4> all;
        for (int d = 2; d <= 3; ++d) {
            for (int p = 1; p <= max_degree; ++p) {
                all[static_cast<std::size_t>(d)][static_cast<std::size_t>(p)] = lobatto_grid(p, d);
            }
        }
        return all;
    }();
    const std::vector<Point>& points =
        grids[static_cast<std::size_t>(dimension_)][static_cast<std::size_t>(degree)];
    values.resize(points.size() * components_);
    base_->evaluate(task, e.member->element, points, values.data());
    LeafPolynomial leaf;
    leaf.net = nets_.size();
    leaf.degree = static_cast<std::uint8_t>(degree);
    greatest_degree_ = std::max(greatest_degree_, degree);
    for (std::size_t c = 0; c < components_; ++c) {
        const std::size_t at = nets_.size();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double value = values[i * components_ + c];
            if (!std::isfinite(value)) {
                throw GridError("evaluate() gives no finite number in " + BaseWalk::name(way));
            }
            nets_.push_back(value);
        }
        to_coefficients(nets_.data() + at, degree, dimension_);
    }
    const auto [lo, hi] =
        std::minmax_element(net(leaf), net(leaf) + static_cast<std::ptrdiff_t>(points.size()));
    least_ = std::min(least_, *lo);
    greatest_ = std::max(greatest_, *hi);
    const auto number = static_cast<std::uint32_t>(leaves_.size());
    for (PartCode part = 0; part + 1 < part_count(dimension_); ++part) {
        if (span_of(part, dimension_) == 0) continue;
        const auto [owner, is_new] = owner_.insert(part_key(e.key, part, dimension_), number);
        if (!is_new && leaves_[*owner].degree > degree) *owner = number;
    }
    leaf_of_.insert(e.path, number);
    leaves_.push_back(leaf);
    corners_.push_back(e.key);
}

/// The frame of a part that an element has.
auto LeafRecords::frame_of(const BoxKeys& corners, PartCode part) const -> Frame {
    const unsigned span = span_of(part, dimension_);
    const unsigned low = low_corner_of(part, dimension_);
    unsigned first = low;
    for (unsigned k = 0; k < 1U << dimension_; ++k) {
        if ((k & ~span) == low && corners[k] < corners[first]) first = k;
    }
    Frame frame;
    for (int d = 0; d < dimension_; ++d) {
        if ((span >> d & 1U) == 0) continue;
        frame.direction[static_cast<std::size_t>(frame.dimension++)] = static_cast<std::uint8_t>(d);
    }
    const auto neighbour = [&](std::size_t i) {
        return corners[first ^ (1U << frame.direction[i])];
    };
    if (frame.dimension == 2 && neighbour(1) < neighbour(0)) {
        std::swap(frame.direction[0], frame.direction[1]);
    }
    for (std::size_t i = 0; i < 2; ++i) frame.flipped[i] = (first >> frame.direction[i] & 1U) != 0;
    return frame;
}

/// The coefficients of a leaf on one of its parts, in the frame of the part.
std::vector<double> LeafRecords::trace(const LeafPolynomial& leaf, PartCode part,
                                       const Frame& frame, std::size_t component) const {
    const std::size_t n = leaf.degree + std::size_t{1};
    const std::array<std::size_t, 3> stride{1, n, n * n};
    const double* const from =
        net(leaf, component) + net_corner(leaf.degree, dimension_, low_corner_of(part, dimension_));
    std::vector<double> to;
    for (std::size_t j = 0; j < (frame.dimension == 2 ? n : 1); ++j) {
        for (std::size_t i = 0; i < n; ++i) {
            const std::array<std::size_t, 2> at{i, j};
            std::size_t offset = 0;
            for (std::size_t d = 0; d < static_cast<std::size_t>(frame.dimension); ++d) {
                const std::size_t k = frame.flipped[d] ? leaf.degree - at[d] : at[d];
                offset += k * stride[frame.direction[d]];
            }
            to.push_back(from[offset]);
        }
    }
    return to;
}

/// The record of a part of a leaf with this key; it is made when it is first asked for.
std::int32_t LeafRecords::record_of(NodeKey key) {
    const auto [number, is_new] =
        record_number_.insert(key, static_cast<std::int32_t>(records_.size()));
    if (!is_new) return *number;
    const std::uint32_t owner = *owner_.find(key);
    const LeafPolynomial& leaf = leaves_[owner];
    PartCode part = 0;
    while (span_of(part, dimension_) == 0 || part_key(corners_[owner], part, dimension_) != key) {
        ++part;
    }
    const Frame frame = frame_of(corners_[owner], part);
    records_.push_back(
        {record_nets_.size(), leaf.degree, static_cast<std::uint8_t>(frame.dimension)});
    for (std::size_t c = 0; c < components_; ++c) {
        const std::vector<double> coefficients = trace(leaf, part, frame, c);
        record_nets_.insert(record_nets_.end(), coefficients.begin(), coefficients.end());
    }
    return *number;
}

/// Looks for the largest edge or face of a leaf around, from the coarse element down.
RecordPlace LeafRecords::place_of(std::span<const BaseElement> way, unsigned span,
                                  const BoxPlace& at) {
    const int last = static_cast<int>(way.size()) - 1;
    for (int j = 0; j <= last; ++j) {
        const int shift = last - j;
        BoxPlace low{};  // of the element, in the one that is 2^shift as large
        for (int i = j + 1; i <= last; ++i) {
            const std::size_t child = way[static_cast<std::size_t>(i)].number;
            for (std::size_t d = 0; d < 3; ++d) {
                low[d] = 2 * low[d] + static_cast<std::uint32_t>(child >> d & 1U);
            }
        }
        BoxPlace begin = low;
        for (std::size_t d = 0; d < 3; ++d) begin[d] += at[d];
        const PartCode part = part_around(span, begin, shift, dimension_);
        if (part + 1 == part_count(dimension_)) continue;
        const BoxKeys& corners = way[static_cast<std::size_t>(j)].key;
        const NodeKey key = part_key(corners, part, dimension_);
        if (owner_.find(key) == nullptr) continue;
        const Frame frame = frame_of(corners, part);
        RecordPlace place;
        place.record = record_of(key);
        place.shift = static_cast<std::uint8_t>(shift);
        for (std::size_t i = 0; i < static_cast<std::size_t>(frame.dimension); ++i) {
            place.direction[i] = frame.direction[i];
            place.flipped[i] = frame.flipped[i];
            place.low[i] = low[frame.direction[i]];
        }
        return place;
    }
    return {};
}

/// Restricts a record to a part: along a direction of `span` to the part, along others to a point.
/// \return the dimension of the restricted net
int LeafRecords::restrict_record(const RecordPlace& of, unsigned span, const BoxPlace& at,
                                 int level, std::size_t component, Restricted& net) const {
    const Record& record = records_[static_cast<std::size_t>(of.record)];
    const std::size_t size = net_size(record.degree, record.dimension);
    std::copy_n(record_nets_.data() + record.net + component * size, size, net.begin());
    const int total = level + of.shift;
    int left = record.dimension;
    for (std::size_t i = 0; i < record.dimension; ++i) {
        const std::size_t d = of.direction[i];
        const bool spans = (span >> d & 1U) != 0;
        std::uint64_t x = (std::uint64_t{of.low[i]} << static_cast<unsigned>(level)) + at[d];
        if (of.flipped[i])
            x = (std::uint64_t{1} << static_cast<unsigned>(total)) - x - (spans ? 1 : 0);
        // Of the directions that are left, the one at hand is the last but those to come.
        const int direction = left - (record.dimension - static_cast<int>(i));
        if (spans) {
            for (int bit = total - 1; bit >= 0; --bit) {
                keep_half(net.data(), record.degree, left, direction,
                          static_cast<unsigned>(x >> static_cast<unsigned>(bit) & 1U));
            }
            continue;
        }
        // Along the direction at hand each line becomes its value.
        const double t = std::ldexp(static_cast<double>(x), -total);
        const std::size_t n = record.degree + std::size_t{1};
        const std::size_t rows = net_size(record.degree, left) / n;
        const std::size_t stride = direction == 0 ? 1 : n;
        Restricted result;
        for (std::size_t r = 0; r < rows; ++r) {
            std::array<double, max_degree + 1> line;
            const double* const from = net.data() + (direction == 0 ? r * n : r);
            for (std::size_t k = 0; k < n; ++k) line[k] = from[k * stride];
            result[r] = line_value(line.data(), record.degree, t);
        }
        std::copy_n(result.begin(), rows, net.begin());
        --left;
    }
    return left;
}

NetFacts LeafRecords::facts_on(const RecordPlace& of, unsigned span, const BoxPlace& at,
                               int level) const {
    Restricted net;
    const int dimension = restrict_record(of, span, at, level, 0, net);
    return net_facts(net.data(), records_[static_cast<std::size_t>(of.record)].degree, dimension);
}

void LeafRecords::values_at(const RecordPlace& of, const BoxPlace& at, int level,
                            double* out) const {
    Restricted net;
    for (std::size_t c = 0; c < components_; ++c) {
        restrict_record(of, 0, at, level, c, net);
        out[c] = net[0];
    }
}

void LeafRecords::raise_jump(std::size_t leaf, double jump) {
    leaves_[leaf].jump = std::max(leaves_[leaf].jump, float_above(jump));
}

double LeafRecords::jump() const {
    float jump = 0;
    for (const LeafPolynomial& leaf : leaves_) jump = std::max(jump, leaf.jump);
    return static_cast<double>(jump);
}

/// Compares the coefficients of each leaf on its parts with those of the records there, both raised
/// to one degree: no two polynomials differ by more than their coefficients do.
void LeafRecords::find_jumps() {
    for (std::size_t l = 0; l < leaves_.size(); ++l) {
        for (PartCode part = 0; part + 1 < part_count(dimension_); ++part) {
            const RecordPlace& place = leaves_[l].part[part];
            if (place.record < 0) continue;
            const unsigned span = span_of(part, dimension_);
            const unsigned low = low_corner_of(part, dimension_);
            Restricted net;
            const int dimension =
                restrict_record(place, span, {low & 1U, low >> 1U & 1U, low >> 2U}, 0, 0, net);
            // The leaf's own trace in the directions of the record.
            Frame frame;
            frame.dimension = dimension;
            const Record& record = records_[static_cast<std::size_t>(place.record)];
            for (std::size_t i = 0, to = 0; i < record.dimension; ++i) {
                if ((span >> place.direction[i] & 1U) == 0) continue;
                frame.direction[to] = place.direction[i];
                frame.flipped[to++] = place.flipped[i];
            }
            const std::vector<double> own = trace(leaves_[l], part, frame, 0);
            const int degree = std::max(record.degree, leaves_[l].degree);
            const auto a = elevated(own.data(), leaves_[l].degree, dimension, degree);
            const auto b = elevated(net.data(), record.degree, dimension, degree);
            double jump = 0;
            for (std::size_t i = 0; i < a.size(); ++i) jump = std::max(jump, std::abs(a[i] - b[i]));
            raise_jump(l, jump);
        }
    }
}

std::size_t LeafRecords::memory_bytes() const {
    return leaves_.capacity() * sizeof(LeafPolynomial) + nets_.capacity() * sizeof(double) +
           records_.capacity() * sizeof(Record) + record_nets_.capacity() * sizeof(double) +
           leaf_of_.memory_bytes();
}

void LeafRecords::finish() {
    leaves_.shrink_to_fit();
    nets_.shrink_to_fit();
    records_.shrink_to_fit();
    record_nets_.shrink_to_fit();
    corners_ = {};
    owner_ = {};
    record_number_ = {};
}

}  // namespace nestgrid::engine
