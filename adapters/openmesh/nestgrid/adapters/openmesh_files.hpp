// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces from files. OpenMesh's readers parse them, but what they find goes straight into the
// coarse grid. Consequence: no face is lost or torn off, so that an edge of three faces and a
// Moebius strip are there for check_and_orient() to find.
#pragma once

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <nestgrid/adapters/openmesh_importer.hpp>

namespace nestgrid {

namespace detail {

/// OpenMesh prints what it thinks of a file; not while this lives.
class OpenMeshSilence {
public:
    OpenMeshSilence() {
        for (OpenMesh::mostream* s : streams_) s->disable();
    }
    ~OpenMeshSilence() {
        for (std::size_t i = 0; i < streams_.size(); ++i) {
            if (enabled_[i]) streams_[i]->enable();
        }
    }
    OpenMeshSilence(const OpenMeshSilence&) = delete;
    OpenMeshSilence& operator=(const OpenMeshSilence&) = delete;

private:
    std::array<OpenMesh::mostream*, 2> streams_{&omerr(), &omlog()};
    std::array<bool, 2> enabled_{omerr().is_enabled(), omlog().is_enabled()};
};

/// An STL file is binary if it has 84 bytes and 50 for each of the triangles it declares, and a
/// complete text if its last line starts with "endsolid".
inline bool is_binary_stl(const SurfaceImporter& importer, const std::string& content) {
    const bool text = content.compare(content.find_first_not_of(" \t\r\n"), 5, "solid") == 0;
    if (content.size() >= 84) {
        std::uint32_t triangles = 0;
        std::memcpy(&triangles, content.data() + 80, sizeof triangles);
        const std::size_t size = 84 + 50 * std::size_t{triangles};
        if (content.size() == size || (!text && content.size() > size)) return true;
    }
    const std::size_t end = content.find_last_not_of(" \t\r\n");
    const std::size_t line = content.find_last_of('\n', end) + 1;
    const std::size_t word = content.find_first_not_of(" \t", line);
    if (!text || content.compare(word, 8, "endsolid") != 0) throw importer.truncated();
    return false;
}

/// OpenMesh's reader of .ply believes every word of a header, and looks for its end for ever.
inline bool is_ply_header(const std::string& content) {
    static constexpr std::string_view types =
        " char uchar short ushort int uint float double int8 uint8 int16 uint16 int32 uint32 "
        "float32 float64 ";
    const auto is_type = [](const std::string& word) {
        return types.find(" " + word + " ") != std::string_view::npos;
    };
    std::istringstream lines(content);
    bool in_element = false;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::vector<std::string> word{std::istream_iterator<std::string>(words), {}};
        if (word.empty()) return false;
        const bool list = word.size() == 5 && word[1] == "list";
        if (word[0] == "end_header") return true;
        if (word[0] == "element") {
            if (word.size() != 3) return false;
            in_element = true;
        } else if (word[0] == "property") {
            if (!in_element || (word.size() != 3 && !list)) return false;
            if (!is_type(word[list ? 2 : 1]) || (list && !is_type(word[3]))) return false;
        } else if (word[0] != "ply" && word[0] != "format" && word[0] != "comment" &&
                   word[0] != "obj_info") {
            return false;
        }
    }
    return false;
}

}  // namespace detail

/// The triangles and quadrilaterals of a file .off, .obj, .ply or .stl. Vertices of an STL file at
/// equal coordinates are one. Coordinates have the precision of OpenMesh's readers, that of float.
/// The readers have a state: not to be called from two threads at a time.
/// \throw IoError for a file that is missing, empty, truncated or of another format
/// \throw InvalidInput for a surface without faces, with faces of other polygons, and with faces
///        that name a vertex which is not there
inline CoarseGrid read_surface(const std::string& path) {
    using namespace OpenMesh::IO;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw IoError("'" + path + "' cannot be opened");
    std::string content{std::istreambuf_iterator<char>(file), {}};
    if (content.find_first_not_of(" \t\r\n") == std::string::npos) {
        throw IoError("'" + path + "' is empty");
    }
    std::string ending = path.substr(std::min(path.rfind('.'), path.size()));
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::array<std::pair<std::string, BaseReader*>, 4> readers{{{".off", &OFFReader()},
                                                                      {".obj", &OBJReader()},
                                                                      {".ply", &PLYReader()},
                                                                      {".stl", &STLReader()}}};
    const auto reader = std::find_if(readers.begin(), readers.end(),
                                     [&](const auto& r) { return r.first == ending; });
    if (reader == readers.end()) {
        throw IoError("'" + path + "' is no .off, .obj, .ply or .stl");
    }

    detail::SurfaceImporter importer(path, content.size());
    const detail::OpenMeshSilence silence;
    // This also tells the readers of .off and .ply what the header says.
    if ((ending == ".ply" && !detail::is_ply_header(content)) ||
        !reader->second->can_u_read(path)) {
        throw IoError("'" + path + "' has no complete header of the format " + ending);
    }
    Options options;
    if (ending == ".stl" && detail::is_binary_stl(importer, content)) options += Options::Binary;
    std::istringstream stream(std::move(content));
    // These two read as much as the header declares, whether it is there or not.
    if (ending == ".off" || ending == ".ply") {
        stream.exceptions(std::ios::failbit | std::ios::badbit);
    }
    try {
        const bool parsed = reader->second->read(stream, importer, options);
        if (!parsed || !importer.complete()) throw importer.truncated();
    } catch (const std::ios_base::failure&) {
        throw importer.truncated();
    }
    if (importer.grid.element_count() == 0) throw InvalidInput("'" + path + "' has no faces");
    importer.grid.nodes = Coordinates(std::move(importer.points));
    return std::move(importer.grid);
}

}  // namespace nestgrid
