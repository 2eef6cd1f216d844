// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// check_grid: walks a hierarchy and names the first violation of the contract in a sentence.
//
// A node's place is its weights over the ids of coarse nodes. It needs no coordinates, so slits,
// periodic images and curved boundaries do not confuse it: two elements that make a node at one
// place must agree about its key, its parents, its weights and its value.
// Costs O(elements) memory and several times a traversal: for tests, not for production.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

/// What can be violated.
enum class Law : std::uint8_t {
    rule,            ///< weights, children inside their father, volume, orientation of a rule
    rule_shape,      ///< split() gave a rule for another shape, or with another one than promised
    split_repeats,   ///< split() answers the same when asked twice
    coarse_element,  ///< finite, not flat, oriented as said, distinct ids, right dimension
    coarse_node,     ///< one id, one place
    coarse_face,     ///< a face belongs to at most two coarse elements
    coarse_contact,  ///< coarse elements that touch share the nodes of the part in which they touch
    coarse_overlap,  ///< coarse elements do not overlap
    key_place,       ///< one key, one place
    one_stencil,     ///< one node, one key, one set of parents and weights
    stable_key,      ///< own keys do not change from father to child
    dense_key,       ///< own keys below node_count()
    hanging_mask,    ///< a node that hangs is in the constrained mask
    conforming,      ///< a grid that says so has no hanging node
    hanging_value,   ///< a hanging node's value is its interpolant
    value_present,   ///< the field gives all values
    value_finite,
    value_unique,     ///< one node, one value
    position,         ///< own positions: those of eq. (1), and one node, one position
    depth,            ///< the hierarchy ends
    hidden,           ///< an element is hidden as its children are; no leaf is in part
    hanging_parents,  ///< a node hangs on its own parents: on every leaf that it lies on, its
                      ///< stencil gives the value that the leaf has there
    degree,           ///< evaluate() gives the values at nodes, and polynomials of degree()
    map,              ///< map() gives the positions of nodes, and polynomials of geometry_degree()
    coarse_ids,       ///< one place, one id; where CheckOptions::one_id_a_place demands it
    presence,         ///< an element is here, in part or elsewhere as its children are; no leaf is
                      ///< in part. Of a grid with this operation no values are looked at
};

/// The first mistake that was found.
struct GridViolation {
    Law law;
    std::string sentence;
};

/// What check_grid and check_hierarchy look at.
struct CheckOptions {
    int max_depth = 100;
    /// Relative to the size of the coarse element, for own positions.
    double position_tolerance = 1e-9;
    /// Demand that the field itself gives the interpolant at hanging nodes, as a solver does that
    /// has distributed its constraints; the traversal does not need it.
    bool hanging_values = false;
    /// Relative to the largest value, for that.
    double value_tolerance = 1e-12;
    /// Relative to the largest value met so far: how far the values that elements give one node may
    /// differ, where a solver rounds them in each element. Surfaces of such a field may still show
    /// two vertices instead of one.
    double node_value_tolerance = 0;
    /// Demand that coarse corners at one place have one id: for grids without slits. Ids that each
    /// element counts for itself look like slits everywhere.
    bool one_id_a_place = false;
    /// Coarse elements may touch without sharing nodes, as bodies in contact do, and overlap, as
    /// overset grids do: such places are noted. Surfaces are open there.
    bool contacts = false;
    /// Where not null, check_grid appends sentences about what is legal and may yet not be meant:
    /// which optional operations it found, so that a misspelt name is seen to be missing, coarse
    /// corners and faces that lie at one place under different ids, and pieces of the grid that
    /// share no face.
    std::vector<std::string>* notes = nullptr;
};

/// The first violation of the contract, or nothing. Elements are named by the number of the coarse
/// element and those of the children on the way down, as in "element 3/0/1".
/// \throw GridError where a rule has more children than the grid's max_children
std::optional<GridViolation> check_hierarchy(const Hierarchy<float>& hierarchy,
                                             const CheckOptions& options = {});
std::optional<GridViolation> check_hierarchy(const Hierarchy<double>& hierarchy,
                                             const CheckOptions& options = {});

namespace detail {
/// Notes the names of the optional operations that a grid and a field offer.
void note_operations(const std::vector<std::string>& grid, const std::vector<std::string>& field,
                     std::vector<std::string>& notes);
}  // namespace detail

/// The first violation of the contract by a grid and a field on it, or nothing.
template <class Grid, class Field>
std::optional<GridViolation> check_grid(const Grid& grid, const Field& field,
                                        const CheckOptions& options = {}) {
    if (options.notes != nullptr) {
        detail::note_operations(offered_operations(grid), offered_field_operations<Grid>(field),
                                *options.notes);
    }
    return check_hierarchy(erase(grid, field), options);
}

}  // namespace nestgrid
