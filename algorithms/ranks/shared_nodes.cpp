// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/shared_nodes.hpp>

#include <string>

#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

namespace {

/// The nodes that ranks sent to this one, which is their home and tells who else has them.
class Home {
public:
    void add(int rank, const SharedNodes::Candidate& node) {
        const auto [at, is_new] =
            number_.insert(node.name, static_cast<std::uint32_t>(nodes_.size()));
        if (is_new) nodes_.push_back({node, {}});
        Node& known = nodes_[*at];
        const bool two_keys = known.node.key != node.key;
        if ((two_keys || known.node.place != node.place) && conflict_.empty()) {
            conflict_ = "ranks " + std::to_string(known.ranks.front()) + " and " +
                        std::to_string(rank) + " have a node " +
                        (two_keys ? "under two keys" : "at two places under one key") +
                        ": own keys of a distributed grid, and its positions of nodes, must be the "
                        "same on all ranks";
        }
        known.ranks.push_back(rank);
    }
    /// \throw GridError where a node has two keys or two places
    void check() const {
        if (!conflict_.empty()) throw GridError(conflict_);
    }
    /// Writes to each rank its shared nodes, with the others that have them, or common ones to all.
    void answer(Outbox& box, std::size_t most_sharers) const {
        for (const auto& [node, ranks] : nodes_) {
            if (ranks.size() < 2) continue;
            if (ranks.size() > most_sharers) {
                put(box.to_all(), node.key);
                continue;
            }
            for (const int to : ranks) {
                put(box.to(to), node.key);
                put(box.to(to), static_cast<std::uint32_t>(ranks.size() - 1));
                for (const int other : ranks) {
                    if (other != to) put(box.to(to), other);
                }
            }
        }
    }

private:
    struct Node {
        SharedNodes::Candidate node;
        std::vector<int> ranks;  // in order, as messages come in the order of ranks
    };
    std::vector<Node> nodes_;
    KeyTable<NodeKey, std::uint32_t> number_;
    std::string conflict_;
};

}  // namespace

void SharedNodes::find(std::span<const Candidate> candidates, std::size_t most_sharers,
                       bool compared) {
    const int size = ranks_->size();
    const bool places = compared && std::any_of(candidates.begin(), candidates.end(),
                                                [](const auto& node) { return node.place != 0; });
    Outbox question(size);
    for (const Candidate& node : candidates) {
        const std::uint64_t home = hash(node.name + 1) % static_cast<std::uint64_t>(size);
        Bytes& out = question.to(static_cast<int>(home));
        if (out.empty()) put(out, static_cast<std::uint8_t>(places));
        put(out, node.name);
        if (!compared) continue;
        put(out, node.key);
        if (places) put(out, node.place);
    }
    Home home;
    question.send(*ranks_, [&](int rank, Reader& in) {
        const bool with_places = in.get<std::uint8_t>() != 0;
        while (in.more()) {
            const auto name = in.get<NodeKey>();
            Candidate node{name, name, 0};
            if (compared) node.key = in.get<NodeKey>();
            if (with_places) node.place = in.get<std::uint64_t>();
            home.add(rank, node);
        }
    });
    together(this, "shared nodes", [&] { home.check(); });
    Outbox answer(size);
    home.answer(answer, most_sharers);
    for (const Bytes& announced : ranks_->gather(std::move(answer.to_all()))) {
        for (Reader in(announced); in.more();) common_.push_back(in.get<NodeKey>());
    }
    std::vector<std::pair<NodeKey, std::vector<int>>> found;
    answer.send(*ranks_, [&](int, Reader& in) {
        while (in.more()) {
            auto& [node, sharers] = found.emplace_back();
            node = in.get<NodeKey>();
            sharers.resize(in.get<std::uint32_t>());
            for (int& rank : sharers) rank = in.get<int>();
        }
    });
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    with_.resize(static_cast<std::size_t>(size));
    for (auto& [node, sharers] : found) keep(node, std::move(sharers));
    keep_common(candidates);
}

void SharedNodes::keep(NodeKey node, std::vector<int> sharers) {
    const auto number = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(node);
    index_.insert(node, number);
    for (const int rank : sharers) with_[static_cast<std::size_t>(rank)].push_back(number);
    sharers_.push_back(std::move(sharers));
}

void SharedNodes::keep_common(std::span<const Candidate> candidates) {
    std::sort(common_.begin(), common_.end());
    struct Here {};
    KeyTable<NodeKey, Here> own(candidates.size());
    for (const Candidate& node : candidates) own.insert(node.key, {});
    for (const NodeKey node : common_) {
        common_here_.push_back(own.find(node) != nullptr);
        if (!common_here_.back()) continue;
        index_.insert(node, static_cast<std::uint32_t>(keys_.size()));
    }
}

void SharedNodes::set_hanging(HangingNodes hanging) {
    hanging_ = std::move(hanging);
    std::uint64_t any = hanging_.size() > 0 ? 1 : 0;
    ranks_->reduce(std::span(&any, 1), Ranks::Reduction::max);
    any_hangs_ = any != 0;
}

}  // namespace nestgrid::engine
