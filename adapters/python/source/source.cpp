// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "source.hpp"

namespace nestgrid::python {

Prerolls& PrerolledSource::prerolls() const {
    std::call_once(once_, [&] { prerolls_ = std::make_unique<Prerolls>(hierarchy()); });
    return *prerolls_;
}

ChosenIndicator PrerolledSource::choose(const std::string& name, double blend,
                                        const Call& call) const {
    if (const auto error = node_error(name)) {
        const auto numbers = prerolls().of_nodes(*error, blend, call);
        return {numbers, numbers, numbers.get()};
    }
    const auto swept = prerolls().swept(name, blend, call);
    const auto bounds = prerolls().offsets(1, call);
    return {swept, bounds, bounds.get()};
}

std::array<double, 2> PrerolledSource::range(const Call& call) const {
    const auto offsets = prerolls().offsets(1, call);
    return {offsets->least(), offsets->greatest()};
}

}  // namespace nestgrid::python
