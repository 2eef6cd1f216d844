// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The element at hand: its corners, and where a level cuts its edges.
#pragma once

#include <algorithm>

#include <contours/cell_contour.hpp>
#include <contours/level.hpp>
#include <level_sets/finest_piece.hpp>
#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <surfaces/surface_builder.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// Names and makes the vertices of one element. A vertex on an edge is named by the two nodes of
/// the maximal edge around that edge, and cuts the maximal edge from its lower to its higher value:
/// all elements at the edge find the same name and the same bits.
template <class Real>
class ElementCuts {
public:
    using View = ElementView<Real>;

    /// \param first_attribute the first of the components that vertices carry
    ElementCuts(const Walk<Real>& walk, std::size_t first_attribute)
        : walk_{&walk},
          components_{walk.components()},
          first_attribute_{first_attribute},
          finest_{walk},
          attributes_(components_ - first_attribute) {}

    /// Loads positions, and keys where asked for, of the corners of an element.
    NESTGRID_INLINE void load(const View& view, bool keys) {
        view_ = &view;
        walk_->corners(view, keys ? key_.data() : nullptr, x_.data());
    }
    /// Loads an element that was put aside.
    /// \param keys of the corners, or null; and so are their positions
    void reload(const View& view, const NodeKey* keys, const Point* positions) {
        view_ = &view;
        if (keys == nullptr) return;
        std::copy(keys, keys + view.corner_count(), key_.begin());
        std::copy(positions, positions + view.corner_count(), x_.begin());
    }
    /// Chooses whether edges are cut on their finest pieces (finest_piece.hpp).
    void set_finest(bool finest) { cuts_finest_ = finest; }
    /// Sets the level that cuts the loaded element.
    void set_level(const Level<Real>& level) {
        level_ = &level;
        off_level_ = 0;
    }

    const View& view() const { return *view_; }
    const Level<Real>& level() const { return *level_; }
    const Walk<Real>& walk() const { return *walk_; }
    std::size_t attribute_count() const { return attributes_.size(); }
    const std::array<NodeKey, max_corners>& keys() const { return key_; }
    const std::array<Point, max_corners>& positions() const { return x_; }
    /// A component of the field at the corners.
    /// \param component 0 is the first behind the functions of position
    NESTGRID_INLINE std::array<double, max_corners> data(std::size_t component) const {
        std::array<double, max_corners> values;
        const Real* const value = view_->value + walk_->function_count() + component;
        for (std::size_t i = 0; i < view_->corner_count(); ++i) {
            values[i] = static_cast<double>(value[i * components_]);
        }
        return values;
    }
    /// The component less the value of the level, at a corner.
    double u(std::size_t corner) const {
        const Real value = view_->value[corner * components_ + level_->component];
        return static_cast<double>(value) - level_->value;
    }
    /// The same at all corners.
    std::array<double, max_corners> u() const {
        std::array<double, max_corners> values{};
        for (std::size_t i = 0; i < view_->corner_count(); ++i) values[i] = u(i);
        return values;
    }

    /// The name of the vertex on a cut edge.
    NESTGRID_INLINE KeyPair name(std::uint8_t edge) const {
        if (const auto* maximal = view_->closed.edge(edge)) {
            return {maximal->key(0), maximal->key(1)};
        }
        const auto& [a, b] = view_->topology().edge[edge];
        return {key_[a], key_[b]};
    }
    /// Whether edges of the element that no maximal edge contains are cut on finest pieces.
    bool cuts_finest() const { return cuts_finest_ && !view_->is_leaf(); }
    /// How far P_S U was from the level at the cuts so far, at most.
    double off_level() const { return off_level_; }
    /// The cut of an edge.
    SurfaceCut cut(std::uint8_t edge) const;
    /// The cut of an edge that no maximal edge contains, without attributes.
    /// \param inside the corners inside the level, one bit each
    NESTGRID_INLINE SurfaceCut plain_cut(std::uint8_t edge, unsigned inside) const {
        const auto [low, high] = ends(edge, inside);
        if (cuts_finest()) return finest_cut(low, high);
        const double fraction = fraction_between(low, high);
        return {between(low, high, fraction), {key_[low], key_[high]}, fraction, {}};
    }
    /// Positions of the cuts of some edges.
    NESTGRID_INLINE void positions_of(std::span<const std::uint8_t> edges, unsigned inside,
                                      Point* out) const {
        if (view_->closed.any || cuts_finest()) return positions_of_any(edges, inside, out);
        for (const std::uint8_t edge : edges) {
            const auto [low, high] = ends(edge, inside);
            *out++ = between(low, high, fraction_between(low, high));
        }
    }
    /// The end of a cut edge at which the component has the value of the level, or no_corner. Such
    /// a node may lie inside the maximal edge around that edge.
    static constexpr std::size_t no_corner = max_corners;
    std::size_t corner_at_level(std::uint8_t edge) const {
        const auto& [a, b] = view_->topology().edge[edge];
        return u(a) == 0 ? a : u(b) == 0 ? b : no_corner;
    }
    /// Whether the component has the value of the level at a corner.
    bool touches_level() const {
        bool touches = false;
        for (std::size_t i = 0; i < view_->corner_count(); ++i) touches |= u(i) == 0;
        return touches;
    }
    /// A corner as a vertex.
    SurfaceCut node(std::size_t corner) const;
    /// Attributes at a point of the reference element. Valid until the next call, cut() or node().
    std::span<const double> attributes_at(const Point& reference) const;
    /// The segments on a face.
    /// \param signs bit i says that corner i of the face is inside the level
    const FaceContour& contour(const FaceTopology& face, unsigned signs) const {
        return face_contour(face.corners, signs, alternate(face.corners, signs) && joined(face));
    }
    /// Whether the corners inside the level are joined across a face whose signs alternate.
    bool joined(const FaceTopology& face) const {
        return joins_across(u(face.corner[0]), u(face.corner[1]), u(face.corner[2]),
                            u(face.corner[3]));
    }

private:
    struct Ends {
        std::size_t low;
        std::size_t high;
    };
    NESTGRID_INLINE Ends ends(std::uint8_t edge, unsigned inside) const {
        const auto& [a, b] = view_->topology().edge[edge];
        const bool falls = (inside >> a & 1U) != 0;
        return {falls ? std::size_t{b} : std::size_t{a}, falls ? std::size_t{a} : std::size_t{b}};
    }
    NESTGRID_INLINE double fraction_between(std::size_t low, std::size_t high) const {
        const Real* const value = view_->value + level_->component;
        return level_->fraction(static_cast<double>(value[low * components_]),
                                static_cast<double>(value[high * components_]));
    }
    NESTGRID_INLINE Point between(std::size_t low, std::size_t high, double fraction) const {
        return x_[low] + fraction * (x_[high] - x_[low]);
    }

    void positions_of_any(std::span<const std::uint8_t> edges, unsigned inside, Point* out) const;
    SurfaceCut finest_cut(std::size_t low, std::size_t high) const;

    const Walk<Real>* walk_;
    std::size_t components_;
    std::size_t first_attribute_;
    mutable FinestPiece<Real> finest_;
    bool cuts_finest_ = false;
    mutable double off_level_ = 0;
    const View* view_ = nullptr;
    const Level<Real>* level_ = nullptr;
    std::array<NodeKey, max_corners> key_{};
    std::array<Point, max_corners> x_{};
    mutable std::vector<double> attributes_;  // attributes of the vertex made last
};

}  // namespace nestgrid::engine
