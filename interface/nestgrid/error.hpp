// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

#include <nestgrid/detail/same_library.hpp>

namespace nestgrid {

// Exported, so that a program that hides its symbols catches what a shared library throws.

/// An argument that cannot be worked with: a field of the wrong length, a NaN, a bad option.
class [[gnu::visibility("default")]] InvalidInput : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// A grid or a field that breaks the contract of the interface, or one that an algorithm cannot
/// treat (a shape it does not know, a value that is not available on this process).
class [[gnu::visibility("default")]] GridError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written.
class [[gnu::visibility("default")]] IoError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace nestgrid
