// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/print.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drawing/first_isovalue.hpp"

namespace {

/// Appends the facts about a lattice of samples.
template <int dimension>
void report_lattice(const nestgrid::LatticeGeometry<dimension>& geometry, Report& report) {
    const nestgrid::LatticeBisection<dimension> grid(geometry);
    constexpr auto axes = std::array{"axis_x", "axis_y", "axis_z"};
    const auto levels = static_cast<std::uint64_t>(grid.block_levels());
    report.add("spacing", std::vector<double>(geometry.spacing.begin(), geometry.spacing.end()));
    report.add("origin", std::vector<double>(geometry.origin.begin(), geometry.origin.end()));
    for (std::size_t d = 0; d < dimension; ++d) {
        std::vector<double> axis;
        for (std::size_t r = 0; r < dimension; ++r) axis.push_back(geometry.direction[r][d]);
        report.add(axes[d], axis);
    }
    report.add("padded_nodes", std::uint64_t{grid.node_count()});
    report.add("block_cells", std::uint64_t{1} << levels);
    report.add("coarse_elements", std::uint64_t{grid.coarse_count()});
    report.add("levels", dimension * levels + 1);
}

/// So many digits, at least six, that four tell values between these apart.
int digits_between(double least, double greatest) {
    const double size = std::max(std::abs(least), std::abs(greatest));
    if (!(greatest > least) || !std::isfinite(greatest - least)) return 6;
    return std::clamp(4 + static_cast<int>(std::ceil(std::log10(size / (greatest - least)))), 6,
                      17);
}

Row row_of(const FieldInfo& f, const HierarchyInfo& info) {
    Row row;
    row.add("field", f.name).add("least_value", f.least).add("greatest_value", f.greatest);
    if (!f.step) return row;
    if (*f.step == 0) row.add("encoded", "exactly");
    if (*f.step > 0) row.add("encoded_within", *f.step / 2);
    const auto values = static_cast<double>(info.nodes * info.times.size());
    return row.add("bytes_per_value", static_cast<double>(f.bytes) / values);
}

}  // namespace

void report_range(std::pair<double, double> range, Report& report) {
    const int digits = digits_between(range.first, range.second);
    report.add("least_value", Digits{range.first, digits});
    report.add("greatest_value", Digits{range.second, digits});
}

void report_field(const std::string& name, const std::string& unit, Report& report) {
    report.add("field", name);
    if (!unit.empty()) report.add("length_unit", unit);
}

void report_info(const HierarchyInfo& info, Report& report) {
    report.add("family", info.family);
    report.add("dimension", static_cast<std::uint64_t>(info.dimension));
    report.add("coarse_elements", std::uint64_t{info.coarse_elements});
    report.add("leaf_elements", std::uint64_t{info.leaves});
    for (const auto& [shape, count] : info.shapes) {
        report.add("leaf_" + std::string(nestgrid::topology(shape).name), std::uint64_t{count});
    }
    report.add("nodes", std::uint64_t{info.nodes});
    report.add("hanging_nodes", std::uint64_t{info.hanging});
    report.add("levels", static_cast<std::uint64_t>(info.levels));
    report.add("measure", info.measure);
    report.add("bytes_per_leaf",
               static_cast<double>(info.bytes) / static_cast<double>(info.leaves));
    if (info.times != std::vector<double>{0}) {
        report.add("frames", std::uint64_t{info.times.size()});
        report.add("times", info.times);
    }
    for (const FieldInfo& f : info.fields) report.add_row("fields", row_of(f, info));
}

void report_info(const Volume& volume, Report& report) {
    const auto& samples = volume.geometry.samples;
    const std::size_t axes = volume.is_plane() ? 2 : 3;
    report_field(volume.name.empty() ? "value" : volume.name, volume.length_unit, report);
    if (!volume.space.empty()) {
        const std::string& unit = volume.length_unit;
        report.add("space", volume.space + (unit.empty() ? "" : " (" + unit + ")"));
    }
    report.add("samples", std::vector<double>(samples.begin(),
                                              samples.begin() + static_cast<std::ptrdiff_t>(axes)));
    report.add("type", volume.type);
    if (volume.missing > 0) report.add("missing", std::uint64_t{volume.missing});
    report_range(with_samples(volume,
                              [](auto values) {
                                  const ValueSample sample = value_sample_of(
                                      values.size(), [&](std::size_t i) { return values[i]; });
                                  return std::pair(sample.least, sample.greatest);
                              }),
                 report);
    report.add("nodes", std::uint64_t{volume.sample_count()});
    report.add("leaf_elements", std::uint64_t{leaf_count(volume.geometry)});
    if (volume.is_plane()) {
        report_lattice<2>(plane_of(volume.geometry), report);
    } else {
        report_lattice<3>(volume.geometry, report);
    }
    if (!volume.note.empty()) report.say(volume.note);
}
