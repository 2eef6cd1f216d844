// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the texts of a plotfile are read and checked. Included at the end of amrex_plotfile.hpp.
#pragma once

#include <nestgrid/adapters/amrex_plotfile.hpp>

namespace nestgrid {

inline AmrexPlotfile::AmrexPlotfile(const std::filesystem::path& folder) : folder_{folder} {
    std::vector<std::string> paths;  // of the levels
    Text header("'" + (folder / "Header").string() + "'", text_of(mapped(folder / "Header")));
    read_header(header, paths);
    while (levels_.size() > 1 && levels_.back().boxes.empty()) levels_.pop_back();
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        if (levels_[l].boxes.empty()) header.fail("level " + std::to_string(l) + " has no boxes");
        read_level(levels_[l], paths[l]);
    }
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
    const auto fractions = std::find(fields_.begin(), fields_.end(), "vfrac");
    if (fractions == fields_.end() || text.is_at_end()) return;
    fractions_ = static_cast<std::size_t>(fractions - fields_.begin());
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        least_fractions_.push_back(text.real("the least free part of a cell"));
    }
}

inline void AmrexPlotfile::read_level_header(Text& text, Level& level,
                                             std::vector<std::string>& paths) {
    text.integer("the number of a level", 0, 30);
    level.boxes.resize(text.count("the number of boxes", 4));
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
    const bool has_lines = text.integer("the version", 1, 4) == 1;  // in front of records
    text.integer("the order of boxes", 0, INT32_MAX);
    if (text.integer("the number of fields", 0, INT32_MAX) !=
        static_cast<std::int64_t>(fields_.size())) {
        text.fail("there are not as many fields as in Header");
    }
    std::array<int, 3> ghosts{};
    if (text.has_next('(')) {
        ghosts = text.place_of(dim_);
        if (*std::min_element(ghosts.begin(), ghosts.end()) < 0) text.fail("ghosts are below 0");
    } else {
        const auto layers = static_cast<int>(text.integer("the number of ghost cells", 0, 1 << 20));
        std::fill_n(ghosts.begin(), dim_, layers);
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
    std::vector<OnDisk> places;
    for (std::size_t i = 0; i < level.boxes.size(); ++i) {
        if (text.word("a record") != "FabOnDisk:") text.fail("a record is no FabOnDisk");
        const std::string file(text.word("the file of a record"));
        if (file.find('/') != std::string::npos) text.fail("a record is in another folder");
        const auto offset = text.integer("the place of a record", 0, INT64_MAX);
        places.push_back({name.parent_path() / file, offset});
    }
    if (!has_lines) {
        text.skip_to('(');  // behind the least and greatest numbers
        set_number_type(text, detail::AmrexNumberType::read_from(text));
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        level.records.push_back(has_lines ? read_record(places[i], level.boxes[i])
                                          : read_record_alone(places[i], level.boxes[i], ghosts));
    }
}

inline void AmrexPlotfile::set_number_type(const Text& text, const detail::AmrexNumberType& type) {
    if (number_type_.bytes == 0) number_type_ = type;
    if (type.bytes != number_type_.bytes) text.fail("some numbers are floats and others doubles");
    if (type != number_type_) text.fail("numbers have several orders of bytes");
}

/// A record behind a line that says what it is.
inline auto AmrexPlotfile::read_record(const OnDisk& place, const Box& box) -> Record {
    const std::string_view all = text_of(mapped(place.file));
    const std::string name = place.file.string();
    if (static_cast<std::uint64_t>(place.offset) >= all.size()) {
        throw IoError("'" + name + "' is truncated: it has " + std::to_string(all.size()) +
                      " bytes, but a record at " + std::to_string(place.offset));
    }
    constexpr std::size_t longest_line = 1000;
    const std::string_view begin = all.substr(static_cast<std::size_t>(place.offset), longest_line);
    const std::size_t line = begin.find('\n');
    Text text("the record at " + std::to_string(place.offset) + " of '" + name + "'",
              begin.substr(0, line));
    if (text.word("the word FAB") != "FAB") text.fail("there is no FAB in the new format");
    set_number_type(text, detail::AmrexNumberType::read_from(text));
    Record record;
    record.stored = text.box(dim_);
    const auto fields = text.integer("the number of fields", 0, INT32_MAX);
    if (fields < static_cast<std::int64_t>(fields_.size())) text.fail("there are too few fields");
    if (line == std::string_view::npos) text.fail("the line has no end");
    for (std::size_t d = 0; d < dim_; ++d) {
        if (record.stored.lower[d] > box.lower[d] || record.stored.upper[d] < box.upper[d]) {
            text.fail("the box is not within that of the record");
        }
    }
    record.first = numbers_at(place, line + 1, record.stored, fields);
    return record;
}

/// A record of numbers alone.
inline auto AmrexPlotfile::read_record_alone(const OnDisk& place, Box box,
                                             const std::array<int, 3>& ghosts) -> Record {
    for (std::size_t d = 0; d < dim_; ++d) {
        box.lower[d] -= ghosts[d];
        box.upper[d] += ghosts[d];
    }
    return {numbers_at(place, 0, box, static_cast<std::int64_t>(fields_.size())), box};
}

/// \param line how long the line in front of the numbers is
inline const std::byte* AmrexPlotfile::numbers_at(const OnDisk& place, std::size_t line,
                                                  const Box& stored, std::int64_t fields) {
    const auto all = mapped(place.file).bytes();
    double bytes = static_cast<double>(number_type_.bytes) * static_cast<double>(fields);
    for (std::size_t d = 0; d < dim_; ++d) {
        bytes *= static_cast<double>(stored.upper[d]) - stored.lower[d] + 1;
    }
    const double begin = static_cast<double>(place.offset) + static_cast<double>(line);
    if (begin + bytes > static_cast<double>(all.size())) {
        throw IoError("'" + place.file.string() + "' is truncated: it has " +
                      std::to_string(all.size()) + " bytes, too few for the record at " +
                      std::to_string(place.offset));
    }
    return all.data() + static_cast<std::size_t>(place.offset) + line;
}

}  // namespace nestgrid
