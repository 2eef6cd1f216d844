// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the values in a .nestgrid file are kept, on the command line.
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include <nestgrid/algorithms/compressed_field.hpp>

struct EncodingOptions {
    bool bit_for_bit = false;
    std::optional<double> within{};  ///< how far values may be off

    /// Nothing where values are kept as they are.
    std::optional<nestgrid::CompressionOptions> compression() const {
        if (within) return nestgrid::CompressionOptions{2 * *within};
        if (bit_for_bit) return nestgrid::CompressionOptions{};
        return std::nullopt;
    }
};
void add_encoding_options(CLI::App& command, EncodingOptions& options);
