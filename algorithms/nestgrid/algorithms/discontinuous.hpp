// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data that jump between elements, drawn with their jumps: finite volumes, discontinuous Galerkin
// methods, data in cells.
//
// Every leaf has values of its own at its corners. An element that is split has, at each of its
// corners, the value of the leaf below it in that corner, and interpolates between them. It stops
// where the leaves below it deviate from that by the threshold at most: one number decides for each
// element, none for a node.
//
// Every element is drawn alone, and no two share a vertex. At threshold 0 colours jump as the data
// do; where elements stop, they jump by up to two thresholds more. Planes still take each point of
// the domain once where faces are plane, whatever the levels of elements. Curved slices and height
// fields gape where levels, or the data, change: no surface here is closed.
//
// Where the drawn function must be continuous, make a nodal field first (cell_data.hpp).
#pragma once

#include <functional>
#include <limits>
#include <memory>

#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/level_function.hpp>
#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

namespace detail {

/// Puts the values at the corners of a leaf, component c of corner k at out[k * components + c].
using LeafValues = std::function<void(const Handle& leaf, std::span<double> out)>;

}  // namespace detail

/// A grid with values of its own for every leaf. Both are borrowed.
class DiscontinuousData {
public:
    /// \tparam Field has, for every leaf of the grid,
    ///             void leaf_values(const Element& leaf, std::span<double> out) const
    ///         which puts component c at corner k into out[k * components + c], and, where it has
    ///         several components, `static constexpr int components`
    template <class Grid, class Field>
        requires requires(const Field& field, const ElementOf<Grid>& leaf, std::span<double> out) {
            field.leaf_values(leaf, out);
        }
    DiscontinuousData(const Grid& grid, const Field& field)
        : DiscontinuousData(hierarchy_of(grid), detail::components_of<Field>(),
                            [&field](const Handle& leaf, std::span<double> out) {
                                field.leaf_values(detail::element_of<ElementOf<Grid>>(leaf), out);
                            }) {}

    /// Data that are constant on each leaf.
    /// \tparam LeafValue callable as a number of LeafValue(const Element&) for every leaf
    template <class Grid, class LeafValue>
        requires std::convertible_to < std::invoke_result_t < const LeafValue&,
            const ElementOf<Grid>
    & >, double > DiscontinuousData(const Grid& grid, const LeafValue& leaf_value)
        : DiscontinuousData(
              hierarchy_of(grid), 1, [&leaf_value](const Handle& leaf, std::span<double> out) {
                  std::ranges::fill(
                      out,
                      static_cast<double>(leaf_value(detail::element_of<ElementOf<Grid>>(leaf))));
              }) {}

    /// The grid, with a field that is zero.
    const Hierarchy<float>& grid() const { return *grid_; }
    int components() const { return components_; }
    void leaf_values(const Handle& leaf, std::span<double> out) const { leaf_values_(leaf, out); }

private:
    DiscontinuousData(std::unique_ptr<const Hierarchy<float>> grid, int components,
                      detail::LeafValues leaf_values)
        : grid_{std::move(grid)}, components_{components}, leaf_values_{std::move(leaf_values)} {}

    template <class Grid>
    static std::unique_ptr<const Hierarchy<float>> hierarchy_of(const Grid& grid) {
        static constexpr ZeroField<Grid> zero;
        using Erased = decltype(erase(grid, zero));
        return std::make_unique<Erased>(grid, zero);
    }

    std::unique_ptr<const Hierarchy<float>> grid_;
    int components_;
    detail::LeafValues leaf_values_;
};

/// How far component 0 at the corners of leaves deviates, below each split element, from the values
/// interpolated between the corners of that element.
/// Memory: 8 bytes for each split element.
class ElementDeviations {
public:
    /// A split element, in the order of a depth-first traversal. Those that are hidden wholly are
    /// left out, and so are those whose split makes no node.
    struct Entry {
        float deviation;        ///< rounded up; infinity where elements below are hidden or masked
        std::uint32_t subtree;  ///< how many entries are those of the element and of all below it
    };

    /// Walks the whole hierarchy, and asks once for the values of every leaf.
    /// \throw InvalidInput where a value is not a finite number
    explicit ElementDeviations(const DiscontinuousData& data);

    std::span<const Entry> entries() const { return entries_; }
    std::uint64_t epoch() const { return epoch_; }
    std::size_t memory_bytes() const { return entries_.capacity() * sizeof(Entry); }

private:
    std::vector<Entry> entries_;
    std::uint64_t epoch_;
};

struct DiscontinuousOptions {
    /// Elements stop where component 0 deviates by this at most, in the units of the data.
    double threshold = 0;
    /// Quadrilaterals in which some component differs by more than this from two triangles get a
    /// vertex in their middle. At least 0, in the units of the data.
    double flatness = std::numeric_limits<double>::infinity();
    /// Keep the drawn elements and which triangle comes from which.
    bool elements = true;
    /// As in IsosurfaceOptions, for slices of grids with true positions.
    const Indicator* position_bounds = nullptr;
    /// Called now and then with the counts so far; returning false ends the traversal.
    std::function<bool(const TraversalCounts&)> progress{};
};

/// Elements that were drawn alone.
struct DiscontinuousSurface {
    /// Component k of the data at vertex v is attributes[v * components + k]. The boundary holds
    /// the edges on the boundary of the domain, of shadings only.
    Surface<3> surface;
    TraversalCounts counts;
    /// Component 0, as it is drawn in an element, differs by at most this from the data of the
    /// leaves below it. Exact where these divide the element as its interpolation does.
    double error_bound = 0;
    bool cancelled = false;  ///< by options.progress; the surface is then a part
};

// All of these throw InvalidInput where the threshold or the flatness is negative or not a number,
// where the grid has another dimension, and where a value is not finite; GridError where the grid
// has changed since the deviations were computed. Without deviations they compute their own where
// the threshold is not 0.

/// Draws the elements of a two-dimensional grid, coloured by the data.
DiscontinuousSurface shading(const DiscontinuousData& data, const ElementDeviations& deviations,
                             const DiscontinuousOptions& options = {});
DiscontinuousSurface shading(const DiscontinuousData& data,
                             const DiscontinuousOptions& options = {});

/// Draws a shading lifted along z by scale times component 0.
/// \throw InvalidInput also where the scale is not finite
DiscontinuousSurface height_field(const DiscontinuousData& data, double scale,
                                  const ElementDeviations& deviations,
                                  const DiscontinuousOptions& options = {});
DiscontinuousSurface height_field(const DiscontinuousData& data, double scale,
                                  const DiscontinuousOptions& options = {});

/// Draws the slice of a three-dimensional grid by the zero of a function of position, oriented
/// towards where the function is negative. Where it runs in a face between two elements, the one
/// in which the function is negative colours it.
/// \throw InvalidInput also where the function has no finite value
DiscontinuousSurface slice(const DiscontinuousData& data, const LevelFunction& function,
                           const ElementDeviations& deviations,
                           const DiscontinuousOptions& options = {});
DiscontinuousSurface slice(const DiscontinuousData& data, const LevelFunction& function,
                           const DiscontinuousOptions& options = {});

}  // namespace nestgrid
