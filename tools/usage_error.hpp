// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <CLI/CLI.hpp>

/// One sentence on what is wrong with a command line, and what was probably meant.
std::string usage_error(const CLI::ParseError& error, const CLI::App& program);

/// CLI11 reads an empty text as a list of nothing.
/// \throw CLI::ConversionError where the command that was given has one
void refuse_empty_lists(const CLI::App& program);
