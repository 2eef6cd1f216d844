// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays of leaves as a forest (LinearOctree), sorted here, of which leaves may be hidden.
#include <nestgrid/adapters/gathered_roots.hpp>
#include <nestgrid/algorithms/frame_weights.hpp>

#include "forest.hpp"

namespace nestgrid::python {

namespace {

template <int dim, int factor>
class MaskedTrees : public LinearOctree<dim, Leaf, factor> {
public:
    using Base = LinearOctree<dim, Leaf, factor>;
    using Element = typename Base::Element;

    /// \param forest borrowed
    explicit MaskedTrees(const Forest<dim, factor>& forest)
        : Base(forest.trees()), forest_{&forest} {
        if (forest.masked().empty()) return;
        hidden_.push_back(0);
        for (const std::uint8_t each : forest.masked()) {
            hidden_.push_back(hidden_.back() + (each != 0));
        }
    }

    Hidden hidden(const Element& e) const {
        if (hidden_.empty()) return Hidden::not_at_all;
        const std::size_t count = hidden_[e.last] - hidden_[e.first];
        if (count == 0) return Hidden::not_at_all;
        return count == e.last - e.first ? Hidden::wholly : Hidden::partly;
    }
    NodeMask constrained(const Element& e) const requires(factor == 3) {
        return nodes_.hanging([&](const std::array<int, 3>& steps) {
            return forest_->is_undivided(e.first, e.level, steps);
        });
    }

private:
    const Forest<dim, factor>* forest_;
    detail::NodesOfTrees<dim, factor> nodes_;
    std::vector<std::size_t> hidden_;  // among the first leaves, so many
};

/// Many trees are gathered, so that a surface looks at those alone that it passes through.
template <int dim, int factor>
struct KeptForest {
    using Trees = MaskedTrees<dim, factor>;
    using Gathered = GatheredRoots<Trees>;
    using Field = LinearOctreeField<Trees, double, std::uint32_t>;

    explicit KeptForest(const OctreeArrays& arrays)
        : forest(arrays), trees(forest), gathered(trees) {
        for (const std::vector<double>& values : forest.values()) {
            fields.emplace_back(trees, forest.element_nodes(), values);
        }
    }
    KeptForest(const KeptForest&) = delete;
    KeptForest& operator=(const KeptForest&) = delete;
    ~KeptForest() = default;

    Forest<dim, factor> forest;
    Trees trees;
    Gathered gathered;
    std::vector<Field> fields;
};

template <int dim, int factor>
std::shared_ptr<OctreeFrames> frames_of(const OctreeArrays& arrays, std::vector<double> times,
                                        const Call& call) {
    using Kept = KeptForest<dim, factor>;
    const auto kept = std::make_shared<const Kept>(arrays);
    const std::shared_ptr<const typename Kept::Gathered> grid(kept, &kept->gathered);
    std::vector<GatheredField<typename Kept::Trees, typename Kept::Field>> fields;
    for (const auto& field : kept->fields) fields.emplace_back(*grid, field);
    Frames frames = shared_frames(grid, std::move(fields), std::move(times), kept);
    if (kept->forest.any_missing()) frames = frames.without_missing(call.work());
    return std::make_shared<OctreeFrames>(std::move(frames),
                                          [kept] { return kept->forest.leaves(); });
}

}  // namespace

std::shared_ptr<OctreeFrames> make_octree(const OctreeArrays& arrays, std::vector<double> times,
                                          const Call& call) {
    linear_weights(times, times.front());  // refuses times that do not ascend
    if (arrays.dimension == 2) {
        return arrays.factor == 2 ? frames_of<2, 2>(arrays, std::move(times), call)
                                  : frames_of<2, 3>(arrays, std::move(times), call);
    }
    return arrays.factor == 2 ? frames_of<3, 2>(arrays, std::move(times), call)
                              : frames_of<3, 3>(arrays, std::move(times), call);
}

}  // namespace nestgrid::python
