// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of a field on one grid, and the field at a time between them.
#pragma once

#include <optional>

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>

#include "missing.hpp"
#include "source.hpp"

namespace nestgrid::python {

/// Fields on a grid, each with prerolls of its own.
template <class Grid, class Field>
class GridFrames final : public FrameSource,
                         public std::enable_shared_from_this<GridFrames<Grid, Field>> {
public:
    /// \param memory that the grid and the fields borrow from; may be null
    /// \param missing whether fields have nodes without a value, beside which no frame is drawn
    GridFrames(std::shared_ptr<const Grid> grid, std::vector<Field> fields,
               std::shared_ptr<const void> memory, bool missing, const Call& call)
        : memory_{std::move(memory)}, grid_{std::move(grid)}, fields_{std::move(fields)} {
        std::vector<const Hierarchy<Real>*> frames;
        for (const Field& field : fields_) {
            erased_.push_back(std::make_unique<Erased>(*grid_, field));
            frames.push_back(erased_.back().get());
        }
        if (missing) hidden_ = find_hidden<Real>(frames, call);
        for (const Hierarchy<Real>* frame : frames) {
            if (hidden_) {
                holes_.push_back(std::make_unique<Holes<Real>>(*frame, hidden_));
                frame = holes_.back().get();
            }
            prerolls_.push_back(std::make_unique<Prerolls>(frame));
        }
    }

    std::unique_ptr<Source> at(std::span<const float> weights) override {
        return std::make_unique<At>(this->shared_from_this(), weights);
    }
    void clear() override {
        for (const auto& each : prerolls_) each->clear();
    }

private:
    using Real = typename Field::value_type;
    using Erased = detail::ErasedHierarchy<Grid, Field>;

    /// The field between frames.
    class At final : public Source {
    public:
        At(std::shared_ptr<const GridFrames> frames, std::span<const float> weights)
            : frames_{std::move(frames)},
              weights_(weights.begin(), weights.end()),
              between_(frames_->fields(), weights),
              hierarchy_(*frames_->grid_, between_) {
            if (frames_->hidden_) holes_.emplace(hierarchy_, frames_->hidden_);
            own_.emplace(hierarchy());
        }

        AnyHierarchy hierarchy() const override {
            if (holes_) return &*holes_;
            return &hierarchy_;
        }
        /// Offsets, deviations, bounds, the numerical and the wavelet indicator are sums of those
        /// of the frames; others are made of this field.
        ChosenIndicator choose(const std::string& name, double blend,
                               const Call& call) const override {
            if (const auto error = node_error(name)) {
                const auto numbers = key_frames(*error, blend, call);
                return {numbers, numbers, numbers.get()};
            }
            const auto bounds = key_frames(NodeError::offset, 1, call);
            if (name == "numerical" || name == "wavelet") {
                const auto swept = sum_of_frames<SweptKeyFrames>(
                    [&](Prerolls& frame) { return frame.swept(name, blend, call); });
                return {swept, bounds, bounds.get()};
            }
            return {own_->swept(name, blend, call), bounds, bounds.get()};
        }
        std::shared_ptr<const SweptIndicator> sizes(double slope, const Call& call) const override {
            return frames_->prerolls_.front()->sizes(slope, call);
        }
        std::array<double, 2> range(const Call& call) const override {
            const auto offsets = key_frames(NodeError::offset, 1, call);
            return {offsets->least(), offsets->greatest()};
        }
        void clear() override { own_->clear(); }

    private:
        std::shared_ptr<const KeyFrames> key_frames(NodeError error, double blend,
                                                    const Call& call) const {
            return sum_of_frames<KeyFrames>(
                [&](Prerolls& frame) { return frame.of_nodes(error, blend, call); });
        }
        /// An indicator that adds up those of the frames, with what it borrows.
        /// \param of gives the indicator of one frame, of its prerolls
        template <class Sum, class Of>
        std::shared_ptr<const Sum> sum_of_frames(const Of& of) const {
            using Frame = decltype(of(*frames_->prerolls_.front()));
            struct Kept {
                std::vector<Frame> frames;
                std::optional<Sum> indicator;
            };
            const auto kept = std::make_shared<Kept>();
            std::vector<typename Frame::element_type*> borrowed;
            for (const auto& each : frames_->prerolls_) {
                kept->frames.push_back(of(*each));
                borrowed.push_back(kept->frames.back().get());
            }
            kept->indicator.emplace(std::move(borrowed), weights_);
            return {kept, &*kept->indicator};
        }

        std::shared_ptr<const GridFrames> frames_;
        std::vector<float> weights_;
        Between<Field> between_;
        detail::ErasedHierarchy<Grid, Between<Field>> hierarchy_;
        std::optional<Holes<Real>> holes_;
        mutable std::optional<Prerolls> own_;
    };

    std::vector<const Field*> fields() const {
        std::vector<const Field*> result;
        for (const Field& each : fields_) result.push_back(&each);
        return result;
    }

    std::shared_ptr<const void> memory_;
    std::shared_ptr<const Grid> grid_;
    std::vector<Field> fields_;
    std::vector<std::unique_ptr<Erased>> erased_;
    std::shared_ptr<const HiddenElements> hidden_;  // null where every node has a value
    std::vector<std::unique_ptr<Holes<Real>>> holes_;
    std::vector<std::unique_ptr<Prerolls>> prerolls_;
};

}  // namespace nestgrid::python
