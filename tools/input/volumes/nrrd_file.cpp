// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// NRRD (.nrrd and .nhdr), read by the format's own library as ITK has it. (ITK's NrrdImageIO asks
// that there are as many axes of space as the space has dimensions, and does not look at axis
// maxs.)
//
// Fields of the header and what becomes of them:
//   type, dimension, sizes, encoding, endian, data file, line skip, byte skip    by the library
//   kinds, space directions                 which axes are of space, frames and components
//   space, space dimension, space origin, space directions                       the place
//   spacings, axis mins, axis maxs, centers   the place where there is no space
//   space units, units                      the unit of length, where it is one
//   content                                 the name of the data
//   thicknesses, labels, sample units, measurement frame, old min, old max, number, block size,
//   comments and key/value pairs            without effect
#include <NrrdIO.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <vector>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/volumes/file_samples.hpp"
#include "samples.hpp"

namespace {

using nestgrid::IoError;
using nestgrid::Point;
namespace fs = std::filesystem;

/// The sentence of the NRRD library on the first cause of a failure.
std::string reason_of_failure() {
    char* const message = biffGetDone(NRRD);
    std::string text = message == nullptr ? "" : message;
    std::free(message);
    text.erase(text.find_last_not_of("\n ") + 1);
    text.erase(0, text.find_last_of('\n') + 1);
    // "[nrrd] function_name: reason"
    const std::size_t name = text.find("] ");
    const std::size_t colon = text.find(": ", name == std::string::npos ? 0 : name);
    return colon == std::string::npos ? text : text.substr(colon + 2);
}

using NrrdPointer = std::unique_ptr<Nrrd, Nrrd* (*)(Nrrd*)>;

using StatePointer = std::unique_ptr<NrrdIoState, NrrdIoState* (*)(NrrdIoState*)>;

/// \return how the file was read
StatePointer load(const fs::path& path, Nrrd* nrrd, bool header_only) {
    StatePointer state(nrrdIoStateNew(), nrrdIoStateNix);
    state->skipData = header_only ? 1 : 0;
    // For headers that leave the order of bytes out.
    state->endian = airEndianLittle;
    if (nrrdLoad(nrrd, path.c_str(), state.get()) != 0) {
        throw IoError(path.string() + " is truncated or damaged: " + reason_of_failure());
    }
    return state;
}

/// Where the numbers stand as they do in memory: in this file, behind the empty line that ends the
/// header, or from the beginning of another one.
std::optional<NumbersInFile> mappable_part(const fs::path& path, const NrrdIoState& state,
                                           std::size_t size) {
    const bool skips = state.lineSkip != 0 || state.byteSkip != 0;
    const bool own_order = size == 1 || state.endian == airMyEndian();
    if (state.encoding != nrrdEncodingRaw || skips || !own_order) return {};
    if (state.dataFNFormat != nullptr || state.dataFNArr->len > 1) return {};
    if (state.dataFNArr->len == 1) return NumbersInFile{path.parent_path() / state.dataFN[0], 0};
    std::ifstream file(path, std::ios::binary);
    for (std::string line; std::getline(file, line);) {
        if (!line.empty() && line != "\r") continue;
        const auto begin = static_cast<std::uintmax_t>(file.tellg());
        if (begin % size != 0) return {};
        return NumbersInFile{path, begin};
    }
    return {};
}

/// Reads the numbers that a header describes.
void read_numbers(const fs::path& path, const Nrrd& header, std::span<std::byte> block) {
    std::array<std::size_t, NRRD_DIM_MAX> sizes{};
    for (unsigned a = 0; a < header.dim; ++a) sizes[a] = header.axis[a].size;
    // The library uses the memory that is there where it has the right size.
    const NrrdPointer nrrd(nrrdNew(), nrrdNix);
    nrrdWrap_nva(nrrd.get(), block.data(), header.type, header.dim, sizes.data());
    load(path, nrrd.get(), false);
    if (nrrd->data == block.data()) return;
    std::memcpy(block.data(), nrrd->data, block.size());
    std::free(nrrd->data);
}

std::string type_of(const fs::path& path, const Nrrd& nrrd) {
    switch (nrrd.type) {
        case nrrdTypeChar:
            return "int8";
        case nrrdTypeUChar:
            return "uint8";
        case nrrdTypeShort:
            return "int16";
        case nrrdTypeUShort:
            return "uint16";
        case nrrdTypeInt:
            return "int32";
        case nrrdTypeUInt:
            return "uint32";
        case nrrdTypeLLong:
            return "int64";
        case nrrdTypeULLong:
            return "uint64";
        case nrrdTypeFloat:
            return "float32";
        case nrrdTypeDouble:
            return "float64";
        default:
            break;
    }
    throw IoError(path.string() + " has blocks of bytes for samples, which are not read");
}

bool has_direction(const Nrrd& nrrd, unsigned axis) {
    return nrrd.spaceDim > 0 && std::isfinite(nrrd.axis[axis].spaceDirection[0]);
}

/// Whether an axis goes along the time of a space that has one.
bool along_time_only(const Nrrd& nrrd, unsigned axis) {
    const double* v = nrrd.axis[axis].spaceDirection;
    return nrrd.spaceDim == 4 && has_direction(nrrd, axis) && v[0] == 0 && v[1] == 0 && v[2] == 0;
}

enum class Role { space, frames, list, components };

Role role_of(const Nrrd& nrrd, unsigned axis) {
    const int kind = nrrd.axis[axis].kind;
    if (kind == nrrdKindTime || along_time_only(nrrd, axis)) return Role::frames;
    if (kind == nrrdKindDomain || kind == nrrdKindSpace) return Role::space;
    if (kind == nrrdKindList) return Role::list;
    if (kind != nrrdKindUnknown) return Role::components;
    // The axes of space have directions where there is a space.
    return nrrd.spaceDim == 0 || has_direction(nrrd, axis) ? Role::space : Role::list;
}

/// The axes of space, fastest first. Where there are more than three, those of one sample are left
/// out, then the slowest ones are frames.
std::vector<unsigned> axes_of_space(const Nrrd& nrrd, std::vector<Role>& roles) {
    std::vector<unsigned> axes;
    for (unsigned a = 0; a < nrrd.dim; ++a) {
        if (roles[a] == Role::space) axes.push_back(a);
    }
    while (axes.size() > 3) {
        const auto one =
            std::ranges::find_if(axes, [&](unsigned a) { return nrrd.axis[a].size == 1; });
        const auto left_out = one != axes.end() ? one : axes.end() - 1;
        roles[*left_out] = Role::frames;
        axes.erase(left_out);
    }
    return axes;
}

/// The step from one sample to the next along an axis of an array without a space.
double scalar_spacing(const fs::path& path, const NrrdAxisInfo& axis) {
    if (std::isfinite(axis.spacing)) return axis.spacing;
    if (!std::isfinite(axis.min) || !std::isfinite(axis.max)) return 1;
    const bool nodes = axis.center == nrrdCenterNode;
    if (nodes && axis.size < 2) return 1;
    const double steps = static_cast<double>(axis.size) - (nodes ? 1 : 0);
    if (axis.max == axis.min) {
        throw IoError(path.string() + " has an axis whose minimum is its maximum");
    }
    return (axis.max - axis.min) / steps;
}

/// The step along axis d of the volume; sets the origin where the axis has a minimum.
Point step_along(FileSamples& samples, const Nrrd& nrrd, unsigned axis, std::size_t d) {
    const NrrdAxisInfo& info = nrrd.axis[axis];
    Point step{0, 0, 0};
    if (has_direction(nrrd, axis)) {
        for (std::size_t r = 0; r < std::min(3U, nrrd.spaceDim); ++r) {
            step[r] = info.spaceDirection[r];
        }
        return step;
    }
    step[d] = scalar_spacing(samples.path, info);
    if (nrrd.spaceDim == 0 && std::isfinite(info.min)) {
        // The minimum is that of the first cell, unless the axis is node-centred; the library takes
        // axes that say nothing for cell-centred ones, too.
        const bool nodes = info.center == nrrdCenterNode;
        samples.geometry.origin[d] = info.min + (nodes ? 0 : step[d] / 2);
    }
    return step;
}

void set_place(FileSamples& samples, const Nrrd& nrrd, const std::vector<unsigned>& axes) {
    auto& g = samples.geometry;
    g.samples = {1, 1, 1};
    for (std::size_t d = 0; d < axes.size(); ++d) {
        const std::size_t size = nrrd.axis[axes[d]].size;
        if (size > 1048576) {
            throw IoError(samples.path.string() + " has " + std::to_string(size) +
                          " samples along an axis, which are too many");
        }
        g.samples[d] = static_cast<int>(size);
        const Point step = step_along(samples, nrrd, axes[d], d);
        g.spacing[d] = nestgrid::norm(step);
        if (!(g.spacing[d] > 0) || !std::isfinite(g.spacing[d])) {
            throw IoError(samples.path.string() + " has an axis without a length");
        }
        for (std::size_t r = 0; r < 3; ++r) g.direction[r][d] = step[r] / g.spacing[d];
    }
    for (std::size_t r = 0; r < std::min(3U, nrrd.spaceDim); ++r) {
        if (std::isfinite(nrrd.spaceOrigin[r])) g.origin[r] = nrrd.spaceOrigin[r];
    }
}

std::string space_of(const Nrrd& nrrd) {
    switch (nrrd.space) {
        case nrrdSpaceUnknown:
            return "";
        case nrrdSpaceRightAnteriorSuperior:
        case nrrdSpaceRightAnteriorSuperiorTime:
            return "RAS";
        case nrrdSpaceLeftAnteriorSuperior:
        case nrrdSpaceLeftAnteriorSuperiorTime:
            return "LAS";
        case nrrdSpaceLeftPosteriorSuperior:
        case nrrdSpaceLeftPosteriorSuperiorTime:
            return "LPS";
        default:
            return airEnumStr(nrrdSpace, nrrd.space);
    }
}

/// The unit that all axes of space have; empty where they differ or have none.
std::string length_unit(const Nrrd& nrrd, const std::vector<unsigned>& axes) {
    std::optional<std::string> common;
    const auto agree = [&](const char* unit) {
        const std::string text = unit == nullptr ? "" : unit;
        common = common.value_or(text) == text ? text : "";
    };
    for (unsigned r = 0; r < std::min(3U, nrrd.spaceDim); ++r) agree(nrrd.spaceUnits[r]);
    if (!common.value_or("").empty()) return *common;
    common.reset();
    for (const unsigned a : axes) agree(nrrd.axis[a].units);
    return common.value_or("");
}

/// Adds an axis that is none of space. One of one sample adds nothing.
void add_axis(FileSamples& samples, const Nrrd& nrrd, unsigned axis, Role role,
              std::size_t stride) {
    const std::size_t size = nrrd.axis[axis].size;
    SampleAxis& to = role == Role::components ? samples.components : samples.frames;
    if (size == 1) return;
    if (to.count > 1) {
        throw IoError(samples.path.string() + " has two axes for " +
                      (role == Role::components ? "components" : "frames") +
                      ", of which one is read");
    }
    to = {size, stride};
    if (role != Role::components) {
        const double step = nrrd.axis[axis].spacing;
        if (std::isfinite(step) && step > 0) samples.time_step = step;
        if (std::isfinite(nrrd.axis[axis].min)) samples.first_time = nrrd.axis[axis].min;
    }
    if (role == Role::components)
        samples.component_kind = airEnumStr(nrrdKind, nrrd.axis[axis].kind);
    if (role == Role::list) samples.frames_are_list = true;
}

FileSamples read_nrrd(const fs::path& path, const WantedSamples& /*wanted*/) {
    const std::shared_ptr<Nrrd> nrrd(nrrdNew(), nrrdNuke);
    const StatePointer state = load(path, nrrd.get(), true);
    FileSamples samples{.path = path};
    samples.type = type_of(path, *nrrd);
    samples.in_file = mappable_part(path, *state, bytes_of(samples.type));
    samples.fill = [path, nrrd](std::span<std::byte> block) { read_numbers(path, *nrrd, block); };
    std::vector<Role> roles;
    for (unsigned a = 0; a < nrrd->dim; ++a) roles.push_back(role_of(*nrrd, a));
    const std::vector<unsigned> axes = axes_of_space(*nrrd, roles);
    set_place(samples, *nrrd, axes);
    std::size_t stride = 1;
    std::size_t d = 0;
    for (unsigned a = 0; a < nrrd->dim; ++a) {
        if (roles[a] == Role::space) {
            samples.stride[d++] = stride;
        } else {
            add_axis(samples, *nrrd, a, roles[a], stride);
        }
        stride *= nrrd->axis[a].size;
    }
    for (; d < 3; ++d) samples.stride[d] = stride;
    samples.name = nrrd->content == nullptr ? "" : nrrd->content;
    samples.space = space_of(*nrrd);
    samples.length_unit = length_unit(*nrrd, axes);
    return samples;
}

const RegisteredFormat nrrd_format({.name = "NRRD",
                                    .endings = {".nrrd", ".nhdr"},
                                    .holds = "samples in space, several frames",
                                    .detached = {".nhdr"},
                                    .reads_beside = true,
                                    .read_samples = read_nrrd});

}  // namespace
