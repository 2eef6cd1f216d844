// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The field between frames, U(t) = sum mu_i U_i (paper, section 5.3). Nothing is stored.
//
// Invariants:
//   - a value has the same bits wherever it is asked for: sums are taken in double, in the order of
//     the frames; products with values of type float are exact in double, those with doubles are
//     fused with the sum;
//   - frames whose weight is 0 are not asked; where one weight is 1 and the others are 0, all
//     values are those of the frame, bit for bit;
//   - no value is judged here, for it may be that of a node that nobody looks at (holes.hpp). One
//     that leaves the range of its type is infinite. KeyFrames refuse weights that could take a
//     value of an element that is drawn out of the range.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

#include <nestgrid/algorithms/frame_weights.hpp>
#include <nestgrid/detail/operations.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// Offers gradients, rows of values, and polynomials of leaves where the frames do.
template <class Field>
class Between {
public:
    using value_type = typename Field::value_type;
    static constexpr int components = detail::components_of<Field>();

    /// \param fields of one grid; borrowed
    /// \param weights those of KeyFrames
    /// \throw InvalidInput where there is no frame, or not one finite weight for each
    Between(std::vector<const Field*> fields, std::span<const float> weights)
        : fields_{std::move(fields)} {
        if (fields_.empty()) throw InvalidInput("there are no frames to interpolate between");
        set_weights(weights);
    }

    /// Goes to another time.
    /// \throw InvalidInput where there is not one finite weight for each frame
    void set_weights(std::span<const float> weights) {
        detail::require_weights(fields_.size(), weights);
        terms_.clear();
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            if (weights[i] != 0) terms_.push_back({fields_[i], static_cast<double>(weights[i])});
        }
    }

    template <class Context>
    NodeMask coarse_values(std::size_t i, std::span<value_type> out, Context& context) const {
        return add_frames(~NodeMask{0}, out, [&](const Field& field, std::span<value_type> values) {
            return detail::call_coarse_values(field, context, i, values);
        });
    }
    template <class Element, class Context>
    NodeMask new_values(const Element& e, NodeMask which, std::span<value_type> out,
                        Context& context) const {
        return add_frames(which, out, [&](const Field& field, std::span<value_type> values) {
            return detail::call_new_values(field, context, e, which, values);
        });
    }

    bool offers(Feature feature) const requires detail::DecidesAtRunTime<Field> {
        return std::ranges::all_of(fields_, [&](const Field* f) { return f->offers(feature); });
    }
    template <class Element, class Context>
    void corner_gradients(const Element& e, std::span<Point> out, Context& context) const requires
        detail::offers_corner_gradients<Field, Context, const Element&, std::span<Point>> {
        std::array<Point, max_corners> gradient;
        std::ranges::fill(out, Point{0, 0, 0});
        for (const Term& term : terms_) {
            const std::span<Point> of_frame = std::span(gradient).first(out.size());
            detail::call_corner_gradients(*term.field, context, e, of_frame);
            for (std::size_t k = 0; k < out.size(); ++k) {
                for (std::size_t d = 0; d < 3; ++d) {
                    out[k][d] = std::fma(term.weight, of_frame[k][d], out[k][d]);
                }
            }
        }
    }
    /// The greatest degree of the frames that count: their sum has no greater one.
    template <class Element, class Context>
    int degree(const Element& leaf, Context& context)
        const requires detail::offers_degree<Field, Context, const Element&> {
        int greatest = 1;
        for (const Term& term : terms_) {
            const int degree = static_cast<int>(detail::call_degree(*term.field, context, leaf));
            if (degree < 1) return degree;  // which is refused
            greatest = std::max(greatest, degree);
        }
        return greatest;
    }
    template <class Element, class Context>
    void evaluate(const Element& leaf, std::span<const Point> reference, std::span<value_type> out,
                  Context& context)
        const requires detail::offers_evaluate<Field, Context, const Element&,
                                               std::span<const Point>, std::span<value_type>> {
        constexpr std::size_t points = room_ / stride_;
        for (std::size_t begin = 0; begin < reference.size(); begin += points) {
            const auto places =
                reference.subspan(begin, std::min(points, reference.size() - begin));
            const auto part = out.subspan(begin * stride_, places.size() * stride_);
            add_frames(~NodeMask{0}, part, [&](const Field& field, std::span<value_type> values) {
                detail::call_evaluate(field, context, leaf, places, values);
                return NodeMask{0};
            });
        }
    }
    bool knows_stars() const requires KnowsRows<Field> {
        return std::ranges::all_of(fields_,
                                   [](const Field* f) { return nestgrid::knows_stars(*f); });
    }
    void row_values(NodeKey first, std::size_t stride,
                    std::span<value_type> out) const requires KnowsRows<Field> {
        for (std::size_t begin = 0; begin < out.size(); begin += room_) {
            const auto part = out.subspan(begin, std::min(room_, out.size() - begin));
            const NodeKey from = first + begin * stride;
            add_frames(~NodeMask{0}, part, [&](const Field& field, std::span<value_type> values) {
                field.row_values(from, stride, values);
                return NodeMask{0};
            });
        }
    }

private:
    struct Term {
        const Field* field;
        double weight;
    };
    static constexpr auto stride_ = static_cast<std::size_t>(components);
    static constexpr std::size_t room_ = std::max(max_corners, max_new_nodes) * stride_;

    static double first_product(double weight, value_type value) {
        return weight * static_cast<double>(value);
    }
    static double add_product(double weight, float value, double sum) {
        return sum + weight * static_cast<double>(value);
    }
    static double add_product(double weight, double value, double sum) {
        return std::fma(weight, value, sum);
    }
    static value_type rounded(double value) {
        using Limits = std::numeric_limits<value_type>;
        if (std::abs(value) > static_cast<double>(Limits::max())) {
            return value > 0 ? Limits::infinity() : -Limits::infinity();
        }
        return static_cast<value_type>(value);
    }

    /// Sets out to the sum over frames of their values at the nodes in `which`.
    /// \param values_of values_of(field, out) sets the values of a frame and returns the nodes that
    ///        have none
    /// \return the nodes that some frame has no value at
    template <class ValuesOf>
    NodeMask add_frames(NodeMask which, std::span<value_type> out,
                        const ValuesOf& values_of) const {
        std::array<value_type, room_> from;
        std::array<double, room_> sum;
        std::fill_n(sum.begin(), terms_.empty() ? out.size() : 0, 0.0);
        NodeMask missing = 0;
        for (const Term& term : terms_) {
            const std::span<value_type> values = std::span(from).first(out.size());
            missing |= values_of(*term.field, values);
            const bool is_first = &term == &terms_.front();
            for (std::size_t i = 0; i < out.size(); ++i) {
                if (((which & ~missing) >> i / stride_ & 1U) == 0) continue;
                sum[i] = is_first ? first_product(term.weight, values[i])
                                  : add_product(term.weight, values[i], sum[i]);
            }
        }
        for (std::size_t i = 0; i < out.size(); ++i) {
            if (((which & ~missing) >> i / stride_ & 1U) != 0) out[i] = rounded(sum[i]);
        }
        return missing;
    }

    std::vector<const Field*> fields_;
    std::vector<Term> terms_;  // of frames whose weight is not 0
};

template <class Field>
Between(std::initializer_list<const Field*>, std::span<const float>) -> Between<Field>;

}  // namespace nestgrid
