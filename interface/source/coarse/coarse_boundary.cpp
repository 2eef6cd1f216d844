// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/detail/coarse_boundary.hpp>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::detail {

template <class Real>
std::vector<std::uint8_t> single_faces(const Hierarchy<Real>& hierarchy) {
    struct Use {
        std::size_t element;
        std::uint8_t face;
        bool once;
    };
    const std::unique_ptr<Task> task = hierarchy.open();
    const int dimension = hierarchy.facts().dimension;
    std::vector<std::uint8_t> single(hierarchy.coarse_count(), 0);
    KeyTable<NodeKey, Use> faces;
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < single.size(); ++i) {
        hierarchy.coarse(task.get(), i, coarse, family);
        const Topology& t = topology(coarse.shape);
        if (t.dimension != dimension) {
            throw GridError("coarse element " + std::to_string(i) + " is a " + std::string(t.name) +
                            ", but the grid has dimension " + std::to_string(dimension));
        }
        for (std::uint8_t f = 0; f < t.faces; ++f) {
            NodeKey sum = 0;
            for (std::size_t k = 0; k < t.face[f].corners; ++k) {
                sum += coarse_key(coarse.ids[t.face[f].corner[k]]);
            }
            const auto [use, is_new] = faces.insert(mean_key(sum, t.face[f].corners), {i, f, true});
            if (!is_new) use->once = false;
        }
    }
    faces.for_each([&](const NodeKey&, const Use& use) {
        if (use.once) single[use.element] |= static_cast<std::uint8_t>(1U << use.face);
    });
    return single;
}

template <class Real>
std::vector<std::uint8_t> coarse_boundary(const Hierarchy<Real>& hierarchy) {
    std::vector<std::uint8_t> boundary = single_faces(hierarchy);
    for (const FaceContact& contact : face_contacts<Real>(hierarchy, boundary)) {
        for (std::size_t side = 0; side < 2 && !contact.is_slit; ++side) {
            boundary[contact.element[side]] &=
                static_cast<std::uint8_t>(~(1U << contact.face[side]));
        }
    }
    return boundary;
}

template std::vector<std::uint8_t> single_faces(const Hierarchy<float>&);
template std::vector<std::uint8_t> single_faces(const Hierarchy<double>&);
template std::vector<std::uint8_t> coarse_boundary(const Hierarchy<float>&);
template std::vector<std::uint8_t> coarse_boundary(const Hierarchy<double>&);

}  // namespace nestgrid::detail
