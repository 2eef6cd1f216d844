// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <utility>

#include <nestgrid/view/page.hpp>

int main() {
    nestgrid::view::Page page({.title = "A triangle"});
    nestgrid::Surface<3> triangle;
    triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.simplices = {{0, 1, 2}};
    page.push(std::move(triangle), {.field = "temperature"});
    std::printf("%s\n", page.address().c_str());
    return page.address().starts_with("http://127.0.0.1:") ? 0 : 1;
}
