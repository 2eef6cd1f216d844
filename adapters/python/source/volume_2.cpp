// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "volume.hpp"

namespace nestgrid::python {

std::unique_ptr<Source> make_volume_2(const Samples& samples, const Call& call) {
    return with_sample_type(samples.type, [&]<class Sample>(Sample) {
        return std::unique_ptr<Source>(std::make_unique<Volume<2, Sample>>(samples, call));
    });
}

}  // namespace nestgrid::python
