// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A piece of VTK poly data as raw numbers, all of it or the part of one rank: what is before them
// and between them. mpi_files.hpp writes such pieces.
#pragma once

#include <array>
#include <bit>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>

#include <nestgrid/algorithms/join_pieces.hpp>

namespace nestgrid::detail {

/// An array of a file of VTK: numbers of some points, or of some cells.
struct VtkArray {
    std::string name;
    const char* type;        ///< VTK's name of its numbers
    std::size_t components;  ///< of each tuple
    Ranks::Bytes bytes;      ///< of this rank
    std::uint64_t first;     ///< bytes of lesser ranks
    std::uint64_t all;       ///< bytes of all ranks
};

template <class T>
Ranks::Bytes bytes_of(const std::vector<T>& numbers) {
    const auto bytes = std::as_bytes(std::span(numbers));
    return {bytes.begin(), bytes.end()};
}

/// VTK's name for the numbers of points in all pieces.
inline constexpr const char* global_ids = "GlobalPointIds";

/// All arrays of a piece of VTK poly data.
struct VtkPiece {
    std::uint64_t points = 0;
    std::uint64_t simplices = 0;
    int dimension = 3;
    VtkArray position;
    VtkArray connectivity;
    VtkArray offsets;
    std::vector<VtkArray> of_points;  ///< attributes, normals, numbers
};

/// Makes the arrays of some vertices and of all simplices of a piece.
template <int dimension>
class VtkPieceMaker {
public:
    /// \param vertices those of the piece that are written, in their order
    /// \param number by vertex of the piece: its number in the file
    VtkPieceMaker(const Surface<dimension>& surface, std::vector<std::uint32_t> vertices,
                  std::vector<std::int64_t> number)
        : surface_{&surface}, vertices_{std::move(vertices)}, number_{std::move(number)} {}

    /// \param components of the attributes of a vertex, also where this piece is empty
    VtkPiece make(std::size_t components, bool normals, std::uint64_t first_point,
                  std::uint64_t points, std::uint64_t first_simplex, std::uint64_t simplices) {
        VtkPiece piece;
        piece.points = points;
        piece.simplices = simplices;
        piece.dimension = dimension;
        const auto of_points = [&](std::string name, std::size_t count, std::vector<double> own) {
            return VtkArray{std::move(name),         "Float64",         count, bytes_of(own),
                            8 * count * first_point, 8 * count * points};
        };
        const auto of_cells = [&](const char* name, std::size_t count,
                                  std::vector<std::int64_t> own) {
            return VtkArray{
                name, "Int64", 1, bytes_of(own), 8 * count * first_simplex, 8 * count * simplices};
        };
        piece.position = of_points("Points", 3, coordinates(surface_->vertices));
        std::vector<std::int64_t> corners;
        std::vector<std::int64_t> ends;
        for (const auto& simplex : surface_->simplices) {
            for (const std::uint32_t v : simplex) corners.push_back(number_[v]);
            ends.push_back(
                static_cast<std::int64_t>(dimension * (first_simplex + ends.size() + 1)));
        }
        piece.connectivity = of_cells("connectivity", dimension, std::move(corners));
        piece.offsets = of_cells("offsets", 1, std::move(ends));
        for (std::size_t c = 0; c < components; ++c) {
            std::vector<double> own;
            for (const std::uint32_t v : vertices_) {
                own.push_back(surface_->attributes[v * components + c]);
            }
            piece.of_points.push_back(of_points("attribute " + std::to_string(c + 1), 1, own));
        }
        if (normals) {
            piece.of_points.push_back(of_points("Normals", 3, coordinates(surface_->normals)));
        }
        return piece;
    }

private:
    std::vector<double> coordinates(const std::vector<Point>& all) const {
        std::vector<double> own;
        if (all.empty()) return own;
        for (const std::uint32_t v : vertices_) own.insert(own.end(), all[v].begin(), all[v].end());
        return own;
    }

    const Surface<dimension>* surface_;
    std::vector<std::uint32_t> vertices_;
    std::vector<std::int64_t> number_;
};

/// The arrays of a piece in the order of the file, with the place of each behind its first byte.
inline std::vector<std::pair<const VtkArray*, std::uint64_t>> places_of(const VtkPiece& piece) {
    std::vector<const VtkArray*> all;
    for (const VtkArray& array : piece.of_points) all.push_back(&array);
    for (const VtkArray* array : {&piece.position, &piece.connectivity, &piece.offsets}) {
        all.push_back(array);
    }
    std::vector<std::pair<const VtkArray*, std::uint64_t>> places;
    std::uint64_t at = 0;
    for (const VtkArray* array : all) {
        places.emplace_back(array, at);
        at += sizeof(std::uint64_t) + array->all;
    }
    return places;
}

/// What is before the first byte of the arrays.
inline std::string header_of(const VtkPiece& piece) {
    std::ostringstream text;
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\""
         << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
         << "\" header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" << piece.points
         << "\" NumberOfVerts=\"0\" NumberOfLines=\""
         << (piece.dimension == 2 ? piece.simplices : 0)
         << "\" NumberOfStrips=\"0\" NumberOfPolys=\""
         << (piece.dimension == 3 ? piece.simplices : 0) << "\">\n";
    const auto places = places_of(piece);
    const auto put = [&](std::size_t i) {
        const VtkArray& array = *places[i].first;
        text << "<DataArray type=\"" << array.type << "\" Name=\"" << array.name
             << "\" NumberOfComponents=\"" << array.components << "\" format=\"appended\" offset=\""
             << places[i].second << "\"/>\n";
    };
    const std::size_t count = piece.of_points.size();
    const bool ids = count > 0 && places[0].first->name == global_ids;
    text << "<PointData" << (ids ? " GlobalIds=\"" + std::string(global_ids) + "\"" : "") << ">\n";
    for (std::size_t i = 0; i < count; ++i) put(i);
    text << "</PointData>\n<Points>\n";
    put(count);
    const char* const cells = piece.dimension == 2 ? "Lines" : "Polys";
    text << "</Points>\n<" << cells << ">\n";
    put(count + 1);
    put(count + 2);
    text << "</" << cells << ">\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    return text.str();
}
inline const char* end_of_vtk_file() { return "\n</AppendedData>\n</VTKFile>\n"; }

/// The piece of one rank, with the numbers of its vertices in the whole. VTK's mark 1 is that of a
/// point that another piece has as its own.
template <int dimension>
VtkPiece numbered_piece(int rank, const Surface<dimension>& surface, const JoinedPiece& joined) {
    const std::size_t vertices = surface.vertices.size();
    std::vector<std::uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0U);
    const std::size_t components = vertices == 0 ? 0 : surface.attributes.size() / vertices;
    VtkPiece piece =
        VtkPieceMaker(surface, all, std::vector<std::int64_t>(all.begin(), all.end()))
            .make(components, !surface.normals.empty(), 0, vertices, 0, surface.simplices.size());
    std::vector<std::uint8_t> copies;
    for (const int owner : joined.owner) copies.push_back(owner == rank ? 0 : 1);
    piece.of_points.insert(
        piece.of_points.begin(),
        {VtkArray{global_ids, "Int64", 1, bytes_of(joined.number), 0, 8 * vertices},
         VtkArray{"vtkGhostType", "UInt8", 1, bytes_of(copies), 0, vertices}});
    return piece;
}

inline void write_piece(std::ostream& out, const VtkPiece& piece) {
    out << header_of(piece);
    for (const auto& [array, at] : places_of(piece)) {
        out.write(reinterpret_cast<const char*>(&array->all), sizeof array->all);
        out.write(reinterpret_cast<const char*>(array->bytes.data()),
                  static_cast<std::streamsize>(array->bytes.size()));
    }
    out << end_of_vtk_file();
}

/// The list of the pieces.
/// \param columns a piece, for the names of its arrays
inline void write_list(std::ostream& out, const VtkPiece& columns,
                       const std::vector<std::string>& files) {
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PPolyData\" version=\"1.0\" "
           "header_type=\"UInt64\">\n<PPolyData GhostLevel=\"0\">\n<PPointData GlobalIds=\""
        << global_ids << "\">\n";
    const auto put = [&](const VtkArray& array) {
        out << "<PDataArray type=\"" << array.type << "\" Name=\"" << array.name
            << "\" NumberOfComponents=\"" << array.components << "\"/>\n";
    };
    for (const VtkArray& array : columns.of_points) put(array);
    out << "</PPointData>\n<PPoints>\n";
    put(columns.position);
    out << "</PPoints>\n";
    for (const std::string& file : files) out << "<Piece Source=\"" << file << "\"/>\n";
    out << "</PPolyData>\n</VTKFile>\n";
}

}  // namespace nestgrid::detail
