// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares the data with functions on the leaves below elements: where a function has the isovalue,
// where the data have it, and where they lie on different sides of it.
//
// Of each function, one column of the rows (path_rows.hpp), the greatest error counts. No error
// below an element is greater than those that the values at its corners allow; a function for which
// a greater one is known already is not looked at there.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <indicators/affine_slopes.hpp>

namespace nestgrid::engine {

/// What is known of an element at its corners.
struct CutCorners {
    std::size_t count;
    std::size_t columns;
    std::array<const double*, max_corners> row;  ///< values of the functions, by column
    std::array<double, max_corners> value;       ///< of the data
    std::span<const Point> position;             ///< where distances are measured
    std::size_t dimension;
};

/// The greatest errors of functions.
class CutMeasure {
public:
    /// \param isovalues borrowed
    /// \param distances whether errors are divided by slopes
    CutMeasure(std::span<const double> isovalues, bool distances)
        : isovalues_{isovalues}, distances_{distances} {}

    /// Begins functions, columns first ... last - 1.
    /// \param most no distance is greater
    void begin(std::size_t first, std::size_t last, double most);
    /// Looks at an element, and at the data where the element is a leaf.
    /// \param bound below the element, the data stay within their corner values +- this
    /// \return whether a leaf below it may have a greater error than is known of a function
    bool look(const CutCorners& at, bool leaf, double bound);
    /// The greatest error of columns first ... last - 1.
    double greatest(std::size_t first, std::size_t last) const;

private:
    void find_ranges(const CutCorners& at);
    std::size_t find_active(const CutCorners& at, double isovalue, double bound);
    bool is_active(std::size_t column, double limit) const;
    void estimate(const CutCorners& at, std::size_t column, double error);
    void measure(const CutCorners& at, std::size_t active, double isovalue);
    void find_slopes(const CutCorners& at, std::size_t active);

    std::span<const double> isovalues_;
    bool distances_;
    std::vector<double> greatest_;     // by column
    std::vector<double> most_;         // by column, where distances are measured
    std::vector<double> low_, high_;   // by column: at the corners of the element at hand
    std::vector<std::size_t> active_;  // the columns that are looked at
    std::vector<double> function_;     // their values less the isovalue, by corner
    std::vector<double> error_;        // their greatest errors in the leaf at hand
    std::vector<double> per_slope_;    // 1 / slope of these functions there
    double data_per_slope_ = 1;
};

}  // namespace nestgrid::engine
