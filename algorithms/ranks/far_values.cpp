// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/far_values.hpp>

#include <cmath>
#include <cstring>
#include <string>

#include <nestgrid/algorithms/distributed.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>
#include <walk/for_each_element.hpp>

namespace nestgrid::engine {

namespace {

/// The values at shared nodes: first this rank's, then those of the least rank that has any.
class SharedValues {
public:
    SharedValues(const SharedNodes& shared, std::size_t components)
        : shared_{&shared}, components_{components} {}

    /// Takes what the field says at nodes that are shared and do not hang.
    template <class Real>
    void add(std::span<const NodeKey> nodes, NodeMask which, NodeMask missing, const Real* values) {
        for (; which != 0; which &= which - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(which));
            const bool there = (missing >> n & 1U) == 0;
            if (!there) missed_.push_back(nodes[n]);
            const auto [known, is_new] = known_.insert(nodes[n], {values_.size(), none_});
            if (is_new) values_.resize(values_.size() + components_);
            if (!there || known->from != none_) continue;
            known->from = shared_->ranks().rank();
            for (std::size_t c = 0; c < components_; ++c) {
                values_[known->first + c] = static_cast<double>(values[n * components_ + c]);
            }
        }
    }
    NodeMask wanted(std::span<const NodeKey> nodes) const {
        NodeMask which = 0;
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const bool wants =
                shared_->is_shared(nodes[n]) && !shared_->hanging().contains(nodes[n]);
            which |= NodeMask{wants} << n;
        }
        return which;
    }

    /// Collective. \throw InvalidInput on all ranks where two have different values at a node
    void agree() {
        const SharedValues own = *this;
        shared_->tell_sharers([&](Bytes& out, NodeKey node) { own.write(out, node); },
                              [&](int rank, NodeKey node, Reader& in) {
                                  if (in.get<std::uint8_t>() != 0) take(rank, node, read(in), own);
                              });
        if (shared_->common_count() > 0) agree_on_common(own);
        refuse_differences();
    }
    void put_missed(FarValues& far) const {
        for (const NodeKey node : missed_) {
            const Known& known = *known_.find(node);
            if (known.from != none_) far.add(node, of(known));
        }
    }

private:
    struct Known {
        std::size_t first;  // in values_
        int from;           // the rank
    };
    static constexpr int none_ = -1;

    std::span<const double> of(const Known& known) const {
        return std::span(values_).subspan(known.first, components_);
    }
    void write(Bytes& out, NodeKey node) const {
        const Known* const known = known_.find(node);
        const bool there = known != nullptr && known->from != none_;
        put(out, std::uint8_t{there});
        for (std::size_t c = 0; there && c < components_; ++c) put(out, of(*known)[c]);
    }
    std::vector<double> read(Reader& in) const {
        std::vector<double> values(components_);
        for (double& value : values) value = in.get<double>();
        return values;
    }
    /// Takes the value that another rank has at a node.
    void take(int rank, NodeKey node, const std::vector<double>& values, const SharedValues& own) {
        Known* const known = known_.find(node);
        if (known == nullptr) return;  // it hangs, or nobody asks for it here
        const Known& mine = *own.known_.find(node);
        if (mine.from != none_) compare(rank, values, own.of(mine));
        if (known->from != none_ && known->from < rank) return;
        known->from = rank;
        std::copy(values.begin(), values.end(),
                  values_.begin() + static_cast<std::ptrdiff_t>(known->first));
    }
    /// Counts a node at which another rank has other values.
    void compare(int rank, std::span<const double> theirs, std::span<const double> mine) {
        if (std::memcmp(theirs.data(), mine.data(), theirs.size_bytes()) == 0) return;
        const int here = shared_->ranks().rank();
        if (rank > here) return;  // that rank counts it
        ++different_;
        other_ = rank;
        for (std::size_t c = 0; c < components_; ++c) {
            const double off = std::abs(theirs[c] - mine[c]);
            if (off > farthest_) farthest_ = off;
        }
    }
    void agree_on_common(const SharedValues& own) {
        Bytes told;
        for (std::size_t i = 0; i < shared_->common_count(); ++i) {
            const NodeKey* const node = shared_->common(i);
            const Known* const known = node == nullptr ? nullptr : own.known_.find(*node);
            if (known == nullptr || known->from == none_) continue;
            put(told, static_cast<std::uint32_t>(i));
            for (std::size_t c = 0; c < components_; ++c) put(told, own.of(*known)[c]);
        }
        const std::vector<Bytes> all = shared_->ranks().gather(std::move(told));
        for (int rank = 0; rank < shared_->ranks().size(); ++rank) {
            if (rank == shared_->ranks().rank()) continue;
            for (Reader in(all[static_cast<std::size_t>(rank)]); in.more();) {
                const NodeKey* const node = shared_->common(in.get<std::uint32_t>());
                const std::vector<double> values = read(in);
                if (node != nullptr) take(rank, *node, values, own);
            }
        }
    }
    void refuse_differences() {
        std::array<std::uint64_t, 1> count{different_};
        Ranks& ranks = shared_->ranks();
        ranks.reduce(count, Ranks::Reduction::sum);
        if (count[0] == 0) return;
        std::array<double*, 1> farthest{&farthest_};
        take_greatest(ranks, farthest);
        Outcome outcome;
        if (different_ > 0) {
            outcome.kind = Outcome::Kind::invalid_input;
            outcome.sentence = "its field differs from that of rank " + std::to_string(other_) +
                               " at a node that both have, one of " + std::to_string(count[0]) +
                               " such copies, which differ by up to " + all_digits(farthest_) +
                               ": were the values beside other ranks (ghost values) updated?";
        }
        settle(ranks, "values at shared nodes", outcome);
    }

    const SharedNodes* shared_;
    std::size_t components_;
    KeyTable<NodeKey, Known> known_;
    std::vector<double> values_;
    std::vector<NodeKey> missed_;
    std::uint64_t different_ = 0;
    int other_ = 0;
    double farthest_ = 0;
};

/// Asks the field at all shared nodes that do not hang, in every element that makes them.
template <class Real>
void collect(const Hierarchy<Real>& field, SharedValues& values) {
    const Walk<Real> walk(field, {.values = false, .keys = true, .on_ranks = true});
    const auto components = static_cast<std::size_t>(field.facts().components);
    std::array<NodeKey, max_corners> keys;
    std::vector<Real> at;
    for_each_element(walk, true, [&](const ElementView<Real>& view, const Split& split) {
        const std::size_t corners = view.corner_count();
        Task* const task = view.stack->task.get();
        at.resize((corners + split.keys.size()) * components);
        if (view.level == 0) {
            walk.corners(view, keys.data(), nullptr);
            const std::span<const NodeKey> nodes = std::span(keys).first(corners);
            const NodeMask missing = field.coarse_values(task, view.coarse, corners, at.data());
            values.add(nodes, values.wanted(nodes), missing, at.data());
        }
        const NodeMask which = values.wanted(split.keys);
        if (which == 0) return;
        const NodeMask missing =
            field.new_values(task, view.element(), *split.rule, which, at.data());
        values.add(split.keys, which, missing, at.data() + corners * components);
    });
}

template <class Real>
std::shared_ptr<const FarValues> share_values(const Hierarchy<Real>& field) {
    const SharedNodes* const shared = field.facts().shared;
    const auto components = static_cast<std::size_t>(field.facts().components);
    SharedValues values(*shared, components);
    const auto asked = [&] {
        return "values of a field of " + std::to_string(components) + " components of " +
               std::to_string(sizeof(Real)) + " bytes";
    };
    together(shared, asked, [&] {
        require_same_state(field);
        if (field.facts().decodes) refuse_on_ranks("a compressed field");
        if (shared->count() > 0) collect(field, values);
    });
    values.agree();
    const auto far = std::make_shared<FarValues>(components);
    values.put_missed(*far);
    return far;
}

}  // namespace

}  // namespace nestgrid::engine

namespace nestgrid::detail {

std::shared_ptr<const engine::FarValues> share_values(const Hierarchy<float>& field) {
    return engine::share_values(field);
}
std::shared_ptr<const engine::FarValues> share_values(const Hierarchy<double>& field) {
    return engine::share_values(field);
}

}  // namespace nestgrid::detail
