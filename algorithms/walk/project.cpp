// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/project.hpp>

#include <walk/criterion_question.hpp>

namespace nestgrid::engine {

namespace {

template <class Real>
class ProjectVisitor final : public Visitor<Real> {
public:
    ProjectVisitor(const Walk<Real>& walk, const Criterion& criterion,
                   const ExtractFunction<Real>& function)
        : walk_{&walk}, criterion_{&criterion}, function_{&function} {}

    Leaves leaves(const Rule&, const Real*, NodeMask which, bool) override { return {which, 0}; }
    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        if (split.rule == nullptr) return {Visit::stop, 0};
        return question_.ask(*walk_, *criterion_, view, split);
    }
    void extract(const ElementView<Real>& view) override { (*function_)(view); }

private:
    const Walk<Real>* walk_;
    const Criterion* criterion_;
    const ExtractFunction<Real>* function_;
    CriterionQuestion question_;
};

}  // namespace

template <class Real>
void project(const Walk<Real>& walk, const Criterion& criterion,
             const ExtractFunction<Real>& function) {
    ProjectVisitor<Real> visitor(walk, criterion, function);
    walk.run(visitor);
}

template void project(const Walk<float>&, const Criterion&, const ExtractFunction<float>&);
template void project(const Walk<double>&, const Criterion&, const ExtractFunction<double>&);

}  // namespace nestgrid::engine
