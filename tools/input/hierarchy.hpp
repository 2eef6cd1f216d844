// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hierarchies in files, and which families the program knows.
#pragma once

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/adapters/prism_grid.hpp>
#include <nestgrid/adapters/red_green.hpp>
#include <nestgrid/adapters/stored_file.hpp>

#include "input/input_file.hpp"

// What is compiled once for all families, in stored_families.cpp.
#define NESTGRID_STORED_FAMILY(prefix, ...)                                          \
    prefix template nestgrid::StoredHierarchy<__VA_ARGS__> nestgrid::read_hierarchy( \
        const std::filesystem::path&, nestgrid::Encoded);                            \
    prefix template void nestgrid::write_hierarchy(                                  \
        const nestgrid::StoredGrid<__VA_ARGS__>&, const std::filesystem::path&,      \
        const std::vector<nestgrid::NamedField>&, const nestgrid::StoredFileOptions&);
#define NESTGRID_STORED_FAMILIES(prefix)                     \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::Bisection<2>)   \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::Bisection<3>)   \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::RedGreen<2, 3>) \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::RedGreen<2, 4>) \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::RedGreen<3, 4>) \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::RedGreen<3, 8>) \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::Octree<2>)      \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::Octree<3>)      \
    NESTGRID_STORED_FAMILY(prefix, nestgrid::Prism)
NESTGRID_STORED_FAMILIES(extern)

/// Whether a file is called like a hierarchy.
bool is_hierarchy(const std::filesystem::path& path);

/// \throw nestgrid::IoError unless a file is called like a hierarchy
void require_hierarchy_name(const std::filesystem::path& path);

/// Calls function(StoredHierarchy<Family>&) with the hierarchy of a file.
/// \throw nestgrid::IoError for a file that holds none
template <class Function>
void with_hierarchy(const std::filesystem::path& path, Function&& function,
                    nestgrid::Encoded encoded = nestgrid::Encoded::decode) {
    using namespace nestgrid;
    require_file(path);
    const HierarchyHeader header = read_hierarchy_header(path);
    const auto tried = [&]<class Family>() {
        if (header.family != Family::name || header.dimension != Family::dimension ||
            header.corners != Family::max_corners) {
            return false;
        }
        auto stored = read_hierarchy<Family>(path, encoded);
        function(stored);
        return true;
    };
    if (tried.template operator()<Bisection<2>>() || tried.template operator()<Bisection<3>>() ||
        tried.template operator()<RedGreen<2, 3>>() ||
        tried.template operator()<RedGreen<2, 4>>() ||
        tried.template operator()<RedGreen<3, 4>>() ||
        tried.template operator()<RedGreen<3, 8>>() || tried.template operator()<Octree<2>>() ||
        tried.template operator()<Octree<3>>() || tried.template operator()<Prism>()) {
        return;
    }
    throw IoError("'" + path.string() +
                  "' holds a family this program does not know: " + header.family);
}

/// The field with a name, or null.
const nestgrid::NamedField* find_field(const std::vector<nestgrid::NamedField>& fields,
                                       const std::string& name);

/// The field with a name; an empty name stands for the only one.
/// \throw nestgrid::InvalidInput where there is none
const nestgrid::NamedField& field_named(const std::vector<nestgrid::NamedField>& fields,
                                        const std::string& name);

struct FieldInfo {
    std::string name;
    double least = INFINITY;  ///< of all frames
    double greatest = -INFINITY;
    std::optional<double> step{};  ///< of encoded values, 0 where they are kept bit for bit
    std::size_t bytes = 0;         ///< of all frames in the file
};

struct HierarchyInfo {
    std::string family;
    int dimension = 0;
    std::size_t coarse_elements = 0;
    std::size_t leaves = 0;
    std::map<nestgrid::Shape, std::size_t> shapes;  ///< of the leaves
    std::size_t nodes = 0;
    std::size_t hanging = 0;
    int levels = 0;
    double measure = 0;  ///< volume or area
    std::size_t bytes = 0;
    std::vector<double> times;  ///< of the frames
    std::vector<FieldInfo> fields;
};

HierarchyInfo hierarchy_info(const std::filesystem::path& path);
