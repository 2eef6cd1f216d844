// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "volume.hpp"

namespace nestgrid::python {

namespace {

/// \throw InvalidInput where an array has neither two nor three indices
int dimension_of(const Samples& samples) {
    if (samples.shape.size() == 2 || samples.shape.size() == 3) {
        return static_cast<int>(samples.shape.size());
    }
    throw InvalidInput("an array with " + std::to_string(samples.shape.size()) +
                       " indices is no volume: it needs 2 or 3");
}

/// \throw InvalidInput where a frame differs from the first one
void require_one_layout(const std::vector<Samples>& frames) {
    const Samples& first = frames.front();
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const char* what = nullptr;
        if (frames[i].shape != first.shape)
            what = "another shape";
        else if (frames[i].type != first.type)
            what = "samples of another type";
        else if (frames[i].order != first.order)
            what = "another order in memory";
        if (what == nullptr) continue;
        throw InvalidInput("frame " + std::to_string(i) + " has " + what + " than frame 0");
    }
}

}  // namespace

std::shared_ptr<Source> make_volume(const Samples& samples, const Call& call) {
    return std::make_shared<Source>(make_frames({samples}, {0}, call)[0]);
}

Frames make_frames(const std::vector<Samples>& frames, std::vector<double> times,
                   const Call& call) {
    if (frames.empty()) throw InvalidInput("there are no frames");
    require_one_layout(frames);
    return dimension_of(frames.front()) == 2 ? make_frames_2(frames, std::move(times), call)
                                             : make_frames_3(frames, std::move(times), call);
}

}  // namespace nestgrid::python
