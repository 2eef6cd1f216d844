// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/annotations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

using nestgrid::dot;
using nestgrid::Point;

namespace {

constexpr double line_width = 1.2;

std::string number(const char* format, double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

/// The greatest 1, 2 or 5 times a power of ten that is at most x.
double round_down(double x) {
    const double power = std::pow(10, std::floor(std::log10(x)));
    const double digit = x / power * (1 + 1e-12);
    return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/// The least 1, 2 or 5 times a power of ten that is at least x.
double round_up(double x) {
    const double below = round_down(x);
    if (below >= x * (1 - 1e-12)) return below;
    const double digit = below / std::pow(10, std::floor(std::log10(below * (1 + 1e-12))));
    return below * (digit < 1.5 ? 2 : digit < 3 ? 2.5 : 2);
}

/// What stands beside the colours: isovalues, or round numbers.
struct Labels {
    std::vector<double> values;
    std::vector<std::string> texts;
};

Labels labels_of(const ColourBy& colour, const ColourRange& range, double font, double height) {
    Labels labels;
    if (!colour.isovalues.empty()) {
        for (const double value : colour.isovalues) {
            if (value < range.least || value > range.greatest) continue;
            labels.values.push_back(value);
            labels.texts.push_back(number("%.4g", value));
        }
        return labels;
    }
    const int most = std::clamp(static_cast<int>(height / (3 * font)), 2, 9);
    const Ticks ticks = make_ticks(range.least, range.greatest, most);
    labels.values = ticks.values;
    for (const double value : ticks.values) labels.texts.push_back(ticks.text(value));
    return labels;
}

// Widths of a legend, in multiples of the font.
constexpr double bar_width = 1.1;
constexpr double tick_gap = 0.55;
constexpr double bar_margin = 0.9;

double text_width(const Labels& labels, double font) {
    double width = 0;
    for (const std::string& text : labels.texts) {
        width = std::max(width, Sheet::measure(text, {.size = font}).width);
    }
    return width;
}

/// An edge of the box, along `axis`, and the direction away from the box on the picture.
struct Edge {
    Point from;
    Point to;
    Pixel outwards;
};

/// Whether the eye sees the face of the box across an axis, at its low or its high end.
bool is_seen(const Projector& view, const Point& corner, std::size_t axis, bool high) {
    double towards = view.towards[axis];
    if (std::isfinite(view.distance)) {
        towards = view.focus[axis] + view.distance * view.towards[axis] - corner[axis];
        towards /= view.distance;
    }
    return (high ? towards : -towards) > 1e-6;
}

/// The edge along an axis on the outline of the box: the lowest one, or, where edges run rather
/// upwards, the leftmost one. None where the eye looks along the axis.
std::optional<Edge> outer_edge(const Projector& view, const std::array<double, 6>& bounds,
                               std::size_t axis) {
    const std::size_t a = (axis + 1) % 3;
    const std::size_t b = (axis + 2) % 3;
    const Point centre{(bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2,
                       (bounds[4] + bounds[5]) / 2};
    const Pixel middle = view.at(centre);
    std::optional<Edge> best;
    double least = INFINITY;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const bool high_a = (corner & 1U) != 0;
        const bool high_b = (corner & 2U) != 0;
        Edge edge;
        edge.from[axis] = bounds[2 * axis];
        edge.from[a] = bounds[2 * a + std::size_t{high_a}];
        edge.from[b] = bounds[2 * b + std::size_t{high_b}];
        edge.to = edge.from;
        edge.to[axis] = bounds[2 * axis + 1];
        if (is_seen(view, edge.from, a, high_a) == is_seen(view, edge.from, b, high_b)) continue;
        const Pixel p = view.at(edge.from);
        const Pixel q = view.at(edge.to);
        const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
        if (length < 1) continue;
        const bool upright = std::abs(q[1] - p[1]) > 1.5 * std::abs(q[0] - p[0]);
        const double height = upright ? (p[0] + q[0]) / 2 : (p[1] + q[1]) / 2;
        if (height >= least) continue;
        least = height;
        edge.outwards = {-(q[1] - p[1]) / length, (q[0] - p[0]) / length};
        const double side =
            edge.outwards[0] * (p[0] - middle[0]) + edge.outwards[1] * (p[1] - middle[1]);
        if (side < 0) edge.outwards = {-edge.outwards[0], -edge.outwards[1]};
        best = edge;
    }
    return best;
}

/// A text beside an edge, at a distance outwards.
TextPlace beside(const Pixel& at, const Pixel& outwards, double distance, double font) {
    const auto side = [](double part) {
        return part > 0.35 ? Side::low : part < -0.35 ? Side::high : Side::middle;
    };
    return {.at = {at[0] + distance * outwards[0], at[1] + distance * outwards[1]},
            .horizontal = side(outwards[0]),
            .vertical = side(outwards[1]),
            .size = font};
}

void draw_axis(Sheet& sheet, const Projector& view, const std::array<double, 6>& bounds,
               std::size_t axis, double font) {
    const std::optional<Edge> edge = outer_edge(view, bounds, axis);
    if (!edge) return;
    const Pixel p = view.at(edge->from);
    const Pixel q = view.at(edge->to);
    const Pixel& out = edge->outwards;
    const double tick = 0.35 * font;
    sheet.line(p, q, line_width);
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    // Numbers side by side need more room than numbers above each other.
    const double room = font * (2 + 1.5 * std::abs(out[1]));
    const int most = std::clamp(static_cast<int>(length / room), 2, 9);
    const Ticks ticks = make_ticks(bounds[2 * axis], bounds[2 * axis + 1], most);
    double reach = 0;
    for (const double value : ticks.values) {
        Point x = edge->from;
        x[axis] = value;
        const Pixel at = view.at(x);
        const TextPlace place = beside(at, out, 1.8 * tick, font);
        if (!sheet.write_if_free(ticks.text(value), place, view.cell)) continue;
        sheet.line(at, {at[0] + tick * out[0], at[1] + tick * out[1]}, line_width);
        const Box& box = sheet.texts().back();
        reach = std::max(reach, std::abs(out[0]) * box.width + std::abs(out[1]) * box.height);
    }
    const Pixel middle{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
    const std::string name(1, static_cast<char>('x' + axis));
    double distance = 1.8 * tick + reach + 0.4 * font;
    for (int trial = 0; trial < 8; ++trial, distance += 0.4 * font) {
        if (sheet.write_if_free(name, beside(middle, out, distance, font), view.cell)) return;
    }
}

}  // namespace

std::string Ticks::text(double value) const {
    const double size = std::max(std::abs(values.front()), std::abs(values.back()));
    if (std::abs(value) < step / 1e6) value = 0;
    if (size >= 1e6 || step < 1e-4) return number("%.6g", value);
    const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    std::array<char, 60> text{};
    std::snprintf(text.data(), text.size(), "%.*f", digits, value);
    return text.data();
}

Ticks make_ticks(double least, double greatest, int most) {
    Ticks ticks;
    const double range = greatest - least;
    if (!(range > 0) || !std::isfinite(range)) return {{least}, 1};
    // At both ends a tick, and one more for a range that starts at one.
    double distance = range / std::max(1, most - 1);
    for (int trial = 0; trial < 4 && ticks.values.size() < 2; ++trial) {
        ticks = {{}, round_up(distance)};
        for (double i = std::ceil(least / ticks.step - 1e-6);
             i <= std::floor(greatest / ticks.step + 1e-6); ++i) {
            ticks.values.push_back(i * ticks.step);
        }
        distance = ticks.step / 2.2;
    }
    return ticks;
}

double legend_width(const ColourBy& colour, const ColourRange& range, double font, double height) {
    const Labels labels = labels_of(colour, range, font, height);
    return font * (2 * bar_margin + bar_width + 2 * tick_gap + 1.3) + text_width(labels, font);
}

void draw_legend(Sheet& sheet, const ColourBy& colour, const ColourMap& map,
                 const ColourRange& range, double font, const Box& place) {
    const auto colours = make_colours(map, range.least, range.greatest);
    const double left = place.x + bar_margin * font;
    const double right = left + bar_width * font;
    const auto height_of = [&](double value) {
        return place.y + place.height * (value - range.least) / (range.greatest - range.least);
    };
    const int steps = std::max(2, static_cast<int>(place.height));
    for (int i = 0; i < steps; ++i) {
        const auto value = [&](double part) {
            return range.least + part / steps * (range.greatest - range.least);
        };
        Colour c{};
        colours->GetColor(value(i + 0.5), c.data());
        sheet.area({{left, height_of(value(i))},
                    {right, height_of(value(i))},
                    {right, height_of(value(i + 1))},
                    {left, height_of(value(i + 1))}},
                   c);
    }
    const Labels labels = labels_of(colour, range, font, place.height);
    for (std::size_t i = 0; i < labels.values.size(); ++i) {
        const double y = height_of(labels.values[i]);
        const bool isoline = !colour.isovalues.empty();
        const bool written = sheet.write_if_free(
            labels.texts[i],
            {.at = {right + tick_gap * font, y}, .horizontal = Side::low, .size = font},
            {place.x, place.y - font, place.width, place.height + 2 * font});
        if (written || isoline) {
            sheet.line({isoline ? left : right, y}, {right + 0.3 * font, y}, line_width);
        }
    }
    sheet.write(colour.array, {.at = {right + 2 * tick_gap * font + text_width(labels, font),
                                      place.y + place.height / 2},
                               .horizontal = Side::low,
                               .size = font,
                               .longest = place.height,
                               .upwards = true});
}

void draw_scale_bar(Sheet& sheet, const Projector& view, const std::string& unit, double font,
                    const Box& place) {
    const double length = round_down(place.width / 3 / view.pixels_per_unit);
    const double width = length * view.pixels_per_unit;
    const double bottom = place.y + 0.8 * font;
    const double top = bottom + 0.3 * font;
    const double left = place.x + font;
    sheet.area({{left, bottom}, {left + width, bottom}, {left + width, top}, {left, top}},
               sheet.ink());
    sheet.write(number("%.6g", length) + (unit.empty() ? "" : " " + unit),
                {.at = {left, top + 0.4 * font},
                 .horizontal = Side::low,
                 .vertical = Side::low,
                 .size = font,
                 .longest = place.width - 2 * font});
}

void draw_orientation(Sheet& sheet, const Projector& view, double font, const Box& place) {
    const std::array<Colour, 3> colours{{{0.75, 0.15, 0.15}, {0.1, 0.5, 0.15}, {0.15, 0.3, 0.8}}};
    const Pixel origin{place.x + place.width - 3.2 * font, place.y + 3 * font};
    const double size = 1.7 * font;
    std::array<std::size_t, 3> order{0, 1, 2};
    std::ranges::sort(order, [&](std::size_t i, std::size_t j) {
        return view.towards[i] < view.towards[j];  // the nearest one last
    });
    for (const std::size_t d : order) {
        const Pixel along{view.right[d], view.up[d]};
        const double length = std::hypot(along[0], along[1]);
        if (length < 0.1) continue;
        const auto at = [&](double part, double aside) {
            return Pixel{origin[0] + size * part * along[0] - aside * along[1] / length,
                         origin[1] + size * part * along[1] + aside * along[0] / length};
        };
        const double head = std::min(1., 0.45 / length);
        sheet.line(origin, at(1 - head / 2, 0), 0.14 * font, colours[d]);
        sheet.area({at(1, 0), at(1 - head, 0.22 * font), at(1 - head, -0.22 * font)}, colours[d]);
        const double beyond = 1 + 0.55 * font / size / length;
        sheet.write_if_free(std::string(1, static_cast<char>('x' + d)),
                            {.at = at(beyond, 0), .size = font}, place);
    }
}

std::vector<Point> axis_ends(const Viewpoint& view, const std::array<double, 6>& bounds) {
    Box square{0, 0, 1000, 1000};
    const std::vector<Point> diagonal{{bounds[0], bounds[2], bounds[4]},
                                      {bounds[1], bounds[3], bounds[5]}};
    const Projector projector = fit(diagonal, view, false, square, square);
    std::vector<Point> ends;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (const auto edge = outer_edge(projector, bounds, axis)) {
            ends.push_back(edge->from);
            ends.push_back(edge->to);
        }
    }
    return ends;
}

void draw_axes(Sheet& sheet, const Projector& view, const std::array<double, 6>& bounds,
               double font) {
    for (std::size_t axis = 0; axis < 3; ++axis) draw_axis(sheet, view, bounds, axis, font);
}
