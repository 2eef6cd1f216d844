// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A slice by a plane as a Level of the engine: what a new level set algorithm takes.
#pragma once

#include <levels/draw.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// dot(normal, x) - offset as component 0, in front of the components of a field. It is affine, so
/// that it is asked for at coarse corners only.
template <class Grid, class Field>
class PlaneField {
public:
    using value_type = double;
    static constexpr int data = detail::components_of<Field>();
    static constexpr int components = 1 + data;
    static constexpr int affine_components = 1;

    PlaneField(const Grid& grid, const Field& field, const Point& normal, double offset)
        : grid_{&grid}, field_{&field}, normal_{normal}, offset_{offset} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        const auto coarse = grid_->coarse(i);
        const auto from = values(out.size(), [&](auto to) { field_->coarse_values(i, to); });
        for (std::size_t k = 0; k * components < out.size(); ++k) {
            out[k * components] = dot(normal_, coarse.corners[k]) - offset_;
            std::copy_n(from.data() + k * data, data, out.data() + k * components + 1);
        }
        return 0;
    }
    NodeMask new_values(const ElementOf<Grid>& e, NodeMask which, std::span<double> out,
                        Context<Grid>& context) const {
        const auto from = values(
            out.size(), [&](auto to) { detail::call_new_values(*field_, context, e, which, to); });
        for (std::size_t n = 0; n * components < out.size(); ++n) {
            std::copy_n(from.data() + n * data, data, out.data() + n * components + 1);
        }
        return 0;
    }

private:
    template <class Fill>
    static auto values(std::size_t size, Fill&& fill) {
        std::vector<typename Field::value_type> from(size / components * data);
        fill(std::span(from));
        return from;
    }

    const Grid* grid_;
    const Field* field_;
    Point normal_;
    double offset_;
};

/// An affine component stays within its corner values; everything else is told by the data.
class AffineBounds final : public Bounds {
public:
    explicit AffineBounds(const Bounds& data) : data_{&data} {}
    double offset_bound(NodeKey) const override { return 0; }
    double bound(const Rule&, std::span<const NodeKey>) const override { return 0; }
    const HangingNodes* hanging() const override { return data_->hanging(); }
    std::uint64_t epoch() const override { return data_->epoch(); }
    bool stops_conform() const override { return data_->stops_conform(); }
    int finest_level() const override { return data_->finest_level(); }
    bool one_level_a_node() const override { return data_->one_level_a_node(); }

private:
    const Bounds* data_;
};

/// The slice by dot(normal, x) = offset, coloured by all components of the field.
/// \param elements whether to keep the extracted elements
template <class Grid, class Field>
Surface<3> slice(const Grid& grid, const Field& field, const Point& normal, double offset,
                 const Criterion& criterion, const Bounds& bounds, bool elements = false) {
    const PlaneField plane(grid, field, normal, offset);
    const auto hierarchy = erase(grid, plane);
    std::vector<Isosurface<3>> result(1);
    const engine::Level<double> level(0);
    result[0].surface.elements = hierarchy.make_elements();
    const engine::SurfaceBuilder<3> builder(result[0].surface, elements);
    engine::draw_levels<3, double>(hierarchy, std::span(&level, 1), 1, std::span(&builder, 1),
                                   criterion, AffineBounds(bounds), {.verify = true},
                                   SequentialExecutor{}, result);
    return std::move(result[0].surface);
}

}  // namespace nestgrid_test
