// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A grid and a field that have exactly what is required, and nothing else: one triangle, cut once.
#pragma once

#include <nestgrid/grid.hpp>
#include <nestgrid/standard_rules.hpp>

namespace nestgrid_test {

class ArchetypeGrid {
public:
    struct Element {
        int level = 0;
        bool operator==(const Element&) const = delete;
    };
    static constexpr int dimension = 2;

    std::size_t coarse_count() const { return 1; }
    nestgrid::CoarseElement<Element> coarse(std::size_t) const {
        nestgrid::CoarseElement<Element> c;
        c.shape = nestgrid::Shape::triangle;
        c.corners = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
        c.ids = {5, 6, 7};
        return c;
    }
    const nestgrid::Rule* split(const Element& e) const {
        return e.level == 0 ? &nestgrid::bisection_rule(nestgrid::Shape::triangle, 2) : nullptr;
    }
    void children(const Element& e, std::span<Element> out) const {
        for (Element& child : out) child.level = e.level + 1;
    }
};

class ArchetypeField {
public:
    using value_type = float;

    nestgrid::NodeMask coarse_values(std::size_t, std::span<float> out) const {
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = static_cast<float>(k);
        return 0;
    }
    nestgrid::NodeMask new_values(const ArchetypeGrid::Element&, nestgrid::NodeMask,
                                  std::span<float> out) const {
        out[0] = 4;
        return 0;
    }
};

static_assert(nestgrid::NestedGrid<ArchetypeGrid>);
static_assert(nestgrid::NodalField<ArchetypeField, ArchetypeGrid>);

}  // namespace nestgrid_test
