// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/surface_parts.hpp>

#include <map>

#include <surfaces/merge_at_nodes.hpp>

namespace nestgrid::engine {

namespace {

template <class T>
void put_all(Bytes& out, std::span<const T> all) {
    put(out, static_cast<std::uint32_t>(all.size()));
    for (const T& each : all) put(out, each);
}

template <class T>
std::vector<T> get_all(Reader& in) {
    std::vector<T> all(in.get<std::uint32_t>());
    for (T& each : all) each = in.get<T>();
    return all;
}

std::vector<double> get_attributes(Reader& in, std::size_t stride) {
    std::vector<double> attributes(stride);
    for (double& a : attributes) a = in.get<double>();
    return attributes;
}

}  // namespace

PartSource::PartSource(const Surface<3>& of, std::span<const KeyPair> named,
                       const VerticesAtNodes& at, std::size_t attributes)
    : surface{&of},
      names{named},
      at_nodes{&at},
      stride{attributes},
      entry(of.vertices.size(), dropped) {
    for (std::uint32_t i = 0; i < at.vertex.size(); ++i) entry[at.vertex[i]] = i;
}

std::uint32_t PartWriter::number_of(std::uint32_t vertex) {
    const auto [number, is_new] = number_.insert(vertex, vertex_count_);
    if (!is_new) return *number;
    const PartSource& s = *source_;
    const std::uint32_t entry = s.entry[vertex];
    put(vertices_, s.names[vertex]);
    put(vertices_, s.surface->vertices[vertex]);
    put(vertices_, std::uint8_t{entry != dropped});
    for (std::size_t c = 0; c < s.stride; ++c) {
        put(vertices_, s.surface->attributes[vertex * s.stride + c]);
    }
    if (entry != dropped) {
        put(vertices_, s.at_nodes->node[entry]);
        for (std::size_t c = 0; c < s.stride; ++c) {
            put(vertices_, s.at_nodes->attributes[entry * s.stride + c]);
        }
    }
    return vertex_count_++;
}

void PartWriter::add_triangle(const Surface<3>::Simplex& v, std::uint32_t from) {
    triangles_.push_back({{number_of(v[0]), number_of(v[1]), number_of(v[2])}, from});
}

void PartWriter::add_boundary(const Surface<3>::Ridge& v) {
    boundary_.push_back({number_of(v[0]), number_of(v[1])});
}

void PartWriter::write(Bytes& out) const {
    put(out, vertex_count_);
    out.insert(out.end(), vertices_.begin(), vertices_.end());
    put_all(out, std::span(triangles_));
    put_all(out, std::span(boundary_));
}

PartReader::PartReader(Reader& in, std::size_t stride) : vertices(in.get<std::uint32_t>()) {
    for (PartVertex& v : vertices) {
        v.name = in.get<KeyPair>();
        v.x = in.get<Point>();
        v.at_node = in.get<std::uint8_t>() != 0;
        v.attributes = get_attributes(in, stride);
        if (!v.at_node) continue;
        v.node = in.get<NodePlace>();
        v.of_node = get_attributes(in, stride);
    }
    triangles = get_all<NumberedTriangle>(in);
    boundary = get_all<Surface<3>::Ridge>(in);
}

void JoinedParts::add(int rank, Reader& in) {
    const PartReader part(in, stride_);
    std::vector<std::uint32_t> number;
    for (const PartVertex& v : part.vertices) {
        const auto next = static_cast<std::uint32_t>(names_.size());
        const auto [known, is_new] = number_of_.insert(v.name, next);
        number.push_back(*known);
        if (is_new) {
            names_.push_back(v.name);
            surface_.vertices.push_back(v.x);
            surface_.attributes.insert(surface_.attributes.end(), v.attributes.begin(),
                                       v.attributes.end());
            is_at_node_.push_back(false);
        }
        if (!v.at_node || is_at_node_[number.back()]) continue;
        is_at_node_[number.back()] = true;
        at_nodes_.add(number.back(), v.node, v.of_node);
    }
    for (const NumberedTriangle& t : part.triangles) {
        surface_.simplices.push_back({number[t.v[0]], number[t.v[1]], number[t.v[2]]});
        surface_.element_of.push_back(static_cast<std::uint32_t>(origins_.size()));
        origins_.push_back({rank, t.from});
    }
    for (const auto& [a, b] : part.boundary) surface_.boundary.push_back({number[a], number[b]});
}

void JoinedParts::merge() {
    const std::vector<std::uint32_t> number = merge_at_nodes(surface_, at_nodes_);
    if (number.empty()) return;
    std::vector<KeyPair> names(surface_.vertices.size());
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] != dropped) names[number[v]] = names_[v];
    }
    names_ = std::move(names);
}

void JoinedParts::give_back(Outbox& box) const {
    const VerticesAtNodes merged;
    const PartSource source(surface_, names_, merged, stride_);
    std::map<int, PartWriter> writers;
    RanksOfSides rank_of;
    for (std::size_t t = 0; t < surface_.simplices.size(); ++t) {
        const auto& v = surface_.simplices[t];
        const auto& [rank, from] = origins_[surface_.element_of[t]];
        writers.try_emplace(rank, source).first->second.add_triangle(v, from);
        if (!surface_.boundary.empty()) rank_of.add(v, rank);
    }
    for (const auto& ridge : surface_.boundary) {
        if (const int* const rank = rank_of.find(ridge)) writers.at(*rank).add_boundary(ridge);
    }
    for (const auto& [rank, writer] : writers) writer.write(box.to(rank));
}

}  // namespace nestgrid::engine
