// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/picture_options.hpp"

#include <algorithm>
#include <charconv>

#include <vtkColor.h>
#include <vtkNamedColors.h>
#include <vtkNew.h>

#include <nestgrid/error.hpp>

#include "options/number_list.hpp"
#include "output/surface_file.hpp"

namespace {

using nestgrid::InvalidInput;

constexpr int least_side = 100;
constexpr int greatest_side = 8192;

/// Width and height of "WxH".
std::pair<int, int> parse_size(const std::string& text) {
    int width = 0;
    int height = 0;
    const char* const end = text.data() + text.size();
    const auto [cross, first] = std::from_chars(text.data(), end, width);
    if (first != std::errc() || cross == end || *cross != 'x') width = 0;
    const auto [rest, second] = std::from_chars(std::min(cross + 1, end), end, height);
    if (second != std::errc() || rest != end) width = 0;
    if (std::min(width, height) >= least_side && std::max(width, height) <= greatest_side) {
        return {width, height};
    }
    throw InvalidInput("'" + text + "' is no size of a picture: --size takes WxH, each from " +
                       std::to_string(least_side) + " to " + std::to_string(greatest_side) +
                       " pixels, as in 1600x1200");
}

/// The colour of a name of CSS, or of #rrggbb; none for "transparent".
std::optional<Colour> parse_background(const std::string& text) {
    if (text == "transparent") return std::nullopt;
    const bool hex = text.size() == 7 && text[0] == '#' &&
                     text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
    const vtkNew<vtkNamedColors> colours;
    if (!hex && !colours->ColorExists(text)) {
        throw InvalidInput("'" + text +
                           "' is no colour: --background takes a name such as white, a number "
                           "#rrggbb, or transparent");
    }
    if (!hex) {
        const vtkColor3d colour = colours->GetColor3d(text);
        return Colour{colour[0], colour[1], colour[2]};
    }
    const vtkColor3ub colour = colours->HTMLColorToRGB(text);
    return Colour{colour[0] / 255., colour[1] / 255., colour[2] / 255.};
}

ColourRange parse_range(const std::string& text) {
    const std::vector<double> numbers = numbers_of(text);
    if (numbers.size() == 2 && numbers[0] < numbers[1]) return {numbers[0], numbers[1]};
    throw InvalidInput("'" + text +
                       "' is no range: --range takes the least value and a greater one, as in 0,1");
}

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
    const std::string group = "Picture";
    CLI::Option* image = command.add_option("--image", options.image, "draw a picture, .png");
    image->group(group);
    const auto add = [&](const char* name, auto& target, const std::string& text) {
        command.add_option(name, target, text)->needs(image)->group(group);
    };
    const auto add_flag = [&](const char* name, bool& target, const char* text) {
        command.add_flag(name, target, text)->needs(image)->group(group);
    };
    add("--size", options.size, "WxH in pixels");
    add("--background", options.background, "a colour (white, #rrggbb), or transparent");
    add("--view", options.view,
        "front, back, left, right, top or bottom; angles az,el; or a position, a focus and the "
        "direction upwards, x,y,z,x,y,z,x,y,z");
    add_flag("--perspective", options.perspective, "draw what is near larger");
    add("--colours", options.colours, colour_map_names() + "; with _r reversed");
    add("--range", options.range, "the values of the first and the last colour, LEAST,GREATEST");
    add("--opacity", options.opacity, "of the surface, above 0 up to 1");
    add("--title", options.title, "a line above the picture");
    add_flag("--axes", options.axes, "draw the coordinates around the surface");
    add("--scale-bar", options.unit, "draw a length in this unit, that of the coordinates");
    add_flag("--orientation", options.orientation, "draw the directions of x, y and z");
    add_flag("--detail", options.detail, "magnify a part with its triangles below");
}

PictureStyle parse(const PictureOptions& o) {
    PictureStyle style;
    if (o.image.empty()) return style;
    check_output(o.image, {".png"});
    if (o.size) std::tie(style.width, style.height) = parse_size(*o.size);
    if (o.background) style.background = parse_background(*o.background);
    if (o.view) style.view = parse_view(*o.view);
    if (o.colours) style.colours = parse_colour_map(*o.colours);
    if (o.range) style.range = parse_range(*o.range);
    if (o.opacity && !(*o.opacity > 0 && *o.opacity <= 1)) {
        throw InvalidInput("--opacity is not a number above 0 and at most 1");
    }
    if (o.unit && o.perspective) {
        throw InvalidInput(
            "--scale-bar has no length in --perspective, which draws lengths "
            "smaller the farther they are");
    }
    style.opacity = o.opacity;
    style.unit = o.unit;
    style.title = o.title.value_or("");
    style.perspective = o.perspective;
    style.axes = o.axes;
    style.orientation = o.orientation;
    style.detail = o.detail;
    return style;
}

void refuse_colours(const PictureOptions& options, const std::string& why) {
    if (options.colours) throw InvalidInput("--colours has no effect: " + why);
    if (options.range) throw InvalidInput("--range has no effect: " + why);
}
