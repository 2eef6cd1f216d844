// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "explored_files.hpp"
#include "explored_samples.hpp"

namespace nestgrid::view {

ExploredField read_explored_volumes(Input& input, const Paths& paths, std::vector<double> times) {
    const auto volumes = std::make_shared<std::vector<Volume>>();
    for (const auto& path : paths) {
        input.path = path;
        volumes->push_back(read_volume(input));
    }
    require_one_layout(*volumes, paths);
    const Volume& first = volumes->front();
    return with_samples(first, [&]<class Sample>(std::span<const Sample> samples) {
        std::vector<std::span<const Sample>> frames;
        for (const Volume& volume : *volumes) {
            const auto* data = static_cast<const Sample*>(volume.image->GetScalarPointer());
            frames.emplace_back(data, samples.size());
        }
        if (frames.size() == 1) return explored_samples(first.geometry, samples, volumes);
        return explored_samples(first.geometry, frames, std::move(times), volumes);
    });
}

}  // namespace nestgrid::view
