// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn of a field: the field itself, or the field at times between its frames. A command
// draws each moment in one way, whichever it is.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/watch.hpp>

#include "input/input_field.hpp"
#include "options/time_options.hpp"

/// A field at one moment.
class Moment {
public:
    /// Calls function(hierarchy) with a nestgrid::Hierarchy<float> or <double>.
    template <class Function>
    decltype(auto) visit(Function&& function) const {
        return prerolls_->field().visit(function);
    }
    const nestgrid::Prerolls& prerolls() const { return *prerolls_; }
    /// What is asked for at all moments; surfaces add their thresholds.
    const nestgrid::Projection& projection() const;
    /// Where it is between frames; nothing for a field without frames.
    std::optional<double> time() const { return time_; }
    /// Made when first asked for. The prerolls of frames are made once for all moments.
    /// \throw nestgrid::InvalidInput, nestgrid::GridError as nestgrid::Criteria
    const nestgrid::Criteria& criteria() const;
    /// \throw nestgrid::InvalidInput as ThresholdText::in_units()
    double threshold(const ThresholdText& text) const;
    /// The polynomials of a field of higher degree; null for others.
    /// \throw nestgrid::InvalidInput, nestgrid::GridError as nestgrid::HighOrder
    std::shared_ptr<const nestgrid::HighOrder> high_order() const;
    /// An error that a user gave, in units of the data.
    double error(const ThresholdText& text) const;

private:
    friend class Moments;
    Moment(const class Moments& all, std::shared_ptr<nestgrid::Prerolls> prerolls,
           std::optional<double> time)
        : all_{all}, prerolls_{std::move(prerolls)}, time_{time} {}

    const Moments& all_;
    std::shared_ptr<nestgrid::Prerolls> prerolls_;
    std::optional<double> time_;
    mutable std::optional<nestgrid::Criteria> criteria_;
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
    /// \param isovalues of the isosurfaces; empty where none are drawn
    /// \param tell told the share that is done of the work at hand, from 0 to 1, where there are
    ///        several threads; may be empty
    /// \throw nestgrid::InvalidInput as require_frames()
    Moments(const InputField& field, const TimeOptions& time, const std::filesystem::path& path,
            nestgrid::Projection projection, std::vector<double> isovalues, int threads,
            const std::function<void(double share)>& tell = {});

    const nestgrid::Executor& executor() const { return executor_; }
    /// Calls function(moment) for each, in the order of their times.
    void for_each(const std::function<void(const Moment&)>& function) const;
    /// The least and the greatest value of all frames. Makes their prerolls, when first asked for.
    const std::array<double, 2>& range() const;
    /// The cost of the prerolls and the indicators made so far.
    const PrerollCost& preroll_cost() const { return cost_; }

private:
    friend class Moment;

    const InputField& field_;
    const TimeOptions& time_;
    nestgrid::Projection projection_;
    std::vector<double> isovalues_;
    nestgrid::TbbExecutor threads_;
    nestgrid::TellingExecutor executor_;
    mutable std::optional<std::array<double, 2>> range_;
    mutable PrerollCost cost_;
};
