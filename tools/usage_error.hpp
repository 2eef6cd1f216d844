// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include <CLI/CLI.hpp>

/// One sentence on what is wrong with a command line, and what was probably meant.
std::string usage_error(const CLI::ParseError& error, const CLI::App& program);

/// CLI11 reads an empty text as a list of nothing, and leaves out what is empty in '1,,2'.
/// \param words of the command line
/// \throw CLI::ParseError where the command that was given has such a list
void refuse_empty_lists(const CLI::App& program, std::span<const char* const> words);
