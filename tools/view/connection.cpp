// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "connection.hpp"

#include <algorithm>
#include <cstring>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace nestgrid::view {

using std::chrono::milliseconds;

namespace {

constexpr milliseconds idle_time{10000};
constexpr milliseconds head_time{5000};
constexpr milliseconds send_time{20000};
constexpr milliseconds goodbye_time{300};
constexpr milliseconds slice{100};

}  // namespace

Connection::Connection(socket_t socket) : socket_{socket} {
    const int on = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

Connection::~Connection() {
    // Who is closed with bytes unread resets the connection, and the other side may lose the
    // answer.
    shutdown(socket_, SHUT_WR);
    const auto end = Clock::now() + goodbye_time;
    while (Clock::now() < end && poll_for(POLLIN, slice)) {
        if (recv(socket_, buffer_.data(), buffer_.size(), 0) <= 0) break;
    }
    close(socket_);
}

bool Connection::poll_for(short events, milliseconds time) const {
    pollfd one{socket_, events, 0};
    return poll(&one, 1, static_cast<int>(time.count())) > 0;
}

bool Connection::wait(const std::atomic<bool>& stopping) {
    const auto end = Clock::now() + idle_time;
    while (begin_ == end_ && !poll_for(POLLIN, slice)) {
        if (stopping || Clock::now() > end) return false;
    }
    left_ = longest_head;
    deadline_ = Clock::now() + head_time;
    return !stopping;
}

bool Connection::is_readable() const { return begin_ < end_ || poll_for(POLLIN, milliseconds{0}); }
bool Connection::is_writable() const { return poll_for(POLLOUT, send_time); }

ssize_t Connection::read(char* to, std::size_t size) {
    if (left_ == 0) return -1;
    if (begin_ == end_) {
        const auto time = std::chrono::duration_cast<milliseconds>(deadline_ - Clock::now());
        if (time.count() <= 0 || !poll_for(POLLIN, time)) return -1;
        const ssize_t got = recv(socket_, buffer_.data(), buffer_.size(), 0);
        if (got <= 0) return got;
        begin_ = 0;
        end_ = static_cast<std::size_t>(got);
    }
    const std::size_t count = std::min({size, end_ - begin_, left_});
    std::memcpy(to, buffer_.data() + begin_, count);
    begin_ += count;
    left_ -= count;
    return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* from, std::size_t size) {
    if (!poll_for(POLLOUT, send_time)) return -1;
    return send(socket_, from, size, MSG_NOSIGNAL);
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
    ip.clear();
    port = 0;
}
void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
    ip.clear();
    port = 0;
}

}  // namespace nestgrid::view
