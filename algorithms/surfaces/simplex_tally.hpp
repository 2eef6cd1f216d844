// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace nestgrid::engine {

/// Thrown where more simplices are counted than the limit.
struct OverLimit {};

/// Counts the simplices that are drawn, up to a limit.
class SimplexTally {
public:
    static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

    explicit SimplexTally(std::uint64_t limit = no_limit) : limit_{limit} {}

    std::uint64_t limit() const { return limit_; }
    bool limited() const { return limit_ != no_limit; }
    std::uint64_t drawn() const { return drawn_; }

    /// \throw OverLimit
    void add(std::uint64_t more) {
        drawn_ += more;
        if (drawn_ + later_ > limit_) throw OverLimit{};
    }
    /// Counts elements of which each will be drawn later as one simplex at least.
    /// \throw OverLimit
    void add_later(std::uint64_t more) {
        later_ += more;
        add(0);
    }
    /// Adds what a task has counted. \throw OverLimit
    void add(const SimplexTally& task) {
        later_ += task.later_;
        add(task.drawn_);
    }
    /// Forgets the elements that were to be drawn later.
    void begin_later() { later_ = 0; }

private:
    std::uint64_t limit_;
    std::uint64_t drawn_ = 0;
    std::uint64_t later_ = 0;
};

}  // namespace nestgrid::engine
