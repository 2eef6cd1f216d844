// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a file of a hierarchy must hold before anything is done with it. Included at the end of
// stored_file_steps.hpp.
#pragma once

#include <bit>

namespace nestgrid::detail {

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
