// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include <nestgrid/grid.hpp>
#include <nestgrid/shape.hpp>

template <class Field>
concept HasGradients = requires(const Field& field, const typename Field::Element& e,
                                std::span<nestgrid::Point> out) {
    field.corner_gradients(e, out);
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
