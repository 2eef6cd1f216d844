// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input_field.hpp"

#include <nestgrid/adapters/bisection.hpp>

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
    set_frames(field, grid, std::move(fields), std::move(times), std::move(memory));
    field.nodes = grid->sample_count();
    field.region = [grid](const InputField::Inside& inside) {
        return nestgrid::Region(*grid, inside);
    };
    field.value_count = each.front().size();
    field.value = [samples = each.front()](std::size_t i) {
        return static_cast<double>(samples[i]);
    };
}

InputField read_volumes(Input& input, const Paths& paths, const std::vector<double>& times) {
    InputField field;
    const auto volumes = std::make_shared<std::vector<Volume>>();
    for (const auto& path : paths) {
        input.path = path;
        volumes->push_back(read_volume(input));
    }
    require_one_layout(*volumes, paths);
    const Volume& first = volumes->front();
    with_samples(first, [&]<class Sample>(std::span<const Sample> samples) {
        std::vector<std::span<const Sample>> each;
        for (const Volume& volume : *volumes) {
            const auto* data = static_cast<const Sample*>(volume.image->GetScalarPointer());
            each.emplace_back(data, samples.size());
        }
        set_samples(field, first.geometry, each, times, volumes);
    });
    field.leaf_elements = leaf_count(nestgrid::LatticeBisection<3>(first.geometry));
    field.geometry = first.geometry;
    field.volumes = volumes;
    field.name_in_file = first.name;
    field.length_unit = first.length_unit;
    field.space = first.space;
    field.note = first.note;
    if (!first.name.empty()) field.name = first.name;
    return field;
}

InputField read_rasters(const Input& input, const Paths& paths, const std::vector<double>& times) {
    InputField field;
    const auto rasters = std::make_shared<std::vector<Raster>>();
    for (const auto& path : paths) rasters->push_back(read_raster(path, input.read_limit));
    require_one_layout(*rasters, paths);
    std::vector<std::span<const float>> each;
    for (const Raster& raster : *rasters) each.push_back(raster.samples);
    set_samples(field, rasters->front().geometry, each, times, rasters);
    const auto& samples = rasters->front().geometry.samples;
    field.leaf_elements =
        2 * static_cast<std::size_t>(samples[0] - 1) * static_cast<std::size_t>(samples[1] - 1);
    return field;
}

}  // namespace

InputField read_field(Input& input, const Paths& more, const std::vector<double>& times) {
    check(input);
    Paths paths{input.path};
    paths.insert(paths.end(), more.begin(), more.end());
    if (is_hierarchy(input.path)) return read_hierarchies(input, paths, times);
    const std::vector<double> all = times_of_frames(times, times_of_files(paths.size()));
    const bool pictures = is_raster(input.path);
    return pictures ? read_rasters(input, paths, all) : read_volumes(input, paths, all);
}
