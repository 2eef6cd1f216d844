// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of the sign patterns of every shape, generated from its topology the first time a shape
// is met (paper, section 8).
//
// Invariants:
//   - the contour on a face is a function of the face alone: its signs and, where the signs of a
//     quadrilateral alternate, which of its diagonals is joined across it;
//   - every cut edge falls on one of its two faces and rises on the other, so the segments on the
//     faces link up to loops, and every cut edge lies on one of them;
//   - no edge inside a filled loop joins two vertices on one face of the element.
// Consequences: elements on both sides of a face draw the same, in opposite directions; no edge
// inside one element is an edge of another.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// One loop of a contour: cut edges in order; the segment from edge i to edge i + 1 lies in
/// face[i]. Seen along the loop, the corners with U >= C lie behind the disc it bounds.
/// In two dimensions a "loop" is a segment of two cut edges, and face[i] the side cut at edge i.
struct ContourLoop {
    std::uint8_t count = 0;
    std::array<std::uint8_t, max_edges> edge{};
    std::array<std::uint8_t, max_edges> face{};
    std::uint8_t positive = 0;        ///< region of the corners with U >= C along it
    std::uint8_t negative = 0;        ///< region of those with U < C
    std::uint8_t triangle_count = 0;  ///< 0 where the loop is filled around a vertex in its middle
    std::array<std::array<std::uint8_t, 3>, max_edges - 2> triangle{};  ///< of places in the loop
    bool any_diagonal = false;  ///< a loop of four that may be cut along either diagonal
};

/// The contour of one sign pattern and one choice on every alternating face.
struct Contour {
    std::uint8_t loop_count = 0;
    std::array<ContourLoop, 4> loop{};
    /// Corners joined on the surface of the element, one number per connected region.
    std::array<std::uint8_t, max_corners> region{};
};

/// A segment of the contour on a face, as places in its loop of corners: it leaves through side
/// `falls`, from corner `falls` with U >= C to the next one, and comes back through side `rises`.
struct FaceSegment {
    std::uint8_t falls = 0;
    std::uint8_t rises = 0;
};

/// The segments on a face. Bit i of `signs` says that corner i of the loop has U >= C; `joined`
/// says for an alternating quadrilateral that those corners are joined across it.
struct FaceContour {
    std::uint8_t count = 0;
    std::array<FaceSegment, 2> segment{};
};

/// Whether the signs at the corners of a face, one bit each, change along every side of a
/// quadrilateral.
constexpr bool alternate(std::size_t corners, unsigned signs) {
    return corners == 4 && (signs == 5 || signs == 10);
}

constexpr FaceContour make_face_contour(std::size_t corners, unsigned signs, bool joined) {
    FaceContour contour;
    const auto positive = [&](std::size_t i) { return (signs >> (i % corners) & 1U) != 0; };
    const bool alternating = alternate(corners, signs);
    for (std::size_t i = 0; i < corners; ++i) {
        if (!positive(i) || positive(i + 1)) continue;
        std::size_t rises = 0;
        if (alternating) {
            rises = (joined ? i + 1 : i + corners - 1) % corners;
        } else {
            while (positive(rises) || !positive(rises + 1)) ++rises;
        }
        contour.segment[contour.count++] = {static_cast<std::uint8_t>(i),
                                            static_cast<std::uint8_t>(rises)};
    }
    return contour;
}

inline constexpr auto face_contours = [] {
    std::array<std::array<std::array<FaceContour, 2>, 16>, 5> contours{};
    for (const std::size_t corners : {3U, 4U}) {
        for (unsigned signs = 0; signs < 1U << corners; ++signs) {
            for (const bool joined : {false, true}) {
                contours[corners][signs][joined ? 1 : 0] =
                    make_face_contour(corners, signs, joined);
            }
        }
    }
    return contours;
}();
/// The segments on a face of three or four corners.
constexpr const FaceContour& face_contour(std::size_t corners, unsigned signs, bool joined) {
    return face_contours[corners][signs][joined ? 1 : 0];
}

/// The signs at the corners of a face, one bit each.
/// \param inside the corners of the element with U >= C, one bit each
constexpr unsigned signs_of(const FaceTopology& face, unsigned inside) {
    unsigned signs = 0;
    for (std::size_t i = 0; i < face.corners; ++i) {
        signs |= (inside >> face.corner[i] & 1U) << i;
    }
    return signs;
}

/// The edge of an element under a side of one of its faces.
inline std::uint8_t edge_at(Shape shape, const FaceTopology& face, std::size_t side) {
    return edge_between(shape, face.corner[side], face.corner[(side + 1) % face.corners]);
}

/// The contours of one shape.
class ContourTable {
public:
    /// The table of a shape of dimension 2 or 3.
    static const ContourTable& of(Shape shape);

    /// Faces whose signs alternate, one bit each; bit i of `pattern` says that corner i has U >= C.
    /// In two dimensions bit 0 stands for the element itself.
    unsigned alternating(unsigned pattern) const { return alternating_[pattern]; }

    /// Edges whose ends have different signs, one bit each.
    unsigned cut_edges(unsigned pattern) const { return cut_edges_[pattern]; }
    /// Faces with such edges, one bit each; 1 in two dimensions.
    unsigned cut_faces(unsigned pattern) const { return cut_faces_[pattern]; }

    /// The contour of a sign pattern.
    /// \param joined which alternating faces join their corners with U >= C, one bit each
    const Contour& at(unsigned pattern, unsigned joined = 0) const {
        unsigned choice = 0;
        unsigned place = 0;
        for (unsigned left = alternating_[pattern]; left != 0; left &= left - 1) {
            choice |= (joined >> std::countr_zero(left) & 1U) << place++;
        }
        return contours_[first_[pattern] + choice];
    }

    /// The contour of a pattern if nothing in it depends on values, else null. Nothing does if no
    /// signs alternate, every loop is a segment or filled with triangles between its own vertices,
    /// and there is no tunnel.
    const Contour* plain(unsigned pattern) const {
        return plain_[pattern] ? &contours_[first_[pattern]] : nullptr;
    }

private:
    explicit ContourTable(Shape shape);
    /// The table of one shape. The first call makes it.
    template <Shape shape>
    static const ContourTable& table_of();

    std::vector<std::uint8_t> alternating_;
    std::vector<std::uint16_t> cut_edges_;
    std::vector<std::uint8_t> cut_faces_;
    std::vector<std::uint32_t> first_;
    std::vector<std::uint8_t> plain_;
    std::vector<Contour> contours_;
};

}  // namespace nestgrid::engine
