// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several ways to the same thing, timed in turns: on a machine shared with others ratios are worth
// more than times.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

/// What is measured: the time that passes, or the processor time of all threads, which counts less
/// of what others do on the machine.
enum class Clock { wall, processor };

class Contest {
public:
    /// \param rounds how often each contestant runs; the median counts
    explicit Contest(std::size_t rounds, Clock clock = Clock::wall)
        : rounds_{rounds}, clock_{clock} {}

    void add(const std::string& name, std::function<void()> run) {
        contestants_.push_back({name, std::move(run), {}});
    }

    void run() {
        for (std::size_t round = 0; round < rounds_; ++round) {
            for (Contestant& c : contestants_) {
                const double start = now();
                c.run();
                c.times.push_back(now() - start);
            }
        }
        for (Contestant& c : contestants_) std::sort(c.times.begin(), c.times.end());
    }

    /// Median, in milliseconds.
    double time(const std::string& name) const {
        const auto c = std::find_if(contestants_.begin(), contestants_.end(),
                                    [&](const Contestant& each) { return each.name == name; });
        return c->times[c->times.size() / 2];
    }

    void print_times() const {
        for (const Contestant& c : contestants_) {
            print_figure(c.name + "_ms", c.times[c.times.size() / 2]);
        }
    }

    static void print_figure(const std::string& name, double value) {
        std::printf("%s %.6g\n", name.c_str(), value);
        std::fflush(stdout);
    }

private:
    struct Contestant {
        std::string name;
        std::function<void()> run;
        std::vector<double> times;
    };

    /// In milliseconds.
    double now() const {
        using Milliseconds = std::chrono::duration<double, std::milli>;
        if (clock_ == Clock::processor) return 1e3 * double(std::clock()) / CLOCKS_PER_SEC;
        return Milliseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    std::size_t rounds_;
    Clock clock_;
    std::vector<Contestant> contestants_;
};
