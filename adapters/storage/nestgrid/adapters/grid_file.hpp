// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A stored grid in a file, and what the file must hold before anything is done with it.
#pragma once

#include <bit>

#include <nestgrid/adapters/file_bytes.hpp>
#include <nestgrid/adapters/stored_grid.hpp>

namespace nestgrid::detail {

/// Reading and writing what a StoredGrid keeps private.
template <class Family>
class GridFile {
public:
    using Grid = StoredGrid<Family>;

    static void write(const Grid& grid, Writer& out) {
        const CoarseGrid& coarse = grid.coarse_;
        out.put(static_cast<std::uint64_t>(coarse.nodes.size()));
        for (std::size_t i = 0; i < coarse.nodes.size(); ++i) out.put(coarse.nodes[i]);
        out.put_all(coarse.shapes);
        out.put_all(coarse.corners);
        out.put_all(grid.orientation_);
        std::vector<std::uint64_t> rules;
        for (std::size_t r = 1; r < grid.table_.rule_count(); ++r) {
            rules.push_back(grid.table_.rule(r).descriptor);
        }
        out.put_all(rules);
        out.put(static_cast<std::uint64_t>(grid.table_.size() - shape_count));
        for (std::size_t p = shape_count; p < grid.table_.size(); ++p) {
            out.put_all(grid.table_[p].tree);
        }
        out.put(static_cast<std::uint64_t>(grid.node_count_));
        out.put(static_cast<std::uint64_t>(grid.leaf_count_));
        out.put_all(grid.root_);
        out.put_all(grid.words_);
        out.put_all(grid.hanging_);
        std::vector<bool> used(grid.node_count_, false);
        std::fill_n(used.begin(), coarse.nodes.size(), true);
        grid.for_each_leaf([&](const Leaf& leaf) {
            for (const std::uint32_t node : leaf.nodes) used[node] = true;
        });
        out.put_all(bits(used));
    }

    static Grid read(Reader& in, const Family& family) {
        Grid grid;
        grid.family_ = family;
        read_coarse(grid, in);
        read_table(grid, in);
        grid.node_count_ = static_cast<std::size_t>(in.get<std::uint64_t>());
        grid.leaf_count_ = static_cast<std::size_t>(in.get<std::uint64_t>());
        grid.root_ = in.get_all<std::uint32_t>();
        grid.words_ = in.get_all<std::uint32_t>();
        grid.hanging_ = in.get_all<std::uint32_t>();
        GridFile(grid, in).check(in.get_all<std::uint32_t>());
        return grid;
    }

private:
    GridFile(Grid& grid, const Reader& in) : grid_{grid}, in_{in} {}

    static std::vector<std::uint32_t> bits(const std::vector<bool>& set) {
        std::vector<std::uint32_t> words((set.size() + 31) / 32, 0);
        for (std::size_t i = 0; i < set.size(); ++i) words[i / 32] |= unsigned{set[i]} << i % 32;
        return words;
    }

    static void read_coarse(Grid& grid, Reader& in) {
        CoarseGrid& coarse = grid.coarse_;
        coarse.dimension = Family::dimension;
        const std::vector<Point> nodes = in.get_all<Point>();
        coarse.nodes = Coordinates(nodes);
        const auto shapes = in.get_all<Shape>();
        const auto corners = in.get_all<std::uint32_t>();
        grid.orientation_ = in.get_all<std::int8_t>();
        if (shapes.empty() || grid.orientation_.size() != shapes.size()) {
            in.fail("the coarse grid is incomplete");
        }
        std::size_t at = 0;
        for (const Shape s : shapes) {
            if (static_cast<int>(s) >= shape_count || !Family::refines(s)) {
                in.fail("an element of the coarse grid has a shape the family does not know");
            }
            const std::size_t n = topology(s).corners;
            if (corners.size() - at < n) in.fail("the coarse grid is incomplete");
            coarse.add(s, std::span(corners).subspan(at, n));
            at += n;
        }
        if (at != corners.size()) in.fail("the coarse grid has corners left over");
        try {
            check_nodes(coarse, {.slits = true});
            for (std::size_t e = 0; e < shapes.size(); ++e) check_element(coarse, e);
        } catch (const InvalidInput& error) {
            in.fail(error.what());
        }
        for (const std::int8_t o : grid.orientation_) {
            if (o != 1 && o != -1) in.fail("an orientation is neither 1 nor -1");
        }
    }

    static void read_table(Grid& grid, Reader& in) {
        try {
            for (const std::uint64_t descriptor : in.get_all<std::uint64_t>()) {
                const std::size_t expected = grid.table_.rule_count();
                if (expected > 0xFFFF) in.fail("it has too many rules");
                const std::uint16_t number =
                    grid.table_.rule(descriptor, is_temporary<Family>(descriptor),
                                     [&] { return Family::make_rule(descriptor); });
                if (number != expected) in.fail("a rule is there twice");
            }
            const auto patterns = in.get<std::uint64_t>();
            for (std::uint64_t p = 0; p < patterns; ++p) {
                const auto tree = in.get_all<std::uint16_t>();
                if (tree.empty() || tree.size() > 64 || tree[0] == 0) in.fail("a pattern is wrong");
                for (const std::uint16_t rule : tree) {
                    if (rule >= grid.table_.rule_count()) in.fail("a pattern names no rule");
                }
                const std::size_t expected = grid.table_.size();
                if (grid.table_.pattern(tree) != expected) in.fail("a pattern is there twice");
            }
        } catch (const InvalidInput& error) {
            in.fail(error.what());
        } catch (const GridError& error) {
            in.fail(error.what());
        }
    }

    void check(const std::vector<std::uint32_t>& in_use);
    void check_record(std::uint32_t at, std::size_t pattern, int depth);

    Grid& grid_;
    const Reader& in_;
    std::size_t next_ = 0;
    std::size_t leaves_ = 0;
    std::vector<bool> used_;
};

template <class Family>
void GridFile<Family>::check(const std::vector<std::uint32_t>& in_use) {
    if (grid_.root_.size() != grid_.coarse_count()) in_.fail("it has another number of roots");
    if (grid_.node_count_ < grid_.coarse_.nodes.size() || grid_.node_count_ > 0x7FFFFFFFU ||
        in_use.size() != (grid_.node_count_ + 31) / 32) {
        in_.fail("its number of nodes is wrong");
    }
    if (!grid_.hanging_.empty() &&
        (Family::conforming || grid_.hanging_.size() != (grid_.node_count_ + 31) / 32)) {
        in_.fail("its mask of hanging nodes is wrong");
    }
    used_.assign(grid_.node_count_, false);
    std::fill_n(used_.begin(), grid_.coarse_.nodes.size(), true);
    for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
        if (grid_.root_[i] == Grid::none_) {
            ++leaves_;
        } else {
            check_record(grid_.root_[i], static_cast<std::size_t>(grid_.coarse_.shapes[i]), 0);
        }
    }
    if (next_ != grid_.words_.size()) in_.fail("it has records left over");
    if (leaves_ != grid_.leaf_count_) in_.fail("its number of leaves is wrong");
    if (bits(used_) != in_use) in_.fail("its set of nodes in use is wrong");
    grid_.used_node_count_ = static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
    try {
        if (!is_prepared(grid_.family_, grid_.coarse_) || !Rewrite<Family>(grid_).is_sound()) {
            in_.fail("its elements do not fit together");
        }
    } catch (const InvalidInput& error) {
        in_.fail(error.what());
    } catch (const GridError& error) {
        in_.fail(error.what());
    }
}

/// Records follow each other as they are written, so none is met twice.
template <class Family>
void GridFile<Family>::check_record(std::uint32_t at, std::size_t pattern, int depth) {
    const Pattern& p = grid_.table_[pattern];
    const std::size_t fixed = p.code_words() + p.mask_words();
    if (at != next_ || grid_.words_.size() - next_ < fixed || depth > 254) {
        in_.fail("a record is out of place");
    }
    std::array<std::uint32_t, max_entities / 32> mask{};
    std::size_t links = 0;
    bool refined = false;
    for (unsigned j = 0; j < 2 * p.code_words(); ++j) {
        const unsigned raw = grid_.raw_code(at, j);
        const unsigned code = raw & ~Grid::has_record_;
        if (raw == 0) continue;
        if (j >= p.exits.size() || code < static_cast<unsigned>(shape_count) ||
            code >= grid_.table_.size() || p.exits[j].entity.empty() ||
            grid_.table_[code].shape != p.exits[j].shape) {
            in_.fail("a record names a wrong pattern");
        }
        refined = true;
        if ((raw & Grid::has_record_) != 0) ++links;
        for (const std::uint8_t entity : grid_.table_[code].node_entity) {
            const unsigned bit = p.exits[j].entity[entity];
            mask[bit / 32] |= 1U << bit % 32;
        }
    }
    std::size_t references = 0;
    for (std::size_t i = 0; i < p.mask_words(); ++i) {
        if (grid_.words_[at + p.code_words() + i] != mask[i]) {
            in_.fail("the nodes of a record do not belong to its patterns");
        }
        references += static_cast<std::size_t>(std::popcount(mask[i]));
    }
    if (!refined || grid_.words_.size() - at - fixed < links + references) {
        in_.fail("a record is incomplete");
    }
    const std::size_t first_link = at + fixed;
    for (std::size_t i = 0; i < references; ++i) {
        const std::uint32_t node = grid_.words_[first_link + links + i];
        if (node >= grid_.node_count_ || node < grid_.coarse_.nodes.size()) {
            in_.fail("a record refers to a node that is not there");
        }
        used_[node] = true;
    }
    next_ = first_link + links + references;
    std::size_t link = first_link;
    for (unsigned j = 0; j < p.exits.size(); ++j) {
        const unsigned raw = grid_.raw_code(at, j);
        const unsigned code = raw & ~Grid::has_record_;
        if ((raw & Grid::has_record_) != 0) {
            check_record(grid_.words_[link++], code, depth + 1);
        } else {
            leaves_ += code == 0 ? 1 : grid_.table_[code].exits.size();
        }
    }
}

}  // namespace nestgrid::detail
