// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The least threshold at which a drawing keeps within a number of triangles, whatever is drawn and
// whatever criterion the threshold is one of.
//
// Thresholds are searched among finite bfloat16 numbers. The indicators of the library
// are bfloat16, so that the elements that stop change at these thresholds only.
// Promise: the threshold that is found keeps within the number, and it is the least one that may be
// tried, or the bfloat16 number below it (less by 1/256 to 1/128 of it) does not.
// Where many elements have the same indicator, they go on at one threshold, and the surface above
// it may have far fewer triangles than asked for: end() and reason() say so, and what the next
// threshold would give. Not promised: that no lesser threshold keeps within the number. Triangles
// get fewer as the threshold grows, but not at each step: a coarser element may cut a fold that
// finer ones miss. Under criteria that blend, and between frames, vertices also move between
// bfloat16 numbers, and some triangles come or go. Cost: every trial ends when the number is
// exceeded. Threshold 0 is tried first; a least threshold above 0, at which there may be far more
// triangles, last. Thresholds are halved from `start` until the number is exceeded, or raised from
// there until it is kept, by factors that grow; 7 bisections remain, for an octave has 128 numbers,
// and one more for each doubling of the steps. From the range of the data, that is at most 10 times
// the number, and what fitted before the last halving.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace nestgrid {

/// Why a drawing has no more triangles than it has.
enum class BudgetEnd : std::uint8_t {
    filled,     ///< it has at least nine tenths of the number
    complete,   ///< the least threshold keeps within the number: at 0 nothing is projected away
    step,       ///< the next lesser threshold, at which many elements go on at once, exceeds it
    cancelled,  ///< the search was
};

/// The threshold that keeps within a number of triangles.
struct TriangleBudget {
    double threshold = 0;
    std::uint64_t triangles = 0;  ///< of the surface at it
    std::uint64_t extracted = 0;  ///< over all trials: the cost of the search
    int trials = 0;
    std::uint64_t max_triangles = 0;  ///< the number that was asked for
    double least = 0;                 ///< no threshold below this one was to be tried
    /// Where the search ended at a step: the next lesser threshold, and how many triangles it has;
    /// 0 where these are more than sixteen times max_triangles.
    double next_threshold = 0;
    std::uint64_t next_triangles = 0;
    /// By options.progress: `threshold` is the least one that was found to keep within the number
    /// by then, or the greatest one, with 0 triangles.
    bool cancelled = false;

    BudgetEnd end() const;
    /// Why there are no more triangles, as a sentence; empty where the budget is filled.
    std::string reason() const;
};

/// The number of triangles at a threshold, or nothing where there are more than `most`: a function
/// that draws or counts them, and ends as soon as there are more.
using CountTriangles =
    std::function<std::optional<std::uint64_t>(double threshold, std::uint64_t most)>;

/// \param start a threshold at which about nothing is left to be projected away, such as the range
///        of the data for indicators in their units; any number is right, others cost trials
/// \param least no threshold below it is tried; 0 to 3.4e38, rounded up to a bfloat16 number
/// \throw InvalidInput where there are more than max_triangles even at the greatest threshold,
///        3.4e38, and what count() throws
TriangleBudget least_threshold(const CountTriangles& count, double start,
                               std::uint64_t max_triangles, double least = 0);

}  // namespace nestgrid
