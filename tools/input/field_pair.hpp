// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <nestgrid/grid.hpp>
#include <nestgrid/shape.hpp>

template <class Field>
concept HasGradients = requires(const Field& field, const typename Field::Element& e,
                                std::span<nestgrid::Point> out) {
    field.corner_gradients(e, out);
};

template <class Field>
concept HasDegree = requires(const Field& field, const typename Field::Element& e) {
    field.degree(e);
};

/// Two fields of one component each, on one grid, as the components of one field.
template <class Field>
class FieldPair {
public:
    using value_type = typename Field::value_type;
    using Element = typename Field::Element;
    static constexpr int components = 2;

    FieldPair(const Field& first, const Field& second) : fields_{first, second} {}

    template <class Context>
    nestgrid::NodeMask coarse_values(std::size_t i, std::span<value_type> out,
                                     Context& context) const {
        return gather(out, [&](const Field& field, std::span<value_type> values) {
            if constexpr (requires { field.coarse_values(i, values, context); }) {
                return field.coarse_values(i, values, context);
            } else {
                return field.coarse_values(i, values);
            }
        });
    }
    template <class Context>
    nestgrid::NodeMask new_values(const Element& e, nestgrid::NodeMask which,
                                  std::span<value_type> out, Context& context) const {
        return gather(out, [&](const Field& field, std::span<value_type> values) {
            if constexpr (requires { field.new_values(e, which, values, context); }) {
                return field.new_values(e, which, values, context);
            } else {
                return field.new_values(e, which, values);
            }
        });
    }
    /// Of the first field, where it has gradients of its own.
    void corner_gradients(const Element& e,
                          std::span<nestgrid::Point> out) const requires HasGradients<Field> {
        fields_[0].corner_gradients(e, out);
    }

    /// Of two fields of polynomials.
    int degree(const Element& leaf) const requires HasDegree<Field> {
        return std::max(fields_[0].degree(leaf), fields_[1].degree(leaf));
    }
    void evaluate(const Element& leaf, std::span<const nestgrid::Point> reference,
                  std::span<value_type> out) const requires HasDegree<Field> {
        std::vector<value_type> values(reference.size());
        for (std::size_t c = 0; c < components; ++c) {
            fields_[c].evaluate(leaf, reference, values);
            for (std::size_t i = 0; i < values.size(); ++i) out[i * components + c] = values[i];
        }
    }

private:
    template <class Give>
    nestgrid::NodeMask gather(std::span<value_type> out, const Give& give) const {
        std::array<value_type, std::max(nestgrid::max_corners, nestgrid::max_new_nodes)> values;
        const std::size_t nodes = out.size() / components;
        nestgrid::NodeMask missing = 0;
        for (std::size_t c = 0; c < components; ++c) {
            missing |= give(fields_[c], std::span(values).first(nodes));
            for (std::size_t n = 0; n < nodes; ++n) out[n * components + c] = values[n];
        }
        return missing;
    }

    std::array<Field, components> fields_;
};
