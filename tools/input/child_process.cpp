// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <fstream>
#include <new>
#include <sstream>

#include <nestgrid/error.hpp>

#include "formats.hpp"

namespace {

using nestgrid::IoError;
using Clock = std::chrono::steady_clock;

// How the child ends; foreign code that stops the program ends it with another number.
constexpr int ended_well = 100;
constexpr int ended_by_exception = 101;
constexpr int ended_without_memory = 102;

std::size_t whole_pages(std::size_t bytes) {
    static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return (bytes + page - 1) / page * page;
}

/// Bytes that could be allocated now; 0 where the system does not tell.
std::uintmax_t free_memory() {
    std::ifstream file("/proc/meminfo");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string name;
        std::uintmax_t kibibytes = 0;
        if (words >> name >> kibibytes && name == "MemAvailable:") return kibibytes * 1024;
    }
    return 0;
}

/// Bytes of the address space of this process.
std::uintmax_t used_addresses() {
    std::ifstream file("/proc/self/statm");
    std::uintmax_t pages = 0;
    file >> pages;
    return pages * whole_pages(1);
}

/// Lets the child die before the machine suffers: with its parent, without a core file, and where
/// it asks for more than nine tenths of the memory that is free.
void limit_child(pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    rlimit memory{};
    const std::uintmax_t spare = free_memory();
    if (spare == 0 || getrlimit(RLIMIT_AS, &memory) != 0) return;
    memory.rlim_cur = std::min<rlim_t>(memory.rlim_cur, used_addresses() + spare / 10 * 9);
    setrlimit(RLIMIT_AS, &memory);
}

void silence_standard_streams() {
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDIN_FILENO);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
}

/// The child's whole life.
/// \param message where it writes the text of an exception
[[noreturn]] void live_as_child(pid_t parent, int message, Parcel& parcel,
                                const std::function<void(Parcel&)>& work) {
    silence_standard_streams();
    limit_child(parent);
    try {
        work(parcel);
        _exit(ended_well);
    } catch (const std::bad_alloc&) {
        _exit(ended_without_memory);
    } catch (const std::exception& error) {
        const std::string text = error.what();
        // A pipe takes this many bytes at once.
        const bool written =
            write(message, text.data(), std::min<std::size_t>(text.size(), 4096)) > 0;
        _exit(written ? ended_by_exception : 1);
    } catch (...) {
        _exit(1);
    }
}

/// Reads what the child writes until it ends.
/// \return whether it ended in time
bool read_until_end(int message, double seconds, std::string& text) {
    const auto start = Clock::now();
    const auto time_left = [&] {
        return seconds - std::chrono::duration<double>(Clock::now() - start).count();
    };
    while (true) {
        const double left = time_left();
        if (left <= 0) return false;
        pollfd ready{message, POLLIN, 0};
        const int milliseconds = static_cast<int>(std::ceil(std::min(left, 1e6) * 1000));
        if (poll(&ready, 1, milliseconds) <= 0) continue;
        std::array<char, 4096> buffer{};
        const ssize_t count = read(message, buffer.data(), buffer.size());
        if (count == 0 || (count < 0 && errno != EINTR)) return time_left() > 0;
        if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

int wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

/// \return a sentence where the child has not ended well; empty otherwise
std::string cause_of_death(int status) {
    if (WIFSIGNALED(status)) {
        if (WTERMSIG(status) == SIGKILL) return "its reader was killed, maybe for want of memory";
        return std::string("it is damaged, its reader crashes (") + strsignal(WTERMSIG(status)) +
               ")";
    }
    if (WEXITSTATUS(status) == ended_well) return "";
    if (WEXITSTATUS(status) == ended_without_memory) return "there is not enough memory for it";
    return "it is damaged, its reader gives up";
}

}  // namespace

/// The first page of the shared memory.
struct Parcel::Directory {
    std::uint64_t count;
    std::array<std::uint64_t, 15> start;
    std::array<std::uint64_t, 15> bytes;
    std::uint64_t end;
};

Parcel::Parcel() : file_{memfd_create("parcel", MFD_CLOEXEC)} {
    const std::size_t first = whole_pages(sizeof(Directory));
    void* page = MAP_FAILED;
    if (file_ >= 0 && ftruncate(file_, static_cast<off_t>(first)) == 0) {
        page = mmap(nullptr, first, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    }
    if (page == MAP_FAILED) {
        const std::string reason = std::strerror(errno);
        if (file_ >= 0) close(file_);
        throw IoError("no memory to share with a child process: " + reason);
    }
    directory_ = static_cast<Directory*>(page);
    directory_->end = first;
}

Parcel::~Parcel() {
    close(file_);
    munmap(directory_, whole_pages(sizeof(Directory)));
    if (!contents_.empty()) munmap(contents_.data(), contents_.size());
}

std::span<std::byte> Parcel::append(std::size_t bytes) {
    Directory& d = *directory_;
    if (d.count == d.start.size() || bytes > PTRDIFF_MAX - d.end) throw std::bad_alloc();
    const std::uint64_t start = d.end;
    const std::size_t size = whole_pages(bytes);
    void* block = nullptr;
    if (size > 0) {
        if (ftruncate(file_, static_cast<off_t>(start + size)) != 0) throw std::bad_alloc();
        block = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_,
                     static_cast<off_t>(start));
        if (block == MAP_FAILED) throw std::bad_alloc();
    }
    d.start[d.count] = start;
    d.bytes[d.count] = bytes;
    ++d.count;
    d.end = start + size;
    return {static_cast<std::byte*>(block), bytes};
}

void Parcel::put_last_use(std::span<std::byte> bytes) {
    constexpr std::size_t step = std::size_t{1} << 24U;
    const std::size_t page = whole_pages(1);
    const std::span<std::byte> block = append(bytes.size());
    const auto address = reinterpret_cast<std::uintptr_t>(bytes.data());
    std::size_t released = whole_pages(address) - address;  // pages may start within the bytes
    for (std::size_t done = 0; done < bytes.size(); done += step) {
        const std::size_t count = std::min(step, bytes.size() - done);
        std::memcpy(block.data() + done, bytes.data() + done, count);
        if (done + count < released + page) continue;
        const std::size_t whole = (done + count - released) / page * page;
        madvise(bytes.data() + released, whole, MADV_DONTNEED);
        released += whole;
    }
}

void Parcel::open() {
    const std::size_t size = directory_->end;
    void* all = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (all == MAP_FAILED) throw std::bad_alloc();
    contents_ = {static_cast<std::byte*>(all), size};
}

std::span<const std::byte> Parcel::block_bytes(std::size_t i) const {
    return contents_.subspan(directory_->start.at(i), directory_->bytes.at(i));
}

std::shared_ptr<const Parcel> run_apart(const std::string& file, double seconds,
                                        const std::function<void(Parcel&)>& work) {
    const auto parcel = std::make_shared<Parcel>();
    std::array<int, 2> channel{};
    if (pipe2(channel.data(), O_CLOEXEC) != 0) throw IoError("no pipe to a child process");
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child == 0) live_as_child(parent, channel[1], *parcel, work);
    close(channel[1]);
    std::string text;
    const bool in_time = child > 0 && read_until_end(channel[0], seconds, text);
    close(channel[0]);
    if (child < 0) throw IoError("no child process can be started");
    if (!in_time) kill(child, SIGKILL);
    const int status = wait_for(child);
    if (!in_time) {
        std::ostringstream limit;
        limit << seconds;
        throw IoError(file + " cannot be read within " + limit.str() +
                      " seconds (--read-limit allows more)");
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == ended_by_exception) throw IoError(text);
    const std::string cause = cause_of_death(status);
    if (!cause.empty()) throw IoError(file + " cannot be read: " + cause);
    parcel->open();
    return parcel;
}

std::shared_ptr<const Parcel> read_file_apart(const std::filesystem::path& path, double seconds,
                                              const std::function<void(Parcel&)>& work) {
    const std::string quoted = "'" + path.string() + "'";
    return run_apart(quoted, seconds, [&](Parcel& out) {
        try {
            work(out);
        } catch (const nestgrid::InvalidInput& error) {
            throw nestgrid::InvalidInput(quoted + ": " + error.what());
        }
    });
}

std::uintmax_t bytes_to_read(const std::filesystem::path& path, const Format& format) {
    std::error_code none;
    std::filesystem::path folder = path;
    if (!std::filesystem::is_directory(path, none)) {
        if (!format.reads_beside) return std::filesystem::file_size(path);
        folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    }
    std::uintmax_t bytes = 0;
    for (std::filesystem::recursive_directory_iterator at(folder, none), end; !none && at != end;
         at.increment(none)) {
        std::error_code unreadable;
        const std::uintmax_t size = at->is_regular_file(unreadable) ? at->file_size(unreadable) : 0;
        if (!unreadable) bytes += size;
    }
    return bytes;
}
