// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "connection.hpp"

#include <algorithm>
#include <cerrno>
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
constexpr milliseconds stopping_time{1000};
constexpr milliseconds slice{100};

}  // namespace

Connection::Connection(socket_t socket, const std::atomic<bool>& stopping)
    : socket_{socket}, stopping_{&stopping} {
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

bool Connection::is_open() const {
    pollfd one{socket_, POLLRDHUP, 0};
    return poll(&one, 1, 0) <= 0 && !must_end();
}

bool Connection::must_end() const {
    if (!*stopping_) return false;
    if (!end_at_) end_at_ = Clock::now() + stopping_time;
    return Clock::now() > *end_at_;
}

bool Connection::wait() {
    const auto start = Clock::now();
    while (begin_ == end_ && !poll_for(POLLIN, slice)) {
        if (Clock::now() > start + (*stopping_ ? goodbye_time : idle_time)) return false;
    }
    left_ = longest_head;
    deadline_ = Clock::now() + head_time;
    return !must_end();
}

bool Connection::wait_for(short events, milliseconds time) const {
    const auto end = Clock::now() + time;
    while (!must_end()) {
        if (poll_for(events, slice)) return true;
        if (Clock::now() > end) return false;
    }
    return false;
}

bool Connection::is_readable() const { return begin_ < end_ || poll_for(POLLIN, milliseconds{0}); }
bool Connection::is_writable() const { return wait_for(POLLOUT, send_time); }

ssize_t Connection::read(char* to, std::size_t size) {
    if (left_ == 0) return -1;
    if (begin_ == end_) {
        const auto time = std::chrono::duration_cast<milliseconds>(deadline_ - Clock::now());
        if (time.count() <= 0 || !wait_for(POLLIN, time)) return -1;
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
    std::size_t sent = 0;
    while (sent < size) {
        if (!wait_for(POLLOUT, send_time)) return -1;
        const ssize_t now = send(socket_, from + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (now < 0 && errno != EAGAIN && errno != EINTR) return -1;
        sent += static_cast<std::size_t>(std::max<ssize_t>(now, 0));
    }
    return static_cast<ssize_t>(size);
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
