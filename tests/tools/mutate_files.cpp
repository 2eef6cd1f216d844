// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Damages files and hands them to the program, which must read each or refuse it with one sentence,
// within the limit of time given to it, and leave no file behind where it refuses. The program is
// linked, and runs in a child process for each file: to start it takes longer than to read a file.
//
// Arguments: how many files; a folder with good ones, and the names of those that make
// one input together, the named one first; "--" and arguments of the program, where IN, at the end
// of an argument, stands for that first file and OUT for a file that is written.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"

namespace {

namespace fs = std::filesystem;
using Bytes = std::string;

/// Far beyond the limit that the program is given, for machines with much to do.
constexpr double patience = 60;

Bytes content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Damage that is the same on every machine.
class Damage {
public:
    explicit Damage(const std::string& seed)
        : random_{[&] {
              std::seed_seq sequence(seed.begin(), seed.end());
              return std::mt19937(sequence);
          }()} {}

    /// Damages one of several files. Every kind of damage, in heads and anywhere, in every file:
    /// the number of the damage goes through them all; what is done there, and more of it, is
    /// random.
    void apply(std::vector<Bytes>& files, std::size_t number) {
        Bytes& bytes = files[number / (2 * kinds) % files.size()];
        if (bytes.empty()) return;
        apply_one(bytes, number % kinds, number / kinds % 2 == 0);
        if (below(2) == 0 && !bytes.empty()) apply_one(bytes, below(kinds), below(2) == 0);
    }

private:
    static constexpr std::size_t kinds = 9;

    std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }

    /// \param in_head among the first 400, where headers are
    std::size_t place(const Bytes& bytes, bool in_head) {
        return below(in_head ? std::min<std::size_t>(400, bytes.size()) : bytes.size());
    }

    void apply_one(Bytes& bytes, std::size_t kind, bool in_head) {
        const std::size_t at = place(bytes, in_head);
        const std::size_t length = std::min(bytes.size() - at, 1 + below(20));
        switch (kind) {
            case 0:  // bits
                for (std::size_t i = 0, count = 1 + below(8); i < count; ++i) {
                    bytes[place(bytes, in_head)] ^= static_cast<char>(1U << below(8));
                }
                break;
            case 1:  // bytes
                for (std::size_t i = 0, count = 1 + below(8); i < count; ++i) {
                    bytes[place(bytes, in_head)] = static_cast<char>(below(256));
                }
                break;
            case 2:
                bytes.replace(at, length, length, static_cast<char>(below(256)));
                break;
            case 3:
                bytes.replace(at, length, length, "\0\xFF-9 \n"[below(6)]);
                break;
            case 4:
                bytes.erase(at, length);
                break;
            case 5:
                bytes.insert(at, bytes.substr(place(bytes, below(2) == 0), length));
                break;
            case 6:
                bytes.resize(at);
                break;
            default:
                change_digit(bytes, at);
        }
    }

    /// The next digit behind a place becomes another one, in a few cases something else.
    void change_digit(Bytes& bytes, std::size_t at) {
        for (std::size_t i = at; i < bytes.size() && i < at + 100; ++i) {
            if (bytes[i] < '0' || bytes[i] > '9') continue;
            bytes[i] = "0123456789012345678901234567890123456789-.e "[below(44)];
            return;
        }
    }

    std::mt19937 random_;
};

struct Run {
    int status = 0;  ///< as waitpid() gives it
    bool ended = false;
    double seconds = 0;
};

int open_for_writing(const char* path) { return open(path, O_WRONLY | O_CREAT | O_TRUNC, 0644); }

/// Runs the program in the current folder, its streams to the files "out" and "err".
Run run(const std::vector<std::string>& command) {
    const auto start = std::chrono::steady_clock::now();
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        std::vector<char*> words;
        for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        dup2(open_for_writing("out"), STDOUT_FILENO);
        dup2(open_for_writing("err"), STDERR_FILENO);
        std::exit(run_program(static_cast<int>(command.size()), words.data()));
    }
    Run result;
    do {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        result.ended = waitpid(child, &result.status, WNOHANG) == child;
        result.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    } while (!result.ended && result.seconds < patience);
    if (!result.ended) {
        kill(child, SIGKILL);
        waitpid(child, &result.status, 0);
    }
    return result;
}

/// What is wrong with a run; empty where nothing is.
std::string complaint(const Run& run, const std::string& output) {
    const Bytes err = content("err");
    if (!run.ended) return "does not end";
    if (WIFSIGNALED(run.status)) {
        return "dies by signal " + std::to_string(WTERMSIG(run.status));
    }
    const int status = WEXITSTATUS(run.status);
    if (status == 0) return err.empty() ? "" : "reads it, but writes to standard error: " + err;
    if (status != 1) return "ends with status " + std::to_string(status) + ": " + err;
    const auto lines = std::count(err.begin(), err.end(), '\n');
    if (lines != 1 || err.back() != '\n') return "refuses it not in one line: " + err;
    if (fs::exists(output)) return "refuses it, but writes " + output;
    return "";
}

/// Files that the program leaves behind.
std::string litter(const std::vector<std::string>& expected) {
    for (const auto& entry : fs::directory_iterator(".")) {
        std::string name = entry.path().filename().string();
        if (std::find(expected.begin(), expected.end(), name) == expected.end()) return name;
    }
    return "";
}

struct Arguments {
    int count;
    fs::path folder;
    std::vector<std::string> files;
    std::vector<std::string> rest;
};

std::vector<std::string> command_of(const Arguments& arguments, std::string& output) {
    std::vector<std::string> command{"nestgrid"};
    for (const std::string& word : arguments.rest) {
        command.push_back(word);
        if (word.ends_with("IN")) {
            command.back().replace(word.size() - 2, 2, arguments.files.front());
        }
        if (!word.starts_with("OUT")) continue;
        output = "written" + word.substr(3);
        command.back() = output;
    }
    return command;
}

/// \return how many runs went wrong
int damage_and_run(const Arguments& arguments) {
    std::vector<Bytes> good;
    for (const std::string& name : arguments.files)
        good.push_back(content(arguments.folder / name));
    std::string output;
    const std::vector<std::string> command = command_of(arguments, output);
    std::vector<std::string> expected = arguments.files;
    for (const std::string& name : arguments.files) {
        expected.push_back(fs::path(name).begin()->string());  // a folder
    }
    expected.insert(expected.end(), {"out", "err", output});

    Damage damage(arguments.files.front());
    std::array<int, 2> outcomes{};
    int failures = 0;
    double longest = 0;
    for (int i = 0; i < arguments.count; ++i) {
        std::vector<Bytes> bytes = good;
        // The first of all is not damaged: it must be read.
        if (i > 0) damage.apply(bytes, static_cast<std::size_t>(i));
        for (std::size_t k = 0; k < bytes.size(); ++k) {
            const fs::path folder = fs::path(arguments.files[k]).parent_path();
            if (!folder.empty()) fs::create_directories(folder);
            std::ofstream(arguments.files[k], std::ios::binary) << bytes[k];
        }
        fs::remove(output);
        const Run result = run(command);
        longest = std::max(longest, result.seconds);
        std::string text = complaint(result, output);
        if (text.empty()) ++outcomes[result.status == 0 ? 0 : 1];
        if (i == 0 && text.empty() && result.status != 0) text = "refuses it: " + content("err");
        if (text.empty() && !litter(expected).empty()) text = "leaves " + litter(expected);
        if (text.empty()) continue;
        ++failures;
        std::printf("FAILED: file %d of %s: the program %s\n", i, arguments.files[0].c_str(),
                    text.c_str());
    }
    std::printf("%d files: %d read, %d refused, %d failures, at most %.2f s\n", arguments.count,
                outcomes[0], outcomes[1], failures, longest);
    return failures;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    const auto split = std::find(words.begin(), words.end(), "--");
    if (words.size() < 4 || split - words.begin() < 3) return 2;
    const Arguments arguments{std::stoi(words[0]),
                              fs::absolute(words[1]),
                              {words.begin() + 2, split},
                              {split + 1, words.end()}};
    std::string folder = (fs::temp_directory_path() / "damagedXXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) return 2;
    fs::current_path(folder);
    const int failures = damage_and_run(arguments);
    fs::current_path(fs::temp_directory_path());
    fs::remove_all(folder);
    return failures == 0 ? 0 : 1;
}
