// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <indicators/lattice_cuts.hpp>

#include <indicators/diameter.hpp>
#include <indicators/lattice_walk.hpp>
#include <indicators/rules_by_level.hpp>

namespace nestgrid::engine {

namespace {

/// Compares the interpolants of elements with the data where one of them has the isovalue.
template <class Real>
class LatticeCuts {
public:
    static constexpr bool sees_leaves = true;

    LatticeCuts(const Hierarchy<Real>& hierarchy, const CutRequest& request,
                std::span<const Rule* const> rules, RaisedNumbers& numbers)
        : hierarchy_{&hierarchy},
          request_{&request},
          rules_{rules},
          numbers_{&numbers},
          measure_{request.isovalues, request.distances} {}

    bool enters(const LatticeCorners& corners, std::size_t level, NodeKey made) {
        set_corners(corners, level + 1);
        measure_.begin(level, level + 1, request_->distances ? diameter_of(at_.position) : 0);
        return measure_.look(at_, false, request_->bounds->bound(*rules_[level], {&made, 1}));
    }
    void make_row(double, const double* a, const double* b, double* row, std::size_t level) {
        for (std::size_t i = 0; i <= level; ++i) row[i] = 0.5 * (a[i] + b[i]);
    }
    void leaf(const LatticeCorners& corners) {
        set_corners(corners, rules_.size());
        measure_.look(at_, true, 0);
    }
    void leave(std::size_t level, NodeKey made) {
        raise(*numbers_, made, measure_.greatest(level, level + 1));
    }

private:
    void set_corners(const LatticeCorners& corners, std::size_t columns) {
        at_.count = corners.count;
        at_.columns = columns;
        at_.dimension = corners.count - 1;
        for (std::size_t k = 0; k < corners.count; ++k) {
            at_.row[k] = corners.row[k];
            at_.value[k] = corners.row[k][rules_.size()];
        }
        if (!request_->distances) return;
        for (std::size_t k = 0; k < corners.count; ++k) {
            position_[k] = hierarchy_->node_position(corners.key[k]);
        }
        at_.position = std::span<const Point>(position_).first(corners.count);
    }

    const Hierarchy<Real>* hierarchy_;
    const CutRequest* request_;
    std::span<const Rule* const> rules_;
    RaisedNumbers* numbers_;
    CutMeasure measure_;
    CutCorners at_{};
    std::array<Point, LatticeCorners::most> position_{};
};

}  // namespace

template <class Real>
std::vector<std::uint16_t> lattice_cuts(const Hierarchy<Real>& hierarchy, const CutRequest& request,
                                        const Executor& executor) {
    const std::vector<const Rule*> rules = rules_by_level(hierarchy);
    const std::vector<Real> values = values_by_key(hierarchy);
    RaisedNumbers numbers(values.size());
    walk_lattice<Real>(hierarchy, rules, values, executor,
                       [&] { return LatticeCuts<Real>(hierarchy, request, rules, numbers); });
    return {numbers.begin(), numbers.end()};
}

template std::vector<std::uint16_t> lattice_cuts(const Hierarchy<float>&, const CutRequest&,
                                                 const Executor&);
template std::vector<std::uint16_t> lattice_cuts(const Hierarchy<double>&, const CutRequest&,
                                                 const Executor&);

}  // namespace nestgrid::engine
