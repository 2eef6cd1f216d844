// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A stored grid with fields on it, as files hold them: values at several times, each as they are or
// encoded (compressed_field.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nestgrid/adapters/stored_grid.hpp>
#include <nestgrid/algorithms/compressed_field.hpp>

namespace nestgrid {

/// Values at the nodes, by node number; those of several frames one after the other.
struct NamedField {
    std::string name;
    std::vector<double> values;  ///< one for each node of each frame; none where encoded
    /// One for each frame, where values are encoded.
    std::vector<CompressedValues<double>> encoded{};
};

/// The grid of a .nestgrid file, its fields and the times of its frames.
template <class Family>
struct StoredHierarchy {
    StoredGrid<Family> grid;
    std::vector<NamedField> fields;
    std::vector<double> times{0};  ///< of the frames, finite and ascending

    /// The values of a frame of a field that is not encoded.
    std::span<const double> frame(const NamedField& field, std::size_t i) const {
        return std::span(field.values).subspan(i * grid.node_count(), grid.node_count());
    }
};

/// Options of writing a .nestgrid file: times of the frames, and how values are encoded.
struct StoredFileOptions {
    std::vector<double> times{0};  ///< of the frames, finite and ascending
    /// How values are encoded; nothing: as they are. Nodes that hang lose their values, and have
    /// the mean of their parents when they are decoded.
    std::optional<CompressionOptions> compression{};
};

/// Whether encoded values are decoded when a file is read, or kept as they are.
enum class Encoded { decode, keep };

namespace detail {

/// Decodes values from coarser to finer elements, so that those of all parents are known.
template <class Family>
class Decoder {
public:
    using Grid = StoredGrid<Family>;

    Decoder(const Grid& grid, const CompressedValues<double>& encoded)
        : grid_{grid}, encoded_{encoded}, values_(grid.node_count(), 0) {}

    std::vector<double> run() {
        for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
            const auto coarse = grid_.coarse(i);
            const auto nodes = std::span(coarse.ids).first(topology(coarse.shape).corners);
            std::array<double, max_corners> out;
            encoded_.decode_coarse(nodes, std::span(out).first(nodes.size()));
            for (std::size_t k = 0; k < nodes.size(); ++k) values_[nodes[k]] = out[k];
            visit(coarse.element);
        }
        return std::move(values_);
    }

private:
    void visit(const typename Grid::Element& e) {
        const Rule* const rule = grid_.split(e);
        if (rule == nullptr) return;
        set_new_nodes(e, *rule);
        std::array<typename Grid::Element, static_cast<std::size_t>(Grid::max_children)> child;
        const auto children = std::span(child).first(rule->children.size());
        grid_.children(e, children, context_);
        for (const auto& each : children) visit(each);
    }

    void set_new_nodes(const typename Grid::Element& e, const Rule& rule) {
        std::array<NodeKey, max_new_nodes> keys;
        const auto nodes = std::span(keys).first(rule.new_nodes.size());
        grid_.new_keys(e, nodes, context_);
        NodeMask hanging = 0;
        if constexpr (!Family::conforming) hanging = grid_.constrained(e, context_);
        std::array<double, max_corners> corner;
        std::array<double, max_new_nodes> made;
        const auto corners = std::span(corner).first(static_cast<std::size_t>(rule.corner_count()));
        for (std::size_t k = 0; k < corners.size(); ++k) corner[k] = values_[e.corner[k]];
        encoded_.decode_split(rule, hanging, nodes, corners, std::span(made).first(nodes.size()));
        for (std::size_t n = 0; n < nodes.size(); ++n) values_[nodes[n]] = made[n];
    }

    const Grid& grid_;
    const CompressedValues<double>& encoded_;
    typename Grid::Context context_;
    std::vector<double> values_;
};

}  // namespace detail

/// The values at the nodes of a grid by node number; 0 at numbers that are not in use.
/// \param encoded as many values as the grid has nodes
template <class Family>
std::vector<double> decode(const StoredGrid<Family>& grid,
                           const CompressedValues<double>& encoded) {
    return detail::Decoder<Family>(grid, encoded).run();
}

}  // namespace nestgrid
