// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What records of edges and faces say: their values, beta and ranges.
#include <algorithm>
#include <cmath>

#include <high_order/leaf_records.hpp>

namespace nestgrid::engine {

std::array<Place, 4> corners_of(const ShapeParts& shape, const ShapePart& part) {
    std::array<Place, 4> corners{};
    for (std::size_t i = 0; i < part.count; ++i) {
        corners[i] = shape.reference_corner(part.corner[i]);
    }
    return corners;
}

std::array<Place, 3> places_of(const ShapeParts& shape, const std::array<std::uint8_t, 3>& frame) {
    std::array<Place, 3> places;
    for (std::size_t i = 0; i < 3; ++i) places[i] = shape.reference_corner(frame[i]);
    return places;
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

PartOfLeaf LeafRecords::in_owner(const OnRecord& part) const {
    const Record& record = records_[static_cast<std::size_t>(part.record)];
    const LeafPolynomial& owner = leaves_[record.leaf];
    const std::array<Place, 3> frame = places_of(owner.parts(), record.corner);
    PartOfLeaf in{owner.number, part.level, {}, part.count};
    for (std::size_t i = 0; i < part.count; ++i) {
        for (std::size_t d = 0; d < 3; ++d) {
            in.corner[i][d] = frame[0][d] * (std::int64_t{1} << part.level) +
                              part.at[i][0] * (frame[1][d] - frame[0][d]) +
                              part.at[i][1] * (frame[2][d] - frame[0][d]);
        }
    }
    return in;
}

float LeafRecords::jump_of(const LeafPolynomial& leaf) const {
    float jump = leaf.jump;
    for (std::size_t part = 0; part < leaf.parts().parts.size(); ++part) {
        jump = std::max(jump, detail::float_above(jump_on(leaf, part)));
    }
    return jump;
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

}  // namespace nestgrid::engine
