// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/project.hpp>

namespace nestgrid::engine {

namespace {

template <class Real>
class ProjectVisitor final : public Visitor<Real> {
public:
    ProjectVisitor(const Criterion& criterion, const ExtractFunction<Real>& function)
        : criterion_{&criterion}, function_{&function} {}

    Leaves leaves(const Rule&, const Real*, NodeMask which, bool) override { return {which, 0}; }
    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        if (split.rule == nullptr) return {Visit::stop, 0};
        const NodeMask mask =
            criterion_->holds({*split.rule, split.keys, view.level + 1, split.outside});
        return {mask == split.rule->all() ? Visit::stop : Visit::descend, mask};
    }
    void extract(const ElementView<Real>& view) override { (*function_)(view); }

private:
    const Criterion* criterion_;
    const ExtractFunction<Real>* function_;
};

}  // namespace

template <class Real>
void project(const Walk<Real>& walk, const Criterion& criterion,
             const ExtractFunction<Real>& function) {
    ProjectVisitor<Real> visitor(criterion, function);
    walk.run(visitor);
}

template void project(const Walk<float>&, const Criterion&, const ExtractFunction<float>&);
template void project(const Walk<double>&, const Criterion&, const ExtractFunction<double>&);

}  // namespace nestgrid::engine
