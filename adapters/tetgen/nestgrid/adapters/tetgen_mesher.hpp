// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TetGen as a mesher of piecewise linear complexes; included by tetgen.hpp.
//
// TetGen reports a failure by throwing an int after it has freed the memory of its mesh, which the
// destructor of the mesh then frees again. So its steps are called here, on a mesh that is never
// destroyed after a failure.
#pragma once

#include <ctime>
#include <memory>
#include <set>

#include <tetgen.h>

#include <nestgrid/adapters/coarse.hpp>

namespace nestgrid {

struct TetgenOptions {
    /// TetGen's switches (its manual, chapter 4) p q a Y O S T o z with their numbers, such as
    /// "pq1.4a0.1": quality 1.4, tetrahedra of a volume of 0.1 at most.
    std::string switches = "pq1.4";
};

namespace detail {

/// Whether all points lie in a plane, up to TetGen's tolerance.
inline bool is_flat(const tetgenio& plc) {
    const auto from_first = [&](std::ptrdiff_t i) {
        const double* x = plc.pointlist;
        return Point{x[3 * i] - x[0], x[3 * i + 1] - x[1], x[3 * i + 2] - x[2]};
    };
    const auto greatest = [&](auto&& size_of) {
        Point best{};
        for (std::ptrdiff_t i = 1; i < plc.numberofpoints; ++i) {
            const Point x = size_of(from_first(i));
            if (norm(x) > norm(best)) best = x;
        }
        return best;
    };
    const Point along = greatest([](const Point& x) { return x; });
    const Point normal = greatest([&](const Point& x) { return cross(along, x); });
    const Point height = greatest([&](const Point& x) { return Point{dot(normal, x), 0, 0}; });
    return norm(height) <= 1e-7 * norm(normal) * norm(along);
}

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

/// Marks of the facets that meet where they must not, as far as TetGen finds them.
inline std::string meeting_facets(tetgenio& plc) {
    tetgenbehavior behavior;
    behavior.plc = behavior.diagnose = behavior.quiet = 1;
    tetgenio found;
    try {
        with_tetgen([&](tetgenmesh& m) {
            start_tetgen(m, behavior, plc);
            m.detectinterfaces();
            if (m.subfaces->items > 0) m.outsubfaces(&found);
        });
    } catch (int) {
        return "";
    }
    if (found.trifacemarkerlist == nullptr) return "";
    const std::set<int> facets(found.trifacemarkerlist,
                               found.trifacemarkerlist + found.numberoftrifaces);
    std::string text;
    for (const int facet : facets)
        text += (text.empty() ? ": facets " : ", ") + std::to_string(facet);
    return text;
}

}  // namespace detail

/// Fills a piecewise linear complex with tetrahedra.
/// \throw InvalidInput for a complex that is not closed, intersects itself or is too small or thin
///        for TetGen, and for other switches; facets are named by their marks
inline void tetrahedralize(tetgenio& plc, tetgenio& mesh, const TetgenOptions& options = {}) {
    std::string switches = options.switches + "Q";
    tetgenbehavior behavior;
    if (options.switches.find_first_not_of("pqaYOSToz0123456789./") != std::string::npos ||
        switches.size() > 500 || !behavior.parse_commandline(switches.data()) ||
        behavior.plc == 0) {
        throw InvalidInput("the switches '" + options.switches +
                           "' do not ask TetGen for a mesh of a complex");
    }
    if (plc.numberofpoints < 4) throw InvalidInput("the complex has less than four points");
    if (detail::is_flat(plc)) throw InvalidInput("the complex is flat");
    try {
        detail::with_tetgen([&](tetgenmesh& m) {
            detail::start_tetgen(m, behavior, plc);
            detail::finish_tetgen(m, behavior, mesh);
        });
    } catch (const int code) {
        throw InvalidInput(
            code == 1    ? "TetGen has not enough memory for the complex"
            : code == 3  ? "the complex intersects itself" + detail::meeting_facets(plc)
            : code == 4  ? "the complex has details too small for TetGen"
            : code == 5  ? "the complex has facets too close to each other for TetGen"
            : code == 10 ? "TetGen refuses the complex"
                         : "TetGen fails on the complex (" + std::to_string(code) + ")");
    }
    if (mesh.numberoftetrahedra == 0) {
        throw InvalidInput(
            "nothing lies inside the complex: its facets do not close, or its holes take "
            "everything");
    }
}

}  // namespace nestgrid
