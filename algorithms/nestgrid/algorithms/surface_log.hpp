// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What one task draws, to be repeated into the sinks of all tasks in the order of one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/inlining.hpp>
#include <nestgrid/key_table.hpp>
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

/// A sink (surface.hpp) that keeps what it is told. Vertices come with the nodes they lie between,
/// by which a vertex is known to several tasks; those inside one element come without.
template <int dimension, class Element, std::size_t attribute_count, bool is_indexed>
class SurfaceLog {
public:
    static constexpr bool logs = true;
    static constexpr bool indexed = is_indexed;
    using Cut = SurfaceCut<attribute_count>;
    using Corner = std::conditional_t<is_indexed, std::uint32_t, Point>;
    using Simplex = std::array<Corner, static_cast<std::size_t>(dimension)>;
    using Ridge = std::array<Corner, static_cast<std::size_t>(dimension - 1)>;
    struct Owner {
        Element element;
        Shape shape;
        int level;
        std::size_t first;  ///< simplex from it
    };

    /// \param elements whether the sink it is for keeps them
    explicit SurfaceLog(bool elements) : keeps_elements_{elements} {}

    /// \param alone no other task knows it
    NESTGRID_INLINE void add_cut(const Cut& cut, bool alone) {
        kinds_.push_back(alone ? Kind::alone : Kind::shared);
        cuts_.push_back(cut);
    }
    void add_vertex(const Point& x, std::span<const double> attributes) {
        kinds_.push_back(Kind::unnamed);
        cuts_.push_back({x, {}, 0, {}});
        for (std::size_t i = 0; i < attribute_count; ++i)
            cuts_.back().attributes[i] = attributes[i];
    }
    Point position(std::uint32_t vertex) const { return cuts_[vertex].x; }
    bool keeps_elements() const { return keeps_elements_; }
    void add_element(const Element& element, Shape shape, int level) {
        if (keeps_elements_) elements_.push_back({element, shape, level, simplices_.size()});
    }
    NESTGRID_INLINE void add_simplex(const Simplex& corners, std::span<const Point> reference) {
        simplices_.push_back(corners);
        for (const Point& x : reference) reference_.push_back(x);
    }
    template <class Corners>
    void add_simplices(std::span<const std::uint32_t> vertices, std::span<const Corners> all)
        requires(is_indexed)
    {
        put_simplices(vertices, all, simplices_);
    }
    void add_boundary(const Ridge& corners) { boundary_.push_back(corners); }

    /// As new, but for its memory.
    void clear(bool elements) {
        keeps_elements_ = elements;
        kinds_.clear();
        cuts_.clear();
        elements_.clear();
        simplices_.clear();
        reference_.clear();
        boundary_.clear();
    }

    /// Repeats the calls, those for vertices before all others; corners are numbers of vertices in
    /// the order they were added here. Cuts that other tasks may know are announced by expect().
    template <class Receiver>
    void repeat(Receiver&& to) const {
        constexpr std::size_t ahead = 16;
        for (std::size_t i = 0; i < cuts_.size(); ++i) {
            if (i + ahead < cuts_.size() && kinds_[i + ahead] == Kind::shared) {
                to.expect(cuts_[i + ahead]);
            }
            switch (kinds_[i]) {
                case Kind::shared:
                    to.cut(cuts_[i]);
                    break;
                case Kind::alone:
                    to.cut_alone(cuts_[i]);
                    break;
                case Kind::unnamed:
                    to.vertex(cuts_[i]);
                    break;
            }
        }
        for (const Ridge& corners : boundary_) to.boundary(corners);
        if (elements_.empty() && reference_.empty()) return to.simplices(simplices_);
        auto element = elements_.begin();
        std::span<const Point> reference(reference_);
        const std::size_t step = reference_.empty() ? 0 : dimension;
        for (std::size_t i = 0; i < simplices_.size(); ++i) {
            if (element != elements_.end() && element->first == i) to.element(*element++);
            to.simplex(simplices_[i], reference.first(step));
            reference = reference.subspan(step);
        }
    }

private:
    enum class Kind : std::uint8_t { shared, alone, unnamed };

    bool keeps_elements_;
    std::vector<Kind> kinds_;  // of the cuts
    std::vector<Cut> cuts_;
    std::vector<Owner> elements_;
    std::vector<Simplex> simplices_;
    std::vector<Point> reference_;
    std::vector<Ridge> boundary_;
};

}  // namespace nestgrid
