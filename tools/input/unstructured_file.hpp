// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is in files of unstructured grids. VTK reads them in a child process.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <nestgrid/adapters/lagrange_cells.hpp>

#include "input/child_process.hpp"
#include "input/frame_files.hpp"

/// An array of points in a file.
struct PointArray {
    std::array<char, 256> name;
    int components;
    std::array<double, 2> range;  ///< of the first component
};

/// Which values are wanted of a file.
struct WantedValues {
    std::string array;  ///< empty: the only one
    int component = -1;
    std::string by{};  ///< another array that the values of are wanted, if there is such a one
};

/// A file that has been read: one grid, or the pieces of several processes as one.
class UnstructuredFile {
public:
    /// \param wanted nothing: arrays are told without their values
    /// \param seconds within which it is read; 0 for as many as its size asks for
    /// \throw nestgrid::IoError where it cannot be read
    /// \throw nestgrid::InvalidInput for an array that is not there, or has several components
    UnstructuredFile(const std::filesystem::path& path, double seconds,
                     const std::optional<WantedValues>& wanted);

    nestgrid::CellArrays cells() const;
    std::span<const PointArray> arrays() const;
    /// The values at points, and the name of their array.
    std::span<const double> values() const;
    std::string name() const;
    /// Those of the array that colours; empty where the file has none of this name.
    std::span<const double> by() const;
    /// As the file tells it, by the names of VTK or deal.II.
    std::optional<double> time() const;

private:
    std::shared_ptr<const Parcel> parcel_;
};

/// The data sets that a .pvd file lists, each with its time.
struct PvdSets {
    Paths paths;
    std::vector<double> times;
};

/// \throw nestgrid::IoError where it cannot be read
/// \throw nestgrid::InvalidInput where it lists no files, or several of one time
PvdSets read_pvd(const std::filesystem::path& path);
