// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The coefficients of one component in elements below leaves, and what of it lies in them.
#pragma once

#include <high_order/leaf_records.hpp>

namespace nestgrid::engine {

/// What is known of an element besides its name.
struct ElementState {
    Handle base;                 // the element of the hierarchy, or the leaf it lies in
    const Rule* rule = nullptr;  // of that element
    const ShapeParts* shape = nullptr;
    CornerKeys key{};
    NodeKey path = 0;                     // of that element
    std::array<Point, max_corners> x{};   // of the corners, where the hierarchy has positions
    std::array<Place, max_corners> at{};  // in the leaf, in units of 2^-level
};

/// An element of the hierarchy, or one below a leaf.
struct VirtualElement {
    static constexpr std::uint32_t no_leaf = 0xFFFFFFFFU;
    static constexpr std::uint32_t left_out = no_leaf - 1;  // a leaf that is not looked at
    std::uint32_t leaf = no_leaf;  // none: an element that the hierarchy itself divides
    std::int32_t level = 0;        // below the leaf
    // The numbers of children from the leaf on, 4 bits each; of a leaf that is left out its path.
    std::uint64_t way = 0;
    const ElementState* state = nullptr;

    VirtualElement father() const { return {leaf, level - 1, way >> 4U, nullptr}; }
    /// The corners in the leaf, in units of 2^-level.
    std::span<const Place> places() const {
        return std::span<const Place>(state->at).first(state->shape->corners);
    }
};

/// The corners of a child of an element that its red rule divides, in units of half the size.
/// \param at the corners of the element
std::array<Place, max_corners> child_places(const ShapeParts& shape,
                                            const std::array<Place, max_corners>& at,
                                            const Child& child);

/// The coefficients on an element below a leaf; below a pyramid on a box around.
struct OwnNet {
    const double* net = nullptr;
    int degree = 1;
    std::array<std::uint8_t, max_corners> number{};  // of the corners, among those of the net
    Factors factors;                                 // of the net
    const PyramidCurvature* curvature = nullptr;     // below a pyramid
};

/// Keeps the nets that it made last: of one task.
class ElementNets {
public:
    /// Borrows the records. \param depth of elements below leaves, at most
    ElementNets(const LeafRecords& records, std::size_t component, int depth)
        : records_{&records},
          component_{component},
          halves_(static_cast<std::size_t>(depth) + 1),
          net_(max_net_size) {}

    /// Boxes are halved on the way down; others are parts of the leaf, whose coefficients depend on
    /// their corners alone. What it points to stays until the next call.
    OwnNet of(const VirtualElement& e);
    /// The polynomial of the leaf at a corner of an element.
    double at_corner(const VirtualElement& e, const OwnNet& own, std::size_t corner) const;
    /// The coefficients in all children of a box, one child behind the other.
    const double* of_children(const VirtualElement& e);
    /// Beta of an edge or a face of an element that lies inside its leaf.
    static double beta_on_part(const VirtualElement& e, const OwnNet& own, const ShapePart& part);
    /// How far the polynomial is from what is drawn at the corners.
    /// \param u what is drawn there
    double corner_error(const VirtualElement& e, const OwnNet& own,
                        std::span<const double> u) const;
    /// How far it may be from what is drawn between them.
    /// \param beta of the net \param enough below this no better bound is looked for
    double drawn_error(const VirtualElement& e, const OwnNet& own, double beta,
                       std::span<const double> u, double enough) const;

private:
    struct Halves {
        std::uint32_t leaf = VirtualElement::no_leaf;
        std::uint64_t way = 0;
        std::vector<double> nets;  // one child behind the other
    };
    double drawn_error_in_pyramid(const VirtualElement& e, const OwnNet& own, double beta,
                                  std::span<const double> u, double enough) const;
    OwnNet in_pyramid(const VirtualElement& e, const LeafPolynomial& leaf);
    const double* of_box(const VirtualElement& e);

    const LeafRecords* records_;
    std::size_t component_;
    std::vector<Halves> halves_;  // by level of the element entered
    std::vector<double> net_;     // of the element looked at last, where it is no box
    std::uint32_t pyramid_ = VirtualElement::no_leaf;  // the one looked into last
    PyramidCurvature curvature_;                       // of that
};

}  // namespace nestgrid::engine
