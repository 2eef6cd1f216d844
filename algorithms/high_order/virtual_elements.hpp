// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements of a virtual refinement: those of the hierarchy, and the parts of leaves.
//
// A part of a leaf is flat where beta is at most a third of the tolerance, or of that of the region
// that it is in, and it is as small as a lens asks if there is one; or where it is as small as the
// depth allows. A leaf, or an element
// below it, is divided where an edge, a face or itself is not flat, or where what is drawn in it
// might miss U by more than the tolerance. Invariants:
//   - a new node hangs exactly where the part that it halves is flat;
//   - values and flatness of what lies on the surface of a leaf come from the records, of what lies
//     inside from its own coefficients;
//   - no criterion stops at a virtual node.
// Consequence: a virtual element ends only where every deeper node on its faces hangs, seen from
// any side, so that drawings are closed as at other hanging nodes.
// A leaf that a drawing does not look at (VirtualOptions::values) is not divided: nothing of the
// level sets drawn passes through it, whatever is projected around.
#pragma once

#include <high_order/element_nets.hpp>
#include <high_order/high_order_data.hpp>

namespace nestgrid::engine {

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
    /// Positions of new nodes: those of curved leaves. In straight ones true ones of the hierarchy;
    /// means of the parents where these hang, and below leaves.
    void new_positions(Task* task, const VirtualElement& e, NodeMask which,
                       std::span<Point> out) const;

private:
    /// Polynomials with the tolerance that they are drawn within.
    struct Drawn {
        const LeafSummary* summary = nullptr;
        const RealNodes* nodes = nullptr;
        const LeafRecords* records = nullptr;
        double tolerance = 0;
        double in_region = 0;  // the tolerance there
        double flat = 0;       // beta of what is flat
        double rounding = 0;   // added to bounds

        Drawn(const PolynomialFacts& of, const LeafRecords& leaves, double within,
              double within_region = std::numeric_limits<double>::infinity())
            : summary{&of.summary},
              nodes{&of.nodes},
              records{&leaves},
              tolerance{within},
              in_region{std::min(within, within_region)},
              flat{within / flat_share},
              rounding{of.summary.rounding()} {}
        /// Whether elements may stop at a node of the hierarchy.
        bool stops(NodeKey key, bool region) const {
            const RealNode* const node = nodes->find(key);
            return node != nullptr &&
                   static_cast<double>(node->stop) <= (region ? in_region : tolerance);
        }
    };
    /// S = (stop <= tolerance) at nodes of the hierarchy, and the lens lets elements stop there.
    class Stops final : public Criterion {
    public:
        Stops(const Drawn& field, const std::optional<Drawn>& places,
              std::shared_ptr<const LensSizes> lens, std::shared_ptr<const RegionParts> region)
            : field_{field}, places_{places}, lens_{std::move(lens)}, region_{std::move(region)} {}
        NodeMask holds(const NewNodes& nodes) const override;
        bool saturated() const override { return true; }
        bool wants_positions() const override { return lens_ != nullptr || region_ != nullptr; }
        bool made_for(std::uint64_t epoch) const override { return field_.nodes->made_for(epoch); }

    private:
        Drawn field_;
        std::optional<Drawn> places_;
        std::shared_ptr<const LensSizes> lens_;
        std::shared_ptr<const RegionParts> region_;
    };
    struct OpenTask final : Task {
        std::unique_ptr<Task> base;
        Family family;                         // of a coarse element
        std::size_t coarse = ~std::size_t{0};  // the one asked for last
        CornerKeys key{};                      // of its corners
        std::vector<ElementNets> field;        // of component 0
        std::vector<ElementNets> places;       // of the coordinates, where leaves are curved

        std::vector<ElementNets>& nets_of(const LeafRecords& records) {
            return records.drawn() == 1 ? field : places;
        }
    };
    /// What a leaf, or an element below it, looks like at the tolerance.
    struct Looked {
        NodeMask flat = 0;     // new nodes that halve a flat part
        bool all_flat = true;  // parts without a node, too
        NetFacts facts;        // of the element; its range includes that of the records around
        std::array<double, 3> beta{};  // of each component that is drawn
        double error = 0;              // of what is drawn in the element
        double corner_error = 0;       // of positions drawn at the corners
        bool exceeds = false;          // whether the error is more than is allowed
    };
    using Positions = std::array<Point, max_split_nodes>;
    struct Places;

    std::optional<Drawn> places_within(const VirtualOptions& options) const;
    static bool is_linear(const HighOrderData& data);
    Point position(NodeKey key) const;
    Positions positions(Task* task, const VirtualElement& e, NodeMask which) const;
    void put_places(OpenTask& task, const VirtualElement& e, NodeMask which, Positions& x) const;
    static Places& places(Family& family, std::size_t count);
    void set_leaf(VirtualElement& e, const Member& member, ElementState& state) const;
    void set_child(const VirtualElement& father, std::size_t child, const Family& base,
                   VirtualElement& e, ElementState& state) const;
    void describe(OpenTask& task, const VirtualElement& e, const double* u, Family& family,
                  std::size_t member) const;
    void describe_split(const VirtualElement& e, Member& member, InnerBounds& inner) const;
    void describe_leaf(OpenTask& task, const VirtualElement& e, const double* u, Member& member,
                       InnerBounds& inner) const;
    // One leaf and its parts (leaf_parts.cpp).
    Looked look(OpenTask& task, const VirtualElement& e, const Drawn& drawn,
                std::span<const double> u) const;
    void look_at_parts(const VirtualElement& e, const Drawn& drawn, std::span<const OwnNet> own,
                       Looked& looked) const;
    void look_at_error(OpenTask& task, const VirtualElement& e, const Drawn& drawn,
                       std::span<const OwnNet> own, std::span<const double> u,
                       Looked& looked) const;
    /// \param with calls a function with the part of a leaf, for the lens and the region
    template <class WithPart>
    bool is_flat(const Drawn& drawn, double beta, int level, const WithPart& with) const {
        if (level >= depth_) return true;
        if (beta > drawn.flat) return false;
        const bool fine =
            lens_ == nullptr || with([&](const auto&... part) { return lens_->is_fine(part...); });
        if (!fine || region_ == nullptr || flat_share * beta <= drawn.in_region) return fine;
        return !with([&](const auto&... part) { return region_->has(part...); });
    }
    bool hangs_flat(const Drawn& drawn, NodeKey key) const;
    void leaf_values(OpenTask& task, const VirtualElement& e, const Drawn& drawn, std::size_t node,
                     double* out) const;

    std::shared_ptr<const HighOrderData> data_;
    bool linear_;  // every leaf is the interpolant of its corners, and fits its neighbours
    std::shared_ptr<const GatheredLeaves> leaves_;
    Drawn field_;
    std::optional<Drawn> places_;  // where leaves are curved
    std::size_t components_;
    int depth_;
    std::shared_ptr<const LensSizes> lens_;      // or null
    std::shared_ptr<const RegionParts> region_;  // or null
    Stops criterion_;
};

}  // namespace nestgrid::engine
