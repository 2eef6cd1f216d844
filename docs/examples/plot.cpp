// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "plot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace {

using nestgrid::Point;

constexpr int width = 760;
constexpr int height = 480;
constexpr double left = 74, right = 560, bottom = 62, top = 440;  // of the axes, in pixels
constexpr double letter = 2.0;                                    // pixels for a unit of the glyphs
constexpr Colour ink{0.15, 0.15, 0.18};
constexpr Colour pale{0.86, 0.86, 0.88};

/// Strokes of characters, separated by blanks. Two digits are a point: 0 ... 4 to the right, and 0
/// ... 8 upwards, the line of writing at 2.
const std::map<char, const char*>& glyphs() {
    static const std::map<char, const char*> known{{'a', "160503123243453616 4642"},
                                                   {'b', "160503123243453616 0802"},
                                                   {'c', "4536160503123243"},
                                                   {'d', "160503123243453616 4842"},
                                                   {'e', "04444536160503123243"},
                                                   {'f', "38281712 0636"},
                                                   {'g', "160503123243453616 46413010"},
                                                   {'h', "0802 0516364542"},
                                                   {'i', "2622 2827"},
                                                   {'j', "26211000 2827"},
                                                   {'k', "0802 4603 1442"},
                                                   {'l', "2822"},
                                                   {'m', "0602 05162522 25364542"},
                                                   {'n', "0602 0516364542"},
                                                   {'o', "160503123243453616"},
                                                   {'p', "160503123243453616 0600"},
                                                   {'q', "160503123243453616 4640"},
                                                   {'r', "0602 05163645"},
                                                   {'s', "45361605143443321203"},
                                                   {'t', "18132232 0636"},
                                                   {'u', "0603123243 4642"},
                                                   {'v', "062246"},
                                                   {'w', "0612253246"},
                                                   {'x', "0642 4602"},
                                                   {'y', "0622 4610"},
                                                   {'z', "06460242"},
                                                   {'0', "180703123243473818"},
                                                   {'1', "172822 1232"},
                                                   {'2', "07183847460242"},
                                                   {'3', "07183847463515 354443321203"},
                                                   {'4', "380444 3832"},
                                                   {'5', "480805354443321203"},
                                                   {'6', "473818070312324344351504"},
                                                   {'7', "084812"},
                                                   {'8', "1807061535444332120304153546473818"},
                                                   {'9', "031232434738180706153546"},
                                                   {'.', "2223"},
                                                   {',', "2311"},
                                                   {'/', "0248"},
                                                   {'(', "38272332"},
                                                   {')', "18272312"},
                                                   {'-', "0444"},
                                                   {'=', "0545 0343"},
                                                   {' ', ""}};
    return known;
}

/// Writes from x on; upwards from y on, where that is asked for. Behind ^ digits are raised.
/// \return where the text ends
double write(Picture& picture, double x, double y, const std::string& text, const Colour& colour,
             bool upwards = false) {
    double along = 0;
    bool raised = false;
    for (const char c : text) {
        if (c == '^') {
            raised = true;
            continue;
        }
        if (c == ' ') raised = false;
        const double size = raised ? 0.7 * letter : letter;
        const double shift_up = raised ? 3.5 * letter : 0;
        const auto at = [&](const char* digits) {
            const double a = along + size * (digits[0] - '0');
            const double b = shift_up + size * (digits[1] - '2');
            return upwards ? Point{x - b, y + a, 0} : Point{x + a, y + b, 0};
        };
        std::istringstream strokes(glyphs().at(c));
        for (std::string stroke; strokes >> stroke;) {
            for (std::size_t i = 2; i + 1 < stroke.size(); i += 2) {
                picture.line(at(&stroke[i - 2]), at(&stroke[i]), colour, 1.4);
            }
        }
        along += 6 * size;
    }
    return x + along;
}

double width_of(const std::string& text) { return 6 * letter * static_cast<double>(text.size()); }

/// One logarithmic axis in pixels.
struct Axis {
    double low, high;  // decades
    double first, last;
    double at(double value) const {
        return first + (std::log10(value) - low) / (high - low) * (last - first);
    }
};

/// Where the name of a curve is written.
struct NamePlace {
    double height;
    const Curve* curve;
};

Axis axis_of(const std::vector<Curve>& curves, std::size_t coordinate, double first, double last) {
    double low = INFINITY;
    double high = -INFINITY;
    for (const Curve& curve : curves) {
        for (const auto& point : curve.points) {
            low = std::min(low, std::log10(point[coordinate]));
            high = std::max(high, std::log10(point[coordinate]));
        }
    }
    constexpr double margin = 0.15;
    return {low - margin, high + margin, first, last};
}

}  // namespace

void plot_logarithmic(const std::string& file, const std::string& x_title,
                      const std::string& y_title, const std::vector<Curve>& curves) {
    Picture picture(width, height, 1);
    picture.look(0, {.centre = {width / 2.0, height / 2.0, 0}, .height = height});
    const Axis x = axis_of(curves, 0, left, right);
    const Axis y = axis_of(curves, 1, bottom, top);
    const auto label = [](double decade) { return "10^" + std::to_string(std::lround(decade)); };
    for (double decade = std::ceil(x.low); decade <= x.high; ++decade) {
        const double at = x.at(std::pow(10, decade));
        picture.line({at, bottom, 0}, {at, top, 0}, pale, 1);
        write(picture, at - 14, bottom - 24, label(decade), ink);
    }
    for (double decade = std::ceil(y.low); decade <= y.high; ++decade) {
        const double at = y.at(std::pow(10, decade));
        picture.line({left, at, 0}, {right, at, 0}, pale, 1);
        write(picture, left - 44, at - 6, label(decade), ink);
    }
    picture.line({left, bottom, 0}, {right, bottom, 0}, ink, 1.5);
    picture.line({left, bottom, 0}, {left, top, 0}, ink, 1.5);
    write(picture, (left + right - width_of(x_title)) / 2, 12, x_title, ink);
    write(picture, 20, (bottom + top - width_of(y_title)) / 2, y_title, ink, true);
    std::vector<NamePlace> names;
    for (const Curve& curve : curves) {
        Point before{};
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const Point here{x.at(curve.points[i][0]), y.at(curve.points[i][1]), 0};
            if (i > 0) picture.line(before, here, curve.colour, curve.dots ? 2.5 : 1.5);
            if (curve.dots) picture.dot(here, curve.colour, 4.5);
            before = here;
        }
        names.push_back({before[1] - 6, &curve});
    }
    std::ranges::sort(names, {}, &NamePlace::height);
    double lowest = bottom;
    for (const NamePlace& name : names) {
        const double at = std::max(name.height, lowest);
        write(picture, right + 10, at, name.curve->name, name.curve->colour);
        lowest = at + 10 * letter;
    }
    picture.write(file);
}
