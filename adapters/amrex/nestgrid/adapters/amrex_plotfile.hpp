// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plotfiles of AMReX, and of BoxLib before it: a folder with the texts
// Header and Level_l/Cell_H, and with files of records, one a box: a line of text, then numbers, x
// fastest, component by component. The files are mapped: no number is copied, and only those are
// read from the disk that are looked at. Copied are numbers in another order of bytes, and boxes
// with cells that an embedded boundary covers.
//
// Everything in the texts is checked against the files before it is believed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nestgrid/adapters/amrex_copies.hpp>
#include <nestgrid/adapters/amrex_mapping.hpp>
#include <nestgrid/adapters/block_fields.hpp>

namespace nestgrid {

/// A plotfile, which must stay as it is while this object or an array of it is used.
class AmrexPlotfile {
public:
    /// \throw IoError naming file and line, where it is none, is damaged or ends too early, has
    /// data of nodes, spherical coordinates, or numbers that are no floats or doubles
    explicit AmrexPlotfile(const std::filesystem::path& folder);

    int dimension() const { return static_cast<int>(dim_); }
    double time() const { return time_; }
    const std::vector<std::string>& fields() const { return fields_; }
    /// Whether numbers are doubles; floats otherwise.
    bool is_double() const { return number_type_.bytes == sizeof(double); }
    std::size_t level_count() const { return levels_.size(); }
    std::size_t box_count(std::size_t level) const { return levels_[level].boxes.size(); }
    /// Cells of a level, those that a finer one covers included.
    std::uint64_t cell_count(std::size_t level) const;

    /// \throw InvalidInput where the dimension is another one, or cells of levels do not fit
    /// together; BlockGrid checks the boxes
    template <int dim>
    Blocks<dim> blocks() const;
    /// The numbers of a field, in the mapped files or in a copy that this object, and copies of it,
    /// keep. Cells that an embedded boundary covers have no number (NaN): where there is a field
    /// "vfrac", of the free part of each cell, and Header ends with the least one to be drawn.
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
    /// The place of a record, as a Cell_H names it.
    struct OnDisk {
        std::filesystem::path file;
        std::int64_t offset = 0;
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
    Record read_record(const OnDisk& place, const Box& box);
    Record read_record_alone(const OnDisk& place, Box box, const std::array<int, 3>& ghosts);
    const std::byte* numbers_at(const OnDisk& place, std::size_t line, const Box& stored,
                                std::int64_t fields);
    void set_number_type(const Text& text, const detail::AmrexNumberType& type);
    template <int dim, class Real>
    BlockArrays<dim, Real> mapped_arrays(std::size_t field) const;
    void require(bool fits, const std::string& what) const {
        if (!fits) throw InvalidInput("the plotfile '" + folder_.string() + "' has " + what);
    }

    std::filesystem::path folder_;
    std::size_t dim_ = 3;
    double time_ = 0;
    detail::AmrexNumberType number_type_;
    std::vector<std::string> fields_;
    Point low_{};
    Point spacing_{1, 1, 1};
    std::vector<Level> levels_;
    std::optional<std::size_t> fractions_;  // the field of free parts of cells
    std::vector<double> least_fractions_;   // below which a cell is covered, by level
    std::shared_ptr<detail::AmrexCopies> copies_ = std::make_shared<detail::AmrexCopies>();
    std::map<std::filesystem::path, std::shared_ptr<const detail::AmrexMapping>> files_;
};

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
BlockArrays<dim, Real> AmrexPlotfile::mapped_arrays(std::size_t field) const {
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

template <int dim, class Real>
BlockArrays<dim, Real> AmrexPlotfile::arrays(std::size_t field) const {
    require(dim_ == static_cast<std::size_t>(dim),
            std::to_string(dim_) + " dimensions, not " + std::to_string(dim));
    require(sizeof(Real) == number_type_.bytes,
            "numbers of " + std::to_string(number_type_.bytes) + " bytes");
    require(field < fields_.size(), std::to_string(fields_.size()) +
                                        " fields, none with the number " + std::to_string(field));
    auto arrays = mapped_arrays<dim, Real>(field);
    const bool hides = fractions_ && field != *fractions_;
    if (number_type_.is_native() && !hides) return arrays;
    BlockArrays<dim, Real> fractions(arrays.size());
    if (hides) fractions = mapped_arrays<dim, Real>(*fractions_);
    const auto cells_of = [&](std::size_t l, std::size_t b) {
        const Box& box = levels_[l].boxes[b];
        detail::CellRange<dim> cells;
        for (std::size_t d = 0; d < dim_; ++d) cells.high[d] = box.upper[d] - box.lower[d] + 1;
        return cells;
    };
    const auto& copies = copies_->of_field(field, [&](auto& all) {
        for (std::size_t l = 0; l < arrays.size(); ++l) {
            for (std::size_t b = 0; b < arrays[l].size(); ++b) {
                detail::AmrexCovered<dim, Real> covered;
                if (hides) covered = {fractions[l][b], number_type_, least_fractions_[l]};
                const auto cells = cells_of(l, b);
                all.emplace_back();
                if (number_type_.is_native() && !covered.any(cells)) continue;
                all.back() =
                    detail::AmrexCopies::copied(arrays[l][b], cells, number_type_, covered);
            }
        }
    });
    std::size_t number = 0;
    for (std::size_t l = 0; l < arrays.size(); ++l) {
        for (std::size_t b = 0; b < arrays[l].size(); ++b) {
            const std::vector<std::byte>& copy = copies[number++];
            if (copy.empty()) continue;
            arrays[l][b].first = copy.data();
            auto stride = static_cast<std::ptrdiff_t>(sizeof(Real));
            for (std::size_t d = 0; d < dim_; ++d) {
                arrays[l][b].stride[d] = stride;
                stride *= cells_of(l, b).high[d];
            }
        }
    }
    return arrays;
}

}  // namespace nestgrid

#include <nestgrid/adapters/amrex_plotfile_steps.hpp>
