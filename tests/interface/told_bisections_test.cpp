// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bisections that a C code tells in its tables: the same surface as by the plain traversal, and
// what is told wrongly is found.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.h>
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/table.hpp>

#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"
#include "tetrahedra_in_c.h"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

/// What the wrong functions call.
const samples_in_c no_samples{1, nullptr};
const nestgrid_grid right_grid = tetrahedra_in_c(&no_samples);
const nestgrid_field right_field = samples_field_in_c(&no_samples);

/// Answers changed by a function of (count, out) that captures nothing.
template <class Change>
auto node_keys_but(Change) {
    return [](const void* self, std::size_t count, const std::uint64_t* nodes, std::uint64_t* out) {
        const int code = right_grid.node_keys(self, count, nodes, out);
        Change{}(count, out);
        return code;
    };
}
template <class Change>
auto middles_but(Change) {
    return [](const void* self, std::size_t count, const std::uint64_t* a, const std::uint64_t* b,
              std::uint64_t* out) {
        const int code = right_grid.middles(self, count, a, b, out);
        Change{}(count, out);
        return code;
    };
}

/// Of one that says 4 + t.
nestgrid_element with_right_tag(nestgrid_element e) {
    e.word[4] &= 3U;
    return e;
}

/// With a preroll, at any threshold, in the way of any hierarchy.
Isosurface<3> draw_by_offsets(const Hierarchy<float>& hierarchy, double isovalue, double threshold,
                              const IsosurfaceOptions& options = {}) {
    const HierarchicalIndicator offsets(hierarchy);
    return isosurface<3>(hierarchy, isovalue, under(offsets, threshold), options);
}

class ToldBisections : public ::testing::Test {
protected:
    explicit ToldBisections(int n = 17) : data{sampled_fields({n, n, n})} {
        samples.cells = static_cast<std::uint64_t>(n - 1);
        show(data[0]);
    }
    void show(const SampledField& values) {
        samples.samples = values.values.data();
        grid = tetrahedra_in_c(&samples);
        field = samples_field_in_c(&samples);
    }
    auto draw(double isovalue, double threshold, const IsosurfaceOptions& options = {}) const {
        return draw_by_offsets(*open_table<float>(grid, field), isovalue, threshold, options);
    }
    std::string violation() const {
        std::array<char, 300> message{};
        nestgrid_check_grid(&grid, &field, message.data(), message.size());
        return message.data();
    }

    /// Elements that say 4 + t where t is meant.
    void put_tag_elsewhere() {
        grid.coarse = [](const void* self, void* context, std::size_t i, nestgrid_coarse* out) {
            const int code = right_grid.coarse(self, context, i, out);
            out->element.word[4] |= 4U;
            return code;
        };
        grid.split = [](const void* self, void* context, const nestgrid_element* e, int* rule) {
            const nestgrid_element meant = with_right_tag(*e);
            return right_grid.split(self, context, &meant, rule);
        };
        grid.children = [](const void* self, void* context, const nestgrid_element* e,
                           std::size_t count, nestgrid_element* out) {
            const nestgrid_element meant = with_right_tag(*e);
            const int code = right_grid.children(self, context, &meant, count, out);
            for (nestgrid_element& child : std::span(out, count)) child.word[4] |= 4U;
            return code;
        };
        grid.new_keys = [](const void* self, void* context, const nestgrid_element* e,
                           std::size_t count, std::uint64_t* out) {
            const nestgrid_element meant = with_right_tag(*e);
            return right_grid.new_keys(self, context, &meant, count, out);
        };
        field.new_values = [](const void* self, void* context, const nestgrid_element* e,
                              std::uint64_t which, std::size_t count, void* out,
                              std::uint64_t* missing) {
            const nestgrid_element meant = with_right_tag(*e);
            return right_field.new_values(self, context, &meant, which, count, out, missing);
        };
    }

    std::vector<SampledField> data;
    samples_in_c samples{};
    nestgrid_grid grid{};
    nestgrid_field field{};
};

TEST_F(ToldBisections, AreTakenWhereAllOfThemAreThere) {
    const auto taken = [&] { return open_table<float>(grid, field)->bisection_rows() != nullptr; };
    EXPECT_TRUE(taken());
    const auto not_taken_with = [&](auto change) {
        const auto [g, f] = std::pair(grid, field);
        change();
        EXPECT_FALSE(taken());
        grid = g;
        field = f;
    };
    not_taken_with([&] { grid.middles = nullptr; });
    not_taken_with([&] { grid.node_keys = nullptr; });
    not_taken_with([&] { grid.node_positions = nullptr; });
    not_taken_with([&] { grid.boundary_faces = nullptr; });
    not_taken_with([&] { grid.conforming = 0; });
    not_taken_with([&] { grid.hidden = [](auto...) { return 0; }; });
    not_taken_with([&] { grid.size = offsetof(nestgrid_grid, middles); });
    not_taken_with([&] { field.node_values = nullptr; });
    not_taken_with([&] { field.size = offsetof(nestgrid_field, node_values); });
}

TEST_F(ToldBisections, GiveTheSurfaceOfThePlainTraversal) {
    for (const SampledField& values : data) {
        show(values);
        EXPECT_EQ(violation(), "") << values.name;
        const LatticeBisection<3> lattice({.samples = {17, 17, 17}});
        const LatticeField lattice_field(lattice, std::span<const float>(values.values));
        for (const double threshold : {0.0, 0.01, 0.05, 0.3}) {
            SCOPED_TRACE(values.name + " at " + std::to_string(threshold));
            const double epsilon = threshold * values.range;
            const auto told = draw(values.isovalue, epsilon);
            EXPECT_GT(told.surface.simplices.size(), 0U);
            grid.middles = nullptr;
            expect_same(told, draw(values.isovalue, epsilon));
            expect_same(told,
                        draw_by_offsets(erase(lattice, lattice_field), values.isovalue, epsilon));
            show(values);
        }
    }
}

TEST_F(ToldBisections, GiveTheNormalsOfTheLattice) {
    for (const SampledField& values : data) {
        show(values);
        const LatticeBisection<3> lattice({.samples = {17, 17, 17}});
        const LatticeField lattice_field(lattice, std::span<const float>(values.values));
        for (const double threshold : {0.0, 0.01, 0.3}) {
            for (const IsosurfaceOptions& options : {IsosurfaceOptions{.normals = true},
                                                     {.cuts = Cuts::finest, .normals = true},
                                                     // Not drawn in patches.
                                                     {.normals = true, .at_nodes = true}}) {
                SCOPED_TRACE(values.name + " at " + std::to_string(threshold));
                const double epsilon = threshold * values.range;
                const auto told = draw(values.isovalue, epsilon, options);
                EXPECT_EQ(told.surface.normals.size(), told.surface.vertices.size());
                expect_same(told, draw_by_offsets(erase(lattice, lattice_field), values.isovalue,
                                                  epsilon, options));
                // Gradients at corners give the same by the plain traversal, but for finest pieces,
                // whose ends are no corners.
                field.node_gradients = nullptr;
                field.corner_gradients = [](const void* self, void*, const nestgrid_element* e,
                                            std::size_t count, double(*out)[3]) {
                    return right_field.node_gradients(self, count, e->word, out);
                };
                if (options.cuts == Cuts::linear)
                    expect_same(told, draw(values.isovalue, epsilon, options));
                show(values);
            }
        }
    }
}

TEST_F(ToldBisections, NeedTheValuesAtNodesForGradients) {
    const auto facts = [&] { return open_table<float>(grid, field)->facts(); };
    const auto given = [&] {
        EXPECT_EQ(facts().gradients_at_nodes, facts().offers(Feature::gradients));
        return facts().gradients_at_nodes;
    };
    EXPECT_TRUE(given());
    field.size = offsetof(nestgrid_field, node_gradients);
    EXPECT_FALSE(given());
    show(data[0]);
    field.node_values = nullptr;
    EXPECT_FALSE(given());
    show(data[0]);
    grid.middles = nullptr;
    EXPECT_FALSE(given());
}

TEST_F(ToldBisections, GiveTheSlicesOfThePlainTraversal) {
    for (const SampledField& values : data) {
        show(values);
        for (const Plane& plane : {Plane({8, 8, 8}, {0, 0, 1}), Plane({7, 8, 8}, {0.3, 0.5, 0.8}),
                                   Plane({8, 8, 8}, {1, 1, 1}), Plane({16, 0, 0}, {-1, 0, 0})}) {
            for (const double threshold : {0.0, 0.05}) {
                const Projection projection{.threshold = threshold * values.range};
                const auto draw_slice = [&] {
                    return slice(*open_table<float>(grid, field), plane, projection);
                };
                const Slice told = draw_slice();
                EXPECT_GT(told.surface.simplices.size(), 0U);
                grid.middles = nullptr;
                const Slice plain = draw_slice();
                expect_same(told.surface, plain.surface);
                EXPECT_EQ(told.error_bound, plain.error_bound);
                show(values);
            }
        }
    }
}

/// Every function, wrong in one answer only.
TEST_F(ToldBisections, ThatAreWrongAreFound) {
    EXPECT_EQ(violation(), "");
    const auto found_with = [&](auto change) {
        change();
        const std::string sentence = violation();
        show(data[0]);
        return sentence.substr(0, sentence.find(" is not what is known of bisections"));
    };
    EXPECT_EQ(found_with([&] {
                  grid.node_keys = node_keys_but([](std::size_t count, std::uint64_t* out) {
                      if (count > 1) out[count - 1] ^= 1U;
                  });
              }),
              "a key in a row");
    EXPECT_EQ(found_with([&] {
                  grid.node_keys = node_keys_but([](std::size_t count, std::uint64_t* out) {
                      for (std::size_t i = 0; i < count; ++i) out[i] ^= out[i] == 2 ? 1U : 0U;
                  });
              }),
              "the new node");
    EXPECT_EQ(found_with([&] {
                  grid.node_positions = [](const void* self, std::size_t count,
                                           const std::uint64_t* nodes, double(*out)[3]) {
                      const int code = right_grid.node_positions(self, count, nodes, out);
                      for (std::size_t i = 0; i < count; ++i) out[i][1] *= 1 + 1e-16 + 1e-15;
                      return code;
                  };
              }),
              "the position of a node");
    EXPECT_EQ(found_with([&] {
                  grid.middles = middles_but([](std::size_t count, std::uint64_t* out) {
                      if (count == 1 && *out == NESTGRID_NO_NODE) *out = 0;
                  });
              }),
              "whether the element is split");
    EXPECT_EQ(found_with([&] {
                  grid.middles = middles_but([](std::size_t count, std::uint64_t* out) {
                      if (count > 1) out[1] = NESTGRID_NO_NODE;
                  });
              }),
              "a middle in a row");
    EXPECT_EQ(found_with([&] {
                  field.node_values = [](const void* self, std::size_t count,
                                         const std::uint64_t* nodes, const std::uint64_t* keys,
                                         void* out) {
                      const int code = right_field.node_values(self, count, nodes, keys, out);
                      if (*nodes % 2 == 1) *static_cast<float*>(out) += 1;
                      return code;
                  };
              }),
              "the value at the new node");
    EXPECT_EQ(found_with([&] {
                  field.node_gradients = [](const void* self, std::size_t count,
                                            const std::uint64_t* nodes, double(*out)[3]) {
                      const int code = right_field.node_gradients(self, count, nodes, out);
                      if (count > 1) out[1][2] += 1;
                      return code;
                  };
              }),
              "a gradient in a row");
    EXPECT_EQ(found_with([&] {
                  field.corner_gradients = [](const void* self, void*, const nestgrid_element* e,
                                              std::size_t count, double(*out)[3]) {
                      const int code = right_field.node_gradients(self, count, e->word, out);
                      out[3][0] *= 2;
                      out[3][0] += 1;
                      return code;
                  };
              }),
              "the gradient at a corner");
    EXPECT_EQ(found_with([&] {
                  grid.split = [](const void* self, void* context, const nestgrid_element* e,
                                  int* rule) {
                      const int code = right_grid.split(self, context, e, rule);
                      if (e->word[4] == 1) *rule = -1;
                      return code;
                  };
              }),
              "which elements of a patch are split");
    EXPECT_EQ(found_with([&] { put_tag_elsewhere(); }), "the number of the bisection");
}

TEST_F(ToldBisections, ThatFailAreNamed) {
    const auto refused_with = [&](auto change) {
        change();
        std::string sentence = refusal<GridError>([&] { draw(data[0].isovalue, 0.01); });
        show(data[0]);
        return sentence;
    };
    EXPECT_EQ(refused_with([&] { field.node_values = [](auto...) { return 7; }; }),
              "the operation 'node_values' of the field failed with code 7");
    field.node_gradients = [](auto...) { return 9; };
    EXPECT_EQ(refusal<GridError>([&] { draw(data[0].isovalue, 0, {.normals = true}); }),
              "the operation 'node_gradients' of the field failed with code 9");
    show(data[0]);
    EXPECT_EQ(refused_with([&] { grid.middles = [](auto...) { return 3; }; }),
              "the operation 'middles' of the grid failed with code 3");
    EXPECT_EQ(refused_with([&] { grid.node_positions = [](auto...) { return 1; }; }),
              "the operation 'node_positions' of the grid failed with code 1");
    EXPECT_EQ(refused_with([&] { put_tag_elsewhere(); }), "an element has the tag 7, not 1 to 3");
    EXPECT_EQ(refused_with([&] {
                  grid.middles = middles_but([](std::size_t count, std::uint64_t* out) {
                      if (count > 3) out[3] = NESTGRID_NO_NODE;
                  });
              }),
              "the operation 'middles' of the grid gave no node for an edge that is halved, for "
              "elements beside it are");
}

}  // namespace
