// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements below a leaf: their coefficients, what of them is flat, and how far they are from what
// is drawn.
#include <algorithm>
#include <cmath>

#include <high_order/virtual_elements.hpp>

namespace nestgrid::engine {

bool VirtualElements::is_flat(const NetFacts& facts, int level) const {
    return level >= depth_ || facts.beta <= flat_;
}

namespace {

/// The coefficients of an element on an edge or a face of it.
/// \return their number
std::size_t take_part(const double* net, int degree, int dimension, const HalvedPart& part,
                      double* to) {
    const std::size_t n = static_cast<std::size_t>(degree) + 1;
    std::array<std::size_t, 2> stride{};
    std::size_t directions = 0;
    std::size_t low = 0;
    std::size_t step = 1;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d, step *= n) {
        if ((part.span >> d & 1U) != 0) {
            stride[directions++] = step;
        } else if (part.at[d] != 0) {
            low += step * static_cast<std::size_t>(degree);
        }
    }
    std::size_t count = 0;
    for (std::size_t j = 0; j < (directions == 2 ? n : 1); ++j) {
        for (std::size_t i = 0; i < n; ++i) to[count++] = net[low + i * stride[0] + j * stride[1]];
    }
    return directions;
}

}  // namespace

/// Finds the flat parts of an element below a leaf, from the side of the leaf.
auto VirtualElements::look(const VirtualElement& e, const double* net) const -> Looked {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    const unsigned all = (1U << static_cast<unsigned>(dimension_)) - 1;
    Looked looked{0, net_facts(net, leaf.degree, dimension_)};
    const bool flat_inside = is_flat(looked.facts, e.level);
    std::array<double, std::size_t{max_degree + 1} * (max_degree + 1)> on_part;
    for (std::size_t n = 0; n < halved_.size(); ++n) {
        const HalvedPart& part = halved_[n];
        BoxPlace at = e.place;
        for (std::size_t d = 0; d < 3; ++d) at[d] += part.at[d];
        const PartCode around = part_around(part.span, at, e.level, dimension_);
        bool flat = flat_inside;
        if (around + 1 != part_count(dimension_)) {
            const RecordPlace& place = leaf.part[around];
            const NetFacts facts = records_->facts_on(place, part.span, at, e.level);
            looked.facts.least = std::min(looked.facts.least, facts.least);
            looked.facts.greatest = std::max(looked.facts.greatest, facts.greatest);
            flat = is_flat(facts, e.level + place.shift);
        } else if (!flat_inside && part.span != all) {
            // Inside the leaf, on the surface of the element.
            const std::size_t directions =
                take_part(net, leaf.degree, dimension_, part, on_part.data());
            flat = is_flat(net_facts(on_part.data(), leaf.degree, static_cast<int>(directions)),
                           e.level);
        }
        looked.flat |= NodeMask{flat} << n;
    }
    return looked;
}

/// How far U may be from what is drawn between the corners: with A the affine function that fits
/// P_S U there best up to s, and r the greatest distance of U from it, r + s, because at a vertex,
/// where P_S U is what is drawn, A is within s of that, and so on triangles. Or what the element's
/// beta and the corners say.
double VirtualElements::drawn_error(const double* net, const LeafPolynomial& leaf, double beta,
                                    std::span<const double> u) const {
    const AffineFit fit = fit_affine(u, dimension_);
    const double distance = distance_from_affine(net, leaf.degree, dimension_, fit.affine);
    double off = 0;
    for (std::size_t k = 0; k < corners_; ++k) {
        off = std::max(off, std::abs(net[net_corner(leaf.degree, dimension_, k)] - u[k]));
    }
    return std::min(distance + fit.residual, beta + off + 2 * fit.residual) + least_beyond_;
}

/// The coefficients of component 0 and of the others of an element below a leaf.
const double* VirtualElements::net_of(OpenTask& task, const VirtualElement& e) const {
    const LeafPolynomial& leaf = records_->leaves()[e.leaf];
    if (e.level == 0) return records_->net(leaf);
    VirtualElement father = e;
    --father.level;
    std::size_t child = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        child |= static_cast<std::size_t>(e.place[d] & 1U) << d;
        father.place[d] = e.place[d] >> 1U;
    }
    return nets_of_children(task, father) + child * components_ * net_size(leaf.degree, dimension_);
}

/// The same of its children, one behind the other.
const double* VirtualElements::nets_of_children(OpenTask& task, const VirtualElement& e) const {
    OpenTask::Halves& halves = task.halves[static_cast<std::size_t>(e.level)];
    if (halves.leaf == e.leaf && halves.place == e.place) return halves.nets.data();
    const int degree = records_->leaves()[e.leaf].degree;
    const std::size_t size = net_size(degree, dimension_);
    const double* const own = net_of(task, e);
    halves.leaf = e.leaf;
    halves.place = e.place;
    halves.nets.resize(corners_ * components_ * size);
    if (components_ == 1) {
        halve_all(own, degree, dimension_, halves.nets.data());
        return halves.nets.data();
    }
    std::vector<double> parts(corners_ * size);
    for (std::size_t c = 0; c < components_; ++c) {
        halve_all(own + c * size, degree, dimension_, parts.data());
        for (std::size_t k = 0; k < corners_; ++k) {
            std::copy_n(
                parts.begin() + static_cast<std::ptrdiff_t>(k * size), size,
                halves.nets.begin() + static_cast<std::ptrdiff_t>((k * components_ + c) * size));
        }
    }
    return halves.nets.data();
}

}  // namespace nestgrid::engine
