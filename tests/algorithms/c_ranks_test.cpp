// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Ranks of a C code, simulated by threads: the pieces that its calls return are, together, what the
// same calls return without ranks for the whole grid.
#include <mutex>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/isolines.h>
#include <nestgrid/algorithms/probe.h>
#include <nestgrid/algorithms/slice.h>
#include <nestgrid/algorithms/surface_measures.h>

#include "cut_grid.hpp"
#include "sample_grids.hpp"
#include "simulated_ranks.hpp"
#include "table_in_c.hpp"

using namespace nestgrid_test;

namespace {

/// Ranks as a C code has them.
class TableOfRanks {
public:
    explicit TableOfRanks(Ranks& ranks) : ranks_{&ranks} {
        table.size = sizeof(table);
        table.self = this;
        table.rank = ranks.rank();
        table.count = ranks.size();
        table.last_error = [](void*) { return last_sentence().c_str(); };
        table.exchange = [](void* self, std::size_t sent, const nestgrid_message* to,
                            std::size_t* received, const nestgrid_message** from) {
            auto& own = *static_cast<TableOfRanks*>(self);
            return guarded([&] {
                if (own.fails) throw std::runtime_error("the cable is cut");
                std::vector<Ranks::Message> messages;
                for (std::size_t i = 0; i < sent; ++i) {
                    messages.push_back({to[i].rank, bytes(to[i].bytes, to[i].size)});
                }
                own.keep(own.ranks_->exchange(std::move(messages)));
                std::reverse(own.told_.begin(), own.told_.end());  // in any order
                *received = own.told_.size();
                *from = own.told_.data();
            });
        };
        table.gather = [](void* self, std::size_t size, const void* mine,
                          const nestgrid_message** from) {
            auto& own = *static_cast<TableOfRanks*>(self);
            return guarded([&] {
                std::vector<Ranks::Message> all;
                for (Ranks::Bytes& each : own.ranks_->gather(bytes(mine, size))) {
                    all.push_back({static_cast<int>(all.size()), std::move(each)});
                }
                own.keep(std::move(all));
                *from = own.told_.data();
            });
        };
        table.reduce = [](void* self, std::size_t size, std::uint64_t* numbers, int how) {
            return guarded([&] {
                static_cast<TableOfRanks*>(self)->ranks_->reduce(
                    {numbers, size}, static_cast<Ranks::Reduction>(how));
            });
        };
    }
    TableOfRanks(const TableOfRanks&) = delete;
    TableOfRanks& operator=(const TableOfRanks&) = delete;

    nestgrid_ranks table{};
    bool fails = false;

private:
    static Ranks::Bytes bytes(const void* from, std::size_t size) {
        const auto* const begin = static_cast<const std::byte*>(from);
        return {begin, begin + size};
    }
    void keep(std::vector<Ranks::Message> messages) {
        kept_ = std::move(messages);
        told_.clear();
        for (const Ranks::Message& m : kept_) {
            told_.push_back({m.rank, m.bytes.size(), m.bytes.data()});
        }
    }

    Ranks* ranks_;
    std::vector<Ranks::Message> kept_;
    std::vector<nestgrid_message> told_;
};

/// What calls have returned: rows of numbers that ranks have in parts, and numbers that all have.
struct Answers {
    std::vector<std::vector<double>> parts;
    std::vector<double> same;
    std::vector<double> totals;  ///< vertices, simplices, components, open edges

    void sort() { std::sort(parts.begin(), parts.end()); }
};

/// One rank's tables, or those of the whole.
struct Asked {
    const nestgrid_grid* grid;
    const nestgrid_field* field;
    nestgrid_options options;
    std::string sentence;
    std::array<char, 400> message{};

    /// Notes the sentence of a call that failed.
    bool is_done(int code) {
        if (code != 0 && sentence.empty()) sentence = message.data();
        return code == 0;
    }
};

/// What is measured of the connected parts of a surface: the same on all ranks, but in their order.
void put_measures(const nestgrid_surface& surface, Asked& asked, Answers& answers) {
    nestgrid_surface_measures measures{};
    measures.size = sizeof(measures);
    if (!asked.is_done(
            nestgrid_measure_surface(&surface, -1, &measures, asked.message.data(), 400))) {
        return;
    }
    std::vector<std::vector<double>> rows;
    const auto row_of = [](const nestgrid_measures& m) {
        return std::vector{static_cast<double>(m.triangles),
                           m.area,
                           m.area_vector[0],
                           m.area_vector[1],
                           m.area_vector[2],
                           m.volume,
                           m.integrals[0],
                           static_cast<double>(m.closed)};
    };
    for (std::size_t i = 0; i < measures.component_count; ++i) {
        rows.push_back(row_of(measures.components[i]));
    }
    std::sort(rows.begin(), rows.end());
    for (const auto& row : rows) answers.same.insert(answers.same.end(), row.begin(), row.end());
    for (std::size_t t = 0; t < surface.simplex_count; ++t) {
        EXPECT_LT(measures.component_of[t], measures.component_count);
    }
    answers.same.push_back(static_cast<double>(measures.whole.triangles));
    nestgrid_surface_measures_free(&measures);
}

/// \param joins whether ranks number the vertices of their pieces
void put_surface(nestgrid_surface& surface, Asked& asked, std::size_t call, bool joins,
                 Answers& answers) {
    nestgrid_surface_details details{};
    details.size = sizeof(details);
    nestgrid_details(&surface, &details, nullptr, 0);
    const std::size_t corners = surface.simplex_count == 0 ? 0 : surface.dimension;
    for (std::size_t i = 0; i < surface.simplex_count; ++i) {
        std::vector<std::vector<double>> corner;
        for (std::size_t k = 0; k < corners; ++k) {
            const std::uint32_t v = surface.simplices[corners * i + k];
            std::vector<double>& row =
                corner.emplace_back(surface.vertices + 3 * v, surface.vertices + 3 * v + 3);
            for (std::size_t c = 0; c < details.attribute_count; ++c) {
                row.push_back(details.attributes[details.attribute_count * v + c]);
            }
        }
        std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
        std::vector<double> row{static_cast<double>(call)};
        for (const auto& each : corner) row.insert(row.end(), each.begin(), each.end());
        answers.parts.push_back(std::move(row));
    }
    answers.same.insert(answers.same.end(), {surface.error_bound, surface.range_bound,
                                             static_cast<double>(surface.visited),
                                             static_cast<double>(surface.extracted)});
    if (surface.dimension == 3 && joins) put_measures(surface, asked, answers);
    if (asked.options.ranks != nullptr && joins) {
        nestgrid_joined joined{};
        joined.size = sizeof(joined);
        if (asked.is_done(nestgrid_join(&surface, &joined, asked.message.data(), 400))) {
            for (const std::uint64_t total :
                 {joined.vertices, joined.simplices, joined.components, joined.open}) {
                answers.totals.push_back(static_cast<double>(total));
            }
            for (std::size_t v = 0; v < surface.vertex_count; ++v) {
                EXPECT_LT(joined.numbers[v], joined.vertices);
                EXPECT_LE(joined.owners[v], asked.options.ranks->rank);
            }
        }
        nestgrid_joined_free(&joined);
    }
    nestgrid_surface_free(&surface);
}

/// All calls that draw, one after the other.
template <int dim>
Answers ask(Asked& asked) {
    Answers answers;
    std::size_t call = 0;
    const auto surface = [&](const auto& draw, bool joins = true) {
        nestgrid_surface drawn;
        if (!asked.is_done(draw(&drawn, asked.message.data(), asked.message.size()))) return;
        put_surface(drawn, asked, call++, joins, answers);
    };
    const nestgrid_options& o = asked.options;
    for (const double isovalue : {0.1, 0.3}) {
        surface([&](auto... to) {
            return nestgrid_isosurface_with(asked.grid, asked.field, isovalue, &o, to...);
        });
    }
    constexpr std::array isovalues{0.05, 0.25};
    std::array<nestgrid_surface, 2> several{};
    if (asked.is_done(nestgrid_isosurfaces(asked.grid, asked.field, 2, isovalues.data(), &o,
                                           several.data(), asked.message.data(),
                                           asked.message.size()))) {
        for (nestgrid_surface& one : several) put_surface(one, asked, call++, true, answers);
    }
    if constexpr (dim == 3) {
        nestgrid_options open = o;
        open.cap = 0;
        constexpr bool joins = false;  // vertices of two levels may have one name
        surface(
            [&](auto... to) {
                return nestgrid_isoband(asked.grid, asked.field, -0.1, 0.2, &open, to...);
            },
            joins);
        constexpr std::array through{0.5, 0.5, 0.5};
        constexpr std::array normal{1.0, 1.0, 0.3};
        surface([&](auto... to) {
            return nestgrid_slice(asked.grid, asked.field, through.data(), normal.data(), &open,
                                  to...);
        });
    } else {
        nestgrid_options flat = o;
        flat.cap = 0;
        surface([&](auto... to) {
            return nestgrid_height_field(asked.grid, asked.field, 0.5, &flat, to...);
        });
        nestgrid_lines lines{};
        lines.size = sizeof(lines);
        constexpr std::array values{0.05, 0.2};
        if (asked.is_done(nestgrid_isolines(asked.grid, asked.field, values.data(), 2, &flat,
                                            &lines, asked.message.data(), 400))) {
            answers.same.insert(answers.same.end(), {lines.error_bound, lines.range_bound});
            for (std::size_t i = 0; i < lines.line_count; ++i) {
                answers.parts.push_back({100.0, lines.values[i],
                                         static_cast<double>(lines.first[i + 1] - lines.first[i])});
            }
            nestgrid_lines_free(&lines);
        }
    }
    std::vector<double> points;
    for (int i = 0; i < 40; ++i) {
        points.insert(points.end(), {i / 40.0, 0.37, dim == 3 ? 0.61 : 0});
    }
    nestgrid_probed probed{};
    probed.size = sizeof(probed);
    if (asked.is_done(nestgrid_probe(asked.grid, asked.field, points.data(), 40, &o, &probed,
                                     asked.message.data(), 400))) {
        answers.same.push_back(static_cast<double>(probed.found));
        for (const double v : std::span(probed.values, 40 * probed.component_count)) {
            answers.same.push_back(std::isnan(v) ? -1e9 : v);
        }
        nestgrid_probed_free(&probed);
    }
    return answers;
}

std::vector<double> some_values(const Whole& whole, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<double> values;
    for (const Point& x : whole.positions) {
        const double noise = static_cast<double>(random()) / 0x1p32;
        values.push_back(0.3 * noise + std::sin(5 * x[0]) * x[1] - x[2] * x[2]);
        values.push_back(x[0] + 2 * x[1] - x[2]);
    }
    return values;
}

nestgrid_options some_options() {
    nestgrid_options options{};
    options.size = sizeof(options);
    options.threshold = 0.1;
    options.cap = 1;
    return options;
}

template <int dim>
class Scene {
public:
    template <class Grid>
    Scene(const Grid& grid, unsigned seed) : whole_(grid), values_{some_values(whole_, seed)} {}

    /// \param change change(rank, table, asked) makes a rank an odd one
    /// \return what each rank says that fails
    template <class Change>
    std::vector<std::string> run(int count, unsigned seed, bool keeps, Answers& together,
                                 const Change& change) const {
        std::mt19937 random(seed);
        const auto how = static_cast<Whole::Cut>(seed % 4);
        const std::vector<int> owner = whole_.partition(count, how, random);
        std::mutex mutex;
        std::vector<std::string> said(static_cast<std::size_t>(count));
        const auto ended = SimulatedRanks::run(count, [&](Ranks& ranks) {
            const Part part(whole_, owner, ranks.rank());
            const CutGrid<dim> mine(whole_, &part, seed % 2 == 0);
            const CutField<dim, double> field{&mine, &values_};
            TableOfRanks table(ranks);
            TableInC<CutGrid<dim>> in_c(mine);
            const nestgrid_field field_table = field_in_c(mine, field);
            Asked asked{&in_c.table, &field_table, some_options(), {}};
            asked.options.ranks = &table.table;
            change(ranks.rank(), table, in_c.table, asked.options);
            if (keeps) nestgrid_prerolls_make(&asked.options.prerolls, nullptr, 0);
            const Answers own = ask<dim>(asked);
            nestgrid_prerolls_free(asked.options.prerolls);
            const std::scoped_lock lock(mutex);
            said[static_cast<std::size_t>(ranks.rank())] = asked.sentence;
            together.parts.insert(together.parts.end(), own.parts.begin(), own.parts.end());
            if (ranks.rank() == 0) together.same = own.same;
            if (ranks.rank() == 0) together.totals = own.totals;
        });
        for (const std::string& sentence : ended) EXPECT_EQ(sentence, "");
        return said;
    }
    Answers alone() const {
        const CutGrid<dim> all(whole_, nullptr, true);
        const CutField<dim, double> field{&all, &values_};
        TableInC<CutGrid<dim>> in_c(all);
        const nestgrid_field field_table = field_in_c(all, field);
        Asked asked{&in_c.table, &field_table, some_options(), {}};
        Answers answers = ask<dim>(asked);
        EXPECT_EQ(asked.sentence, "");
        return answers;
    }

private:
    Whole whole_;
    std::vector<double> values_;
};

constexpr auto nothing = [](int, TableOfRanks&, nestgrid_grid&, nestgrid_options&) {};

template <class Family>
void expect_same(const char* name) {
    constexpr int dim = Family::Grid::dimension;
    unsigned seed = 0;
    for (auto& grid : Family::grids()) {
        std::mt19937 random(++seed);
        refine_at_random(grid, random, 3, 4, 3, 200);
        const Scene<dim> scene(grid, seed);
        Answers expected = scene.alone();
        expected.sort();
        for (const int ranks : {1, 2, 3, 5}) {
            Answers found;
            const bool keeps = ++seed % 2 == 0;
            for (const auto& said : scene.run(ranks, seed, keeps, found, nothing)) {
                EXPECT_EQ(said, "") << name;
            }
            found.sort();
            EXPECT_EQ(found.parts.size(), expected.parts.size()) << name << " on " << ranks;
            EXPECT_TRUE(found.parts == expected.parts) << name << " on " << ranks;
            EXPECT_TRUE(found.same == expected.same) << name << " on " << ranks;
            ASSERT_EQ(found.totals.size(), 20U);
            for (std::size_t i = 0; i < 5; ++i) {
                const double call = dim == 3 && i == 4 ? 5 : static_cast<double>(i);
                const auto simplices =
                    std::count_if(expected.parts.begin(), expected.parts.end(),
                                  [&](const auto& row) { return row[0] == call; });
                EXPECT_EQ(found.totals[4 * i + 1], static_cast<double>(simplices));
                EXPECT_EQ(found.totals[4 * i + 3], 0) << "open edges";
            }
        }
    }
}

TEST(RanksInC, PiecesAreWhatOneProcessDraws) {
    expect_same<UnbalancedOctree>("unbalanced octrees");
    expect_same<RedGreenTetrahedra>("red-green tetrahedra");
    expect_same<UnbalancedQuadtree>("unbalanced quadtrees");
    expect_same<BisectionTriangles>("bisected triangles");
}

/// What ranks say where rank 1 is an odd one.
template <class Change>
std::vector<std::string> said_with(const Change& change) {
    auto grid = UnbalancedOctree::grids()[0];
    std::mt19937 random(1);
    refine_at_random(grid, random, 3, 4, 3, 200);
    Answers answers;
    const auto on_one = [&](int rank, auto&... of_rank) {
        if (rank == 1) change(of_rank...);
    };
    return Scene<3>(grid, 1).run(3, 2, false, answers, on_one);
}

TEST(RanksInC, WhatOneThrowsAllSay) {
    using Table = TableOfRanks;
    using Options = nestgrid_options;
    const auto expect = [](const char* sentence, const auto& change) {
        for (const std::string& said : said_with(change)) {
            EXPECT_NE(said.find(sentence), std::string::npos) << said << ", not " << sentence;
        }
    };
    expect("rank 1: the threshold is negative",
           [](Table&, nestgrid_grid&, Options& o) { o.threshold = -1; });
    expect("rank 1: the table of the grid lacks the function 'split'",
           [](Table&, nestgrid_grid& g, Options&) { g.split = nullptr; });
    expect("rank 1: the table of the grid lacks the function 'presence'",
           [](Table&, nestgrid_grid& g, Options&) { g.presence = nullptr; });
    expect("rank 1: the operation 'children' of the grid failed",
           [](Table&, nestgrid_grid& g, Options&) { g.children = [](auto...) { return 7; }; });
    expect("all ranks must ask for the same",
           [](Table&, nestgrid_grid&, Options& o) { o.threshold = 0.3; });
    expect("reference coordinates is not made for distributed grids yet",
           [](Table&, nestgrid_grid&, Options& o) { o.reference = 1; });
}

TEST(RanksInC, TablesAreLookedAt) {
    const auto sentence = [](const auto& change) {
        return said_with([&](TableOfRanks& t, nestgrid_grid&, nestgrid_options&) { change(t); })[1];
    };
    EXPECT_NE(sentence([](TableOfRanks& t) {
                  t.table.exchange = nullptr;
              }).find("lacks the function 'exchange'"),
              std::string::npos);
    EXPECT_NE(sentence([](TableOfRanks& t) { t.table.rank = 3; }).find("rank 3 is none of 3 ranks"),
              std::string::npos);
    EXPECT_NE(sentence([](TableOfRanks& t) { t.table.size = 8; }).find("its size says 8 bytes"),
              std::string::npos);
    EXPECT_NE(sentence([](TableOfRanks& t) {
                  t.fails = true;
              }).find("the operation 'exchange' of rank 1 failed with code 3: the cable is cut"),
              std::string::npos);
}

}  // namespace
