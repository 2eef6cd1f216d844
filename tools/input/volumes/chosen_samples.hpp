// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The volume that is chosen among the samples of a file: one frame, one number of each sample.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "input/volumes/file_samples.hpp"

class Parcel;

/// Which of the samples of a file are wanted.
struct VolumeChoice {
    std::string array{};                      ///< of a .vti file; empty for the active one
    std::optional<std::int64_t> frame{};      ///< from 0; the first where it is not given
    bool all_frames = false;                  ///< instead
    std::optional<std::int64_t> component{};  ///< of each sample, from 0
    bool magnitude = false;                   ///< the norm of each sample instead
    std::optional<double> label{};            ///< samples are 1 where they have this value, else 0
    std::string space{};            ///< to turn places to, ras or lps; empty for that of the file
    std::vector<double> missing{};  ///< values that stand for none, beside what is no number
    std::filesystem::path mask{};   ///< samples that are not 0 there are kept; empty for all
};

/// The plane of samples of which there is one along the third axis.
nestgrid::LatticeGeometry<2> plane_of(const nestgrid::LatticeGeometry<3>& geometry);

/// A volume without its samples; in a parcel it stands before them.
struct VolumeDescription {
    std::array<char, 8> type{};
    std::array<char, 64> name{};
    std::array<char, 16> length_unit{};
    std::array<char, 32> space{};
    std::array<char, 256> note{};
    nestgrid::LatticeGeometry<3> geometry{};
    std::size_t frames = 1;  ///< that are chosen
    double first_time = 0;
    double time_step = 1;
    std::size_t missing = 0;  ///< samples of all frames that have no value, and are NaN
    /// Where the samples stand in a file, whose path is in the parcel in their place; -1: nowhere.
    std::int64_t mapped_from = -1;

    /// The number of samples of one frame.
    std::size_t sample_count() const;
};

/// Appends a description and the chosen samples, frame after frame, in the type of the file unless
/// they are computed: then in float32, or in float64 where that would lose digits. Those of a
/// plane, whose third axis has one sample, are always of these types. Samples without a value are
/// not a number (NaN). What stands in a file as it does in memory is not copied.
/// \param mask samples that are kept are not 0 there; null for all
/// \throw nestgrid::InvalidInput where the choice is missing or does not fit the file, for a space
///        that places cannot be turned to, for a mask on other places, and for samples that are
///        infinite, all without a value, or not on at least 2 x 2 places
void put_chosen(FileSamples& samples, const VolumeChoice& choice, FileSamples* mask,
                Parcel& parcel);
