// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The indicators of one field, made when they are first asked for, and kept: what every projection
// of the field shares.
//
// Invariants:
//   - what is kept has the bits of what its own function makes of the field;
//   - between frames, offsets, deviations, bounds and each indicator of which it is known to hold
//     (IndicatorKind::between_frames) are the weighted sums of those of the frames
//     (key_frames.hpp), which are made once for all times; others are made of the field between
//     them;
//   - several threads may ask at once: the one that comes first makes, the others wait. Where its
//     work is ended by an exception, nothing is kept, and the next one makes it.
// Memory: that of what was asked for; of sizes, and of each indicator of level sets, the last ones.
#pragma once

#include <array>
#include <concepts>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/indicators.hpp>
#include <nestgrid/algorithms/projection.hpp>
#include <nestgrid/algorithms/watch.hpp>

namespace nestgrid {

class HighOrder;

/// An indicator to compare thresholds with, and bounds of the data for the search and the error.
struct ChosenIndicator {
    const IndicatorKind* kind = nullptr;
    std::shared_ptr<const Indicator> indicator;  ///< or null: S holds nowhere
    std::shared_ptr<const Bounds> bounds;
};

/// A field, and the indicators that projections of it have needed so far: what functions that draw
/// take. Safe for threads. One that is kept serves many drawings; one that is made of a hierarchy
/// in a call serves this one.
class Prerolls {
public:
    /// \param field shared where it is to be kept alive. It is not asked by work that has a field
    ///        of its own (Work::same_field)
    Prerolls(FieldOnGrid field);
    /// Prerolls of a FieldOnGrid made of these arguments.
    template <class... Field>
        requires std::constructible_from<FieldOnGrid, Field...> Prerolls(Field&&... field)
            : Prerolls(FieldOnGrid(std::forward<Field>(field)...)) {}
        /// Prerolls of a field between frames.
        /// \param field sum of weight * frame (between.hpp)
        /// \param frames of one grid, shared
        /// \throw InvalidInput where there is no frame, or not one finite weight for each
        Prerolls(FieldOnGrid field, std::vector<std::shared_ptr<Prerolls>> frames,
                 std::span<const float> weights);
        Prerolls(const Prerolls&) = delete;
        Prerolls& operator=(const Prerolls&) = delete;
        ~Prerolls();

        const FieldOnGrid& field() const;
        bool between_frames() const;

        /// \param name of indicators(), or "error" as of Projection
        /// \param blend the factor by which the indicator is spread, at least 1
        /// \param isovalues where the indicator is that of level sets
        /// \throw GridError where the grid has changed since the field's hierarchy was made for it
        /// \throw InvalidInput for an unknown name, where the grid lacks what the indicator needs,
        /// where
        ///        one of level sets is asked for without isovalues, and as the functions that make
        ///        them
        ChosenIndicator choose(std::string_view name, double blend,
                               std::span<const double> isovalues, const Work& work) const;
        /// Makes what a projection needs whatever is drawn.
        /// \param shared whether fields between this one and others are drawn: then also the
        /// indicator
        ///        where it serves between frames
        /// \return the bounds, which know the range of the data
        std::shared_ptr<const Bounds> prepare(const Projection& projection, bool shared,
                                              const Work& work) const;
        /// What a drawing of everything needs. Grids that are walked in stars or patches, and
        /// fields between frames, take the offsets, with which elements stop where offsets are 0;
        /// all others have no indicator, and bounds for Exact: SplitBounds, or the offsets where
        /// they are kept.
        ChosenIndicator finest(const Work& work) const;
        /// The offsets, which bound the data and know their range.
        std::shared_ptr<const Bounds> bounds(const Work& work) const;
        /// Sizes of elements (mesh_size.hpp), for a lens.
        std::shared_ptr<const SweptIndicator> sizes(const Spread& spread, const Work& work) const;

        /// The polynomials of the field (high_order.hpp), within an error of which it is drawn;
        /// null where all are of degree 1. Between frames they are made for each time. Work that
        /// has a field of its own has them made anew.
        ///
        /// \throw InvalidInput, GridError as HighOrder
        std::shared_ptr<const HighOrder> high_order(const Work& work) const;

        /// How many nodes the hierarchy has. Makes the offsets.
        std::size_t node_count(const Work& work) const;

        /// Drops what is kept: the data have changed. Work that goes on keeps what it uses. Frames
        /// keep theirs.
        void clear();
        /// Bytes of what is kept, without those of the frames.
        std::size_t memory_bytes() const;

    private:
        class Kept;

        std::unique_ptr<Kept> kept_;
};

}  // namespace nestgrid
