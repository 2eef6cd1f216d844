// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nestgrid/algorithms/frames.hpp>

/// A field, or several frames of one on one grid, which keep alive what they are made of.
struct FrameField {
    std::string name = "value";
    nestgrid::Frames frames{};  ///< at least one

    const nestgrid::FieldOnGrid& first() const { return frames[0]->field(); }
    int dimension() const { return first().dimension(); }
    const std::vector<double>& times() const { return frames.times(); }
};
