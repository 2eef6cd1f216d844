// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/frame_field.hpp"

#include <nestgrid/algorithms/holes.hpp>

namespace {

using Hidden = std::shared_ptr<const nestgrid::HiddenElements>;

SharedHierarchy with_holes(const SharedHierarchy& frame, const Hidden& hidden) {
    return std::visit(
        [&]<class Real>(
            const std::shared_ptr<const nestgrid::Hierarchy<Real>>& inner) -> SharedHierarchy {
            struct Kept {
                Kept(std::shared_ptr<const nestgrid::Hierarchy<Real>> of, const Hidden& hidden)
                    : inner{std::move(of)}, holes(*inner, hidden) {}
                std::shared_ptr<const nestgrid::Hierarchy<Real>> inner;
                nestgrid::Holes<Real> holes;
            };
            const auto kept = std::make_shared<const Kept>(inner, hidden);
            return std::shared_ptr<const nestgrid::Hierarchy<Real>>(kept, &kept->holes);
        },
        frame);
}

}  // namespace

void hide_missing(FrameField& field) {
    const Hidden hidden = std::visit(
        [&]<class Frame>(const Frame&) {
            std::vector<typename Frame::element_type*> frames;
            for (const SharedHierarchy& each : field.frames) {
                frames.push_back(std::get<Frame>(each).get());
            }
            using Real = typename Frame::element_type::value_type;
            return nestgrid::HiddenElements::of_all<Real>(frames);
        },
        field.frames.front());
    if (!hidden->any()) return;
    for (SharedHierarchy& frame : field.frames) frame = with_holes(frame, hidden);
    if (!field.between) return;
    field.between = [between = field.between, hidden](std::span<const float> weights) {
        return with_holes(between(weights), hidden);
    };
}
