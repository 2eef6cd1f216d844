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

/// Places of the corners of a frame. \param count 2 or 3
std::array<Place, 3> places_of(const ShapeParts& shape, const std::array<std::uint8_t, 3>& frame) {
    std::array<Place, 3> places;
    for (std::size_t i = 0; i < 3; ++i) places[i] = shape.reference_corner(frame[i]);
    return places;
}

}  // namespace

std::array<Place, 4> corners_of(const ShapeParts& shape, const ShapePart& part) {
    std::array<Place, 4> corners{};
    for (std::size_t i = 0; i < part.count; ++i) {
        corners[i] = shape.reference_corner(part.corner[i]);
    }
    return corners;
}

LeafRecords::LeafRecords(const LeafFunction& function, const BaseWalk& walk)
    : components_{function.components()},
      drawn_{function.drawn()},
      least_(components_, std::numeric_limits<double>::infinity()),
      greatest_(components_, -std::numeric_limits<double>::infinity()) {
    std::vector<double> values;
    walk.for_each([&](Task* task, std::span<const BaseElement> way) {
        if (way.back().member->rule == nullptr) add_leaf(function, task, way, values);
    });
    std::size_t leaf = 0;
    walk.for_each([&](Task*, std::span<const BaseElement> way) {
        if (way.back().member->rule == nullptr) add_parts(way, leaves_[leaf++]);
    });
    for (std::size_t l = 0; l < leaves_.size(); ++l) {
        for (std::size_t part = 0; part < leaves_[l].parts().parts.size(); ++part) {
            raise_jump(l, jump_on(leaves_[l], part));
        }
    }
}

/// Takes the polynomial of the last element on the way.
void LeafRecords::add_leaf(const LeafFunction& function, Task* task,
                           std::span<const BaseElement> way, std::vector<double>& values) {
    const BaseElement& e = way.back();
    const int degree = function.degree(task, e.member->element);
    if (degree < 1 || degree > max_degree) {
        throw GridError(BaseWalk::name(way) + " has the " + function.degree_name() + " " +
                        std::to_string(degree) + ", not 1 to " + std::to_string(max_degree));
    }
    const Factors& factors = e.shape->factors;
    thread_local std::map<std::pair<Shape, int>, std::vector<Point>> all_points;
    std::vector<Point>& points = all_points[{e.shape->shape, degree}];
    if (points.empty()) {
        points =
            e.shape->shape == Shape::pyramid ? pyramid_points(degree) : net_points(degree, factors);
    }
    values.resize(points.size() * components_);
    function.evaluate(task, e.member->element, points, values);
    LeafPolynomial leaf;
    leaf.net = nets_.size();
    leaf.degree = static_cast<std::uint8_t>(degree);
    leaf.shape = e.shape->shape;
    greatest_degree_ = std::max(greatest_degree_, degree);
    double jump = 0;
    for (std::size_t c = 0; c < components_; ++c) {
        const std::size_t at = nets_.size();
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double value = values[i * components_ + c];
            if (!std::isfinite(value)) {
                throw GridError(function.operation() + " gives no finite number in " +
                                BaseWalk::name(way));
            }
            nets_.push_back(value);
        }
        to_coefficients(nets_.data() + at, degree, factors);
        for (std::size_t i = 0; i < points.size(); ++i) {
            least_[c] = std::min(least_[c], nets_[at + i]);
            greatest_[c] = std::max(greatest_[c], nets_[at + i]);
        }
        if (leaf.shape != Shape::pyramid) continue;
        nets_.resize(at + leaf.size());
        const double* const own = nets_.data() + at;
        const double off = put_triangle_nets(own, degree, nets_.data() + at + points.size());
        if (c < drawn_) jump = norm_of(2, [&](std::size_t i) { return i == 0 ? jump : off; });
    }
    leaf.jump = detail::float_above(jump);
    const auto number = static_cast<std::uint32_t>(leaves_.size());
    for (const ShapePart& part : e.shape->parts) {
        const auto [owner, is_new] = owner_.insert(part_key(e.key, part), number);
        if (!is_new && leaves_[*owner].degree > degree) *owner = number;
    }
    leaf_of_.insert(e.path, number);
    leaves_.push_back(leaf);
    corners_.push_back(e.key);
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

/// The record of a part of a leaf with this key; it is made when it is first asked for.
std::int32_t LeafRecords::record_of(NodeKey key) {
    const auto [number, is_new] =
        record_number_.insert(key, static_cast<std::int32_t>(records_.size()));
    if (!is_new) return *number;
    const std::uint32_t owner = *owner_.find(key);
    const std::vector<ShapePart>& parts = leaves_[owner].parts().parts;
    std::uint8_t part = 0;
    while (part_key(corners_[owner], parts[part]) != key) ++part;
    records_.push_back({owner, frame_corners(corners_[owner], parts[part]), part});
    return *number;
}

/// Looks for the largest edge or face of a leaf around, from the coarse element down.
OnRecord LeafRecords::around(std::span<const BaseElement> way, std::span<const Place> points) {
    std::vector<std::array<Place, 4>> seen(way.size());  // from each element on the way
    std::copy(points.begin(), points.end(), seen.back().begin());
    const int last = static_cast<int>(way.size()) - 1;
    const auto index = [](int j) { return static_cast<std::size_t>(j); };
    for (int j = last; j > 0; --j) {
        const BaseElement& father = way[index(j - 1)];
        const Rule& rule = *father.member->rule;
        const Child& child = rule.children[way[index(j)].number];
        for (std::size_t i = 0; i < points.size(); ++i) {
            seen[index(j - 1)][i] =
                father.shape->in_father(rule, child, seen[index(j)][i], last - j);
        }
    }
    for (int j = 0; j <= last; ++j) {
        const BaseElement& e = way[index(j)];
        FaceMask faces = ~FaceMask{0};
        for (std::size_t i = 0; i < points.size(); ++i) {
            faces &= e.shape->faces_at(seen[index(j)][i], last - j);
        }
        const int number = e.shape->part_in(faces);
        if (number < 0) continue;
        const ShapePart& part = e.shape->parts[static_cast<std::size_t>(number)];
        const NodeKey key = part_key(e.key, part);
        if (owner_.find(key) == nullptr) continue;
        const std::array<Place, 3> corners = places_of(*e.shape, frame_corners(e.key, part));
        const PartFrame frame = frame_between(std::span(corners).first(frame_size(part)));
        OnRecord on{record_of(key), last - j, last - j, {}, points.size()};
        for (std::size_t i = 0; i < points.size(); ++i) {
            on.at[i] = frame(seen[index(j)][i], last - j);
        }
        return on;
    }
    return {};
}

OnRecord LeafRecords::on_part(const LeafPolynomial& leaf, std::size_t part,
                              std::span<const Place> points, int level) const {
    const PartRecord& of = of_part_[leaf.first + part];
    const RecordMap& map = maps_[of.map];
    OnRecord on{of.record, map.shift, level + map.shift, {}, points.size()};
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Place& x = points[k];
        for (std::size_t i = 0; i < 2; ++i) {
            const auto& step = map.step[i];
            on.at[k][i] = map.low[i] * (std::int64_t{1} << level) + step[0] * x[0] +
                          step[1] * x[1] + step[2] * x[2];
        }
    }
    return on;
}

const Factors& LeafRecords::factors_of(const Record& record) const {
    return leaves_[record.leaf].parts().parts[record.part].factors;
}

/// Copies the coefficients on an edge or face of a leaf.
void LeafRecords::take(const LeafPolynomial& leaf, std::size_t component,
                       std::span<const Place> frame, const Factors& part, double* out) const {
    const double* const own = net(leaf, component);
    if (leaf.shape == Shape::pyramid) {
        const double* const triangles = own + net_size(leaf.degree, leaf.factors());
        return take_pyramid_part(own, triangles, leaf.degree, frame, part, out);
    }
    take_part(own, leaf.degree, leaf.factors(), frame, part, out);
}

/// Puts the coefficients of a record in its frame. \return its degree
int LeafRecords::put_record(const OnRecord& at, std::size_t component, NetRoom& to) const {
    const Record& record = records_[static_cast<std::size_t>(at.record)];
    const LeafPolynomial& owner = leaves_[record.leaf];
    const ShapeParts& shape = owner.parts();
    const ShapePart& part = shape.parts[record.part];
    const std::array<Place, 3> frame = places_of(shape, record.corner);
    take(owner, component, std::span(frame).first(frame_size(part)), part.factors, to.data());
    return owner.degree;
}

NetFacts LeafRecords::facts_on(const OnRecord& part) const {
    const Factors& factors = factors_of(records_[static_cast<std::size_t>(part.record)]);
    const NetPart there = part_at(factors, std::span(part.at).first(part.count), part.level);
    return joined_facts(drawn_, [&](std::size_t c) {
        NetRoom whole;
        NetRoom own;
        const int degree = put_record(part, c, whole);
        restrict_net(whole.data(), degree, factors, there, own.data());
        return net_facts(own.data(), degree, there.factors);
    });
}

NetFacts LeafRecords::facts_on(const LeafPolynomial& leaf, std::size_t part) const {
    const ShapeParts& shape = leaf.parts();
    const std::array<Place, 4> corners = corners_of(shape, shape.parts[part]);
    return facts_on(on_part(leaf, part, std::span(corners).first(shape.parts[part].count), 0));
}

void LeafRecords::values_at(const OnRecord& point, double* out) const {
    NetRoom whole;
    const Factors& factors = factors_of(records_[static_cast<std::size_t>(point.record)]);
    const NetPart there = part_at(factors, std::span(point.at).first(1), point.level);
    for (std::size_t c = 0; c < components_; ++c) {
        const int degree = put_record(point, c, whole);
        restrict_net(whole.data(), degree, factors, there, out + c);
    }
}

std::uint32_t LeafRecords::in_owner(const OnRecord& part, std::array<Place, 4>& points) const {
    const Record& record = records_[static_cast<std::size_t>(part.record)];
    const std::array<Place, 3> frame = places_of(leaves_[record.leaf].parts(), record.corner);
    for (std::size_t i = 0; i < part.count; ++i) {
        for (std::size_t d = 0; d < 3; ++d) {
            points[i][d] = frame[0][d] * (std::int64_t{1} << part.level) +
                           part.at[i][0] * (frame[1][d] - frame[0][d]) +
                           part.at[i][1] * (frame[2][d] - frame[0][d]);
        }
    }
    return record.leaf;
}

void LeafRecords::raise_jump(std::size_t leaf, double jump) {
    leaves_[leaf].jump = std::max(leaves_[leaf].jump, detail::float_above(jump));
}

double LeafRecords::jump() const {
    float jump = 0;
    for (const LeafPolynomial& leaf : leaves_) jump = std::max(jump, leaf.jump);
    return static_cast<double>(jump);
}

/// Compares the coefficients of a leaf on one of its parts with those of the record there, both
/// raised to one degree: no two polynomials differ by more than their coefficients do.
double LeafRecords::jump_on(const LeafPolynomial& leaf, std::size_t number) const {
    const ShapeParts& shape = leaf.parts();
    const ShapePart& part = shape.parts[number];
    const std::array<Place, 4> corners = corners_of(shape, part);
    const OnRecord on = on_part(leaf, number, std::span(corners).first(part.count), 0);
    const Factors& factors = factors_of(records_[static_cast<std::size_t>(on.record)]);
    const NetPart there = part_at(factors, std::span(on.at).first(part.count), on.level);
    // The leaf's own coefficients in the same order.
    std::array<Place, 4> sorted{};
    for (std::size_t i = 0; i < part.count; ++i) sorted[there.number[i]] = corners[i];
    std::array<std::vector<double>, 3> differences;
    for (std::size_t c = 0; c < drawn_; ++c) {
        NetRoom whole;
        NetRoom other;
        NetRoom own;
        const int degree = put_record(on, c, whole);
        restrict_net(whole.data(), degree, factors, there, other.data());
        take(leaf, c, std::span(sorted).first(frame_size(part)), there.factors, own.data());
        const int greatest = std::max(degree, int{leaf.degree});
        differences[c] = elevated(own.data(), leaf.degree, there.factors, greatest);
        const auto of_record = elevated(other.data(), degree, there.factors, greatest);
        for (std::size_t i = 0; i < of_record.size(); ++i) differences[c][i] -= of_record[i];
    }
    double jump = 0;
    for (std::size_t i = 0; i < differences[0].size(); ++i) {
        jump = std::max(jump, norm_of(drawn_, [&](std::size_t c) { return differences[c][i]; }));
    }
    return jump;
}

std::size_t LeafRecords::memory_bytes() const {
    return leaves_.capacity() * sizeof(LeafPolynomial) + nets_.capacity() * sizeof(double) +
           records_.capacity() * sizeof(Record) + maps_.capacity() * sizeof(RecordMap) +
           of_part_.capacity() * sizeof(PartRecord) + leaf_of_.memory_bytes();
}

void LeafRecords::finish() {
    leaves_.shrink_to_fit();
    nets_.shrink_to_fit();
    records_.shrink_to_fit();
    maps_.shrink_to_fit();
    of_part_.shrink_to_fit();
    corners_ = {};
    owner_ = {};
    record_number_ = {};
    map_number_ = {};
}

}  // namespace nestgrid::engine
