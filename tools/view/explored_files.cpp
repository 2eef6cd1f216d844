// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "explored_files.hpp"

#include <nestgrid/error.hpp>

#include "explored_samples.hpp"

namespace nestgrid::view {

namespace {

/// The name of a file without what tells its format, such as .nii.gz.
std::string stem_of(const std::filesystem::path& path) {
    const std::filesystem::path stem = path.stem();
    return (path.extension() == ".gz" ? stem.stem() : stem).string();
}

void describe_volumes(ExploredField& field, const std::vector<Volume>& volumes) {
    with_samples(volumes.front(), [&]<class Sample>(std::span<const Sample> first) {
        std::vector<std::span<const Sample>> frames;
        for (const Volume& volume : volumes) {
            frames.emplace_back(static_cast<const Sample*>(volume.image->GetScalarPointer()),
                                first.size());
        }
        describe_samples(field, frames);
    });
}

}  // namespace

ExploredField read_explored(Input& input, const Paths& more, const std::vector<double>& times) {
    const std::filesystem::path path = input.path;
    InputField read = read_field(input, more, times, WantedFrames::all, Planes::thick);
    if (read.dimension() != 3) {
        throw InvalidInput("'" + path.string() +
                           "' has 2 dimensions; only fields in space can be explored");
    }
    ExploredField f;
    static_cast<FrameField&>(f) = read;
    f.box = read.geometry ? box_of(*read.geometry)
                          : read.first().visit([](const auto& first) { return box_of(first); });
    if (read.volumes) {
        describe_volumes(f, *read.volumes);
        f.name = !input.array.empty()         ? input.array
                 : !read.name_in_file.empty() ? read.name_in_file
                                              : stem_of(path);
    } else {
        describe_values(f, read.value_count, read.value);
        f.range = read.range;
    }
    f.length_unit = read.length_unit;
    f.note = read.note;
    f.title = path.filename().string();
    if (!more.empty()) f.title += " … " + more.back().filename().string();
    return f;
}

}  // namespace nestgrid::view
