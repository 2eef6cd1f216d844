// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What one task draws, to be put behind what others have drawn in the order of one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/inlining.hpp>
#include <nestgrid/keys.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid {

/// A vertex of a surface, on the edge from the lower to the higher of two nodes.
template <std::size_t attribute_count>
struct SurfaceCut {
    Point x;
    std::array<NodeKey, 2> node;
    double fraction;
    std::array<double, attribute_count> attributes;
};

/// A surface with numbers of its own. Vertices that other parts may know come with the nodes they
/// lie between; those that only this one can know come without.
template <int dimension, class Element>
struct SurfacePart {
    Surface<dimension, Element> surface;
    std::vector<SharedVertex> shared;  ///< in the order of their numbers

    /// As new, but for its memory.
    /// \param elements whether the sink it is for keeps them
    SurfaceSink<dimension, Element> begin(bool elements) {
        surface.clear();
        shared.clear();
        return SurfaceSink<dimension, Element>(surface, elements, &shared);
    }
};

/// A sink (surface.hpp) without indices that keeps what it is told. Corners are kept once for all
/// simplices that are put down together.
template <int dimension, class Element>
class SimplexLog {
public:
    static constexpr bool indexed = false;

    /// \param elements whether the sink it is for keeps them
    explicit SimplexLog(bool elements) : keeps_elements_{elements} {}

    bool keeps_elements() const { return keeps_elements_; }
    void add_element(const Element& element, Shape shape, int level) {
        if (keeps_elements_) elements_.push_back({element, shape, level, 0});
    }
    NESTGRID_INLINE void add_simplex(
        const std::array<Point, static_cast<std::size_t>(dimension)>& corners,
        std::span<const Point> reference) {
        Simplex& simplex = simplices_.emplace_back();
        for (std::size_t k = 0; k < simplex.size(); ++k) {
            simplex[k] = static_cast<std::uint32_t>(x_.size());
            x_.push_back(corners[k]);
        }
        if (keeps_elements_) ++elements_.back().simplices;
        for (const Point& x : reference) reference_.push_back(x);
    }
    template <class Corners>
    void add_simplices(std::span<const WidePoint> x, std::span<const Corners> all) {
        const auto first = static_cast<std::uint32_t>(x_.size());
        for (const WidePoint& corner : x) x_.push_back(Point(corner));
        for (const Corners& corners : all) {
            Simplex& simplex = simplices_.emplace_back();
            for (std::size_t k = 0; k < simplex.size(); ++k) simplex[k] = first + corners[k];
        }
        if (keeps_elements_) elements_.back().simplices += static_cast<std::uint32_t>(all.size());
    }

    /// As new, but for its memory.
    void clear(bool elements) {
        keeps_elements_ = elements;
        x_.clear();
        elements_.clear();
        simplices_.clear();
        reference_.clear();
    }

    /// Puts everything into a sink.
    template <class Sink>
    void repeat(Sink& to) const {
        constexpr auto corners = static_cast<std::size_t>(dimension);
        const std::span<const Point> x(x_);
        const std::span<const Simplex> all(simplices_);
        std::size_t first = 0;
        const auto some = [&](std::size_t count) {
            if (reference_.empty()) {
                detail::put_simplices<dimension>(to, x, all.subspan(first, count));
                first += count;
                return;
            }
            for (const std::size_t end = first + count; first < end; ++first) {
                std::array<Point, corners> simplex;
                for (std::size_t k = 0; k < corners; ++k) simplex[k] = x[all[first][k]];
                to.add_simplex(
                    simplex, std::span<const Point>(reference_).subspan(first * corners, corners));
            }
        };
        for (const ExtractedElement<Element>& e : elements_) {
            to.add_element(e.element, e.shape, e.level);
            some(e.simplices);
        }
        some(all.size() - first);
    }

private:
    using Simplex = std::array<std::uint32_t, static_cast<std::size_t>(dimension)>;

    bool keeps_elements_;
    std::vector<Point> x_;  // of corners
    std::vector<ExtractedElement<Element>> elements_;
    std::vector<Simplex> simplices_;
    std::vector<Point> reference_;
};

}  // namespace nestgrid
