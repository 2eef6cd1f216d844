// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of CGAL as coarse grids; its octree as a nested grid.
#include <nestgrid/adapters/cgal.hpp>

#include <CGAL/Cartesian.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <nestgrid/check_grid.hpp>
#include <nestgrid/detail/erase.hpp>
#include <walk/walk.hpp>

#include "coarse_samples.hpp"
#include "element_in.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <class K>
CGAL::Surface_mesh<typename K::Point_3> to_cgal(const CoarseGrid& grid) {
    using Mesh = CGAL::Surface_mesh<typename K::Point_3>;
    using Number = typename K::FT;
    Mesh mesh;
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const Point x = grid.nodes[i];
        mesh.add_vertex({Number(x[0]), Number(x[1]), Number(x[2])});
    }
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        std::vector<typename Mesh::Vertex_index> loop;
        for (const auto n : grid.element(e)) loop.push_back(typename Mesh::Vertex_index(n));
        if (loop.size() == 4) std::swap(loop[2], loop[3]);
        EXPECT_NE(mesh.add_face(loop), Mesh::null_face());
    }
    return mesh;
}

template <class K>
void expect_round_trip(bool borrowed, double tolerance) {
    for (const bool quadrilaterals : {false, true}) {
        const CoarseGrid sample = torus(24, 12, quadrilaterals);
        const auto mesh = to_cgal<K>(sample);
        CoarseGrid grid = coarse_from_cgal(mesh);
        EXPECT_EQ(grid.nodes.borrowed(), borrowed);
        ASSERT_EQ(grid.element_count(), sample.element_count());
        for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
            EXPECT_LE(norm(grid.nodes[i] - sample.nodes[i]), tolerance);
        }
        EXPECT_EQ(grid.shapes, sample.shapes);
        EXPECT_NEAR(total_measure(grid), total_measure(sample), 100 * tolerance);
        check_and_orient(grid);
    }
}

TEST(CgalSurface, LendsDoublesAndFloats) {
    expect_round_trip<Kernel>(true, 0);
    expect_round_trip<CGAL::Simple_cartesian<double>>(true, 0);
    expect_round_trip<CGAL::Simple_cartesian<float>>(true, 1e-6);
}

TEST(CgalSurface, CopiesWhatIsNoThreeNumbers) {
    expect_round_trip<CGAL::Exact_predicates_exact_constructions_kernel>(false, 0);
    expect_round_trip<CGAL::Cartesian<double>>(false, 0);
}

TEST(CgalSurface, IsRefusedWithASentence) {
    using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
    Mesh mesh = to_cgal<Kernel>(torus(8, 6, true));
    CGAL::Euler::remove_face(mesh.halfedge(Mesh::Face_index(5)), mesh);
    expect_sentence<InvalidInput>([&] { coarse_from_cgal(mesh); },
                                  {"removed elements", "collect_garbage()"});
    mesh.collect_garbage();
    CoarseGrid open = coarse_from_cgal(mesh);
    EXPECT_EQ(open.element_count(), 47U);
    check_and_orient(open);

    Mesh pentagon;
    std::vector<Mesh::Vertex_index> loop;
    for (int i = 0; i < 5; ++i) {
        loop.push_back(pentagon.add_vertex({std::cos(1.2566 * i), std::sin(1.2566 * i), 0}));
    }
    pentagon.add_face(loop);
    expect_sentence<InvalidInput>([&] { coarse_from_cgal(pentagon); }, {"face 0", "5 corners"});

    Mesh twice = to_cgal<Kernel>(torus(8, 6, true));
    twice.add_vertex(twice.point(Mesh::Vertex_index(7)));
    CoarseGrid grid = coarse_from_cgal(twice);
    expect_sentence<InvalidInput>([&] { check_and_orient(grid); },
                                  {"duplicate vertex", "7 and 48"});
    grid = coarse_from_cgal(Mesh());
    expect_sentence<InvalidInput>([&] { check_and_orient(grid); }, {"no element"});
}

using Points = std::vector<Kernel::Point_3>;
using Octree = CGAL::Octree<Kernel, Points>;

/// A function of the place of a node, which the handles of CGAL give exactly.
class FieldOnOctree {
public:
    using value_type = double;
    using Element = CgalOctree<Octree>::Element;

    explicit FieldOnOctree(const Octree& tree) : tree_{&tree} {}

    NodeMask coarse_values(std::size_t, std::span<double> out) const {
        for (std::size_t i = 0; i < 8; ++i) {
            out[i] = value(tree_->root(), {double(i & 1U), double(i >> 1 & 1U), double(i >> 2)});
        }
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out) const {
        static const std::vector<Point> places = reference_nodes(dyadic_rule(Shape::hexahedron));
        for (std::size_t n = 0; n < out.size(); ++n) {
            if ((which >> n & 1U) != 0) out[n] = value(e, places[8 + n]);
        }
        return 0;
    }

    /// \param local coordinates in the node, from 0 to 1
    static Point place(const Element& e, const Point& local) {
        Point x{};
        for (std::size_t d = 0; d < 3; ++d) {
            x[d] = std::ldexp(e.global_coordinates()[d] + local[d], -e.depth());
        }
        return x;
    }

private:
    static double value(const Element& e, const Point& local) {
        const Point x = place(e, local) - Point{0.5, 0.5, 0.5};
        return norm(x) + 0.1 * std::sin(9 * x[0] + 5 * x[1] * x[2]);
    }

    const Octree* tree_;
};

/// Counts and measures the elements of a walk.
class Leaves final : public engine::Visitor<double> {
public:
    using View = engine::ElementView<double>;

    explicit Leaves(const engine::Walk<double>& walk, const CgalOctree<Octree>& grid,
                    const Octree& tree)
        : walk_{&walk}, grid_{&grid}, tree_{&tree} {}

    std::size_t count = 0;
    std::size_t inner = 0;
    double volume = 0;
    double worst = 0;

    engine::Decision inspect(const View&, const engine::Split& split) override {
        if (split.rule != nullptr) ++inner;
        return {};
    }
    void extract(const View& view) override {
        ++count;
        const CGAL::Bbox_3 box = tree_->bbox(element_in(*grid_, view));
        std::array<Point, max_corners> x;
        walk_->corners(view, nullptr, x.data());
        const Point low = x[0];
        const Point high = x[7];
        for (std::size_t d = 0; d < 3; ++d) {
            const auto axis = static_cast<int>(d);
            worst = std::max(worst, std::abs(low[d] - box.min(axis)));
            worst = std::max(worst, std::abs(high[d] - box.max(axis)));
        }
        volume += (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]);
    }

private:
    const engine::Walk<double>* walk_;
    const CgalOctree<Octree>* grid_;
    const Octree* tree_;
};

TEST(CgalOctree, IsANestedGridAroundASphere) {
    const CGAL::Sphere_3<Kernel> sphere({0.5, 0.5, 0.5}, 0.09);
    for (const bool balanced : {true, false}) {
        Points points{{0, 0, 0}, {1, 1, 1}};
        Octree tree(points, {}, 1.0);
        tree.refine([&](const Octree::Node& node) {
            return node.depth() < 6 && CGAL::do_intersect(tree.bbox(node), sphere);
        });
        if (balanced) tree.grade();
        std::size_t nodes = 0;
        std::size_t leaves = 0;
        for (const Octree::Node& node : tree.traverse<CGAL::Orthtrees::Preorder_traversal>()) {
            ++nodes;
            if (node.is_leaf()) ++leaves;
        }
        EXPECT_EQ(tree.depth(), 6U);
        EXPECT_GT(leaves, 5000U);

        const CgalOctree grid(tree);
        static_assert(NestedGrid<CgalOctree<Octree>>);
        static_assert(sizeof(CgalOctree<Octree>::Element) == sizeof(void*));
        const FieldOnOctree field(tree);
        const auto violation = check_grid(grid, field);
        EXPECT_FALSE(violation.has_value()) << violation->sentence;

        const auto hierarchy = erase(grid, field);
        const engine::Walk<double> walk(hierarchy, {.keys = false, .positions = true});
        Leaves found(walk, grid, tree);
        walk.run(found);
        EXPECT_EQ(found.inner + found.count, nodes);
        EXPECT_EQ(found.count, leaves);
        EXPECT_NEAR(found.volume, 1, 1e-12);
        EXPECT_EQ(found.worst, 0);
    }
}

TEST(CgalOctree, MayJumpOverLevels) {
    Points points{{0, 0, 0}, {1, 2, 3}};
    Octree tree(points);
    tree.refine([&](const Octree::Node& node) {
        return node.depth() < (node.global_coordinates()[0] == 0 ? 5 : 2);
    });
    const auto violation = check_grid(CgalOctree(tree), FieldOnOctree(tree));
    EXPECT_FALSE(violation.has_value()) << violation->sentence;
}

}  // namespace
