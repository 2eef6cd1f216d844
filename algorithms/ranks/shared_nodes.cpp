// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/shared_nodes.hpp>

#include <string>

#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

namespace {

/// What a rank says of a node to the rank that collects who has it, the home of its name.
struct Asked {
    NodeKey name;
    std::uint32_t key = 0;  ///< a hash, as are places: compared, and needed for nothing else
    std::uint32_t place = 0;
};
std::uint32_t short_hash(std::uint64_t hash) { return static_cast<std::uint32_t>(hash >> 32U); }

/// The nodes that ranks sent to this one, which is their home and tells who else has them.
class Home {
public:
    /// \param number of the node among those that the rank sent to this home
    void add(int rank, std::uint32_t number, const Asked& node) {
        const auto [at, is_new] =
            number_.insert(node.name, static_cast<std::uint32_t>(nodes_.size()));
        if (is_new) nodes_.push_back({node, {}});
        Node& known = nodes_[*at];
        const bool two_keys = known.node.key != node.key;
        if ((two_keys || known.node.place != node.place) && conflict_.empty()) {
            conflict_ = "ranks " + std::to_string(known.ranks.front().rank) + " and " +
                        std::to_string(rank) + " have a node " +
                        (two_keys ? "under two keys" : "at two places under one key") +
                        ": own keys of a distributed grid, and its positions of nodes, must be the "
                        "same on all ranks";
        }
        known.ranks.push_back({rank, number});
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
                put(box.to_all(), node.name);
                continue;
            }
            for (const auto& [to, number] : ranks) {
                put(box.to(to), number);
                put(box.to(to), static_cast<std::uint32_t>(ranks.size() - 1));
                for (const auto& [other, unused] : ranks) {
                    if (other != to) put(box.to(to), other);
                }
            }
        }
    }

private:
    struct Has {
        int rank;
        std::uint32_t number;
    };
    struct Node {
        Asked node;
        std::vector<Has> ranks;  // in order, as messages come in the order of ranks
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
    std::vector<std::vector<NodeKey>> asked(static_cast<std::size_t>(size));  // of each home
    for (const Candidate& node : candidates) {
        const auto home = static_cast<int>(hash(node.name + 1) % static_cast<std::uint64_t>(size));
        asked[static_cast<std::size_t>(home)].push_back(node.key);
        Bytes& out = question.to(home);
        if (out.empty()) put(out, static_cast<std::uint8_t>(places));
        put(out, node.name);
        if (compared) put(out, short_hash(hash(node.key)));
        if (places) put(out, short_hash(node.place));
    }
    Home home;
    question.send(*ranks_, [&](int rank, Reader& in) {
        const bool with_places = in.get<std::uint8_t>() != 0;
        for (std::uint32_t number = 0; in.more(); ++number) {
            Asked node{in.get<NodeKey>()};
            if (compared) node.key = in.get<std::uint32_t>();
            if (with_places) node.place = in.get<std::uint32_t>();
            home.add(rank, number, node);
        }
    });
    together(this, "shared nodes", [&] { home.check(); });
    Outbox answer(size);
    home.answer(answer, most_sharers);
    std::vector<NodeKey> common;
    for (const Bytes& announced : ranks_->gather(std::move(answer.to_all()))) {
        for (Reader in(announced); in.more();) common.push_back(in.get<NodeKey>());
    }
    std::vector<std::pair<NodeKey, std::vector<int>>> found;
    answer.send(*ranks_, [&](int from, Reader& in) {
        while (in.more()) {
            auto& [node, sharers] = found.emplace_back();
            node = asked[static_cast<std::size_t>(from)][in.get<std::uint32_t>()];
            sharers.resize(in.get<std::uint32_t>());
            for (int& rank : sharers) rank = in.get<int>();
        }
    });
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    with_.resize(static_cast<std::size_t>(size));
    for (auto& [node, sharers] : found) keep(node, std::move(sharers));
    keep_common(std::move(common), candidates);
}

void SharedNodes::keep(NodeKey node, std::vector<int> sharers) {
    const auto number = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(node);
    index_.insert(node, number);
    for (const int rank : sharers) with_[static_cast<std::size_t>(rank)].push_back(number);
    sharers_.push_back(std::move(sharers));
}

void SharedNodes::keep_common(std::vector<NodeKey> names, std::span<const Candidate> candidates) {
    std::sort(names.begin(), names.end());
    KeyTable<NodeKey, NodeKey> own(candidates.size());
    for (const Candidate& node : candidates) own.insert(node.name, node.key);
    for (const NodeKey name : names) {
        const NodeKey* const key = own.find(name);
        const auto number = static_cast<std::uint32_t>(keys_.size() + common_.size());
        if (key != nullptr) index_.insert(*key, number);
        common_here_.push_back(key != nullptr);
        common_.push_back(key == nullptr ? NodeKey{} : *key);
    }
}

std::uint32_t SharedNodes::number_with(int rank, NodeKey node) const {
    const std::uint32_t number = *index_.find(node);
    if (number >= keys_.size()) return ~static_cast<std::uint32_t>(number - keys_.size());
    const std::vector<std::uint32_t>& with = with_[static_cast<std::size_t>(rank)];
    const auto at = std::lower_bound(with.begin(), with.end(), number);
    return static_cast<std::uint32_t>(at - with.begin());
}

const NodeKey* SharedNodes::node_with(int rank, std::uint32_t number) const {
    if (~number >= common_.size()) return &keys_[with_[static_cast<std::size_t>(rank)][number]];
    return common(~number);
}

void SharedNodes::set_hanging(HangingNodes hanging) {
    hanging_ = std::move(hanging);
    std::uint64_t any = hanging_.size() > 0 ? 1 : 0;
    ranks_->reduce(std::span(&any, 1), Ranks::Reduction::max);
    any_hangs_ = any != 0;
}

}  // namespace nestgrid::engine
