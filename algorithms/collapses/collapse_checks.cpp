// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/collapse_checks.hpp>

#include <algorithm>

#include <collapses/separated.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

namespace {

/// 1 for an equilateral triangle, 0 for one without area.
double shape_of(const Triangle& x) {
    constexpr double of_equilateral = 3.4641016151377544;  // makes it 1
    const Point a = x[1] - x[0];
    const Point b = x[2] - x[0];
    const Point c = x[2] - x[1];
    return of_equilateral * norm(cross(a, b)) / (dot(a, a) + dot(b, b) + dot(c, c));
}

}  // namespace

void require_limits(double turn, double shape) {
    if (!(turn > 0 && turn < 90)) {
        throw InvalidInput("the greatest turn of a triangle is not between 0 and 90 degrees");
    }
    if (!(shape >= 0 && shape < 1)) {
        throw InvalidInput("the least quality of a triangle is not between 0 and 1");
    }
}

CollapseChecks::CollapseChecks(const BlockMesh& mesh, const CollapseRules& rules, const Box& region)
    : mesh_{&mesh}, rules_{&rules}, region_{region}, in_star_(mesh.triangles.size(), 0) {
    if (rules.distance != nullptr) distance_.emplace(*rules.distance);
    if (!rules.in_place()) sort_into_cells();
}

/// Makes cells as large as the triangles are now, and forgets where they were.
void CollapseChecks::sort_into_cells() {
    std::vector<BoxedTriangle> present;
    for (std::uint32_t t = 0; t < mesh_->triangles.size(); ++t) {
        if (mesh_->triangles[t][0] == BlockMesh::gone) continue;
        present.emplace_back(t, Box::around(mesh_->corners(t)));
    }
    cells_ = TriangleCells(present);
    most_entries_ = 2 * cells_.entry_count() + 1000;
}

void CollapseChecks::note_done(const BlockMesh::Star& star, std::uint32_t vertex, BlockMesh& mesh) {
    if (distance_) {
        auto given = distance_->given().begin();
        for (const StarTriangle& t : star) {
            auto& parts = mesh.parts[t.triangle];
            if (t.goes)
                parts = {};
            else
                parts.swap(*given++);
        }
    }
    if (rules_->in_place()) return;
    for (const std::uint32_t t : mesh_->around(vertex)) {
        cells_.add({t, Box::around(mesh_->corners(t))});
    }
    if (cells_.entry_count() > most_entries_) sort_into_cells();
}

Refusal CollapseChecks::refuse(std::uint32_t u, std::uint32_t v, const BlockMesh::Star& star,
                               const CollapsePlace& place) {
    const Point& w = place.x;
    if (!region_.contains(w) || !keeps_shape(star, w)) return &Collapsed::refused_by_shape;
    const Freedom& of_u = mesh_->vertices[u].freedom;
    const Freedom& of_v = mesh_->vertices[v].freedom;
    if (!rules_->in_place() &&
        !keeps_off_boundary(of_u.count() < of_v.count() ? of_v : of_u, star)) {
        return &Collapsed::refused_by_shape;
    }
    if (!keeps_error(star, place)) return &Collapsed::refused_by_field;
    if (rules_->in_place()) return nullptr;
    if (rules_->strong != nullptr && !keeps_sides(star, w)) return &Collapsed::refused_by_sides;
    if (distance_ && !(keeps_distance(star, w) && keeps_domain(star, w))) {
        return &Collapsed::refused_by_distance;
    }
    if (!crosses_nothing(star, w)) return &Collapsed::refused_by_crossing;
    return nullptr;
}

/// Whether no new triangle lies in the boundary of the domain, where it might touch others.
/// \param freedom of the point that the edge becomes
bool CollapseChecks::keeps_off_boundary(const Freedom& freedom, const BlockMesh::Star& star) const {
    return freedom.free() || std::none_of(star.begin(), star.end(), [&](const StarTriangle& t) {
               return !t.goes && Freedom::may_share_plane(freedom, mesh_->vertices[t.a].freedom,
                                                          mesh_->vertices[t.b].freedom);
           });
}

bool CollapseChecks::keeps_shape(const BlockMesh::Star& star, const Point& w) const {
    double before = 1;
    double after = 1;
    for (const StarTriangle& t : star) {
        before = std::min(before, shape_of(mesh_->corners(t.triangle)));
        if (t.goes) continue;
        const Triangle x{w, mesh_->x(t.a), mesh_->x(t.b)};
        const Point was = mesh_->normal(t.triangle);
        const Point is = cross(x[1] - w, x[2] - w);
        const double product = dot(was, is);
        if (!(product > 0) || product < rules_->least_cosine * norm(was) * norm(is)) return false;
        after = std::min(after, shape_of(x));
    }
    return after >= rules_->least_shape || after >= before;
}

bool CollapseChecks::keeps_error(const BlockMesh::Star& star, const CollapsePlace& place) const {
    if (rules_->coloured) return keeps_colours(star, place);
    return rules_->field == nullptr || keeps_field(star, place.x);
}

bool CollapseChecks::keeps_field(const BlockMesh::Star& star, const Point& w) const {
    boost::container::small_vector<std::uint32_t, 24> number;
    boost::container::small_vector<Point, 24> ring;
    boost::container::small_vector<std::array<std::uint32_t, 2>, 24> sides;
    const auto number_of = [&](std::uint32_t vertex) {
        const auto at = std::find(number.begin(), number.end(), vertex) - number.begin();
        if (static_cast<std::size_t>(at) == number.size()) {
            number.push_back(vertex);
            ring.push_back(mesh_->x(vertex) + rules_->middle);
        }
        return static_cast<std::uint32_t>(at);
    };
    for (const StarTriangle& t : star) {
        if (!t.goes) sides.push_back({number_of(t.a), number_of(t.b)});
    }
    return rules_->field->keeps_fan({.w = w + rules_->middle,
                                     .ring = {ring.data(), ring.size()},
                                     .side = {sides.data(), sides.size()}});
}

bool CollapseChecks::keeps_colours(const BlockMesh::Star& star, const CollapsePlace& place) const {
    const auto colours_of = [&](std::uint32_t vertex) {
        const ColourValues& values = mesh_->vertices[vertex].colours.values();
        return std::span(values.data(), values.size());
    };
    const std::span<const double> at_w(place.colours.data(), place.colours.size());
    return std::all_of(star.begin(), star.end(), [&](const StarTriangle& t) {
        if (t.goes) return true;
        const Triangle x = rules_->in_space({place.x, mesh_->x(t.a), mesh_->x(t.b)});
        return rules_->field->keeps_colours(FlatTriangle(x),
                                            {at_w, colours_of(t.a), colours_of(t.b)});
    });
}

/// The tetrahedra between the old triangles and the new point, in space.
CollapseChecks::Swept CollapseChecks::swept(const BlockMesh::Star& star, const Point& w) const {
    Swept swept;
    for (const StarTriangle& t : star) {
        const auto [a, b, c] = rules_->in_space(mesh_->corners(t.triangle));
        swept.push_back({w + rules_->middle, a, b, c});
    }
    return swept;
}

bool CollapseChecks::keeps_sides(const BlockMesh::Star& star, const Point& w) const {
    const Swept all = swept(star, w);
    Box box;
    for (const Tetrahedron& x : all) box.add(Box::around(x));
    if (!rules_->strong->any_in(box)) return true;
    return std::none_of(all.begin(), all.end(),
                        [&](const Tetrahedron& x) { return rules_->strong->any_in(x); });
}

bool CollapseChecks::keeps_domain(const BlockMesh::Star& star, const Point& w) const {
    const Swept all = swept(star, w);
    return std::all_of(all.begin(), all.end(),
                       [&](const Tetrahedron& x) { return rules_->distance->domain().hold(x); });
}

bool CollapseChecks::keeps_distance(const BlockMesh::Star& star, const Point& w) {
    boost::container::small_vector<Triangle, 24> fan;
    boost::container::small_vector<const std::vector<NearPart>*, 24> parts;
    for (const StarTriangle& t : star) {
        parts.push_back(&mesh_->parts[t.triangle]);
        if (!t.goes) fan.push_back(rules_->in_space({w, mesh_->x(t.a), mesh_->x(t.b)}));
    }
    return distance_->keeps(w + rules_->middle, {fan.data(), fan.size()},
                            {parts.data(), parts.size()});
}

bool CollapseChecks::crosses_nothing(const BlockMesh::Star& star, const Point& w) {
    Box box{w, w};
    boost::container::small_vector<Tetrahedron, 24> swept;
    boost::container::small_vector<Box, 24> box_of;
    for (const StarTriangle& t : star) {
        const auto [a, b, c] = mesh_->corners(t.triangle);
        swept.push_back({w, a, b, c});
        box_of.push_back(Box::around(swept.back()));
        box.add(box_of.back());
        in_star_[t.triangle] = 1;
    }
    bool apart = true;
    cells_.for_each_near(box, [&](std::uint32_t other) {
        if (!apart || in_star_[other] != 0) return;
        if (mesh_->triangles[other][0] == BlockMesh::gone) return;
        const Triangle x = mesh_->corners(other);
        const Box around = Box::around(x);
        if (!around.meets(box)) return;
        for (std::size_t i = 0; i < swept.size() && apart; ++i) {
            apart = !around.meets(box_of[i]) || separated(swept[i], x);
        }
    });
    for (const StarTriangle& t : star) in_star_[t.triangle] = 0;
    return apart && new_star_is_embedded(star, w);
}

/// Whether the new triangles do not cross each other.
bool CollapseChecks::new_star_is_embedded(const BlockMesh::Star& star, const Point& w) const {
    boost::container::small_vector<Triangle, 24> fresh;
    for (const StarTriangle& t : star) {
        if (!t.goes) fresh.push_back({w, mesh_->x(t.a), mesh_->x(t.b)});
    }
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        for (std::size_t j = i + 1; j < fresh.size(); ++j) {
            if (!separated(fresh[i], fresh[j])) return false;
        }
    }
    return true;
}

}  // namespace nestgrid::engine
