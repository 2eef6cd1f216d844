// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/error.hpp>

#include "explored_files.hpp"
#include "explorer.hpp"
#include "options/command_line.hpp"
#include "page_server.hpp"

namespace {

namespace fs = std::filesystem;
using namespace nestgrid::view;
using nestgrid::InvalidInput;

struct ViewArguments {
    Input input;
    std::vector<fs::path> more;
    std::vector<double> times;
    int port = 0;
    int threads = 0;
    bool no_browser = false;
};

/// \throw InvalidInput where times do not ascend
void check_times(const std::vector<double>& times) {
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i]) || (i > 0 && !(times[i - 1] < times[i]))) {
            throw InvalidInput("--times are not finite numbers in ascending order");
        }
    }
}

/// Shows an address in the reader's browser, where there is a screen.
void open_browser(const std::string& address) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    std::string program = "xdg-open";
    std::string argument = address;
    const std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
    pid_t child = 0;
    posix_spawnp(&child, program.c_str(), &quiet, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&quiet);
}

/// Calls a function at the end of a scope.
template <class Function>
class AtEnd {
public:
    explicit AtEnd(Function function) : function_{std::move(function)} {}
    AtEnd(const AtEnd&) = delete;
    AtEnd& operator=(const AtEnd&) = delete;
    ~AtEnd() { function_(); }

private:
    Function function_;
};

/// Draws one frame at a time.
class ExploredFrames final : public FrameSource {
public:
    explicit ExploredFrames(Explorer& explorer) : explorer_{&explorer} {}
    std::string info() override { return explorer_->info(); }
    Bytes frame(std::string_view request, const std::function<bool()>& is_wanted) override {
        std::unique_lock lock(drawing_, std::defer_lock);
        while (!lock.try_lock_for(std::chrono::milliseconds{20})) {
            if (!is_wanted()) throw FrameAbandoned{};
        }
        const auto watch = [&](const FrameStep& step) {
            tell(step);
            return is_wanted();
        };
        const AtEnd quiet([&] { tell({}); });
        return std::make_shared<const std::vector<std::byte>>(explorer_->frame(request, watch));
    }
    std::string pulse() override {
        const std::scoped_lock lock(telling_);
        return pulse_of(step_);
    }

private:
    void tell(const FrameStep& step) {
        const std::scoped_lock lock(telling_);
        step_ = step;
    }

    Explorer* explorer_;
    std::timed_mutex drawing_;
    std::mutex telling_;  // of the step
    FrameStep step_{};
};

/// Serves until the program is interrupted or asked to end.
void serve(PageServer& server) {
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    std::thread waiting([&] {
        int signal = 0;
        sigwait(&ends, &signal);
        server.stop();
    });
    server.run();
    waiting.join();
}

void run_view(ViewArguments& o, Report& report) {
    if (o.port < 0 || o.port > 65535) throw InvalidInput("--port is not from 0 to 65535");
    if (o.threads < 0) throw InvalidInput("--threads is negative");
    check_times(o.times);
    std::optional<ProgressLine> progress(std::in_place);
    progress->show("reading");
    ExploredField field = read_explored(o.input, o.more, o.times);
    if (!field.note.empty()) {
        progress.reset();
        std::fprintf(stderr, "nestgrid: %s\n", field.note.c_str());
        progress.emplace();
    }
    progress->show("preroll");

    // The threads that follow leave these signals to the one that waits for them.
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &ends, nullptr);
    std::signal(SIGCHLD, SIG_IGN);

    const nestgrid::TbbExecutor executor(o.threads);
    Explorer explorer(std::move(field), executor);
    progress.reset();
    ExploredFrames frames(explorer);
    PageServer server(frames, o.port);
    if (report.json()) {
        report.add("address", server.address());
        report.print();
    } else {
        std::printf("%s\n", server.address().c_str());
        std::fflush(stdout);
    }
    if (isatty(STDOUT_FILENO) == 1 && !report.json()) {
        std::printf("Open this address in a browser; Ctrl+C ends.\n");
    }
    if (!o.no_browser) open_browser(server.address());
    serve(server);
}

Command add_view(CLI::App& program) {
    auto o = std::make_shared<ViewArguments>();
    CLI::App* view =
        program.add_subcommand("view", "explore a field in the browser, by a page on 127.0.0.1");
    view->footer(
        "Examples:\n"
        "  nestgrid view head.nii.gz\n");
    add_input(*view, o->input);
    view->add_option("FRAMES", o->more,
                     "further files of the same layout: later frames of the same field");
    view->add_option("--port", o->port, "of 127.0.0.1 [any that is free]")->type_name("NUMBER");
    view->add_flag("--no-browser", o->no_browser, "print the address and open no browser");
    view->add_option("--times", o->times,
                     "times of all frames, ascending [those of the file, or 0,1,2,...]")
        ->type_name("T,T,...")
        ->delimiter(',');
    view->add_option("--threads", o->threads, "how many to use [all]")
        ->type_name("COUNT")
        ->group("Further");
    add_read_options(*view, o->input);
    return {view, [o](Report& report) { run_view(*o, report); }};
}

const RegisteredCommand view_command(120, add_view);

}  // namespace
