// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An unbalanced grid with all that a solver's adapter may have: a state per task, which some
// operations take and others do not, own keys, hanging nodes, true positions, an epoch.
#pragma once

#include <atomic>

#include "mutant.hpp"

namespace nestgrid_test {

class CurvedGrid : public MutantGrid<3> {
public:
    class Context {
    public:
        explicit Context(const CurvedGrid& grid) : grid_{&grid} {
            ++live;
            ++made;
        }
        Context(const Context&) = delete;
        Context& operator=(const Context&) = delete;
        ~Context() { --live; }

        /// Only the context of the grid itself knows the secret.
        void use(const CurvedGrid& grid) {
            if (grid_ != &grid) throw InvalidInput("a context of another grid");
            ++uses;
        }

        static inline std::atomic<int> live = 0;
        static inline std::atomic<int> made = 0;
        static inline std::atomic<int> uses = 0;

    private:
        const CurvedGrid* grid_;
    };

    explicit CurvedGrid(const Forest<3>& f) : MutantGrid<3>(f) {
        for (const Feature offered : {Feature::own_keys, Feature::dense_keys, Feature::constrained,
                                      Feature::new_positions}) {
            features |= static_cast<unsigned>(offered);
        }
        for (std::size_t n = 0; n < keys.size(); ++n) keys[n] = n;
    }

    Context make_context() const { return Context(*this); }
    const Rule* split(Element e, Context& c) const {
        c.use(*this);
        return MutantGrid<3>::split(e);
    }
    void children(Element e, std::span<Element> out, Context& c) const {
        c.use(*this);
        expect_room(out.size(), forest.cells[e].rule->children.size());
        forest.children(e, out);
    }
    void corner_keys(Element e, std::span<NodeKey> out) const {
        expect_room(out.size(), topology(forest.cells[e].shape).corners);
        MutantGrid<3>::corner_keys(e, out);
    }
    void new_keys(Element e, std::span<NodeKey> out) const {
        expect_room(out.size(), forest.cells[e].rule->new_nodes.size());
        MutantGrid<3>::new_keys(e, out);
    }
    void new_positions(Element e, NodeMask which, std::span<Point> out, Context& c) const {
        c.use(*this);
        const auto& cell = forest.cells[e];
        const std::size_t corners = topology(cell.shape).corners;
        for (std::size_t n = 0; n < out.size(); ++n) {
            const Point& x = positions[cell.nodes[corners + n]];
            const double bend = 0.03 * std::sin(7 * x[0] + 5 * x[1] + 3 * x[2]);
            if ((which >> n & 1U) != 0) out[n] = x + bend * Point{1, -1, 1};
        }
    }
    std::uint64_t epoch() const { return 5; }

private:
    /// Adapters may rely on the length of what they fill.
    static void expect_room(std::size_t given, std::size_t needed) {
        if (given != needed) throw InvalidInput("room for more or less than there is");
    }
};

class CurvedField : public MutantField<3> {
public:
    CurvedField(const CurvedGrid& grid, const std::function<double(const Point&)>& f)
        : MutantField<3>(grid, f), grid_{&grid} {}

    NodeMask new_values(std::uint32_t e, NodeMask which, std::span<double> out,
                        CurvedGrid::Context& c) const {
        c.use(*grid_);
        return MutantField<3>::new_values(e, which, out);
    }

private:
    const CurvedGrid* grid_;
};

}  // namespace nestgrid_test
