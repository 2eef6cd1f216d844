// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes one volume to the folder given as .vti in every way that VTK knows (text, base64,
// appended; packed or not; either order of bytes; words of 32 or 64 bits) and in every type of
// samples, and each type's samples as bare bytes, least byte first.
#include <array>
#include <fstream>
#include <string>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkZLibDataCompressor.h>

namespace {

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

void write(vtkImageData* image, const std::string& path, int mode, bool base64, bool packed,
           bool big_endian, bool wide) {
    const vtkNew<vtkXMLImageDataWriter> writer;
    const vtkNew<vtkZLibDataCompressor> zlib;
    writer->SetInputData(image);
    writer->SetFileName(path.c_str());
    writer->SetDataMode(mode);
    writer->SetEncodeAppendedData(base64);
    writer->SetCompressor(packed ? zlib.Get() : nullptr);
    writer->SetBlockSize(4096);
    if (big_endian) writer->SetByteOrderToBigEndian();
    wide ? writer->SetHeaderTypeToUInt64() : writer->SetHeaderTypeToUInt32();
    writer->Write();
}

void write_all(vtkImageData* image, const std::string& name) {
    for (const bool packed : {false, true}) {
        for (const bool big_endian : {false, true}) {
            for (const bool wide : {false, true}) {
                const std::string way = name + (packed ? "_packed" : "_plain") +
                                        (big_endian ? "_big" : "_little") + (wide ? "64" : "32");
                const auto to = [&](const char* how) { return way + "_" + how + ".vti"; };
                using W = vtkXMLImageDataWriter;
                write(image, to("binary"), W::Binary, false, packed, big_endian, wide);
                write(image, to("raw"), W::Appended, false, packed, big_endian, wide);
                write(image, to("base64"), W::Appended, true, packed, big_endian, wide);
            }
        }
    }
    // The order of bytes says nothing about a text.
    write(image, name + "_text.vti", vtkXMLImageDataWriter::Ascii, false, false, true, false);
}

}  // namespace

int main(int, char** argv) {
    const std::string folder = std::string(argv[1]) + "/";
    for (const NamedType& type : types) {
        const vtkNew<vtkImageData> image;
        image->SetExtent(-2, 14, 3, 21, 0, 12);
        image->SetSpacing(0.5, 1, 2);
        image->SetOrigin(1, 2, 3);
        const vtkNew<vtkMatrix3x3> direction;
        direction->SetElement(0, 0, 0);
        direction->SetElement(0, 1, 1);
        direction->SetElement(1, 0, -1);
        direction->SetElement(1, 1, 0);
        image->SetDirectionMatrix(direction);
        image->AllocateScalars(type.vtk, 1);
        vtkDataArray* const scalars = image->GetPointData()->GetScalars();
        scalars->SetName("density");
        for (vtkIdType i = 0; i < scalars->GetNumberOfTuples(); ++i) {
            scalars->SetComponent(i, 0, static_cast<double>((i * 37) % 113));
        }
        const auto size =
            static_cast<std::streamsize>(scalars->GetDataTypeSize()) * scalars->GetNumberOfTuples();
        std::ofstream(folder + type.name + ".bytes", std::ios::binary)
            .write(static_cast<const char*>(scalars->GetVoidPointer(0)), size);
        // A vector field beside the scalars.
        const vtkNew<vtkImageData> with_vectors;
        with_vectors->DeepCopy(image);
        vtkDataArray* const vectors = vtkDataArray::CreateDataArray(VTK_FLOAT);
        vectors->SetName("velocity");
        vectors->SetNumberOfComponents(3);
        vectors->SetNumberOfTuples(scalars->GetNumberOfTuples());
        vectors->Fill(1);
        with_vectors->GetPointData()->AddArray(vectors);
        vectors->Delete();
        write_all(with_vectors, folder + type.name);
        if (type.vtk != VTK_FLOAT) continue;
        const vtkNew<vtkXMLImageDataWriter> writer;
        const vtkNew<vtkLZ4DataCompressor> lz4;
        writer->SetInputData(image);
        writer->SetFileName((folder + "lz4.vti").c_str());
        writer->SetCompressor(lz4);
        writer->Write();
    }
    return 0;
}
