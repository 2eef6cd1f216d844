// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data that jump, given by C codes, have the bits that C++ codes get.
#include <nestgrid/algorithms/discontinuous.h>
#include <nestgrid/algorithms/discontinuous.hpp>

#include "c_scenes.hpp"

namespace c_algorithms_test {

/// Of two components: a function with a constant of each leaf on top, and that constant.
template <int dim>
struct JumpingValues {
    static constexpr int components = 2;

    const Forest<dim>* forest;
    double jump = 0.03;

    void leaf_values(const std::uint32_t& leaf, std::span<double> out) const {
        const auto& nodes = forest->cells[leaf].nodes;
        for (std::size_t k = 0; 2 * k < out.size(); ++k) {
            out[2 * k + 1] = jump * (leaf % 7);
            out[2 * k] = wave(forest->positions[nodes[k]]) + out[2 * k + 1];
        }
    }
};

template <int dim>
struct JumpingScene : Scene<dim> {
    explicit JumpingScene(const Forest<dim>& made) : Scene<dim>(made) {
        table.size = sizeof(table);
        table.self = &values;
        table.components = 2;
        table.leaf_values = [](const void* self, const nestgrid_element* leaf, std::size_t corners,
                               double* out) {
            const auto& of = *static_cast<const JumpingValues<dim>*>(self);
            const auto e = Crossing<Forest<dim>>::load(leaf);
            if (corners != topology(of.forest->cells[e].shape).corners) return 7;
            of.leaf_values(e, {out, 2 * corners});
            return 0;
        };
    }
    template <class Draw>
    nestgrid_surface drawn(const Draw& draw) {
        nestgrid_surface surface{};
        EXPECT_EQ(draw(&this->in_c.table, &table, &this->options, &surface, this->message.data(),
                       this->message.size()),
                  0)
            << this->message.data();
        return surface;
    }
    template <class Draw>
    std::string refusal(const Draw& draw) {
        nestgrid_surface surface{};
        this->message.fill('x');
        EXPECT_NE(draw(&this->in_c.table, &table, &this->options, &surface, this->message.data(),
                       this->message.size()),
                  0);
        EXPECT_EQ(surface.owner, nullptr);
        return this->message.data();
    }

    JumpingValues<dim> values{&this->grid};
    nestgrid_leaf_data table{};
    DiscontinuousData direct{this->grid, values};
};

/// A ball around the origin, with the operations of the function in C.
class Hull final : public LevelFunction {
public:
    explicit Hull(double radius) : radius_{radius} {}
    double value(const Point& x) const override { return std::hypot(x[0], x[1], x[2]) - radius_; }
    double variation(const Point&, double radius) const override { return radius; }

private:
    double radius_;
};

class JumpsForC : public ::testing::Test {
protected:
    static constexpr Point through{0.4, 0.5, 0.3};
    static constexpr Point normal{1, 0.5, -2};

    static int cut(const nestgrid_grid* grid, const nestgrid_leaf_data* data,
                   const nestgrid_options* options, nestgrid_surface* out, char* message,
                   std::size_t size) {
        return nestgrid_discontinuous_slice(grid, data, through.data(), normal.data(), options, out,
                                            message, size);
    }
};

TEST_F(JumpsForC, HeightFieldsAreTheSame) {
    for (const auto& forest : forests<2>()) {
        JumpingScene<2> scene(forest);
        scene.options.elements = 1;
        const auto height = [&] {
            return scene.drawn([](const auto* grid, const auto* data, auto... more) {
                return nestgrid_discontinuous_height_field(grid, data, 0.5, more...);
            });
        };
        nestgrid_surface all = height();
        const std::size_t triangles = all.simplex_count;
        expect_same(all, height_field(scene.direct, 0.5));
        scene.options.error = 0.3;
        nestgrid_surface surface = height();
        EXPECT_LT(surface.simplex_count, triangles);
        expect_same(surface, height_field(scene.direct, 0.5, {.threshold = 0.3}));
        scene.options.error = 0;
        scene.options.max_triangles = triangles / 2;
        surface = height();
        EXPECT_LE(surface.simplex_count, triangles / 2);
        expect_same(surface, height_field(scene.direct, 0.5, {.max_triangles = triangles / 2}));
    }
}

TEST_F(JumpsForC, SlicesAreTheSame) {
    for (const auto& forest : forests<3>()) {
        JumpingScene<3> scene(forest);
        scene.options.elements = 1;
        const Plane plane(through, normal);
        const double radius = 0.8;
        nestgrid_level_function ball{};
        ball.size = sizeof(ball);
        ball.self = &radius;
        ball.value = [](const void* self, const double* x, double* out) {
            *out = std::hypot(x[0], x[1], x[2]) - *static_cast<const double*>(self);
            return 0;
        };
        ball.variation = [](const void*, const double*, double reach, double* out) {
            *out = reach;
            return 0;
        };
        for (const double threshold : {0.0, 0.4}) {
            for (const int threads : {0, 3}) {
                scene.options.threshold = threshold;
                scene.options.threads = threads;
                nestgrid_surface surface = scene.drawn(cut);
                expect_same(surface, slice(scene.direct, plane, {.threshold = threshold}));
                surface = scene.drawn([&](const auto* grid, const auto* data, auto... more) {
                    return nestgrid_discontinuous_slice_along(grid, data, &ball, more...);
                });
                expect_same(surface, slice(scene.direct, Hull(radius), {.threshold = threshold}));
            }
        }
    }
}

TEST_F(JumpsForC, SayWhatIsWrong) {
    JumpingScene<3> scene(kuhn<3>(0));
    const auto says = [&] { return scene.refusal(cut); };
    scene.options.cap = 1;
    EXPECT_EQ(says(), "data that jump are drawn without 'cap': leave it out of the options");
    scene.options.cap = 0;
    scene.options.threshold = -1;
    EXPECT_EQ(says(), "the threshold is negative or not a number");
    scene.options.threshold = 0;
    scene.table.leaf_values = [](const void*, const nestgrid_element*, std::size_t, double*) {
        return 4;
    };
    EXPECT_EQ(says(), "the operation 'leaf_values' of the data of leaves failed with code 4");
    scene.table.components = 0;
    EXPECT_EQ(says(), "the data of leaves have 0 components");
    scene.table.leaf_values = nullptr;
    EXPECT_EQ(says(), "the table of the data of leaves lacks the function 'leaf_values'");
    scene.table.size = 8;
    EXPECT_EQ(says(), "the table of the data of leaves is too small: its size says 8 bytes");
    nestgrid_ranks alone{};
    alone.size = sizeof(alone);
    alone.count = 1;
    alone.exchange = [](auto...) { return 0; };
    alone.gather = [](void*, std::size_t size, const void* own, const nestgrid_message** from) {
        static nestgrid_message sent;
        sent = {0, size, own};
        *from = &sent;
        return 0;
    };
    alone.reduce = [](auto...) { return 0; };
    scene.options.ranks = &alone;
    EXPECT_NE(says().find("discontinuous data is not made for distributed grids yet"),
              std::string::npos)
        << scene.message.data();
}

}  // namespace c_algorithms_test
