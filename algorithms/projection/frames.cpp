// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/frames.hpp>

#include <algorithm>
#include <limits>

#include <nestgrid/algorithms/holes.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

using HiddenPointer = std::shared_ptr<const HiddenElements>;

/// The elements at which any field has no value.
HiddenPointer missing_elements(std::span<const FieldOnGrid> fields) {
    return fields.front().visit([&]<class Real>(const Hierarchy<Real>&) {
        std::vector<const Hierarchy<Real>*> hierarchies;
        for (const FieldOnGrid& each : fields) {
            each.visit([&]<class Other>(const Hierarchy<Other>& hierarchy) {
                if constexpr (std::is_same_v<Real, Other>) hierarchies.push_back(&hierarchy);
            });
        }
        return HiddenElements::of_all<Real>(hierarchies);
    });
}

/// A field with holes, and what it is made of.
template <class Real>
struct FieldWithHoles {
    FieldWithHoles(FieldOnGrid of, const Hierarchy<Real>& hierarchy, const HiddenPointer& hidden)
        : inner{std::move(of)}, holes(hierarchy, hidden) {}

    FieldOnGrid inner;
    Holes<Real> holes;
};

template <class Real>
FieldOnGrid make_holes(const FieldOnGrid& field, const Hierarchy<Real>& hierarchy,
                       const HiddenPointer& hidden) {
    const auto kept = std::make_shared<const FieldWithHoles<Real>>(field, hierarchy, hidden);
    return std::shared_ptr<const Hierarchy<Real>>(kept, &kept->holes);
}
// clang 14 emits nothing that is instantiated by a generic lambda alone.
template FieldOnGrid make_holes(const FieldOnGrid&, const Hierarchy<float>&, const HiddenPointer&);
template FieldOnGrid make_holes(const FieldOnGrid&, const Hierarchy<double>&, const HiddenPointer&);

FieldOnGrid with_holes(const FieldOnGrid& field, const HiddenPointer& hidden) {
    return field.visit([&](const auto& hierarchy) { return make_holes(field, hierarchy, hidden); });
}

}  // namespace

Frames::Frames(std::vector<FieldOnGrid> frames, std::vector<double> times, Between between)
    : times_{std::move(times)}, between_{std::move(between)} {
    if (frames.empty() || frames.size() != times_.size()) {
        throw InvalidInput("frames need at least one field, and a time for each");
    }
    for (FieldOnGrid& frame : frames) {
        prerolls_.push_back(std::make_shared<Prerolls>(std::move(frame)));
    }
}

Frames Frames::without_missing(const Work& work) const {
    std::vector<FieldOnGrid> fields;
    std::vector<FieldOnGrid> asked;
    for (const std::shared_ptr<Prerolls>& frame : prerolls_) {
        fields.push_back(frame->field());
        asked.push_back(work.on(frame->field()));
    }
    const HiddenPointer hidden = missing_elements(asked);
    if (!hidden->any()) return *this;
    for (FieldOnGrid& field : fields) field = with_holes(field, hidden);
    Between between;
    if (between_) {
        between = [inner = between_, hidden](std::span<const float> weights) {
            return with_holes(inner(weights), hidden);
        };
    }
    return {std::move(fields), times_, std::move(between)};
}

std::shared_ptr<Prerolls> Frames::at(std::span<const float> weights) const {
    detail::require_weights(count(), weights);
    std::vector<std::shared_ptr<Prerolls>> counted;
    std::vector<float> of_counted;
    for (std::size_t i = 0; i < count(); ++i) {
        if (weights[i] == 0) continue;
        counted.push_back(prerolls_[i]);
        of_counted.push_back(weights[i]);
    }
    if (counted.size() == 1 && of_counted.front() == 1) return counted.front();
    return std::make_shared<Prerolls>(between_(weights), std::move(counted), of_counted);
}

std::array<double, 2> Frames::prepare(const Projection& projection, const Work& work) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 2> range{infinity, -infinity};
    for (const std::shared_ptr<Prerolls>& frame : prerolls_) {
        const std::shared_ptr<const Bounds> bounds = frame->prepare(projection, count() > 1, work);
        range = {std::min(range[0], bounds->least()), std::max(range[1], bounds->greatest())};
    }
    return range;
}

std::size_t Frames::memory_bytes() const {
    std::size_t bytes = 0;
    for (const std::shared_ptr<Prerolls>& frame : prerolls_) bytes += frame->memory_bytes();
    return bytes;
}

void Frames::clear() {
    for (const std::shared_ptr<Prerolls>& frame : prerolls_) frame->clear();
}

}  // namespace nestgrid
