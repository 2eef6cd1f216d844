// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// That what a program finds out on ranks is what it finds out on one: numbers that all ranks have
// alike, and lists of which each rank has a part.
#pragma once

#include <algorithm>
#include <mutex>

#include "program_judge.hpp"
#include "sample_grids.hpp"

namespace nestgrid_test {

/// What a program tells.
struct Record {
    using Numbers = std::vector<double>;

    std::vector<Numbers> same;                ///< on all ranks
    std::vector<std::vector<Numbers>> parts;  ///< each a list of which ranks have parts

    void put(Numbers numbers) { same.push_back(std::move(numbers)); }
    void put_part(std::vector<Numbers> part) { parts.push_back(std::move(part)); }
    /// Simplices by the positions and attributes of their corners.
    template <int dim>
    void put_surface(const Surface<dim>& surface) {
        const std::size_t stride =
            surface.vertices.empty() ? 0 : surface.attributes.size() / surface.vertices.size();
        std::vector<Numbers> part;
        for (const auto& simplex : surface.simplices) {
            std::array<Numbers, dim> corners;
            for (std::size_t k = 0; k < dim; ++k) {
                const auto& x = surface.vertices[simplex[k]];
                corners[k].assign(x.begin(), x.end());
                const auto from =
                    surface.attributes.begin() + static_cast<std::ptrdiff_t>(simplex[k] * stride);
                corners[k].insert(corners[k].end(), from,
                                  from + static_cast<std::ptrdiff_t>(stride));
            }
            std::ranges::rotate(corners, std::ranges::min_element(corners));
            Numbers& all = part.emplace_back();
            for (const Numbers& c : corners) all.insert(all.end(), c.begin(), c.end());
        }
        put_part(std::move(part));
    }
    /// Adds the parts of another rank.
    /// \return whether it has other numbers
    bool add(const Record& other) {
        if (same.empty() && parts.empty()) {
            *this = other;
            return false;
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].insert(parts[i].end(), other.parts[i].begin(), other.parts[i].end());
        }
        return same != other.same;
    }
    void sort() {
        for (auto& list : parts) std::ranges::sort(list);
    }
    std::size_t size() const {
        std::size_t sum = same.size();
        for (const auto& list : parts) sum += list.size();
        return sum;
    }
    bool operator==(const Record&) const = default;
};

/// \tparam Program program(grid, field, executor, record)
template <int dim, class Program>
class RecordJudge {
public:
    RecordJudge(const Whole& whole, std::vector<double> values, Program program)
        : whole_{&whole}, values_{std::move(values)}, program_{std::move(program)} {
        const CutGrid<dim> grid(*whole_, nullptr, true);
        const CutField<dim, double> field{&grid, &values_};
        program_(grid, field, SequentialExecutor{}, expected_);
        expected_.sort();
    }
    const Record& expected() const { return expected_; }

    void compare(const Cutting& cutting, const std::vector<int>& owner, Tally& tally) const {
        Record found;
        bool alike = true;
        std::mutex mutex;
        const auto ended = SimulatedRanks::run(cutting.ranks, [&](Ranks& all) {
            ForgetfulRanks ranks(all, cutting.omission);
            ranks.begin(ForgetfulRanks::Step::share);
            const Part part(*whole_, owner, ranks.rank());
            const CutGrid<dim> mine(*whole_, &part, cutting.own_keys);
            const Distributed grid(mine, ranks, cutting.most_sharers);
            const DistributedField field(grid, CutField<dim, double>{&mine, &values_});
            const ThreadExecutor threads(cutting.threads);
            Record own;
            ranks.begin(ForgetfulRanks::Step::draw);
            program_(grid, field, threads, own);
            const std::scoped_lock lock(mutex);
            alike = !found.add(own) && alike;
        });
        const std::string where =
            std::to_string(cutting.ranks) + " ranks, cut " + std::to_string(int(cutting.how));
        for (const std::string& sentence : ended) {
            if (!sentence.empty()) return note(tally, tally.ended, where + ": " + sentence);
        }
        ++tally.drawn;
        found.sort();
        tally.simplices += found.size();
        if (!alike) return note(tally, tally.other, where + ": ranks have different numbers");
        if (found != expected_) note(tally, tally.other, where + differs(found));
    }

private:
    std::string differs(const Record& found) const {
        for (std::size_t i = 0; i < expected_.same.size(); ++i) {
            const auto& a = found.same[i];
            const auto& b = expected_.same[i];
            const auto [at, in] = std::ranges::mismatch(a, b);
            if (a.size() == b.size() && in == b.end()) continue;
            return ": numbers " + std::to_string(i) + ", number " + std::to_string(at - a.begin()) +
                   (in == b.end() ? ""
                                  : " is " + std::to_string(*at) + " for " + std::to_string(*in));
        }
        for (std::size_t i = 0; i < expected_.parts.size(); ++i) {
            if (found.parts[i] == expected_.parts[i]) continue;
            return ": list " + std::to_string(i) + " of " + std::to_string(found.parts[i].size()) +
                   " for " + std::to_string(expected_.parts[i].size());
        }
        return ": something else differs";
    }
    static void note(Tally& tally, std::uint64_t& count, const std::string& what) {
        ++count;
        if (tally.first.empty()) tally.first = what;
    }

    const Whole* whole_;
    std::vector<double> values_;
    Program program_;
    Record expected_;
};

/// Compares a program on random grids of a family, cut in many ways.
template <class Family, class Program>
Tally compare_on(const char* name, const Program& program, unsigned cuttings,
                 const ForgetfulRanks::Omission& omission = {"nothing", ForgetfulRanks::Step::none,
                                                             0, false}) {
    constexpr int dim = Family::Grid::dimension;
    Tally tally;
    unsigned seed = 50;
    for (auto& grid : Family::grids()) {
        std::mt19937 random(++seed);
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Whole whole(grid);
        for (unsigned data = 0; data < 3; ++data) {
            const RecordJudge<dim, Program> judge(whole, some_values(whole, ++seed), program);
            for (unsigned i = 0; i < cuttings; ++i) {
                Cutting cut = some_cutting(seed + i, random);
                cut.omission = omission;
                judge.compare(cut, whole.partition(cut.ranks, cut.how, random), tally);
            }
        }
    }
    if (omission.step == ForgetfulRanks::Step::none) tally.expect_none(name);
    return tally;
}

}  // namespace nestgrid_test
