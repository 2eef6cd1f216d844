// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How long work is ended from outside, also that of an algorithm which takes no callback: the
// hierarchy it asks, and the executor it runs its tasks on, throw. Results have the bits of work
// that is not watched.
#pragma once

#include <functional>
#include <utility>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/field_on_grid.hpp>

namespace nestgrid {

/// Told that work goes on.
class Watch {
public:
    virtual ~Watch() = default;
    /// Called very often, by every thread that works. Throws to end the work.
    virtual void check() const = 0;

protected:
    Watch() = default;
    Watch(const Watch&) = default;
    Watch& operator=(const Watch&) = default;
    Watch(Watch&&) noexcept = default;
    Watch& operator=(Watch&&) noexcept = default;
};

namespace detail {

/// The same field, which calls check() wherever it is asked for elements, values or positions.
/// \param watch borrowed
FieldOnGrid watched(const FieldOnGrid& field, const Watch& watch);

}  // namespace detail

/// An executor that tells how far its tasks are.
class TellingExecutor final : public Executor {
public:
    /// \param inner borrowed
    /// \param tell told the share of the tasks of a run that are done, from 0 to 1; what it throws
    ///        ends the run; may be empty
    TellingExecutor(const Executor& inner, std::function<void(double share)> tell)
        : inner_{&inner}, tell_{std::move(tell)} {}

    std::size_t concurrency() const override { return inner_->concurrency(); }
    void run(std::size_t count, const std::function<void(std::size_t)>& work,
             const std::function<void(std::size_t)>& consume) const override;

private:
    const Executor* inner_;
    std::function<void(double share)> tell_;
};

/// Who does long work, and who may end it.
struct Work {
    const Executor& executor = sequential();
    const Watch* watch = nullptr;  ///< or null
    /// Asked in the place of a field that is the same: for hierarchies that are made anew for each
    /// call. Or null.
    const FieldOnGrid* same_field = nullptr;
    /// Told what begins, by drawings under a projection: "drawing", "searching the threshold",
    /// "collapsing". May be empty.
    std::function<void(const char* step)> step{};

    void begin(const char* what) const {
        if (step) step(what);
    }
    /// The field as this work asks it.
    FieldOnGrid on(const FieldOnGrid& field) const {
        const FieldOnGrid& asked = same_field == nullptr ? field : *same_field;
        return watch == nullptr ? asked : detail::watched(asked, *watch);
    }

private:
    static const Executor& sequential();
};

}  // namespace nestgrid
