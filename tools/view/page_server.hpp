// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Serves the page on 127.0.0.1 and answers its requests.
//
// Invariants:
//   - every address begins with a token of 128 random bits, which other users of the machine do not
//     know;
//   - only requests to the hosts localhost and 127.0.0.1 are answered, at any port, so that no page
//     of another site reaches the server by a name of its own, and a tunnel (ssh -L) does;
//   - files are part of the program and have fixed names: no path from a request reaches the file
//   system;
//   - a request is a GET without a body, with a head of 16 KiB at most.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "frame_source.hpp"

namespace nestgrid::view {

/// A file of the page.
struct PageFile {
    std::string_view name;
    std::string_view type;  ///< of MIME
    std::string_view content;
};

/// The files of the page, which the library holds (page_files.cmake).
std::vector<PageFile> page_files();

class PageServer {
public:
    /// Connections that are served at a time. A browser opens up to six to begin with, and keeps
    /// one.
    static constexpr std::size_t connections = 32;

    /// Takes a port of 127.0.0.1.
    /// \param source borrowed
    /// \param port 0: any
    /// \throw IoError where the port is not free
    PageServer(FrameSource& source, int port);
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    /// http://127.0.0.1:PORT/TOKEN/
    const std::string& address() const { return address_; }

    /// Serves until stop() is called, and then for a moment more the readers who are connected, so
    /// that they learn of the end.
    void run();
    /// May be called by any thread. Waits for run() to begin, and not for it to end.
    void stop();

private:
    class Http;
    std::string address_;
    std::unique_ptr<Http> http_;
};

}  // namespace nestgrid::view
