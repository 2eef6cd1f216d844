// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A function of position in the place of the field, for walks over bisections that draw slices.
#pragma once

#include <cmath>
#include <span>

#include <nestgrid/detail/mean.hpp>
#include <nestgrid/detail/pack.hpp>
#include <nestgrid/keys.hpp>
#include <patches/known_bisection.hpp>

namespace nestgrid::engine {

/// A field whose values at new nodes are means of those at the parents.
template <class Field>
concept GivesMeans = requires(const Field& field, typename Field::value_type value) {
    { field.mean(value, value) } -> std::same_as<typename Field::value_type>;
};

/// The values that vertices carry: those of the field at nodes of the grid.
template <class Grid>
class CarriedValues {
public:
    virtual void values_at(std::span<const typename Grid::Node> nodes,
                           std::span<const NodeKey> keys, std::span<double> out) const = 0;

protected:
    CarriedValues() = default;
    ~CarriedValues() = default;
    CarriedValues(const CarriedValues&) = default;
    CarriedValues& operator=(const CarriedValues&) = default;
    CarriedValues(CarriedValues&&) noexcept = default;
    CarriedValues& operator=(CarriedValues&&) noexcept = default;
};

/// CarriedValues read from a borrowed field with known bisections (known_bisection.hpp).
template <class Grid, class Field>
class CarriedField final : public CarriedValues<Grid> {
public:
    explicit CarriedField(const Field& field) : field_{&field} {}

    void values_at(std::span<const typename Grid::Node> nodes, std::span<const NodeKey> keys,
                   std::span<double> out) const override {
        if constexpr (AnswersInRows<Grid>) {
            field_->values_at(nodes, keys, out);
        } else {
            for (std::size_t i = 0; i < out.size(); ++i) {
                out[i] = static_cast<double>(field_->template value_at<false>(nodes[i], keys[i]));
            }
        }
    }

private:
    const Field* field_;
};

/// A function of position that a walk interpolates at all new nodes (position_functions.hpp), with
/// the values that vertices carry.
template <class Grid>
class MeanValues {
public:
    using value_type = double;

    /// Borrows the carried values.
    /// \param tolerance values within it of 0 are 0
    MeanValues(double tolerance, const CarriedValues<Grid>& carried)
        : tolerance_{tolerance}, carried_{&carried} {}

    double mean(double a, double b) const {
        const double between = midpoint(a, b);
        return std::abs(between) <= tolerance_ ? 0 : between;
    }
    NESTGRID_INLINE Pack<double> mean(const Pack<double>& a, const Pack<double>& b) const {
        const auto between = midpoint(a, b);
        const auto size = max(between, Pack<double>::all(0) - between);
        const auto is_zero = at_most(size, Pack<double>::all(tolerance_));
        return without(between.as<MaskOf<double>>(), is_zero).as<double>();
    }
    const CarriedValues<Grid>& carried() const { return *carried_; }

private:
    double tolerance_;
    const CarriedValues<Grid>* carried_;
};

}  // namespace nestgrid::engine
