// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <projection/polynomials.hpp>

#include <deque>

namespace nestgrid::engine {

/// Polynomials, with the field that they borrow.
struct PolynomialsOfField {
    PolynomialsOfField(const FieldOnGrid& of, const Executor& executor)
        : field{of}, data{field.visit([&](const auto& hierarchy) {
              return HighOrder(hierarchy, executor);
          })} {}

    FieldOnGrid field;
    HighOrder data;
};

namespace {

/// Looks for a leaf that is curved, or has a degree above 1.
template <class Real>
class DegreeSearch {
public:
    explicit DegreeSearch(const Hierarchy<Real>& hierarchy)
        : hierarchy_{&hierarchy}, task_{hierarchy.open()} {}

    bool finds_one() {
        for (std::size_t i = 0; i < hierarchy_->coarse_count(); ++i) {
            Coarse coarse;
            Family& family = at(0);
            hierarchy_->coarse(task_.get(), i, coarse, family);
            if (is_below(family.members[0], 1)) return true;
        }
        return false;
    }

private:
    Family& at(std::size_t level) {
        while (families_.size() <= level) families_.emplace_back();
        return families_[level];
    }
    bool is_below(const Member& member, std::size_t level) {
        if (member.rule == nullptr) {
            return hierarchy_->degree(task_.get(), member.element) > 1 ||
                   hierarchy_->geometry_degree(task_.get(), member.element) > 1;
        }
        Family& family = at(level);
        hierarchy_->enter(task_.get(), member.element, *member.rule, 0, nullptr, ~NodeMask{0},
                          family);
        for (std::size_t c = 0; c < member.rule->children.size(); ++c) {
            if (is_below(family.members[c], level + 1)) return true;
        }
        return false;
    }

    const Hierarchy<Real>* hierarchy_;
    std::unique_ptr<Task> task_;
    std::deque<Family> families_;  // of each level on the way down
};

}  // namespace

std::shared_ptr<const HighOrder> polynomials_of(const FieldOnGrid& field,
                                                const Executor& executor) {
    const bool has_degree = field.visit([](const auto& hierarchy) {
        return hierarchy.offers(Feature::degree) && DegreeSearch(hierarchy).finds_one();
    });
    if (!has_degree) return nullptr;
    const auto kept = std::make_shared<const PolynomialsOfField>(field, executor);
    return {kept, &kept->data};
}

}  // namespace nestgrid::engine
