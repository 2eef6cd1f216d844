// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The surface of all data in parts, each of which is near to one triangle of another surface.
//
// The distance from a triangle is a convex function. So on a part, which is a triangle, too, it is
// greatest at a corner, and three corners decide for all of the part.
#pragma once

#include <cstdint>
#include <vector>

#include <boost/container/small_vector.hpp>

#include <distances/far_points.hpp>

namespace nestgrid::engine {

/// A triangle of a surface, or a part of it.
struct NearPart {
    std::uint32_t triangle;
    std::uint32_t path = 1;  ///< behind a 1, two bits for each quarter of what was before
};

/// The triangle that is near to a part.
struct Owner {
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    std::uint32_t triangle = none;
    bool may_quarters = false;  ///< where there is none, whether quarters may have one
};

class PartedSurface {
public:
    /// \param whole borrowed
    PartedSurface(const Surface<3>& whole, double distance)
        : whole_{&whole}, square_{distance * distance}, least_{0.02 * distance} {}

    std::size_t size() const { return whole_->simplices.size(); }
    /// Whether no point of a part is farther from a triangle than the distance.
    bool is_near(const Triangle& part, const Triangle& to) const {
        return is_near(part[0], to) && is_near(part[1], to) && is_near(part[2], to);
    }
    bool is_near(const Point& x, const Triangle& to) const {
        return square_distance(x, to) <= square_;
    }
    /// Gives a part, or each of its quarters, to an owner.
    /// \param find find(corners) is the Owner of a part
    /// \param take take(triangle, part) is called for each owner
    /// \return whether the whole part has owners
    template <class Find, class Take>
    bool give(const NearPart& part, const Find& find, const Take& take) const {
        boost::container::small_vector<NearPart, 32> parts{part};
        while (!parts.empty()) {
            const NearPart p = parts.back();
            parts.pop_back();
            const Triangle x = corners(p);
            const Owner owner = find(x);
            if (owner.triangle != Owner::none) {
                take(owner.triangle, p);
                continue;
            }
            if (!owner.may_quarters || !has_quarters(p, x)) return false;
            for (const std::uint32_t q : {0U, 1U, 2U, 3U}) {
                parts.push_back({p.triangle, p.path << 2U | q});
            }
        }
        return true;
    }

private:
    Triangle corners(const NearPart& part) const;
    bool has_quarters(const NearPart& part, const Triangle& corners) const;

    const Surface<3>* whole_;
    double square_;  // of the distance
    double least_;   // length of a part that has quarters
};

inline Point middle_of(const Triangle& x) { return (1.0 / 3) * (x[0] + x[1] + x[2]); }

/// Gives all of a surface to the triangles of another one.
/// \param parts by triangle of that: takes its parts
/// \return how many triangles are left that are farther, in part
std::size_t give_parts(const PartedSurface& whole, const Surface<3>& to,
                       std::vector<std::vector<NearPart>>& parts, const Executor& executor);

}  // namespace nestgrid::engine
