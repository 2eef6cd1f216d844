// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/input_field.hpp"

#include <algorithm>

#include <nestgrid/adapters/bisection.hpp>

#include "formats.hpp"

namespace {

/// Sets the frames of samples on a lattice.
/// \param each the samples of each frame, of one type
template <int dimension, class Sample>
void set_samples(InputField& field, const nestgrid::LatticeGeometry<dimension>& geometry,
                 const std::vector<std::span<const Sample>>& each, std::vector<double> times,
                 std::shared_ptr<const void> memory) {
    using Grid = nestgrid::LatticeBisection<dimension>;
    const auto grid = std::make_shared<const Grid>(geometry);
    std::vector<nestgrid::LatticeField<Grid, Sample>> fields;
    for (const auto& samples : each) fields.emplace_back(*grid, samples);
    field.frames =
        nestgrid::shared_frames(grid, std::move(fields), std::move(times), std::move(memory));
    field.nodes = grid->sample_count();
    field.value_count = each.front().size();
    field.value = [samples = each.front()](std::size_t i) {
        return static_cast<double>(samples[i]);
    };
}

/// \param given the times of the option --times
InputField volume_field(Input& input, const Paths& paths, const std::vector<double>& given,
                        WantedFrames frames, Planes planes) {
    InputField field;
    const auto volumes = std::make_shared<std::vector<Volume>>();
    const bool one = paths.size() == 1;
    for (const auto& path : paths) {
        input.path = path;
        for (Volume& volume : read_volumes(input, one && frames == WantedFrames::all)) {
            const bool thickens = planes == Planes::thick && volume.is_plane();
            volumes->push_back(thickens ? thickened(volume) : std::move(volume));
        }
    }
    std::vector<double> times = times_of_files(paths.size());
    if (one) {
        times.clear();
        for (const Volume& volume : *volumes) times.push_back(volume.time);
    } else {
        require_one_layout(*volumes, paths);
    }
    times = times_of_frames(given, times);
    const Volume& first = volumes->front();
    // The samples of all files, of one type.
    const auto all = [&]<class Sample>(std::span<const Sample> samples) {
        std::vector<std::span<const Sample>> each;
        for (const Volume& volume : *volumes) {
            const auto* data = static_cast<const Sample*>(volume.image->GetScalarPointer());
            each.emplace_back(data, samples.size());
        }
        return each;
    };
    if (first.is_plane()) {
        const nestgrid::LatticeGeometry<2> plane = plane_of(first.geometry);
        const auto set = [&](auto samples) { set_samples(field, plane, samples, times, volumes); };
        const void* const data = first.image->GetScalarPointer();
        const std::size_t count = first.sample_count();
        if (first.type == "float32") set(all(std::span(static_cast<const float*>(data), count)));
        if (first.type == "float64") set(all(std::span(static_cast<const double*>(data), count)));
    } else {
        with_samples(first, [&]<class Sample>(std::span<const Sample> samples) {
            set_samples(field, first.geometry, all(samples), times, volumes);
        });
        field.geometry = first.geometry;
        field.volumes = volumes;
    }
    const bool any_missing =
        std::ranges::any_of(*volumes, [](const Volume& volume) { return volume.missing > 0; });
    if (any_missing) field.frames = field.frames.without_missing();
    field.leaf_elements = leaf_count(first.geometry);
    field.name_in_file = first.name;
    field.length_unit = first.length_unit;
    field.space = first.space;
    field.note = first.note;
    if (!first.name.empty()) field.name = first.name;
    return field;
}

}  // namespace

InputField read_field(Input& input, const Paths& more, const std::vector<double>& times,
                      WantedFrames frames, Planes planes) {
    open(input);
    Paths paths{input.path};
    paths.insert(paths.end(), more.begin(), more.end());
    const Format* const format = format_of(input.path);
    if (format != nullptr && format->read_field != nullptr) {
        return format->read_field(input, paths, times);
    }
    if (is_hierarchy(input.path)) return read_hierarchies(input, paths, times);
    return volume_field(input, paths, times, frames, planes);
}
