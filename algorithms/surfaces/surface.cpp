// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

template <int dimension>
void Surface<dimension>::clear() {
    vertices.clear();
    normals.clear();
    attributes.clear();
    simplices.clear();
    element_of.clear();
    reference.clear();
    elements.clear();
    shape_of.clear();
    level_of.clear();
    boundary.clear();
}

template <int dimension>
std::size_t Surface<dimension>::memory_bytes() const {
    const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    return bytes(vertices) + bytes(normals) + bytes(attributes) + bytes(simplices) +
           bytes(element_of) + bytes(reference) + elements.memory_bytes() + bytes(shape_of) +
           bytes(level_of) + bytes(boundary);
}

template struct Surface<2>;
template struct Surface<3>;

}  // namespace nestgrid
