// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The bucky ball of docs/paper_table.md and its tetrahedra, for the benchmarks.
#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "bucky_ball.hpp"
#include "contest.hpp"
#include "handwritten_bisection.hpp"

inline constexpr float bucky_isovalue = 0.275F;
inline constexpr std::array<float, 3> bucky_thresholds{0.0F, 0.005F, 0.02F};

using Tetrahedra = nestgrid::LatticeBisection<3>;
using Samples = nestgrid::LatticeField<Tetrahedra, float>;
using Triangle = std::array<float, 9>;

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
    template <class Grid, class Field, class Executor = nestgrid::SequentialExecutor>
    std::size_t draw_soup(const Grid& of, const Field& values, float threshold,
                          nestgrid::TraversalCounts* counts = nullptr,
                          const Executor& executor = {}) {
        return draw_soup_of(of, values, indicator, double{bucky_isovalue}, threshold, counts,
                            executor);
    }
    /// The same of other samples.
    template <class Grid, class Field, class Executor = nestgrid::SequentialExecutor>
    std::size_t draw_soup_of(const Grid& of, const Field& values,
                             const nestgrid::HierarchicalIndicator& by, double isovalue,
                             float threshold, nestgrid::TraversalCounts* counts = nullptr,
                             const Executor& executor = {}) {
        Triangle* to = soup.data();
        const auto put = [&to](const std::array<nestgrid::Point, 3>& x) {
            const auto narrow = [](double number) { return static_cast<float>(number); };
            *to++ = {narrow(x[0][0]), narrow(x[0][1]), narrow(x[0][2]),
                     narrow(x[1][0]), narrow(x[1][1]), narrow(x[1][2]),
                     narrow(x[2][0]), narrow(x[2][1]), narrow(x[2][2])};
        };
        using Sink = nestgrid::SimplexStream<3, decltype(put)>;
        const nestgrid::Threshold<nestgrid::HierarchicalIndicator> criterion{&by, threshold};
        const auto result = nestgrid::extract_isosurfaces(
            of, values, std::span<const double>(&isovalue, 1), std::vector<Sink>{Sink(put)},
            criterion, by, {}, executor);
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
            result.push_back({samples[i], nestgrid::bfloat16_above(indicator.stop(i)),
                              nestgrid::bfloat16_above(indicator.bound(i))});
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
