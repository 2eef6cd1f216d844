// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// NIfTI-1 and NIfTI-2, and Analyze, which has no places; read by VTK, which keeps sheared axes.
// (ITK 5.2 refuses these and NIfTI-2.)
//
// Fields of the header and what becomes of them:
//   dim, pixdim, datatype, vox_offset, byte order, qform, sform   by VTK; sform goes before qform
//   dim[4]: frames; dim[5]: components; dim[6] and dim[7]         refused unless 1
//   scl_slope, scl_inter                                          applied here
//   xyzt_units, pixdim[4], toffset                                unit of length; times of frames
//   qform_code, sform_code                                        whether axes are those of a space
//   intent_name                                                   the name of the data
//   intent_code, intent_p*, cal_*, slice_*, descrip, aux_file   without effect
#include <cmath>
#include <limits>

#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <nestgrid/error.hpp>

#include "formats.hpp"
#include "input/end_checks.hpp"
#include "input/input_file.hpp"
#include "input/volumes/vtk_reading.hpp"

namespace {

using nestgrid::IoError;
namespace fs = std::filesystem;

/// One file, or a header and its samples beside it.
struct Files {
    fs::path header;
    fs::path samples;
};

Files files_of(const fs::path& path) {
    Files files{path, path};
    const bool packed = ending_of(path) == ".gz";
    const fs::path unpacked = packed ? path.stem() : path.filename();
    const auto with = [&](const char* ending) {
        fs::path name = unpacked;
        name.replace_extension(ending);
        if (packed) name += path.extension();
        return path.parent_path() / name;
    };
    if (ending_of(unpacked) == ".img") files.header = with(".hdr");
    if (ending_of(unpacked) == ".hdr") files.samples = with(".img");
    require_file(files.header);
    require_file(files.samples);
    return files;
}

/// The unit of length that xyzt_units of a header has.
std::string length_unit(int units) {
    constexpr std::array<const char*, 4> names{"", "m", "mm", "µm"};
    const auto code = static_cast<std::size_t>(units) & 7U;
    return code < names.size() ? names[code] : "";
}

/// Numbers of the file for each place, of one frame or of all.
std::array<std::size_t, 2> axes_beyond_space(const fs::path& path, vtkNIFTIImageHeader* header) {
    std::array<std::size_t, 2> counts{1, 1};
    const long axes = header->GetDim(0);
    for (int d = 4; d <= axes && d <= 7; ++d) {
        const auto count = static_cast<std::size_t>(std::max<long>(1, header->GetDim(d)));
        if (d <= 5) counts[static_cast<std::size_t>(d - 4)] = count;
        if (d > 5 && count > 1) {
            throw IoError(path.string() + " has " + std::to_string(count) +
                          " samples along its dimension " + std::to_string(d) +
                          ", which is not read");
        }
    }
    return counts;
}

void set_place(FileSamples& samples, vtkNIFTIImageReader* reader) {
    const vtkMatrix4x4* matrix =
        reader->GetSFormMatrix() != nullptr ? reader->GetSFormMatrix() : reader->GetQFormMatrix();
    if (matrix == nullptr) return;
    samples.space = "RAS";
    for (std::size_t r = 0; r < 3; ++r) {
        const auto row = static_cast<int>(r);
        for (std::size_t c = 0; c < 3; ++c) {
            samples.geometry.direction[r][c] = matrix->GetElement(row, static_cast<int>(c));
        }
        samples.geometry.origin[r] = matrix->GetElement(row, 3);
    }
}

/// Times of frames, in the unit of the file.
void set_times(FileSamples& samples, vtkNIFTIImageHeader* header) {
    const double step = header->GetPixDim(4);
    const double first = header->GetTOffset();
    if (std::isfinite(step) && step > 0) samples.time_step = step;
    if (std::isfinite(first)) samples.first_time = first;
}

/// A slope of 0, or one that is no number, means that the numbers are the values.
void set_scale(FileSamples& samples, vtkNIFTIImageHeader* header) {
    const double slope = header->GetSclSlope();
    const double intercept = header->GetSclInter();
    if (!std::isfinite(slope) || slope == 0) return;
    if (!std::isfinite(intercept)) {
        throw IoError(samples.path.string() + " has a scl_inter that is not a finite number");
    }
    samples.slope = slope;
    samples.intercept = intercept;
}

FileSamples read_nifti(const fs::path& path, const WantedSamples& wanted) {
    const Files files = files_of(path);
    const vtkNew<vtkNIFTIImageReader> reader;
    const VtkReading reading(files.samples);
    reading.listen(reader);
    if (reader->CanReadFile(files.header.c_str()) == 0) {
        throw IoError(files.header.string() + " is no NIfTI file, or truncated in its header");
    }
    const NiftiStart start = checked_nifti_start(files.header);
    reader->SetFileName(files.header.c_str());
    const std::uintmax_t places = reading.read_header(reader);
    vtkNIFTIImageHeader* const header = reader->GetNIFTIHeader();
    const auto [frames, vectors] = axes_beyond_space(path, header);
    const auto bytes =
        static_cast<double>(vtkDataArray::GetDataTypeSize(reader->GetDataScalarType()));
    const double size = static_cast<double>(places) * bytes * static_cast<double>(frames) *
                        static_cast<double>(vectors);
    check_plausible(files.samples, fs::file_size(files.samples), size);
    check_nifti_size(files.samples, start, static_cast<std::uintmax_t>(size));
    // All frames become components of the samples.
    if (frames > 1 && wanted.several_frames) reader->TimeAsVectorOn();
    const vtkSmartPointer<vtkImageData> image = reading.read_samples(reader);
    vtkDataArray* const scalars = image->GetPointData()->GetScalars();
    if (scalars == nullptr) throw IoError(path.string() + " holds no samples");
    FileSamples samples{.path = path};
    set_geometry(samples, image);
    set_place(samples, reader);
    set_numbers(samples, scalars);
    samples.frames.count = frames;
    if (frames > 1 && wanted.several_frames) {
        samples.components.count /= frames;
        samples.frames.stride = samples.components.count;
    }
    set_scale(samples, header);
    samples.name = header->GetIntentName() == nullptr ? "" : header->GetIntentName();
    samples.length_unit = length_unit(header->GetXYZTUnits());
    set_times(samples, header);
    return samples;
}

const RegisteredFormat nifti({.name = "NIfTI",
                              .endings = {".nii.gz", ".nii", ".hdr", ".img", ".hdr.gz", ".img.gz"},
                              .holds = "samples in space, several frames",
                              .detached = {".hdr", ".img", ".hdr.gz", ".img.gz"},
                              .read_samples = read_nifti});

}  // namespace
