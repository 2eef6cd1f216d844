// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Exact sums over the components of a surface in pieces.
#pragma once

#include <nestgrid/algorithms/join_pieces.hpp>
#include <ranks/wire.hpp>
#include <surfaces/triangle_terms.hpp>

namespace nestgrid::engine {

/// A term of a measure of a component, or what one rank knows of it.
struct ComponentTerm {
    std::uint64_t component;
    std::uint64_t number;
    double part;
    std::size_t term() const { return static_cast<std::size_t>(number); }
    auto key() const { return std::pair(component, number); }
};

/// Adds up terms of the triangles of all ranks, each component at a home.
/// \param terms terms(triangle, out), of the piece
/// \return on all ranks the terms of each component and, at last, of all
template <class Terms>
std::vector<double> sum_up(Ranks& ranks, const JoinedPiece& joined, std::size_t term_count,
                           const Terms& terms) {
    Outbox box(ranks.size());
    sum_by_component<std::uint64_t>(
        joined.component_of, term_count, terms,
        [&](std::uint64_t component, std::size_t term, ExactSum& sum) {
            const auto home = component % static_cast<std::uint64_t>(ranks.size());
            sum.for_each_part([&](double part) {
                put(box.to(static_cast<int>(home)), ComponentTerm{component, term, part});
            });
        });
    std::vector<ComponentTerm> parts;
    box.send(ranks, [&](int, Reader& in) {
        while (in.more()) parts.push_back(in.get<ComponentTerm>());
    });
    std::ranges::sort(parts, {}, &ComponentTerm::key);
    std::vector<ExactSum> total(term_count);
    Bytes told;
    for (std::size_t i = 0; i < parts.size();) {
        ExactSum sum;
        const std::size_t first = i;
        for (; i < parts.size() && parts[i].key() == parts[first].key(); ++i) {
            sum.add(parts[i].part);
            total[parts[i].term()].add(parts[i].part);
        }
        put(told, ComponentTerm{parts[first].component, parts[first].number, sum.value()});
    }
    for (std::size_t term = 0; term < term_count; ++term) {
        total[term].for_each_part([&](double part) {
            put(told, ComponentTerm{joined.components, term, part});
        });
    }
    const auto components = static_cast<std::size_t>(joined.components);
    std::vector<double> result((components + 1) * term_count, 0.0);
    std::vector<ExactSum> of_all(term_count);
    for (const Bytes& of_rank : ranks.gather(std::move(told))) {
        for (Reader in(of_rank); in.more();) {
            const auto term = in.get<ComponentTerm>();
            const auto component = static_cast<std::size_t>(term.component);
            if (component == components) {
                of_all[term.term()].add(term.part);
            } else {
                result[component * term_count + term.term()] = term.part;
            }
        }
    }
    for (std::size_t term = 0; term < term_count; ++term) {
        result[components * term_count + term] = of_all[term].value();
    }
    return result;
}

}  // namespace nestgrid::engine
