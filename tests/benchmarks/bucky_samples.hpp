// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The bucky ball of docs/paper_table.md and its tetrahedra, for the benchmarks.
#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>

#include "bucky_ball.hpp"
#include "contest.hpp"
#include "handwritten_bisection.hpp"

inline constexpr float bucky_isovalue = 0.275F;
inline constexpr std::array<float, 3> bucky_thresholds{0.0F, 0.005F, 0.02F};

using Tetrahedra = nestgrid::LatticeBisection<3>;
using Samples = nestgrid::LatticeField<Tetrahedra, float>;
using Triangle = std::array<float, 9>;

/// Writes triangles behind each other.
class TriangleWriter final : public nestgrid::SimplexSink<3> {
public:
    /// \param to where the next one goes; moved on
    explicit TriangleWriter(Triangle*& to) : to_{&to} {}

    void take(const nestgrid::Surface<3>& part) override {
        Triangle* to = *to_;
        for (const auto& corners : part.simplices) {
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const nestgrid::Point& x = part.vertices[corners[i]];
                for (std::size_t d = 0; d < 3; ++d) (*to)[3 * i + d] = static_cast<float>(x[d]);
            }
            ++to;
        }
        *to_ = to;
    }
    bool takes_batches() const override { return true; }
    void take_batch(const nestgrid::SimplexBatch& batch) override {
        Triangle* to = *to_;
        for (const auto& corners : batch.simplices) {
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const double* const x = batch.at(corners[i]);
                for (std::size_t d = 0; d < 3; ++d) (*to)[3 * i + d] = static_cast<float>(x[d]);
            }
            ++to;
        }
        *to_ = to;
    }

private:
    Triangle** to_;
};

/// The samples of a cube, and the triangles drawn from them.
struct BuckySamples {
    std::vector<float> samples;
    Tetrahedra grid;
    Samples field{grid, std::span<const float>(samples)};
    nestgrid::HierarchicalIndicator indicator{grid, field};
    std::vector<Triangle> soup;

    /// \param n along each direction
    explicit BuckySamples(int n)
        : samples{bucky_ball(n)},
          grid{{.samples = {n, n, n}}},
          soup(40 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n) + 1000) {}
    BuckySamples(const BuckySamples&) = delete;  // the field refers to the rest
    BuckySamples& operator=(const BuckySamples&) = delete;

    /// Writes the triangles of any grid and field into `soup`.
    /// \return how many
    template <class Grid, class Field>
    std::size_t draw_soup(const Grid& of, const Field& values, float threshold,
                          nestgrid::TraversalCounts* counts = nullptr,
                          const nestgrid::Executor& executor = nestgrid::SequentialExecutor{}) {
        return draw_soup_of(of, values, indicator, double{bucky_isovalue}, threshold, counts,
                            executor);
    }
    /// The same of other samples.
    template <class Grid, class Field>
    std::size_t draw_soup_of(const Grid& of, const Field& values,
                             const nestgrid::HierarchicalIndicator& by, double isovalue,
                             float threshold, nestgrid::TraversalCounts* counts = nullptr,
                             const nestgrid::Executor& executor = nestgrid::SequentialExecutor{}) {
        return draw_hierarchy(nestgrid::erase(of, values), by, isovalue, threshold, counts,
                              executor);
    }
    template <class Real>
    std::size_t draw_hierarchy(
        const nestgrid::Hierarchy<Real>& of, const nestgrid::HierarchicalIndicator& by,
        double isovalue, float threshold, nestgrid::TraversalCounts* counts = nullptr,
        const nestgrid::Executor& executor = nestgrid::SequentialExecutor{}) {
        Triangle* to = soup.data();
        const nestgrid::Threshold criterion{&by, threshold};
        const auto result = nestgrid::extract_isosurfaces<3>(
            of, std::span<const double>(&isovalue, 1), std::vector{TriangleWriter(to)},
            under(criterion, by), {}, {executor});
        if (counts != nullptr) *counts = result.front().counts;
        return static_cast<std::size_t>(to - soup.data());
    }
};

/// The same with what a recursion by hand for n samples along each direction takes.
template <int n>
struct Bucky : BuckySamples {
    using Handwritten = HandwrittenBisection<static_cast<std::uint32_t>(n)>;

    std::vector<typename Handwritten::Node> nodes = handwritten_nodes();

    Bucky() : BuckySamples(n) {}

    std::vector<typename Handwritten::Node> handwritten_nodes() const {
        std::vector<typename Handwritten::Node> result;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            result.push_back(
                {samples[i],
                 nestgrid::detail::bfloat16_above(static_cast<float>(indicator.stop(i))),
                 nestgrid::detail::bfloat16_above(indicator.bound(i))});
        }
        return result;
    }

    Handwritten handwritten(float threshold) {
        Handwritten recursion(nodes.data(), bucky_isovalue, threshold, soup.data());
        recursion.run();
        return recursion;
    }
};

inline std::string at_threshold(const std::string& name, float threshold) {
    char text[32];
    std::snprintf(text, sizeof text, "_at_%g", static_cast<double>(threshold));
    return name + text;
}

inline bool is_quick(int argc, char** argv) {
    return argc > 1 && std::strcmp(argv[1], "--quick") == 0;
}

/// Calls function(std::integral_constant<int, n>, rounds): 129 samples along each direction, or 33
/// and three rounds with --quick.
template <class Function>
void at_either_size(int argc, char** argv, std::size_t rounds, Function&& function) {
    if (is_quick(argc, argv)) {
        function(std::integral_constant<int, 33>{}, std::size_t{3});
    } else {
        function(std::integral_constant<int, 129>{}, rounds);
    }
}
