// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/hdf5/hdf5_reading.hpp"

#include <array>
#include <fstream>

#include <nestgrid/error.hpp>

#include "input/child_process.hpp"

namespace {

using nestgrid::InvalidInput;

/// A type in memory for numbers of a file's type: numbers themselves, or compounds of them.
/// \return the type and how many numbers there are in one
std::pair<Hdf5, std::size_t> type_in_memory(const Hdf5& type, hid_t number, const char* name) {
    if (H5Tget_class(type.id()) != H5T_COMPOUND) return {Hdf5(H5Tcopy(number), name), 1};
    const int members = H5Tget_nmembers(type.id());
    if (members < 1 || members > 64) throw InvalidInput(std::string(name) + " has no numbers");
    const std::size_t size = H5Tget_size(number);
    Hdf5 compound(H5Tcreate(H5T_COMPOUND, size * static_cast<std::size_t>(members)), name);
    for (int m = 0; m < members; ++m) {
        char* const member = H5Tget_member_name(type.id(), static_cast<unsigned>(m));
        H5Tinsert(compound.id(), member, size * static_cast<std::size_t>(m), number);
        H5free_memory(member);
    }
    return {std::move(compound), static_cast<std::size_t>(members)};
}

std::size_t count_of(const Hdf5& space) {
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    return count < 0 ? 0 : static_cast<std::size_t>(count);
}

template <class Number>
std::vector<Number> attribute_of(hid_t object, const std::string& name, hid_t number) {
    const std::string what = "the attribute '" + name + "'";
    const Hdf5 attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), what);
    const Hdf5 type(H5Aget_type(attribute.id()), what);
    const Hdf5 space(H5Aget_space(attribute.id()), what);
    const auto [memory, each] = type_in_memory(type, number, what.c_str());
    std::vector<Number> all(count_of(space) * each);
    if (all.empty() || H5Aread(attribute.id(), memory.id(), all.data()) < 0) {
        throw InvalidInput(what + " has no numbers");
    }
    return all;
}

/// The texts of an attribute or a data set.
/// \param read(type, out) reads all of them, as they are in the file
template <class Read>
std::vector<std::string> texts_in(const Hdf5& type, const Hdf5& space, const std::string& what,
                                  const Read& read) {
    if (H5Tget_class(type.id()) != H5T_STRING) throw InvalidInput(what + " is no text");
    std::vector<std::string> all(count_of(space));
    if (H5Tis_variable_str(type.id()) > 0) {
        std::vector<char*> pointers(all.size());
        if (read(type.id(), pointers.data()) < 0) pointers.clear();
        for (std::size_t i = 0; i < pointers.size(); ++i) {
            if (pointers[i] != nullptr) all[i] = pointers[i];
            H5free_memory(pointers[i]);
        }
        return all;
    }
    const std::size_t length = H5Tget_size(type.id());
    std::vector<char> letters(length * all.size());
    if (read(type.id(), letters.data()) < 0) letters.assign(letters.size(), 0);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string padded(letters.data() + i * length, length);
        all[i] = padded.substr(0, padded.find('\0'));
        all[i].erase(all[i].find_last_not_of(' ') + 1);
    }
    return all;
}

}  // namespace

Hdf5::Hdf5(hid_t id, const std::string& what) : id_{id} {
    if (id < 0) throw InvalidInput("it has not " + what);
}

Hdf5 Hdf5::at(const std::string& name) const {
    return {H5Oopen(id_, name.c_str(), H5P_DEFAULT), "'" + name + "'"};
}

std::vector<std::string> Hdf5::data_sets() const {
    std::vector<std::string> names;
    const auto add = [](hid_t, const char* name, const H5L_info_t*, void* all) -> herr_t {
        static_cast<std::vector<std::string>*>(all)->emplace_back(name);
        return 0;
    };
    H5Literate(id_, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
    std::erase_if(names, [&](const std::string& name) {
        const hid_t object = H5Oopen(id_, name.c_str(), H5P_DEFAULT);
        const bool is_data = object >= 0 && H5Iget_type(object) == H5I_DATASET;
        if (object >= 0) H5Idec_ref(object);
        return !is_data;
    });
    return names;
}

bool Hdf5::has(const std::string& name) const {
    return H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5::has_attribute(const std::string& name) const { return H5Aexists(id_, name.c_str()) > 0; }

std::vector<int> Hdf5::integers(const std::string& attribute) const {
    return attribute_of<int>(id_, attribute, H5T_NATIVE_INT);
}

std::vector<double> Hdf5::numbers(const std::string& attribute) const {
    return attribute_of<double>(id_, attribute, H5T_NATIVE_DOUBLE);
}

std::vector<std::string> Hdf5::texts(const std::string& name) const {
    const std::string what = "the attribute '" + name + "'";
    const Hdf5 attribute(H5Aopen(id_, name.c_str(), H5P_DEFAULT), what);
    return texts_in(Hdf5(H5Aget_type(attribute.id()), what),
                    Hdf5(H5Aget_space(attribute.id()), what), what,
                    [&](hid_t type, void* out) { return H5Aread(attribute.id(), type, out); });
}

std::vector<std::string> Hdf5::all_texts() const {
    const std::string what = "a data set of texts";
    return texts_in(Hdf5(H5Dget_type(id_), what), Hdf5(H5Dget_space(id_), what), what,
                    [&](hid_t type, void* out) {
                        return H5Dread(id_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
                    });
}

std::vector<hsize_t> Hdf5::shape() const {
    const Hdf5 space(H5Dget_space(id_), "data");
    std::vector<hsize_t> sizes(
        static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.id()))));
    if (!sizes.empty()) H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
    return sizes;
}

bool Hdf5::is_double() const {
    const Hdf5 type(H5Dget_type(id_), "data");
    return H5Tget_class(type.id()) != H5T_FLOAT || H5Tget_size(type.id()) > sizeof(float);
}

std::vector<std::int64_t> Hdf5::all_integers() const {
    const Hdf5 type(H5Dget_type(id_), "data");
    const Hdf5 space(H5Dget_space(id_), "data");
    const auto [memory, each] = type_in_memory(type, H5T_NATIVE_INT64, "a data set");
    std::vector<std::int64_t> all(count_of(space) * each);
    if (!all.empty() && H5Dread(id_, memory.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) {
        throw InvalidInput("a data set of whole numbers cannot be read");
    }
    return all;
}

void Hdf5::read(const std::vector<hsize_t>& from, const std::vector<hsize_t>& count, bool is_double,
                void* out) const {
    const Hdf5 space(H5Dget_space(id_), "data");
    const std::vector<hsize_t> sizes = shape();
    bool fits = sizes.size() == from.size() && sizes.size() == count.size();
    for (std::size_t d = 0; fits && d < sizes.size(); ++d) {
        fits = from[d] <= sizes[d] && count[d] <= sizes[d] - from[d];
    }
    if (!fits) throw InvalidInput("a data set has fewer numbers than its boxes need");
    const Hdf5 memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                      "data");
    if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, from.data(), nullptr, count.data(),
                            nullptr) < 0 ||
        H5Dread(id_, is_double ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT, memory.id(), space.id(),
                H5P_DEFAULT, out) < 0) {
        throw InvalidInput("the numbers of a data set cannot be read: it is damaged");
    }
}

Hdf5 open_hdf5(const std::filesystem::path& path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) throw InvalidInput("it is no HDF5 file, or a damaged one");
    return {file, "HDF5"};
}

Hdf5Kind hdf5_kind(const std::filesystem::path& path) {
    std::array<char, 8> start{};
    std::ifstream(path, std::ios::binary).read(start.data(), start.size());
    if (std::string_view(start.data(), start.size()) != "\x89HDF\r\n\x1a\n") return Hdf5Kind::none;
    try {
        return run_apart(path.string(), 60,
                         [&](Parcel& out) {
                             const Hdf5 file = open_hdf5(path);
                             Hdf5Kind kind = Hdf5Kind::none;
                             if (file.has("gid") && file.has("unknown names")) {
                                 kind = Hdf5Kind::flash;
                             }
                             if (file.has_attribute("MeshBlockSize")) kind = Hdf5Kind::athena;
                             if (file.has("Chombo_global")) kind = Hdf5Kind::chombo;
                             out.put(std::span<const Hdf5Kind>(&kind, 1));
                         })
            ->block<Hdf5Kind>(0)
            .front();
    } catch (const nestgrid::IoError&) {
        return Hdf5Kind::none;  // a damaged file
    }
}
