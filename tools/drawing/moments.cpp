// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/moments.hpp"

#include <utility>

#include "drawing/meter.hpp"

const ChosenIndicator& Moment::indicators() const {
    if (!indicators_) {
        const FramePrerolls& prerolls = all_.prerolls();
        const Meter meter;
        indicators_.emplace(prerolls, hierarchy_, weights_);
        all_.cost_.seconds += meter.seconds();
    }
    return *indicators_;
}

Moments::Moments(const InputField& field, const TimeOptions& time,
                 const std::filesystem::path& path, ProjectionChoice choice,
                 std::optional<LensRequest> lens, int threads,
                 const std::function<void(double share)>& tell)
    : field_{field},
      time_{time},
      choice_{std::move(choice)},
      lens_{std::move(lens)},
      threads_(threads),
      executor_(threads_, tell) {
    require_frames(time, field.times, path);
}

const FramePrerolls& Moments::prerolls() const {
    if (!prerolls_) {
        const Meter meter;
        prerolls_.emplace(field_.frames, choice_, lens_, executor_);
        cost_ = {meter.seconds(), meter.peak_bytes(), prerolls_->memory_bytes()};
    }
    return *prerolls_;
}

void Moments::for_each(const std::function<void(const Moment&)>& function) const {
    if (!time_.in_use()) return function(Moment(*this, field_.frames.front(), {}, {}));
    for (const double t : time_.drawn_times(field_.times)) {
        const std::vector<float> weights = time_.weights(field_.times, t);
        function(Moment(*this, field_.between(weights), t, weights));
    }
}
