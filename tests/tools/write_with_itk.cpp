// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes a volume with ITK's writers of images. Arguments: the file to write, a file of bare
// samples, their type (float or short), how many components each has, "packed" or "plain", and four
// lists of numbers, one number or vector an axis: samples, spacings, origin and axes.
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace {

std::vector<double> numbers(const std::string& list) {
    std::istringstream text(list);
    return {std::istream_iterator<double>(text), {}};
}

itk::ImageIOBase::Pointer writer_of(const std::string& path) {
    if (path.ends_with(".mha") || path.ends_with(".mhd"))
        return itk::MetaImageIO::New().GetPointer();
    if (path.ends_with(".nrrd") || path.ends_with(".nhdr"))
        return itk::NrrdImageIO::New().GetPointer();
    return itk::NiftiImageIO::New().GetPointer();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 10) return 2;
    const std::string path = argv[1];
    std::ifstream file(argv[2], std::ios::binary);
    const std::string samples((std::istreambuf_iterator<char>(file)), {});
    const auto components = static_cast<unsigned>(std::atoi(argv[4]));
    const auto sizes = numbers(argv[6]);
    const auto spacings = numbers(argv[7]);
    const auto origin = numbers(argv[8]);
    const auto axes = numbers(argv[9]);
    const auto n = static_cast<unsigned>(sizes.size());

    const itk::ImageIOBase::Pointer writer = writer_of(path);
    writer->SetFileName(path);
    writer->SetNumberOfDimensions(n);
    itk::ImageIORegion all(n);
    for (unsigned d = 0; d < n; ++d) {
        writer->SetDimensions(d, static_cast<std::size_t>(sizes[d]));
        writer->SetSpacing(d, spacings[d]);
        writer->SetOrigin(d, origin[d]);
        writer->SetDirection(d, {axes.begin() + d * n, axes.begin() + (d + 1) * n});
        all.SetSize(d, static_cast<std::size_t>(sizes[d]));
    }
    writer->SetIORegion(all);
    writer->SetComponentType(std::string(argv[3]) == "short" ? itk::IOComponentEnum::SHORT
                                                             : itk::IOComponentEnum::FLOAT);
    writer->SetNumberOfComponents(components);
    writer->SetPixelType(components > 1 ? itk::IOPixelEnum::VECTOR : itk::IOPixelEnum::SCALAR);
    writer->SetUseCompression(std::string(argv[5]) == "packed");
    writer->WriteImageInformation();
    writer->Write(samples.data());
    return 0;
}
