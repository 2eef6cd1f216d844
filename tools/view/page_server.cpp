// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "page_server.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <map>
#include <random>
#include <thread>

#include <nestgrid/error.hpp>

#include "connection.hpp"

namespace nestgrid::view {

namespace {

/// 128 random bits as 32 digits.
std::string random_token() {
    std::random_device random;
    std::string token;
    for (int i = 0; i < 4; ++i) {
        const unsigned bits = random();
        for (unsigned shift = 0; shift < 32; shift += 4) {
            token += "0123456789abcdef"[bits >> shift & 15U];
        }
    }
    return token;
}

/// In a time that tells nothing of where they differ.
bool same_token(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference |= static_cast<unsigned char>(a[i] ^ b[i]);
    }
    return difference == 0;
}

/// Whether a host is this machine by a name that no other site can take.
bool is_local(std::string_view host) {
    const std::size_t colon = host.rfind(':');
    if (colon != std::string_view::npos) {
        const std::string_view port = host.substr(colon + 1);
        if (port.empty() || port.size() > 5 ||
            port.find_first_not_of("0123456789") != std::string_view::npos) {
            return false;
        }
        host = host.substr(0, colon);
    }
    return host == "localhost" || host == "127.0.0.1";
}

void answer(httplib::Response& response, int status, const std::string& sentence) {
    response.status = status;
    response.set_content(sentence, "text/plain; charset=utf-8");
}

/// Leaves what a signal does as it is.
class KeptSignal {
public:
    explicit KeptSignal(int signal) : signal_{signal} { sigaction(signal, nullptr, &action_); }
    KeptSignal(const KeptSignal&) = delete;
    KeptSignal& operator=(const KeptSignal&) = delete;
    ~KeptSignal() { sigaction(signal_, &action_, nullptr); }

private:
    int signal_;
    struct sigaction action_ {};
};

}  // namespace

class PageServer::Http final : public httplib::Server {
public:
    explicit Http(FrameSource& source) : source_{&source} {
        for (const PageFile& file : page_files()) files_.emplace(file.name, file);
        new_task_queue = [] { return new httplib::ThreadPool(connections); };
        // Without the default, SO_REUSEPORT, by which two servers share a port.
        set_socket_options([](socket_t socket) {
            const int on = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        });
        set_default_headers(
            {{"Cache-Control", "no-store"},
             {"Content-Security-Policy",
              "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
              "img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; "
              "frame-ancestors 'none'"},
             {"Cross-Origin-Resource-Policy", "same-origin"},
             {"Referrer-Policy", "no-referrer"},
             {"X-Content-Type-Options", "nosniff"}});
        set_pre_routing_handler([this](const auto& request, auto& response) {
            handle(request, response);
            return HandlerResponse::Handled;
        });
    }

    const std::string& token() const { return token_; }
    void run() {
        listen_after_bind();
        has_run_ = true;
    }
    void stop_all() {
        stopping_ = true;
        source_->stop();
        // The base does nothing where it does not listen yet.
        while (!is_running() && !has_run_)
            std::this_thread::sleep_for(std::chrono::milliseconds{1});
        stop();
    }

private:
    /// Answers the requests of one connection. Closes it behind a request with a body, which is not
    /// read.
    bool process_and_close_socket(socket_t socket) override {
        Connection connection(socket, stopping_);
        bool last = false;
        while (!last && connection.wait()) {
            const auto look = [&](httplib::Request& request) {
                // For serve(). cpp-httplib asks this of clients alone.
                request.progress = [&](auto, auto) { return connection.is_open(); };
                last = has_body(request) || request.has_header("Expect");
                request.headers.erase("Expect");
                if (!last) return;
                request.headers.erase("Connection");
                request.set_header("Connection", "close");
            };
            bool closed = false;
            if (!process_request(connection, false, closed, look)) break;
            last |= closed;
        }
        return true;
    }

    static bool has_body(const httplib::Request& request) {
        const std::string length = request.get_header_value("Content-Length");
        return (!length.empty() && length != "0") || request.has_header("Transfer-Encoding");
    }

    void handle(const httplib::Request& request, httplib::Response& response) const {
        const std::string_view target = request.target;
        const std::string_view path = target.substr(0, target.find('?'));
        const std::string_view rest = path.substr(std::min<std::size_t>(path.size(), 1));
        const std::size_t slash = rest.find('/');
        if (!is_local(request.get_header_value("Host"))) {
            answer(response, 403, "This server answers to localhost and 127.0.0.1 alone.\n");
        } else if (!same_token(rest.substr(0, slash), token_)) {
            answer(response, 403, "The address has not the token that was printed with it.\n");
        } else if (has_body(request)) {
            answer(response, 413, "A request has no body here.\n");
        } else if (request.method != "GET") {
            answer(response, 405, "There is only GET here.\n");
        } else if (slash == std::string_view::npos) {
            response.set_redirect("/" + token_ + "/");
        } else {
            const std::size_t query = target.find('?');
            serve(
                rest.substr(slash + 1),
                query == std::string_view::npos ? std::string_view{} : target.substr(query + 1),
                [&] { return request.progress(0, 0); }, response);
        }
    }

    void serve(std::string_view name, std::string_view query,
               const std::function<bool()>& is_wanted, httplib::Response& response) const {
        try {
            if (name == "info") {
                response.set_content(source_->info(), "application/json");
            } else if (name == "pulse") {
                response.set_content(source_->pulse(), "application/json");
            } else if (name == "frame") {
                const FrameSource::Bytes frame = source_->frame(query, is_wanted);
                response.set_content(reinterpret_cast<const char*>(frame->data()), frame->size(),
                                     "application/octet-stream");
            } else if (const auto file = files_.find(name.empty() ? "index.html" : name);
                       file != files_.end()) {
                const PageFile& found = file->second;
                response.set_content(found.content.data(), found.content.size(),
                                     std::string(found.type));
            } else {
                answer(response, 404, "There is no such file here.\n");
            }
        } catch (const InvalidInput& error) {
            answer(response, 400, error.what());
        } catch (const GridError& error) {
            answer(response, 400, error.what());
        } catch (const FrameAbandoned&) {
            answer(response, 503, "Nobody waits for this frame any more.\n");
        } catch (const std::bad_alloc&) {
            answer(response, 500, "There is not enough memory for this picture.\n");
        }
    }

    const std::string token_ = random_token();
    std::map<std::string_view, PageFile> files_;
    FrameSource* source_;
    std::atomic<bool> stopping_ = false;
    std::atomic<bool> has_run_ = false;
};

PageServer::PageServer(FrameSource& source, int port) {
    const KeptSignal pipe(SIGPIPE);  // which cpp-httplib changes, and Connection does not raise
    http_ = std::make_unique<Http>(source);
    const std::string host = "127.0.0.1";
    const int bound = port == 0                         ? http_->bind_to_any_port(host)
                      : http_->bind_to_port(host, port) ? port
                                                        : -1;
    if (bound < 0) throw IoError("port " + std::to_string(port) + " of " + host + " is not free");
    address_ = "http://" + host + ":" + std::to_string(bound) + "/" + http_->token() + "/";
}

PageServer::~PageServer() = default;
void PageServer::run() { http_->run(); }
void PageServer::stop() { http_->stop_all(); }

}  // namespace nestgrid::view
