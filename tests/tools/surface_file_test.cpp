// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is written into files of surfaces is what VTK reads from them, number by number.
#include <cmath>
#include <filesystem>
#include <string>
#include <tuple>

#include <unistd.h>

#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include "output/surface_file.hpp"

namespace {

namespace fs = std::filesystem;
using Compression = SurfaceEncoding::Compression;

/// The blocks of files have 2^20 bytes: columns of this many points have a whole number of them, or
/// end inside one.
constexpr vtkIdType whole_blocks = vtkIdType{1} << 18U;

template <class Array>
vtkSmartPointer<Array> numbers(const std::string& name, vtkIdType count, int components) {
    const auto array = vtkSmartPointer<Array>::New();
    array->SetName(name.c_str());
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(count);
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i) {
        array->SetComponent(i / components, static_cast<int>(i % components),
                            std::floor(1e6 * std::sin(static_cast<double>(i))));
    }
    return array;
}

/// Triangles of successive points in rows of 512, and a line, with data of each kind.
vtkSmartPointer<vtkPolyData> surface_of(vtkIdType points, bool wide) {
    const auto surface = vtkSmartPointer<vtkPolyData>::New();
    const vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    for (vtkIdType i = 0; i < points; ++i) {
        places->InsertNextPoint(static_cast<double>(i % 512) / 3, static_cast<double>(i / 512),
                                0.1);
    }
    surface->SetPoints(places);
    const vtkNew<vtkCellArray> polys;
    const vtkNew<vtkCellArray> lines;
    wide ? polys->Use64BitStorage() : polys->Use32BitStorage();
    for (vtkIdType i = 0; i + 2 < points; ++i) polys->InsertNextCell({i, i + 1, i + 2});
    if (points > 4) lines->InsertNextCell({0, 2, 4});
    surface->SetPolys(polys);
    surface->SetLines(lines);
    surface->GetPointData()->SetNormals(numbers<vtkFloatArray>("Normals", points, 3));
    surface->GetPointData()->AddArray(numbers<vtkDoubleArray>("a < \"b\" & c", points, 1));
    surface->GetCellData()->AddArray(
        numbers<vtkIntArray>("element", surface->GetNumberOfCells(), 1));
    describe(surface, "mm", "RAS", {{"density", 0.1}});
    return surface;
}

/// A file in a folder that vanishes with it.
class File {
public:
    explicit File(const std::string& name)
        : folder_{fs::temp_directory_path() / ("surface_file." + std::to_string(getpid()))},
          path_{folder_ / name} {
        fs::create_directory(folder_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { fs::remove_all(folder_); }
    const fs::path& path() const { return path_; }

private:
    fs::path folder_;
    fs::path path_;
};

/// \param rounded whether numbers may have been rounded to single precision
void expect_equal(vtkDataArray* a, vtkDataArray* b, bool rounded) {
    ASSERT_NE(a, nullptr);
    ASSERT_NE(b, nullptr);
    ASSERT_EQ(a->GetNumberOfTuples(), b->GetNumberOfTuples());
    ASSERT_EQ(a->GetNumberOfComponents(), b->GetNumberOfComponents());
    vtkIdType different = 0;
    for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i) {
        for (int c = 0; c < a->GetNumberOfComponents(); ++c) {
            const double x = a->GetComponent(i, c);
            const double kept = rounded ? static_cast<double>(static_cast<float>(x)) : x;
            different += kept == b->GetComponent(i, c) ? 0 : 1;
        }
    }
    EXPECT_EQ(different, 0);
}

void expect_equal_cells(vtkCellArray* a, vtkCellArray* b) {
    ASSERT_EQ(a->GetNumberOfCells(), b->GetNumberOfCells());
    if (a->GetNumberOfCells() == 0) return;
    expect_equal(a->GetOffsetsArray(), b->GetOffsetsArray(), false);
    expect_equal(a->GetConnectivityArray(), b->GetConnectivityArray(), false);
}

class Vtp : public testing::TestWithParam<std::tuple<vtkIdType, Compression, bool>> {};

TEST_P(Vtp, IsReadByVtkAsItWasWritten) {
    const auto& [points, compression, doubles] = GetParam();
    const auto surface = surface_of(points, doubles);
    const File file("s.vtp");
    write_surface(surface, file.path(), {compression, doubles});

    const vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file.path().c_str());
    reader->Update();
    ASSERT_EQ(reader->GetErrorCode(), 0U);
    vtkPolyData* const read = reader->GetOutput();
    ASSERT_EQ(read->GetNumberOfPoints(), points);
    if (points > 0) {
        vtkDataArray* const places = read->GetPoints()->GetData();
        EXPECT_EQ(places->GetDataType(), doubles ? VTK_DOUBLE : VTK_FLOAT);
        expect_equal(surface->GetPoints()->GetData(), places, !doubles);
    }
    expect_equal_cells(surface->GetPolys(), read->GetPolys());
    expect_equal_cells(surface->GetLines(), read->GetLines());
    for (const char* const name : {"Normals", "a < \"b\" & c"}) {
        expect_equal(surface->GetPointData()->GetArray(name), read->GetPointData()->GetArray(name),
                     false);
    }
    EXPECT_NE(read->GetPointData()->GetNormals(), nullptr);
    expect_equal(surface->GetCellData()->GetArray("element"),
                 read->GetCellData()->GetArray("element"), false);
    vtkFieldData* const facts = read->GetFieldData();
    expect_equal(surface->GetFieldData()->GetArray("density"), facts->GetArray("density"), false);
    auto* const unit = vtkStringArray::SafeDownCast(facts->GetAbstractArray("length_unit"));
    ASSERT_NE(unit, nullptr);
    EXPECT_EQ(unit->GetValue(0), "mm");
}

INSTANTIATE_TEST_SUITE_P(
    EachEncoding, Vtp,
    testing::Combine(testing::Values(0, 2, 7, whole_blocks, whole_blocks + 1000),
                     testing::Values(Compression::none, Compression::lz4, Compression::zlib),
                     testing::Bool()));

TEST(Ply, IsReadByVtkAsItWasWritten) {
    const auto surface = surface_of(whole_blocks + 1000, false);
    surface->SetLines(nullptr);
    const File file("s.ply");
    write_surface(surface, file.path(), {});

    const vtkNew<vtkPLYReader> reader;
    reader->SetFileName(file.path().c_str());
    reader->Update();
    expect_equal(surface->GetPoints()->GetData(), reader->GetOutput()->GetPoints()->GetData(),
                 true);
    expect_equal(surface->GetPointData()->GetNormals(),
                 reader->GetOutput()->GetPointData()->GetNormals(), false);
    expect_equal_cells(surface->GetPolys(), reader->GetOutput()->GetPolys());
}

}  // namespace
