// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <high_order/node_preroll.hpp>

#include <algorithm>
#include <limits>

namespace nestgrid::engine {

RealNodes::Preroll::Preroll(RealNodes& nodes, const LeafFunction& function, const BaseWalk& walk,
                            LeafSummary& summary, const Executor& executor)
    : nodes_{&nodes},
      function_{&function},
      walk_{&walk},
      summary_{&summary},
      executor_{&executor},
      records_{function},
      components_{summary.components},
      drawn_{summary.drawn} {
    const auto add = [this](Task* task, std::span<const BaseElement> way) {
        way.back().member->rule == nullptr ? add_leaf(task, way) : add_split(way);
    };
    walk.for_each(add, BaseWalk::Positions::yes);
    records_.end_claims();
    find_records();
    nodes.values_.resize(nodes.nodes_.size() * components_);
    facts_.resize(leaves_.size());
    read_all();
}

std::uint32_t RealNodes::Preroll::number_of(NodeKey key) {
    const auto fresh = static_cast<std::uint32_t>(nodes_->nodes_.size());
    const auto [at, is_new] = nodes_->number_.insert(key, fresh);
    if (is_new) {
        nodes_->nodes_.emplace_back();
        first_.push_back(no_leaf);
    }
    return *at;
}

void RealNodes::Preroll::add_leaf(Task* task, std::span<const BaseElement> way) {
    const BaseElement& e = way.back();
    const auto leaf = static_cast<std::uint32_t>(leaves_.size());
    if (leaf % chunk_size == 0) {
        Chunk& chunk = chunks_.emplace_back();
        for (const BaseElement& on_way : way) chunk.first.push_back(on_way.number);
        chunk.begin = leaf;
        // Elements above this leaf that begin with it were added before it.
        chunk.first_split = splits_.size();
        for (std::size_t i = way.size(); i-- > 1 && way[i].number == 0;) --chunk.first_split;
    }
    records_.claim(*function_, task, way);
    LeafNodes corner{};
    for (std::size_t k = 0; k < e.shape->corners; ++k) {
        corner[k] = number_of(e.key[k]);
        if (first_[corner[k]] == no_leaf) first_[corner[k]] = leaf;
    }
    leaves_.push_back(corner);
}

void RealNodes::Preroll::add_split(std::span<const BaseElement> way) {
    const BaseElement& e = way.back();
    const RedSplitKeys keys = split_keys_of(e.key, *e.member->rule);
    Split split{{}, e.member->rule, static_cast<int>(way.size())};
    for (std::size_t n = 0; n < e.shape->node.size(); ++n) split.node[n] = number_of(keys[n]);
    const double diameter = diameter_of(std::span(e.x).first(e.shape->corners));
    for (const std::uint32_t number : made_by(split)) raise(node(number).size, diameter);
    splits_.push_back(split);
}

/// Finds which chunks need others, the nodes that hang and the parts that nodes halve.
void RealNodes::Preroll::find_records() {
    std::vector<Seen> seen(chunks_.size());
    const auto find = [&](std::size_t i) { seen[i] = find_in(chunks_[i]); };
    const auto take = [&](std::size_t i) {
        for (const OnOwner& on : seen[i].hanging) {
            if (node(on.node).hangs) continue;
            node(on.node).hangs = true;
            chunks_[chunk_of(records_.owner_of(on.part))].hanging.push_back(on);
        }
        for (const OnOwner& on : seen[i].halved) {
            RealNode& made = node(on.node);
            if (made.halves > 0) continue;
            made.shift = static_cast<std::uint8_t>(on.part.shift);
            made.halves = static_cast<std::uint32_t>(nodes_->parts_.size());
            nodes_->parts_.emplace_back(records_.in_owner(on.part));
            chunks_[chunk_of(records_.owner_of(on.part))].halved.push_back(on);
        }
        chunks_[i].complete = std::max(i, seen[i].owners.back());
        for (const std::size_t owner : seen[i].owners) {
            chunks_[owner].needed = std::max(chunks_[owner].needed, chunks_[i].complete);
        }
        seen[i] = {};
    };
    executor_->run(chunks_.size(), find, take);
}

auto RealNodes::Preroll::find_in(const Chunk& chunk) const -> Seen {
    Seen seen;
    RecordSearch search(records_);
    std::size_t leaf = chunk.begin;
    std::size_t split = chunk.first_split;
    const auto needs = [&](std::uint32_t of) {
        const std::size_t owner = chunk_of(of);
        if (owner != seen.owners.back()) seen.owners.push_back(owner);
    };
    seen.owners.push_back(chunk_of(static_cast<std::uint32_t>(leaf)));
    walk_->for_each(
        [&](Task*, std::span<const BaseElement> way) {
            const BaseElement& e = way.back();
            if (e.member->rule != nullptr) {
                find_halved(search, way, splits_[split++], seen);
                return;
            }
            for (std::size_t p = 0; p < e.shape->parts.size(); ++p) {
                needs(search.owner(way, p));
            }
            for (std::size_t k = 0; k < e.shape->corners; ++k) {
                const Place place = e.shape->reference_corner(k);
                const OnRecord on =
                    search.around(way, e.shape->parts.size() + k, std::span(&place, 1));
                if (on.record < 0) continue;
                needs(records_.owner_of(on));
                seen.hanging.push_back({leaves_[leaf][k], on});
            }
            ++leaf;
        },
        chunk.first, size_of(chunk));
    std::sort(seen.owners.begin(), seen.owners.end());
    seen.owners.erase(std::unique(seen.owners.begin(), seen.owners.end()), seen.owners.end());
    return seen;
}

/// A node of a split that halves a part which lies in one of a leaf hangs there, and stops as
/// that part is flat. A triangle has no node: the edges that children have in it, and the faces
/// of leaves, tell.
void RealNodes::Preroll::find_halved(RecordSearch& search, std::span<const BaseElement> way,
                                     const Split& split, Seen& seen) {
    const ShapeParts& shape = *way.back().shape;
    for (std::size_t p = 0; p < shape.parts.size(); ++p) {
        const std::uint8_t n = node_halving(*split.rule, shape.parts[p]);
        if (n == no_new_node) continue;
        const std::array<Place, 4> places = corners_of(shape, shape.parts[p]);
        const OnRecord on = search.around(way, p, std::span(places).first(shape.parts[p].count));
        if (on.record >= 0) seen.halved.push_back({split.node[shape.corners + n], on});
    }
}

/// Reads all chunks in order, and looks at each when it is complete.
void RealNodes::Preroll::read_all() {
    std::vector<std::vector<std::size_t>> completed(chunks_.size());  // by chunk
    std::vector<std::vector<std::size_t>> unneeded(chunks_.size());
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        completed[chunks_[i].complete].push_back(i);
        unneeded[std::max(chunks_[i].needed, i)].push_back(i);
    }
    const std::size_t at_a_time = 4 * executor_->concurrency();
    for (std::size_t begin = 0; begin < chunks_.size(); begin += at_a_time) {
        const std::size_t end = std::min(begin + at_a_time, chunks_.size());
        const auto read_one = [&](std::size_t i) { read(chunks_[begin + i]); };
        executor_->run(end - begin, read_one,
                       [&](std::size_t i) { take_ranges(chunks_[begin + i]); });
        std::vector<std::size_t> ready;
        for (std::size_t i = begin; i < end; ++i) {
            ready.insert(ready.end(), completed[i].begin(), completed[i].end());
        }
        executor_->run(
            ready.size(), [&](std::size_t i) { look_at(chunks_[ready[i]]); }, [](std::size_t) {});
        for (std::size_t i = begin; i < end; ++i) {
            for (const std::size_t chunk : unneeded[i]) chunks_[chunk].nets.reset();
        }
    }
}

/// Takes the polynomials of a chunk, and what nodes need of them.
void RealNodes::Preroll::read(Chunk& chunk) {
    chunk.nets = std::make_unique<NetStore>();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    chunk.ranges.assign(components_, {infinity, -infinity});
    auto leaf = static_cast<std::uint32_t>(chunk.begin);
    walk_->for_each(
        [&](Task* task, std::span<const BaseElement> way) {
            if (way.back().member->rule != nullptr) return;
            records_.read(*function_, task, way, leaf, *chunk.nets);
            const LeafPolynomial& of = records_.leaves()[leaf];
            chunk.greatest_degree = std::max(chunk.greatest_degree, int{of.degree});
            const std::size_t size = net_size(of.degree, of.factors());
            for (std::size_t c = 0; c < components_; ++c) {
                const double* const net = records_.net(of, c);
                const auto [least, greatest] = std::minmax_element(net, net + size);
                Range& range = chunk.ranges[c];
                range = {std::min(range.least, *least), std::max(range.greatest, *greatest)};
            }
            give_corners(leaf++);
        },
        chunk.first, size_of(chunk));
    for (const OnOwner& on : chunk.hanging) {
        records_.values_at(on.part, nodes_->values_.data() + on.node * components_);
    }
    for (const OnOwner& on : chunk.halved) node(on.node).beta = records_.facts_on(on.part).beta;
}

/// A corner inside a larger leaf's part has the value of the record, any other that of the
/// first leaf that has it.
void RealNodes::Preroll::give_corners(std::uint32_t leaf) {
    const LeafPolynomial& of = records_.leaves()[leaf];
    for (std::size_t k = of.parts().corners; k-- > 0;) {
        const std::uint32_t number = leaves_[leaf][k];
        if (first_[number] != leaf || node(number).hangs) continue;
        for (std::size_t c = 0; c < components_; ++c) {
            nodes_->values_[number * components_ + c] = corner_value(of, k, c);
        }
    }
}

void RealNodes::Preroll::take_ranges(const Chunk& chunk) {
    summary_->greatest_degree = std::max(summary_->greatest_degree, chunk.greatest_degree);
    for (std::size_t c = 0; c < components_; ++c) {
        summary_->least[c] = std::min(summary_->least[c], chunk.ranges[c].least);
        summary_->greatest[c] = std::max(summary_->greatest[c], chunk.ranges[c].greatest);
    }
}

/// Looks at the leaves of a chunk and their records.
void RealNodes::Preroll::look_at(const Chunk& chunk) {
    RecordSearch search(records_);
    auto leaf = static_cast<std::uint32_t>(chunk.begin);
    walk_->for_each(
        [&](Task*, std::span<const BaseElement> way) {
            if (way.back().member->rule == nullptr) look_at(search, way, leaf++);
        },
        chunk.first, size_of(chunk));
}

void RealNodes::Preroll::look_at(RecordSearch& search, std::span<const BaseElement> way,
                                 std::uint32_t leaf) {
    const LeafPolynomial& of = records_.leaves()[leaf];
    const ShapeParts& shape = of.parts();
    const NetFacts own = records_.facts_of(of);
    LeafFacts facts{own.beta, own.beta, own.least, own.greatest, of.jump};
    for (std::size_t p = 0; p < shape.parts.size(); ++p) {
        if (records_.coincides(of, way.back(), p, search.whole(way, p))) continue;
        const std::array<Place, 4> corners = corners_of(shape, shape.parts[p]);
        const OnRecord on = search.around(way, p, std::span(corners).first(shape.parts[p].count));
        const PartFacts there = records_.compared(of, p, on);
        facts.flatness = std::max(facts.flatness, there.record.beta);
        facts.least = std::min(facts.least, there.record.least);
        facts.greatest = std::max(facts.greatest, there.record.greatest);
        facts.jump = std::max(facts.jump, detail::float_above(there.jump));
    }
    double jump = 0;
    for (std::size_t k = 0; k < shape.corners; ++k) {
        jump = std::max(jump, norm_of(drawn_, [&](std::size_t c) {
                            return corner_value(of, k, c) - value(leaves_[leaf][k], c);
                        }));
    }
    facts.corner_jump = jump;
    facts_[leaf] = facts;
}

}  // namespace nestgrid::engine
