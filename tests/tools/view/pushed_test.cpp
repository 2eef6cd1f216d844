// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces that a solver pushes into a page, as readers get them by HTTP: what was pushed, the
// newest first, and the solver waits for none of them.
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/outlines.hpp>
#include <nestgrid/view/page.hpp>

#include <pushed_surfaces.hpp>

#include "frame_of.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"

using namespace nestgrid;
using namespace nestgrid_test;
using nestgrid::view::Page;
using namespace std::chrono_literals;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

int port_of(const Page& page) { return std::stoi(page.address().substr(17)); }
std::string root_of(const Page& page) { return page.address().substr(page.address().find('/', 8)); }

/// A page in a browser.
class Reader {
public:
    explicit Reader(const Page& page) : client_("127.0.0.1", port_of(page)), root_{root_of(page)} {
        client_.set_keep_alive(true);
        client_.set_read_timeout(30s);
    }
    /// The answer to a request; empty where the server does not answer.
    std::optional<Frame> ask(const std::string& request) {
        const auto answer = client_.Get(root_ + "frame?" + request);
        if (!answer || answer->status != 200) return {};
        const auto* bytes = reinterpret_cast<const std::byte*>(answer->body.data());
        return Frame(std::vector<std::byte>(bytes, bytes + answer->body.size()));
    }
    std::optional<Frame> ask_after(std::uint64_t number) {
        return ask("after=" + std::to_string(number));
    }

private:
    httplib::Client client_;
    std::string root_;
};

std::uint64_t number_of(const Frame& frame) {
    return static_cast<std::uint64_t>(frame.number("number"));
}
bool has_ended(const Frame& frame) {
    return frame.text().find("\"ended\":true") != std::string::npos;
}

/// Asks for a frame and reads nothing of it.
class StalledReader {
public:
    explicit StalledReader(const Page& page) : socket_{::socket(AF_INET, SOCK_STREAM, 0)} {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port_of(page)));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
            throw std::runtime_error("no connection");
        }
        const std::string head =
            "GET " + root_of(page) + "frame?after=0 HTTP/1.1\r\nHost: localhost\r\n\r\n";
        send(socket_, head.data(), head.size(), 0);
    }
    StalledReader(const StalledReader&) = delete;
    StalledReader& operator=(const StalledReader&) = delete;
    ~StalledReader() { close(socket_); }

private:
    int socket_;
};

/// A strip of triangles, all of whose coordinates, indices and attributes follow from a number.
Surface<3> strip(std::size_t vertices, double number) {
    Surface<3> surface;
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto x = static_cast<double>(v);
        surface.vertices.push_back({number, x / 3, number + x});
        surface.attributes.push_back(number - x);
    }
    for (std::uint32_t v = 2; v < vertices; ++v) surface.simplices.push_back({v - 2, v - 1, v});
    return surface;
}

/// A sphere with normals, elements and, in the second component, the distance from a plane.
Surface<3> sphere() {
    std::vector<double> samples;
    for (int z = -8; z <= 8; ++z) {
        for (int y = -8; y <= 8; ++y) {
            for (int x = -8; x <= 8; ++x) samples.push_back(std::hypot(x, y, z));
        }
    }
    const LatticeBisection<3> grid({.samples = {17, 17, 17}});
    const LatticeField field(grid, std::span<const double>(samples));
    Surface<3> surface =
        isosurface(grid, field, 6.0, {.threshold = 0.1}, {.normals = true}).surface;
    for (const Point& x : surface.vertices) {
        surface.attributes.push_back(x[0]);
        surface.attributes.push_back(x[2] - 8);
    }
    return surface;
}

std::vector<float> floats_of(std::span<const Point> points) {
    std::vector<float> result;
    for (const Point& x : points) {
        for (const double c : x) result.push_back(static_cast<float>(c));
    }
    return result;
}

template <int dimension>
void expect_mesh(const Frame& frame, const std::string& kind, const Surface<dimension>& surface) {
    expect_same_bits(frame.array<float>(kind, "positions"), floats_of(surface.vertices),
                     "vertices");
    std::vector<std::uint32_t> indices;
    for (const auto& simplex : surface.simplices) {
        indices.insert(indices.end(), simplex.begin(), simplex.end());
    }
    expect_same_bits(frame.array<std::uint32_t>(kind, "indices"), indices, "simplices");
}

std::size_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t all = 0;
    std::size_t resident = 0;
    file >> all >> resident;
    return resident * 4096;
}

}  // namespace

TEST(Pushed, SurfacesArriveBitForBit) {
    Page page;
    const Surface<3> surface = sphere();
    page.push(surface, {.time = 0.1,
                        .step = 7,
                        .field = "height",
                        .isovalue = 6,
                        .component = 1,
                        .numbers = {{"residual", 1e-9}}});
    const Frame frame = Reader(page).ask("after=0&outlines=on").value();
    expect_mesh(frame, "surface", surface);
    expect_mesh(frame, "outlines", outlines(surface));
    std::vector<float> heights;
    for (const Point& x : surface.vertices) heights.push_back(static_cast<float>(x[2] - 8));
    expect_same_bits(frame.array<float>("surface", "values"), heights, "values");
    const auto normals = frame.array<std::int8_t>("surface", "normals");
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        for (std::size_t d = 0; d < 3; ++d) {
            ASSERT_EQ(normals[4 * v + d], std::lround(127 * surface.normals[v][d]));
        }
    }
    EXPECT_EQ(frame.number("time"), 0.1);
    EXPECT_EQ(frame.number("step"), 7);
    EXPECT_EQ(frame.number("isovalue"), 6);
    EXPECT_EQ(frame.number("triangles"), surface.simplices.size());
    EXPECT_EQ(frame.number("value"), 1e-9);
    const auto [least, greatest] = std::ranges::minmax(heights);
    EXPECT_NEAR(frame.number("least"), least, 1e-6);
    EXPECT_NEAR(frame.number("greatest"), greatest, 1e-6);
    EXPECT_NE(frame.text().find("\"field\":\"height\""), std::string::npos);
}

TEST(Pushed, ColoursAndBoxCoverAllSurfacesUnlessTheSolverSays) {
    Page page;
    page.push(strip(10, 0));
    page.push(strip(4, 1));
    const Frame grown = Reader(page).ask_after(0).value();
    EXPECT_EQ(grown.number("least"), -9);
    EXPECT_EQ(grown.number("greatest"), 1);
    EXPECT_NE(grown.text().find("\"box\":[[0,0,0],[1,3,9]]"), std::string::npos) << grown.text();
    page.push(strip(4, 2), {.range = {-1, 1}});
    const Frame told = Reader(page).ask_after(2).value();
    EXPECT_EQ(told.number("least"), -1);
    EXPECT_EQ(told.number("greatest"), 1);
}

TEST(Pushed, ReadersGetTheNewestSurfaceAndWaitForTheNext) {
    Page page;
    Reader reader(page);
    auto first = std::async(std::launch::async, [&] { return reader.ask_after(0); });
    std::this_thread::sleep_for(50ms);
    page.push(strip(5, 1));
    EXPECT_EQ(number_of(first.get().value()), 1U);
    for (int i = 2; i <= 4; ++i) page.push(strip(5, i));
    const Frame newest = reader.ask_after(1).value();
    EXPECT_EQ(number_of(newest), 4U);
    expect_mesh(newest, "surface", strip(5, 4));
    auto next = std::async(std::launch::async, [&] { return reader.ask_after(4); });
    EXPECT_EQ(next.wait_for(200ms), std::future_status::timeout);
    page.push(strip(5, 5));
    EXPECT_EQ(number_of(next.get().value()), 5U);
}

TEST(Pushed, ReadersBeyondThoseWhoMayWaitAreAnsweredAtOnce) {
    view::PushedSurfaces surfaces({}, 1);
    auto waits = std::async(std::launch::async,
                            [&] { return surfaces.frame("after=0", [] { return true; }); });
    std::this_thread::sleep_for(100ms);
    const auto start = Clock::now();
    EXPECT_FALSE(Frame(*surfaces.frame("after=0", [] { return true; })).has("surface"));
    EXPECT_LT(seconds_since(start), 5);
    EXPECT_EQ(waits.wait_for(0s), std::future_status::timeout);
    surfaces.stop();
    EXPECT_TRUE(has_ended(Frame(*waits.get())));
}

TEST(Pushed, SeveralReadersFollowOneWhoPushes) {
    constexpr std::uint64_t last = 400;
    Page page;
    const auto follow = [&] {
        Reader reader(page);
        std::uint64_t number = 0;
        while (number < last) {
            const Frame frame = reader.ask_after(number).value();
            if (!frame.has("surface")) continue;
            EXPECT_GT(number_of(frame), number);
            number = number_of(frame);
            const auto n = static_cast<double>(number);
            EXPECT_EQ(frame.number("time"), n);
            expect_mesh(frame, "surface", strip(3 + number, n));
        }
        return number;
    };
    std::vector<std::future<std::uint64_t>> readers;
    for (int r = 0; r < 4; ++r) readers.push_back(std::async(std::launch::async, follow));
    for (std::uint64_t i = 1; i <= last; ++i) {
        const auto n = static_cast<double>(i);
        page.push(strip(3 + i, n), {.time = n});
        if (i % 8 == 0) std::this_thread::sleep_for(1ms);
    }
    for (auto& reader : readers) EXPECT_EQ(reader.get(), last);
}

TEST(Pushed, StalledReadersHoldUpNeitherTheSolverNorOthers) {
    constexpr std::size_t vertices = 300000;
    const Surface<3> large = strip(vertices, 1);
    std::optional<Page> page(std::in_place);
    page->push(large);
    const StalledReader stalled[] = {StalledReader(*page), StalledReader(*page),
                                     StalledReader(*page)};
    std::this_thread::sleep_for(300ms);
    const std::size_t before = resident_bytes();
    double longest = 0;
    for (int i = 0; i < 60; ++i) {
        const auto start = Clock::now();
        page->push(large, {.time = i});
        longest = std::max(longest, seconds_since(start));
        if (i % 20 == 0) {
            EXPECT_TRUE(Reader(*page).ask_after(0));
        }
    }
    std::printf("the longest of 60 pushes took %.1f ms\n", 1000 * longest);
    EXPECT_LT(longest, 2);
    // One push has 17 MB, and as much once more as bytes.
    EXPECT_LT(resident_bytes(), before + (200U << 20U));
    const auto start = Clock::now();
    page.reset();
    EXPECT_LT(seconds_since(start), 4);
}

TEST(Pushed, AtTheEndReadersHaveTheNewestSurfaceAndAreTold) {
    std::optional<Page> page(std::in_place);
    const auto follow = [reader = std::make_shared<Reader>(*page)] {
        std::uint64_t number = 0;
        while (const auto frame = reader->ask_after(number)) {
            number = number_of(*frame);
            if (has_ended(*frame)) return number;
        }
        return number + 1000;
    };
    auto reader = std::async(std::launch::async, follow);
    for (int i = 1; i <= 3; ++i) {
        page->push(strip(100000, i));
        std::this_thread::sleep_for(20ms);
    }
    page->push(strip(5, 4));
    const auto start = Clock::now();
    page.reset();
    EXPECT_LT(seconds_since(start), 3);
    EXPECT_EQ(reader.get(), 4U);
}

TEST(Pushed, PagesEndAtOnce) {
    for (int i = 0; i < 20; ++i) Page();
    std::optional<Page> page(std::in_place);
    Reader reader(*page);
    auto waits = std::async(std::launch::async, [&] { return reader.ask_after(0); });
    std::this_thread::sleep_for(100ms);
    const auto start = Clock::now();
    page.reset();
    EXPECT_LT(seconds_since(start), 3);
    EXPECT_TRUE(has_ended(waits.get().value()));
}

TEST(Pushed, OthersAreRefusedAndThePageLivesOn) {
    Page page;
    page.push(strip(5, 1));
    httplib::Client client("127.0.0.1", port_of(page));
    const std::string root = root_of(page);
    std::string wrong = root;
    wrong[1] = wrong[1] == '0' ? '1' : '0';
    const auto status = [&](const std::string& path, const httplib::Headers& headers = {}) {
        const auto answer = client.Get(path, headers);
        return answer ? answer->status : 0;
    };
    EXPECT_EQ(status(root), 200);
    EXPECT_EQ(status(root + "frame?after=0"), 200);
    EXPECT_EQ(status(root + "frame?after=0", {{"Host", "localhost:9"}}), 200);
    EXPECT_EQ(status(root + "frame?after=0", {{"Host", "example.com"}}), 403);
    EXPECT_EQ(status(wrong + "frame?after=0"), 403);
    EXPECT_EQ(status("/frame?after=0"), 403);
    EXPECT_EQ(status(root + "../page.cpp"), 404);
    for (const char* request : {"after=x", "after=-1", "after=1e300", "after=0.5", "after=nan",
                                "after=0&after=0", "isovalue=1", "outlines=yes"}) {
        EXPECT_EQ(status(root + "frame?" + request), 400) << request;
    }
    EXPECT_EQ(client.Post(root + "frame?after=0")->status, 405);
    EXPECT_EQ(status(root + "frame?after=0"), 200);
}

TEST(Pushed, WrongSurfacesAreRefusedWithASentence) {
    Page page;
    page.push(strip(5, 1));
    const auto push = [&](const auto& spoil, const view::PushOptions& options = {}) {
        return [&page, spoil, options] {
            Surface<3> surface = strip(5, 2);
            spoil(surface);
            page.push(surface, options);
        };
    };
    const auto nothing = [](Surface<3>&) {};
    expect_refused(push([](auto& s) { s.simplices[1][2] = 5; }), "triangle 1 names a vertex");
    expect_refused(push([](auto& s) { s.vertices[3][1] = NAN; }), "vertex 3 is not finite");
    expect_refused(push([](auto& s) { s.normals.resize(4); }), "4 normals");
    expect_refused(push([](auto& s) { s.attributes.pop_back(); }), "4 attributes");
    expect_refused(push(nothing, {.component = 1}), "component 1");
    expect_mesh(Reader(page).ask_after(0).value(), "surface", strip(5, 1));
    page.push({});
    EXPECT_EQ(Reader(page).ask_after(1).value().number("triangles"), 0);
}

TEST(Pushed, SignalsAreTheSolvers) {
    struct sigaction before {};
    struct sigaction after {};
    sigaction(SIGPIPE, nullptr, &before);
    const Page page;
    sigaction(SIGPIPE, nullptr, &after);
    EXPECT_EQ(before.sa_handler, after.sa_handler);
    int threads = 0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        if (task.path().filename() == std::to_string(getpid())) continue;
        ++threads;
        std::ifstream file(task.path() / "status");
        for (std::string line; std::getline(file, line);) {
            if (!line.starts_with("SigBlk:")) continue;
            const auto blocked = std::stoull(line.substr(7), nullptr, 16);
            for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGCHLD, SIGALRM}) {
                EXPECT_TRUE((blocked >> (signal - 1) & 1U) != 0) << signal;
            }
        }
    }
    EXPECT_GE(threads, 1);
    sigset_t mine;
    pthread_sigmask(SIG_SETMASK, nullptr, &mine);
    EXPECT_EQ(sigismember(&mine, SIGINT), 0);
}

TEST(Pushed, APortIsTakenOnce) {
    const Page page;
    EXPECT_NE(refusal<IoError>([&] { Page({.port = port_of(page)}); }).find("is not free"),
              std::string::npos);
}
