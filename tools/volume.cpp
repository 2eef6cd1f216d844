// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "volume.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkImageReader.h>
#include <vtkInformation.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLImageDataReader.h>
#include <zlib.h>

#include <nestgrid/error.hpp>

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;
namespace fs = std::filesystem;

/// Collects what VTK would print.
class ErrorCollector : public vtkCommand {
public:
    static ErrorCollector* New() { return new ErrorCollector; }  // NOLINT(*-naming)
    void Execute(vtkObject*, unsigned long, void* data) override {
        if (!message.empty()) return;
        const std::string text = data == nullptr ? "" : static_cast<const char*>(data);
        const std::size_t start = text.find("): ");
        message = start == std::string::npos ? text : text.substr(start + 3);
        std::replace(message.begin(), message.end(), '\n', ' ');
        message.erase(message.find_last_not_of(' ') + 1);
        if (message.empty()) message = "it cannot be read";
    }
    std::string message;
};

struct NamedType {
    const char* name;
    int vtk;
};
constexpr std::array<NamedType, 10> types{{{"uint8", VTK_UNSIGNED_CHAR},
                                           {"int8", VTK_SIGNED_CHAR},
                                           {"uint16", VTK_UNSIGNED_SHORT},
                                           {"int16", VTK_SHORT},
                                           {"uint32", VTK_UNSIGNED_INT},
                                           {"int32", VTK_INT},
                                           {"uint64", VTK_UNSIGNED_LONG},
                                           {"int64", VTK_LONG},
                                           {"float32", VTK_FLOAT},
                                           {"float64", VTK_DOUBLE}}};

std::string type_name(int vtk_type) {
    if (vtk_type == VTK_CHAR) return "int8";
    if (vtk_type == VTK_UNSIGNED_LONG_LONG) return "uint64";
    if (vtk_type == VTK_LONG_LONG) return "int64";
    for (const NamedType& t : types) {
        if (t.vtk == vtk_type) return t.name;
    }
    return "";
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool ends_with(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

[[noreturn]] void truncated(const fs::path& path, std::uintmax_t found, std::uintmax_t expected) {
    throw IoError(path.string() + " is truncated: " + std::to_string(found) +
                  " bytes, but its header asks for " + std::to_string(expected));
}

/// The text header of MetaImage and NRRD files: keys in lower case.
struct TextHeader {
    std::map<std::string, std::string> field;
    std::uintmax_t length = 0;
    bool ended = false;  ///< by a blank line

    std::vector<double> numbers(const std::string& key) const {
        std::vector<double> result;
        const auto at = field.find(key);
        if (at == field.end()) return result;
        std::string text = at->second;
        for (char& c : text) {
            if (c == '(' || c == ')' || c == ',') c = ' ';
        }
        std::istringstream words(text);
        for (std::string word; words >> word;) {
            char* end = nullptr;
            const double number = std::strtod(word.c_str(), &end);
            if (*end == '\0') result.push_back(number);
        }
        return result;
    }
    std::string value(const std::string& key) const {
        const auto at = field.find(key);
        return at == field.end() ? "" : at->second;
    }
};

TextHeader read_text_header(const fs::path& path, char separator, const std::string& last) {
    std::ifstream file(path, std::ios::binary);
    TextHeader header;
    std::string line;
    const auto trim = [](std::string text) {
        text.erase(text.find_last_not_of(" \t\r=:") + 1);
        return text.erase(0, text.find_first_not_of(" \t=:"));
    };
    for (int i = 0; i < 1000 && std::getline(file, line); ++i) {
        header.length += line.size() + 1;
        header.ended = line.find_first_not_of("\r") == std::string::npos && !file.eof();
        if (header.ended) break;
        const std::size_t at = line.find(separator);
        if (at == std::string::npos) continue;
        const std::string key = trim(lower(line.substr(0, at)));
        header.field[key] = trim(line.substr(at + 1));
        if (key == last) break;
    }
    return header;
}

/// Sizes are checked before anything is allocated: what the header asks for against the file.
void check_meta_sizes(const fs::path& path) {
    const TextHeader header = read_text_header(path, '=', "elementdatafile");
    const std::string data = header.value("elementdatafile");
    if (data.empty()) throw IoError(path.string() + " is no MetaImage: it names no data file");
    if (data == "LIST" || data.find('%') != std::string::npos) {
        throw IoError(path.string() + " spreads its samples over several files, which is not read");
    }
    const bool local = lower(data) == "local";
    const fs::path file = local ? path : path.parent_path() / data;
    if (!fs::is_regular_file(file)) {
        throw IoError(path.string() + " names the data file " + file.string() +
                      ", which does not exist");
    }
    const double found = static_cast<double>(fs::file_size(file)) -
                         (local ? static_cast<double>(header.length) : 0.0);
    if (lower(header.value("compresseddata")) == "true") {
        const auto size = header.numbers("compresseddatasize");
        if (size.empty()) {
            throw IoError(path.string() +
                          " is compressed but does not say CompressedDataSize, which is not read");
        }
        if (!(size[0] <= found)) {
            truncated(file, static_cast<std::uintmax_t>(std::max(found, 0.0)),
                      static_cast<std::uintmax_t>(size[0]));
        }
        return;
    }
    static const std::map<std::string, double> bytes{
        {"MET_CHAR", 1},  {"MET_UCHAR", 1},     {"MET_SHORT", 2},      {"MET_USHORT", 2},
        {"MET_INT", 4},   {"MET_UINT", 4},      {"MET_LONG", 4},       {"MET_ULONG", 4},
        {"MET_FLOAT", 4}, {"MET_LONG_LONG", 8}, {"MET_ULONG_LONG", 8}, {"MET_DOUBLE", 8}};
    const auto size = bytes.find(header.value("elementtype"));
    if (size == bytes.end()) {
        throw IoError(path.string() + " has the sample type '" + header.value("elementtype") +
                      "', which is not read");
    }
    double expected = size->second;
    for (const double n : header.numbers("dimsize")) expected *= n;
    if (!(expected <= found)) {
        truncated(file, static_cast<std::uintmax_t>(std::max(found, 0.0)),
                  static_cast<std::uintmax_t>(std::min(expected, 1e18)));
    }
}

/// The bytes of a file, unpacked where it is packed with gzip.
/// \throw IoError where it ends too early
std::uintmax_t unpacked_size(const fs::path& path) {
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw IoError(path.string() + " cannot be opened");
    std::vector<char> buffer(1U << 20U);
    std::uintmax_t total = 0;
    int count = 0;
    while ((count = gzread(file, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0) {
        total += static_cast<std::uintmax_t>(count);
    }
    const int error = gzclose(file);
    if (count < 0 || error != Z_OK) {
        throw IoError(path.string() + " is truncated or damaged: it cannot be unpacked to its end");
    }
    return total;
}

/// Where the samples of a NIfTI file start.
std::uintmax_t nifti_offset(const fs::path& path) {
    std::array<char, 352> header{};
    gzFile file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw IoError(path.string() + " cannot be opened");
    const int count = gzread(file, header.data(), header.size());
    gzclose(file);
    if (count < static_cast<int>(header.size())) return header.size();
    const bool swapped = header[0] != 0x5C && header[0] != 0x1C;  // 348 or 540, low byte first
    const auto load = [&]<class Number>(std::size_t at, Number number) {
        std::array<char, sizeof(Number)> bytes{};
        std::copy_n(header.begin() + static_cast<std::ptrdiff_t>(at), bytes.size(), bytes.begin());
        if (swapped) std::reverse(bytes.begin(), bytes.end());
        std::memcpy(&number, bytes.data(), bytes.size());
        return number;
    };
    const bool second = load(0, std::int32_t{}) == 540;
    const double offset =
        second ? static_cast<double>(load(168, std::int64_t{})) : load(108, float{});
    return offset > 0 && offset < 1e12 ? static_cast<std::uintmax_t>(offset) : header.size();
}

/// An XML file is complete when its last element is closed.
void check_xml_end(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const auto size = static_cast<std::streamoff>(fs::file_size(path));
    file.seekg(std::max<std::streamoff>(0, size - 64));
    const std::string tail((std::istreambuf_iterator<char>(file)), {});
    if (tail.find("</VTKFile>") == std::string::npos) {
        throw IoError(path.string() + " is truncated: it does not end with </VTKFile>");
    }
}

struct Reading {
    fs::path path;
    vtkSmartPointer<ErrorCollector> errors = vtkSmartPointer<ErrorCollector>::New();

    void listen(vtkAlgorithm* reader) const {
        reader->AddObserver(vtkCommand::ErrorEvent, errors);
        reader->AddObserver(vtkCommand::WarningEvent, errors);
    }
    void check() const {
        if (!errors->message.empty()) {
            throw IoError(path.string() + " cannot be read: " + errors->message);
        }
    }
    /// The header first; what it asks for must be plausible for the size of the file.
    vtkSmartPointer<vtkImageData> run(vtkAlgorithm* reader, bool compressed,
                                      int sample_bytes) const {
        reader->UpdateInformation();
        check();
        std::array<int, 6> extent{0, -1, 0, -1, 0, -1};
        vtkInformation* info = reader->GetOutputInformation(0);
        info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
        double expected = sample_bytes;
        for (std::size_t d = 0; d < 3; ++d) expected *= extent[2 * d + 1] - extent[2 * d] + 1.0;
        const auto found = static_cast<double>(fs::file_size(path));
        // Deflate packs at most 1032 to 1.
        if (expected > found * (compressed ? 1100 : 1)) {
            truncated(path, fs::file_size(path),
                      static_cast<std::uintmax_t>(std::min(expected, 1e18)));
        }
        reader->Update();
        check();
        auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
        if (image == nullptr) throw IoError(path.string() + " holds no image data");
        return image;
    }
};

void set_direction(Volume& volume, const vtkMatrix4x4* matrix) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            volume.geometry.direction[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] =
                matrix->GetElement(r, c);
        }
        volume.geometry.origin[static_cast<std::size_t>(r)] = matrix->GetElement(r, 3);
    }
}

void set_geometry(Volume& volume) {
    std::array<int, 3> dims{};
    volume.image->GetDimensions(dims.data());
    volume.geometry.samples = dims;
    volume.image->GetSpacing(volume.geometry.spacing.data());
    std::array<int, 6> extent{};
    volume.image->GetExtent(extent.data());
    volume.image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4],
                                                volume.geometry.origin.data());
    const double* direction = volume.image->GetDirectionMatrix()->GetData();
    for (std::size_t i = 0; i < 9; ++i) volume.geometry.direction[i / 3][i % 3] = direction[i];
}

Volume read_meta(const Reading& reading) {
    check_meta_sizes(reading.path);
    const vtkNew<vtkMetaImageReader> reader;
    reading.listen(reader);
    reader->SetFileName(reading.path.c_str());
    Volume volume;
    volume.image = reading.run(reader, true, 1);
    set_geometry(volume);
    const TextHeader header = read_text_header(reading.path, '=', "elementdatafile");
    for (const char* key : {"transformmatrix", "rotation", "orientation"}) {
        const std::vector<double> m = header.numbers(key);
        if (m.size() != 9) continue;
        // MetaImage lists the axes one after the other.
        for (std::size_t i = 0; i < 9; ++i) volume.geometry.direction[i % 3][i / 3] = m[i];
        break;
    }
    return volume;
}

Volume read_nrrd(const Reading& reading) {
    const TextHeader header = read_text_header(reading.path, ':', "");
    if (!header.ended) {  // VTK would look for its end for ever
        throw IoError(reading.path.string() +
                      " is truncated or no NRRD file: its header does not "
                      "end");
    }
    if (lower(header.value("encoding")) == "raw" && header.value("data file").empty()) {
        const std::string type = header.value("type");
        double bytes = 1;  // at least
        for (const auto& [name, size] : std::map<std::string, double>{{"short", 2},
                                                                      {"int16", 2},
                                                                      {"int32", 4},
                                                                      {"float", 4},
                                                                      {"double", 8},
                                                                      {"int64", 8},
                                                                      {"long long", 8}}) {
            if (type.find(name) != std::string::npos) bytes = size;
        }
        if (type == "int" || type == "unsigned int" || type == "uint") bytes = 4;
        double expected = bytes;
        for (const double n : header.numbers("sizes")) expected *= n;
        const double found =
            static_cast<double>(fs::file_size(reading.path)) - static_cast<double>(header.length);
        if (!(expected <= found)) {
            truncated(reading.path, static_cast<std::uintmax_t>(std::max(found, 0.0)),
                      static_cast<std::uintmax_t>(std::min(expected, 1e18)));
        }
    }
    const vtkNew<vtkNrrdReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no NRRD file that can be read");
    }
    reader->SetFileName(reading.path.c_str());
    Volume volume;
    volume.image = reading.run(reader, true, 1);
    set_geometry(volume);
    const std::vector<double> axes = header.numbers("space directions");
    const std::vector<double> origin = header.numbers("space origin");
    if (axes.size() == 9) {
        for (std::size_t d = 0; d < 3; ++d) {
            const nestgrid::Point axis{axes[3 * d], axes[3 * d + 1], axes[3 * d + 2]};
            volume.geometry.spacing[d] = nestgrid::norm(axis);
            for (std::size_t r = 0; r < 3; ++r) {
                volume.geometry.direction[r][d] = axis[r] / volume.geometry.spacing[d];
            }
        }
    }
    if (origin.size() == 3) std::copy_n(origin.begin(), 3, volume.geometry.origin.begin());
    return volume;
}

Volume read_nifti(const Reading& reading, bool compressed) {
    const vtkNew<vtkNIFTIImageReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no NIfTI file, or truncated in its header");
    }
    reader->SetFileName(reading.path.c_str());
    reader->UpdateInformation();
    reading.check();
    std::array<int, 6> extent{};
    reader->GetDataExtent(extent.data());
    std::uintmax_t expected =
        static_cast<std::uintmax_t>(vtkDataArray::GetDataTypeSize(reader->GetDataScalarType()));
    for (std::size_t d = 0; d < 3; ++d) {
        expected *= static_cast<std::uintmax_t>(extent[2 * d + 1] - extent[2 * d] + 1);
    }
    expected += nifti_offset(reading.path);
    const std::uintmax_t found =
        compressed ? unpacked_size(reading.path) : fs::file_size(reading.path);
    if (found < expected) truncated(reading.path, found, expected);
    Volume volume;
    volume.image = reading.run(reader, compressed, 1);
    set_geometry(volume);
    const vtkMatrix4x4* matrix =
        reader->GetSFormMatrix() != nullptr ? reader->GetSFormMatrix() : reader->GetQFormMatrix();
    if (matrix != nullptr) set_direction(volume, matrix);
    return volume;
}

Volume read_vti(const Reading& reading, const std::string& array) {
    const vtkNew<vtkXMLImageDataReader> reader;
    reading.listen(reader);
    if (reader->CanReadFile(reading.path.c_str()) == 0) {
        throw IoError(reading.path.string() + " is no VTK image data file");
    }
    check_xml_end(reading.path);
    reader->SetFileName(reading.path.c_str());
    Volume volume;
    volume.image = reading.run(reader, true, 1);
    vtkPointData* data = volume.image->GetPointData();
    if (!array.empty() && data->SetActiveScalars(array.c_str()) < 0) {
        throw InvalidInput(reading.path.string() + " has no point data array '" + array + "'");
    }
    if (data->GetScalars() == nullptr && data->GetNumberOfArrays() == 1 &&
        data->GetArray(0) != nullptr) {
        data->SetActiveScalars(data->GetArray(0)->GetName());
    }
    set_geometry(volume);
    return volume;
}

Volume read_raw(const Reading& reading, const RawFormat& raw) {
    const auto type = std::find_if(types.begin(), types.end(),
                                   [&](const NamedType& t) { return raw.type == t.name; });
    if (type == types.end() || *std::min_element(raw.dims.begin(), raw.dims.end()) < 1) {
        throw InvalidInput(reading.path.string() +
                           " does not describe itself: give --dims NX,NY,NZ and --type");
    }
    const auto size = static_cast<std::uintmax_t>(vtkDataArray::GetDataTypeSize(type->vtk));
    const std::uintmax_t expected = size * static_cast<std::uintmax_t>(raw.dims[0]) *
                                    static_cast<std::uintmax_t>(raw.dims[1]) *
                                    static_cast<std::uintmax_t>(raw.dims[2]);
    const std::uintmax_t found = fs::file_size(reading.path);
    if (found != expected) {
        throw IoError(reading.path.string() + " has " + std::to_string(found) +
                      " bytes, but --dims and --type ask for " + std::to_string(expected));
    }
    const vtkNew<vtkImageReader> reader;
    reading.listen(reader);
    reader->SetFileName(reading.path.c_str());
    reader->SetFileDimensionality(3);
    reader->SetDataExtent(0, raw.dims[0] - 1, 0, raw.dims[1] - 1, 0, raw.dims[2] - 1);
    reader->SetDataSpacing(raw.spacing[0], raw.spacing[1], raw.spacing[2]);
    reader->SetDataScalarType(type->vtk);
    reader->SetHeaderSize(0);
    reader->FileLowerLeftOn();
    raw.big_endian ? reader->SetDataByteOrderToBigEndian()
                   : reader->SetDataByteOrderToLittleEndian();
    Volume volume;
    volume.image = reading.run(reader, false, static_cast<int>(size));
    set_geometry(volume);
    return volume;
}

void check_samples(const Volume& volume, const fs::path& path) {
    const auto n = volume.geometry.samples;
    if (*std::min_element(n.begin(), n.end()) < 2) {
        throw InvalidInput(path.string() + " has " + std::to_string(n[0]) + " x " +
                           std::to_string(n[1]) + " x " + std::to_string(n[2]) +
                           " samples; an isosurface needs at least 2 along each direction");
    }
    if (volume.type.compare(0, 5, "float") != 0) return;
    with_samples(volume, [&](auto samples) {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (std::isfinite(static_cast<double>(samples[i]))) continue;
            const auto nx = static_cast<std::size_t>(n[0]);
            const auto ny = static_cast<std::size_t>(n[1]);
            throw InvalidInput(
                path.string() + ": the sample at (" + std::to_string(i % nx) + ", " +
                std::to_string(i / nx % ny) + ", " + std::to_string(i / nx / ny) + ") is " +
                (std::isnan(static_cast<double>(samples[i])) ? "not a number" : "infinite"));
        }
    });
}

}  // namespace

std::size_t Volume::sample_count() const {
    return static_cast<std::size_t>(geometry.samples[0]) *
           static_cast<std::size_t>(geometry.samples[1]) *
           static_cast<std::size_t>(geometry.samples[2]);
}

Volume read_volume(const fs::path& path, const std::string& array, const RawFormat& raw) {
    if (!fs::exists(path)) throw IoError(path.string() + " does not exist");
    if (!fs::is_regular_file(path)) throw IoError(path.string() + " is no file");
    if (std::ifstream file(path); !file) throw IoError(path.string() + " cannot be opened");
    if (fs::file_size(path) == 0) throw IoError(path.string() + " is empty");
    const Reading reading{path};
    const std::string name = lower(path.filename().string());
    Volume volume;
    if (ends_with(name, ".vti")) {
        volume = read_vti(reading, array);
    } else if (ends_with(name, ".mhd") || ends_with(name, ".mha")) {
        volume = read_meta(reading);
    } else if (ends_with(name, ".nrrd") || ends_with(name, ".nhdr")) {
        volume = read_nrrd(reading);
    } else if (ends_with(name, ".nii") || ends_with(name, ".nii.gz")) {
        volume = read_nifti(reading, ends_with(name, ".gz"));
    } else if (ends_with(name, ".raw")) {
        volume = read_raw(reading, raw);
    } else {
        throw IoError(path.string() +
                      " is of no known format (.vti, .mhd, .mha, .nrrd, .nii, .nii.gz, .raw)");
    }
    vtkDataArray* scalars = volume.image->GetPointData()->GetScalars();
    if (scalars == nullptr) {
        throw InvalidInput(path.string() + " has no point data that could be contoured");
    }
    if (scalars->GetNumberOfComponents() != 1) {
        throw InvalidInput(path.string() + " has " +
                           std::to_string(scalars->GetNumberOfComponents()) +
                           " numbers per sample, not one");
    }
    volume.type = type_name(scalars->GetDataType());
    if (volume.type.empty()) {
        throw InvalidInput(path.string() + " has samples of a type that is not read");
    }
    if (static_cast<std::size_t>(scalars->GetNumberOfTuples()) != volume.sample_count()) {
        throw IoError(path.string() + " holds fewer samples than its header says");
    }
    check_samples(volume, path);
    return volume;
}
