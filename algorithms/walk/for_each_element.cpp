// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/for_each_element.hpp>

#include <algorithm>

namespace nestgrid::engine {

namespace {

template <class Real>
class EachVisitor final : public Visitor<Real> {
public:
    EachVisitor(bool splits_only, const ElementFunction<Real>& function)
        : splits_only_{splits_only}, function_{&function} {}

    bool sees_hidden() const override { return true; }
    Leaves leaves(const Rule&, const Real*, NodeMask which, bool) override {
        return {0, splits_only_ ? NodeMask{0} : which};
    }
    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        (*function_)(view, split);
        return {};
    }
    void extract(const ElementView<Real>&) override {}

private:
    bool splits_only_;
    const ElementFunction<Real>* function_;
};

template <class Real>
class LevelVisitor final : public Visitor<Real> {
public:
    LevelVisitor(int level, const ElementFunction<Real>& function)
        : level_{level}, function_{&function} {}

    bool sees_hidden() const override { return true; }
    Decision inspect(const ElementView<Real>& view, const Split& split) override {
        if (view.level < level_) return {};
        if (view.level == level_) (*function_)(view, split);
        return {Visit::skip, 0};
    }
    void extract(const ElementView<Real>&) override {}

private:
    int level_;
    const ElementFunction<Real>* function_;
};

}  // namespace

template <class Real>
void for_each_element(const Walk<Real>& walk, bool splits_only,
                      const ElementFunction<Real>& function) {
    EachVisitor<Real> visitor(splits_only, function);
    walk.run(visitor);
}

template <class Real>
void for_each_on_level(const Walk<Real>& walk, int level, const ElementFunction<Real>& function) {
    LevelVisitor<Real> visitor(level, function);
    walk.run(visitor);
}

template <class Real>
int count_levels(const Walk<Real>& walk) {
    int levels = 0;
    for_each_element(walk, false, [&](const ElementView<Real>& view, const Split&) {
        levels = std::max(levels, view.level + 1);
    });
    return levels;
}

template void for_each_element(const Walk<float>&, bool, const ElementFunction<float>&);
template void for_each_element(const Walk<double>&, bool, const ElementFunction<double>&);
template void for_each_on_level(const Walk<float>&, int, const ElementFunction<float>&);
template void for_each_on_level(const Walk<double>&, int, const ElementFunction<double>&);
template int count_levels(const Walk<float>&);
template int count_levels(const Walk<double>&);

}  // namespace nestgrid::engine
