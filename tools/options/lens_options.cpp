// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "options/lens_options.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <nestgrid/error.hpp>

#include "input/input_file.hpp"
#include "input/meshes/solid.hpp"
#include "options/number_list.hpp"

namespace {

using nestgrid::Distance;
using nestgrid::Point;

constexpr const char* known_lenses =
    "ball:x,y,z,r, box:x,x,y,y,z,z, halfspace:x,y,z,x,y,z, cone:x,y,z,x,y,z,degrees, "
    "frustum:EYE,TOWARDS,UP,degrees,aspect,nearest,farthest (three times x,y,z), "
    "polyhedron:FILE, polygon:FILE or surface:FILE";

[[noreturn]] void refuse(const std::string& text) {
    throw nestgrid::InvalidInput("the lens '" + text + "' is none of " + known_lenses);
}

/// \throw nestgrid::InvalidInput unless there are so many finite numbers between commas
std::vector<double> lens_numbers(const std::string& text, const std::string& list,
                                 std::size_t count) {
    std::vector<double> numbers = numbers_of(list);
    if (numbers.size() != count) refuse(text);
    return numbers;
}

/// \param each how many numbers are on each line, and `what` they are
/// \throw nestgrid::IoError where the file is no such list, of 10 MB at most
std::vector<double> read_numbers(const std::string& path, std::size_t each,
                                 const std::string& what) {
    constexpr std::uintmax_t most_bytes = 10000000;
    require_file(path);
    std::error_code error;
    std::ifstream file(path);
    std::vector<double> numbers;
    double number = 0;
    const bool small = std::filesystem::file_size(path, error) <= most_bytes;
    while (small && file >> number) numbers.push_back(number);
    if (!file.eof() || numbers.empty() || numbers.size() % each != 0) {
        throw nestgrid::IoError("'" + path + "' is no list of " + what + " on each line");
    }
    return numbers;
}

Distance read_polygon(const std::string& path) {
    const auto numbers = read_numbers(path, 2, "corners, x and y");
    std::vector<nestgrid::ImagePoint> corners;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        corners.push_back({numbers[i], numbers[i + 1]});
    }
    return nestgrid::Polygon(std::move(corners));
}

Distance read_polyhedron(const std::string& path) {
    const auto numbers = read_numbers(path, 6, "half-spaces, a point and the outer normal");
    std::vector<nestgrid::HalfSpace> sides;
    for (std::size_t i = 0; i < numbers.size(); i += 6) {
        sides.emplace_back(point_at(numbers, i), point_at(numbers, i + 3));
    }
    return nestgrid::ConvexPolyhedron(std::move(sides));
}

Distance domain_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) refuse(text);
    const std::string kind = text.substr(0, colon);
    const std::string list = text.substr(colon + 1);
    if (kind == "ball") {
        const auto n = lens_numbers(text, list, 4);
        if (n[3] < 0) throw nestgrid::InvalidInput("the radius of '" + text + "' is negative");
        return nestgrid::Ball{point_at(n, 0), n[3]};
    }
    if (kind == "box") {
        const auto n = lens_numbers(text, list, 6);
        if (!(n[0] <= n[1] && n[2] <= n[3] && n[4] <= n[5])) {
            throw nestgrid::InvalidInput("'" + text +
                                         "' is empty: bounds are x,x,y,y,z,z in ascending order");
        }
        return nestgrid::Box{{n[0], n[2], n[4]}, {n[1], n[3], n[5]}};
    }
    if (kind == "halfspace") {
        const auto n = lens_numbers(text, list, 6);
        return nestgrid::HalfSpace(point_at(n, 0), point_at(n, 3));
    }
    if (kind == "cone") {
        const auto n = lens_numbers(text, list, 7);
        return nestgrid::Cone(point_at(n, 0), point_at(n, 3), n[6] * std::numbers::pi / 180);
    }
    if (kind == "frustum") {
        const auto n = lens_numbers(text, list, 13);
        const nestgrid::PerspectiveCamera camera{.eye = point_at(n, 0),
                                                 .towards = point_at(n, 3),
                                                 .up = point_at(n, 6),
                                                 .angle = n[9] * std::numbers::pi / 180,
                                                 .aspect = n[10]};
        return nestgrid::view_frustum(camera, n[11], n[12]);
    }
    if (kind == "polyhedron") return read_polyhedron(list);
    if (kind == "polygon") return read_polygon(list);
    if (kind == "surface") return read_solid(list);
    refuse(text);
}

}  // namespace

void add_lens_options(CLI::App& command, LensText& text) {
    auto* lens = command
                     .add_option("--lens", text.domains,
                                 "draw finely in a domain and coarsely far from it; again for "
                                 "several: " +
                                     std::string(known_lenses))
                     ->type_name("DOMAIN")
                     ->group("Lens")
                     ->take_all();
    command
        .add_option("--finest", text.finest,
                    "size of the elements in the lens [0, the finest there are]")
        ->type_name("LENGTH")
        ->group("Lens")
        ->needs(lens);
    command.add_option("--coarsest", text.coarsest, "size of elements anywhere [no limit]")
        ->type_name("LENGTH")
        ->group("Lens")
        ->needs(lens);
    command.add_option("--slope", text.slope, "growth of elements with the distance from the lens")
        ->type_name("NUMBER")
        ->group("Lens")
        ->capture_default_str()
        ->needs(lens);
}

std::optional<nestgrid::LensRequest> parse(const LensText& text) {
    if (text.domains.empty()) return {};
    if (!(text.finest >= 0) || !std::isfinite(text.finest)) {
        throw nestgrid::InvalidInput("--finest is negative or not a finite number");
    }
    if (!(text.coarsest >= text.finest)) {
        throw nestgrid::InvalidInput("--coarsest is below --finest or not a number");
    }
    if (!(text.slope >= 0) || !std::isfinite(text.slope)) {
        throw nestgrid::InvalidInput("--slope is negative or not a finite number");
    }
    Distance all = domain_of(text.domains.front());
    for (std::size_t i = 1; i < text.domains.size(); ++i) {
        all = nestgrid::union_of(std::move(all), domain_of(text.domains[i]));
    }
    return nestgrid::LensRequest{std::move(all), text.finest, text.coarsest, text.slope};
}
