// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "picture.hpp"

namespace figures {

/// A plot in one view of a picture, without letters: the page beside it names the axes.
class PlotView {
public:
    using Range = std::array<double, 2>;
    using At = std::array<double, 2>;

    /// \param logarithmic both axes, with a line at each power of ten; else a line at each whole
    ///        number of x and each second one of y
    PlotView(Picture& picture, int view, const Range& x, const Range& y, bool logarithmic)
        : picture_{&picture}, x_{x}, y_{y}, logarithmic_{logarithmic} {
        picture.look(view, {.centre = {0.5, 0.5, 0}, .height = 1.1});
        grid_lines(x, 1, [&](double at) { line({at, y[0]}, {at, y[1]}, pale, 1); });
        grid_lines(y, 2, [&](double at) { line({x[0], at}, {x[1], at}, pale, 1); });
        const Colour black{0, 0, 0};
        for (const double at : x) line({at, y[0]}, {at, y[1]}, black, 1.5);
        for (const double at : y) line({x[0], at}, {x[1], at}, black, 1.5);
    }

    void line(const At& a, const At& b, const Colour& colour, double width = 2.5) const {
        picture_->line(place(a, 0), place(b, 0), colour, width);
    }
    void dot(const At& at, const Colour& colour) const { picture_->dot(place(at, 0.1), colour, 4); }

private:
    static constexpr Colour pale{0.85, 0.85, 0.85};

    template <class Draw>
    void grid_lines(const Range& range, double step, const Draw& draw) const {
        if (logarithmic_) {
            for (double at = std::pow(10, std::ceil(std::log10(range[0]))); at < range[1];
                 at *= 10) {
                draw(at);
            }
        } else {
            for (double at = range[0] + step; at < range[1]; at += step) draw(at);
        }
    }
    double part(double at, const Range& range) const {
        if (!logarithmic_) return (at - range[0]) / (range[1] - range[0]);
        return std::log(at / range[0]) / std::log(range[1] / range[0]);
    }
    nestgrid::Point place(const At& at, double height) const {
        return {part(at[0], x_), part(at[1], y_), height};
    }

    Picture* picture_;
    Range x_;
    Range y_;
    bool logarithmic_;
};

}  // namespace figures
