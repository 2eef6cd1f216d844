// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws triangles, lines and dots into a PNG file, for the figures of the documentation. Needs no
// display and no graphics library.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <nestgrid/detail/geometry.hpp>

/// Red, green and blue between 0 and 1.
using Colour = std::array<double, 3>;

/// A parallel projection.
struct View {
    nestgrid::Point towards_eye{0, 0, 1};  ///< any length
    nestgrid::Point up{0, 1, 0};           ///< not parallel to towards_eye
    nestgrid::Point centre{0, 0, 0};       ///< what appears in the middle
    double height = 1;                     ///< of the visible part, in units of the scene
};

/// Views side by side, of equal width, on white. What is nearer to the eye hides what is farther.
class Picture {
public:
    /// \param width, height of one view, in pixels
    Picture(int width, int height, int views);

    /// Draws into a view from now on.
    void look(int view, const View& how);
    /// Leaves out what lies at dot(normal, x) > offset, until the next look().
    void cut_off(const nestgrid::Point& normal, double offset);

    /// Shades a triangle. Its back, from where its corners turn clockwise, is drawn darker.
    /// \param edges whether to draw its edges
    void triangle(const std::array<nestgrid::Point, 3>& corners, const Colour& colour, bool edges);
    /// \param width in pixels
    void line(const nestgrid::Point& a, const nestgrid::Point& b, const Colour& colour,
              double width);
    /// \param radius in pixels
    void dot(const nestgrid::Point& at, const Colour& colour, double radius);

    /// \throw nestgrid::IoError where the file cannot be written
    void write(const std::string& path) const;

private:
    /// Pixels, and the distance to the eye in the same units.
    struct Projected {
        double x, y, depth;
    };
    Projected project(const nestgrid::Point& at) const;
    nestgrid::Point unproject(const Projected& at) const;
    /// The colour of a triangle under a lamp above the eye.
    Colour shade(const nestgrid::Point& normal, const Colour& colour) const;
    void put(int x, int y, double depth, const Colour& colour);
    /// The mean of the samples of a pixel.
    Colour pixel(std::size_t x, std::size_t y) const;
    /// The image as numbers of colours in a palette of 256 at most.
    struct Indexed {
        std::string rows;     ///< a byte a pixel, each row behind the number of its PNG filter
        std::string palette;  ///< three bytes a colour
    };
    Indexed indexed() const;

    int view_width_;
    int width_;
    int height_;
    std::vector<Colour> colour_;
    std::vector<double> depth_;

    int view_ = 0;
    double scale_ = 1;
    nestgrid::Point centre_{0, 0, 0};
    nestgrid::Point right_{1, 0, 0};
    nestgrid::Point up_{0, 1, 0};
    nestgrid::Point towards_{0, 0, 1};
    nestgrid::Point normal_{0, 0, 0};
    double offset_ = 0;
};
