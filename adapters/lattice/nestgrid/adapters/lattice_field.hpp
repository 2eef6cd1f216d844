// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The samples of a lattice as a field. Included at the end of lattice.hpp.
#pragma once

namespace nestgrid {

/// Samples of any arithmetic type, borrowed, x fastest. Values are float for types that float holds
/// exactly (float, and integers of at most 16 bits), double for all others.
template <class Grid, class Sample>
class LatticeField {
public:
    using value_type = std::conditional_t<std::is_same_v<Sample, float> ||
                                              (std::is_integral_v<Sample> && sizeof(Sample) <= 2),
                                          float, double>;
    using Element = typename Grid::Element;

    /// \throw InvalidInput where the number of samples is not that of the lattice
    LatticeField(const Grid& grid, std::span<const Sample> samples)
        : grid_{&grid}, samples_{samples}, dual_{dual_axes(grid.geometry())} {
        if (samples.size() != grid.sample_count()) {
            throw InvalidInput("the field has " + std::to_string(samples.size()) +
                               " samples, but the lattice " + std::to_string(grid.sample_count()));
        }
    }

    NodeMask coarse_values(std::size_t i, std::span<value_type> out) const {
        const Element e = grid_->coarse(i).element;
        for (std::size_t k = 0; k < corners_; ++k) out[k] = at(grid_->corner_place(e, k));
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<value_type> out) const {
        if (grid_->whole()) {
            std::array<NodeKey, static_cast<std::size_t>(Grid::max_new_nodes)> node;
            grid_->new_keys(e, node);
            for (std::size_t k = 0; which >> k != 0; ++k) out[k] = sample(node[k]);
            return 0;
        }
        for (std::size_t k = 0; which >> k != 0; ++k) {
            if ((which >> k & 1U) != 0) out[k] = at(grid_->new_place(e, k));
        }
        return 0;
    }
    template <bool whole>
    NESTGRID_INLINE value_type value_at(typename Grid::Place p, NodeKey node) const {
        return whole || grid_->whole() ? sample(node) : at(p);
    }
    void row_values(NodeKey first, std::size_t stride, std::span<value_type> out) const {
        auto from = static_cast<std::size_t>(first);
        std::size_t within = out.size();  // the rest lies in the padding
        if (!grid_->whole()) {
            const typename Grid::Place p = grid_->place(first);
            const std::size_t x = grid_->at(p, 0);
            const std::size_t last = grid_->samples(0) - 1;
            from = grid_->sample(p);
            within = x > last ? 0 : std::min(within, (last - x) / stride + 1);
            std::ranges::fill(out.subspan(within), sample(from + last - std::min(x, last)));
        }
        const auto copy = [from = samples_.data() + from, to = out.first(within)](auto by) {
            for (std::size_t i = 0; i < to.size(); ++i) {
                to[i] = static_cast<value_type>(from[i * by]);
            }
        };
        // Most nodes; the compiler then takes several at once.
        if (stride == 2) return copy(std::integral_constant<std::size_t, 2>{});
        if (stride == 4) return copy(std::integral_constant<std::size_t, 4>{});
        copy(stride);
    }

    /// Central differences of the samples, one-sided at the boundary and beside samples that are
    /// not a number (NaN).
    void corner_gradients(const Element& e, std::span<Point> out) const {
        for (std::size_t k = 0; k < corners_; ++k) out[k] = gradient_at(grid_->corner_place(e, k));
    }
    /// Central differences of the samples around a node, as corner_gradients() gives them.
    Point gradient_at(typename Grid::Place p) const;

private:
    static constexpr std::size_t corners_ = static_cast<std::size_t>(Grid::max_corners);

    NESTGRID_INLINE value_type sample(NodeKey node) const {
        return static_cast<value_type>(samples_[static_cast<std::size_t>(node)]);
    }
    NESTGRID_INLINE value_type at(typename Grid::Place p) const {
        return static_cast<value_type>(samples_[grid_->sample(p)]);
    }
    /// Puts the gradient at a node that has neighbours along all axes. Returns false where a sample
    /// is not a number.
    NESTGRID_INLINE bool inner_gradient(typename Grid::Place p, Point& gradient) const {
        constexpr auto dimension = static_cast<std::size_t>(Grid::dimension);
        for (std::size_t d = 0; d < dimension; ++d) {
            if (grid_->at(p, d) - 1U >= grid_->samples(d) - 2) return false;
        }
        const Sample* const centre = samples_.data() + grid_->sample(p);
        gradient = {0, 0, 0};
        for (std::size_t d = 0; d < dimension; ++d) {
            const auto stride = static_cast<std::ptrdiff_t>(grid_->sample_stride(d));
            const double rise =
                static_cast<double>(centre[stride]) - static_cast<double>(centre[-stride]);
            gradient = gradient + 0.5 * rise * dual_[d];
        }
        return !std::is_floating_point_v<Sample> ||
               !std::isnan(gradient[0] + gradient[1] + gradient[2]);
    }
    double rise_beside_missing(std::size_t centre, std::size_t up, std::size_t down,
                               std::size_t d) const;
    static std::array<Point, 3> dual_axes(const LatticeGeometry<Grid::dimension>& geometry);

    const Grid* grid_;
    std::span<const Sample> samples_;
    std::array<Point, 3> dual_;  // times the rises from sample to sample: the gradient
};

template <class Grid, class Sample>
Point LatticeField<Grid, Sample>::gradient_at(typename Grid::Place p) const {
    Point gradient{0, 0, 0};
    if (inner_gradient(p, gradient)) return gradient;
    gradient = {0, 0, 0};
    const std::size_t centre = grid_->sample(p);
    for (std::size_t d = 0; d < static_cast<std::size_t>(Grid::dimension); ++d) {
        const std::size_t x = std::min<std::size_t>(grid_->at(p, d), grid_->samples(d) - 1);
        const std::size_t up = x + 1 < grid_->samples(d) ? 1 : 0;
        const std::size_t down = x > 0 ? 1 : 0;
        const double rise = static_cast<double>(samples_[centre + up * grid_->sample_stride(d)]) -
                            static_cast<double>(samples_[centre - down * grid_->sample_stride(d)]);
        if (std::is_floating_point_v<Sample> && std::isnan(rise)) {
            gradient = gradient + rise_beside_missing(centre, up, down, d) * dual_[d];
            continue;
        }
        gradient = gradient + (up + down == 2 ? 0.5 * rise : rise) * dual_[d];
    }
    return gradient;
}

/// The rise from a sample to one of its neighbours that has a value, or 0 where none has.
template <class Grid, class Sample>
double LatticeField<Grid, Sample>::rise_beside_missing(std::size_t centre, std::size_t up,
                                                       std::size_t down, std::size_t d) const {
    const auto value = [&](std::size_t i) { return static_cast<double>(samples_[i]); };
    const double above = value(centre + up * grid_->sample_stride(d)) - value(centre);
    const double below = value(centre) - value(centre - down * grid_->sample_stride(d));
    if (up == 1 && !std::isnan(above)) return above;
    return down == 1 && !std::isnan(below) ? below : 0;
}

/// The columns of the inverse transpose of the direction matrix, each divided by the spacing.
template <class Grid, class Sample>
std::array<Point, 3> LatticeField<Grid, Sample>::dual_axes(
    const LatticeGeometry<Grid::dimension>& g) {
    constexpr int dim = Grid::dimension;
    std::array<Point, 3> axis{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
        for (std::size_t r = 0; r < 3; ++r) axis[d][r] = g.direction[r][d];
    }
    if (dim == 2) axis[2] = cross(axis[0], axis[1]);
    const double volume = dot(axis[0], cross(axis[1], axis[2]));
    std::array<Point, 3> dual{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
        dual[d] = (1 / (volume * g.spacing[d])) * cross(axis[(d + 1) % 3], axis[(d + 2) % 3]);
    }
    return dual;
}

}  // namespace nestgrid
