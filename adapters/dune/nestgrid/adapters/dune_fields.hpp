// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data on grids of Dune: vectors of values at vertices, and functions on leaves. Both are read
// where they lie. At the corners of elements that are no leaves, a leaf with the same corner
// answers. Over several processes all have values at the vertices of their own elements.
#pragma once

#include <nestgrid/adapters/dune.hpp>
#include <nestgrid/detail/made_for.hpp>

namespace nestgrid {

namespace detail {

template <class Entry>
struct DuneEntry {
    using Scalar = Entry;
    static constexpr int components = 1;
    static Scalar at(const Entry& entry, std::size_t) { return entry; }
};
template <class Entry>
    requires requires { Entry::dimension; }
struct DuneEntry<Entry> {
    using Scalar = typename Entry::value_type;
    static constexpr int components = Entry::dimension;
    static Scalar at(const Entry& entry, std::size_t c) { return entry[c]; }
};

}  // namespace detail

/// One value or FieldVector per vertex of the leaf grid, in the order of an index set: std::vector,
/// Dune::BlockVector, or anything with size() and operator[].
/// \tparam IndexSet of the leaf grid view, with subIndex(element, i, codimension): its index set,
///         or a mapper of its vertices
template <class Grid, class Vector, class IndexSet = typename Grid::Solver::LeafIndexSet>
class DuneVertexField {
    using Entry = detail::DuneEntry<std::decay_t<decltype(std::declval<const Vector&>()[0])>>;

public:
    using value_type = typename Entry::Scalar;
    static constexpr int components = Entry::components;
    using Element = typename Grid::Element;
    using Context = typename Grid::Context;

    /// The vector must outlive the field and keep its place.
    /// \throw InvalidInput where there is not one entry per vertex
    DuneVertexField(const Grid& grid, const Vector& values)
        : DuneVertexField(grid, values, grid.solver().leafIndexSet()) {}
    DuneVertexField(const Grid& grid, const Vector& values, const IndexSet& indices)
        : grid_{&grid}, values_{&values}, indices_{&indices} {
        check_length();
    }

    /// \throw InvalidInput where the grid was adapted, but not the vector
    NodeMask coarse_values(std::size_t i, std::span<value_type> out, Context& context) const {
        check_length();
        const Element e = grid_->coarse_entity(i);
        const std::size_t corners = out.size() / components;
        if (grid_->presence(e) == Presence::elsewhere) return (NodeMask{1} << corners) - 1;
        for (std::size_t k = 0; k < corners; ++k)
            get(e, static_cast<int>(k), context, &out[k * components]);
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<value_type> out,
                        Context& context) const {
        grid_->for_each_new_corner(e, which, context,
                                   [&](std::size_t n, const Element& child, int corner) {
                                       get(child, corner, context, &out[n * components]);
                                   });
        return 0;
    }

private:
    void check_length() const {
        const auto vertices = static_cast<std::size_t>(grid_->solver().size(Grid::dimension));
        if (static_cast<std::size_t>(values_->size()) != vertices) {
            throw InvalidInput("there are " + std::to_string(values_->size()) +
                               " values, but the leaf grid has " + std::to_string(vertices) +
                               " vertices");
        }
    }

    void get(const Element& e, int corner, Context& context, value_type* out) const {
        const auto read = [&](const Element& from, int at) {
            const auto& entry = (*values_)[indices_->subIndex(from, at, Grid::dimension)];
            for (std::size_t c = 0; c < components; ++c) out[c] = Entry::at(entry, c);
        };
        if constexpr (Grid::leaf_indices_on_branches) {
            read(e, corner);
        } else {
            grid_->at_leaf(e, corner, context, read);
        }
    }

    const Grid* grid_;
    const Vector* values_;
    const IndexSet* indices_;
};

/// A continuous function, seen at the vertices of the leaf grid: also one of higher order only
/// there. Called with a leaf and a place in its reference element, or a grid function of
/// dune-functions. All leaves around a vertex must give it the same value to the last bit, as
/// Lagrange functions do.
template <class Grid, class Function>
class DuneFunctionField {
public:
    using value_type = double;
    using Element = typename Grid::Element;
    using Context = typename Grid::Context;

    DuneFunctionField(const Grid& grid, Function function)
        : grid_{&grid}, function_{std::move(function)}, made_for_{grid} {}

    /// \throw GridError where the grid has changed since the field was made
    NodeMask coarse_values(std::size_t i, std::span<double> out, Context& context) const {
        made_for_.require_same(*grid_, "the field");
        const Element e = grid_->coarse_entity(i);
        if (grid_->presence(e) == Presence::elsewhere) return (NodeMask{1} << out.size()) - 1;
        for (std::size_t k = 0; k < out.size(); ++k)
            out[k] = value(e, static_cast<int>(k), context);
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out,
                        Context& context) const {
        grid_->for_each_new_corner(e, which, context,
                                   [&](std::size_t n, const Element& child, int corner) {
                                       out[n] = value(child, corner, context);
                                   });
        return 0;
    }

protected:
    /// Values at points of the reference element of a leaf.
    void put_values(const Element& leaf, std::span<const Point> reference,
                    std::span<double> out) const {
        Dune::FieldVector<typename Grid::Solver::ctype, Grid::dimension> local;
        const auto put = [&](const auto& function) {
            for (std::size_t i = 0; i < reference.size(); ++i) {
                for (std::size_t d = 0; d < local.size(); ++d) local[d] = reference[i][d];
                out[i] = function(local);
            }
        };
        if constexpr (requires { function_(leaf, local); }) {
            put([&](const auto& at) { return function_(leaf, at); });
        } else {
            auto on_leaf = localFunction(function_);
            on_leaf.bind(leaf);
            put(on_leaf);
        }
    }

private:
    double value(const Element& e, int corner, Context& context) const {
        return grid_->at_leaf(e, corner, context, [&](const Element& leaf, int at) {
            const Shape shape = detail::dune_shape(leaf.type());
            const Point& x = topology(shape).reference[static_cast<std::size_t>(at)];
            double result = 0;
            put_values(leaf, std::span(&x, 1), std::span(&result, 1));
            return result;
        });
    }

    const Grid* grid_;
    Function function_;
    detail::MadeFor made_for_;
};

/// A function that is a polynomial on each leaf, drawn between vertices, too (high_order.hpp). It
/// may jump from leaf to leaf, if it is drawn within an error.
template <class Grid, class Function>
class DunePolynomialField : public DuneFunctionField<Grid, Function> {
public:
    using Element = typename Grid::Element;

    /// \param degree of all leaves, 1 to 8
    DunePolynomialField(const Grid& grid, Function function, int degree)
        : DuneFunctionField<Grid, Function>(grid, std::move(function)), degree_{degree} {}

    int degree(const Element&) const { return degree_; }
    void evaluate(const Element& leaf, std::span<const Point> reference,
                  std::span<double> out) const {
        this->put_values(leaf, reference, out);
    }

private:
    int degree_;
};

}  // namespace nestgrid
