// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests of p4est and p8est, balanced and not.
#include "p4est_samples.hpp"

#include <nestgrid/adapters/p4est.hpp>

#include "options.hpp"
#include "table_in_c.hpp"

namespace {

using namespace recording;
using namespace nestgrid_test;

/// By node key, behind tables: compiled once for all maps.
template <int dim, class Map>
void record_forest(const std::string& name, const Forest<dim>& forest, const Map& map) {
    const P4estGrid grid(forest.get(), map);
    using Grid = std::decay_t<decltype(grid)>;
    const NodePlaces<Grid> nodes(grid);
    const auto fields = catching_fields(nodes.places, 7);
    std::vector<KeyedField<Grid>> keyed;
    for (const NodalSamples& samples : fields) keyed.emplace_back(grid, nodes, samples.values);
    const TableInC in_c(grid);
    const TabledGrid<dim> tabled{in_c.table};
    std::vector<Subject<TabledField<double>>> subjects;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        subjects.push_back({fields[i].name.substr(0, fields[i].name.find(' ')),
                            {field_in_c(grid, keyed[i])},
                            0.0,
                            fields[i].name == "5 units in the last place" ? 0x1p-52 : 1});
    }
    record_options(name, tabled, subjects);
}

/// The solver's own numbers of nodes, without tables.
template <int dim>
void record_balanced(const std::string& name, Forest<dim> forest) {
    forest.balance();
    const auto nodes = forest.nodes();
    const P4estBalancedGrid<dim> grid(forest.get(), nodes.get());
    using Grid = std::decay_t<decltype(grid)>;
    std::mt19937 random(3);
    std::vector<std::vector<double>> values(3);
    for (int i = 0; i < nodes->num_local_nodes; ++i) {
        values[0].push_back(uniform(random) - 0.5);
        values[1].push_back(static_cast<double>(random() % 3) - 1);
        values[2].push_back(std::sin(0.05 * i));
    }
    using Field = std::decay_t<decltype(P4estNodalField(grid, nodes.get(), values[0]))>;
    std::vector<Subject<Field>> subjects;
    for (std::size_t i = 0; i < values.size(); ++i) {
        subjects.push_back(
            {"field" + std::to_string(i), Field(grid, nodes.get(), values[i]), 0.0, 1.0});
    }
    (void)sizeof(Grid);
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
    record_threads(name, grid, subjects);
}

template <int dim>
Forest<dim> refined(Forest<dim> forest, unsigned seed, int depth) {
    forest.refine_at_random(seed, depth);
    return forest;
}

}  // namespace

int main(int count, char** arguments) {
    MPI_Init(nullptr, nullptr);
    sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_SILENT);
    p4est_init(nullptr, SC_LP_SILENT);
    {
        const P4estVertices straight;
        using F2 = Forest<2>;
        using F3 = Forest<3>;
        const auto star = refined(F2(p4est_connectivity_new_star()), 3, 5);
        record_forest("p4est/2/star", star, straight);
        const auto ring = refined(F2(p4est_connectivity_new_brick(4, 1, 1, 0)), 6, 5);
        record_forest("p4est/2/ring", ring, [](std::size_t tree, const Point& r) {
            const double angle = 0.5 * M_PI * (static_cast<double>(tree) + r[0]);
            return (1 + r[1]) * Point{std::cos(angle), std::sin(angle), 0};
        });
        const auto rotated = refined(F3(p8est_connectivity_new_rotcubes()), 3, 3);
        record_forest("p4est/3/rotated_cubes", rotated, straight);
        const auto two = refined(F3(p8est_connectivity_new_twotrees(1, 4, 3)), 4, 4);
        record_forest("p4est/3/two_trees", two, straight);
        record_balanced<2>("p4est/2/balanced",
                           refined(F2(p4est_connectivity_new_brick(3, 2, 0, 0)), 2, 5));
        record_balanced<3>("p4est/3/balanced",
                           refined(F3(p8est_connectivity_new_brick(2, 2, 1, 0, 0, 0)), 2, 3));
    }
    const int code = finish(count, arguments);
    MPI_Finalize();
    return code;
}
