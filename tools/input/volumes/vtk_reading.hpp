// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reading a file with VTK: its errors, its header checked before its samples, their geometry.
#pragma once

#include <filesystem>

#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include "input/volumes/file_samples.hpp"
#include "input/vtk_errors.hpp"

/// A reader of VTK at work on a file. What it would print becomes an exception.
class VtkReading {
public:
    explicit VtkReading(std::filesystem::path path) : path_{std::move(path)} {}

    void listen(vtkAlgorithm* reader) const;
    /// Reads the header; what it asks for must be plausible for the size of the file.
    /// \return the number of samples
    std::uintmax_t read_header(vtkAlgorithm* reader) const;
    vtkSmartPointer<vtkImageData> read_samples(vtkAlgorithm* reader) const;

private:
    void check() const;

    std::filesystem::path path_;
    vtkSmartPointer<ErrorCollector> errors_ = vtkSmartPointer<ErrorCollector>::New();
};

/// Takes the numbers of an array as those of the file; its tuples must be as many as the samples of
/// the geometry.
void set_numbers(FileSamples& samples, vtkDataArray* array);
/// Takes the place of an image in space.
void set_geometry(FileSamples& samples, vtkImageData* image);
