// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lattices of several sizes, padded and not, in other positions.
#pragma once

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>

#include "options.hpp"
#include "sample_fields.hpp"

namespace recording {

using namespace nestgrid_test;

template <int dim>
struct NamedLattice {
    const char* name;
    LatticeGeometry<dim> geometry;
};

inline std::vector<NamedLattice<3>> lattices(std::integral_constant<int, 3>) {
    const double c = 0.6;
    const double s = 0.8;
    return {
        {"cube", {.samples = {17, 17, 17}}},
        {"padded", {.samples = {18, 21, 11}, .spacing = {0.5, 1, 1.5}, .origin = {-3, 0.25, 7}}},
        {"blocks",
         {.samples = {17, 9, 25},
          .direction = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
          .block_levels = 2}},
        {"turned",
         {.samples = {14, 20, 33},
          .spacing = {1, 2, 0.3},
          .origin = {1, 2, 3},
          .direction = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}}},
        {"flat", {.samples = {36, 5, 3}}},
        {"one_level", {.samples = {7, 6, 9}, .block_levels = 0}}};
}
inline std::vector<NamedLattice<2>> lattices(std::integral_constant<int, 2>) {
    return {{"square", {.samples = {33, 33}}},
            {"padded", {.samples = {37, 50}, .spacing = {0.5, 1.5, 1}, .origin = {-3, 0.25, 7}}},
            {"blocks",
             {.samples = {49, 17},
              .direction = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
              .block_levels = 3}},
            {"turned",
             {.samples = {23, 42}, .direction = {{{0.6, -0.8, 0}, {0, 0, 1}, {0.8, 0.6, 0}}}}},
            {"one_level", {.samples = {9, 12}, .block_levels = 0}}};
}

/// Samples of all fields.
template <class Sample, int dim>
class Sampled {
public:
    explicit Sampled(const LatticeGeometry<dim>& geometry) {
        Samples n{geometry.samples[0], geometry.samples[1], 2};
        if constexpr (dim == 3) n[2] = geometry.samples[2];
        for (SampledField& data : sampled_fields(n)) {
            if constexpr (dim == 2) data.values.resize(data.values.size() / 2);
            const bool integers = std::is_integral_v<Sample>;
            const double scale = integers ? 200 / (2 * data.range) : 1;
            const double offset = integers ? 100 : 0;
            auto& to = values_.emplace_back();
            const bool generic = data.name != "integer noise" && data.name != "plateaus";
            for (const float v : data.values) {
                double x = scale * static_cast<double>(v) + offset;
                // Nothing that a float could hold.
                if (generic && std::is_same_v<Sample, double>) {
                    x += 1e-9 * static_cast<double>(to.size() % 97);
                }
                to.push_back(static_cast<Sample>(x));
            }
            names_.push_back(data.name);
            isovalues_.push_back(integers ? std::round(scale * data.isovalue + offset)
                                          : data.isovalue);
            ranges_.push_back(scale * data.range);
        }
    }
    template <class Grid>
    std::vector<Subject<LatticeField<Grid, Sample>>> on(const Grid& grid) const {
        std::vector<Subject<LatticeField<Grid, Sample>>> subjects;
        for (std::size_t i = 0; i < names_.size(); ++i) {
            subjects.push_back(
                {names_[i], LatticeField<Grid, Sample>(grid, std::span<const Sample>(values_[i])),
                 isovalues_[i], ranges_[i]});
        }
        return subjects;
    }

private:
    std::vector<std::string> names_;
    std::vector<std::vector<Sample>> values_;
    std::vector<double> isovalues_;
    std::vector<double> ranges_;
};

template <class Grid, class Sample>
void record_lattices(const std::string& name) {
    constexpr int dim = Grid::dimension;
    int number = 0;
    for (const auto& lattice : lattices(std::integral_constant<int, dim>())) {
        const Grid grid(lattice.geometry);
        const Sampled<Sample, dim> samples(lattice.geometry);
        const auto subjects = samples.on(grid);
        const std::string here = name + "/" + lattice.name;
        if (number < 2) {
            record_all(here, grid, subjects);
        } else {
            record_preroll(here, grid, subjects);
            record_options(here, grid, subjects, number == 2 ? "" : "zero small large");
            if (number == 2) record_threads(here, grid, subjects);
        }
        ++number;
    }
}

}  // namespace recording
