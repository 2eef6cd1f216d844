// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The ranks of a C code, and the part of a grid and a field that one of them has.
#pragma once

#include <memory>
#include <variant>

#include <nestgrid/algorithms/ranks.h>
#include <nestgrid/nestgrid.h>
#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/ranks.hpp>

namespace nestgrid {

/// Ranks by the functions of a C code, whose table is copied.
class RanksInC final : public Ranks {
public:
    /// \throw InvalidInput where a function is missing, or the rank is none of those
    explicit RanksInC(const nestgrid_ranks& given);

    int rank() const override { return table_.rank; }
    int size() const override { return table_.count; }
    // These throw an IoError with the sentence of the C code where its function fails.
    std::vector<Message> exchange(std::vector<Message> to) override;
    std::vector<Bytes> gather(Bytes own) override;
    void reduce(std::span<std::uint64_t> numbers, Reduction how) override;

private:
    void require(int code, const char* operation) const;
    Message message_of(const nestgrid_message& from, const char* operation) const;

    nestgrid_ranks table_{};
};

/// The ranks, the nodes that they share, and the values at these that the field lacks here.
class PartOnRanks {
public:
    /// Collective.
    /// \param grid of the field, whose table is copied
    ///
    /// \throw InvalidInput or GridError as Distributed and DistributedField do
    PartOnRanks(const nestgrid_ranks& ranks, const nestgrid_grid& grid, const FieldOnGrid& field);

    /// The field as ranks draw it. Each call of C may hand in another hierarchy of the same field.
    FieldOnGrid on_ranks(const FieldOnGrid& field) const;
    const engine::SharedNodes& shared() const { return *shared_; }

private:
    RanksInC ranks_;
    std::shared_ptr<const engine::SharedNodes> shared_;
    std::shared_ptr<const engine::FarValues> far_;
};

}  // namespace nestgrid
