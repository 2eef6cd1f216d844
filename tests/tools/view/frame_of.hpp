// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A frame of an Explorer as a page reads it, and the surfaces in it.
#pragma once

#include <array>
#include <cstdio>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <explorer.hpp>
#include <nestgrid/adapters/node_field.hpp>

#include "same_surface.hpp"

namespace nestgrid_test {

class Frame {
public:
    explicit Frame(std::vector<std::byte> bytes) : bytes_{std::move(bytes)} {
        std::uint32_t length = 0;
        std::memcpy(&length, bytes_.data(), sizeof length);
        arrays_ = sizeof length + length;
        text_.assign(reinterpret_cast<const char*>(bytes_.data()) + sizeof length, length);
    }

    const std::string& text() const { return text_; }
    /// A number of the frame, or of the first part of a kind.
    double number(const std::string& name, const std::string& kind = "") const {
        return std::stod(text_.substr(behind("\"" + name + "\":", part(kind))));
    }
    /// Whether a number of the frame is told, and not null.
    bool has_number(const std::string& name) const {
        return text_.compare(behind("\"" + name + "\":", 0), 4, "null") != 0;
    }
    bool has(const std::string& kind) const {
        return text_.find(R"("kind":")" + kind + "\"") != std::string::npos;
    }
    template <class Number>
    std::vector<Number> array(const std::string& kind, const std::string& name) const {
        const std::size_t array = behind("\"" + name + "\":{", part(kind));
        const auto at = std::stoul(text_.substr(behind("\"at\":", array)));
        const auto count = std::stoul(text_.substr(behind("\"count\":", array)));
        std::vector<Number> numbers(count);
        // Views of a browser begin at multiples of the size of their numbers.
        if (arrays_ + at + count * sizeof(Number) > bytes_.size() || (arrays_ + at) % 4 != 0) {
            throw std::out_of_range("the array " + name + " is not where a view can be");
        }
        if (count == 0) return numbers;
        std::memcpy(numbers.data(), bytes_.data() + arrays_ + at, count * sizeof(Number));
        return numbers;
    }

private:
    std::size_t part(const std::string& kind) const {
        return kind.empty() ? 0 : behind(R"("kind":")" + kind + "\"", 0);
    }
    std::size_t behind(const std::string& what, std::size_t from) const {
        const std::size_t found = text_.find(what, from);
        if (found == std::string::npos) throw std::out_of_range("no " + what + " in " + text_);
        return found + what.size();
    }

    std::vector<std::byte> bytes_;
    std::string text_;
    std::size_t arrays_;
};

/// A field that borrows a grid and values of the test.
template <class Grid>
nestgrid::view::ExploredField borrowed_field(const Grid& grid, const std::vector<double>& values) {
    const std::shared_ptr<const Grid> shared(std::shared_ptr<const void>(), &grid);
    return nestgrid::view::still_field(shared, nestgrid::NodeField<Grid, double>(grid, values));
}

inline Frame frame_of(nestgrid::view::Explorer& explorer, const std::string& request) {
    return Frame(explorer.frame(request));
}

inline std::string text_of(double x) {
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "%.17g", x);
    return digits.data();
}

inline std::vector<float> floats_of(std::span<const nestgrid::Point> points) {
    std::vector<float> result;
    for (const nestgrid::Point& x : points) {
        for (const double c : x) result.push_back(static_cast<float>(c));
    }
    return result;
}

template <class Simplices>
std::vector<std::uint32_t> indices_of(const Simplices& simplices) {
    std::vector<std::uint32_t> result;
    for (const auto& simplex : simplices)
        result.insert(result.end(), simplex.begin(), simplex.end());
    return result;
}

/// The surface of arrays of a frame.
template <int dimension>
nestgrid::Surface<dimension> surface_of(const std::vector<float>& positions,
                                        const std::vector<std::uint32_t>& indices) {
    constexpr auto corners = static_cast<std::size_t>(dimension);
    nestgrid::Surface<dimension> surface;
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        surface.vertices.push_back({positions[i], positions[i + 1], positions[i + 2]});
    }
    for (std::size_t i = 0; i + corners <= indices.size(); i += corners) {
        auto& simplex = surface.simplices.emplace_back();
        for (std::size_t k = 0; k < corners; ++k) simplex[k] = indices[i + k];
    }
    return surface;
}

/// A part of a frame has the vertices and triangles (segments) of a surface.
template <int dimension>
void expect_part(const Frame& frame, const std::string& kind,
                 const nestgrid::Surface<dimension>& surface) {
    expect_same_simplices(
        surface_of<dimension>(frame.array<float>(kind, "positions"),
                              frame.array<std::uint32_t>(kind, "indices")),
        surface_of<dimension>(floats_of(surface.vertices), indices_of(surface.simplices)));
}

}  // namespace nestgrid_test
