// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the adapter asks of AMReX, with the layout that AMReX has: Fortran order, ghost cells around
// each box, component by component. Debian has no AMReX.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "block_samples.hpp"

// Names are those of AMReX.
// NOLINTBEGIN(readability-identifier-naming)
namespace nestgrid_test::stand_in {

template <class T>
class Vector : public std::vector<T> {
public:
    using std::vector<T>::vector;
    T& operator[](int i) { return std::vector<T>::operator[](static_cast<std::size_t>(i)); }
    const T& operator[](int i) const {
        return std::vector<T>::operator[](static_cast<std::size_t>(i));
    }
};

struct Box {
    std::array<int, 3> low{}, high{};
    int smallEnd(int d) const { return low[static_cast<std::size_t>(d)]; }
    int bigEnd(int d) const { return high[static_cast<std::size_t>(d)]; }
};

struct IntVect {
    std::array<int, 3> x{};
    int operator[](int d) const { return x[static_cast<std::size_t>(d)]; }
};

class BoxArray {
public:
    Vector<Box> boxes;
    long size() const { return static_cast<long>(boxes.size()); }
    Box operator[](int i) const { return boxes[i]; }
};

template <class Real>
class Fab {
public:
    Fab(const Box& box, int components)
        : box_{box},
          numbers_(size() * static_cast<std::size_t>(components),
                   std::numeric_limits<Real>::quiet_NaN()) {}
    const Box& box() const { return box_; }
    const Real* dataPtr(int n = 0) const { return &numbers_[size() * static_cast<std::size_t>(n)]; }
    Real& operator()(const std::array<int, 3>& cell, int n) {
        auto at = static_cast<std::size_t>(n);
        for (std::size_t d = 3; d-- > 0;) {
            at = at * static_cast<std::size_t>(box_.high[d] - box_.low[d] + 1) +
                 static_cast<std::size_t>(cell[d] - box_.low[d]);
        }
        return numbers_.at(at);
    }
    std::size_t size() const {
        std::size_t cells = 1;
        for (std::size_t d = 0; d < 3; ++d) {
            cells *= static_cast<std::size_t>(box_.high[d] - box_.low[d] + 1);
        }
        return cells;
    }

private:
    Box box_;
    std::vector<Real> numbers_;
};

/// Those of some boxes alone, as on one of several processes.
template <class Real>
class MultiFab {
public:
    using value_type = Real;

    MultiFab(BoxArray boxes, int components, int ghosts, bool is_nodal, int every = 1)
        : boxes_{std::move(boxes)}, components_{components}, is_nodal_{is_nodal} {
        for (int i = 0; i < static_cast<int>(boxes_.size()); i += every) {
            Box stored = boxes_[i];
            for (std::size_t d = 0; d < 3; ++d) {
                if (stored.low[d] == 0 && stored.high[d] == 0 && d == 2 && is_flat()) continue;
                stored.low[d] -= ghosts;
                stored.high[d] += ghosts;
            }
            here_.push_back(i);
            fabs_.emplace_back(stored, components);
        }
    }
    const BoxArray& boxArray() const { return boxes_; }
    int nComp() const { return components_; }
    const Vector<int>& IndexArray() const { return here_; }
    const Fab<Real>& atLocalIdx(int i) const { return fabs_[static_cast<std::size_t>(i)]; }
    Fab<Real>& atLocalIdx(int i) { return fabs_[static_cast<std::size_t>(i)]; }
    bool is_nodal() const { return is_nodal_; }
    bool is_cell_centered() const { return !is_nodal_; }

private:
    bool is_flat() const {
        for (const Box& box : boxes_.boxes) {
            if (box.low[2] != 0 || box.high[2] != 0) return false;
        }
        return true;
    }

    BoxArray boxes_;
    int components_;
    bool is_nodal_;
    Vector<int> here_;
    std::vector<Fab<Real>> fabs_;
};

struct Geometry {
    Point low{};
    Point size{};
    double ProbLo(int d) const { return low[static_cast<std::size_t>(d)]; }
    double CellSize(int d) const { return size[static_cast<std::size_t>(d)]; }
};

/// An AMR run: levels of MultiFabs, and what goes with them.
template <int dim, class Real>
class Run {
public:
    using Function = std::function<double(const Point& x, int component)>;

    /// \param every of the boxes that are here, one in so many
    Run(const Blocks<dim>& blocks, const Function& f, int components = 2, int ghosts = 1,
        bool nodal = false, int every = 1)
        : geometry{blocks.origin, blocks.spacing} {
        const CellsOfBlocks<dim> cells(blocks);
        for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
            BoxArray boxes;
            for (const BlockBox<dim>& box : blocks.levels[l].boxes)
                boxes.boxes.push_back(copy(box));
            if (nodal) {
                for (Box& box : boxes.boxes) {
                    for (std::size_t d = 0; d < dim; ++d) ++box.high[d];
                }
            }
            owned.push_back(
                std::make_unique<MultiFab<Real>>(boxes, components, ghosts, nodal, every));
            levels.push_back(owned.back().get());
            if (l > 0)
                ratios.push_back({{blocks.levels[l].ratio[0], blocks.levels[l].ratio[0],
                                   blocks.levels[l].ratio[0]}});
            for (int i = 0; i < static_cast<int>(owned.back()->IndexArray().size()); ++i) {
                BlockBox<dim> box =
                    blocks.levels[l].boxes[static_cast<std::size_t>(owned.back()->IndexArray()[i])];
                for (int& last : box.upper) last += nodal ? 1 : 0;
                for_each_cell(box, [&](const Cell<dim>& c) {
                    if (!nodal && !cells.is_leaf(l, c)) return;
                    std::array<int, 3> at{};
                    std::copy(c.begin(), c.end(), at.begin());
                    for (int n = 0; n < components; ++n) {
                        owned.back()->atLocalIdx(i)(at, n) =
                            static_cast<Real>(f(cells.at(l, c, nodal ? 0 : 0.5), n));
                    }
                });
            }
        }
    }

    std::vector<std::unique_ptr<MultiFab<Real>>> owned;
    Vector<const MultiFab<Real>*> levels;
    Geometry geometry;
    Vector<IntVect> ratios;

private:
    static Box copy(const BlockBox<dim>& box) {
        Box result;
        std::copy(box.lower.begin(), box.lower.end(), result.low.begin());
        std::copy(box.upper.begin(), box.upper.end(), result.high.begin());
        return result;
    }
};

}  // namespace nestgrid_test::stand_in
// NOLINTEND(readability-identifier-naming)
