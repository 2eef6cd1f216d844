// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/reach.hpp>

#include <algorithm>

#include <probes/point_box.hpp>
#include <walk/criterion_question.hpp>

namespace nestgrid::engine {

namespace {

/// Collects the boxes of what lies below the elements on the way down.
template <class Real>
class ReachSearch final : public Visitor<Real> {
    using View = ElementView<Real>;

public:
    ReachSearch(const Walk<Real>& walk, const Criterion& criterion)
        : walk_{walk}, criterion_{criterion} {}

    Decision inspect(const View& view, const Split& split) override {
        arrive(view);
        if (split.rule == nullptr) return {Visit::stop};
        return question_.ask(walk_, criterion_, view, split);
    }
    void extract(const View& /*view*/) override {}
    NodeMask children(const View& view) override {
        if (view.member->rule->new_nodes.empty()) arrive(view);  // inspect() was not called
        return ~NodeMask{0};
    }

    /// The reach on each level of the elements that were visited since the last call.
    std::span<const double> finish() {
        leave(0);
        return of_level_;
    }
    void begin() { of_level_.clear(); }

private:
    struct Open {
        PointBox corners;
        PointBox below;
    };

    void arrive(const View& view) {
        leave(static_cast<std::size_t>(view.level));
        std::array<Point, max_corners> x;
        walk_.corners(view, nullptr, x.data());
        const auto box = PointBox::around(std::span(x).first(view.corner_count()));
        open_.push_back({box, box});
        if (!walk_.places_corners()) return;
        walk_.placed_corners(view, x.data());
        open_.back().below.add(PointBox::around(std::span(x).first(view.corner_count())));
    }
    /// Leaves the elements on a level and below.
    void leave(std::size_t level) {
        while (open_.size() > level) {
            const Open element = open_.back();
            open_.pop_back();
            if (of_level_.size() <= open_.size()) of_level_.resize(open_.size() + 1, 0.0);
            double& most = of_level_[open_.size()];
            most = std::max(most, element.corners.exceeded_by(element.below));
            if (!open_.empty()) open_.back().below.add(element.below);
        }
    }

    const Walk<Real>& walk_;
    const Criterion& criterion_;
    CriterionQuestion question_;
    std::vector<Open> open_;  // the element at hand and those above
    std::vector<double> of_level_;
};

}  // namespace

template <class Real>
Reach::Reach(const Walk<Real>& walk, const Criterion& criterion) : first_{0} {
    ReachSearch<Real> search(walk, criterion);
    for (std::size_t i = 0; i < walk.hierarchy().coarse_count(); ++i) {
        search.begin();
        walk.run(search, i, i + 1);
        const auto levels = search.finish();
        of_level_.insert(of_level_.end(), levels.begin(), levels.end());
        first_.push_back(of_level_.size());
    }
}

template <class Real>
std::optional<Reach> Reach::told(const Hierarchy<Real>& hierarchy) {
    const auto task = hierarchy.open();
    Coarse coarse;
    Family family;
    Reach reach;
    reach.first_.push_back(0);
    for (std::size_t i = 0; i < hierarchy.coarse_count(); ++i) {
        hierarchy.coarse(task.get(), i, coarse, family);
        const float beyond = family.inner_bounds(family.members[0]).beyond_hull;
        if (beyond < 0) return std::nullopt;
        reach.of_level_.push_back(static_cast<double>(beyond));
        reach.first_.push_back(reach.of_level_.size());
    }
    return reach;
}

template std::optional<Reach> Reach::told(const Hierarchy<float>&);
template std::optional<Reach> Reach::told(const Hierarchy<double>&);
template Reach::Reach(const Walk<float>&, const Criterion&);
template Reach::Reach(const Walk<double>&, const Criterion&);

}  // namespace nestgrid::engine
