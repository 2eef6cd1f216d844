// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A cube that the tests of VTK's sources draw, and what a source says.
#pragma once

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>

#include <nestgrid/error.hpp>

#include "sample_grids.hpp"

namespace nestgrid_test {

/// Updates a source, and throws the sentence that it reports, without the name of the source.
inline void update_source(vtkAlgorithm* source) {
    std::string text;
    const vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(&text);
    observer->SetCallback([](vtkObject*, unsigned long, void* client, void* said) {
        *static_cast<std::string*>(client) += static_cast<const char*>(said);
    });
    const unsigned long tag = source->AddObserver(vtkCommand::ErrorEvent, observer);
    source->Update();
    source->RemoveObserver(tag);
    const std::size_t begin = text.find("): ");
    if (begin == std::string::npos) return;
    throw nestgrid::InvalidInput(text.substr(begin + 3, text.find('\n', begin) - begin - 3));
}

inline double height(const nestgrid::Point& x) { return x[0] + 2 * x[1] - x[2]; }
inline double bent(const nestgrid::Point& x) { return 3 - x[0] * x[0]; }

/// A refined unit cube, with a linear function and another one.
struct Cube {
    nestgrid::OctreeGrid<3> grid{hexahedra(2)};
    std::vector<double> first;
    std::vector<double> second;

    Cube() {
        refine_at_sphere(grid, 3);
        first = sample_nodes(grid, height);
        second = sample_nodes(grid, bent);
    }
};

}  // namespace nestgrid_test
