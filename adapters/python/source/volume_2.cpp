// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "volume.hpp"

namespace nestgrid::python {

Frames make_frames_2(const std::vector<Samples>& frames, std::vector<double> times,
                     const Call& call) {
    return with_sample_type(frames.front().type, [&]<class Sample>(Sample) {
        return lattice_frames<2, Sample>(frames, std::move(times), call);
    });
}

}  // namespace nestgrid::python
