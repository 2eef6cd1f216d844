// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ranks_in_c.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/detail/forwarding_hierarchy.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/table.hpp>

namespace nestgrid {

namespace {

static_assert(int{NESTGRID_MAX} == static_cast<int>(Ranks::Reduction::max) &&
              int{NESTGRID_MIN} == static_cast<int>(Ranks::Reduction::min) &&
              int{NESTGRID_SUM} == static_cast<int>(Ranks::Reduction::sum));

/// A hierarchy that knows what its process shares with others.
template <class Real>
class OnRanks final : public detail::ForwardingHierarchy<Real> {
public:
    OnRanks(const Hierarchy<Real>& inner, const engine::SharedNodes* shared,
            const engine::FarValues* far)
        : detail::ForwardingHierarchy<Real>(inner, with(inner.facts(), shared, far)) {}

private:
    static HierarchyFacts with(HierarchyFacts facts, const engine::SharedNodes* shared,
                               const engine::FarValues* far) {
        facts.shared = shared;
        facts.far_values = far;
        facts.drop_promises_of_whole_grids();
        return facts;
    }
};

FieldOnGrid share(const FieldOnGrid& field, const engine::SharedNodes* shared,
                  const engine::FarValues* far) {
    return field.visit([&]<class Real>(const Hierarchy<Real>& each) {
        return FieldOnGrid(std::shared_ptr<const Hierarchy<Real>>(
            std::make_shared<OnRanks<Real>>(each, shared, far)));
    });
}

std::vector<std::byte> copied(const void* bytes, std::size_t size) {
    const auto* const begin = static_cast<const std::byte*>(bytes);
    return {begin, begin + size};
}

}  // namespace

RanksInC::RanksInC(const nestgrid_ranks& given) {
    if (given.size < offsetof(nestgrid_ranks, last_error)) {
        throw InvalidInput("the table of the ranks is too small: its size says " +
                           std::to_string(given.size) + " bytes");
    }
    std::memcpy(&table_, &given, std::min(given.size, sizeof(table_)));
    const char* lacks = table_.exchange == nullptr ? "exchange"
                        : table_.gather == nullptr ? "gather"
                        : table_.reduce == nullptr ? "reduce"
                                                   : nullptr;
    if (lacks != nullptr) {
        throw InvalidInput("the table of the ranks lacks the function '" + std::string(lacks) +
                           "'");
    }
    if (table_.count < 1 || table_.rank < 0 || table_.rank >= table_.count) {
        throw InvalidInput("rank " + std::to_string(table_.rank) + " is none of " +
                           std::to_string(table_.count) + " ranks");
    }
}

void RanksInC::require(int code, const char* operation) const {
    if (code == 0) return;
    const char* const why = table_.last_error == nullptr ? nullptr : table_.last_error(table_.self);
    throw IoError("the operation '" + std::string(operation) + "' of rank " +
                  std::to_string(table_.rank) + " failed with code " + std::to_string(code) +
                  (why == nullptr ? "" : ": " + std::string(why)));
}

Ranks::Message RanksInC::message_of(const nestgrid_message& from, const char* operation) const {
    if (from.rank < 0 || from.rank >= table_.count || (from.size > 0 && from.bytes == nullptr)) {
        throw IoError("the operation '" + std::string(operation) + "' of rank " +
                      std::to_string(table_.rank) + " received no bytes, or of rank " +
                      std::to_string(from.rank) + " of " + std::to_string(table_.count));
    }
    return {from.rank, copied(from.bytes, from.size)};
}

std::vector<Ranks::Message> RanksInC::exchange(std::vector<Message> to) {
    std::vector<nestgrid_message> sent;
    for (const Message& m : to) sent.push_back({m.rank, m.bytes.size(), m.bytes.data()});
    std::size_t count = 0;
    const nestgrid_message* from = nullptr;
    require(table_.exchange(table_.self, sent.size(), sent.data(), &count, &from), "exchange");
    std::vector<Message> received;
    for (std::size_t i = 0; i < count; ++i) {
        if (from[i].size > 0) received.push_back(message_of(from[i], "exchange"));
    }
    std::sort(received.begin(), received.end(),
              [](const Message& a, const Message& b) { return a.rank < b.rank; });
    return received;
}

std::vector<Ranks::Bytes> RanksInC::gather(Bytes own) {
    const nestgrid_message* from = nullptr;
    require(table_.gather(table_.self, own.size(), own.data(), &from), "gather");
    std::vector<Bytes> all;
    for (int r = 0; r < table_.count; ++r) all.push_back(message_of(from[r], "gather").bytes);
    return all;
}

void RanksInC::reduce(std::span<std::uint64_t> numbers, Reduction how) {
    require(table_.reduce(table_.self, numbers.size(), numbers.data(), static_cast<int>(how)),
            "reduce");
}

PartOnRanks::PartOnRanks(const nestgrid_ranks& ranks, const nestgrid_grid& grid,
                         const FieldOnGrid& field)
    : ranks_(ranks) {
    constexpr std::size_t most_sharers = 24;  // as Distributed has it
    shared_ = detail::share_nodes(*open_table(grid), ranks_, most_sharers);
    far_ = share(field, shared_.get(), nullptr).visit([](const auto& each) {
        return detail::share_values(each);
    });
}

FieldOnGrid PartOnRanks::on_ranks(const FieldOnGrid& field) const {
    return share(field, shared_.get(), far_.get());
}

}  // namespace nestgrid
