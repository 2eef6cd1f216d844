// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/moments.hpp"

#include <algorithm>
#include <utility>

#include "drawing/meter.hpp"

const nestgrid::Projection& Moment::projection() const { return all_.projection_; }

const nestgrid::Criteria& Moment::criteria() const {
    if (!criteria_) {
        all_.range();
        const Meter meter;
        criteria_.emplace(*prerolls_, all_.projection_, all_.isovalues_,
                          nestgrid::Work{.executor = all_.executor()});
        all_.cost_.seconds += meter.seconds();
    }
    return *criteria_;
}

double Moment::threshold(const ThresholdText& text) const {
    const std::array<double, 2>& range = all_.range();
    return text.in_units(criteria().kind(), range[1] - range[0]);
}

std::shared_ptr<const nestgrid::HighOrder> Moment::high_order() const {
    return prerolls_->high_order({.executor = all_.executor()});
}

double Moment::error(const ThresholdText& text) const {
    const std::array<double, 2>& range = all_.range();
    return text.percent ? text.number / 100 * (range[1] - range[0]) : text.number;
}

Moments::Moments(const InputField& field, const TimeOptions& time,
                 const std::filesystem::path& path, nestgrid::Projection projection,
                 std::vector<double> isovalues, int threads,
                 const std::function<void(double share)>& tell)
    : field_{field},
      time_{time},
      projection_{std::move(projection)},
      isovalues_{std::move(isovalues)},
      threads_(threads),
      executor_(threads_, tell) {
    require_frames(time, field.times(), path);
}

const std::array<double, 2>& Moments::range() const {
    if (!range_) {
        const Meter meter;
        // What is drawn by its polynomials needs them alone.
        const bool has_degree =
            field_.range && field_.frames[0]->high_order({.executor = executor_}) != nullptr;
        range_ = has_degree ? *field_.range
                            : field_.frames.prepare(projection_, {.executor = executor_});
        cost_ = {meter.seconds(), meter.peak_bytes(), field_.frames.memory_bytes()};
    }
    return *range_;
}

void Moments::for_each(const std::function<void(const Moment&)>& function) const {
    if (!time_.in_use()) return function(Moment(*this, field_.frames[0], {}));
    for (const double t : time_.drawn_times(field_.times())) {
        function(Moment(*this, field_.frames.at(time_.weights(field_.times(), t)), t));
    }
}
