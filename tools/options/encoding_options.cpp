// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "options/encoding_options.hpp"

#include "options/command_line.hpp"

void add_encoding_options(CLI::App& command, EncodingOptions& options) {
    CLI::Option* exactly =
        command
            .add_flag("--encode", options.bit_for_bit,
                      "keep values as differences from their interpolants: smaller, bit for bit")
            ->group("Encoding");
    command
        .add_option("--encode-within", options.within,
                    "the same with values that may be off by this, in units of the data")
        ->type_name("NUMBER")
        ->group("Encoding")
        ->check(positive_number)
        ->excludes(exactly);
}
