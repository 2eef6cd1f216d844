// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A coarse grid, from wherever it comes: the coordinates of its nodes, owned or borrowed from a
// tool's array, and the nodes of its elements.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/error.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid {

/// Coordinates of nodes. Borrowed ones must outlive their user and stay where they are.
class Coordinates {
public:
    Coordinates() = default;
    explicit Coordinates(std::vector<Point> points)
        : owned_{std::make_shared<const std::vector<Point>>(std::move(points))},
          first_{owned_->data()},
          count_{owned_->size()} {}

    /// `count` nodes; coordinate d of node i stands at first[i * stride + d], d < 3.
    static Coordinates borrow(const double* first, std::size_t count, std::size_t stride = 3) {
        return {first, count, stride * sizeof(double), false};
    }
    static Coordinates borrow(const float* first, std::size_t count, std::size_t stride = 3) {
        return {first, count, stride * sizeof(float), true};
    }

    std::size_t size() const { return count_; }
    bool borrowed() const { return owned_ == nullptr && count_ > 0; }

    Point operator[](std::size_t i) const {
        const char* at = static_cast<const char*>(first_) + i * stride_;
        if (!single_) {
            const auto* x = reinterpret_cast<const double*>(at);
            return {x[0], x[1], x[2]};
        }
        const auto* x = reinterpret_cast<const float*>(at);
        return {double{x[0]}, double{x[1]}, double{x[2]}};
    }

private:
    Coordinates(const void* first, std::size_t count, std::size_t stride, bool single)
        : first_{first}, count_{count}, stride_{stride}, single_{single} {}

    std::shared_ptr<const std::vector<Point>> owned_;
    const void* first_ = nullptr;
    std::size_t count_ = 0;
    std::size_t stride_ = sizeof(Point);
    bool single_ = false;
};

/// Elements over nodes, at most 2^31 of either.
struct CoarseGrid {
    int dimension = 3;  ///< of the elements: 2 or 3
    Coordinates nodes;
    std::vector<Shape> shapes;                   ///< of each element
    std::vector<std::uint32_t> corners;          ///< nodes, element after element, tensor order
    std::vector<std::uint32_t> first_corner{0};  ///< of each element in `corners`, and the end

    std::size_t element_count() const { return shapes.size(); }

    std::span<const std::uint32_t> element(std::size_t i) const {
        return {corners.data() + first_corner[i], corners.data() + first_corner[i + 1]};
    }
    std::span<std::uint32_t> element(std::size_t i) {
        return {corners.data() + first_corner[i], corners.data() + first_corner[i + 1]};
    }
    void add(Shape shape, std::span<const std::uint32_t> nodes_of_element) {
        shapes.push_back(shape);
        corners.insert(corners.end(), nodes_of_element.begin(), nodes_of_element.end());
        first_corner.push_back(static_cast<std::uint32_t>(corners.size()));
    }
    void add(Shape shape, std::initializer_list<std::uint32_t> nodes_of_element) {
        add(shape, std::span(nodes_of_element.begin(), nodes_of_element.size()));
    }
    /// A face of a surface, its corners in a loop.
    /// \throw InvalidInput for a polygon that is neither a triangle nor a quadrilateral
    void add_loop(std::span<const std::uint32_t> loop) {
        if (loop.size() == 3) {
            add(Shape::triangle, loop);
        } else if (loop.size() == 4) {
            add(Shape::quadrilateral, {loop[0], loop[1], loop[3], loop[2]});
        } else {
            throw InvalidInput("face " + std::to_string(element_count()) + " has " +
                               std::to_string(loop.size()) +
                               " corners; only triangles and quadrilaterals are supported");
        }
    }
    /// Coordinates of the corners of an element.
    std::array<Point, max_corners> positions(std::size_t i) const {
        std::array<Point, max_corners> x{};
        const auto of = element(i);
        for (std::size_t k = 0; k < of.size(); ++k) x[k] = nodes[of[k]];
        return x;
    }
};

}  // namespace nestgrid
