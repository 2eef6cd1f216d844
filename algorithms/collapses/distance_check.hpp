// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Collapses that keep a surface within a distance of the surface of all data, and all of the latter
// within the same distance of what is left.
//
// There, each new triangle is looked at as a whole (FarSearch). Back, each part of the surface of
// all data is near to one triangle, its owner; where triangles are replaced, each of their parts
// must be near to one of the new ones, as a whole or by quarters. So nothing is lost.
#pragma once

#include <collapses/near_leaves.hpp>
#include <collapses/near_parts.hpp>
#include <collapses/strong_nodes.hpp>
#include <nestgrid/algorithms/nearness.hpp>

namespace nestgrid::engine {

/// The faces of leaves on the boundary of the domain. Bent ones are taken for two triangles.
class DomainFaces {
public:
    explicit DomainFaces(const NearLeaves& leaves);

    /// Whether a tetrahedron, a corner of which lies in the domain, keeps inside.
    bool hold(const Tetrahedron& x) const;

private:
    std::vector<Triangle> faces_;
    BoxTree tree_;
};

class DistanceCheck {
public:
    /// \param to_whole ClosestPoints of the surface of `nearness`; borrowed
    /// \param leaves those at the boundary of the domain at least
    DistanceCheck(const Nearness& nearness, const ClosestPoints& to_whole, const NearLeaves& leaves)
        : distance_{nearness.distance},
          to_whole_{&to_whole},
          whole_(nearness.whole, nearness.distance),
          domain_(leaves) {}

    /// One for each task.
    FarSearch search() const { return {*to_whole_, distance_}; }
    const PartedSurface& whole() const { return whole_; }
    const DomainFaces& domain() const { return domain_; }

private:
    double distance_;
    const ClosestPoints* to_whole_;
    PartedSurface whole_;
    DomainFaces domain_;
};

/// Judges the collapses of one task.
class DistanceJudge {
public:
    explicit DistanceJudge(const DistanceCheck& check) : check_{&check}, search_{check.search()} {}

    /// Whether the distance is kept there and back where a fan of triangles takes the place of
    /// others.
    /// \param w the common corner of the fan
    /// \param parts of the others
    bool keeps(const Point& w, std::span<const Triangle> fan,
               std::span<const std::vector<NearPart>* const> parts);
    /// Which parts the triangles of that fan have, where it is kept; to be moved away.
    std::span<std::vector<NearPart>> given() { return {given_.data(), fan_size_}; }

private:
    bool keeps_back(std::span<const Triangle> fan,
                    std::span<const std::vector<NearPart>* const> parts);

    const DistanceCheck* check_;
    FarSearch search_;
    std::size_t fan_size_ = 0;
    std::vector<std::vector<NearPart>> given_;
};

}  // namespace nestgrid::engine
