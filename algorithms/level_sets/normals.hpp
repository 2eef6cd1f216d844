// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients of the extracted elements, summed up at nodes, for normals (paper, section 8).
#pragma once

#include <utility>
#include <vector>

#include <level_sets/element_cuts.hpp>
#include <ranks/normals_across.hpp>
#include <surfaces/node_gradients.hpp>

namespace nestgrid::engine {

/// Sums up gradients: those of the field where it offers them, else those of the drawn elements.
template <class Real>
class Normals {
public:
    explicit Normals(const Walk<Real>& walk)
        : own_{walk.hierarchy().offers(Feature::gradients)},
          shared_{walk.hierarchy().facts().shared},
          by_key_{own_ && shared_ == nullptr && walk.hierarchy().facts().gradients_by_key} {}

    /// Begins anew, and keeps its memory.
    /// \param logs whether to log what add() adds, for append()
    void begin(bool logs);
    /// Adds the gradients at the corners of an element that is drawn.
    void add(const ElementCuts<Real>& element);
    /// Adds what `other` has logged, in its order.
    void append(const Normals& other);

    /// Adds what is known of nodes without an element: the gradients of the field at the ends of
    /// cut edges, where it tells them by the keys of nodes. Behind all add() and append().
    void complete(const Hierarchy<Real>& hierarchy);

    /// Adds what other ranks have drawn around shared nodes. Collective.
    void add_across() { of_shared_.sum_up(*shared_, sums_); }

    NodeGradients& sums() { return sums_; }
    std::size_t memory_bytes() const { return sums_.memory_bytes(); }

private:
    using Slot = NodeGradients::Index;
    using View = ElementView<Real>;

    void add(Slot slot, const CornerGradient& gradient);
    void log_shared(const ElementCuts<Real>& element, std::span<const CornerGradient> drawn);

    bool own_;  // the field has gradients
    bool logs_ = false;
    const SharedNodes* shared_;  // null where there are no ranks
    // Whether complete() finds gradients, so that add() adds projected ones alone.
    bool by_key_;
    SharedGradients of_shared_;
    NodeGradients sums_;
    std::vector<std::pair<Slot, CornerGradient>> log_;
};

}  // namespace nestgrid::engine
