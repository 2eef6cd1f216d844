// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The identity adapter: another grid's required operations under a name of its own, and nothing
// added. Its length is the touchstone of the interface.
#pragma once

#include <nestgrid/grid.hpp>

namespace nestgrid_test {

template <class Grid>
class IdentityGrid {
public:
    struct Element {
        typename Grid::Element hosted;
    };
    static constexpr int dimension = Grid::dimension;

    explicit IdentityGrid(const Grid& grid) : grid_{&grid} {}

    std::size_t coarse_count() const { return grid_->coarse_count(); }
    nestgrid::CoarseElement<Element> coarse(std::size_t i) const {
        const auto c = grid_->coarse(i);
        return {{c.element}, c.shape, c.corners, c.ids, c.orientation};
    }
    const nestgrid::Rule* split(const Element& e) const { return grid_->split(e.hosted); }
    void children(const Element& e, std::span<Element> out) const {
        std::array<typename Grid::Element, nestgrid::max_children> hosted;
        grid_->children(e.hosted, std::span(hosted).first(out.size()));
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = {hosted[k]};
    }

private:
    const Grid* grid_;
};

template <class Grid, class Field>
class IdentityField {
public:
    using value_type = typename Field::value_type;

    IdentityField(const IdentityGrid<Grid>&, const Field& field) : field_{&field} {}

    nestgrid::NodeMask coarse_values(std::size_t i, std::span<value_type> out) const {
        return field_->coarse_values(i, out);
    }
    nestgrid::NodeMask new_values(const typename IdentityGrid<Grid>::Element& e,
                                  nestgrid::NodeMask which, std::span<value_type> out) const {
        return field_->new_values(e.hosted, which, out);
    }

private:
    const Field* field_;
};

}  // namespace nestgrid_test
