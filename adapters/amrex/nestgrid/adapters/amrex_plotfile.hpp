// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plotfiles of AMReX, and of BoxLib before it: a folder with the texts
// Header and Level_l/Cell_H, and with files of records, one a box: a line of text, then numbers, x
// fastest, component by component. The files are mapped: no number is copied, and only those are
// read from the disk that are looked at.
//
// Everything in the texts is checked against the files before it is believed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <nestgrid/adapters/amrex_mapping.hpp>
#include <nestgrid/adapters/amrex_text.hpp>
#include <nestgrid/adapters/block_fields.hpp>

namespace nestgrid {

/// A plotfile, which must stay as it is while this object or an array of it is used.
class AmrexPlotfile {
public:
    /// \throw IoError naming file and line, where it is none, is damaged or ends too early, has
    /// data of nodes, spherical coordinates, records without headers, or numbers of another machine
    explicit AmrexPlotfile(const std::filesystem::path& folder);

    int dimension() const { return static_cast<int>(dim_); }
    double time() const { return time_; }
    const std::vector<std::string>& fields() const { return fields_; }
    /// Whether numbers are doubles; floats otherwise.
    bool is_double() const { return bytes_a_number_ == sizeof(double); }
    std::size_t level_count() const { return levels_.size(); }
    std::size_t box_count(std::size_t level) const { return levels_[level].boxes.size(); }
    /// Cells of a level, those that a finer one covers included.
    std::uint64_t cell_count(std::size_t level) const;

    /// \throw InvalidInput where the dimension is another one, or cells of levels do not fit
    /// together; BlockGrid checks the boxes
    template <int dim>
    Blocks<dim> blocks() const;
    /// Where a field lies in the mapped files.
    /// \param field one of fields(), by its number
    ///
    /// \throw InvalidInput where dimension or type are others, or there is no such field
    template <int dim, class Real>
    BlockArrays<dim, Real> arrays(std::size_t field) const;

private:
    using Box = detail::AmrexBox;
    using Text = detail::AmrexText;

    /// The numbers of a box.
    struct Record {
        const std::byte* first = nullptr;
        Box stored;  ///< with ghost cells
    };
    struct Level {
        Box domain;
        std::vector<Box> boxes;
        std::vector<Record> records;
    };

    static std::string_view text_of(const detail::AmrexMapping& file) {
        const auto bytes = file.bytes();
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    const detail::AmrexMapping& mapped(const std::filesystem::path& path);
    void read_header(Text& text, std::vector<std::string>& paths);
    void read_level_header(Text& text, Level& level, std::vector<std::string>& paths);
    void read_level(Level& level, const std::string& path);
    Record read_record(const std::filesystem::path& path, std::int64_t offset, const Box& box);
    void read_number_type(Text& text);
    void require(bool fits, const std::string& what) const {
        if (!fits) throw InvalidInput("the plotfile '" + folder_.string() + "' has " + what);
    }

    std::filesystem::path folder_;
    std::size_t dim_ = 3;
    double time_ = 0;
    std::size_t bytes_a_number_ = 0;  // 0 before the first record
    std::vector<std::string> fields_;
    Point low_{};
    Point spacing_{1, 1, 1};
    std::vector<Level> levels_;
    std::map<std::filesystem::path, std::shared_ptr<const detail::AmrexMapping>> files_;
};

}  // namespace nestgrid

#include <nestgrid/adapters/amrex_plotfile_steps.hpp>
