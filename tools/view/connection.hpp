// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One connection to a browser, within limits that cpp-httplib 0.11 does not have: it reads lines of
// any length, and bodies of any size to throw them away.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <optional>

#include <httplib.h>

namespace nestgrid::view {

class Connection final : public httplib::Stream {
public:
    static constexpr std::size_t longest_head = 16384;  ///< bytes of the head of a request

    /// \param socket is closed with the connection
    /// \param stopping borrowed; once it is set, the connection ends within a second
    Connection(socket_t socket, const std::atomic<bool>& stopping);
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    /// Tells the other side that nothing more comes, and waits a moment for it to understand.
    ~Connection() override;

    /// Waits for the next request.
    /// \return whether there is one within 10 seconds; while stopping, within 0.3 seconds
    bool wait();

    /// Whether the other side still waits for an answer: it has not closed the connection.
    bool is_open() const;

    bool is_readable() const override;
    bool is_writable() const override;
    /// Ends with an error where a head is too long or takes more than 5 seconds.
    ssize_t read(char* to, std::size_t size) override;
    /// Sends everything. Ends with an error where nothing can be sent for 20 seconds.
    ssize_t write(const char* from, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return socket_; }

private:
    using Clock = std::chrono::steady_clock;

    bool poll_for(short events, std::chrono::milliseconds time) const;
    /// The same, but in vain once the connection must end.
    bool wait_for(short events, std::chrono::milliseconds time) const;
    /// Whether the server has been stopping for a second.
    bool must_end() const;

    socket_t socket_;
    const std::atomic<bool>* stopping_;
    mutable std::optional<Clock::time_point> end_at_;  // set when the connection sees it stop
    std::array<char, 4096> buffer_{};
    std::size_t begin_ = 0;  // of what is in the buffer and not yet read
    std::size_t end_ = 0;
    std::size_t left_ = longest_head;  // bytes of the head that may still be read
    Clock::time_point deadline_{};     // of the head
};

}  // namespace nestgrid::view
