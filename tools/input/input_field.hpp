// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The field of an input, or the frames of one, on the hierarchy that the program gives it.
#pragma once

#include <array>
#include <optional>

#include "drawing/frame_field.hpp"
#include "input/frame_files.hpp"
#include "options/command_line.hpp"

struct InputField : FrameField {
    std::size_t nodes = 0;          ///< or samples
    std::size_t leaf_elements = 0;  ///< of the finest grid
    /// The values of the first frame, in any order; some may be there more than once.
    std::size_t value_count = 0;
    std::function<double(std::size_t)> value{};
    /// Of the values of all frames, where nodes of elements do not have them all.
    std::optional<std::array<double, 2>> range{};
    std::optional<nestgrid::LatticeGeometry<3>> geometry{};  ///< of volumes
    std::shared_ptr<const std::vector<Volume>>
        volumes{};               ///< the files of volumes; null for others
    std::string name_in_file{};  ///< of the samples of volumes; empty where the file gives none
    std::string length_unit{};   ///< such as mm; empty where it is not known
    std::string space{};         ///< such as RAS; empty where the file does not say
    std::string note{};          ///< a sentence on what of the first file is left out; mostly empty
};

/// Which frames of a file that has several.
enum class WantedFrames { one, all };

/// What becomes of volumes that are planes: fields in the plane, or slabs (thickened()).
enum class Planes { flat, thick };

/// Reads one or more files of one layout, whose frames must be as many as there are times. The
/// samples of a volume or a picture are the corners of bisected boxes. To be called before there
/// are threads.
/// \param more files with later frames
/// \param frames of the only file, where it is none of a hierarchy, which always has all
/// \param times of the frames; empty for those of the file, or 0, 1, 2, ...
/// \throw nestgrid::IoError, nestgrid::InvalidInput as read_volume(), with_hierarchy(),
/// field_named(), append_frames() and times_of_frames()
InputField read_field(Input& input, const Paths& more, const std::vector<double>& times,
                      WantedFrames frames, Planes planes = Planes::flat);

/// The same for hierarchies.
InputField read_hierarchies(const Input& input, const Paths& paths,
                            const std::vector<double>& times);
