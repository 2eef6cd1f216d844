// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "own_grid_figure.hpp"

#include <fstream>
#include <vector>

#include <nestgrid/error.hpp>

#include "picture.hpp"

namespace figures {

void own_grid_figure(const std::string& file) {
    std::ifstream written("own_grid.obj");
    if (!written) throw nestgrid::IoError("there is no own_grid.obj: run the example own_grid");
    Picture picture(520, 440, 1);
    picture.look(0, {{1.1, 1.5, 0.7}, {0, 0, 1}, {0.5, 0.5, 0.49}, 1.5});
    std::vector<nestgrid::Point> vertices;
    for (char kind = 0; written >> kind;) {
        if (kind == 'v') {
            nestgrid::Point x{};
            written >> x[0] >> x[1] >> x[2];
            vertices.push_back(x);
        } else {
            std::array<std::size_t, 3> corner{};
            written >> corner[0] >> corner[1] >> corner[2];
            picture.triangle({vertices.at(corner[0] - 1), vertices.at(corner[1] - 1),
                              vertices.at(corner[2] - 1)},
                             {0.95, 0.87, 0.72}, true);
        }
    }
    picture.write(file);
}

}  // namespace figures
