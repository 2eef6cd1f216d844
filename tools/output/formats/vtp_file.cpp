// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK poly data (.vtp): a header, then each array as it lies in memory, packed with LZ4 or not.
// Points are of single precision where that suffices. VTK's own writer copies the points, looks for
// the range of each array and lists the cells first, which takes longer than to write them.
#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkZLibDataCompressor.h>

#include "formats.hpp"
#include "output/precision.hpp"
#include "output/xml.hpp"

namespace {

static_assert(std::endian::native == std::endian::little);

using Bytes = std::span<const std::byte>;

/// An array of the file.
struct Column {
    std::string name;
    std::string type;          ///< in the words of VTK, like Float32
    std::string attributes{};  ///< further ones
    Bytes numbers{};           ///< where they lie
    bool narrow = false;       ///< whether the file has numbers of half as many bytes
    std::string text{};        ///< in the place of numbers

    std::size_t size() const {
        return text.size() + (narrow ? numbers.size() / 2 : numbers.size());
    }
    Bytes bytes() const { return text.empty() ? numbers : std::as_bytes(std::span(text)); }
};

/// Some bytes of a column of the file, which lie in memory, or in the room if they are narrowed.
/// \param room at least as long
Bytes part_of(const Column& column, std::size_t first, std::size_t size,
              std::span<std::byte> room) {
    if (!column.narrow) return column.bytes().subspan(first, size);
    const auto narrow = [&]<class Wide, class Narrow>(Wide, Narrow) {
        const auto* const from =
            reinterpret_cast<const Wide*>(column.numbers.data()) + first / sizeof(Narrow);
        auto* const to = reinterpret_cast<Narrow*>(room.data());
        std::transform(from, from + size / sizeof(Narrow), to,
                       [](Wide x) { return static_cast<Narrow>(x); });
    };
    column.type == "Float32" ? narrow(double{}, float{}) : narrow(std::int64_t{}, std::int32_t{});
    return room.first(size);
}

std::string type_of(vtkDataArray* array, bool narrow) {
    const int bits = 8 * array->GetDataTypeSize() / (narrow ? 2 : 1);
    const bool real = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
    const bool has_sign = array->GetDataTypeMin() < 0;
    return (real ? "Float" : has_sign ? "Int" : "UInt") + std::to_string(bits);
}

/// \param skipped values at the beginning
Column column_of(vtkDataArray* array, const std::string& name, bool narrow,
                 std::size_t skipped = 0) {
    Column column{.name = name, .type = type_of(array, narrow), .narrow = narrow};
    const int components = array->GetNumberOfComponents();
    if (components > 1) {
        column.attributes = " NumberOfComponents=\"" + std::to_string(components) + "\"";
    }
    const auto values = static_cast<std::size_t>(array->GetNumberOfValues());
    if (values <= skipped) return column;
    const auto width = static_cast<std::size_t>(array->GetDataTypeSize());
    const auto* const data = static_cast<const std::byte*>(array->GetVoidPointer(0));
    column.numbers = Bytes(data, values * width).subspan(skipped * width);
    return column;
}

/// Part of the header: an element with arrays.
struct Section {
    std::string name;
    std::string attributes{};
    std::vector<Column> columns{};
};

Section data_section(const std::string& name, vtkDataSetAttributes* data) {
    Section section{.name = name};
    std::array<int, vtkDataSetAttributes::NUM_ATTRIBUTES> roles{};
    data->GetAttributeIndices(roles.data());
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        vtkDataArray* const array = data->GetArray(i);
        if (array == nullptr) continue;
        const std::string array_name = array->GetName() == nullptr ? "" : array->GetName();
        section.columns.push_back(column_of(array, array_name, false));
        for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role) {
            if (roles.at(static_cast<std::size_t>(role)) != i) continue;
            section.attributes += std::string(" ") +
                                  vtkDataSetAttributes::GetAttributeTypeAsString(role) + "=" +
                                  xml_value(array_name);
        }
    }
    return section;
}

Section field_section(vtkFieldData* data) {
    Section section{.name = "FieldData"};
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        vtkAbstractArray* const array = data->GetAbstractArray(i);
        const std::string name = array->GetName() == nullptr ? "" : array->GetName();
        if (auto* const numbers = vtkDataArray::SafeDownCast(array)) {
            section.columns.push_back(column_of(numbers, name, false));
        } else if (auto* const texts = vtkStringArray::SafeDownCast(array)) {
            Column& column = section.columns.emplace_back(Column{.name = name, .type = "String"});
            for (vtkIdType t = 0; t < texts->GetNumberOfValues(); ++t) {
                column.text += texts->GetValue(t) + '\0';
            }
        } else {
            continue;
        }
        section.columns.back().attributes +=
            " NumberOfTuples=\"" + std::to_string(array->GetNumberOfTuples()) + "\"";
    }
    return section;
}

Section cell_section(const std::string& name, vtkCellArray* cells) {
    const bool narrow = cells->IsStorage64Bit() && cells->CanConvertTo32BitStorage();
    // The first offset is left out: it is 0.
    return {.name = name,
            .columns = {column_of(cells->GetConnectivityArray(), "connectivity", narrow),
                        column_of(cells->GetOffsetsArray(), "offsets", narrow, 1)}};
}

/// Null for none.
vtkSmartPointer<vtkDataCompressor> compressor_of(SurfaceEncoding::Compression compression) {
    vtkSmartPointer<vtkDataCompressor> compressor;
    if (compression == SurfaceEncoding::Compression::lz4) {
        compressor = vtkSmartPointer<vtkLZ4DataCompressor>::New();
    } else if (compression == SurfaceEncoding::Compression::zlib) {
        compressor = vtkSmartPointer<vtkZLibDataCompressor>::New();
    }
    if (compressor != nullptr) compressor->SetCompressionLevel(5);  // as VTK's writers do
    return compressor;
}

class VtpFile {
public:
    VtpFile(vtkPolyData* surface, const std::filesystem::path& path,
            const SurfaceEncoding& encoding)
        : file_(path, std::ios::binary), compressor_{compressor_of(encoding.compression)} {
        counts_ = {surface->GetNumberOfPoints(), surface->GetNumberOfLines(),
                   surface->GetNumberOfPolys()};
        sections_.push_back(field_section(surface->GetFieldData()));
        sections_.push_back(data_section("PointData", surface->GetPointData()));
        sections_.push_back(data_section("CellData", surface->GetCellData()));
        vtkDataArray* const points = surface->GetPoints()->GetData();
        const bool single =
            points->GetDataType() == VTK_DOUBLE && !encoding.doubles && single_keeps_shape(surface);
        sections_.push_back({.name = "Points", .columns = {column_of(points, "Points", single)}});
        sections_.push_back(cell_section("Lines", surface->GetLines()));
        sections_.push_back(cell_section("Polys", surface->GetPolys()));
    }

    /// \return why it could not be written, or nothing
    std::string write() {
        errno = 0;
        file_ << header();  // of the same length as with the offsets that are found below
        const auto begin = static_cast<std::uint64_t>(file_.tellp());
        for (const Section& section : sections_) {
            for (const Column& column : section.columns) {
                offsets_.push_back(static_cast<std::uint64_t>(file_.tellp()) - begin);
                compressor_ == nullptr ? put(column) : pack(column);
            }
        }
        file_ << "\n  </AppendedData>\n</VTKFile>\n";
        file_.seekp(0);
        file_ << header();
        file_.close();
        return file_ ? "" : std::strerror(errno == 0 ? EIO : errno);
    }

private:
    /// Shorter blocks take longer to write.
    static constexpr std::size_t block_size = std::size_t{1} << 20U;

    std::string header() const {
        const auto& [points, lines, polys] = counts_;
        std::string text =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
        if (compressor_ != nullptr) {
            text += " compressor=" + xml_value(compressor_->GetClassName());
        }
        text += ">\n  <PolyData>\n";
        std::size_t next = 0;
        for (const Section& section : sections_) {
            text += "    <" + section.name + section.attributes + ">\n";
            for (const Column& column : section.columns) {
                const std::string element = column.type == "String" ? "Array" : "DataArray";
                std::string offset = std::to_string(next < offsets_.size() ? offsets_[next] : 0);
                offset.resize(20, ' ');
                ++next;
                text += "      <" + element + " type=\"" + column.type +
                        "\" Name=" + xml_value(column.name) + column.attributes +
                        " format=\"appended\" offset=\"" + offset + "\"/>\n";
            }
            text += "    </" + section.name + ">\n";
            if (section.name != "FieldData") continue;
            text += "    <Piece NumberOfPoints=\"" + std::to_string(points) +
                    "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(lines) +
                    "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(polys) + "\">\n";
        }
        return text + "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n   _";
    }

    /// Calls function(bytes) for the blocks of a column, the last of which may be shorter.
    template <class Function>
    void for_blocks(const Column& column, const Function& function) {
        for (std::size_t first = 0; first < column.size(); first += block_size) {
            function(part_of(column, first, std::min(block_size, column.size() - first), room_));
        }
    }
    void put_bytes(Bytes bytes) {
        file_.write(reinterpret_cast<const char*>(bytes.data()),
                    static_cast<std::streamsize>(bytes.size()));
    }
    void put(const Column& column) {
        const std::array<std::uint64_t, 1> size{column.size()};
        put_bytes(std::as_bytes(std::span(size)));
        for_blocks(column, [&](Bytes block) { put_bytes(block); });
    }
    /// How many blocks there are, how long each is, and the last if it is shorter; the lengths of
    /// the packed ones; then these.
    void pack(const Column& column) {
        std::vector<std::uint64_t> sizes{(column.size() + block_size - 1) / block_size, block_size,
                                         column.size() % block_size};
        const auto begin = file_.tellp();
        packed_.resize(compressor_->GetMaximumCompressionSpace(block_size));
        const std::vector<std::uint64_t> unknown(3 + sizes[0]);
        put_bytes(std::as_bytes(std::span(unknown)));
        for_blocks(column, [&](Bytes block) {
            const auto* const from = reinterpret_cast<const unsigned char*>(block.data());
            auto* const to = reinterpret_cast<unsigned char*>(packed_.data());
            sizes.push_back(compressor_->Compress(from, block.size(), to, packed_.size()));
            put_bytes(Bytes(packed_).first(sizes.back()));
        });
        const auto end = file_.tellp();
        file_.seekp(begin);
        put_bytes(std::as_bytes(std::span(sizes)));
        file_.seekp(end);
    }

    std::ofstream file_;
    vtkSmartPointer<vtkDataCompressor> compressor_;
    std::array<vtkIdType, 3> counts_{};
    std::vector<Section> sections_;
    std::vector<std::uint64_t> offsets_;  // of the columns so far
    std::vector<std::byte> room_ = std::vector<std::byte>(block_size);
    std::vector<std::byte> packed_;
};

std::string write_vtp(vtkPolyData* surface, const std::filesystem::path& path,
                      const SurfaceEncoding& encoding) {
    return VtpFile(surface, path, encoding).write();
}

const RegisteredFormat vtp({.name = "VTK poly data",
                            .endings = {".vtp"},
                            .holds = "triangles, lines, normals and values",
                            .keeps_elements = true,
                            .compresses = true,
                            .has_doubles = true,
                            .write_surface = write_vtp});

}  // namespace
