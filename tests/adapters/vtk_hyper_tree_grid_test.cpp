// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's own hyper tree grids: data of cells, by the means at nodes.
#include <map>

#include <vtkBitArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkUnsignedCharArray.h>

#include <nestgrid/adapters/vtk_hyper_tree_grid.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <walk/for_each_element.hpp>
#include <walk/project.hpp>

#include "changed_laws.hpp"
#include "element_in.hpp"
#include "hyper_trees.hpp"
#include "refusal_rows.hpp"
#include "solver_laws.hpp"

using namespace nestgrid_test;

namespace {

/// Trees refined at random, neighbours differing by any number of levels.
vtkNew<vtkHyperTreeGrid> random_trees(std::array<unsigned, 3> points, int depth, unsigned seed,
                                      bool transposed = false, unsigned factor = 2) {
    vtkNew<vtkHyperTreeGrid> grid;
    grid->SetTransposedRootIndexing(transposed);
    grid->SetDimensions(points.data());
    grid->SetBranchFactor(factor);
    grid->SetXCoordinates(coordinates(static_cast<int>(points[0])));
    grid->SetYCoordinates(coordinates(static_cast<int>(points[1])));
    grid->SetZCoordinates(coordinates(static_cast<int>(points[2])));
    std::mt19937 random(seed);
    vtkIdType next = 0;
    vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
    for (vtkIdType i = 0; i < grid->GetMaxNumberOfTrees(); ++i) {
        grid->InitializeNonOrientedCursor(cursor, i, true);
        subdivide(cursor, random, depth, next);
    }
    return grid;
}

/// Value of a function at the centre of every cell, in the order of the arrays.
template <int dim, int factor>
std::vector<double> at_centres(const HyperTreeGrid<dim, factor>& grid, std::size_t cells,
                               const std::function<double(const Point&)>& f) {
    std::vector<double> values(cells, 0.0);
    const ZeroField<HyperTreeGrid<dim, factor>> zero;
    const auto hierarchy = erase(grid, zero);
    const engine::Walk<float> walk(hierarchy, {.positions = true});
    engine::project(walk, Exact{}, [&](const auto& view) {
        std::array<Point, max_corners> x;
        walk.corners(view, nullptr, x.data());
        Point centre{0, 0, 0};
        const std::size_t n = view.corner_count();
        for (std::size_t k = 0; k < n; ++k) centre = centre + (1.0 / double(n)) * x[k];
        values.at(static_cast<std::size_t>(grid.index(element_in(grid, view)))) = f(centre);
    });
    return values;
}

template <int dim, int factor = 2>
void expect_laws(vtkHyperTreeGrid& trees) {
    const HyperTreeGrid<dim, factor> grid(trees);
    const auto cells = static_cast<std::size_t>(trees.GetNumberOfVertices());
    std::mt19937 random(3);
    const std::vector<std::function<double(const Point&)>> functions{
        [](const Point& x) { return x[0] + x[1] * x[1] + x[2] - 1.03; },
        [&](const Point&) { return uniform(random) - 0.5; },
        [&](const Point&) { return static_cast<double>(random() % 3) - 1; }};
    for (const auto& f : functions) {
        const std::vector<double> values = at_centres(grid, cells, f);
        const CellAverages field(
            grid, [&](const auto& e) { return values[static_cast<std::size_t>(grid.index(e))]; });
        expect_sound_grid(grid, field);
        expect_closed_levels(grid, field, 0.0);
    }
}

TEST(HyperTreeGrid, KeepsTheLaws) {
    for (const bool transposed : {false, true}) {
        expect_laws<3>(*random_trees({3, 4, 3}, 4, 1, transposed));
        expect_laws<2>(*random_trees({4, 3, 1}, 6, 2, transposed));
        expect_laws<2>(*random_trees({1, 4, 3}, 5, 3, transposed));
    }
}

TEST(HyperTreeGrid, KeepsTheLawsByThrees) {
    for (const bool transposed : {false, true}) {
        expect_laws<3, 3>(*random_trees({3, 3, 2}, 2, 1, transposed, 3));
        expect_laws<2, 3>(*random_trees({4, 3, 1}, 4, 2, transposed, 3));
        expect_laws<2, 3>(*random_trees({1, 4, 3}, 3, 3, transposed, 3));
    }
}

/// Also at walls and at changes of level, on trees whose sizes differ by direction.
template <int dim, int factor = 2>
void expect_linear_functions(vtkHyperTreeGrid& trees) {
    const HyperTreeGrid<dim, factor> grid(trees);
    const auto values =
        at_centres(grid, static_cast<std::size_t>(trees.GetNumberOfVertices()), slanted<dim>);
    const CellAverages field(
        grid, [&](const auto& e) { return values[static_cast<std::size_t>(grid.index(e))]; });
    expect_linear_exact(grid, field);
}

TEST(HyperTreeGrid, ReproducesLinearFunctions) {
    expect_linear_functions<3>(*random_trees({3, 4, 3}, 4, 1));
    expect_linear_functions<3>(*random_trees({2, 2, 2}, 5, 2));
    expect_linear_functions<2>(*random_trees({4, 3, 1}, 6, 3));
    expect_linear_functions<3, 3>(*random_trees({3, 3, 2}, 2, 1, false, 3));
    expect_linear_functions<2, 3>(*random_trees({4, 3, 1}, 4, 2, false, 3));
}

/// How many leaves a cursor of VTK meets from where it is.
std::size_t leaves_below(vtkHyperTreeGridNonOrientedCursor* cursor) {
    if (cursor->IsLeaf()) return 1;
    std::size_t count = 0;
    for (int c = 0; c < cursor->GetNumberOfChildren(); ++c) {
        cursor->ToChild(static_cast<unsigned char>(c));
        count += leaves_below(cursor);
        cursor->ToParent();
    }
    return count;
}

/// The leaves are those of VTK's own cursors, also where a limit makes leaves of divided cells.
template <int dim, int factor = 2>
void expect_leaves_of_vtk(vtkHyperTreeGrid& trees) {
    std::size_t expected = 0;
    vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
    for (vtkIdType i = 0; i < trees.GetMaxNumberOfTrees(); ++i) {
        trees.InitializeNonOrientedCursor(cursor, i);
        expected += leaves_below(cursor);
    }
    const HyperTreeGrid<dim, factor> grid(trees);
    std::size_t leaves = 0;
    const ZeroField<HyperTreeGrid<dim, factor>> zero;
    const auto hierarchy = erase(grid, zero);
    nestgrid::detail::for_each_leaf(hierarchy,
                                    [&](const nestgrid::detail::LeafView&) { ++leaves; });
    EXPECT_EQ(leaves, expected);
}

TEST(HyperTreeGrid, EndsAtTheLimitOfItsDepth) {
    for (const unsigned limit : {0U, 2U, 9U}) {
        const vtkNew<vtkHyperTreeGrid> space = random_trees({3, 4, 3}, 4, 1);
        const vtkNew<vtkHyperTreeGrid> plane = random_trees({1, 4, 3}, 4, 3, false, 3);
        space->SetDepthLimiter(limit);
        plane->SetDepthLimiter(limit);
        expect_leaves_of_vtk<3>(*space);
        expect_leaves_of_vtk<2, 3>(*plane);
        if (limit == 0) continue;  // there is nothing to leave out
        expect_laws<3>(*space);
        expect_laws<2, 3>(*plane);
        expect_linear_functions<3>(*space);
    }
}

/// Every triangle carries the data of its cell as they are.
TEST(HyperTreeGrid, SurfacesCarryTheDataOfLeaves) {
    const vtkNew<vtkHyperTreeGrid> trees = random_trees({4, 4, 4}, 4, 5);
    const HyperTreeGrid<3> grid(*trees);
    const auto cells = static_cast<std::size_t>(trees->GetNumberOfVertices());
    const auto f = [](const Point& x) { return x[0] + x[1] * x[2]; };
    const std::vector<double> values = at_centres(grid, cells, f);
    const CellAverages field(grid, [&](const HyperTreeGrid<3>::Element& e) {
        return values[static_cast<std::size_t>(grid.index(e))];
    });
    const HierarchicalIndicator indicator(grid, field);
    const Surface<3> surface = isosurface(grid, field, 0.7, under(Exact{}, indicator)).surface;
    const auto elements = surface.elements.as<HyperTreeGrid<3>::Element>();
    ASSERT_GT(surface.simplices.size(), 500U);
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& e = elements[surface.element_of[t]];
        ASSERT_EQ(grid.split(e), nullptr);
        EXPECT_EQ(field.leaf_value(e), values[static_cast<std::size_t>(grid.index(e))]);
        EXPECT_NEAR(field.leaf_value(e), 0.7, 0.6);
    }
}

/// What is masked is not drawn, whatever its data are; the surface is open towards it, and nowhere
/// else.
template <int dim>
void expect_laws_beside_a_mask(vtkHyperTreeGrid& trees, unsigned seed) {
    std::mt19937 random(seed);
    const auto cells = static_cast<std::size_t>(trees.GetNumberOfVertices());
    const vtkNew<vtkBitArray> mask;
    for (std::size_t i = 0; i < cells; ++i) mask->InsertNextValue(random() % 9 == 0);
    const std::vector<double> values =
        at_centres(HyperTreeGrid<dim>(trees), cells,
                   [&](const Point& x) { return x[0] + x[1] * x[1] + x[2] - 1.03; });
    trees.SetMask(mask);
    const HyperTreeGrid<dim> grid(trees);
    using Element = typename HyperTreeGrid<dim>::Element;
    const CellAverages field(grid, [&](const Element& e) {
        EXPECT_EQ(grid.hidden(e), Hidden::not_at_all);
        return values[static_cast<std::size_t>(grid.index(e))];
    });
    expect_sound_grid(grid, field);

    std::vector<std::array<Point, 2>> masked;  // boxes of leaves: first and last corner
    const ZeroField<HyperTreeGrid<dim>> zero;
    const auto hierarchy = erase(grid, zero);
    const engine::Walk<float> walk(hierarchy, {.positions = true});
    engine::for_each_element(walk, false, [&](const auto& view, const engine::Split& split) {
        if (split.rule != nullptr) return;
        if (grid.hidden(element_in(grid, view)) == Hidden::not_at_all) return;
        std::array<Point, max_corners> x;
        walk.corners(view, nullptr, x.data());
        masked.push_back({x[0], x[(std::size_t{1} << dim) - 1]});
    });
    ASSERT_GT(masked.size(), 100U);
    const auto beside_masked = [&](const Point& p) {
        return std::any_of(masked.begin(), masked.end(), [&](const auto& box) {
            bool inside = true;
            for (std::size_t d = 0; d < 3; ++d) {
                inside = inside && p[d] >= box[0][d] - 1e-9 && p[d] <= box[1][d] + 1e-9;
            }
            return inside;
        });
    };
    const HierarchicalIndicator indicator(grid, field);
    for (const double threshold : {0.0, 0.01, 0.1, 1.0}) {
        SCOPED_TRACE(threshold);
        const auto surface =
            isosurface(grid, field, 0.0, under(indicator, threshold), {.verify = true}).surface;
        EXPECT_GT(surface.simplices.size(), 20U);
        for (const Element& e : surface.elements.template as<Element>()) {
            EXPECT_EQ(grid.hidden(e), Hidden::not_at_all);
        }
        // Sides of simplices, each in one direction; those on the boundary are told.
        using Side = std::array<std::uint32_t, dim - 1>;
        std::map<Side, int> sides;
        const auto add = [&](const auto& simplex, std::size_t from, int orientation) {
            Side side;
            for (std::size_t i = 0; i + 1 < dim; ++i)
                side[i] = simplex[(from + i) % simplex.size()];
            if (dim == 2 && from == 1) orientation = -orientation;
            if (side.front() > side.back()) orientation = -orientation;
            std::sort(side.begin(), side.end());
            sides[side] += orientation;
        };
        for (const auto& s : surface.simplices) {
            for (std::size_t i = 0; i < s.size(); ++i) add(s, i, 1);
        }
        std::size_t open = 0;
        for (const Side& side : surface.boundary) {
            Side sorted = side;
            std::sort(sorted.begin(), sorted.end());
            sides.erase(sorted);
        }
        for (const auto& [side, count] : sides) {
            if (count == 0) continue;
            ++open;
            Point middle{0, 0, 0};
            for (const auto v : side) middle = middle + (1.0 / (dim - 1)) * surface.vertices[v];
            EXPECT_TRUE(beside_masked(middle));
        }
        EXPECT_GT(open, 10U);
    }
}

TEST(HyperTreeGrid, HidesWhatIsMasked) {
    expect_laws_beside_a_mask<3>(*random_trees({5, 5, 5}, 4, 1), 1);
    expect_laws_beside_a_mask<3>(*random_trees({5, 4, 4}, 4, 2, true), 2);
    expect_laws_beside_a_mask<2>(*random_trees({9, 8, 1}, 6, 2), 3);
}

/// Cells that another process has are hidden as masked ones are.
TEST(HyperTreeGrid, HidesGhostCells) {
    const vtkNew<vtkHyperTreeGrid> trees = random_trees({5, 5, 5}, 4, 1);
    std::mt19937 random(1);
    const vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    for (vtkIdType i = 0; i < trees->GetNumberOfVertices(); ++i) {
        ghosts->InsertNextValue(random() % 9 == 0 ? vtkDataSetAttributes::DUPLICATECELL : 0);
    }
    trees->GetCellData()->AddArray(ghosts);
    const HyperTreeGrid<3> grid(*trees);
    std::size_t hidden = 0;
    const CellAverages averages(grid, [&](const HyperTreeGrid<3>::Element& e) {
        EXPECT_EQ(ghosts->GetValue(grid.index(e)), 0);
        return 1.0;
    });
    const auto hierarchy = erase(grid, averages);
    const engine::Walk<double> walk(hierarchy, {.values = false});
    engine::for_each_element(walk, false, [&](const auto& view, const engine::Split& split) {
        if (split.rule != nullptr) return;
        const auto& e = element_in(grid, view);
        const bool is_ghost = ghosts->GetValue(grid.index(e)) != 0;
        EXPECT_EQ(grid.hidden(e), is_ghost ? Hidden::wholly : Hidden::not_at_all);
        hidden += is_ghost ? 1U : 0U;
    });
    EXPECT_GT(hidden, 100U);
    expect_sound_grid(grid, averages);
}

using Triangles = std::vector<std::array<Point, 3>>;

/// The triangles of what one of two processes draws, each beginning with its least corner.
/// \param rank of the process that has the trees of that parity; of the others it has ghosts
void draw_piece(vtkHyperTreeGrid& trees, int rank, GhostCells in_averages, Triangles& out) {
    const vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    ghosts->SetNumberOfValues(trees.GetNumberOfVertices());
    vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
    for (vtkIdType i = 0; i < trees.GetMaxNumberOfTrees(); ++i) {
        trees.InitializeNonOrientedCursor(cursor, i);
        vtkHyperTree* const tree = cursor->GetTree();
        const bool is_ghost = rank >= 0 && i % 2 != rank;
        for (vtkIdType v = 0; v < tree->GetNumberOfVertices(); ++v) {
            ghosts->SetValue(tree->GetGlobalIndexFromLocal(v),
                             is_ghost ? vtkDataSetAttributes::DUPLICATECELL : 0);
        }
    }
    trees.GetCellData()->AddArray(ghosts);
    const HyperTreeGrid<3> all(trees, in_averages);
    const CellAverages field(all, [&](const HyperTreeGrid<3>::Element& e) {
        return std::sin(static_cast<double>(all.index(e)));
    });
    const HyperTreeGrid<3> grid(trees);
    const HierarchicalIndicator indicator(grid, field);
    const auto surface = isosurface(grid, field, 0.1, under(Exact{}, indicator)).surface;
    for (const auto& s : surface.simplices) {
        std::array<Point, 3> x{surface.vertices[s[0]], surface.vertices[s[1]],
                               surface.vertices[s[2]]};
        std::rotate(x.begin(), std::min_element(x.begin(), x.end()), x.end());
        out.push_back(x);
    }
    trees.GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
}

/// Two processes draw what one does where data of ghost cells count and levels do not change
/// between the two; where they do not count, each sees a wall.
TEST(HyperTreeGrid, GhostCellsCountForNodes) {
    const vtkNew<vtkHyperTreeGrid> trees = random_trees({4, 4, 4}, 1, 1);  // all divided once
    for (const GhostCells in_averages : {GhostCells::shown, GhostCells::hidden}) {
        Triangles whole;
        draw_piece(*trees, -1, in_averages, whole);
        Triangles pieces;
        draw_piece(*trees, 0, in_averages, pieces);
        draw_piece(*trees, 1, in_averages, pieces);
        std::sort(whole.begin(), whole.end());
        std::sort(pieces.begin(), pieces.end());
        EXPECT_GT(whole.size(), 200U);
        EXPECT_EQ(whole == pieces, in_averages == GhostCells::shown);
    }
}

/// No leaf is left to take a mean of.
TEST(HyperTreeGrid, MasksMayHideEverything) {
    const vtkNew<vtkHyperTreeGrid> trees = random_trees({3, 3, 3}, 3, 1);
    const vtkNew<vtkBitArray> mask;
    for (vtkIdType i = 0; i < trees->GetNumberOfVertices(); ++i) mask->InsertNextValue(1);
    trees->SetMask(mask);
    const HyperTreeGrid<3> grid(*trees);
    const CellAverages field(grid, [](const HyperTreeGrid<3>::Element&) { return 1.0; });
    expect_sound_grid(grid, field);
    EXPECT_EQ(isosurface(grid, field, 0.5).surface.simplices.size(), 0U);
}

/// The values of a function at the centres of cells, as a field on a hyper tree grid.
struct Averages {
    explicit Averages(vtkHyperTreeGrid& trees)
        : grid{trees},
          values{at_centres(grid, static_cast<std::size_t>(trees.GetNumberOfVertices()),
                            [](const Point& x) { return x[0] + x[1] * x[1] + x[2] - 1.03; })} {}
    HyperTreeGrid<3> grid;
    std::vector<double> values;

    double operator()(const HyperTreeGrid<3>::Element& e) const {
        return values[static_cast<std::size_t>(grid.index(e))];
    }
};

/// Every change is noticed: of the trees, of the mask, of the coordinates.
TEST(HyperTreeGrid, RefusesWhatWasMadeBeforeAChange) {
    const vtkNew<vtkHyperTreeGrid> trees = random_trees({3, 4, 3}, 3, 1);
    const vtkNew<vtkBitArray> mask;
    for (vtkIdType i = 0; i < 100000; ++i) mask->InsertNextValue(0);
    const std::vector<std::function<void()>> changes{
        [&] {
            const vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
            trees->InitializeNonOrientedCursor(cursor, 5);
            while (!cursor->IsLeaf()) cursor->ToChild(0);
            const vtkIdType next = trees->GetGlobalNodeIndexMax() + 1;
            cursor->SubdivideLeaf();
            for (unsigned char c = 0; c < 8; ++c) {
                cursor->ToChild(c);
                cursor->SetGlobalIndexFromLocal(next + c);
                cursor->ToParent();
            }
        },
        [&] { trees->SetMask(mask); },
        [&] {
            mask->SetValue(7, 1);
            mask->Modified();
        },
        [&] {
            trees->GetXCoordinates()->SetTuple1(0, -1);
            trees->GetXCoordinates()->Modified();
        },
    };
    for (const auto& change : changes) {
        const Averages old_values(*trees);
        const CellAverages old_field(old_values.grid, std::cref(old_values));
        using Field = std::remove_const_t<decltype(old_field)>;
        MadeOnce<HyperTreeGrid<3>, Field> before(old_values.grid, old_field);
        change();
        const Averages values(*trees);
        const CellAverages field(values.grid, std::cref(values));
        expect_refused_after_change(before, values.grid, field);
        expect_changed("adapter", [&] { check_grid(old_values.grid, field); });
        expect_usable(values.grid, field);
    }
}

TEST(HyperTreeGrid, RefusesWhatItCannotRead) {
    const vtkNew<vtkHyperTreeGrid> flat = random_trees({3, 3, 1}, 1, 1);
    expect_refused([&] { HyperTreeGrid<3> grid(*flat); }, "has dimension 2, not 3");
    const vtkNew<vtkHyperTreeGrid> masked = random_trees({3, 3, 3}, 1, 1);
    const vtkNew<vtkBitArray> mask;
    for (vtkIdType i = 1; i < masked->GetNumberOfVertices(); ++i) mask->InsertNextValue(0);
    masked->SetMask(mask);
    expect_refused([&] { HyperTreeGrid<3> grid(*masked); }, "entries for 72 cells");
    vtkNew<vtkHyperTreeGrid> thirds;
    thirds->SetDimensions(2, 2, 2);
    thirds->SetBranchFactor(3);
    expect_refused([&] { HyperTreeGrid<3> grid(*thirds); }, "branch factor 3, not 2");
}

TEST(Refusals, OfHyperTreeGrids) {
    RefusalRows rows("VTK hyper tree grids");
    const auto trees = random_trees({3, 3, 3}, 1, 1);
    rows.add("another dimension", [&] { HyperTreeGrid<2>{*trees}; });
    rows.add("another branch factor", [] {
        vtkNew<vtkHyperTreeGrid> thirds;
        thirds->SetDimensions(2, 2, 2);
        thirds->SetBranchFactor(3);
        HyperTreeGrid<3>{*thirds};
    });
    const vtkNew<vtkBitArray> mask;
    mask->InsertNextValue(0);
    trees->SetMask(mask);
    rows.add("a mask that is too short", [&] { HyperTreeGrid<3>{*trees}; });
    trees->SetMask(nullptr);
    const vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    ghosts->InsertNextValue(0);
    trees->GetCellData()->AddArray(ghosts);
    rows.add("a ghost array that is too short", [&] { HyperTreeGrid<3>{*trees}; });
    trees->GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
    const HyperTreeGrid<3> grid(*trees);
    const CellAverages field(grid, [](const HyperTreeGrid<3>::Element&) { return 1.0; });
    const HierarchicalIndicator indicator(grid, field);
    trees->Modified();
    const HyperTreeGrid<3> anew(*trees);
    const CellAverages field_anew(anew, [](const HyperTreeGrid<3>::Element&) { return 1.0; });
    rows.add<GridError>("an adapter from before a change",
                        [&] { CellAverages(grid, [](const auto&) { return 1.0; }); });
    rows.add<GridError>("means of cells from before a change",
                        [&] { HierarchicalIndicator(grid, field); });
    rows.add<GridError>("an indicator from before a change",
                        [&] { isosurface(anew, field_anew, 0.5, under(indicator, 0)); });
}

}  // namespace
