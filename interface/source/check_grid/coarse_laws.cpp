// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of check_grid: coarse elements, and how they fit together.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <nestgrid/detail/coarse_boundary.hpp>
#include <nestgrid/detail/union_find.hpp>

#include "laws.hpp"

namespace nestgrid::detail {

namespace {

constexpr const char* in_tensor_order =
    "; its corners are numbered in tensor order, x fastest, and not around";

std::string coarse_name(std::size_t i) { return "coarse element " + std::to_string(i); }

/// Coarse elements have the shape that the grid says, finite coordinates and distinct nodes.
class CoarseShapeLaw final : public GridLaw {
public:
    explicit CoarseShapeLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void visit(const Coarse& coarse, std::size_t i) override {
        const Topology& t = topology(coarse.shape);
        const HierarchyFacts& facts = inspection_->facts();
        const std::string what = coarse_name(i) + " is a " + std::string(t.name);
        if (t.dimension != facts.dimension) {
            Inspection::fail(Law::coarse_element,
                             what + " on a grid of dimension " + std::to_string(facts.dimension));
        }
        if (facts.only_shape != Shape::point && coarse.shape != facts.only_shape) {
            Inspection::fail(Law::coarse_element, what + inspection_->broken_promise());
        }
        for (std::size_t k = 0; k < t.corners; ++k) check_corner(coarse, i, k);
    }

private:
    static void check_corner(const Coarse& coarse, std::size_t i, std::size_t k) {
        if (!std::isfinite(norm(coarse.corners[k]))) {
            Inspection::fail(Law::coarse_element, coarse_name(i) + " has a corner " +
                                                      std::to_string(k) +
                                                      " whose coordinates are not finite");
        }
        const auto* const before = coarse.ids.begin() + k;
        if (std::find(coarse.ids.begin(), before, coarse.ids[k]) != before) {
            Inspection::fail(Law::coarse_element, coarse_name(i) + " has the node " +
                                                      std::to_string(coarse.ids[k]) +
                                                      " at two of its corners");
        }
    }

    const Inspection* inspection_;
};

/// One id has one place; one place has one id where the options demand it.
class CoarseNodeLaw final : public GridLaw {
public:
    explicit CoarseNodeLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void visit(const Coarse& coarse, std::size_t i) override {
        for (std::size_t k = 0; k < topology(coarse.shape).corners; ++k) {
            const std::uint64_t id = coarse.ids[k];
            const Point& x = coarse.corners[k];
            const auto [at, is_new] = nodes_.insert({id, {x, i}});
            if (!is_new && at->second.first != x) {
                Inspection::fail(
                    Law::coarse_node,
                    "coarse node " + std::to_string(id) + " is at one place in " +
                        coarse_name(at->second.second) + " and at another in " + coarse_name(i) +
                        ": periodic images are different nodes, with ids of their own");
            }
            if (id_at_.try_emplace(x, id).first->second != id) several_ids_at_.insert(x);
        }
    }

    void finish_coarse() override {
        if (several_ids_at_.empty()) return;
        const std::string sentence =
            "coarse corners have different ids at " + std::to_string(several_ids_at_.size()) +
            " of " + std::to_string(id_at_.size()) + " places, such as " +
            text_of(*several_ids_at_.begin()) +
            ": elements share no node there, as at a slit or where each counts its ids itself";
        if (inspection_->options().one_id_a_place) Inspection::fail(Law::coarse_ids, sentence);
        inspection_->note(sentence);
    }

private:
    const Inspection* inspection_;
    std::map<std::uint64_t, std::pair<Point, std::size_t>> nodes_;  // with an element that has it
    std::map<Point, std::uint64_t> id_at_;                          // of the first corner there
    std::set<Point> several_ids_at_;
};

/// Coarse elements are neither flat nor inverted under their orientation.
class CoarseVolumeLaw final : public GridLaw {
public:
    void visit(const Coarse& coarse, std::size_t i) override {
        const Topology& t = topology(coarse.shape);
        const double volume = measure(coarse.shape, std::span(coarse.corners).first(t.corners));
        if (coarse.orientation != 1 && coarse.orientation != -1) {
            Inspection::fail(Law::coarse_element,
                             coarse_name(i) + " has an orientation that is neither 1 nor -1");
        }
        if (!((t.dimension == 3 ? coarse.orientation * volume : volume) > 0)) {
            Inspection::fail(Law::coarse_element,
                             coarse_name(i) + " is flat or inverted under its orientation sign" +
                                 (is_simplex(coarse.shape) ? "" : in_tensor_order));
        }
    }
};

/// A face has at most two coarse elements; tells of pieces that share no face.
class CoarseFaceLaw final : public GridLaw {
public:
    explicit CoarseFaceLaw(const Inspection& inspection)
        : inspection_{&inspection}, pieces_(inspection.hierarchy().coarse_count()) {}

    void visit(const Coarse& coarse, std::size_t i) override {
        const Topology& t = topology(coarse.shape);
        const auto element = static_cast<std::uint32_t>(i);
        for (std::size_t f = 0; f < t.faces; ++f) {
            NodeKey sum = 0;
            for (std::size_t k = 0; k < t.face[f].corners; ++k) {
                sum += coarse_key(coarse.ids[t.face[f].corner[k]]);
            }
            FaceUse& use = *faces_.insert(mean_key(sum, t.face[f].corners), {0, element}).first;
            pieces_.join(use.element, element);
            if (++use.count <= 2) continue;
            Inspection::fail(Law::coarse_face, "face " + std::to_string(f) + " of " +
                                                   coarse_name(i) +
                                                   " belongs to more than two coarse elements");
        }
    }

    void finish_coarse() override {
        std::size_t pieces = 0;
        std::uint32_t other = 0;  // the first element that is in another piece than element 0
        for (std::uint32_t i = 0; i < inspection_->hierarchy().coarse_count(); ++i) {
            if (pieces_.root(i) != i) continue;
            if (++pieces == 2) other = i;
        }
        if (pieces < 2) return;
        inspection_->note("the ids leave the coarse grid in " + std::to_string(pieces) +
                          " pieces that share no face: " + coarse_name(other) +
                          " is in another one than coarse element 0. Nothing is continuous "
                          "between pieces");
    }

private:
    struct FaceUse {
        int count;              // of coarse elements that have the face
        std::uint32_t element;  // the first one
    };

    const Inspection* inspection_;
    KeyTable<NodeKey, FaceUse> faces_;
    UnionFind pieces_;  // coarse elements that share faces
};

/// Coarse elements that touch share the nodes there, and do not overlap.
class CoarseContactLaw final : public GridLaw {
public:
    explicit CoarseContactLaw(const Inspection& inspection) : inspection_{&inspection} {}

    void finish_coarse() override {
        const Hierarchy<double>& hierarchy = inspection_->hierarchy();
        const std::vector<std::uint8_t> faces = single_faces<double>(hierarchy);
        const std::vector<FaceContact> contacts = face_contacts<double>(hierarchy, faces);
        for (const FaceContact& contact : contacts) {
            if (contact.is_slit) continue;  // its corners are noted
            tell(Law::coarse_contact, contact.text() +
                                          ", touch in a part whose corners they do not share: "
                                          "what is drawn there is open");
        }
        for (const auto& sentence : point_contacts<double>(hierarchy, faces, contacts)) {
            tell(Law::coarse_contact, sentence);
        }
        for (const auto& sentence : coarse_overlaps<double>(hierarchy)) {
            tell(Law::coarse_overlap, sentence);
        }
    }

private:
    void tell(Law law, const std::string& sentence) const {
        if (!inspection_->options().contacts) Inspection::fail(law, sentence);
        inspection_->note(sentence);
    }

    const Inspection* inspection_;
};

}  // namespace

GridLawPointer coarse_shape_law(Inspection& inspection) {
    return std::make_unique<CoarseShapeLaw>(inspection);
}
GridLawPointer coarse_node_law(Inspection& inspection) {
    return std::make_unique<CoarseNodeLaw>(inspection);
}
GridLawPointer coarse_volume_law(Inspection& /*inspection*/) {
    return std::make_unique<CoarseVolumeLaw>();
}
GridLawPointer coarse_face_law(Inspection& inspection) {
    return std::make_unique<CoarseFaceLaw>(inspection);
}
GridLawPointer coarse_contact_law(Inspection& inspection) {
    return std::make_unique<CoarseContactLaw>(inspection);
}

}  // namespace nestgrid::detail
