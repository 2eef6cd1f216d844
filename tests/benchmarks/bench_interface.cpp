// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the interface costs: triangles of the bucky ball into a buffer, by the concept, by
// the general loop over rules, by tables written in C that tell their
// bisections and that do not, and by a recursion written by hand for this one grid. Where valgrind
// is installed, the instructions of the latter per element are counted first; more than 105 fail
// the run, for then it would be a bad measure. One "name value" line per figure; --quick takes 33^3
// samples instead of 129^3.
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <nestgrid/table.hpp>

#include "bucky_samples.hpp"
#include "tetrahedra_in_c.h"

namespace {

constexpr double most_instructions = 105;

/// The same grid, of which nothing is known at compile time.
struct General : Tetrahedra {
    using Tetrahedra::Tetrahedra;
    struct Nothing {};
    [[maybe_unused]] static constexpr Nothing bisections{};
};

/// What --handwritten runs under valgrind.
constexpr int counted = 65;

/// Instructions of a run of this program with one argument, counted by callgrind; 0 where it
/// cannot.
double instructions(const std::string& program, const std::string& argument) {
    const std::string out = "callgrind." + argument + ".txt";
    const std::string command = "valgrind --tool=callgrind --callgrind-out-file=/dev/null '" +
                                program + "' " + argument + " >" + out + " 2>&1";
    double result = 0;
    if (std::system(command.c_str()) == 0) {
        std::ifstream lines(out);
        for (std::string word; lines >> word;) {
            if (word == "Collected") lines >> word >> result;
        }
    }
    std::remove(out.c_str());
    return result;
}

template <int n>
void compare(std::size_t rounds) {
    Bucky<n> bucky;
    const General general({.samples = {n, n, n}});
    const nestgrid::LatticeField general_field(general, std::span<const float>(bucky.samples));
    const samples_in_c in_c{static_cast<std::uint64_t>(n - 1), bucky.samples.data()};
    nestgrid_grid table = tetrahedra_in_c(&in_c);
    const nestgrid_field c_field = samples_field_in_c(&in_c);
    const auto c_table = nestgrid::open_table<float>(table, c_field);
    table.middles = nullptr;
    const auto untold = nestgrid::open_table<float>(table, c_field);
    for (const float threshold : bucky_thresholds) {
        Contest contest(rounds);
        nestgrid::TraversalCounts counts;
        std::size_t triangles = 0;
        contest.add("handwritten", [&] { bucky.handwritten(threshold); });
        contest.add("concept", [&] {
            triangles = bucky.draw_soup(bucky.grid, bucky.field, threshold, &counts);
        });
        contest.add("general", [&] { bucky.draw_soup(general, general_field, threshold); });
        const auto draw = [&](const auto& hierarchy) {
            bucky.draw_hierarchy(hierarchy, bucky.indicator, double{bucky_isovalue}, threshold);
        };
        contest.add("c_table", [&] { draw(*c_table); });
        contest.add("untold", [&] { draw(*untold); });
        contest.run();
        const auto print = [&](const char* name, double value) {
            Contest::print_figure(at_threshold(name, threshold), value);
        };
        const auto handwritten = bucky.handwritten(threshold);
        if (handwritten.calls() != counts.calls || handwritten.visited() != counts.visited) {
            std::cerr << "the recursion by hand looks at other elements\n";
            std::exit(1);
        }
        print("triangles", static_cast<double>(triangles));
        print("calls", static_cast<double>(counts.calls));
        print("handwritten_ms", contest.time("handwritten"));
        print("concept_over_handwritten", contest.time("concept") / contest.time("handwritten"));
        print("general_over_handwritten", contest.time("general") / contest.time("handwritten"));
        print("c_table_over_handwritten", contest.time("c_table") / contest.time("handwritten"));
        print("c_table_untold_over_handwritten",
              contest.time("untold") / contest.time("handwritten"));
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string argument = argc > 1 ? argv[1] : "";
    if (argument == "--handwritten" || argument == "--nothing") {
        Bucky<counted> bucky;
        if (argument == "--handwritten") bucky.handwritten(0);
        return 0;
    }
    const double with = instructions(argv[0], "--handwritten");
    if (with > 0) {
        Bucky<counted> bucky;
        const double per_call = (with - instructions(argv[0], "--nothing")) /
                                static_cast<double>(bucky.handwritten(0).calls());
        Contest::print_figure("handwritten_instructions_per_call", per_call);
        if (per_call > most_instructions) {
            std::cerr << "the recursion by hand takes more than " << most_instructions
                      << " instructions per element\n";
            return 1;
        }
    }
    at_either_size(argc, argv, 15, [](auto n, std::size_t rounds) { compare<n.value>(rounds); });
    return 0;
}
