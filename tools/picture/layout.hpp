// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where everything is on a picture. Needs no display.
#pragma once

#include <vector>

#include "picture/picture.hpp"
#include "picture/sheet.hpp"

struct Layout {
    int width = 0;
    int height = 0;
    ColourRange range{};             ///< of the colours, where there are any
    std::vector<Projector> panels;   ///< one a panel, and the same view in all
    std::vector<Projector> details;  ///< the same magnified, or empty
    Sheet sheet;                     ///< captions, legend and all that explains
};

/// \throw nestgrid::InvalidInput where the panels do not fit into the size that is asked for
Layout make_layout(const std::vector<Panel>& panels, const PictureStyle& style);
