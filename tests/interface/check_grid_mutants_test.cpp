// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every law of check_grid has a mutator that breaks it at a random place of a random grid; more
// than a thousand mutants, each named by the right law and a sentence.
#include <map>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/node_levels.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/detail/erase.hpp>
#include <walk/for_each_element.hpp>

#include "mutant.hpp"
#include "refusal.hpp"

using namespace nestgrid_test;

namespace {

constexpr int mutants_per_law = 60;

/// Breaks a grid or field; false where this one offers no place to break.
template <int dim>
using Mutator = std::function<bool(MutantGrid<dim>&, MutantField<dim>&, std::mt19937&)>;

template <int dim>
std::uint32_t random_refined(const MutantGrid<dim>& grid, std::mt19937& random) {
    std::vector<std::uint32_t> refined;
    for (std::uint32_t e = 0; e < grid.forest.cells.size(); ++e) {
        if (grid.forest.cells[e].rule != nullptr) refined.push_back(e);
    }
    return refined[random() % refined.size()];
}

/// Adds the mirror image of a coarse element, half as large, in the middle of one of its faces on
/// the boundary; false where it has none.
template <int dim>
bool put_half_beside(Forest<dim>& forest, std::mt19937& random) {
    const auto c = forest.coarse(random() % forest.coarse_count());
    const Topology& t = topology(c.shape);
    const FaceTopology& f = t.face[random() % t.faces];
    const auto ids_of = [](const auto& coarse, const FaceTopology& face) {
        std::set<std::uint64_t> ids;
        for (std::size_t k = 0; k < face.corners; ++k) ids.insert(coarse.ids[face.corner[k]]);
        return ids;
    };
    int uses = 0;
    for (std::size_t i = 0; i < forest.coarse_count(); ++i) {
        const auto other = forest.coarse(i);
        for (std::size_t k = 0; k < topology(other.shape).faces; ++k) {
            uses += ids_of(other, topology(other.shape).face[k]) == ids_of(c, f) ? 1 : 0;
        }
    }
    if (uses != 1) return false;
    const auto at = [&](std::size_t k) { return c.corners[f.corner[k]]; };
    Point middle{};
    for (std::size_t k = 0; k < f.corners; ++k) middle = middle + (1.0 / f.corners) * at(k);
    Point normal = cross(at(1) - at(0), dim == 2 ? Point{0, 0, 1} : at(2) - at(0));
    if (f.corners == 4) normal = cross(at(2) - at(0), at(3) - at(1));
    normal = (1 / norm(normal)) * normal;
    std::vector<std::uint32_t> nodes;
    for (std::size_t k = 0; k < t.corners; ++k) {
        const Point x = c.corners[k] - middle;
        nodes.push_back(forest.add_node(middle + 0.5 * (x - 2 * dot(x, normal) * normal)));
    }
    if (dim == 2) std::swap(nodes[0], nodes[1]);
    if (c.shape == Shape::quadrilateral) std::swap(nodes[2], nodes[3]);
    forest.add_coarse(c.shape, nodes, dim == 2 ? 1 : -c.orientation, 0);
    return true;
}

/// A coarse element, smaller, somewhere else, with nodes of its own.
template <int dim, class Coarse, class Place>
void add_copy(Forest<dim>& forest, const Coarse& c, const Place& place) {
    std::vector<std::uint32_t> nodes;
    for (std::size_t k = 0; k < topology(c.shape).corners; ++k) {
        nodes.push_back(forest.add_node(place(c.corners[k])));
    }
    forest.add_coarse(c.shape, nodes, c.orientation, 0);
}

/// A refined element and one of its new nodes that another element makes, too.
template <int dim>
bool random_shared_node(const MutantGrid<dim>& grid, std::mt19937& random, std::uint32_t& element,
                        std::size_t& node) {
    std::map<std::uint32_t, int> uses;
    std::vector<std::pair<std::uint32_t, std::size_t>> places;
    for (const auto& cell : grid.forest.cells) {
        for (std::size_t k = topology(cell.shape).corners; k < cell.nodes.size(); ++k) {
            ++uses[cell.nodes[k]];
        }
    }
    for (std::uint32_t e = 0; e < grid.forest.cells.size(); ++e) {
        const auto& cell = grid.forest.cells[e];
        const std::size_t corners = topology(cell.shape).corners;
        for (std::size_t k = corners; k < cell.nodes.size(); ++k) {
            if (uses[cell.nodes[k]] > 1) places.emplace_back(e, k - corners);
        }
    }
    if (places.empty()) return false;
    std::tie(element, node) = places[random() % places.size()];
    return true;
}

const Rule* spoilt(const Rule& rule, std::mt19937& random) {
    static std::vector<std::unique_ptr<Rule>> keep;
    keep.push_back(std::make_unique<Rule>(rule));
    Rule& r = *keep.back();
    Child& child = r.children[random() % r.children.size()];
    switch (random() % 5) {
        case 0:
            r.new_nodes[random() % r.new_nodes.size()].weight[0] += 0.125;
            break;
        case 1:
            child.orientation = static_cast<std::int8_t>(-child.orientation);
            break;
        case 2:
            r.children.pop_back();
            break;
        case 3:
            std::swap(child.corner[0], child.corner[1]);
            break;
        default:
            child = r.children[&child == &r.children[0] ? 1 : 0];
            break;
    }
    return &r;
}

/// The dyadic rule, but with the centre of one face as the mean of two edge midpoints: the same
/// place, other parents.
const Rule* staged_rule(std::size_t face, std::mt19937& random) {
    static std::vector<std::unique_ptr<Rule>> keep;
    const Topology& t = topology(Shape::hexahedron);
    const auto edge_between = [&](int a, int b) {
        for (int e = 0; e < t.edges; ++e) {
            const auto& ends = t.edge[static_cast<std::size_t>(e)];
            if ((ends[0] == a && ends[1] == b) || (ends[0] == b && ends[1] == a)) return 8 + e;
        }
        return -1;
    };
    Rule r = dyadic_rule(Shape::hexahedron);
    const auto& loop = t.face[face].corner;
    const std::size_t turn = random() % 2;
    r.new_nodes[12 + face] = mean_of({edge_between(loop[turn], loop[turn + 1]),
                                      edge_between(loop[turn + 2], loop[(turn + 3) % 4])});
    keep.push_back(std::make_unique<Rule>(make_rule("staged", r.parent, r.new_nodes, r.children)));
    return keep.back().get();
}

template <int dim>
std::map<Law, Mutator<dim>> mutators() {
    using Grid = MutantGrid<dim>;
    using Field = MutantField<dim>;
    using Random = std::mt19937;
    constexpr auto feature = [](Feature f) { return static_cast<unsigned>(f); };
    std::map<Law, Mutator<dim>> m;
    m[Law::rule] = [](Grid& g, Field&, Random& r) {
        const std::uint32_t e = random_refined(g, r);
        g.rules[e] = spoilt(*g.forest.cells[e].rule, r);
        return true;
    };
    m[Law::rule_shape] = [](Grid& g, Field&, Random& r) {
        const std::uint32_t e = random_refined(g, r);
        g.rules[e] = &dyadic_rule(Shape::segment);
        return true;
    };
    m[Law::split_repeats] = [](Grid& g, Field&, Random& r) {
        g.forgets = random_refined(g, r);
        return true;
    };
    m[Law::coarse_element] = [](Grid& g, Field&, Random& r) {
        g.coarse_at = r() % g.coarse_count();
        const auto how = r() % (dim == 3 ? 4 : 3);
        const std::size_t corner = r() % 3;
        g.change_coarse = [=](auto& c) {
            if (how == 0) c.corners[corner][1] = std::nan("");
            if (how == 1) c.ids[corner] = c.ids[(corner + 1) % 3];
            if (how == 2) c.shape = Shape::segment;
            if (how == 3) c.orientation = static_cast<std::int8_t>(-c.orientation);
        };
        return true;
    };
    m[Law::coarse_node] = [](Grid& g, Field&, Random& r) {
        if (g.coarse_count() < 2) return false;
        g.coarse_at = r() % g.coarse_count();
        // The nodes 0 and the last one belong to all Kuhn simplices; boxes share some.
        g.change_coarse = [](auto& c) {
            for (Point& x : c.corners) x[0] += 1e-3;
        };
        return true;
    };
    m[Law::coarse_face] = [](Grid& g, Field& f, Random& r) {
        const auto c = g.forest.coarse(r() % g.coarse_count());
        for (int copy = 0; copy < 2; ++copy) {
            auto cell = g.forest.cells[c.element];
            cell.nodes.resize(topology(cell.shape).corners);
            g.forest.add_coarse(cell.shape, cell.nodes, c.orientation, cell.tag);
        }
        (void)f;
        return true;
    };
    m[Law::coarse_contact] = [](Grid& g, Field&, Random& r) {
        return put_half_beside(g.forest, r);
    };
    m[Law::coarse_overlap] = [](Grid& g, Field&, Random& r) {
        const auto c = g.forest.coarse(r() % g.coarse_count());
        const std::size_t corners = topology(c.shape).corners;
        Point middle{};
        for (std::size_t k = 0; k < corners; ++k) {
            middle = middle + (1.0 / double(corners)) * c.corners[k];
        }
        const Point towards = c.corners[r() % corners];
        const double size = 0.3 + 0.1 * double(r() % 6);
        add_copy(g.forest, c, [&](const Point& x) {
            return middle + size * (x - middle) + 0.1 * (towards - middle);
        });
        return true;
    };
    m[Law::key_place] = [=](Grid& g, Field&, Random& r) {
        g.features = feature(Feature::own_keys);
        const std::size_t a = r() % g.keys.size();
        const std::size_t b = r() % g.keys.size();
        g.keys[a] = g.keys[b];
        return a != b;
    };
    m[Law::stable_key] = [=](Grid& g, Field&, Random& r) {
        g.features = feature(Feature::own_keys);
        const std::uint32_t father = random_refined(g, r);
        g.rekeyed = g.forest.cells[father].first_child +
                    static_cast<std::uint32_t>(r() % g.forest.cells[father].rule->children.size());
        g.corner = r() % topology(g.forest.cells[g.rekeyed].shape).corners;
        return true;
    };
    m[Law::dense_key] = [=](Grid& g, Field&, Random& r) {
        g.features = feature(Feature::own_keys) | feature(Feature::dense_keys);
        for (std::size_t n = 0; n < g.keys.size(); ++n) g.keys[n] = n;
        g.keys[r() % g.keys.size()] = g.keys.size() + r() % 100;
        return true;
    };
    m[Law::hanging_mask] = [=](Grid& g, Field&, Random& r) {
        g.features = feature(Feature::constrained);
        if (g.hanging.empty()) return false;
        auto at = g.hanging.begin();
        std::advance(at, r() % g.hanging.size());
        g.hanging.erase(at);
        return true;
    };
    m[Law::conforming] = [](Grid& g, Field&, Random&) {
        g.says_conforming = true;
        return !g.hanging.empty();
    };
    m[Law::hanging_value] = [](Grid& g, Field& f, Random& r) {
        if (g.hanging.empty()) return false;
        auto at = g.hanging.begin();
        std::advance(at, r() % g.hanging.size());
        f.field.values[*at] += 1e-3;
        return true;
    };
    m[Law::value_present] = [](Grid& g, Field& f, Random& r) {
        f.misses = random_refined(g, r);
        f.node = r() % g.forest.cells[f.misses].rule->new_nodes.size();
        return true;
    };
    m[Law::value_finite] = [](Grid&, Field& f, Random& r) {
        f.field.values[r() % f.field.values.size()] = r() % 2 == 0 ? NAN : INFINITY;
        return true;
    };
    m[Law::value_unique] = [](Grid& g, Field& f, Random& r) {
        return random_shared_node(g, r, f.differs, f.node);
    };
    m[Law::position] = [=](Grid& g, Field&, Random& r) {
        g.features = feature(Feature::own_positions);
        if (r() % 2 == 0) {
            g.positions[r() % g.positions.size()][2] += 1e-3;
            return true;
        }
        const std::uint32_t father = random_refined(g, r);  // its children share a node
        g.moved = g.forest.cells[father].first_child;
        const auto& corners = g.forest.cells[g.moved].nodes;
        for (g.corner = 0; g.corner < topology(g.forest.cells[g.moved].shape).corners; ++g.corner) {
            const auto& before = g.forest.cells[father].nodes;
            if (std::find(before.begin(), before.end(), corners[g.corner]) != before.end()) break;
        }
        return true;
    };
    m[Law::hidden] = [=](Grid& g, Field&, Random& r) {
        g.features = feature(Feature::hidden);
        const std::uint32_t father = random_refined(g, r);
        const auto& of = g.forest.cells[father];
        const auto child =
            static_cast<std::uint32_t>(of.first_child + r() % of.rule->children.size());
        const bool leaf = g.forest.cells[child].rule == nullptr;
        g.hides[r() % 2 == 0 ? child : father] = Hidden::wholly;
        if (leaf && r() % 2 == 0) g.hides = {{child, Hidden::partly}, {father, Hidden::partly}};
        return true;
    };
    m[Law::depth] = [](Grid& g, Field& f, Random& r) {
        std::fill(f.field.values.begin(), f.field.values.end(), 1.0);
        const std::uint32_t father = random_refined(g, r);
        auto& cells = g.forest.cells;
        const auto heir = static_cast<std::uint32_t>(cells[father].first_child +
                                                     r() % cells[father].rule->children.size());
        cells[heir] = cells[father];  // its children are those of its father, for ever
        return true;
    };
    if constexpr (dim == 3) {
        m[Law::one_stencil] = [](Grid& g, Field&, Random& r) {
            if (g.forest.cells[0].shape != Shape::hexahedron) return false;
            std::uint32_t e = 0;
            std::size_t node = 0;
            while (random_shared_node(g, r, e, node) && node < 12) {
                if (r() % 1000 == 0) return false;
            }
            if (node < 12 || node > 17) return false;
            g.rules[e] = staged_rule(node - 12, r);
            return true;
        };
    }
    return m;
}

template <int dim>
MutantGrid<dim> random_grid(unsigned seed, std::mt19937& random) {
    Forest<dim> forest = seed % 3 == 0   ? boxes<dim>(random, 2)
                         : seed % 3 == 1 ? kuhn<dim>(dim)
                         : dim == 3      ? kuhn<dim>(0)
                                         : boxes<dim>(random, 1);
    refine_randomly(forest, random, 10 + static_cast<int>(random() % 50));
    forest.refine(static_cast<std::uint32_t>(forest.cells.size() - 1),
                  forest.cells.back().tag > 0
                      ? bisection_rule(forest.cells.back().shape, forest.cells.back().tag)
                  : forest.cells.back().shape == Shape::tetrahedron
                      ? red_tetrahedron_rule()
                      : dyadic_rule(forest.cells.back().shape));
    return MutantGrid<dim>(forest);
}

template <int dim>
int run_mutants(Law law) {
    const Mutator<dim> mutate = mutators<dim>().at(law);
    int made = 0;
    for (unsigned seed = 0; made < mutants_per_law / 2 && seed < 2000; ++seed) {
        std::mt19937 random(seed);
        MutantGrid<dim> grid = random_grid<dim>(seed, random);
        // A linear function is its own interpolant everywhere.
        MutantField<dim> field(grid,
                               [](const Point& x) { return x[0] + 2 * x[1] - 3 * x[2] + 0.5; });
        const CheckOptions options{.max_depth = 30, .hanging_values = law == Law::hanging_value};
        if (law == Law::hanging_value) {
            if (check_grid(grid, field, options)) continue;  // deformed boxes are not linear
        }
        if (!mutate(grid, field, random)) continue;
        ++made;
        const auto violation = check_grid(grid, field, options);
        if (!violation) {
            ADD_FAILURE() << "mutant " << seed << " of law " << int(law) << " was not noticed";
            continue;
        }
        EXPECT_EQ(int(violation->law), int(law)) << seed << ": " << violation->sentence;
        EXPECT_GT(violation->sentence.size(), 20U);
    }
    return made;
}

class Mutants : public testing::TestWithParam<int> {};

TEST_P(Mutants, AreNamed) {
    const Law law = static_cast<Law>(GetParam());
    int made = run_mutants<3>(law);
    if (law != Law::one_stencil) made += run_mutants<2>(law);
    EXPECT_GE(made, law == Law::one_stencil ? mutants_per_law / 2 : mutants_per_law);
}

/// A square, divided into a triangle and a quadrilateral.
template <Shape promised>
struct Square {
    using Element = int;
    static constexpr int dimension = 2;
    static constexpr Shape only_shape = promised;
    Rule rule = make_rule("cut", Shape::quadrilateral, {mean_of({0, 1})},
                          {Child{.shape = Shape::triangle, .corner = {0, 4, 2}},
                           Child{.shape = Shape::quadrilateral, .corner = {4, 1, 2, 3}}});
    std::size_t coarse_count() const { return 1; }
    CoarseElement<int> coarse(std::size_t) const {
        CoarseElement<int> c;
        c.shape = Shape::quadrilateral;
        for (std::size_t k = 0; k < 4; ++k) {
            c.corners[k] = topology(c.shape).reference[k];
            c.ids[k] = k;
        }
        return c;
    }
    const Rule* split(int e) const { return e == 0 ? &rule : nullptr; }
    void children(int, std::span<int> out) const { std::iota(out.begin(), out.end(), 1); }
};

template <Shape promised>
std::optional<GridViolation> check_square() {
    return check_grid(Square<promised>{}, ZeroField<Square<promised>>{});
}

TEST(Promises, OfOneShapeAreKept) {
    EXPECT_FALSE(check_square<Shape::point>());  // nothing promised

    const auto child = check_square<Shape::quadrilateral>();
    ASSERT_TRUE(child);
    EXPECT_EQ(child->law, Law::rule_shape) << child->sentence;

    const auto coarse = check_square<Shape::triangle>();
    ASSERT_TRUE(coarse);
    EXPECT_EQ(coarse->law, Law::coarse_element) << coarse->sentence;
    using Wrong = Square<Shape::triangle>;
    const Wrong grid;
    const ZeroField<Wrong> zero;
    const auto hierarchy = erase(grid, zero);
    EXPECT_THROW(engine::count_levels(engine::Walk<float>(hierarchy, {})), GridError);
}

struct OneChild : Square<Shape::point> {
    static constexpr int max_children = 1;
};

TEST(Promises, OfFewChildrenAreKept) {
    const auto check = [] { return check_grid(OneChild{}, ZeroField<OneChild>{}); };
    EXPECT_EQ(refusal<GridError>(check),
              "the rule 'cut' has 2 children, but the grid's max_children is 1");
}

/// What walks a grid with this field says of its keys; each takes node_count() for a promise.
void expect_keys_refused(const MutantGrid<3>& grid, const MutantField<3>& field) {
    const char* const sentence = "own keys must lie below";
    const auto expect = [&](const auto& walk) {
        EXPECT_NE(refusal<GridError>(walk).find(sentence), std::string::npos);
    };
    expect([&] { HierarchicalIndicator(grid, field); });
    expect([&] { NodeLevels{grid}; });
    expect([&] { Region(grid, [](const Point&) { return true; }); });
}

TEST(DenseKeys, BeyondNodeCountAreRefusedByAlgorithms) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        MutantGrid<3> grid = random_grid<3>(seed, random);
        MutantField<3> field(grid, [](const Point& x) { return x[0]; });
        ASSERT_TRUE(mutators<3>().at(Law::dense_key)(grid, field, random));
        expect_keys_refused(grid, field);
    }
}

INSTANTIATE_TEST_SUITE_P(EveryLaw, Mutants, testing::Range(0, int(Law::hidden) + 1));

}  // namespace
