// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/field_check.hpp>

#include <algorithm>

#include <boost/container/small_vector.hpp>

#include <collapses/deformed_leaf.hpp>
#include <nestgrid/detail/shape_functions.hpp>

namespace nestgrid::engine {

namespace {

constexpr int most_halvings = 5;            // of a polygon's triangles
constexpr double least_covered = 1 - 1e-6;  // of a triangle's area by leaves

/// U - C on an affine leaf, or U without a colour, at points of a triangle. These are given in
/// parts of its corners.
struct LeafFunction {
    Shape shape;
    std::array<double, max_corners> value;  // at the leaf's corners
    std::array<Point, 3> reference;         // of the triangle's corners in the leaf
    std::array<double, 3> colour{};         // at the triangle's corners, where there is one

    double operator()(const LeafSection::Corner& c) const {
        const auto weight =
            shape_functions(shape, c[0] * reference[0] + c[1] * reference[1] + c[2] * reference[2]);
        double sum = 0;
        for (std::size_t k = 0; k < topology(shape).corners; ++k) sum += weight[k] * value[k];
        return sum - (c[0] * colour[0] + c[1] * colour[1] + c[2] * colour[2]);
    }
};

/// The greatest of the Bernstein coefficients of a cubic polynomial on a triangle, from its values
/// at ten points, and of its values there.
struct CubicRange {
    double coefficient = 0;
    double met = 0;

    CubicRange(const LeafFunction& f, const Triangle& s) {
        double sum_of_corners = 0;
        double sum_of_edges = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Point& a = s[i];
            const Point& b = s[(i + 1) % 3];
            const double f0 = f(a);
            const double f1 = f((2.0 / 3) * a + (1.0 / 3) * b);
            const double f2 = f((1.0 / 3) * a + (2.0 / 3) * b);
            const double f3 = f(b);
            met = std::max({met, std::abs(f0), std::abs(f1), std::abs(f2)});
            const double near = (-5 * f0 + 18 * f1 - 9 * f2 + 2 * f3) / 6;
            const double far = (2 * f0 - 9 * f1 + 18 * f2 - 5 * f3) / 6;
            coefficient = std::max({coefficient, std::abs(f0), std::abs(near), std::abs(far)});
            sum_of_corners += f0;
            sum_of_edges += near + far;
        }
        const double middle = f((1.0 / 3) * (s[0] + s[1] + s[2]));
        met = std::max(met, std::abs(middle));
        const double inner = (27 * middle - sum_of_corners - 3 * sum_of_edges) / 6;
        coefficient = std::max(coefficient, std::abs(inner));
    }
};

bool cubic_keeps(const LeafFunction& f, const Triangle& s, double error, int halvings,
                 double& greatest) {
    const CubicRange range(f, s);
    if (range.met > error) return false;
    if (range.coefficient <= error) {
        greatest = std::max(greatest, range.coefficient);
        return true;
    }
    if (halvings == 0) return false;
    const Triangle m{0.5 * (s[0] + s[1]), 0.5 * (s[1] + s[2]), 0.5 * (s[2] + s[0])};
    for (const Triangle& part :
         {Triangle{s[0], m[0], m[2]}, Triangle{m[0], s[1], m[1]}, Triangle{m[2], m[1], s[2]}, m}) {
        if (!cubic_keeps(f, part, error, halvings - 1, greatest)) return false;
    }
    return true;
}

}  // namespace

/// Looks at the leaves that one triangle meets.
class FieldCheck::Judge {
public:
    /// \param colours null where an isosurface is drawn
    Judge(const FieldCheck& check, const FlatTriangle& triangle, const CornerColours* colours)
        : check_{check},
          leaves_{*check.leaves_},
          triangle_{triangle},
          colours_{colours},
          limit_{leaves_.error()} {}

    bool keeps(double& greatest) {
        const bool kept = leaves_.for_each([&](const Box& box) { return triangle_.may_meet(box); },
                                           [&](const NearLeaf& leaf) { return keeps_in(leaf); });
        const bool decides = !deformed_ || check_.may_enter_hidden_;
        if (!kept || (decides && covered_ < least_covered)) return false;
        greatest = std::max(greatest, greatest_);
        return true;
    }

    bool keeps_without_bound() {
        boost::container::small_vector<LinearColour, 2> linear;
        for (std::size_t c = 0; c < leaves_.components(); ++c) {
            linear.emplace_back(triangle_, colour(c));
        }
        const auto must_look = [&](const Box& box, std::size_t level, std::size_t group) {
            return triangle_.may_meet(box) &&
                   !check_.ranges_->keeps(level, group, box, triangle_.corner[0],
                                          {linear.data(), linear.size()});
        };
        return leaves_.for_each_in_groups(must_look,
                                          [&](const NearLeaf& leaf) { return keeps_in(leaf); });
    }

private:
    std::array<double, 3> colour(std::size_t component) const {
        const auto& [a, b, c] = *colours_;
        return {a[component], b[component], c[component]};
    }
    bool keeps_in(const NearLeaf& leaf) {
        if (!leaf.affine) return deformed_keeps(leaf);
        if (!section_.cut(leaf, check_.map(leaf), triangle_.corner)) return true;
        // Coloured triangles keep where they are, in the domain.
        if (colours_ == nullptr && section_.leaves_domain()) return false;
        covered_ += section_.area();
        for (std::size_t c = 0; c < leaves_.components(); ++c) {
            const LeafFunction f = function_on(leaf, c);
            if (!(is_simplex(leaf.shape) ? affine_keeps(f) : polynomial_keeps(f))) return false;
        }
        return true;
    }
    LeafFunction function_on(const NearLeaf& leaf, std::size_t component) const {
        LeafFunction f{leaf.shape, {}, section_.reference()};
        const auto nodes = leaves_.nodes(leaf);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            f.value[k] = leaves_.value(nodes[k], component);
        }
        if (colours_ != nullptr) f.colour = colour(component);
        return f;
    }
    bool deformed_keeps(const NearLeaf& leaf) {
        deformed_ = true;
        std::array<Point, max_corners> room;
        const auto x = leaves_.corners(leaf, room);
        NearLeaf inside = leaf;
        if (colours_ != nullptr) inside.boundary = 0;
        for (std::size_t c = 0; c < leaves_.components(); ++c) {
            LeafFunction f = function_on(leaf, c);
            if (colours_ != nullptr) {
                for (std::size_t k = 0; k < x.size(); ++k) {
                    f.value[k] -= triangle_.interpolant(f.colour, x[k]);
                }
            }
            if (!DeformedLeaf(inside, x, f.value).keeps(triangle_, limit_, greatest_)) return false;
        }
        return true;
    }
    bool affine_keeps(const LeafFunction& f) {
        std::array<double, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) {
            at[i] = f.value[0] - f.colour[i];
            const std::size_t corners = topology(f.shape).corners;
            for (std::size_t d = 0; d + 1 < corners; ++d) {
                at[i] += section_.reference()[i][d] * (f.value[d + 1] - f.value[0]);
            }
        }
        for (const auto& c : section_.corners()) {
            const double off = std::abs(c[0] * at[0] + c[1] * at[1] + c[2] * at[2]);
            if (off > limit_) return false;
            greatest_ = std::max(greatest_, off);
        }
        return true;
    }
    bool polynomial_keeps(const LeafFunction& f) {
        for (std::size_t i = 2; i < section_.corners().size(); ++i) {
            const auto& corner = section_.corners();
            const Triangle s{corner[0], corner[i - 1], corner[i]};
            if (!cubic_keeps(f, s, limit_, most_halvings, greatest_)) return false;
        }
        return true;
    }

    const FieldCheck& check_;
    const NearLeaves& leaves_;
    const FlatTriangle& triangle_;
    const CornerColours* colours_;
    double limit_;
    LeafSection section_;
    double covered_ = 0;
    double greatest_ = 0;
    bool deformed_ = false;
};

FieldCheck::FieldCheck(const NearLeaves& leaves, Drawn drawn)
    : leaves_{&leaves},
      may_enter_hidden_{drawn == Drawn::moving_colours && leaves.may_hide()},
      lattice_{drawn == Drawn::isovalue ? KuhnLattice::find(leaves) : std::nullopt} {
    if (lattice_) return;
    if (drawn != Drawn::isovalue) ranges_.emplace(leaves);
    maps_.reserve(leaves.leaves().size());
    std::array<Point, max_corners> room;
    for (const NearLeaf& leaf : leaves.leaves()) {
        maps_.emplace_back(leaf.shape, leaves.corners(leaf, room));
    }
}

AffineLeaf FieldCheck::map(const NearLeaf& leaf) const {
    if (!maps_.empty()) return maps_[static_cast<std::size_t>(&leaf - leaves_->leaves().data())];
    std::array<Point, max_corners> room;
    return {leaf.shape, leaves_->corners(leaf, room)};
}

bool FieldCheck::keeps_in_leaves(const FlatTriangle& triangle, double& greatest) const {
    return Judge(*this, triangle, nullptr).keeps(greatest);
}

bool FieldCheck::keeps_colours(const FlatTriangle& triangle, const CornerColours& colours,
                               double& greatest) const {
    return Judge(*this, triangle, &colours).keeps(greatest);
}

bool FieldCheck::keeps_colours(const FlatTriangle& triangle, const CornerColours& colours) const {
    Judge judge(*this, triangle, &colours);
    double greatest = 0;
    return may_enter_hidden_ ? judge.keeps(greatest) : judge.keeps_without_bound();
}

bool FieldCheck::keeps(const FlatTriangle& triangle, double& greatest) const {
    return lattice_ ? lattice_->keeps(triangle.corner, greatest)
                    : keeps_in_leaves(triangle, greatest);
}

bool FieldCheck::keeps_fan(const Fan& fan) const {
    if (lattice_) return lattice_->keeps_fan(fan);
    double greatest = 0;
    return std::all_of(fan.side.begin(), fan.side.end(), [&](const auto& side) {
        const FlatTriangle triangle({fan.w, fan.ring[side[0]], fan.ring[side[1]]});
        return keeps_in_leaves(triangle, greatest);
    });
}

}  // namespace nestgrid::engine
