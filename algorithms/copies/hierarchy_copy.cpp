// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The record of an element that is split: the number of its rule, its constrained new nodes (two
// words) and those at which no element may stop (two more, where the grid tells them); the numbers
// of its corners and new nodes; the record of each child, or what it is instead; and marks of each
// child, where the grid has hidden elements or boundary faces. Records of elements lie in the order
// of a depth-first walk.
#include <nestgrid/algorithms/hierarchy_copy.hpp>

#include <algorithm>
#include <bit>
#include <deque>
#include <limits>
#include <string>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

// In the place of a child's record.
constexpr std::uint32_t no_record = std::numeric_limits<std::uint32_t>::max();  // a leaf
constexpr std::uint32_t no_element = no_record - 1;                             // masked

constexpr std::uint32_t hidden_bits = 3;  // of a child's marks; its boundary faces lie above
constexpr unsigned first_face = 8;

constexpr NodeMask bit(std::size_t n) { return NodeMask{1} << n; }

NodeMask mask_at(const std::uint32_t* words) { return words[0] | NodeMask{words[1]} << 32U; }

void put_mask(std::vector<std::uint32_t>& words, NodeMask mask) {
    words.push_back(static_cast<std::uint32_t>(mask));
    words.push_back(static_cast<std::uint32_t>(mask >> 32U));
}

[[noreturn]] void refuse(const char* what) {
    throw InvalidInput(std::string("a hierarchy with ") + what + " cannot be copied");
}

void require_copied(const HierarchyFacts& facts) {
    facts.require_one_process("a copy of a hierarchy");
    if (facts.offers(Feature::hanging_parents)) {
        refuse("nodes that hang on edges of other trees (hanging_parents)");
    }
}

HierarchyFacts facts_of(const HierarchyFacts& of) {
    HierarchyFacts facts;
    facts.dimension = of.dimension;
    facts.components = of.components;
    facts.conforming = of.conforming;
    facts.only_shape = of.only_shape;
    const auto keep = [&](Feature feature) {
        facts.features |= of.features & static_cast<unsigned>(feature);
    };
    for (const Feature feature : {Feature::new_positions, Feature::constrained, Feature::masked,
                                  Feature::outside, Feature::boundary_faces, Feature::hidden}) {
        keep(feature);
    }
    facts.features |= static_cast<unsigned>(Feature::own_keys);
    facts.features |= static_cast<unsigned>(Feature::dense_keys);
    if (!facts.offers(Feature::new_positions)) {
        facts.features |= static_cast<unsigned>(Feature::own_positions);
    }
    return facts;
}

}  // namespace

/// Walks what is copied, and appends to the copy.
template <class Real>
class HierarchyCopy<Real>::Copier {
public:
    Copier(const Hierarchy<Real>& of, HierarchyCopy& to)
        : of_{&of},
          to_{&to},
          task_{of.open()},
          components_{static_cast<std::size_t>(of.facts().components)},
          own_keys_{of.offers(Feature::own_keys)},
          own_positions_{of.offers(Feature::own_positions)},
          new_positions_{of.offers(Feature::new_positions)},
          marks_{to.has_marks()} {
        if (of.facts().node_count > 0) to_node(of.facts().node_count - 1);
    }

    void copy_root(std::size_t i) {
        Frame& frame = at(0);
        Root root{};
        of_->coarse(task_.get(), i, root.coarse, frame.family);
        root.own = no_element;
        if ((frame.family.split | frame.family.leaves) != 0) {
            const Member& member = frame.family.members[0];
            const std::size_t corners = topology(root.coarse.shape).corners;
            frame.begin(corners, components_);
            if (!own_keys_) {
                for (std::size_t k = 0; k < corners; ++k) {
                    frame.key[k] = coarse_key(root.coarse.ids[k]);
                }
            } else {
                of_->corners(task_.get(), member.element, corners, frame.key.data(), nullptr,
                             nullptr);
            }
            std::copy_n(root.coarse.corners.begin(), corners, frame.x.begin());
            const NodeMask missing =
                of_->coarse_values(task_.get(), i, corners, frame.value.data());
            for (std::size_t k = 0; k < corners; ++k) {
                frame.node[k] = number_of(frame.key[k]);
                put_value(frame, k, (missing >> k & 1U) != 0);
                to_->position_[frame.node[k]] = frame.x[k];
            }
            std::copy_n(frame.node.begin(), corners, root.node.begin());
            root.marks = marks_of(member, corners);
            root.own = copy(member, frame.family, 0);
        }
        to_->roots_.push_back(root);
    }

private:
    /// One element on the way down: its corners and, behind them, its new nodes.
    struct Frame {
        Family family;  // the element is a member of
        std::vector<NodeKey> key;
        std::vector<Point> x;
        std::vector<Real> value;
        std::vector<std::uint32_t> node;

        void begin(std::size_t nodes, std::size_t components) {
            if (key.size() >= nodes) return;
            key.resize(nodes);
            x.resize(nodes);
            node.resize(nodes);
            value.resize(nodes * components);
        }
    };

    Frame& at(std::size_t depth) {
        while (frames_.size() <= depth) frames_.emplace_back();
        return frames_[depth];
    }

    /// Makes room for all nodes up to one.
    std::uint32_t to_node(std::size_t number) {
        if (number >= no_record) throw GridError("a hierarchy of 2^32 nodes cannot be copied");
        if (number >= to_->position_.size()) {
            to_->position_.resize(number + 1);
            to_->value_.resize((number + 1) * components_);
        }
        return static_cast<std::uint32_t>(number);
    }
    std::uint32_t number_of(NodeKey key) {
        if (of_->facts().node_count > 0) return to_node(static_cast<std::size_t>(key));
        const auto next = static_cast<std::uint32_t>(to_->position_.size());
        const auto [number, is_new] = numbers_.insert(key, next);
        if (is_new) to_node(next);
        return *number;
    }

    void put_value(const Frame& frame, std::size_t n, bool missing) {
        const std::size_t node = frame.node[n];
        if (missing) {
            if (to_->absent_.size() <= node) to_->absent_.resize(node + 1, false);
            to_->absent_[node] = true;
        } else {
            std::copy_n(frame.value.data() + n * components_, components_,
                        to_->value_.data() + node * components_);
        }
    }

    std::uint32_t marks_of(const Member& member, std::size_t corners) {
        unsigned boundary = 0;
        if (of_->offers(Feature::boundary_faces)) {
            of_->corners(task_.get(), member.element, corners, nullptr, nullptr, &boundary);
        }
        return static_cast<std::uint32_t>(member.hidden) | boundary << first_face;
    }

    /// Copies an element, whose corners lie in its frame.
    /// \return its record, or what it is instead
    std::uint32_t copy(const Member& member, const Family& family, std::size_t depth) {
        if (of_->offers(Feature::presence) && member.presence != Presence::here) {
            refuse("elements on other processes");
        }
        if (member.rule == nullptr) {
            require_linear(member.element);
            return no_record;
        }
        const Rule& rule = *member.rule;
        Frame& frame = at(depth);
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        const std::size_t count = rule.new_nodes.size();
        frame.begin(corners + count, components_);
        put_new_keys(member, family, frame);
        Frame& below = at(depth + 1);
        const NodeMask constrained =
            of_->offers(Feature::constrained) ? member.constrained : NodeMask{0};
        const NodeMask asked = rule.all() & ~constrained;
        const NodeMask all =
            rule.children.size() < 64 ? bit(rule.children.size()) - 1 : ~NodeMask{0};
        const NodeMask missing = of_->enter(task_.get(), member.element, rule, asked,
                                            frame.value.data(), all, below.family);
        put_new_positions(member, asked, frame);
        for (std::size_t n = corners; n < corners + count; ++n) {
            frame.node[n] = number_of(frame.key[n]);
            if ((constrained >> (n - corners) & 1U) != 0) {
                interpolate(rule, n, frame);
            } else {
                put_value(frame, n, (missing >> (n - corners) & 1U) != 0);
            }
            to_->position_[frame.node[n]] = frame.x[n];
        }
        return copy_children(member, constrained, depth);
    }

    void put_new_keys(const Member& member, const Family& family, Frame& frame) const {
        const Rule& rule = *member.rule;
        NodeKey* const made = frame.key.data() + rule.corner_count();
        if (own_keys_) {
            std::ranges::copy(family.new_keys(member), made);
            return;
        }
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            made[n] = derived_key(rule.new_nodes[n], frame.key.data());
        }
    }

    void require_linear(const Handle& leaf) {
        if (of_->offers(Feature::degree) && of_->degree(task_.get(), leaf) > 1) {
            refuse("data of higher degree");
        }
        if (of_->offers(Feature::geometry_degree) && of_->geometry_degree(task_.get(), leaf) > 1) {
            refuse("curved leaves");
        }
    }

    void interpolate(const Rule& rule, std::size_t n, Frame& frame) const {
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        for (std::size_t c = 0; c < components_; ++c) {
            frame.value[n * components_ + c] = detail::interpolate(
                rule.new_nodes[n - corners], frame.value.data() + c, components_);
        }
    }

    /// Sets the positions of new nodes; the children set them anew where the grid has own ones.
    void put_new_positions(const Member& member, NodeMask asked, Frame& frame) {
        const Rule& rule = *member.rule;
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        const std::size_t count = rule.new_nodes.size();
        const NodeMask given = new_positions_ ? asked : NodeMask{0};
        if (given != 0) {
            of_->new_positions(task_.get(), member.element, given,
                               {frame.x.data() + corners, count});
        }
        for (std::size_t n = 0; n < count; ++n) {
            if ((given >> n & 1U) != 0) continue;
            frame.x[corners + n] = detail::interpolate(rule.new_nodes[n], frame.x.data());
        }
    }

    /// Writes the record of an element, and copies its children.
    std::uint32_t copy_children(const Member& member, NodeMask constrained, std::size_t depth) {
        const Rule& rule = *member.rule;
        Frame& frame = at(depth);
        Frame& below = at(depth + 1);
        std::vector<std::uint32_t>& words = to_->words_;
        const std::size_t nodes =
            static_cast<std::size_t>(rule.corner_count()) + rule.new_nodes.size();
        const std::size_t children = rule.children.size();
        const std::size_t size = 5 + nodes + (marks_ ? 2 : 1) * children;
        if (words.size() + size >= no_element) {
            throw GridError("a hierarchy cannot be copied that takes 16 GB");
        }
        const auto record = static_cast<std::uint32_t>(words.size());
        words.push_back(number_of(rule));
        put_mask(words, constrained);
        if (of_->offers(Feature::outside)) put_mask(words, member.outside);
        words.insert(words.end(), frame.node.begin(),
                     frame.node.begin() + static_cast<std::ptrdiff_t>(nodes));
        const std::size_t first_child = words.size();
        words.resize(first_child + (marks_ ? 2 : 1) * children, 0);
        const NodeMask there = below.family.split | below.family.leaves;
        for (std::size_t c = 0; c < children; ++c) {
            words[first_child + c] = no_element;
            if ((there >> c & 1U) == 0) continue;
            const Member& of = below.family.members[c];
            take_corners(rule.children[c], of, frame, below);
            if (marks_) {
                words[first_child + children + c] =
                    marks_of(of, topology(rule.children[c].shape).corners);
            }
            const std::uint32_t child = copy(of, below.family, depth + 1);
            words[first_child + c] = child;  // only now, because memory may have moved
        }
        return record;
    }

    /// Puts the corners of a child into its frame.
    void take_corners(const Child& as, const Member& member, const Frame& father, Frame& frame) {
        const std::size_t corners = topology(as.shape).corners;
        frame.begin(corners, components_);
        for (std::size_t k = 0; k < corners; ++k) {
            const std::size_t from = as.corner[k];
            frame.key[k] = father.key[from];
            frame.x[k] = father.x[from];
            frame.node[k] = father.node[from];
            std::copy_n(father.value.data() + from * components_, components_,
                        frame.value.data() + k * components_);
        }
        if (!own_positions_) return;
        of_->corners(task_.get(), member.element, corners, nullptr, frame.x.data(), nullptr);
        for (std::size_t k = 0; k < corners; ++k) to_->position_[frame.node[k]] = frame.x[k];
    }

    std::uint32_t number_of(const Rule& rule) {
        std::vector<const Rule*>& rules = to_->rules_;
        const auto number = std::ranges::find(rules, &rule) - rules.begin();
        if (static_cast<std::size_t>(number) == rules.size()) rules.push_back(&rule);
        return static_cast<std::uint32_t>(number);
    }

    const Hierarchy<Real>* of_;
    HierarchyCopy* to_;
    std::unique_ptr<Task> task_;
    std::size_t components_;
    bool own_keys_;
    bool own_positions_;
    bool new_positions_;
    bool marks_;
    std::deque<Frame> frames_;                  // by depth
    KeyTable<NodeKey, std::uint32_t> numbers_;  // of nodes, where keys are not dense
};

template <class Real>
HierarchyCopy<Real>::HierarchyCopy(const Hierarchy<Real>& of)
    : Hierarchy<Real>((require_copied(of.facts()), facts_of(of.facts()))), epoch_{of.epoch()} {
    Copier copier(of, *this);
    roots_.reserve(of.coarse_count());
    for (std::size_t i = 0; i < of.coarse_count(); ++i) copier.copy_root(i);
    this->facts_.node_count = position_.size();
    words_.shrink_to_fit();
    position_.shrink_to_fit();
    value_.shrink_to_fit();
}

template <class Real>
std::size_t HierarchyCopy<Real>::memory_bytes() const {
    return roots_.capacity() * sizeof(Root) + words_.capacity() * sizeof(std::uint32_t) +
           position_.capacity() * sizeof(Point) + value_.capacity() * sizeof(Real) +
           absent_.capacity() / 8;
}

template <class Real>
const std::uint32_t* HierarchyCopy<Real>::nodes_of(std::uint32_t record) const {
    return words_.data() + record + (this->offers(Feature::outside) ? 5 : 3);
}

/// Sets a member of a family.
template <class Real>
void HierarchyCopy<Real>::describe(const CopiedElement& element, std::uint32_t marks, std::size_t c,
                                   Family& family) const {
    Member& member = family.members[c];
    detail::set_handle(member.element, element);
    member.hidden = static_cast<Hidden>(marks & hidden_bits);
    if (member.hidden == Hidden::wholly) family.hidden |= bit(c);
    if (element.own == no_record) {
        member.rule = nullptr;
        family.leaves |= bit(c);
        return;
    }
    const Rule& rule = rule_of(element.own);
    member.rule = &rule;
    family.split |= bit(c);
    const std::uint32_t* const record = words_.data() + element.own;
    member.constrained = mask_at(record + 1);
    if (this->offers(Feature::outside)) member.outside = mask_at(record + 3);
    const std::size_t count = rule.new_nodes.size();
    const std::uint32_t* const made = nodes_of(element.own) + rule.corner_count();
    member.first_key = static_cast<std::uint32_t>(family.key_count);
    const std::span<NodeKey> keys = family.add_keys(count, 0);
    for (std::size_t n = 0; n < count; ++n) keys[n] = made[n];
}

template <class Real>
NodeMask HierarchyCopy<Real>::values_at(const std::uint32_t* nodes, NodeMask which,
                                        Real* out) const {
    const auto components = static_cast<std::size_t>(this->facts_.components);
    NodeMask missing = 0;
    for (NodeMask left = which; left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        const std::size_t node = nodes[n];
        for (std::size_t c = 0; c < components; ++c) {
            out[n * components + c] = value_[node * components + c];
        }
        if (node < absent_.size() && absent_[node]) missing |= bit(n);
    }
    return missing;
}

template <class Real>
void HierarchyCopy<Real>::coarse(Task*, std::size_t i, Coarse& coarse, Family& family) const {
    const Root& root = roots_[i];
    coarse = root.coarse;
    family.begin(1);
    if (root.own == no_element) return;
    describe({no_record, root.own, static_cast<std::uint32_t>(i)}, root.marks, 0, family);
}

template <class Real>
NodeMask HierarchyCopy<Real>::coarse_values(Task*, std::size_t i, std::size_t corners,
                                            Real* out) const {
    return values_at(roots_[i].node.data(), bit(corners) - 1, out);
}

template <class Real>
NodeMask HierarchyCopy<Real>::enter(Task* task, const Handle& element, const Rule& rule,
                                    NodeMask which, Real* values, NodeMask wanted,
                                    Family& family) const {
    const auto& e = detail::element_of<CopiedElement>(element);
    const NodeMask missing = which == 0 ? 0 : new_values(task, element, rule, which, values);
    const std::size_t children = rule.children.size();
    const std::uint32_t* const child =
        nodes_of(e.own) + static_cast<std::size_t>(rule.corner_count()) + rule.new_nodes.size();
    const bool marks = has_marks();
    family.begin(children);
    for (std::size_t c = 0; c < children; ++c) {
        if ((wanted >> c & 1U) == 0 || child[c] == no_element) continue;
        describe({e.own, child[c], static_cast<std::uint32_t>(c)}, marks ? child[children + c] : 0,
                 c, family);
    }
    return missing;
}

template <class Real>
NodeMask HierarchyCopy<Real>::new_values(Task*, const Handle& element, const Rule& rule,
                                         NodeMask which, Real* values) const {
    const auto& e = detail::element_of<CopiedElement>(element);
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    return values_at(nodes_of(e.own) + corners, which,
                     values + corners * static_cast<std::size_t>(this->facts_.components));
}

template <class Real>
void HierarchyCopy<Real>::corners(Task*, const Handle& element, std::size_t count, NodeKey* keys,
                                  Point* positions, unsigned* boundary) const {
    const auto& e = detail::element_of<CopiedElement>(element);
    const bool is_coarse = e.father == no_record;
    const Rule* const made_by = is_coarse ? nullptr : &rule_of(e.father);
    const std::uint32_t* const nodes =
        is_coarse ? roots_[e.number].node.data() : nodes_of(e.father);
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t node =
            nodes[is_coarse ? k : std::size_t{made_by->children[e.number].corner[k]}];
        if (keys != nullptr) keys[k] = node;
        if (positions != nullptr) positions[k] = position_[node];
    }
    if (boundary == nullptr) return;
    const std::uint32_t* const marks = is_coarse ? &roots_[e.number].marks
                                                 : nodes + made_by->corner_count() +
                                                       made_by->new_nodes.size() +
                                                       made_by->children.size() + e.number;
    *boundary = *marks >> first_face;
}

template <class Real>
void HierarchyCopy<Real>::new_positions(Task*, const Handle& element, NodeMask which,
                                        std::span<Point> out) const {
    const auto& e = detail::element_of<CopiedElement>(element);
    const std::uint32_t* const made = nodes_of(e.own) + rule_of(e.own).corner_count();
    for (NodeMask left = which; left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        out[n] = position_[made[n]];
    }
}

template class HierarchyCopy<float>;
template class HierarchyCopy<double>;

}  // namespace nestgrid
