// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TetGen as a mesher of piecewise linear complexes; included by tetgen.hpp.
#pragma once

#include <nestgrid/adapters/tetgen_calls.hpp>
#include <nestgrid/adapters/tetgen_checks.hpp>

namespace nestgrid {

/// How TetGen fills a surface.
struct TetgenOptions {
    /// TetGen's switches (its manual, chapter 4) p q a Y O S T o z with their numbers, such as
    /// "pq1.4a0.1": quality 1.4, tetrahedra of a volume of 0.1 at most.
    std::string switches = "pq1.4";
};

namespace detail {

/// Marks of the facets that meet where they must not, as far as TetGen finds them.
/// \throw int as TetGen does
inline std::set<int> meeting_facets(tetgenio& plc) {
    tetgenbehavior behavior;
    behavior.plc = behavior.diagnose = behavior.quiet = 1;
    tetgenio found;
    with_tetgen([&](tetgenmesh& m) {
        start_tetgen(m, behavior, plc);
        m.detectinterfaces();
        if (m.subfaces->items > 0) m.outsubfaces(&found);
    });
    if (found.trifacemarkerlist == nullptr) return {};
    return {found.trifacemarkerlist, found.trifacemarkerlist + found.numberoftrifaces};
}

inline std::string tetgen_failure(int code) {
    switch (code) {
        case 1:
            return "TetGen has not enough memory for the complex";
        case 3:
            return "the complex intersects itself";
        case 4:
            return "the complex has details too small for TetGen";
        case 5:
            return "the complex has facets too close to each other for TetGen";
        default:
            return "TetGen fails on the complex, error " + std::to_string(code);
    }
}

}  // namespace detail

/// Fills a piecewise linear complex with tetrahedra. TetGen says some of its failures on standard
/// output, whatever the switches, and on a complex that is thoroughly wrong it may stop or not end.
/// \throw InvalidInput for a complex that is not closed, intersects itself, has duplicate vertices
///        or bent facets, or is too small or thin for TetGen, and for other switches; facets are
///        named by their marks
inline void tetrahedralize(tetgenio& plc, tetgenio& mesh, const TetgenOptions& options = {}) {
    std::string switches = options.switches + "Q";
    tetgenbehavior behavior;
    if (options.switches.find_first_not_of("pqaYOSToz0123456789./") != std::string::npos ||
        switches.size() > 500 || !behavior.parse_commandline(switches.data()) ||
        behavior.plc == 0) {
        throw InvalidInput("the switches '" + options.switches +
                           "' do not ask TetGen for a mesh of a complex");
    }
    detail::check_complex(plc);
    try {
        const std::set<int> facets = detail::meeting_facets(plc);
        if (!facets.empty()) {
            std::string text = "the complex intersects itself at the facets";
            for (const int facet : facets) text += " " + std::to_string(facet);
            throw InvalidInput(text);
        }
        detail::with_tetgen([&](tetgenmesh& m) {
            detail::start_tetgen(m, behavior, plc);
            detail::finish_tetgen(m, behavior, mesh);
        });
    } catch (const int code) {
        throw InvalidInput(detail::tetgen_failure(code));
    }
    if (mesh.numberoftetrahedra == 0) {
        throw InvalidInput(
            "nothing lies inside the complex: its facets do not close, or its holes take "
            "everything");
    }
}

}  // namespace nestgrid
