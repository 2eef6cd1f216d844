// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes of Lagrange cells, with their points in the order of VTK's own functions.
#pragma once

#include <map>
#include <numeric>
#include <random>

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkLagrangeHexahedron.h>
#include <vtkLagrangeQuadrilateral.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <nestgrid/adapters/lagrange.hpp>

namespace nestgrid_test {

inline std::vector<std::int64_t> numbers_to(std::size_t count) {
    std::vector<std::int64_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

struct Mesh {
    std::vector<double> coordinates{};
    std::vector<std::uint8_t> types{};
    std::vector<std::int64_t> first{0};
    std::vector<std::int64_t> points{};
    std::vector<double> degrees{};

    nestgrid::CellArrays arrays() const { return {coordinates, types, first, points, degrees}; }
    nestgrid::Point place(std::size_t i) const {
        return {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
    }
    template <class Function>
    std::vector<double> sampled(const Function& function) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < coordinates.size() / 3; ++i) {
            values.push_back(function(place(i)));
        }
        return values;
    }
    void append(const Mesh& other) {
        const auto offset = static_cast<std::int64_t>(coordinates.size() / 3);
        const auto begin = static_cast<std::int64_t>(points.size());
        coordinates.insert(coordinates.end(), other.coordinates.begin(), other.coordinates.end());
        types.insert(types.end(), other.types.begin(), other.types.end());
        for (const std::int64_t point : other.points) points.push_back(offset + point);
        for (std::size_t i = 1; i < other.first.size(); ++i)
            first.push_back(begin + other.first[i]);
    }
};

struct BoxOptions {
    bool own_points = false;
    bool mirrored = false;  ///< every other cell is numbered as in a mirror
    double noise = 0;       ///< of places
    double shear = 0;
    nestgrid::Point offset{0, 0, 0};
};

/// The unit square or cube, n cells along each direction, of degree p.
inline Mesh lagrange_box(int dim, int n, int p, const BoxOptions& options) {
    using nestgrid::Point;
    Mesh mesh;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-options.noise, options.noise);
    std::map<std::array<int, 3>, std::int64_t> known;
    const int cells = dim == 3 ? n * n * n : n * n;
    const std::array<int, 3> order{p, p, p};
    for (int c = 0; c < cells; ++c) {
        const std::array<int, 3> low{c % n * p, c / n % n * p, c / (n * n) * p};
        const int nodes = (p + 1) * (p + 1) * (dim == 3 ? p + 1 : 1);
        std::vector<std::int64_t> of_cell(static_cast<std::size_t>(nodes));
        for (int i = 0; i < nodes; ++i) {
            const std::array<int, 3> in{i % (p + 1), i / (p + 1) % (p + 1), i / (p + 1) / (p + 1)};
            std::array<int, 3> at{low[0] + in[0], low[1] + in[1], low[2] + in[2]};
            if (options.mirrored && c % 2 == 1) at[0] = low[0] + p - in[0];
            const auto next = static_cast<std::int64_t>(mesh.coordinates.size() / 3);
            const bool fresh = options.own_points || !known.contains(at);
            const std::int64_t point = fresh ? next : known[at];
            known[at] = point;
            if (fresh) {
                const double h = 1.0 / (n * p);
                mesh.coordinates.push_back(options.offset[0] + at[0] * h +
                                           options.shear * at[1] * h + noise(random));
                mesh.coordinates.push_back(options.offset[1] + at[1] * h + noise(random));
                mesh.coordinates.push_back(dim == 3 ? options.offset[2] + at[2] * h + noise(random)
                                                    : 0);
            }
            const int place =
                dim == 3
                    ? vtkLagrangeHexahedron::PointIndexFromIJK(in[0], in[1], in[2], order.data())
                    : vtkLagrangeQuadrilateral::PointIndexFromIJK(in[0], in[1], order.data());
            of_cell[static_cast<std::size_t>(place)] = point;
        }
        mesh.points.insert(mesh.points.end(), of_cell.begin(), of_cell.end());
        mesh.first.push_back(static_cast<std::int64_t>(mesh.points.size()));
        mesh.types.push_back(dim == 3 ? 72 : 70);
    }
    return mesh;
}

/// A cell beside smaller ones, as a solver with hanging nodes writes them.
inline Mesh beside_halves(int dim) {
    Mesh mesh = lagrange_box(dim, 1, 2, {});
    mesh.append(lagrange_box(dim, 2, 2, {.offset = {1, 0, 0}}));
    return mesh;
}

inline void to_vtk(const Mesh& mesh, vtkUnstructuredGrid& grid) {
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (std::size_t i = 0; i < mesh.coordinates.size() / 3; ++i) {
        points->InsertNextPoint(mesh.place(i).data());
    }
    grid.SetPoints(points);
    for (std::size_t c = 0; c < mesh.types.size(); ++c) {
        std::vector<vtkIdType> of_cell(mesh.points.begin() + mesh.first[c],
                                       mesh.points.begin() + mesh.first[c + 1]);
        grid.InsertNextCell(mesh.types[c], static_cast<vtkIdType>(of_cell.size()), of_cell.data());
    }
}

template <class Function>
void add_values(vtkUnstructuredGrid& grid, const char* name, const Function& function) {
    const vtkNew<vtkDoubleArray> values;
    values->SetName(name);
    for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) {
        std::array<double, 3> x{};
        grid.GetPoint(i, x.data());
        values->InsertNextValue(function(nestgrid::Point{x[0], x[1], x[2]}));
    }
    grid.GetPointData()->AddArray(values);
}

}  // namespace nestgrid_test
