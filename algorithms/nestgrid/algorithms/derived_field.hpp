// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Scalars derived from the values at a node: the magnitude of a vector, a component, any function.
// They are derived from true values and projected afterwards, so that what is drawn is continuous
// like every projected function; nothing is stored.
#pragma once

#include <cmath>

#include <nestgrid/detail/operations.hpp>

namespace nestgrid {

/// Euclidean norm of all components.
struct Magnitude {
    template <class Real>
    Real operator()(std::span<const Real> value) const {
        Real sum = 0;
        for (const Real v : value) sum += v * v;
        return std::sqrt(sum);
    }
};

/// One component.
struct Component {
    std::size_t number = 0;
    template <class Real>
    Real operator()(std::span<const Real> value) const {
        return value[number];
    }
};

/// f(values at a node) as component 0 of a field; behind it come the first `carried` components of
/// the field it is derived from, as attributes.
/// \tparam Function called as f(std::span<const Real> components), giving a Real
template <class Field, class Function, int carried = 0>
class DerivedField {
public:
    using value_type = typename Field::value_type;
    static constexpr int components = 1 + carried;
    static_assert(carried <= detail::components_of<Field>(),
                  "A derived field cannot carry more components than there are.");

    explicit DerivedField(const Field& field, Function function = {})
        : field_{&field}, function_{std::move(function)} {}

    template <class Context>
    NodeMask coarse_values(std::size_t i, std::span<value_type> out, Context& context) const {
        std::array<value_type, max_corners * stride_> from;
        const std::size_t nodes = out.size() / components;
        const NodeMask missing =
            detail::call_coarse_values(*field_, context, i, std::span(from).first(nodes * stride_));
        for (std::size_t n = 0; n < nodes; ++n) put(n, from, out, missing);
        return missing;
    }
    template <class Element, class Context>
    NodeMask new_values(const Element& e, NodeMask which, std::span<value_type> out,
                        Context& context) const {
        std::array<value_type, max_new_nodes * stride_> from;
        const std::size_t nodes = out.size() / components;
        const NodeMask missing = detail::call_new_values(*field_, context, e, which,
                                                         std::span(from).first(nodes * stride_));
        for (std::size_t n = 0; n < nodes; ++n) put(n, from, out, missing | ~which);
        return missing;
    }

private:
    static constexpr auto stride_ = static_cast<std::size_t>(detail::components_of<Field>());

    template <class Values>
    void put(std::size_t n, const Values& from, std::span<value_type> out, NodeMask without) const {
        if ((without >> n & 1U) != 0) return;
        const std::span<const value_type> value(from.data() + n * stride_, stride_);
        out[n * components] = function_(value);
        for (std::size_t i = 0; i < carried; ++i) out[n * components + 1 + i] = value[i];
    }

    const Field* field_;
    Function function_;
};

}  // namespace nestgrid
