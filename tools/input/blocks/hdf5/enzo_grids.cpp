// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/blocks/hdf5/enzo_grids.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <nestgrid/error.hpp>

namespace {

using nestgrid::InvalidInput;
namespace fs = std::filesystem;

/// What the text says of a grid.
struct EnzoGrid {
    std::map<std::string, std::string> entries;

    /// \throw InvalidInput where an entry has other numbers than one a direction
    std::vector<double> numbers(const std::string& name, std::size_t count) const {
        const auto found = entries.find(name);
        std::istringstream text(found == entries.end() ? "" : found->second);
        std::vector<double> numbers(count);
        for (double& each : numbers) text >> each;
        const bool fits = std::ranges::all_of(numbers, [](double x) { return std::abs(x) < 1e30; });
        if (text && fits) return numbers;
        throw InvalidInput("a grid has not " + std::to_string(count) + " numbers " + name);
    }
};

std::vector<EnzoGrid> grids_in(const fs::path& path) {
    std::vector<EnzoGrid> grids;
    std::ifstream text(path);
    for (std::string line; std::getline(text, line);) {
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos) continue;
        const std::string name = line.substr(0, line.find_last_not_of(" \t", equals - 1) + 1);
        if (name == "Grid") grids.emplace_back();
        if (!grids.empty()) grids.back().entries[name] = line.substr(equals + 1);
    }
    if (grids.empty()) throw InvalidInput("it names no grids");
    return grids;
}

PlacedGrid placed(const EnzoGrid& grid, std::size_t dim, const fs::path& folder) {
    PlacedGrid result;
    result.low = grid.numbers("GridLeftEdge", dim);
    const auto high = grid.numbers("GridRightEdge", dim);
    const auto first = grid.numbers("GridStartIndex", dim);
    const auto last = grid.numbers("GridEndIndex", dim);
    for (std::size_t d = 0; d < dim; ++d) {
        const double cells = last[d] - first[d] + 1;
        const bool is_box = cells >= 1 && cells <= 1 << 20 && high[d] > result.low[d];
        if (!is_box) throw InvalidInput("a grid has no cells, or too many");
        result.cells.push_back(static_cast<hsize_t>(cells));
        result.spacing.push_back((high[d] - result.low[d]) / cells);
    }
    const auto found = grid.entries.find("BaryonFileName");
    if (found == grid.entries.end()) throw InvalidInput("a grid has no BaryonFileName");
    std::istringstream(found->second) >> result.group;
    result.file = folder / fs::path(result.group).filename();
    std::ostringstream name;
    name.width(8);
    name.fill('0');
    name << static_cast<std::int64_t>(grid.numbers("Grid", 1)[0]);
    result.group = "Grid" + name.str();
    return result;
}

}  // namespace

std::vector<PlacedGrid> enzo_grids(const fs::path& path) {
    const std::vector<EnzoGrid> grids = grids_in(path);
    const double rank = grids.front().numbers("GridRank", 1)[0];
    if (rank != 2 && rank != 3) throw InvalidInput("it has not 2 or 3 dimensions");
    std::vector<PlacedGrid> all;
    for (const EnzoGrid& grid : grids) {
        all.push_back(placed(grid, static_cast<std::size_t>(rank), path.parent_path()));
        if (grid.entries.contains("Time")) all.back().time = grid.numbers("Time", 1)[0];
    }
    return all;
}
