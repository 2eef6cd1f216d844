// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normals of the function of a split, for the boxes of normals around its new nodes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <indicators/corner_axes.hpp>
#include <indicators/gradient_lanes.hpp>
#include <indicators/vector_box.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid::engine {

/// The normals of several elements at once.
/// \tparam count at least as many as any child of a split has
template <std::size_t count>
class NormalLanes {
public:
    explicit NormalLanes(double tau) : tau_{tau} {}

    /// Adds the normals of the children of a split to the boxes of its new nodes.
    void add(const MeasuredSplit& split, std::span<const std::size_t> nodes,
             std::vector<VectorBox>& boxes) {
        const std::size_t corners = split.corner_count();
        const double h = split.diameter();
        const std::vector<Child>& children = split.rule.children;
        for (std::size_t first = 0; first < children.size();) {
            std::size_t end = first;
            std::size_t lanes = 0;
            for (; end < children.size(); ++end) {
                const std::size_t more = gradient_count(children[end].shape);
                if (lanes + more > count) break;
                put(split, children[end], lanes);
                lanes += more;
            }
            gradients_.solve(topology(split.rule.parent).dimension, h);
            for (std::size_t lane = 0, k = first; k < end; ++k) {
                if (children[k].shape == Shape::pyramid) average_apex(lane);
                lane += gradient_count(children[k].shape);
            }
            put_normals();
            for (std::size_t lane = 0; first < end; ++first) {
                const VectorBox box = box_of(lane, gradient_count(children[first].shape));
                lane += gradient_count(children[first].shape);
                for (std::size_t k = 0; k < topology(children[first].shape).corners; ++k) {
                    const std::size_t node = children[first].corner[k];
                    if (node >= corners) boxes[nodes[node]].add(box);
                }
            }
        }
    }

private:
    /// Puts the gradients of a child into the lanes from `lane` on.
    void put(const MeasuredSplit& split, const Child& child, std::size_t lane) {
        const auto& table = corner_axes_of[static_cast<std::size_t>(child.shape)];
        for (std::size_t i = 0; i < gradient_count(child.shape); ++i, ++lane) {
            for (std::size_t d = 0; d < topology(child.shape).dimension; ++d) {
                const std::size_t from = child.corner[table[i][d][0]];
                const std::size_t to = child.corner[table[i][d][1]];
                gradients_.set(
                    lane, d, split.positions[to] - split.positions[from],
                    split.values[to * split.components] - split.values[from * split.components]);
            }
        }
    }
    /// Puts the mean of the gradients at the apex of a pyramid in the place of each of them.
    void average_apex(std::size_t lane) {
        for (auto& g : gradients_.result()) {
            const double mean = (g[lane + 4] + g[lane + 5] + g[lane + 6] + g[lane + 7]) / 4;
            for (std::size_t i = 4; i < 8; ++i) g[lane + i] = mean;
        }
    }
    void put_normals() {
        const auto& [x, y, z] = gradients_.result();
        typename GradientLanes<count>::Lanes by;
        for (std::size_t l = 0; l < count; ++l) {
            const double square = x[l] * x[l] + y[l] * y[l] + z[l] * z[l] + tau_ * tau_;
            by[l] = 1 / std::sqrt(std::max(square, std::numeric_limits<double>::min()));
        }
        for (std::size_t d = 0; d < 3; ++d) {
            for (std::size_t l = 0; l < count; ++l) {
                normals_[d][l] = static_cast<float>(gradients_.result()[d][l] * by[l]);
            }
        }
    }
    VectorBox box_of(std::size_t lane, std::size_t lanes) const {
        VectorBox box;
        for (const std::size_t end = lane + lanes; lane < end; ++lane) {
            box.add({normals_[0][lane], normals_[1][lane], normals_[2][lane]});
        }
        return box;
    }

    double tau_;
    GradientLanes<count> gradients_;
    std::array<std::array<float, count>, 3> normals_{};  // by coordinate
};

}  // namespace nestgrid::engine
