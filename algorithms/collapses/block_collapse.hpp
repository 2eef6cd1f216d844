// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Collapses edges of one block, the cheapest first, as long as any is allowed.
#pragma once

#include <queue>

#include <boost/container/static_vector.hpp>

#include <collapses/collapse_checks.hpp>

namespace nestgrid::engine {

class BlockCollapse {
public:
    /// All arguments are borrowed.
    BlockCollapse(BlockMesh& mesh, const CollapseRules& rules, const Box& region)
        : mesh_{&mesh}, checks_{mesh, rules, region}, version_(mesh.vertices.size(), 0) {}

    void run();
    const Collapsed& counts() const { return counts_; }

private:
    /// An edge, and what its ends were when it was looked at.
    struct Entry {
        double cost;
        std::uint32_t u;
        std::uint32_t v;
        std::uint32_t stamp;

        bool operator<(const Entry& other) const {
            if (cost != other.cost) return cost > other.cost;
            return u != other.u ? u > other.u : v > other.v;
        }
    };
    /// Places for the point that an edge becomes, in the order in which they are tried.
    using Places = boost::container::static_vector<CollapsePlace, 4>;

    void push(std::uint32_t a, std::uint32_t b);
    /// \return the cost of the first place, too
    std::pair<Places, double> places(std::uint32_t u, std::uint32_t v) const;
    void attempt(std::uint32_t u, std::uint32_t v);

    BlockMesh* mesh_;
    CollapseChecks checks_;
    std::priority_queue<Entry> edges_;
    std::vector<std::uint32_t> version_;  // by vertex: how often its star has changed
    BlockMesh::Star star_;
    Collapsed counts_;
};

}  // namespace nestgrid::engine
