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

#include <bit>
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

inline AmrexPlotfile::AmrexPlotfile(const std::filesystem::path& folder) : folder_{folder} {
    std::vector<std::string> paths;  // of the levels
    Text header("'" + (folder / "Header").string() + "'", text_of(mapped(folder / "Header")));
    read_header(header, paths);
    for (std::size_t l = 0; l < levels_.size(); ++l) read_level(levels_[l], paths[l]);
}

inline const detail::AmrexMapping& AmrexPlotfile::mapped(const std::filesystem::path& path) {
    auto& file = files_[path];
    if (file == nullptr) file = std::make_shared<const detail::AmrexMapping>(path);
    return *file;
}

inline void AmrexPlotfile::read_header(Text& text, std::vector<std::string>& paths) {
    text.line("the version");  // codes name their own
    const std::size_t fields = text.count("the number of fields", 2);
    text.line("the first field");
    for (std::size_t i = 0; i < fields; ++i) fields_.emplace_back(text.line("the fields"));
    if (fields == 0) text.fail("there are no fields");
    dim_ = static_cast<std::size_t>(text.integer("the dimension", 2, 3));
    time_ = text.real("the time");
    const auto finest = text.integer("the finest level", 0, 30);
    for (std::size_t d = 0; d < dim_; ++d) low_[d] = text.real("the begin of the domain");
    for (std::size_t d = 0; d < dim_; ++d) text.real("the end of the domain");
    text.line("the ratios");
    text.line("the ratios");  // of the first direction alone; those of the domains are taken
    levels_.resize(static_cast<std::size_t>(finest) + 1);
    for (Level& level : levels_) level.domain = text.box(dim_);
    for (std::size_t l = 0; l < levels_.size(); ++l) text.integer("a step", INT64_MIN, INT64_MAX);
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        for (std::size_t d = 0; d < dim_; ++d) {
            const double size = text.real("the size of cells");
            if (size <= 0) text.fail("the size of cells is not above 0");
            if (l == 0) spacing_[d] = size;
        }
    }
    if (text.integer("the kind of coordinates", 0, 2) == 2) {
        text.fail("the coordinates are spherical, which are not read");
    }
    text.integer("the width of the boundary", 0, INT32_MAX);
    for (Level& level : levels_) read_level_header(text, level, paths);
}

inline void AmrexPlotfile::read_level_header(Text& text, Level& level,
                                             std::vector<std::string>& paths) {
    text.integer("the number of a level", 0, 30);
    level.boxes.resize(text.count("the number of boxes", 4));
    if (level.boxes.empty()) text.fail("a level has no boxes");
    text.real("the time of a level");
    text.integer("the step of a level", INT64_MIN, INT64_MAX);
    // Ends in space, which follow from the cells.
    for (std::size_t i = 0; i < 2 * dim_ * level.boxes.size(); ++i) text.real("an end of a box");
    paths.emplace_back(text.word("the path of a level"));
}

/// \param path relative to the folder, of the files of the level without what follows on "Cell"
inline void AmrexPlotfile::read_level(Level& level, const std::string& path) {
    const std::filesystem::path relative(path);
    for (const auto& part : relative) {
        if (relative.is_absolute() || part == "..") {
            throw IoError("'" + (folder_ / "Header").string() + "': the path '" + path +
                          "' leaves the folder");
        }
    }
    const std::filesystem::path name = folder_ / (path + "_H");
    Text text("'" + name.string() + "'", text_of(mapped(name)));
    if (text.integer("the version", 0, INT32_MAX) != 1) {
        text.fail("its records have no headers, which is not read");
    }
    text.integer("the order of boxes", 0, INT32_MAX);
    if (text.integer("the number of fields", 0, INT32_MAX) !=
        static_cast<std::int64_t>(fields_.size())) {
        text.fail("there are not as many fields as in Header");
    }
    if (text.has_next('(')) {
        text.place_of(dim_);
    } else {
        text.integer("the number of ghost cells", 0, INT32_MAX);
    }
    text.expect('(', "the boxes");
    const auto require_count = [&](std::size_t count) {
        if (count != level.boxes.size()) text.fail("there are not as many boxes as in Header");
    };
    require_count(text.count("the number of boxes", 1));
    text.integer("a number behind that of boxes", 0, INT32_MAX);
    for (Box& box : level.boxes) box = text.box(dim_);
    text.expect(')', "the boxes");
    require_count(text.count("the number of records", 1));
    for (const Box& box : level.boxes) {
        if (text.word("a record") != "FabOnDisk:") text.fail("a record is no FabOnDisk");
        const std::string file(text.word("the file of a record"));
        if (file.find('/') != std::string::npos) text.fail("a record is in another folder");
        const auto offset = text.integer("the place of a record", 0, INT64_MAX);
        level.records.push_back(read_record(name.parent_path() / file, offset, box));
    }
}

inline auto AmrexPlotfile::read_record(const std::filesystem::path& path, std::int64_t offset,
                                       const Box& box) -> Record {
    const std::string_view all = text_of(mapped(path));
    const std::string name = path.string();
    if (static_cast<std::uint64_t>(offset) >= all.size()) {
        throw IoError("'" + name + "' is truncated: it has " + std::to_string(all.size()) +
                      " bytes, but a record at " + std::to_string(offset));
    }
    constexpr std::size_t longest_line = 1000;
    const std::string_view begin = all.substr(static_cast<std::size_t>(offset), longest_line);
    Text text("the record at " + std::to_string(offset) + " of '" + name + "'",
              begin.substr(0, begin.find('\n')));
    if (text.word("the word FAB") != "FAB") text.fail("there is no FAB in the new format");
    read_number_type(text);
    Record record;
    record.stored = text.box(dim_);
    const auto fields = text.integer("the number of fields", 0, INT32_MAX);
    if (fields < static_cast<std::int64_t>(fields_.size())) text.fail("there are too few fields");
    const std::size_t line = begin.find('\n');
    if (line == std::string_view::npos) text.fail("the line has no end");
    double bytes = static_cast<double>(bytes_a_number_) * static_cast<double>(fields);
    for (std::size_t d = 0; d < dim_; ++d) {
        if (record.stored.lower[d] > box.lower[d] || record.stored.upper[d] < box.upper[d]) {
            text.fail("the box is not within that of the record");
        }
        bytes *= static_cast<double>(record.stored.upper[d]) - record.stored.lower[d] + 1;
    }
    const std::size_t first = static_cast<std::size_t>(offset) + line + 1;
    if (bytes > static_cast<double>(all.size() - first)) {
        throw IoError("'" + name + "' is truncated: it has " + std::to_string(all.size()) +
                      " bytes, too few for the record at " + std::to_string(offset));
    }
    record.first = reinterpret_cast<const std::byte*>(all.data()) + first;
    return record;
}

/// Bits of the parts of a number, and the order of its bytes: ((8, (64 11 52 0 1 12 0 1023)),
/// (8, (8 7 6 5 4 3 2 1))) is a double whose last byte stands first.
inline void AmrexPlotfile::read_number_type(Text& text) {
    const auto list = [&](const char* what) {
        std::vector<std::int64_t> numbers;
        text.expect('(', what);
        numbers.resize(static_cast<std::size_t>(text.integer(what, 0, 16)));
        text.expect(',', what);
        text.expect('(', what);
        for (std::int64_t& number : numbers) number = text.integer(what, 0, INT32_MAX);
        text.expect(')', what);
        text.expect(')', what);
        return numbers;
    };
    text.expect('(', "the type of numbers");
    const auto format = list("the format of numbers");
    text.expect(',', "the type of numbers");
    const auto order = list("the order of bytes");
    text.expect(')', "the type of numbers");
    const std::size_t bytes = order.size();
    const std::vector<std::int64_t> single{32, 8, 23, 0, 1, 9, 0, 127};
    const std::vector<std::int64_t> twofold{64, 11, 52, 0, 1, 12, 0, 1023};
    if (!(bytes == 8 && format == twofold) && !(bytes == 4 && format == single)) {
        text.fail("numbers are neither IEEE floats nor doubles");
    }
    for (std::size_t i = 0; i < bytes; ++i) {
        const bool is_little = std::endian::native == std::endian::little;
        if (order[i] != static_cast<std::int64_t>(is_little ? bytes - i : i + 1)) {
            text.fail("numbers have the byte order of another machine");
        }
    }
    if (bytes_a_number_ == 0) bytes_a_number_ = bytes;
    if (bytes != bytes_a_number_) text.fail("some numbers are floats and others doubles");
}

inline std::uint64_t AmrexPlotfile::cell_count(std::size_t level) const {
    std::uint64_t sum = 0;
    for (const Box& box : levels_[level].boxes) {
        std::uint64_t cells = 1;
        for (std::size_t d = 0; d < dim_; ++d) {
            cells *= static_cast<std::uint64_t>(std::int64_t{box.upper[d]} - box.lower[d] + 1);
        }
        sum += cells;
    }
    return sum;
}

template <int dim>
Blocks<dim> AmrexPlotfile::blocks() const {
    require(dim_ == static_cast<std::size_t>(dim),
            std::to_string(dim_) + " dimensions, not " + std::to_string(dim));
    Blocks<dim> blocks;
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        BlockLevel<dim>& level = blocks.levels.emplace_back();
        for (const Box& box : levels_[l].boxes) {
            BlockBox<dim>& copy = level.boxes.emplace_back();
            std::copy_n(box.lower.begin(), dim, copy.lower.begin());
            std::copy_n(box.upper.begin(), dim, copy.upper.begin());
        }
        for (std::size_t d = 0; l > 0 && d < dim_; ++d) {
            const Box& coarse = levels_[l - 1].domain;
            const Box& fine = levels_[l].domain;
            const std::int64_t before = std::int64_t{coarse.upper[d]} - coarse.lower[d] + 1;
            const std::int64_t here = std::int64_t{fine.upper[d]} - fine.lower[d] + 1;
            require(before > 0 && here > 0 && here % before == 0 &&
                        coarse.lower[d] * (here / before) == fine.lower[d],
                    "a domain of level " + std::to_string(l) +
                        " that is no multiple of that of the level before");
            level.ratio[d] = static_cast<int>(here / before);
        }
    }
    for (std::size_t d = 0; d < dim_; ++d) {
        int first = levels_[0].boxes[0].lower[d];
        for (const Box& box : levels_[0].boxes) first = std::min(first, box.lower[d]);
        blocks.spacing[d] = spacing_[d];
        blocks.origin[d] =
            low_[d] + (static_cast<double>(first) - levels_[0].domain.lower[d]) * spacing_[d];
    }
    return blocks;
}

template <int dim, class Real>
BlockArrays<dim, Real> AmrexPlotfile::arrays(std::size_t field) const {
    require(dim_ == static_cast<std::size_t>(dim),
            std::to_string(dim_) + " dimensions, not " + std::to_string(dim));
    require(sizeof(Real) == bytes_a_number_,
            "numbers of " + std::to_string(bytes_a_number_) + " bytes");
    require(field < fields_.size(), std::to_string(fields_.size()) +
                                        " fields, none with the number " + std::to_string(field));
    BlockArrays<dim, Real> arrays;
    for (const Level& level : levels_) {
        auto& of_level = arrays.emplace_back();
        for (std::size_t b = 0; b < level.boxes.size(); ++b) {
            const Box& box = level.boxes[b];
            const Box& stored = level.records[b].stored;
            BlockArray<dim, Real>& array = of_level.emplace_back();
            auto stride = static_cast<std::ptrdiff_t>(sizeof(Real));
            std::ptrdiff_t first = 0;
            for (std::size_t d = 0; d < dim_; ++d) {
                array.stride[d] = stride;
                first += stride * (box.lower[d] - stored.lower[d]);
                stride *= stored.upper[d] - stored.lower[d] + 1;
            }
            array.first =
                level.records[b].first + first + static_cast<std::ptrdiff_t>(field) * stride;
        }
    }
    return arrays;
}

}  // namespace nestgrid
