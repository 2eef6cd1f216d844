// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Objects, attributes and data of HDF5 files. For child processes: the library may crash on damaged
// files.
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

/// An object of the library, closed in the end.
class Hdf5 {
public:
    /// \param what to be named in the sentence
    /// \throw nestgrid::InvalidInput for an identifier of a call that failed
    Hdf5(hid_t id, const std::string& what);
    Hdf5(const Hdf5&) = delete;
    Hdf5& operator=(const Hdf5&) = delete;
    Hdf5(Hdf5&& other) noexcept : id_{std::exchange(other.id_, -1)} {}
    ~Hdf5() {
        if (id_ >= 0) H5Idec_ref(id_);
    }
    hid_t id() const { return id_; }

    /// A group or a data set in this file or group.
    Hdf5 at(const std::string& name) const;
    /// The names of all data sets in it.
    std::vector<std::string> data_sets() const;
    bool has(const std::string& name) const;
    bool has_attribute(const std::string& name) const;

    /// The numbers of an attribute, those of compounds one behind the other.
    /// \throw nestgrid::InvalidInput where there is none, or it has no numbers
    std::vector<int> integers(const std::string& attribute) const;
    std::vector<double> numbers(const std::string& attribute) const;
    /// The first of them.
    int integer(const std::string& attribute) const { return integers(attribute).front(); }
    double number(const std::string& attribute) const { return numbers(attribute).front(); }
    /// The texts of an attribute.
    std::vector<std::string> texts(const std::string& attribute) const;

    // For data sets alone:
    std::vector<hsize_t> shape() const;
    bool is_double() const;  ///< not of floats
    /// All of its integers, those of compounds one behind the other.
    std::vector<std::int64_t> all_integers() const;
    /// All of its texts, without blanks at their ends.
    std::vector<std::string> all_texts() const;
    /// Its numbers from a place on, so many in each direction, to `out`: floats or doubles.
    void read(const std::vector<hsize_t>& from, const std::vector<hsize_t>& count, bool is_double,
              void* out) const;

private:
    hid_t id_;
};

/// \throw nestgrid::InvalidInput where the file is none of HDF5
Hdf5 open_hdf5(const std::filesystem::path& path);

/// What a file is by the names in it.
enum class Hdf5Kind : int { none, athena, chombo, flash };
/// Looks into it in a child process, unless its first bytes say that it is no HDF5.
Hdf5Kind hdf5_kind(const std::filesystem::path& path);
