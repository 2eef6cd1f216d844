// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The volume that is chosen among the samples of a file: one frame, one number of each sample.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "file_samples.hpp"

class Parcel;

/// Which of the samples of a file are wanted.
struct VolumeChoice {
    std::string array{};                      ///< of a .vti file; empty for the active one
    std::optional<std::int64_t> frame{};      ///< from 0; the first where it is not given
    std::optional<std::int64_t> component{};  ///< of each sample, from 0
    bool magnitude = false;                   ///< the norm of each sample instead
};

/// A volume without its samples; in a parcel it stands before them.
struct VolumeDescription {
    std::array<char, 8> type{};
    std::array<char, 64> name{};
    std::array<char, 16> length_unit{};
    std::array<char, 32> space{};
    std::array<char, 256> note{};
    nestgrid::LatticeGeometry<3> geometry{};

    std::size_t sample_count() const;
};

/// Appends a description and the chosen samples, in the type of the file unless they are computed:
/// then in float32, or in float64 where that would lose digits.
/// \throw nestgrid::InvalidInput where the choice is missing or does not fit the file, and for
///        samples that are not finite or not on at least 2 x 2 x 2 places
void put_chosen(FileSamples& samples, const VolumeChoice& choice, Parcel& parcel);
