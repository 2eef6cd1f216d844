// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nestgrid/error.hpp>

#include "picture/annotations.hpp"

using nestgrid::Point;

namespace {

constexpr int most_columns = 4;
constexpr double magnification = 8;
constexpr double least_cell = 80;  ///< a side of a panel, in pixels

/// Rows and columns of panels.
struct Grid {
    int columns = 1;
    int rows = 1;
};

Grid grid_of(std::size_t panels, bool details) {
    const int count = static_cast<int>(panels);
    const int columns =
        count <= most_columns ? count : static_cast<int>(std::ceil(std::sqrt(1.3 * count)));
    return {columns, (count + columns - 1) / columns * (details ? 2 : 1)};
}

std::vector<Point> points_of(const std::vector<Panel>& panels) {
    std::vector<Point> points;
    for (const Panel& panel : panels) {
        for (const auto& data : {panel.surface, panel.veil}) {
            for (vtkIdType i = 0; data != nullptr && i < data->GetNumberOfPoints(); ++i) {
                data->GetPoint(i, points.emplace_back().data());
            }
        }
    }
    return points;
}

std::array<double, 6> bounds_of(const std::vector<Point>& points) {
    std::array<double, 6> bounds{};
    for (std::size_t d = 0; d < 3 && !points.empty(); ++d) {
        const auto [least, greatest] = std::ranges::minmax_element(
            points, [d](const Point& a, const Point& b) { return a[d] < b[d]; });
        bounds[2 * d] = (*least)[d];
        bounds[2 * d + 1] = (*greatest)[d];
    }
    return bounds;
}

/// Looks where there is something to be seen: at the point that is drawn nearest to the middle.
Projector magnified(Projector view, const std::vector<Point>& points) {
    double least = INFINITY;
    Point nearest = view.focus;
    for (const Point& x : points) {
        const Pixel p = view.at(x);
        const double distance = std::hypot(p[0] - view.centre[0], p[1] - view.centre[1]);
        if (distance >= least) continue;
        least = distance;
        nearest = x;
    }
    view.focus = nearest;
    view.pixels_per_unit *= magnification;
    return view;
}

double brightness(const Colour& c) { return 0.30 * c[0] + 0.59 * c[1] + 0.11 * c[2]; }

/// Dark on a light ground, light on a dark one.
Colour ink_on(const std::optional<Colour>& background) {
    if (background && brightness(*background) < 0.5) return {0.92, 0.92, 0.92};
    return {0.1, 0.1, 0.1};
}

ColourRange range_of(const ColourBy& colour, const PictureStyle& style) {
    ColourRange range = style.range.value_or(colour.range);
    if (!(range.least < range.greatest)) {
        const double half = std::max(std::abs(range.least) / 2, 0.5);
        range = {range.least - half, range.least + half};
    }
    return range;
}

/// Makes a layout step by step.
class Maker {
public:
    Maker(const std::vector<Panel>& panels, const PictureStyle& style)
        : panels_{panels},
          style_{style},
          grid_{grid_of(panels.size(), style.detail)},
          layout_{0, 0, {}, {}, {}, Sheet(ink_on(style.background))} {}

    Layout make() {
        set_size();
        layout_.range = range_of(panels_.front().colour, style_);
        Box free{0, 0, double(layout_.width), double(layout_.height)};
        add_title(free);
        add_legend(free);
        add_panels(free);
        return std::move(layout_);
    }

private:
    void set_size() {
        const bool alone = panels_.size() == 1;
        layout_.width = style_.width > 0 ? style_.width : alone ? 1000 : 640 * grid_.columns;
        layout_.height = style_.height > 0 ? style_.height
                         : alone           ? 800 * grid_.rows
                                           : 600 * grid_.rows;
        const double side =
            std::min(double(layout_.width) / grid_.columns, double(layout_.height) / grid_.rows);
        font_ = std::clamp(side / 32, 9., 60.);
        if (side >= least_cell) return;
        throw nestgrid::InvalidInput("--size " + std::to_string(layout_.width) + "x" +
                                     std::to_string(layout_.height) + " is too small for " +
                                     std::to_string(grid_.rows) + " x " +
                                     std::to_string(grid_.columns) + " panels");
    }

    void add_title(Box& free) {
        if (style_.title.empty()) return;
        const double size = 1.3 * font_;
        free.height = std::floor(free.height - 2 * size);
        layout_.sheet.write(style_.title,
                            {.at = {free.x + free.width / 2, free.y + free.height + 0.9 * size},
                             .size = size,
                             .longest = free.width - 2 * size});
    }

    void add_legend(Box& free) {
        const ColourBy& colour = panels_.front().colour;
        if (colour.array.empty()) return;
        const double most = double(layout_.height) / grid_.rows;
        const double height = 0.75 * std::min(free.height, most);
        const double width = std::ceil(legend_width(colour, layout_.range, font_, height));
        free.width -= width;
        draw_legend(layout_.sheet, colour, style_.colours, layout_.range, font_,
                    {free.x + free.width, free.y + (free.height - height) / 2, width, height});
    }

    void add_panels(const Box& free) {
        const std::vector<Point> points = points_of(panels_);
        const std::array<double, 6> bounds = bounds_of(points);
        const Viewpoint& viewpoint = style_.view.value_or(panels_.front().view);
        std::vector<Point> drawn = points;
        if (style_.axes) {
            const std::vector<Point> ends = axis_ends(viewpoint, bounds);
            drawn.insert(drawn.end(), ends.begin(), ends.end());
        }
        const double width = std::floor(free.width / grid_.columns);
        const double height = std::floor(free.height / grid_.rows);
        for (std::size_t i = 0; i < panels_.size(); ++i) {
            const int column = static_cast<int>(i) % grid_.columns;
            const int row = static_cast<int>(i) / grid_.columns * (style_.detail ? 2 : 1);
            const Box cell{free.x + column * width, free.y + free.height - (row + 1) * height,
                           width, height};
            Box inside = cell;
            add_caption(panels_[i], inside);
            // The same view in all panels, so that they can be compared.
            layout_.panels.push_back(
                fit(drawn, viewpoint, style_.perspective, cell, without_margins(inside)));
            if (!style_.detail) continue;
            Projector detail = layout_.panels.back();
            detail.cell.y -= height;
            detail.centre = detail.cell.centre();
            layout_.details.push_back(magnified(detail, points));
        }
        explain(layout_.panels.front());
        if (!style_.axes) return;
        for (const Projector& view : layout_.panels) {
            draw_axes(layout_.sheet, view, bounds, 0.85 * font_);
        }
    }

    /// The part of a cell that is left for the surface.
    Box without_margins(const Box& cell) const {
        const double margin = 0.03 * std::min(cell.width, cell.height);
        const double left = style_.axes ? 4.5 * font_ : margin;
        const double right = style_.axes ? 2 * font_ : margin;
        const double below = bottom_strip() + (style_.axes ? 3 * font_ : margin);
        return {cell.x + left, cell.y + below, std::max(cell.width - left - right, 1.),
                std::max(cell.height - below - margin, 1.)};
    }

    void add_caption(const Panel& panel, Box& inside) {
        if (panels_.size() == 1 || panel.caption.empty()) return;
        const double line = 1.35 * font_;
        std::string rest = panel.caption;
        inside.height -= 0.5 * line;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            inside.height -= line;
            layout_.sheet.write(rest.substr(0, end), {.at = {inside.x + inside.width / 2,
                                                             inside.y + inside.height + line / 2},
                                                      .size = font_,
                                                      .longest = inside.width - font_});
            rest.erase(0, end + 1);
        }
    }

    /// The height below a surface that its scale bar and directions take.
    double bottom_strip() const {
        return style_.orientation ? 5.2 * font_ : style_.unit ? 3 * font_ : 0;
    }

    void explain(const Projector& view) {
        if (style_.unit) draw_scale_bar(layout_.sheet, view, *style_.unit, font_, view.cell);
        if (style_.orientation) draw_orientation(layout_.sheet, view, font_, view.cell);
    }

    const std::vector<Panel>& panels_;
    const PictureStyle& style_;
    Grid grid_;
    Layout layout_;
    double font_ = 12;
};

}  // namespace

Layout make_layout(const std::vector<Panel>& panels, const PictureStyle& style) {
    return Maker(panels, style).make();
}
