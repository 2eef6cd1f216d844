// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/virtual_display.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

#include <nestgrid/error.hpp>

namespace {

/// Whether the work succeeds in a child process.
bool succeeds_apart(const std::function<bool()>& work) {
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        _exit(work() ? 0 : 1);
    }
    int status = 1;
    if (child > 0) waitpid(child, &status, 0);
    return status == 0;
}

/// An X server without a screen, for as long as the object lives.
class VirtualDisplay {
public:
    VirtualDisplay() {
        std::array<int, 2> channel{};
        if (pipe(channel.data()) != 0) return;
        server_ = fork();
        if (server_ == 0) {
            close(channel[0]);
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDOUT_FILENO);
            dup2(nowhere, STDERR_FILENO);
            const std::string fd = std::to_string(channel[1]);
            execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1280x1024x24",
                   "-nolisten", "tcp", "-noreset", nullptr);  // windows come and go
            _exit(127);
        }
        close(channel[1]);
        std::string number;
        pollfd ready{channel[0], POLLIN, 0};
        char c = 0;
        while (poll(&ready, 1, 20000) > 0 && read(channel[0], &c, 1) == 1 && c != '\n') {
            number += c;
        }
        close(channel[0]);
        if (!number.empty()) name_ = ":" + number;
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    ~VirtualDisplay() {
        if (server_ <= 0) return;
        kill(server_, SIGTERM);
        waitpid(server_, nullptr, 0);
    }
    /// The display, or empty where no server could be started.
    const std::string& name() const { return name_; }

private:
    pid_t server_ = -1;
    std::string name_;
};

}  // namespace

void run_with_display(const std::function<bool()>& work) {
    if (std::getenv("DISPLAY") != nullptr && succeeds_apart(work)) return;
    const VirtualDisplay display;
    if (display.name().empty()) {
        throw nestgrid::IoError(
            "the picture needs an X display, and Xvfb could not be started: install the package "
            "xvfb");
    }
    const char* const before = std::getenv("DISPLAY");
    const std::string kept = before == nullptr ? "" : before;
    setenv("DISPLAY", display.name().c_str(), 1);
    const bool drawn = succeeds_apart(work);
    before == nullptr ? unsetenv("DISPLAY") : setenv("DISPLAY", kept.c_str(), 1);
    if (drawn) return;
    throw nestgrid::IoError(
        "the picture could not be drawn on an Xvfb display (is libgl1-mesa-dri installed?)");
}
