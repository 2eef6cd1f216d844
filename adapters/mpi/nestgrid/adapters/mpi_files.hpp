// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files of a surface in pieces (join_pieces.hpp), as VTK poly data with raw numbers:
//   - write_vtp(): one file, as one process would write it, up to order. Each rank writes its own
//     triangles and the vertices that it owns, at their places, by collective writes of MPI-IO;
//   - write_pvtp(): a file a rank and a list of these. VTK does not weld them: vertices have their
//     global numbers, and those that another rank owns are marked as duplicates.
// Ranks without triangles write nothing, and are in no list.
//
// A file has its name once it is whole: before, it ends in ".part". Where a rank cannot write,
// nothing is left of any file, on any rank. All functions are collective.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include <nestgrid/adapters/mpi.hpp>
#include <nestgrid/adapters/vtk_pieces.hpp>

namespace nestgrid {

namespace detail {

/// Ends all ranks alike where one of them could not write.
/// \param failed what is wrong on this rank, or nothing
///
/// \throw IoError
inline void require_written(Ranks& ranks, const std::string& failed) {
    const auto bytes = std::as_bytes(std::span(failed));
    const std::vector<Ranks::Bytes> all = ranks.gather({bytes.begin(), bytes.end()});
    for (std::size_t r = 0; r < all.size(); ++r) {
        if (all[r].empty()) continue;
        throw IoError("rank " + std::to_string(r) + ": " +
                      std::string(reinterpret_cast<const char*>(all[r].data()), all[r].size()));
    }
}

/// A file that all ranks write.
class MpiFile {
public:
    MpiFile(MpiRanks& ranks, std::string path) : ranks_{&ranks}, path_{std::move(path)} {
        note(MPI_File_open(ranks.communicator(), part().c_str(), MPI_MODE_CREATE | MPI_MODE_WRONLY,
                           MPI_INFO_NULL, &file_),
             "opened");
        std::uint64_t fails = failed_.empty() ? 0 : 1;
        ranks.reduce(std::span(&fails, 1), Ranks::Reduction::max);
        if (fails != 0) {
            file_ = MPI_FILE_NULL;  // closing is for all ranks, and some have nothing to close
            return;
        }
        note(MPI_File_set_size(file_, 0), "emptied");  // of what a run that died has left
    }
    MpiFile(const MpiFile&) = delete;
    MpiFile& operator=(const MpiFile&) = delete;

    /// Writes bytes at a place. Collective.
    void write(std::uint64_t at, std::span<const std::byte> bytes) {
        std::uint64_t rounds = (bytes.size() + most_ - 1) / most_;
        ranks_->reduce(std::span(&rounds, 1), Ranks::Reduction::max);
        for (std::uint64_t i = 0; i < rounds; ++i) {
            const auto part = bytes.subspan(std::min<std::size_t>(i * most_, bytes.size()));
            const auto count = static_cast<int>(std::min<std::size_t>(part.size(), most_));
            if (file_ == MPI_FILE_NULL) continue;
            MPI_Status status;
            note(MPI_File_write_at_all(file_, static_cast<MPI_Offset>(at + i * most_), part.data(),
                                       count, MPI_BYTE, &status),
                 "written");
            int written = count;
            MPI_Get_count(&status, MPI_BYTE, &written);
            if (written != count) note(MPI_ERR_NO_SPACE, "written");
        }
    }
    /// Gives the file its name where all is written.
    /// \param bytes of the whole
    ///
    /// \throw IoError on all ranks alike; nothing is left of the file then
    void close(std::uint64_t bytes) {
        if (file_ != MPI_FILE_NULL) note(MPI_File_close(&file_), "closed");
        try {
            require_written(*ranks_, failed_);
            require_written(*ranks_, ranks_->rank() == 0 ? name_whole(bytes) : std::string{});
        } catch (const IoError&) {
            if (ranks_->rank() == 0) std::remove(part().c_str());
            throw;
        }
    }

private:
    static constexpr std::size_t most_ = std::size_t{1} << 28U;  // bytes of a write at most

    std::string part() const { return path_ + ".part"; }
    void note(int code, const char* what) {
        if (code == MPI_SUCCESS || !failed_.empty()) return;
        std::array<char, MPI_MAX_ERROR_STRING> text{};
        int length = 0;
        MPI_Error_string(code, text.data(), &length);
        failed_ = "'" + path_ + "' could not be " + what + ": " + text.data();
    }

    /// Gives the file its name. The size shows what ranks wrote only after all have closed it: a
    /// collective write may return before those of other ranks have ended.
    /// \return what is wrong, or nothing
    std::string name_whole(std::uint64_t bytes) const {
        std::error_code failed;
        if (std::filesystem::file_size(part(), failed) != bytes || failed) {
            return "'" + path_ + "' could not be written whole: is there space left?";
        }
        std::filesystem::rename(part(), path_, failed);
        return failed ? "'" + path_ + "' could not be given its name" : "";
    }

    MpiRanks* ranks_;
    std::string path_;
    MPI_File file_ = MPI_FILE_NULL;
    std::string failed_;
};

/// A file that a rank writes alone. Nothing is left of it unless keep() is called.
class OwnFile {
public:
    explicit OwnFile(std::string path) : path_{std::move(path)}, now_{path_ + ".part"} {}
    OwnFile(const OwnFile&) = delete;
    OwnFile& operator=(const OwnFile&) = delete;
    ~OwnFile() {
        if (!kept_) std::remove(now_.c_str());
    }

    /// \return what is wrong, or nothing
    template <class Write>
    std::string write(const Write& write) {
        std::ofstream out(now_, std::ios::binary);
        write(out);
        out.close();
        return out ? "" : "'" + path_ + "' could not be written";
    }
    /// Gives the file its name. \return what is wrong, or nothing
    std::string name() {
        if (std::rename(now_.c_str(), path_.c_str()) != 0) {
            return "'" + path_ + "' could not be given its name";
        }
        now_ = path_;
        return {};
    }
    void keep() { kept_ = true; }

private:
    std::string path_;
    std::string now_;  // the name that it has
    bool kept_ = false;
};

/// What all pieces have alike.
struct VtkColumns {
    std::size_t components;
    bool normals;
};

/// \throw InvalidInput on all ranks where `joined` is of another piece on some rank, or of another
///        number of ranks
template <int dimension>
VtkColumns columns_of(Ranks& ranks, const Surface<dimension>& surface, const JoinedPiece& joined) {
    if (joined.ranks != ranks.size()) {
        throw InvalidInput("the pieces are those of " + std::to_string(joined.ranks) +
                           " ranks, but the communicator that writes them has " +
                           std::to_string(ranks.size()) + " processes");
    }
    const std::size_t vertices = surface.vertices.size();
    std::array<std::uint64_t, 3> all{
        vertices == 0 ? 0 : surface.attributes.size() / vertices,
        surface.normals.empty() ? std::uint64_t{0} : std::uint64_t{1},
        joined.number.size() == vertices ? std::uint64_t{0} : std::uint64_t{1}};
    ranks.reduce(all, Ranks::Reduction::max);
    if (all[2] != 0) throw InvalidInput("join_pieces() numbered another piece than is written");
    return {static_cast<std::size_t>(all[0]), all[1] != 0};
}

}  // namespace detail

/// Writes the pieces of a surface as one file, and removes nothing but a file of that name.
/// \param piece of this rank, an Isosurface, a slice or a Shading, as join_pieces() numbered it
///
/// \throw IoError on all ranks alike, with the number of a rank that could not write
template <class Piece>
void write_vtp(MpiRanks& ranks, const Piece& piece, const JoinedPiece& joined,
               const std::string& path) {
    const auto& surface = piece.surface;
    const detail::VtkColumns columns = detail::columns_of(ranks, surface, joined);
    std::vector<std::uint32_t> own;
    for (std::uint32_t v = 0; v < joined.owner.size(); ++v) {
        if (joined.owner[v] == ranks.rank()) own.push_back(v);
    }
    const std::vector<std::int64_t> number(joined.number.begin(), joined.number.end());
    const detail::VtkPiece arrays =
        detail::VtkPieceMaker(surface, std::move(own), number)
            .make(columns.components, columns.normals, joined.first_vertex, joined.vertices,
                  joined.first_simplex, joined.simplices);
    const std::string header = detail::header_of(arrays);
    const bool first = ranks.rank() == 0;
    const auto text = [&](const std::string& all) {
        return std::as_bytes(std::span(all).first(first ? all.size() : 0));
    };
    detail::MpiFile file(ranks, path);
    file.write(0, text(header));
    std::uint64_t end = header.size();
    for (const auto& [array, at] : detail::places_of(arrays)) {
        const std::uint64_t begin = header.size() + at;
        const std::string length(reinterpret_cast<const char*>(&array->all), sizeof array->all);
        file.write(begin, text(length));
        file.write(begin + length.size() + array->first, array->bytes);
        end = begin + length.size() + array->all;
    }
    const std::string last = detail::end_of_vtk_file();
    file.write(end, text(last));
    file.close(end + last.size());
}

/// Writes the piece of each rank that has triangles as a file of its own, and a list of these.
/// \param path of the list, whose name ends in ".pvtp"; pieces are beside it, with the number of
///        their rank
///
/// \throw IoError on all ranks alike, with the number of a rank that could not write
template <class Piece>
void write_pvtp(MpiRanks& ranks, const Piece& piece, const JoinedPiece& joined,
                const std::string& path) {
    const auto& surface = piece.surface;
    const detail::VtkColumns columns = detail::columns_of(ranks, surface, joined);
    const std::string stem = path.substr(0, path.rfind(".pvtp")) + "_";
    const auto name_of = [&](std::size_t rank) { return stem + std::to_string(rank) + ".vtp"; };
    detail::VtkPiece own = detail::numbered_piece(ranks.rank(), surface, joined);
    const std::vector<Ranks::Bytes> any =
        ranks.gather(Ranks::Bytes(own.simplices > 0 ? 1 : 0, std::byte{0}));
    std::optional<detail::OwnFile> file;
    std::optional<detail::OwnFile> list;
    std::string failed;
    if (own.simplices > 0) {
        file.emplace(name_of(static_cast<std::size_t>(ranks.rank())));
        failed = file->write([&](std::ostream& out) { detail::write_piece(out, own); });
    }
    if (ranks.rank() == 0) {
        std::vector<std::string> files;
        for (std::size_t r = 0; r < any.size(); ++r) {
            const std::string name = name_of(r);
            if (!any[r].empty()) files.push_back(name.substr(name.rfind('/') + 1));
        }
        while (own.of_points.size() > 2) own.of_points.pop_back();
        const auto add = [&](const std::string& name, std::size_t components) {
            own.of_points.push_back({name, "Float64", components, {}, 0, 0});
        };
        for (std::size_t c = 0; c < columns.components; ++c) {
            add("attribute " + std::to_string(c + 1), 1);
        }
        if (columns.normals) add("Normals", 3);
        list.emplace(path);
        const std::string wrong =
            list->write([&](std::ostream& out) { detail::write_list(out, own, files); });
        if (failed.empty()) failed = wrong;
    }
    // Files get their names once all are whole, and are kept once all have them.
    detail::require_written(ranks, failed);
    if (file) failed = file->name();
    if (list && failed.empty()) failed = list->name();
    detail::require_written(ranks, failed);
    if (file) file->keep();
    if (list) list->keep();
}

}  // namespace nestgrid
