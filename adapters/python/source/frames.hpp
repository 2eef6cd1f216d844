// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of samples in memory, and the field at a time between them.
#pragma once

#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/key_frames.hpp>

#include "volume.hpp"

namespace nestgrid::python {

/// Frames of a lattice, each with a preroll of its own.
template <int dim, class Sample>
class VolumeFrames final : public FrameSource,
                           public std::enable_shared_from_this<VolumeFrames<dim, Sample>> {
public:
    using Grid = LatticeBisection<dim>;
    using Field = LatticeField<Grid, Sample>;

    explicit VolumeFrames(const std::vector<Samples>& frames)
        : grid_(lattice_geometry<dim>(frames.front())) {
        for (const Samples& frame : frames) {
            fields_.push_back(std::make_unique<Field>(lattice_field<Sample>(grid_, frame)));
            erased_.push_back(std::make_unique<Erased>(grid_, *fields_.back()));
            prerolls_.push_back(std::make_unique<Prerolls>(erased_.back().get()));
        }
    }

    std::unique_ptr<Source> at(std::span<const float> weights, const Executor& executor) override {
        return std::make_unique<At>(this->shared_from_this(), weights, executor);
    }
    void clear() override {
        for (const auto& each : prerolls_) each->clear();
    }

private:
    using Erased = detail::ErasedHierarchy<Grid, Field>;

    /// The field between frames.
    class At final : public Source {
    public:
        At(std::shared_ptr<const VolumeFrames> frames, std::span<const float> weights,
           const Executor& executor)
            : frames_{std::move(frames)},
              between_(frames_->fields(), weights),
              hierarchy_(frames_->grid_, between_),
              prerolls_{frames_->offsets(executor)},
              indicator_{std::make_shared<KeyFrames>(pointers(), weights)} {}

        AnyHierarchy hierarchy() const override { return &hierarchy_; }
        /// \throw InvalidInput for anything but offsets without blending
        ChosenIndicator choose(const std::string& name, double blend,
                               const Executor& /*executor*/) const override {
            if (name != "offset" || blend != 1) {
                throw InvalidInput(
                    "between frames thresholds are those of offsets: leave out indicator and "
                    "blend");
            }
            return {indicator_, indicator_, nullptr};
        }
        std::shared_ptr<const SweptIndicator> sizes(double slope) const override {
            return frames_->prerolls_.front()->sizes(slope);
        }
        std::array<double, 2> range(const Executor& /*executor*/) const override {
            return {indicator_->least(), indicator_->greatest()};
        }
        /// Prerolls are those of the frames.
        void clear() override {}

    private:
        std::vector<const HierarchicalIndicator*> pointers() const {
            std::vector<const HierarchicalIndicator*> result;
            for (const auto& each : prerolls_) result.push_back(each.get());
            return result;
        }

        std::shared_ptr<const VolumeFrames> frames_;
        Between<Field> between_;
        detail::ErasedHierarchy<Grid, Between<Field>> hierarchy_;
        std::vector<std::shared_ptr<const HierarchicalIndicator>> prerolls_;
        std::shared_ptr<const KeyFrames> indicator_;
    };

    std::vector<const Field*> fields() const {
        std::vector<const Field*> result;
        for (const auto& each : fields_) result.push_back(each.get());
        return result;
    }
    std::vector<std::shared_ptr<const HierarchicalIndicator>> offsets(
        const Executor& executor) const {
        std::vector<std::shared_ptr<const HierarchicalIndicator>> result;
        for (const auto& each : prerolls_) result.push_back(each->offsets(1, executor));
        return result;
    }

    Grid grid_;
    std::vector<std::unique_ptr<Field>> fields_;
    std::vector<std::unique_ptr<Erased>> erased_;
    std::vector<std::unique_ptr<Prerolls>> prerolls_;
};

}  // namespace nestgrid::python
