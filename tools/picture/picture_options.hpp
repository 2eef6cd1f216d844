// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a picture looks like, on the command line: the same options for all commands that draw one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "picture/picture.hpp"

/// The options as texts. Each needs --image.
struct PictureOptions {
    std::filesystem::path image;  ///< empty: no picture
    std::optional<std::string> size;
    std::optional<std::string> background;
    std::optional<std::string> view;
    std::optional<std::string> colours;
    std::optional<std::string> range;
    std::optional<std::string> title;
    std::optional<std::string> unit;  ///< of the scale bar
    std::optional<double> opacity;
    bool perspective = false;
    bool axes = false;
    bool orientation = false;
    bool detail = false;
};

void add_picture_options(CLI::App& command, PictureOptions& options);

/// \throw nestgrid::InvalidInput for a text that means nothing, and for options that exclude each
///        other
/// \throw nestgrid::IoError where the picture cannot be written
PictureStyle parse(const PictureOptions& options);

/// \param why what is drawn has no colours, as a sentence
/// \throw nestgrid::InvalidInput where options are about colours
void refuse_colours(const PictureOptions& options, const std::string& why);
