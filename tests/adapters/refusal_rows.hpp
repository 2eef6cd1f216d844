// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The table of docs/refusals.md: an adapter, a state in which it is wrong, what is said of it.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>

#include "refusal.hpp"

namespace nestgrid_test {

/// Works in the folder of the tests, so that sentences name files as they are given.
class InTestFolder {
public:
    InTestFolder() { std::filesystem::current_path(testing::TempDir()); }
    InTestFolder(const InTestFolder&) = delete;
    InTestFolder& operator=(const InTestFolder&) = delete;
    ~InTestFolder() { std::filesystem::current_path(before_); }

private:
    std::filesystem::path before_ = std::filesystem::current_path();
};

/// The rows of one adapter. Each that is called must stand in the page, and each of the page must
/// be called. With NESTGRID_PRINT_REFUSALS in the environment the rows are printed.
class RefusalRows {
public:
    explicit RefusalRows(std::string adapter) : begin_{"| " + std::move(adapter) + " |"} {
        std::ifstream page(NESTGRID_REFUSALS_PAGE);
        for (std::string line; std::getline(page, line);) {
            if (line.starts_with(begin_)) rows_.insert(line);
        }
    }
    RefusalRows(const RefusalRows&) = delete;
    RefusalRows& operator=(const RefusalRows&) = delete;
    ~RefusalRows() {
        for (const std::string& row : rows_) ADD_FAILURE() << "nobody called: " << row;
    }

    /// \tparam Error that must be thrown
    template <class Error = nestgrid::InvalidInput, class Function>
    void add(const std::string& state, Function&& function) {
        const std::string sentence = refusal<Error>(function);
        EXPECT_FALSE(sentence.empty()) << state;
        const std::string row = begin_ + " " + state + " | " + sentence + " |";
        std::puts(row.c_str());
        EXPECT_EQ(rows_.erase(row), 1U) << "not in docs/refusals.md: " << row;
    }

private:
    std::string begin_;
    std::set<std::string> rows_;
};

}  // namespace nestgrid_test
