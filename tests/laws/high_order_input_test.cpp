// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is refused of data of higher degree, each in one sentence; and the three ways in.
#include <limits>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/hierarchy_copy.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/table.hpp>

#include "degree_world.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "table_in_c.hpp"

using namespace nestgrid_test;
using namespace nestgrid;

namespace {

double cubic(const Point& x) { return x[0] * x[0] * x[0] - x[1] * x[2] + 0.3 * x[1]; }

/// A field that errs where it is told to.
class Wrong {
public:
    using value_type = double;
    using Element = DegreeWorld<3>::Element;

    explicit Wrong(const DegreeWorld<3>& world) : field_{world} {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return field_.coarse_values(i, out);
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out) const {
        return field_.new_values(e, which, out);
    }
    int degree(const Element& e) const { return says.value_or(field_.degree(e)); }
    void evaluate(const Element& e, std::span<const Point> x, std::span<double> out) const {
        field_.evaluate(e, x, out);
        for (double& value : out) value = value * times + plus;
    }

    std::optional<int> says;
    double plus = 0;
    double times = 1;

private:
    DegreeField<3> field_;
};

class HighOrderInput : public testing::Test {
protected:
    DegreeWorld<3> world{{.levels = 1, .least_degree = 3, .greatest_degree = 3}, cubic};
    Wrong field{world};

    std::string violation() const {
        const auto found = check_grid(world, field);
        return found && found->law == Law::degree ? found->sentence : "";
    }
    std::string refused() const {
        return refusal<GridError>([&] { const HighOrder data(world, field); });
    }
};

TEST_F(HighOrderInput, CheckGridFindsWrongDegreesAndValues) {
    EXPECT_EQ(violation(), "");
    field.says = 4;
    EXPECT_EQ(violation(), "") << "a polynomial of degree 3 is one of degree 4";
    field.says = 2;
    EXPECT_NE(violation().find("no polynomial of degree 2"), std::string::npos) << violation();
    for (const int none : {0, -1, 9}) {
        field.says = none;
        EXPECT_NE(violation().find("has the degree " + std::to_string(none)), std::string::npos);
    }
    field.says = {};
    field.plus = 0.5;
    EXPECT_NE(violation().find("but the node there has the value"), std::string::npos);
    field.plus = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(violation().find("no finite number"), std::string::npos);
}

TEST_F(HighOrderInput, LeavesThatCannotBeAreNamed) {
    EXPECT_EQ(refused(), "");
    for (const int none : {0, -3, 9}) {
        field.says = none;
        EXPECT_NE(refused().find("has the degree " + std::to_string(none) + ", not 1 to 8"),
                  std::string::npos);
        EXPECT_EQ(refused().find("element 0"), 0U) << refused();
    }
    field.says = {};
    field.times = std::numeric_limits<double>::infinity();
    EXPECT_NE(refused().find("no finite number in element 0"), std::string::npos) << refused();
}

TEST_F(HighOrderInput, OptionsThatCannotBeAreRefused) {
    const HighOrder data(world, field);
    const auto with = [&](double tolerance, int depth) {
        return refusal([&] { const VirtualRefinement fine(data, {tolerance, depth}); });
    };
    EXPECT_EQ(with(0.1, 8), "");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double none : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(with(none, 8), "the tolerance is not a positive number");
    }
    EXPECT_NE(with(1e-13, 8).find("below 1e-12 of the range"), std::string::npos);
    for (const int none : {0, -1, 17}) {
        EXPECT_EQ(with(0.1, none), "the depth is " + std::to_string(none) + ", not 1 to 16");
    }
}

/// A field without polynomials.
struct Plain {
    using value_type = float;
    NodeMask coarse_values(std::size_t, std::span<float> out) const {
        std::ranges::fill(out, 0.0F);
        return 0;
    }
    NodeMask new_values(const DegreeWorld<3>::Element&, NodeMask, std::span<float> out) const {
        std::ranges::fill(out, 0.0F);
        return 0;
    }
};

/// An octree that halves elements in one direction.
struct OtherGrid {
    struct Element {
        int level = 0;
    };
    static constexpr int dimension = 3;
    const Rule* rule = nullptr;

    std::size_t coarse_count() const { return 1; }
    CoarseElement<Element> coarse(std::size_t) const {
        CoarseElement<Element> c;
        c.shape = Shape::hexahedron;
        for (std::size_t k = 0; k < 8; ++k) {
            c.corners[k] = topology(c.shape).reference[k];
            c.ids[k] = k;
        }
        return c;
    }
    const Rule* split(const Element& e) const { return e.level == 0 ? rule : nullptr; }
    void children(const Element&, std::span<Element> out) const {
        std::ranges::fill(out, Element{1});
    }
};
struct OtherField {
    using value_type = float;
    NodeMask coarse_values(std::size_t, std::span<float> out) const {
        std::ranges::fill(out, 0.0F);
        return 0;
    }
    NodeMask new_values(const OtherGrid::Element&, NodeMask, std::span<float> out) const {
        std::ranges::fill(out, 0.0F);
        return 0;
    }
    int degree(const OtherGrid::Element&) const { return 2; }
    void evaluate(const OtherGrid::Element&, std::span<const Point>, std::span<float> out) const {
        std::ranges::fill(out, 0.0F);
    }
};

/// A grid some of which is hidden.
struct HidingWorld : DegreeWorld<3> {
    using DegreeWorld<3>::DegreeWorld;
    Hidden hidden(const Element&) const { return Hidden::not_at_all; }
};

TEST_F(HighOrderInput, OtherGridsAndFieldsAreRefused) {
    expect_refused([&] { const HighOrder data(world, Plain()); }, "need degree() and evaluate()");
    const HidingWorld hiding({.least_degree = 2, .greatest_degree = 2}, cubic);
    expect_refused([&] { const HighOrder data(hiding, Wrong(hiding)); }, "beside hidden or masked");
    OtherGrid grid;
    Rule halved = make_rule("halved", Shape::hexahedron,
                            {{2, {0, 1}, {0.5, 0.5}},
                             {2, {2, 3}, {0.5, 0.5}},
                             {2, {4, 5}, {0.5, 0.5}},
                             {2, {6, 7}, {0.5, 0.5}}},
                            {{Shape::hexahedron, {0, 8, 2, 9, 4, 10, 6, 11}},
                             {Shape::hexahedron, {8, 1, 9, 3, 10, 5, 11, 7}}});
    grid.rule = &halved;
    expect_refused([&] { const HighOrder data(grid, OtherField()); }, "by the rule 'halved'");
    expect_refused([&] { const HierarchyCopy copy(erase(world, field)); },
                   "data of higher degree cannot be copied");
}

/// The table of a field in C tells the same polynomials, and its failures reach the caller.
TEST_F(HighOrderInput, TablesInCDrawTheSame) {
    const auto draw = [](const HighOrder& data) {
        const VirtualRefinement fine(data, {.tolerance = 0.01});
        return isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()),
                             {.elements = false});
    };
    const BehindTables tables(world, field);
    EXPECT_FALSE(check_hierarchy(*tables.hierarchy).has_value());
    const HighOrder behind(*tables.hierarchy);
    const HighOrder direct(world, field);
    const auto surface = draw(direct);
    EXPECT_GT(surface.surface.simplices.size(), 100U);
    expect_same(surface.surface, draw(behind).surface);

    const TableInC<DegreeWorld<3>> grid(world);
    nestgrid_field table = field_in_c(world, field);
    table.evaluate = nullptr;
    expect_refused([&] { (void)open_table<double>(grid.table, table); },
                   "one of 'degree' and 'evaluate' alone");
    table = field_in_c(world, field);
    table.degree = [](const void*, void*, const nestgrid_element*, int*) { return 7; };
    const auto failing = open_table<double>(grid.table, table);
    EXPECT_NE(refusal<GridError>([&] { const HighOrder data(*failing); }).find("'degree'"),
              std::string::npos);
    // A table that was compiled before there were such functions.
    table = field_in_c(world, field);
    table.size = offsetof(nestgrid_field, degree);
    EXPECT_FALSE(open_table<double>(grid.table, table)->offers(Feature::degree));
}

/// Values in float, and several components, of which the first one is drawn.
struct TwoComponents {
    using value_type = float;
    static constexpr int components = 2;
    const DegreeField<3>* field;

    NodeMask coarse_values(std::size_t i, std::span<float> out) const {
        std::vector<double> one(out.size() / 2);
        field->coarse_values(i, one);
        return spread(one, out);
    }
    NodeMask new_values(const DegreeWorld<3>::Element& e, NodeMask which,
                        std::span<float> out) const {
        std::vector<double> one(out.size() / 2);
        field->new_values(e, which, one);
        return spread(one, out);
    }
    int degree(const DegreeWorld<3>::Element& e) const { return field->degree(e); }
    void evaluate(const DegreeWorld<3>::Element& e, std::span<const Point> x,
                  std::span<float> out) const {
        std::vector<double> one(x.size());
        field->evaluate(e, x, one);
        spread(one, out);
    }
    static NodeMask spread(std::span<const double> one, std::span<float> out) {
        for (std::size_t i = 0; i < one.size(); ++i) {
            out[2 * i] = static_cast<float>(one[i]);
            out[2 * i + 1] = static_cast<float>(1 - 2 * one[i]);
        }
        return 0;
    }
};

TEST_F(HighOrderInput, FurtherComponentsAreCarriedAlong) {
    const DegreeField<3> data(world);
    const TwoComponents components{&data};
    const HighOrder both(world, components);
    const VirtualRefinement fine(both, {.tolerance = 0.02});
    const auto result = isosurface<3>(fine, 0.1, under(fine.criterion(), fine.bounds()));
    ASSERT_GT(result.surface.vertices.size(), 100U);
    ASSERT_EQ(result.surface.attributes.size(), result.surface.vertices.size());
    for (const double colour : result.surface.attributes) EXPECT_NEAR(colour, 0.8, 1e-5);
}

}  // namespace
