// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/hidden_neighbours.hpp>

namespace nestgrid::engine {

namespace {

using FaceKeys = std::array<NodeKey, max_faces>;

unsigned all_faces(Shape shape) { return (1U << topology(shape).faces) - 1; }

/// The keys of the faces of an element.
template <class Real>
FaceKeys face_keys(const Walk<Real>& walk, const ElementView<Real>& view) {
    std::array<NodeKey, max_corners> node{};
    walk.corners(view, node.data(), nullptr);
    const Topology& t = view.topology();
    FaceKeys keys{};
    for (std::size_t f = 0; f < t.faces; ++f) {
        FaceKey key;
        for (std::size_t i = 0; i < t.face[f].corners; ++i)
            key.add_corner(node[t.face[f].corner[i]]);
        keys[f] = key.key();
    }
    return keys;
}

/// Marks the faces of hidden elements whose fathers are hidden in part, and those around them.
template <class Real>
class HiddenFaceSearch final : public Visitor<Real> {
public:
    using View = ElementView<Real>;

    HiddenFaceSearch(const Walk<Real>& walk, HiddenFaces& faces) : walk_{&walk}, faces_{&faces} {}

    bool sees_hidden() const override { return true; }
    Decision inspect(const View& view, const Split&) override {
        const Hidden hidden = view.member->hidden;
        if (hidden == Hidden::partly) return {};
        open_to(view);
        const unsigned faces = hidden == Hidden::wholly ? all_faces(view.shape) : 0U;
        if (faces != 0)
            open_.push_back(opened(view, faces));
        else if (!open_.empty())
            uncover(*view.as);
        if (faces != 0) close_to(open_.size() - 1);
        return {Visit::skip, 0};
    }
    void extract(const View&) override {}
    void finish() { close_to(0); }

private:
    /// An element to whose faces more may come.
    struct Open {
        NodeKey path;
        const Child* as;  // null for a coarse element
        Shape shape;
        FaceKeys key;
        unsigned some;   // faces of which a part is that of hidden elements below, one bit each
        unsigned whole;  // faces of which no part is known not to be
    };

    Open opened(const View& view, unsigned some) const {
        return {
            view.path, view.as, view.shape, face_keys(*walk_, view), some, all_faces(view.shape)};
    }
    /// Opens the fathers of an element, and closes all others.
    void open_to(const View& view) {
        const View* const father = view.father;
        const auto depth = static_cast<std::size_t>(view.level);
        if (father == nullptr) return close_to(0);
        if (depth <= open_.size() && open_[depth - 1].path == father->path) return close_to(depth);
        open_to(*father);
        open_.push_back(opened(*father, 0));
        const NodeMask there = view.family->split | view.family->leaves;
        const auto& children = view.made_by->children;
        for (std::size_t c = 0; c < children.size(); ++c) {
            if ((there >> c & 1U) == 0) uncover(children[c]);
        }
    }
    /// Takes a part of the innermost open element that is not hidden.
    void uncover(const Child& part) { cover(part, 0, 0); }
    void cover(const Child& part, unsigned some, unsigned whole) {
        Open& father = open_.back();
        for (std::size_t f = 0; f < topology(part.shape).faces; ++f) {
            const std::uint8_t g = part.parent_face[f];
            if (g == no_face) continue;
            father.some |= (some >> f & 1U) << g;
            if ((whole >> f & 1U) == 0) father.whole &= ~(1U << g);
        }
    }
    void close_to(std::size_t depth) {
        while (open_.size() > depth) {
            const Open closed = open_.back();
            open_.pop_back();
            for (std::size_t f = 0; f < topology(closed.shape).faces; ++f) {
                if ((closed.some >> f & 1U) == 0) continue;
                const bool whole = (closed.whole >> f & 1U) != 0;
                faces_->add(closed.key[f],
                            whole ? HiddenFaces::some | HiddenFaces::whole : HiddenFaces::some);
            }
            if (!open_.empty()) cover(*closed.as, closed.some, closed.some & closed.whole);
        }
    }

    const Walk<Real>* walk_;
    HiddenFaces* faces_;
    std::vector<Open> open_;
};

/// Marks the faces of leaves that are shown of which a part is that of hidden elements.
template <class Real>
class ShownLeafSearch final : public Visitor<Real> {
public:
    using View = ElementView<Real>;

    ShownLeafSearch(const Walk<Real>& walk, std::shared_ptr<const HiddenFaces> faces)
        : walk_{&walk}, neighbours_(walk, std::move(faces)) {}

    Decision inspect(const View& view, const Split&) override {
        if (view.member->hidden == Hidden::partly) return {};
        return {neighbours_.of(view).part != 0 ? Visit::descend : Visit::skip, 0};
    }
    void extract(const View& view) override {
        const FaceKeys keys = face_keys(*walk_, view);
        const unsigned part = neighbours_.of(view).part;
        for (std::size_t f = 0; f < view.topology().faces; ++f) {
            if ((part >> f & 1U) != 0) found.push_back(keys[f]);
        }
    }

    std::vector<NodeKey> found;

private:
    const Walk<Real>* walk_;
    HiddenNeighbours<Real> neighbours_;
};

}  // namespace

template <class Real>
HiddenFaces::HiddenFaces(const Hierarchy<Real>& hierarchy) {
    const Walk<Real> walk(hierarchy, {.values = false, .keys = true});
    HiddenFaceSearch<Real> hidden(walk, *this);
    walk.run(hidden);
    hidden.finish();
    if (hierarchy.facts().conforming) return;
    const auto borrowed = std::shared_ptr<const HiddenFaces>(std::shared_ptr<void>{}, this);
    ShownLeafSearch<Real> leaves(walk, borrowed);
    walk.run(leaves);
    for (const NodeKey face : leaves.found) add(face, leaf);
    any_leaf_ = !leaves.found.empty();
}

template <class Real>
const HiddenBeyond& HiddenNeighbours<Real>::of(const View& view) {
    const auto level = static_cast<std::size_t>(view.level);
    if (levels_.size() <= level) levels_.resize(level + 1);
    if (!levels_[level].known || levels_[level].path != view.path) {
        levels_[level] = {view.path, true, find(view)};
    }
    return levels_[level].beyond;
}

/// A face inside a face of the father beyond which all is hidden, or a leaf is shown, has the same
/// beyond it. Other faces are looked up where something may be hidden there.
template <class Real>
HiddenBeyond HiddenNeighbours<Real>::find(const View& view) {
    const HiddenBeyond above = view.father == nullptr ? HiddenBeyond{} : of(*view.father);
    const bool beside_hidden =
        view.father == nullptr || view.father->member->hidden == Hidden::partly;
    const bool hidden = view.member->hidden == Hidden::wholly;
    FaceKeys keys{};
    if (beside_hidden || above.part != 0) keys = face_keys(*walk_, view);
    HiddenBeyond beyond;
    for (std::size_t f = 0; f < view.topology().faces; ++f) {
        const std::uint8_t g = view.as == nullptr ? no_face : view.as->parent_face[f];
        const auto in = [&](std::uint8_t faces) { return g != no_face && (faces >> g & 1U) != 0; };
        const HiddenFaces::Flags flags =
            beside_hidden || in(above.part) ? faces_->find(keys[f]) : 0;
        const bool whole = in(above.whole) || (flags & HiddenFaces::whole) != 0;
        const bool leaf = in(above.leaf) || (flags & HiddenFaces::leaf) != 0;
        const auto bit = static_cast<std::uint8_t>(1U << f);
        if (whole && !hidden) beyond.whole |= bit;
        if (!whole && !hidden && flags != 0) beyond.part |= bit;
        if (leaf && view.member->hidden != Hidden::not_at_all) beyond.leaf |= bit;
    }
    return beyond;
}

template HiddenFaces::HiddenFaces(const Hierarchy<float>&);
template HiddenFaces::HiddenFaces(const Hierarchy<double>&);
template class HiddenNeighbours<float>;
template class HiddenNeighbours<double>;

}  // namespace nestgrid::engine
