// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/view/page.hpp>

#include <csignal>
#include <thread>

#include "page_server.hpp"
#include "pushed_surfaces.hpp"

namespace nestgrid::view {

class Page::Served {
public:
    explicit Served(const PageOptions& options)
        : surfaces{options, PageServer::connections / 2}, server{surfaces, options.port} {
        // Threads that follow, those of the server, leave signals to the solver.
        sigset_t all;
        sigset_t before;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        thread_ = std::thread([this] { server.run(); });
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
    }
    Served(const Served&) = delete;
    Served& operator=(const Served&) = delete;
    ~Served() {
        server.stop();
        thread_.join();
    }

    PushedSurfaces surfaces;
    PageServer server;

private:
    std::thread thread_;
};

Page::Page(const PageOptions& options)
    : served_{std::make_unique<Served>(options)}, address_{served_->server.address()} {}

Page::~Page() = default;

void Page::push(Surface<3> surface, PushOptions options) {
    served_->surfaces.push(std::move(surface), std::move(options));
}

}  // namespace nestgrid::view
