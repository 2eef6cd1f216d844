// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The steps of TetGen, one after another; included by tetgen_mesher.hpp.
//
// TetGen reports a failure by throwing an int after it has freed the memory of its mesh, which the
// destructor of the mesh then frees again. So its steps are called here, on a mesh that is never
// destroyed after a failure.
#pragma once

#include <ctime>
#include <memory>

#include <tetgen.h>

namespace nestgrid::detail {

/// The surface of the complex, in which facets have been cut into triangles.
inline void start_tetgen(tetgenmesh& m, tetgenbehavior& behavior, tetgenio& plc) {
    clock_t time = 0;
    m.b = &behavior;
    m.in = &plc;
    m.initializepools();
    m.transfernodes();
    exactinit(0, 0, 0, m.xmax - m.xmin, m.ymax - m.ymin, m.zmax - m.zmin);
    m.incrementaldelaunay(time);
    m.meshsurface();
}

inline void finish_tetgen(tetgenmesh& m, tetgenbehavior& behavior, tetgenio& mesh) {
    clock_t time = 0;
    if (behavior.nobisect != 0) {
        m.recoverboundary(time);
    } else {
        m.constraineddelaunay(time);
    }
    m.carveholes();
    if (behavior.nobisect != 0) {
        if (m.subvertstack->objects > 0) m.suppresssteinerpoints();
        m.recoverdelaunay();
    }
    if (behavior.quality != 0) m.delaunayrefinement();
    if (behavior.optlevel > 0) m.optimizemesh();
    if (m.dupverts > 0 || m.unuverts > 0) m.jettisonnodes();
    if (behavior.order == 2) m.highorder();
    mesh.firstnumber = behavior.zeroindex != 0 ? 0 : m.in->firstnumber;
    m.outnodes(&mesh);
    if (m.tetrahedrons->items > 0) m.outelements(&mesh);
}

/// \throw int as TetGen does
template <class Steps>
void with_tetgen(Steps&& steps) {
    auto mesh = std::make_unique<tetgenmesh>();
    try {
        steps(*mesh);
    } catch (int) {
        ::operator delete(mesh.release());
        throw;
    }
}

}  // namespace nestgrid::detail
