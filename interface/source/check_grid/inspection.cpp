// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "inspection.hpp"

#include <algorithm>

namespace nestgrid::detail {

double Inspection::tolerance(int ulps) const {
    return std::max(options_->value_tolerance, ulps * epsilon_);
}

std::size_t Inspection::add_step(std::size_t father, std::size_t number) {
    steps_.push_back({father, number});
    return steps_.size() - 1;
}

std::string Inspection::name(std::size_t step) const {
    std::string path;
    for (; step != no_step; step = steps_[step].father) {
        path = "/" + std::to_string(steps_[step].number) + path;
    }
    return "element " + path.substr(1);
}

std::string Inspection::broken_promise() const {
    return ", but the grid says that all elements are " +
           std::string(topology(facts().only_shape).name) + "s";
}

void Inspection::fail(Law law, const std::string& sentence) {
    throw ViolationFound{{law, sentence}};
}

void Inspection::fail_unless_hidden(NodeKey place, Law law, const std::string& sentence) {
    if (!offers(Feature::hidden)) fail(law, sentence);
    unless_hidden_.push_back({place, {law, sentence}});
}

void Inspection::finish_hidden() const {
    for (const auto& [place, violation] : unless_hidden_) {
        if (nodes_.is_seen(place)) throw ViolationFound{violation};
    }
}

void Inspection::fail_if_hanging(NodeKey place, Law law, const std::string& sentence) {
    if_hanging_.try_emplace(place, GridViolation{law, sentence});
}

void Inspection::finish_hanging(NodeKey place, const std::string& more) const {
    const auto found = if_hanging_.find(place);
    if (found != if_hanging_.end()) fail(found->second.law, found->second.sentence + more);
}

void Inspection::note(const std::string& sentence) const {
    if (options_->notes != nullptr) options_->notes->push_back(sentence);
}

}  // namespace nestgrid::detail
