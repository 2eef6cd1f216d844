// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <height_fields/edge_nodes.hpp>

#include <algorithm>
#include <limits>
#include <tuple>

#include <nestgrid/error.hpp>
#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

void EdgeNodes::begin(std::size_t components) {
    components_ = components;
    nodes_.clear();
    values_.clear();
    range_.clear();
}

void EdgeNodes::add(EdgeNode node, std::span<const double> values) {
    if (nodes_.size() == std::numeric_limits<std::uint32_t>::max()) {
        throw GridError("2^32 nodes or more hang on edges of the adaptive grid");
    }
    node.values = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node);
    values_.insert(values_.end(), values.begin(), values.end());
}

void EdgeNodes::append(const EdgeNodes& task) {
    for (const EdgeNode& node : task.nodes_) add(node, task.values(node));
}

void EdgeNodes::exchange(const SharedNodes& shared) {
    Outbox box(shared.ranks().size());
    for (const EdgeNode& node : nodes_) {
        shared.route(std::array{node.edge.low, node.edge.high}, box, [&](Bytes& out, int) {
            put(out, node);
            for (const double value : values(node)) put(out, value);
        });
    }
    std::vector<double> at(components_);
    shared.send(box, [&](int, Reader& in) {
        while (in.more()) {
            const auto node = in.get<EdgeNode>();
            for (double& value : at) value = in.get<double>();
            add(node, at);
        }
    });
}

void EdgeNodes::finish() {
    const auto order = [](const EdgeNode& node) {
        return std::tuple(node.edge.low, node.edge.high, node.place, node.key, node.values);
    };
    std::ranges::sort(nodes_, {}, order);
    const auto same = [](const EdgeNode& a, const EdgeNode& b) {
        return a.edge == b.edge && a.key == b.key;
    };
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end(), same), nodes_.end());
    range_.reserve(nodes_.size());
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        ++range_.insert(nodes_[i].edge, {i, 0}).first->count;
    }
}

std::span<const EdgeNode> EdgeNodes::between(const KeyPair& edge,
                                             const std::array<double, 2>& places) const {
    const Range* const range = range_.find(edge);
    if (range == nullptr) return {};
    const auto on = std::span(nodes_).subspan(range->first, range->count);
    const auto [least, greatest] = std::minmax(places[0], places[1]);
    const auto first = std::ranges::upper_bound(on, least, {}, &EdgeNode::place) - on.begin();
    const auto end = std::ranges::lower_bound(on, greatest, {}, &EdgeNode::place) - on.begin();
    return on.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first));
}

std::size_t EdgeNodes::memory_bytes() const {
    return nodes_.capacity() * sizeof(EdgeNode) + values_.capacity() * sizeof(double) +
           range_.memory_bytes();
}

}  // namespace nestgrid::engine
