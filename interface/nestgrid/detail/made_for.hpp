// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What was made for a grid refuses to be used after the grid has changed: sizes and numbers that it
// keeps are those of another grid.
#pragma once

#include <string>

#include <nestgrid/detail/operations.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::detail {

/// The state of a grid that something was made for.
class MadeFor {
public:
    template <class Grid>
    explicit MadeFor(const Grid& grid) : epoch_{nestgrid::epoch(grid)} {}

    /// \param what was made, with its article
    /// \throw GridError where the grid has changed since
    template <class Grid>
    void require_same(const Grid& grid, const char* what) const {
        if (nestgrid::epoch(grid) != epoch_) refuse(what);
    }

private:
    [[noreturn]] static void refuse(const char* what) {
        throw GridError("the grid has changed since " + std::string(what) +
                        " was made for it: make another one");
    }

    std::uint64_t epoch_;
};

}  // namespace nestgrid::detail
