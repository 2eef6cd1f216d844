// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Around every function that C codes call: tables become hierarchies, exceptions become codes and
// sentences, and structs are read and written as far as their size says.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>

#include <nestgrid/algorithms/options.h>
#include <nestgrid/error.hpp>
#include <nestgrid/table.hpp>

namespace nestgrid {

/// Writes as much of a sentence as there is room for.
inline void say(const std::string& sentence, char* message, std::size_t size) {
    if (message == nullptr || size == 0) return;
    const std::size_t length = std::min(sentence.size(), size - 1);
    std::memcpy(message, sentence.data(), length);
    message[length] = '\0';
}

/// Calls function(), which returns a code; exceptions become codes.
template <class Function>
int without_exceptions(char* message, std::size_t size, const Function& function) noexcept {
    try {
        return function();
    } catch (const InvalidInput& e) {
        say(e.what(), message, size);
        return 1;
    } catch (const std::exception& e) {
        say(e.what(), message, size);
        return 2;
    } catch (...) {
        say("unknown failure", message, size);
        return 3;
    }
}

/// \throw GridError where a function that C code gave returned another code than 0
inline void require_success(int code, const char* operation) {
    if (code == 0) return;
    throw GridError(std::string(operation) + " failed with code " + std::to_string(code));
}

/// Calls function(hierarchy) with what the tables describe.
/// \param attributes fields behind the first one
template <class Function>
int with_tables(const nestgrid_grid* grid, const nestgrid_field* field,
                std::span<const nestgrid_field* const> attributes, const Function& function) {
    if (grid == nullptr || field == nullptr) throw InvalidInput("a table is NULL");
    if (field->value_type == NESTGRID_FLOAT) {
        return function(*open_table<float>(*grid, *field, attributes));
    }
    return function(*open_table<double>(*grid, *field, attributes));
}

/// Empties a result, as much of it as its size says.
/// \tparam Result a struct that begins with `size` and `owner`
/// \throw InvalidInput where it is NULL, or too small for its owner
template <class Result>
void begin_result(Result* out) {
    if (out == nullptr) throw InvalidInput("the result is NULL");
    if (out->size < offsetof(Result, owner) + sizeof(out->owner)) {
        throw InvalidInput("the size of the result says " + std::to_string(out->size) +
                           " bytes: set it to that of the struct");
    }
    Result empty{};
    empty.size = out->size;
    std::memcpy(out, &empty, std::min(out->size, sizeof(empty)));
}

/// Hands out a result, as much of it as its size says.
template <class Result>
void write_result(Result result, Result* out) {
    result.size = out->size;
    std::memcpy(out, &result, std::min(out->size, sizeof(result)));
}

}  // namespace nestgrid
