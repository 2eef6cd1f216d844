// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The seam between grids and algorithms: a grid and a field on it behind virtual functions.
//
// Algorithms are compiled once against Hierarchy<float> and Hierarchy<double>. Any model of the
// concepts in grid.hpp becomes one (detail/erase.hpp), and so does a table in C.
//
// Invariants:
//   - one call enters an element: it returns the values at the new nodes that the walk needs, and
//     all children with the rules that split them, the keys of their new nodes, and which of these
//     hang or lie outside;
//   - one more call returns keys, positions and boundary faces of an element that is extracted;
//   - all functions are const and reentrant; what a grid must remember lies in the Task.
// Consequence: the number of virtual calls is that of the elements entered and extracted, not that
// of the questions asked.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/detail/elements.hpp>
#include <nestgrid/keys.hpp>
#include <nestgrid/optional.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

namespace engine {
class FarValues;
class SharedNodes;
}  // namespace engine

/// The grid's own state of one task: a rebuilt entity, a cache. Used by one thread at a time.
class Task {
public:
    virtual ~Task() = default;
};

/// What is known of an element without entering it.
struct Member {
    Handle element;
    const Rule* rule = nullptr;   ///< that splits the element; null on a leaf
    NodeMask constrained = 0;     ///< new nodes that hang, where the grid knows them
    NodeMask outside = 0;         ///< new nodes at which no element may stop
    std::uint32_t first_key = 0;  ///< in Family::keys, where the grid has keys of its own
    Hidden hidden = Hidden::not_at_all;
    Presence presence = Presence::here;
};

/// What is known of data inside an element besides Bounds, where these are of higher degree.
struct InnerBounds {
    float beyond = 0;  ///< how far U may leave the range of P_S U at the corners
    /// On a leaf: how far U may be from what is drawn of P_S U at its corners, triangles included;
    /// 0 where these say all.
    float error = 0;
    /// On grids with curved leaves, how far what is drawn of an element may be from where its
    /// points are; and how far the element and all below it may leave the hull of its corners.
    /// Negative: the corners, and position_bounds(), say all.
    float position_error = -1;
    float beyond_hull = -1;
    bool limited = false;  ///< a leaf that a limit on depth kept from being divided
};

/// The children of one element, or one coarse element. Members that are neither split nor leaves
/// are masked, elsewhere, or were not asked for; nothing of them is set but handle and presence.
struct Family {
    std::vector<Member> members;
    NodeMask split = 0;   ///< members that are split, one bit each
    NodeMask leaves = 0;  ///< members that are not, one bit each
    NodeMask hidden = 0;  ///< members that are hidden wholly, one bit each
    /// Keys of the new nodes of all members that are split, and room behind them.
    std::vector<NodeKey> keys;
    std::size_t key_count = 0;       ///< number of keys that are set
    std::vector<InnerBounds> inner;  ///< one for each member, or none where Bounds say all
    /// Where handles point to, for elements that do not fit into them.
    std::shared_ptr<void> elements;

    /// Makes room for members, none of which is set, and keeps the memory.
    void begin(std::size_t count) {
        if (members.size() < count) [[unlikely]]
            members.resize(count);
        key_count = 0;
        split = leaves = hidden = 0;
    }
    /// \param member of this family
    InnerBounds inner_bounds(const Member& member) const {
        return inner.empty() ? InnerBounds{}
                             : inner[static_cast<std::size_t>(&member - members.data())];
    }
    std::span<const NodeKey> new_keys(const Member& member) const {
        return {keys.data() + member.first_key, member.rule->new_nodes.size()};
    }
    /// Makes room for keys behind those that are set, and counts them as set.
    /// \param spare room behind them
    std::span<NodeKey> add_keys(std::size_t count, std::size_t spare) {
        if (keys.size() < key_count + count + spare) [[unlikely]] {
            keys.resize(2 * (key_count + count + spare));
        }
        const std::span<NodeKey> added(keys.data() + key_count, count);
        key_count += count;
        return added;
    }
};

/// An element of the coarse grid.
struct Coarse {
    Shape shape = Shape::point;
    std::int8_t orientation = 1;
    std::array<Point, max_corners> corners{};
    std::array<std::uint64_t, max_corners> ids{};
};

/// What holds of a hierarchy as a whole.
struct HierarchyFacts {
    int dimension = 0;
    int components = 1;                 ///< of the field
    unsigned features = 0;              ///< the optional operations it has, by Feature
    std::size_t node_count = 0;         ///< number of dense keys; 0 where keys are not dense
    bool conforming = false;            ///< no node hangs
    bool knows_stars = false;           ///< star_rows() and row_values() work
    bool knows_star_positions = false;  ///< star_rows() and node_position() work
    bool knows_patches = false;         ///< bisection_rows() or bisect() work
    bool bisects_means = false;         ///< the same for visitors that take means
    bool gradients_at_nodes = false;    ///< rows, or bisect(), hand over gradients at any node
    bool gradients_by_key = false;      ///< node_gradients() works
    bool fills_rows = false;            ///< every node is in a star row
    bool decodes = false;               ///< values at new nodes need those at the corners
    Shape only_shape = Shape::point;    ///< of all elements; point where they may differ
    /// What this process shares with others, where the grid and the field are distributed.
    const engine::SharedNodes* shared = nullptr;
    const engine::FarValues* far_values = nullptr;

    bool offers(Feature feature) const { return (features & static_cast<unsigned>(feature)) != 0; }
    /// \throw InvalidInput where the dimension is another one
    void require_dimension(int wanted) const;
    /// Refuses what is not made for distributed grids. \param what "a slice"
    /// \throw InvalidInput where processes share nodes
    void require_one_process(const std::string& what) const;
    /// Drops what only a grid that is on one process can promise, where parts may be elsewhere.
    void drop_promises_of_whole_grids();
};

namespace detail {

/// \throw InvalidInput that says that something is not made for distributed grids
[[noreturn]] void refuse_on_ranks(const std::string& what);

/// \throw GridError that names the rule, which has more children than the grid promises
[[noreturn]] void throw_too_many_children(const Rule& rule, std::size_t most);

/// For whom Hierarchy::bisect() walks. The library derives its visitors from it.
class PatchVisitor {
public:
    /// Whether the walk has values of a function of position in the place of the field's: at a new
    /// node the mean of those at its parents.
    bool takes_means() const { return takes_means_; }

protected:
    explicit PatchVisitor(bool takes_means) : takes_means_{takes_means} {}
    ~PatchVisitor() = default;

private:
    bool takes_means_;
};

/// Bisections told in rows of nodes, as nestgrid.h describes them at `middles`. Elements of the
/// hierarchy are nestgrid_element.
template <class Real>
class BisectionRows {
public:
    using Node = std::uint64_t;
    static constexpr Node no_node = ~Node{0};

    virtual ~BisectionRows() = default;
    /// \param out the nodes halfway between a[i] and b[i], or no_node; may be a
    virtual void middles(std::span<const Node> a, std::span<const Node> b,
                         std::span<Node> out) const = 0;
    virtual void keys(std::span<const Node> nodes, std::span<NodeKey> out) const = 0;
    virtual void positions(std::span<const Node> nodes, std::span<Point> out) const = 0;
    virtual void values(std::span<const Node> nodes, std::span<const NodeKey> keys,
                        std::span<Real> out) const = 0;
    /// Gradients of component 0, where facts().gradients_at_nodes.
    virtual void gradients(std::span<const Node> nodes, std::span<Point> out) const;
};

template <class Real>
void BisectionRows<Real>::gradients(std::span<const Node>, std::span<Point>) const {}

}  // namespace detail

/// A nested grid with a field on it. What it was made of must outlive it.
/// \tparam Real float or double: the type of the values
template <class Real>
class Hierarchy {
public:
    using value_type = Real;

    Hierarchy(const Hierarchy&) = delete;
    Hierarchy& operator=(const Hierarchy&) = delete;
    virtual ~Hierarchy() = default;

    const HierarchyFacts& facts() const { return facts_; }
    bool offers(Feature feature) const { return facts_.offers(feature); }
    virtual std::size_t coarse_count() const = 0;
    /// Changes with the grid.
    virtual std::uint64_t epoch() const = 0;
    /// An empty list for elements of the grid.
    virtual Elements make_elements() const = 0;

    /// A task's state; null where the grid needs none. \throw GridError where the grid has changed
    virtual std::unique_ptr<Task> open() const = 0;

    /// Coarse element i, alone in its family.
    virtual void coarse(Task* task, std::size_t i, Coarse& coarse, Family& family) const = 0;
    /// Values at the corners of coarse element i, component c of corner k at out[k * components +
    /// c]. \return the corners without a value
    virtual NodeMask coarse_values(Task* task, std::size_t i, std::size_t corners,
                                   Real* out) const = 0;
    /// Enters an element.
    /// \param which new nodes whose values are asked for
    /// \param values component c of node n at values[n * components + c]; where facts().decodes,
    ///        the caller sets them at the corners. Set at the new nodes, behind the corners. Null
    ///        where the walk carries no values, and asks for none
    /// \param wanted children that are asked for, one bit each; the others stay undefined
    /// \return the nodes without a value
    virtual NodeMask enter(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                           Real* values, NodeMask wanted, Family& children) const = 0;
    /// Values at new nodes, as enter() gives them, without entering the element.
    virtual NodeMask new_values(Task* task, const Handle& element, const Rule& rule, NodeMask which,
                                Real* values) const = 0;
    /// What the grid itself says of the corners and faces of an element. Each pointer may be null.
    /// \param keys where the grid has own keys
    /// \param positions where it has own positions
    /// \param boundary faces on the boundary of the domain, where it has boundary_faces
    virtual void corners(Task* task, const Handle& element, std::size_t count, NodeKey* keys,
                         Point* positions, unsigned* boundary) const = 0;
    /// True positions of new nodes, where the grid has new_positions.
    virtual void new_positions(Task* task, const Handle& element, NodeMask which,
                               std::span<Point> out) const = 0;
    /// Gradients of component 0 at the corners, where the field has gradients.
    virtual void corner_gradients(Task* task, const Handle& element,
                                  std::span<Point> out) const = 0;
    /// The same at nodes, as from each element at them, where facts().gradients_by_key.
    virtual void node_gradients(std::span<const NodeKey> nodes, std::span<Point> out) const;

    /// The degree of the field on a leaf, where it has degree; else 1.
    virtual int degree(Task* task, const Handle& leaf) const;
    /// The field on a leaf at points of the reference element, where it has degree.
    /// \param out component c of point n at out[n * components + c]
    virtual void evaluate(Task* task, const Handle& leaf, std::span<const Point> reference,
                          Real* out) const;

    /// The degree of the coordinates of points in a leaf, where the grid has geometry_degree; else
    /// 1.
    virtual int geometry_degree(Task* task, const Handle& leaf) const;
    /// Where points of the reference element are, where the grid has geometry_degree.
    virtual void map(Task* task, const Handle& leaf, std::span<const Point> reference,
                     std::span<Point> out) const;

    /// The parents of a node that hangs on an edge, where the grid has hanging_parents.
    virtual std::array<NodeKey, 2> hanging_parents(NodeKey node) const;

    /// Calls function(row) for all star rows (optional.hpp), where facts().knows_stars.
    virtual void star_rows(const std::function<void(const StarRow&)>& function) const;
    /// Values at the nodes first, first + stride, ..., where facts().knows_stars.
    virtual void row_values(NodeKey first, std::size_t stride, std::span<Real> out) const;
    /// The position of a node, where facts().knows_star_positions.
    virtual Point node_position(NodeKey node) const;

    /// The bisections of a grid that tells them in rows; else null.
    virtual const detail::BisectionRows<Real>* bisection_rows() const { return nullptr; }
    /// Walks the bisections below an element in patches, where there are no rows, and
    /// facts().knows_patches or, for visitors that take means, facts().bisects_means.
    virtual void bisect(const Handle& element, detail::PatchVisitor& visitor) const;

protected:
    explicit Hierarchy(const HierarchyFacts& facts) : facts_{facts} {}

    HierarchyFacts facts_;
};

template <class Real>
void Hierarchy<Real>::node_gradients(std::span<const NodeKey>, std::span<Point>) const {}
template <class Real>
int Hierarchy<Real>::degree(Task*, const Handle&) const {
    return 1;
}
template <class Real>
void Hierarchy<Real>::evaluate(Task*, const Handle&, std::span<const Point>, Real*) const {}
template <class Real>
int Hierarchy<Real>::geometry_degree(Task*, const Handle&) const {
    return 1;
}
template <class Real>
void Hierarchy<Real>::map(Task*, const Handle&, std::span<const Point>, std::span<Point>) const {}
template <class Real>
std::array<NodeKey, 2> Hierarchy<Real>::hanging_parents(NodeKey node) const {
    return {node, node};
}
template <class Real>
void Hierarchy<Real>::star_rows(const std::function<void(const StarRow&)>&) const {}
template <class Real>
void Hierarchy<Real>::row_values(NodeKey, std::size_t, std::span<Real>) const {}
template <class Real>
Point Hierarchy<Real>::node_position(NodeKey) const {
    return {};
}
template <class Real>
void Hierarchy<Real>::bisect(const Handle&, detail::PatchVisitor&) const {}

}  // namespace nestgrid
