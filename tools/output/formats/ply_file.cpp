// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// PLY, binary. VTK's writer has points of single precision only, and neither normals of its own nor
// values.
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include "formats.hpp"
#include "output/cells.hpp"
#include "output/precision.hpp"

namespace {

static_assert(std::endian::native == std::endian::little);

/// Numbers, one behind the other, which are written many at a time.
class Rows {
public:
    explicit Rows(std::ofstream& file) : file_{file} {}
    /// Makes room for the numbers that follow.
    /// \param bytes less than a million
    void begin(std::size_t bytes) {
        if (size_ + bytes > bytes_.size()) flush();
    }
    template <class Number>
    void put(Number number) {
        std::memcpy(bytes_.data() + size_, &number, sizeof number);
        size_ += sizeof number;
    }
    void flush() {
        file_.write(bytes_.data(), static_cast<std::streamsize>(size_));
        size_ = 0;
    }

private:
    std::ofstream& file_;
    std::vector<char> bytes_ = std::vector<char>(std::size_t{1} << 20U);
    std::size_t size_ = 0;
};

/// The numbers of an array, copied only where they are neither float nor double.
class Numbers {
public:
    explicit Numbers(vtkDataArray* array) {
        if (auto* const floats = vtkFloatArray::FastDownCast(array)) {
            single_ = floats->GetPointer(0);
            return;
        }
        doubles_ = vtkDoubleArray::FastDownCast(array);
        if (doubles_ == nullptr) {
            doubles_ = vtkSmartPointer<vtkDoubleArray>::New();
            doubles_->DeepCopy(array);
        }
        double_ = doubles_->GetPointer(0);
    }
    double operator[](vtkIdType i) const {
        return single_ != nullptr ? static_cast<double>(single_[i]) : double_[i];
    }

private:
    const float* single_ = nullptr;
    const double* double_ = nullptr;
    vtkSmartPointer<vtkDoubleArray> doubles_;
};

/// What stands at each point beside its place.
struct PointColumns {
    vtkDataArray* normals = nullptr;
    std::vector<vtkDataArray*> values{};
};

PointColumns columns_of(vtkPolyData* surface) {
    vtkPointData* const data = surface->GetPointData();
    PointColumns columns{.normals = data->GetNormals()};
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        vtkDataArray* const array = data->GetArray(i);
        if (array == nullptr || array == columns.normals) continue;
        if (array->GetNumberOfComponents() == 1) columns.values.push_back(array);
    }
    return columns;
}

/// A name of one word, as PLY wants it.
std::string word_of(const char* name) {
    std::string word = name == nullptr ? "value" : name;
    for (char& c : word) {
        if (std::isspace(static_cast<unsigned char>(c)) != 0) c = '_';
    }
    return word.empty() ? "value" : word;
}

/// The texts of the field data, such as the unit of length, as comments.
std::string comments_on(vtkPolyData* surface) {
    std::string comments;
    vtkFieldData* const data = surface->GetFieldData();
    for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
        const auto* text = vtkStringArray::SafeDownCast(data->GetAbstractArray(i));
        if (text == nullptr || text->GetNumberOfValues() == 0) continue;
        comments += "comment " + word_of(data->GetArrayName(i)) + " " +
                    const_cast<vtkStringArray*>(text)->GetValue(0) + "\n";
    }
    return comments;
}

std::string header_of(vtkPolyData* surface, const PointColumns& columns, bool single) {
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment nestgrid\n";
    header += comments_on(surface);
    header += "element vertex " + std::to_string(surface->GetNumberOfPoints()) + "\n";
    for (const char* axis : {"x", "y", "z"}) {
        header += std::string("property ") + (single ? "float " : "double ") + axis + "\n";
    }
    if (columns.normals != nullptr) {
        header += "property float nx\nproperty float ny\nproperty float nz\n";
    }
    for (vtkDataArray* const array : columns.values) {
        header += "property double " + word_of(array->GetName()) + "\n";
    }
    header += "element face " + std::to_string(surface->GetNumberOfPolys()) +
              "\nproperty list uchar int vertex_indices\n";
    vtkIdType segments = 0;
    if (surface->GetNumberOfLines() > 0) {
        segments = surface->GetLines()->GetNumberOfConnectivityIds() - surface->GetNumberOfLines();
        header += "element edge " + std::to_string(segments) +
                  "\nproperty int vertex1\nproperty int vertex2\n";
    }
    return header + "end_header\n";
}

void put_points(vtkPolyData* surface, const PointColumns& columns, bool single, Rows& rows) {
    const Numbers points(surface->GetPoints()->GetData());
    const bool has_normals = columns.normals != nullptr;
    const Numbers normals(has_normals ? columns.normals : surface->GetPoints()->GetData());
    const std::vector<Numbers> values(columns.values.begin(), columns.values.end());
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
        rows.begin(6 * sizeof(double) + values.size() * sizeof(double));
        for (vtkIdType d = 3 * i; d < 3 * i + 3; ++d) {
            single ? rows.put(static_cast<float>(points[d])) : rows.put(points[d]);
        }
        for (vtkIdType d = 3 * i; has_normals && d < 3 * i + 3; ++d) {
            rows.put(static_cast<float>(normals[d]));
        }
        for (const Numbers& value : values) rows.put(value[i]);
    }
}

void put_cells(vtkPolyData* surface, Rows& rows) {
    for_each_cell(surface->GetPolys(), [&](auto corners) {
        rows.begin(1 + corners.size() * sizeof(std::int32_t));
        rows.put(static_cast<std::uint8_t>(corners.size()));
        for (const auto corner : corners) rows.put(static_cast<std::int32_t>(corner));
        return true;
    });
    for_each_cell(surface->GetLines(), [&](auto line) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            rows.begin(2 * sizeof(std::int32_t));
            rows.put(static_cast<std::int32_t>(line[i - 1]));
            rows.put(static_cast<std::int32_t>(line[i]));
        }
        return true;
    });
}

std::string write_ply(vtkPolyData* surface, const std::filesystem::path& path,
                      const SurfaceEncoding& encoding) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    const bool single = !encoding.doubles && single_keeps_edges(surface);
    const PointColumns columns = columns_of(surface);
    file << header_of(surface, columns, single);
    Rows rows(file);
    put_points(surface, columns, single, rows);
    put_cells(surface, rows);
    rows.flush();
    file.close();
    return file ? "" : std::strerror(errno == 0 ? EIO : errno);
}

const RegisteredFormat ply({.name = "PLY",
                            .endings = {".ply"},
                            .holds = "triangles, lines, normals and values",
                            .has_doubles = true,
                            .write_surface = write_ply});

}  // namespace
