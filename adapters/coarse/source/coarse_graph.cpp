// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Boost.Graph does the work; no header includes it, for it costs the compiler seconds.
#include <nestgrid/adapters/coarse_graph.hpp>

#include <algorithm>
#include <iterator>
#include <tuple>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/cuthill_mckee_ordering.hpp>
#include <boost/graph/sequential_vertex_coloring.hpp>
#include <boost/graph/topological_sort.hpp>

namespace nestgrid {

namespace {

/// Elements are vertices; an edge is an inner face.
struct SharedFace {
    CoarseFace face;
    bool turned = false;  ///< both elements run through it in the same sense
};
/// Elements as vertices of a graph, joined where they have a face in common.
using DualGraph =
    boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS,
                          boost::property<boost::vertex_color_t, boost::default_color_type,
                                          boost::property<boost::vertex_degree_t, std::size_t>>,
                          SharedFace>;

std::string name_of(const CoarseFace& face) {
    std::string text;
    for (std::size_t i = 0; i < 4 && face.nodes[i] != 0xFFFFFFFFU; ++i) {
        text += (i == 0 ? "" : "-") + std::to_string(face.nodes[i]);
    }
    return text;
}

DualGraph dual_graph(const CoarseGrid& grid) {
    DualGraph graph(grid.element_count());
    detail::for_each_inner_face(grid, [&](const CoarseFace& a, const CoarseFace& b) {
        boost::add_edge(a.element, b.element, SharedFace{a, a.odd == b.odd}, graph);
    });
    return graph;
}

/// Carries an orientation from element to element.
class Orienter : public boost::default_bfs_visitor {
public:
    explicit Orienter(std::vector<signed char>& sign) : sign_{&sign} {}

    template <class Edge>
    void tree_edge(const Edge& edge, const DualGraph& graph) const {
        (*sign_)[boost::target(edge, graph)] = wanted(edge, graph);
    }
    template <class Edge>
    void non_tree_edge(const Edge& edge, const DualGraph& graph) const {
        const auto to = boost::target(edge, graph);
        if ((*sign_)[to] == wanted(edge, graph)) return;
        throw InvalidInput(
            "the surface cannot be oriented (it contains a Moebius strip): the elements " +
            std::to_string(boost::source(edge, graph)) + " and " + std::to_string(to) +
            " disagree at the edge " + name_of(graph[edge].face));
    }

private:
    template <class Edge>
    signed char wanted(const Edge& edge, const DualGraph& graph) const {
        const signed char from = (*sign_)[boost::source(edge, graph)];
        return static_cast<signed char>(graph[edge].turned ? -from : from);
    }

    std::vector<signed char>* sign_;
};

}  // namespace

namespace detail {

std::vector<CoarseFace> sorted_faces(const CoarseGrid& grid) {
    std::vector<CoarseFace> faces;
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        const Topology& t = topology(grid.shapes[e]);
        const auto nodes = grid.element(e);
        for (std::size_t f = 0; f < t.faces; ++f) {
            CoarseFace face;
            face.nodes.fill(0xFFFFFFFFU);
            face.element = static_cast<std::uint32_t>(e);
            face.face = static_cast<std::uint8_t>(f);
            const std::size_t n = t.face[f].corners;
            for (std::size_t i = 0; i < n; ++i) face.nodes[i] = nodes[t.face[f].corner[i]];
            // The loop, turned so that the least node comes first, starts to the lower neighbour
            // or to the higher one.
            const auto least = static_cast<std::size_t>(
                std::min_element(face.nodes.begin(), face.nodes.begin() + static_cast<int>(n)) -
                face.nodes.begin());
            face.odd =
                n == 2 ? least == 1 : face.nodes[(least + 1) % n] > face.nodes[(least + n - 1) % n];
            std::sort(face.nodes.begin(), face.nodes.end());
            faces.push_back(face);
        }
    }
    std::sort(faces.begin(), faces.end(), [](const CoarseFace& a, const CoarseFace& b) {
        return std::tie(a.nodes, a.element) < std::tie(b.nodes, b.element);
    });
    return faces;
}

void for_each_inner_face(
    const CoarseGrid& grid,
    const std::function<void(const CoarseFace&, const CoarseFace&)>& function) {
    const std::vector<CoarseFace> faces = sorted_faces(grid);
    for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
        if (faces[i].nodes != faces[i + 1].nodes) continue;
        if (i + 2 < faces.size() && faces[i].nodes == faces[i + 2].nodes) {
            throw InvalidInput("not a manifold: the elements " + std::to_string(faces[i].element) +
                               ", " + std::to_string(faces[i + 1].element) + " and " +
                               std::to_string(faces[i + 2].element) + " share the " +
                               (grid.dimension == 2 ? "edge " : "face ") + name_of(faces[i]));
        }
        function(faces[i], faces[i + 1]);
    }
}

}  // namespace detail

std::pair<std::vector<int>, int> components(const CoarseGrid& grid) {
    std::vector<int> component(grid.element_count());
    if (component.empty()) return {component, 0};
    const int count = boost::connected_components(dual_graph(grid), component.data());
    return {component, count};
}

void mirror(Shape shape, std::span<std::uint32_t> corners) {
    std::swap(corners[1], corners[2]);
    if (shape == Shape::prism) std::swap(corners[4], corners[5]);
    if (shape == Shape::hexahedron) std::swap(corners[5], corners[6]);
}

std::size_t orient(CoarseGrid& grid) {
    DualGraph graph = dual_graph(grid);
    std::vector<signed char> sign(grid.element_count(), 0);
    const Orienter visitor(sign);
    boost::queue<std::size_t> queue;
    const auto colour = boost::get(boost::vertex_color, graph);
    for (std::size_t seed = 0; seed < grid.element_count(); ++seed) {
        if (sign[seed] != 0) continue;
        sign[seed] = 1;
        boost::breadth_first_visit(graph, seed, queue, visitor, colour);
    }
    std::size_t turned = 0;
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        if (sign[e] > 0) continue;
        mirror(grid.shapes[e], grid.element(e));
        ++turned;
    }
    return turned;
}

std::vector<std::uint32_t> reverse_cuthill_mckee(const CoarseGrid& grid) {
    DualGraph graph = dual_graph(grid);
    std::vector<std::uint32_t> order(grid.element_count());
    boost::cuthill_mckee_ordering(graph, order.rbegin(), boost::get(boost::vertex_color, graph),
                                  boost::make_degree_map(graph));
    return order;
}

CoarseGrid reordered(const CoarseGrid& grid, std::span<const std::uint32_t> order) {
    CoarseGrid result;
    result.dimension = grid.dimension;
    result.nodes = grid.nodes;
    for (const std::uint32_t e : order) result.add(grid.shapes[e], grid.element(e));
    return result;
}

std::vector<std::uint32_t> node_colours(const CoarseGrid& grid) {
    using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        const auto nodes = grid.element(e);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                edges.emplace_back(std::min(nodes[i], nodes[k]), std::max(nodes[i], nodes[k]));
            }
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const Graph graph(edges.begin(), edges.end(), grid.nodes.size());
    std::vector<std::uint32_t> colour(grid.nodes.size());
    if (!colour.empty()) {
        boost::sequential_vertex_coloring(
            graph, boost::make_iterator_property_map(colour.begin(),
                                                     boost::get(boost::vertex_index, graph)));
    }
    return colour;
}

bool has_common_order(const CoarseGrid& grid) {
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> graph(grid.nodes.size());
    for (std::size_t e = 0; e < grid.element_count(); ++e) {
        const auto nodes = grid.element(e);
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
            boost::add_edge(nodes[i], nodes[i + 1], graph);
        }
    }
    std::vector<std::size_t> order;
    try {
        boost::topological_sort(graph, std::back_inserter(order));
    } catch (const boost::not_a_dag&) {
        return false;
    }
    return true;
}

}  // namespace nestgrid
