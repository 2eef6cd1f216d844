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

NetPart LeafRecords::part_of(const OnRecord& at) const {
    const Factors& factors = factors_of(records_[static_cast<std::size_t>(at.record)]);
    if (!at.is_whole()) return part_at(factors, std::span(at.at).first(at.count), at.level);
    NetPart part;
    part.factors = factors;
    for (std::size_t i = 0; i < at.count; ++i) {
        part.number[i] = static_cast<std::uint8_t>(at.at[i][0] + 2 * at.at[i][1]);
    }
    return part;
}

/// The coefficients of a record on a part of it. \param degree gets theirs
const double* LeafRecords::on_record(const OnRecord& at, const NetPart& there,
                                     std::size_t component, std::array<NetRoom, 2>& room,
                                     int& degree) const {
    degree = put_record(at, component, room[0]);
    if (at.is_whole()) return room[0].data();
    const Factors& factors = factors_of(records_[static_cast<std::size_t>(at.record)]);
    restrict_net(room[0].data(), degree, factors, there, room[1].data());
    return room[1].data();
}

NetFacts LeafRecords::facts_on(const OnRecord& part) const {
    const NetPart there = part_of(part);
    return joined_facts(drawn_, [&](std::size_t c) {
        std::array<NetRoom, 2> room;
        int degree = 0;
        const double* const net = on_record(part, there, c, room, degree);
        return net_facts(net, degree, there.factors);
    });
}

/// No two polynomials differ by more than their coefficients do, both raised to one degree.
PartFacts LeafRecords::compared(const LeafPolynomial& leaf, std::size_t number,
                                const OnRecord& on) const {
    const Record& record = records_[static_cast<std::size_t>(on.record)];
    if (&leaves_[record.leaf] == &leaf) return {facts_on(on), 0};
    const ShapeParts& shape = leaf.parts();
    const ShapePart& part = shape.parts[number];
    const NetPart there = part_of(on);
    // The leaf's own coefficients in the same order.
    const std::array<Place, 4> corners = corners_of(shape, part);
    std::array<Place, 4> sorted{};
    for (std::size_t i = 0; i < part.count; ++i) sorted[there.number[i]] = corners[i];
    const auto frame = std::span(sorted).first(frame_size(part));
    std::array<std::vector<double>, 3> differences;
    double jump = 0;
    PartFacts facts;
    facts.record = joined_facts(drawn_, [&](std::size_t c) {
        std::array<NetRoom, 2> room;
        NetRoom own;
        int degree = 0;
        const double* const other = on_record(on, there, c, room, degree);
        take(leaf, c, frame, there.factors, own.data());
        if (degree == int{leaf.degree} && drawn_ == 1) {
            const std::size_t size = net_size(degree, there.factors);
            for (std::size_t i = 0; i < size; ++i) {
                jump = std::max(jump, std::abs(own[i] - other[i]));
            }
        } else {
            const int greatest = std::max(degree, int{leaf.degree});
            differences[c] = elevated(own.data(), leaf.degree, there.factors, greatest);
            const auto of_record = elevated(other, degree, there.factors, greatest);
            for (std::size_t i = 0; i < of_record.size(); ++i) differences[c][i] -= of_record[i];
        }
        return net_facts(other, degree, there.factors);
    });
    for (std::size_t i = 0; i < differences[0].size(); ++i) {
        jump = std::max(jump, norm_of(drawn_, [&](std::size_t c) { return differences[c][i]; }));
    }
    facts.jump = jump;
    return facts;
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

}  // namespace nestgrid::engine
