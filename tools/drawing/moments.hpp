// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn of a field: the field itself, or the field at times between its frames. A command
// draws each moment in one way, whichever it is.
#pragma once

#include <functional>

#include <nestgrid/adapters/tbb.hpp>

#include "drawing/telling_executor.hpp"
#include "input/input_field.hpp"
#include "options/time_options.hpp"

/// A field at one moment.
class Moment {
public:
    const SharedHierarchy& hierarchy() const { return hierarchy_; }
    /// Calls function(hierarchy) with a nestgrid::Hierarchy<float> or <double>.
    template <class Function>
    decltype(auto) visit(Function&& function) const {
        return std::visit(
            [&](const auto& hierarchy) -> decltype(auto) { return function(*hierarchy); },
            hierarchy_);
    }
    /// Where it is between frames; nothing for a field without frames.
    std::optional<double> time() const { return time_; }
    /// Made when first asked for. The prerolls of frames are made once for all moments.
    /// \throw nestgrid::InvalidInput, nestgrid::GridError as ChosenIndicator
    const ChosenIndicator& indicators() const;

private:
    friend class Moments;
    Moment(const class Moments& all, SharedHierarchy hierarchy, std::optional<double> time,
           std::vector<float> weights)
        : all_{all}, hierarchy_{std::move(hierarchy)}, time_{time}, weights_{std::move(weights)} {}

    const Moments& all_;
    SharedHierarchy hierarchy_;
    std::optional<double> time_;
    std::vector<float> weights_;
    mutable std::optional<ChosenIndicator> indicators_;
};

struct PrerollCost {
    double seconds = 0;
    std::size_t peak_bytes = 0;
    std::size_t kept_bytes = 0;
};

/// All moments of a field that are drawn.
class Moments {
public:
    /// \param field must outlive the moments
    /// \param path of its file, for sentences
    /// \param tell told the share that is done of the work at hand, from 0 to 1, where there are
    ///        several threads; may be empty
    /// \throw nestgrid::InvalidInput as require_frames()
    Moments(const InputField& field, const TimeOptions& time, const std::filesystem::path& path,
            ProjectionChoice choice, std::optional<LensRequest> lens, int threads,
            const std::function<void(double share)>& tell = {});

    const nestgrid::Executor& executor() const { return executor_; }
    /// Calls function(moment) for each, in the order of their times.
    void for_each(const std::function<void(const Moment&)>& function) const;
    /// Made when first asked for.
    const FramePrerolls& prerolls() const;
    /// Of the prerolls and the indicators made so far.
    const PrerollCost& preroll_cost() const { return cost_; }

private:
    friend class Moment;

    const InputField& field_;
    const TimeOptions& time_;
    ProjectionChoice choice_;
    std::optional<LensRequest> lens_;
    nestgrid::TbbExecutor threads_;
    TellingExecutor executor_;
    mutable std::optional<FramePrerolls> prerolls_;
    mutable PrerollCost cost_;
};
