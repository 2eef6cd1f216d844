// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The command-line program as a function, which tests call in processes of their own.
#pragma once

/// \param argv the words of the command line, the name of the program first
/// \return the exit status: 0, 1 where the input is refused, 2 where the command line is
int run_program(int argc, char** argv);
