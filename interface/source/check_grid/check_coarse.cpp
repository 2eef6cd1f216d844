// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// check_grid: coarse elements, and how they fit together.
#include "grid_checker.hpp"

#include <algorithm>
#include <cmath>

#include <nestgrid/detail/coarse_boundary.hpp>

namespace nestgrid::detail {

namespace {

constexpr const char* in_tensor_order =
    "; its corners are numbered in tensor order, x fastest, and not around";

}  // namespace

void GridChecker::check_coarse(std::size_t i) {
    hierarchy_->coarse(task_.get(), i, coarse_, coarse_family_);
    coarse_number_ = i;
    const std::string who = "coarse element " + std::to_string(i);
    const Topology& t = topology(coarse_.shape);
    const HierarchyFacts& facts = hierarchy_->facts();
    if (t.dimension != facts.dimension) {
        fail(Law::coarse_element, who + " is a " + std::string(t.name) +
                                      " on a grid of dimension " + std::to_string(facts.dimension));
    }
    if (facts.only_shape != Shape::point && coarse_.shape != facts.only_shape) {
        fail(Law::coarse_element, who + " is a " + std::string(t.name) + promise());
    }
    check_corners(who);
    const double volume = measure(coarse_.shape, std::span(coarse_.corners).first(t.corners));
    if (coarse_.orientation != 1 && coarse_.orientation != -1) {
        fail(Law::coarse_element, who + " has an orientation that is neither 1 nor -1");
    }
    if (!((t.dimension == 3 ? coarse_.orientation * volume : volume) > 0)) {
        fail(Law::coarse_element, who + " is flat or inverted under its orientation sign" +
                                      (is_simplex(coarse_.shape) ? "" : in_tensor_order));
    }
    for (std::size_t f = 0; f < t.faces; ++f) {
        NodeKey sum = 0;
        for (std::size_t k = 0; k < t.face[f].corners; ++k) {
            sum += coarse_key(coarse_.ids[t.face[f].corner[k]]);
        }
        FaceUse& use =
            *coarse_faces_
                 .insert(mean_key(sum, t.face[f].corners), {0, static_cast<std::uint32_t>(i)})
                 .first;
        pieces_.join(use.element, static_cast<std::uint32_t>(i));
        if (++use.count > 2) {
            fail(Law::coarse_face, "face " + std::to_string(f) + " of " + who +
                                       " belongs to more than two coarse elements");
        }
    }
}

/// Checks coordinates and ids of the coarse element at hand.
void GridChecker::check_corners(const std::string& who) {
    const std::size_t corners = topology(coarse_.shape).corners;
    const auto& id = coarse_.ids;
    for (std::size_t k = 0; k < corners; ++k) {
        if (!std::isfinite(norm(coarse_.corners[k]))) {
            fail(Law::coarse_element,
                 who + " has a corner " + std::to_string(k) + " whose coordinates are not finite");
        }
        if (std::find(id.begin(), id.begin() + k, id[k]) != id.begin() + k) {
            fail(Law::coarse_element,
                 who + " has the node " + std::to_string(id[k]) + " at two of its corners");
        }
    }
    for (std::size_t k = 0; k < corners; ++k) {
        const Point& x = coarse_.corners[k];
        const auto [at, is_new] = coarse_nodes_.insert({id[k], {x, coarse_number_}});
        if (!is_new && at->second.first != x) {
            fail(Law::coarse_node,
                 "coarse node " + std::to_string(id[k]) + " is at one place in coarse element " +
                     std::to_string(at->second.second) + " and at another in " + who +
                     ": periodic images are different nodes, with ids of their own");
        }
        if (id_at_.try_emplace(x, id[k]).first->second != id[k]) several_ids_at_.insert(x);
    }
}

void GridChecker::check_ids() const {
    if (several_ids_at_.empty()) return;
    const std::string sentence =
        "coarse corners have different ids at " + std::to_string(several_ids_at_.size()) + " of " +
        std::to_string(id_at_.size()) + " places, such as " + text_of(*several_ids_at_.begin()) +
        ": elements share no node there, as at a slit or where each counts its ids itself";
    if (options_->one_id_a_place) fail(Law::coarse_ids, sentence);
    if (options_->notes != nullptr) options_->notes->push_back(sentence);
}

void GridChecker::note_pieces() {
    std::size_t pieces = 0;
    std::uint32_t other = 0;  // the first element that is in another piece than element 0
    for (std::uint32_t i = 0; i < hierarchy_->coarse_count(); ++i) {
        if (pieces_.root(i) != i) continue;
        if (++pieces == 2) other = i;
    }
    if (pieces < 2 || options_->notes == nullptr) return;
    options_->notes->push_back("the ids leave the coarse grid in " + std::to_string(pieces) +
                               " pieces that share no face: coarse element " +
                               std::to_string(other) +
                               " is in another one than coarse element 0. Nothing is continuous "
                               "between pieces");
}

void GridChecker::check_contacts() {
    const auto tell = [&](Law law, const std::string& sentence) {
        if (!options_->contacts) fail(law, sentence);
        if (options_->notes != nullptr) options_->notes->push_back(sentence);
    };
    const std::vector<std::uint8_t> faces = single_faces<double>(*hierarchy_);
    const std::vector<FaceContact> contacts = face_contacts<double>(*hierarchy_, faces);
    for (const FaceContact& contact : contacts) {
        if (contact.is_slit) continue;  // its corners are noted
        tell(Law::coarse_contact,
             contact.text() +
                 ", touch in a part whose corners they do not share: what is drawn there is open");
    }
    for (const auto& sentence : point_contacts<double>(*hierarchy_, faces, contacts)) {
        tell(Law::coarse_contact, sentence);
    }
    for (const auto& sentence : coarse_overlaps<double>(*hierarchy_)) {
        tell(Law::coarse_overlap, sentence);
    }
}

}  // namespace nestgrid::detail
