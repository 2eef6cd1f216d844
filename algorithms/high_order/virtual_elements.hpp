// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements of a virtual refinement: those of the hierarchy, and the parts of leaves.
//
// A part of a leaf is flat where beta is at most a third of the tolerance, and it is as small as a
// lens asks if there is one; or where it is as small as the depth allows. A leaf, or an element
// below it, is divided where an edge, a face or itself is not flat, or where what is drawn in it
// might miss U by more than the tolerance. Invariants:
//   - a new node hangs exactly where the part that it halves is flat;
//   - values and flatness of what lies on the surface of a leaf come from the records, of what lies
//     inside from its own coefficients;
//   - no criterion stops at a virtual node.
// Consequence: a virtual element ends only where every deeper node on its faces hangs, seen from
// any side, so that drawings are closed as at other hanging nodes.
#pragma once

#include <mutex>
#include <optional>

#include <high_order/lens_sizes.hpp>
#include <high_order/real_nodes.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <walk/position_functions.hpp>

namespace nestgrid::engine {

/// What is made once per solution.
struct HighOrderData {
    std::optional<WidenedHierarchy<float>> widened;  // where the values are float
    const Hierarchy<double>* base;
    BaseWalk walk;
    LeafRecords records;
    RealNodes nodes;

    explicit HighOrderData(const Hierarchy<float>& single);
    explicit HighOrderData(const Hierarchy<double>& base);

    /// Made when a lens first asks for them.
    const LeafCorners& corners() const;

private:
    mutable std::once_flag corners_made_;
    mutable std::optional<LeafCorners> corners_;
};

/// What is known of an element besides its name.
struct ElementState {
    Handle base;                 // the element of the hierarchy, or the leaf it lies in
    const Rule* rule = nullptr;  // of that element
    const ShapeParts* shape = nullptr;
    CornerKeys key{};
    NodeKey path = 0;                     // of that element
    std::array<Point, max_corners> x{};   // of the corners, where the hierarchy has positions
    std::array<Place, max_corners> at{};  // in the leaf, in units of 2^-level
};

/// An element of the hierarchy, or one below a leaf.
struct VirtualElement {
    static constexpr std::uint32_t no_leaf = 0xFFFFFFFFU;
    std::uint32_t leaf = no_leaf;  // none: an element that the hierarchy itself divides
    std::int32_t level = 0;        // below the leaf
    std::uint64_t way = 0;         // the numbers of children from the leaf on, 4 bits each
    const ElementState* state = nullptr;

    VirtualElement father() const { return {leaf, level - 1, way >> 4U, nullptr}; }
};

class VirtualElements {
public:
    VirtualElements(std::shared_ptr<const HighOrderData> data, const VirtualOptions& options);

    const HighOrderData& data() const { return *data_; }
    const Criterion& criterion() const { return criterion_; }

    std::unique_ptr<Task> open() const;
    void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const;
    NodeMask coarse_values(Task* task, std::size_t i, std::span<double> out) const;
    void enter(Task* task, const VirtualElement& e, NodeMask which, double* values, NodeMask wanted,
               Family& family) const;
    void new_values(Task* task, const VirtualElement& e, NodeMask which, double* values) const;
    unsigned boundary(Task* task, const VirtualElement& e) const;
    /// Positions of new nodes: true ones of the hierarchy; means of the parents where these hang,
    /// and below leaves, whose edges are straight.
    void new_positions(Task* task, const VirtualElement& e, NodeMask which,
                       std::span<Point> out) const;

private:
    /// S = (stop <= tolerance) at nodes of the hierarchy, and the lens lets elements stop there.
    class Stops final : public Criterion {
    public:
        Stops(const RealNodes& nodes, double tolerance, std::shared_ptr<const LensSizes> lens)
            : nodes_{&nodes}, tolerance_{tolerance}, lens_{std::move(lens)} {}
        NodeMask holds(const NewNodes& nodes) const override;
        bool saturated() const override { return true; }
        bool wants_positions() const override { return lens_ != nullptr; }
        bool made_for(std::uint64_t epoch) const override { return nodes_->made_for(epoch); }

    private:
        const RealNodes* nodes_;
        double tolerance_;
        std::shared_ptr<const LensSizes> lens_;
    };
    /// The nets of the children of the boxes on the way down that were entered last.
    struct OpenTask final : Task {
        struct Halves {
            std::uint32_t leaf = VirtualElement::no_leaf;
            std::uint64_t way = 0;
            std::vector<double> nets;  // of component 0, one child behind the other
        };
        std::unique_ptr<Task> base;
        Family family;                         // of a coarse element
        std::size_t coarse = ~std::size_t{0};  // the one asked for last
        CornerKeys key{};                      // of its corners
        std::vector<Halves> halves;            // by level of the element entered
        NetRoom net;                           // of the element looked at last, where it is no box
        std::uint32_t pyramid = VirtualElement::no_leaf;  // the one looked into last
        PyramidCurvature curvature;                       // of that
    };
    /// The coefficients of component 0 on an element below a leaf; below a pyramid on a box around.
    struct OwnNet {
        const double* net;
        int degree;
        std::array<std::uint8_t, max_corners> number;  // of the corners, among those of the net
        Factors factors;                               // of the net
        const PyramidCurvature* curvature = nullptr;   // below a pyramid
    };
    /// What a leaf, or an element below it, looks like at the tolerance.
    struct Looked {
        NodeMask flat = 0;     // new nodes that halve a flat part
        bool all_flat = true;  // parts without a node, too
        NetFacts facts;        // of the element; its range includes that of the records around
    };
    using Positions = std::array<Point, max_split_nodes>;
    struct Places;

    Positions positions(Task* task, const VirtualElement& e, NodeMask which) const;
    static Places& places(Family& family, std::size_t count);
    void set_leaf(VirtualElement& e, const Member& member, ElementState& state) const;
    void set_child(const VirtualElement& father, std::size_t child, const Family& base,
                   VirtualElement& e, ElementState& state) const;
    void describe(OpenTask& task, const VirtualElement& e, const double* u, Family& family,
                  std::size_t member) const;
    void describe_split(const VirtualElement& e, Member& member) const;
    void describe_leaf(OpenTask& task, const VirtualElement& e, const double* u, Member& member,
                       InnerBounds& inner) const;
    // One leaf and its parts (leaf_parts.cpp).
    Looked look(const VirtualElement& e, const OwnNet& own) const;
    /// \param is_fine whether the lens finds the part fine; asked only if there is a lens
    template <class IsFine>
    bool is_flat(double beta, int level, const IsFine& is_fine) const {
        return level >= depth_ || (beta <= flat_ && (lens_ == nullptr || is_fine()));
    }
    double drawn_error(const VirtualElement& e, const OwnNet& own, double beta,
                       std::span<const double> u) const;
    double drawn_error_in_pyramid(const VirtualElement& e, const OwnNet& own, double beta,
                                  std::span<const double> u) const;
    OwnNet net_of(OpenTask& task, const VirtualElement& e) const;
    OwnNet net_in_pyramid(OpenTask& task, const VirtualElement& e) const;
    double own_value(const VirtualElement& e, const OwnNet& own, std::size_t corner) const;
    const double* box_net_of(OpenTask& task, const VirtualElement& e) const;
    const double* nets_of_children(OpenTask& task, const VirtualElement& e) const;
    void leaf_values(OpenTask& task, const VirtualElement& e, std::size_t node, double* out) const;

    std::shared_ptr<const HighOrderData> data_;
    const LeafRecords* records_;
    const RealNodes* nodes_;
    std::size_t components_;
    double tolerance_;
    double flat_;  // beta of what is flat
    int depth_;
    double least_beyond_;  // covers rounding
    bool linear_;          // every leaf is the interpolant of its corners, and fits its neighbours
    std::shared_ptr<const LensSizes> lens_;  // or null
    Stops criterion_;
};

}  // namespace nestgrid::engine
