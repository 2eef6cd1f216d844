// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces from files. OpenMesh's readers parse them, but what they find goes straight into the
// coarse grid. Consequence: no face is lost or torn off, so that an edge of three faces and a
// Moebius strip are there for check_and_orient() to find.
#pragma once

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>

#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <nestgrid/adapters/openmesh_formats.hpp>
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
    if (ending == ".stl") {
        const detail::StlKind kind = detail::stl_kind(content);
        if (kind == detail::StlKind::incomplete) throw importer.truncated();
        if (kind == detail::StlKind::binary) options += Options::Binary;
    }
    if (ending == ".obj" && !detail::has_only_vertices(content)) throw importer.truncated();
    if (ending == ".off") content = detail::without_extras(content);
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
