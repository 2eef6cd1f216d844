// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "explored_files.hpp"

#include <nestgrid/error.hpp>

#include "explored_samples.hpp"

namespace nestgrid::view {

ExploredField read_explored(Input& input, const Paths& more, const std::vector<double>& times) {
    const std::filesystem::path path = input.path;
    InputField read = read_field(input, more, times);
    return std::visit(
        [&](const auto& first) {
            if (first->facts().dimension != 3) {
                throw InvalidInput("'" + path.string() +
                                   "' has 2 dimensions; only fields in space can be explored");
            }
            ExploredField f;
            static_cast<FrameField&>(f) = read;
            f.box = read.geometry ? box_of(*read.geometry) : box_of(*first);
            f.histogram = histogram_of(read.value_count, read.value);
            f.title = path.filename().string();
            if (!more.empty()) f.title += " … " + more.back().filename().string();
            return f;
        },
        read.frames.front());
}

}  // namespace nestgrid::view
