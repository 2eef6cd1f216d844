// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <string_view>

#include <zlib.h>

#include <nestgrid/error.hpp>

using namespace nestgrid;

namespace {

/// Each pixel is the mean of this many samples along each direction.
constexpr int samples = 3;
/// Lines and dots are drawn this many samples nearer to the eye than they are.
constexpr double lift = 4;
constexpr Colour edge_colour{0.13, 0.17, 0.25};

Point unit(const Point& a) { return 1 / norm(a) * a; }

Colour mix(const Colour& a, const Colour& b, double t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// Channels of 8 bits.
using Rgb = std::array<int, 3>;

/// Of the colours, the 256 that are used most; all where there are fewer.
std::vector<Rgb> most_frequent(const std::map<Rgb, std::size_t>& uses) {
    std::vector<std::pair<std::size_t, Rgb>> order;
    for (const auto& [colour, count] : uses) order.emplace_back(count, colour);
    std::ranges::sort(order, std::greater{});
    order.resize(std::min(order.size(), std::size_t{256}));
    std::vector<Rgb> palette;
    for (const auto& use : order) palette.push_back(use.second);
    return palette;
}

std::size_t nearest(const std::vector<Rgb>& palette, const Rgb& colour) {
    const auto distance = [&](const Rgb& other) {
        int sum = 0;
        for (std::size_t d = 0; d < 3; ++d) sum += (other[d] - colour[d]) * (other[d] - colour[d]);
        return sum;
    };
    const auto at = std::ranges::min_element(palette, {}, distance);
    return static_cast<std::size_t>(at - palette.begin());
}

void append(std::string& to, std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(number >> shift & 255U);
}

/// A part of a PNG file: its length, kind, bytes and checksum.
void append_chunk(std::string& to, std::string_view kind, const std::string& bytes) {
    append(to, static_cast<std::uint32_t>(bytes.size()));
    const std::string checked = std::string(kind) + bytes;
    to += checked;
    append(to, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                                                static_cast<uInt>(checked.size()))));
}

}  // namespace

Picture::Picture(int width, int height, int views)
    : view_width_{width * samples},
      width_{view_width_ * views},
      height_{height * samples},
      colour_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), {1, 1, 1}),
      depth_(colour_.size(), std::numeric_limits<double>::infinity()) {}

void Picture::look(int view, const View& how) {
    view_ = view;
    scale_ = height_ / how.height;
    centre_ = how.centre;
    towards_ = unit(how.towards_eye);
    right_ = unit(cross(how.up, towards_));
    up_ = cross(towards_, right_);
    normal_ = {0, 0, 0};
    offset_ = 0;
}

void Picture::cut_off(const Point& normal, double offset) {
    normal_ = normal;
    offset_ = offset;
}

Picture::Projected Picture::project(const Point& at) const {
    const Point from_centre = at - centre_;
    return {(view_ + 0.5) * view_width_ + scale_ * nestgrid::dot(from_centre, right_),
            0.5 * height_ - scale_ * nestgrid::dot(from_centre, up_),
            -scale_ * nestgrid::dot(from_centre, towards_)};
}

Point Picture::unproject(const Projected& at) const {
    return centre_ + (at.x - (view_ + 0.5) * view_width_) / scale_ * right_ +
           (0.5 * height_ - at.y) / scale_ * up_ + -at.depth / scale_ * towards_;
}

void Picture::put(int x, int y, double depth, const Colour& colour) {
    if (x < view_ * view_width_ || x >= (view_ + 1) * view_width_) return;
    if (y < 0 || y >= height_) return;
    if (nestgrid::dot(normal_, unproject({x + 0.5, y + 0.5, depth})) > offset_) return;
    const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x);
    if (depth > depth_[i]) return;
    depth_[i] = depth;
    colour_[i] = colour;
}

Colour Picture::shade(const Point& normal, const Colour& colour) const {
    const Point lamp = unit(towards_ + 0.6 * up_ - 0.5 * right_);
    const double light = 0.42 + 0.58 * std::abs(nestgrid::dot(normal, lamp));
    const bool front = nestgrid::dot(normal, towards_) > 0;
    return mix({0, 0, 0}, front ? colour : mix(colour, {0.35, 0.35, 0.40}, 0.35), light);
}

void Picture::triangle(const std::array<Point, 3>& corners, const Colour& colour, bool edges) {
    std::array<Projected, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = project(corners[i]);
    const double area =
        (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
    if (area == 0) return;
    // The distance of a point to the edge opposite corner i is height[i] times its coordinate i.
    std::array<double, 3> height{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Projected& a = p[(i + 1) % 3];
        const Projected& b = p[(i + 2) % 3];
        height[i] = std::abs(area) / std::max(std::hypot(b.x - a.x, b.y - a.y), 1e-9);
    }
    // Edges of triangles of a few pixels would hide their colour.
    const double strength = std::clamp(std::ranges::min(height) / (4 * samples) - 0.5, 0.0, 1.0);
    const Colour shaded =
        shade(unit(cross(corners[1] - corners[0], corners[2] - corners[0])), colour);
    const Colour edge = mix(shaded, edge_colour, edges ? 0.75 * strength : 0);
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
    const int bottom = static_cast<int>(std::min(y1, double(height_)));
    const int right = static_cast<int>(std::min(x1, double(width_)));
    for (int y = static_cast<int>(std::max(y0, 0.0)); y <= bottom; ++y) {
        for (int x = static_cast<int>(std::max(x0, 0.0)); x <= right; ++x) {
            std::array<double, 3> part{};  // barycentric coordinates
            for (std::size_t i = 0; i < 3; ++i) {
                const Projected& a = p[(i + 1) % 3];
                const Projected& b = p[(i + 2) % 3];
                part[i] = ((b.x - a.x) * (y + 0.5 - a.y) - (b.y - a.y) * (x + 0.5 - a.x)) / area;
            }
            if (std::ranges::min(part) < 0) continue;
            const double depth = part[0] * p[0].depth + part[1] * p[1].depth + part[2] * p[2].depth;
            const double to_edge =
                std::min({part[0] * height[0], part[1] * height[1], part[2] * height[2]});
            put(x, y, depth, to_edge < 0.4 * samples ? edge : shaded);
        }
    }
}

void Picture::line(const Point& a, const Point& b, const Colour& colour, double width) {
    const Projected from = project(a);
    const Projected to = project(b);
    const double radius = 0.5 * width * samples;
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const int x1 = static_cast<int>(std::max(from.x, to.x) + radius) + 1;
    const int y1 = static_cast<int>(std::max(from.y, to.y) + radius) + 1;
    for (int y = static_cast<int>(std::min(from.y, to.y) - radius) - 1; y <= y1; ++y) {
        for (int x = static_cast<int>(std::min(from.x, to.x) - radius) - 1; x <= x1; ++x) {
            const double px = x + 0.5 - from.x;
            const double py = y + 0.5 - from.y;
            const double along = px * (to.x - from.x) + py * (to.y - from.y);
            const double t = length > 0 ? std::clamp(along / (length * length), 0.0, 1.0) : 0.0;
            if (std::hypot(px - t * (to.x - from.x), py - t * (to.y - from.y)) > radius) continue;
            put(x, y, from.depth + t * (to.depth - from.depth) - lift, colour);
        }
    }
}

void Picture::dot(const Point& at, const Colour& colour, double radius) {
    const Point nearer = at + lift / scale_ * towards_;
    line(nearer, nearer, colour, 2 * radius);
}

Colour Picture::pixel(std::size_t x, std::size_t y) const {
    Colour sum{0, 0, 0};
    for (std::size_t k = 0; k < samples * samples; ++k) {
        const std::size_t row = y * samples + k / samples;
        const std::size_t column = x * samples + k % samples;
        const Colour& sample = colour_[row * static_cast<std::size_t>(width_) + column];
        for (std::size_t d = 0; d < 3; ++d) sum[d] += sample[d] / (samples * samples);
    }
    return sum;
}

Picture::Indexed Picture::indexed() const {
    const auto width = static_cast<std::size_t>(width_ / samples);
    const auto height = static_cast<std::size_t>(height_ / samples);
    std::vector<Rgb> image;
    std::map<Rgb, std::size_t> uses;
    for (std::size_t i = 0; i < width * height; ++i) {
        const Colour exact = pixel(i % width, i / width);
        Rgb rounded{};
        for (std::size_t d = 0; d < 3; ++d) {
            // Colours of 5 bits a channel: fewer of them, and smaller files.
            rounded[d] =
                static_cast<int>(std::lround(std::clamp(exact[d], 0.0, 1.0) * 31)) * 255 / 31;
        }
        image.push_back(rounded);
        ++uses[rounded];
    }
    const std::vector<Rgb> palette = most_frequent(uses);
    std::map<Rgb, char> number_of;
    for (const auto& use : uses)
        number_of[use.first] = static_cast<char>(nearest(palette, use.first));
    Indexed result;
    for (const Rgb& colour : palette) {
        for (const int channel : colour) result.palette += static_cast<char>(channel);
    }
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (i % width == 0) result.rows += '\0';  // the PNG filter: none
        result.rows += number_of[image[i]];
    }
    return result;
}

void Picture::write(const std::string& path) const {
    const Indexed image = indexed();
    uLongf size = compressBound(static_cast<uLong>(image.rows.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(image.rows.data()),
                  static_cast<uLong>(image.rows.size()), Z_BEST_COMPRESSION) != Z_OK) {
        throw IoError("the picture could not be compressed");
    }
    packed.resize(size);
    std::string header;
    append(header, static_cast<std::uint32_t>(width_ / samples));
    append(header, static_cast<std::uint32_t>(height_ / samples));
    header += {8, 3, 0, 0, 0};  // a byte a pixel, the number of a colour of the palette
    std::string file = "\x89PNG\r\n\x1a\n";
    append_chunk(file, "IHDR", header);
    append_chunk(file, "PLTE", image.palette);
    append_chunk(file, "IDAT", packed);
    append_chunk(file, "IEND", "");
    if (!std::ofstream(path, std::ios::binary)
             .write(file.data(), static_cast<std::streamsize>(file.size()))) {
        throw IoError(path + " cannot be written");
    }
}
