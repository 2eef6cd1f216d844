// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A page for browsers that shows the surfaces of a solver while it runs.
//
// Invariants:
//   - the solver never waits for a reader: push() hands a surface over and returns. A reader gets
//     the newest surface when it asks for one, and never those that came between;
//   - memory holds the newest surface, as it was pushed and as bytes, and what is being sent;
//   - what is sent is what was pushed: the same triangles, vertices rounded to float;
//   - the page is served on 127.0.0.1 alone, under an address that only its owner knows.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid::view {

struct PageOptions {
    std::string title = "solver";  ///< of the page
    /// The least and the greatest coordinates of the domain; where they are equal: of all surfaces
    /// so far.
    std::array<Point, 2> box{};
    int port = 0;  ///< of 127.0.0.1; 0: any that is free
};

/// What a page tells of a surface.
struct PushOptions {
    std::optional<double> time{};
    std::optional<std::uint64_t> step{};
    std::string field = "value";       ///< name of what colours the surface
    std::optional<double> isovalue{};  ///< of the field, where the surface has one
    std::size_t component = 0;         ///< of the attributes, which colours the surface
    /// Values at the ends of the colours; where they are equal: of all surfaces so far.
    std::array<double, 2> range{};
    std::vector<std::pair<std::string, double>> numbers{};  ///< more to tell: names and values
};

class Page {
public:
    /// Serves a page, by threads of its own that take no signals of the program.
    /// \throw IoError where the port is not free
    explicit Page(const PageOptions& options = {});
    /// Tells readers that the solver has ended, and ends within two seconds. Readers who do not lag
    /// behind have the newest surface then.
    ~Page();
    Page(const Page&) = delete;
    Page& operator=(const Page&) = delete;

    /// http://127.0.0.1:PORT/TOKEN/, to be opened in a browser.
    const std::string& address() const { return address_; }

    /// Shows a surface in the place of the last one. May be called by any thread.
    /// Attributes, where there are some, colour the surface; normals, where there are none, are
    /// made of triangles; a surface that keeps its elements has outlines. Takes time proportional
    /// to the size of the surface, for checks and, unless the surface is moved, a copy.
    /// \throw InvalidInput where a triangle names a vertex that does not exist, a vertex is not
    ///        finite, normals or attributes are not as many as vertices, or there is no such
    ///        component. The page keeps the surface it has.
    void push(Surface<3> surface, PushOptions options = {});

private:
    class Served;

    std::unique_ptr<Served> served_;
    std::string address_;
};

}  // namespace nestgrid::view
