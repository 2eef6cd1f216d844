// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// DICOM: a series of slices, given by its folder, its DICOMDIR or one of its files; read by GDCM,
// through ITK, which applies slope and intercept of each slice.
//
// What becomes of the headers:
//   image position and orientation, pixel spacing   by ITK, in LPS and mm; slices lie where their
//                                                   own positions say, so that a tilted gantry
//                                                   shears the volume
//   several slices in one place                     frames, by their instance numbers
//   series description                              the name of the data
//   windows, palettes, overlays, patients           without effect
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/volumes/file_samples.hpp"
#include "samples.hpp"
#include "suggestion.hpp"

namespace {

using nestgrid::cross;
using nestgrid::dot;
using nestgrid::InvalidInput;
using nestgrid::IoError;
using nestgrid::norm;
using nestgrid::Point;
using nestgrid::operator-;
using nestgrid::operator*;
namespace fs = std::filesystem;

/// Whether a file begins as one of DICOM does.
bool has_mark(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 132> begin{};
    file.read(begin.data(), begin.size());
    return file && std::string(begin.data() + 128, 4) == "DICM";
}

bool is_dicom(const fs::path& path) {
    std::error_code none;
    if (fs::is_regular_file(path, none)) return has_mark(path);
    if (!fs::is_directory(path, none)) return false;
    std::size_t looked_at = 0;
    constexpr std::size_t most = 1000;
    for (fs::recursive_directory_iterator at(path, none), end; !none && at != end;
         at.increment(none)) {
        if (++looked_at > most) break;
        if (at->is_regular_file(none) && has_mark(at->path())) return true;
    }
    return false;
}

std::string tag_of(itk::GDCMImageIO* io, const char* tag) {
    std::string value;
    if (!io->GetValueFromTag(tag, value)) return "";
    value.erase(std::find(value.begin(), value.end(), '\0'), value.end());
    const std::size_t begin = value.find_first_not_of(' ');
    if (begin == std::string::npos) return "";
    return value.substr(begin, value.find_last_not_of(' ') + 1 - begin);
}

/// A file of a series, of one slice or more.
struct Slice {
    itk::GDCMImageIO::Pointer io;
    fs::path path;
    Point place{};  ///< of its first sample
    long instance = 0;
};

Slice open_slice(const fs::path& path) {
    Slice slice{itk::GDCMImageIO::New(), path};
    try {
        slice.io->SetFileName(path.string());
        slice.io->ReadImageInformation();
    } catch (const itk::ExceptionObject&) {
        throw IoError("'" + path.string() + "' holds no DICOM image that can be read");
    }
    for (std::size_t d = 0; d < 3; ++d) {
        slice.place[d] = slice.io->GetOrigin(static_cast<unsigned>(d));
    }
    slice.instance = std::strtol(tag_of(slice.io, "0020|0013").c_str(), nullptr, 10);
    return slice;
}

/// The files of each series in a folder, by its name: its description, with its number where
/// several have one description.
std::map<std::string, std::vector<std::string>> series_in(const fs::path& folder) {
    const auto names = itk::GDCMSeriesFileNames::New();
    names->SetUseSeriesDetails(true);
    names->SetRecursive(true);
    names->SetInputDirectory(folder.string());
    std::map<std::string, std::vector<std::string>> series;
    for (const std::string& identifier : names->GetSeriesUIDs()) {
        const std::vector<std::string> files = names->GetFileNames(identifier);
        if (files.empty()) continue;
        const Slice first = open_slice(files.front());
        std::string name = tag_of(first.io, "0008|103e");
        if (name.empty()) name = "series " + tag_of(first.io, "0020|0011");
        const std::string same = name;
        for (int i = 2; series.contains(name); ++i) name = same + " " + std::to_string(i);
        series[name] = files;
    }
    return series;
}

/// The files of the series that is meant.
std::pair<std::string, std::vector<std::string>> chosen_series(const fs::path& path,
                                                               const std::string& wanted) {
    const bool is_folder = fs::is_directory(path);
    const bool is_list = !is_folder && path.filename() == "DICOMDIR";
    const fs::path above = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const auto all = series_in(is_folder ? path : above);
    std::vector<std::string> names;
    for (const auto& [name, files] : all) {
        names.push_back(name);
        if (name == wanted) return {name, files};
        const auto is_meant = [&](const std::string& file) {
            std::error_code none;
            return fs::equivalent(file, path, none);
        };
        const bool by_file = !is_folder && !is_list && wanted.empty();
        if (by_file && std::ranges::any_of(files, is_meant)) return {name, files};
    }
    if (!wanted.empty()) {
        throw InvalidInput(path.string() + " has no series '" + wanted + "', only " +
                           listed(names) + did_you_mean(wanted, names));
    }
    if (all.empty()) throw IoError(path.string() + " holds no DICOM series that can be read");
    if (all.size() > 1) {
        throw InvalidInput(path.string() +
                           " has several series, choose one by --array: " + listed(names));
    }
    return *all.begin();
}

const char* type_of(const itk::GDCMImageIO& io) {
    using Type = itk::CommonEnums::IOComponent;
    switch (io.GetComponentType()) {
        case Type::UCHAR:
            return "uint8";
        case Type::CHAR:
            return "int8";
        case Type::USHORT:
            return "uint16";
        case Type::SHORT:
            return "int16";
        case Type::UINT:
            return "uint32";
        case Type::INT:
            return "int32";
        case Type::FLOAT:
            return "float32";
        default:
            return "float64";
    }
}

/// Reads a slice, converted where it has another type than the others.
void read_slice(const Slice& slice, const std::string& type, std::span<std::byte> to) {
    itk::GDCMImageIO& io = *slice.io;
    const std::string own = type_of(io);
    itk::ImageIORegion region(3);
    for (unsigned d = 0; d < 3; ++d) {
        region.SetSize(d, d < io.GetNumberOfDimensions() ? io.GetDimensions(d) : 1);
    }
    io.SetIORegion(region);
    const std::size_t count = to.size() / bytes_of(type);
    std::vector<std::byte> block(own == type ? 0 : count * bytes_of(own));
    try {
        io.Read(own == type ? to.data() : block.data());
    } catch (const itk::ExceptionObject&) {
        throw IoError("'" + slice.path.string() +
                      "' is truncated, damaged or packed as no reader "
                      "of GDCM knows");
    }
    if (own == type) return;
    with_samples(own, block.data(), count, [&]<class From>(std::span<From> from) {
        std::transform(from.begin(), from.end(), reinterpret_cast<double*>(to.data()),
                       [](From number) { return static_cast<double>(number); });
    });
}

Point axis_of(const itk::GDCMImageIO& io, unsigned axis) {
    const std::vector<double> direction = io.GetDirection(axis);
    return {direction[0], direction[1], direction[2]};
}

/// Sorts slices along their normal and, where several are in one place, by their instance numbers.
/// \return how many are in each place
std::size_t sort_slices(std::vector<Slice>& slices, const fs::path& path) {
    const Point normal = cross(axis_of(*slices.front().io, 0), axis_of(*slices.front().io, 1));
    // Positions are given in digits.
    constexpr double same = 1e-3;
    const auto height = [&](const Slice& slice) { return dot(slice.place, normal); };
    std::ranges::sort(slices, {}, [&](const Slice& s) { return std::pair(height(s), s.instance); });
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const bool first = i == 0 || height(slices[i]) - height(slices[i - 1]) > same;
        if (first) places.push_back(0);
        ++places.back();
    }
    const std::size_t frames = places.front();
    if (std::ranges::count(places, frames) != std::ssize(places)) {
        throw InvalidInput(path.string() + " has " + std::to_string(frames) +
                           " slices in its first place, and another number elsewhere");
    }
    for (std::size_t p = 0; frames > 1 && p < places.size(); ++p) {
        const auto begin = slices.begin() + static_cast<std::ptrdiff_t>(p * frames);
        std::sort(begin, begin + static_cast<std::ptrdiff_t>(frames),
                  [](const Slice& a, const Slice& b) { return a.instance < b.instance; });
    }
    return frames;
}

void set_place(FileSamples& samples, const std::vector<Slice>& slices, std::size_t frames) {
    const itk::GDCMImageIO& io = *slices.front().io;
    auto& g = samples.geometry;
    for (unsigned d = 0; d < 3; ++d) {
        const bool has = d < io.GetNumberOfDimensions();
        g.samples[d] = has ? static_cast<int>(io.GetDimensions(d)) : 1;
        g.spacing[d] = has ? io.GetSpacing(d) : 1;
        const Point axis = axis_of(io, std::min(d, io.GetNumberOfDimensions() - 1));
        for (std::size_t r = 0; r < 3; ++r) g.direction[r][d] = axis[r];
    }
    g.origin = slices.front().place;
    const std::size_t places = slices.size() / frames;
    if (places == 1) return;
    const Point all = slices.back().place - g.origin;
    const Point step = 1 / static_cast<double>(places - 1) * all;
    // Digits of the header, and a tenth of what a missing slice would make.
    const double tolerance = 0.1 * norm(step);
    for (std::size_t p = 0; p < places; ++p) {
        const Point off = slices[p * frames].place - g.origin - static_cast<double>(p) * step;
        if (norm(off) > tolerance) {
            throw InvalidInput("'" + slices[p * frames].path.string() + "' lies " +
                               std::to_string(norm(off)) + " mm off even steps of " +
                               std::to_string(norm(step)) +
                               " mm: a slice is missing, or they are not even");
        }
    }
    g.samples[2] = static_cast<int>(places);
    g.spacing[2] = norm(step);
    for (std::size_t r = 0; r < 3; ++r) g.direction[r][2] = step[r] / norm(step);
}

FileSamples read_dicom(const fs::path& path, const WantedSamples& wanted) {
    const auto [name, files] = chosen_series(path, wanted.array);
    const auto slices = std::make_shared<std::vector<Slice>>();
    for (const std::string& file : files) slices->push_back(open_slice(file));
    FileSamples samples{.path = path};
    samples.type = type_of(*slices->front().io);
    const itk::GDCMImageIO& first = *slices->front().io;
    for (const Slice& slice : *slices) {
        const itk::GDCMImageIO& io = *slice.io;
        if (io.GetDimensions(0) != first.GetDimensions(0) ||
            io.GetDimensions(1) != first.GetDimensions(1) ||
            io.GetNumberOfComponents() != first.GetNumberOfComponents()) {
            throw InvalidInput("'" + slice.path.string() + "' has other dimensions than '" +
                               slices->front().path.string() + "'");
        }
        if (samples.type != type_of(io)) samples.type = "float64";
    }
    samples.frames.count = sort_slices(*slices, path);
    set_place(samples, *slices, samples.frames.count);
    samples.components.count = first.GetNumberOfComponents();
    if (samples.components.count == 3) samples.component_kind = "colour";
    // Slices stand one behind the other, and those of one place together.
    set_dense_strides(samples);
    const std::size_t slice = samples.stride[2];
    if (samples.frames.count > 1) {
        samples.frames.stride = slice;
        samples.stride[2] = slice * samples.frames.count;
    }
    samples.fill = [slices, type = samples.type](std::span<std::byte> block) {
        const std::size_t bytes = block.size() / slices->size();
        for (std::size_t i = 0; i < slices->size(); ++i) {
            read_slice((*slices)[i], type, block.subspan(i * bytes, bytes));
        }
    };
    samples.name = name;
    samples.length_unit = "mm";
    samples.space = "LPS";
    return samples;
}

const RegisteredFormat dicom({.name = "DICOM series",
                              .endings = {".dcm", ".dicom"},
                              .holds = "slices in space, several series",
                              .options = {"--array"},
                              .reads_beside = true,
                              .recognises = is_dicom,
                              .read_samples = read_dicom});

}  // namespace
