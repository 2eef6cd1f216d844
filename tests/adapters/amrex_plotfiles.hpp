// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes plotfiles as AMReX does.
#pragma once

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "block_samples.hpp"

namespace nestgrid_test {

template <std::size_t size>
std::string in_brackets(const std::array<int, size>& place) {
    std::string text = "(";
    for (std::size_t d = 0; d < size; ++d) text += (d == 0 ? "" : ",") + std::to_string(place[d]);
    return text + ")";
}

template <int dim>
std::string text_of_box(const BlockBox<dim>& box) {
    return "(" + in_brackets(box.lower) + " " + in_brackets(box.upper) + " " +
           in_brackets(std::array<int, static_cast<std::size_t>(dim)>{}) + ")";
}

/// Ways in which AMReX may be told to write.
struct PlotfileWay {
    int ghosts = 0;
    int version = 1;               ///< of the texts: from 2 on records have no lines of their own
    bool is_reversed = false;      ///< whether the highest byte of a number comes first
    bool has_empty_level = false;  ///< finer than all others
    double least_fraction = 0;  ///< of cells that an embedded boundary leaves free, where above 0
};

/// Boxes go into two files a level; cells under finer ones hold no number.
/// \param f called at centres of leaves, with the number of the field
template <int dim, class Real>
void write_plotfile(const std::filesystem::path& folder, const Blocks<dim>& blocks,
                    const std::vector<std::string>& fields,
                    const std::function<double(const Point&, int)>& f, double time = 0,
                    const PlotfileWay& way = {}) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const CellsOfBlocks<dim> cells(blocks);
    std::vector<BlockBox<dim>> domains(1, blocks.levels[0].boxes[0]);
    for (const BlockBox<dim>& box : blocks.levels[0].boxes) {
        for (std::size_t d = 0; d < dim; ++d) {
            domains[0].lower[d] = std::min(domains[0].lower[d], box.lower[d]);
            domains[0].upper[d] = std::max(domains[0].upper[d], box.upper[d]);
        }
    }
    for (std::size_t l = 1; l < blocks.levels.size(); ++l) {
        domains.push_back(domains.back());
        for (std::size_t d = 0; d < dim; ++d) {
            domains[l].lower[d] *= blocks.levels[l].ratio[d];
            domains[l].upper[d] = (domains[l].upper[d] + 1) * blocks.levels[l].ratio[d] - 1;
        }
    }
    if (way.has_empty_level) {
        domains.push_back(domains.back());
        for (std::size_t d = 0; d < dim; ++d) {
            domains.back().lower[d] *= 2;
            domains.back().upper[d] = 2 * domains.back().upper[d] + 1;
        }
    }
    const bool is_double = sizeof(Real) == 8;
    const std::string bytes = is_double ? "8 7 6 5 4 3 2 1" : "4 3 2 1";
    const std::string order = way.is_reversed ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
    const std::string type = is_double ? "((8, (64 11 52 0 1 12 0 1023)),(8, (" + order + ")))"
                                       : "((8, (32 8 23 0 1 9 0 127)),(4, (" + order + ")))";
    std::ofstream header(folder / "Header");
    header.precision(17);
    header << "HyperCLaw-V1.1\n" << fields.size() << '\n';
    for (const std::string& name : fields) header << name << '\n';
    header << dim << '\n' << time << '\n' << domains.size() - 1 << '\n';
    for (std::size_t d = 0; d < dim; ++d) header << blocks.origin[d] << ' ';
    header << '\n';
    for (std::size_t d = 0; d < dim; ++d) {
        const int n = domains[0].upper[d] - domains[0].lower[d] + 1;
        header << blocks.origin[d] + n * blocks.spacing[d] << ' ';
    }
    header << '\n';
    for (std::size_t l = 1; l < blocks.levels.size(); ++l) {
        header << blocks.levels[l].ratio[0] << ' ';
    }
    header << '\n';
    for (const BlockBox<dim>& domain : domains) header << text_of_box(domain) << ' ';
    header << '\n';
    for (std::size_t l = 0; l < domains.size(); ++l) header << "7 ";
    header << '\n';
    int ratio = 1;
    for (std::size_t l = 0; l < domains.size(); ++l) {
        if (l > 0) ratio *= l < blocks.levels.size() ? blocks.levels[l].ratio[0] : 2;
        for (std::size_t d = 0; d < dim; ++d) header << blocks.spacing[d] / ratio << ' ';
        header << '\n';
    }
    header << "0\n0\n";
    for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
        const auto& boxes = blocks.levels[l].boxes;
        header << l << ' ' << boxes.size() << ' ' << time << "\n7\n";
        for (const BlockBox<dim>& box : boxes) {
            const Point low = cells.at(l, box.lower, 0);
            const Point high = cells.at(l, box.upper, 1);
            for (std::size_t d = 0; d < dim; ++d) header << low[d] << ' ' << high[d] << '\n';
        }
        const std::string name = "Level_" + std::to_string(l);
        header << name << "/Cell\n";
        std::filesystem::create_directories(folder / name);
        std::ostringstream records;
        std::array<std::ofstream, 2> files;
        for (std::size_t i = 0; i < 2; ++i) {
            files[i].open(folder / name / ("Cell_D_0000" + std::to_string(i)), std::ios::binary);
        }
        std::ofstream texts(folder / name / "Cell_H");
        texts << way.version << "\n1\n"
              << fields.size() << '\n'
              << way.ghosts << "\n(" << boxes.size() << " 0\n";
        for (const BlockBox<dim>& box : boxes) texts << text_of_box(box) << '\n';
        texts << ")\n" << boxes.size() << '\n';
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            BlockBox<dim> stored = boxes[b];
            for (std::size_t d = 0; d < dim; ++d) {
                stored.lower[d] -= way.ghosts;
                stored.upper[d] += way.ghosts;
            }
            std::ofstream& file = files[b % 2];
            texts << "FabOnDisk: Cell_D_0000" << b % 2 << ' ' << file.tellp() << '\n';
            if (way.version == 1) {
                file << "FAB " << type << text_of_box(stored) << ' ' << fields.size() << '\n';
            }
            for (std::size_t n = 0; n < fields.size(); ++n) {
                for_each_cell(stored, [&](const Cell<dim>& c) {
                    bool is_leaf = cells.is_leaf(l, c);
                    for (std::size_t d = 0; d < dim; ++d) {
                        is_leaf = is_leaf && boxes[b].lower[d] <= c[d] && c[d] <= boxes[b].upper[d];
                    }
                    const Real value =
                        is_leaf ? static_cast<Real>(f(cells.centre(l, c), static_cast<int>(n)))
                                : std::numeric_limits<Real>::quiet_NaN();
                    auto raw = std::bit_cast<std::array<char, sizeof(Real)>>(value);
                    if (way.is_reversed) std::reverse(raw.begin(), raw.end());
                    file.write(raw.data(), sizeof(raw));
                });
            }
        }
        texts << "\n0,0\n\n0,0\n\n";
        if (way.version > 1) texts << type << '\n';
    }
    if (way.has_empty_level) {
        const std::string name = "Level_" + std::to_string(blocks.levels.size());
        header << blocks.levels.size() << " 0 " << time << "\n7\n" << name << "/Cell\n";
    }
    for (std::size_t l = 0; way.least_fraction > 0 && l < domains.size(); ++l) {
        header << way.least_fraction << '\n';
    }
}

}  // namespace nestgrid_test
