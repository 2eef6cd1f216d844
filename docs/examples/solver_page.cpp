// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver_page.hpp"

#include <cstdio>

#include <nestgrid/view/page.hpp>

ShowSurface show_in_page(const std::string& title, const std::array<nestgrid::Point, 2>& box) {
    using nestgrid::view::Page;
    const auto page =
        std::make_shared<Page>(nestgrid::view::PageOptions{.title = title, .box = box});
    std::printf("%s\n", page->address().c_str());
    std::fflush(stdout);
    return [page](SolverSurface shown) {
        page->push(std::move(shown.surface),
                   {.time = shown.time, .step = shown.step, .field = shown.field});
    };
}
