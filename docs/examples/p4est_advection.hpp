// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solver of p4est_advection.cpp, which knows nothing of nestgrid: finite volumes of second
// order on a forest that follows the solution, on one rank of MPI or on several. The means of cells
// are in the user data of quadrants.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <vector>

#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_ghost.h>
#include <p8est_iterate.h>

namespace p4est_advection {

using Vector = std::array<double, 3>;

/// How fine the forest is.
struct Fineness {
    int coarsest = 2;  ///< level
    int finest = 6;
    double largest_jump = 0.14;    ///< between neighbours: above it cells are refined
    int steps_per_rotation = 360;  ///< Courant numbers up to 0.9

    double time_step() const { return 1.0 / steps_per_rotation; }
};

inline constexpr int steps_per_adaptation = 4;

/// A vortex around the axis x = y = 1: once round in a unit of time, as a solid up to 0.8 from the
/// axis, then ever slower, at rest from 1 on. So nothing flows through the walls.
struct Vortex {
    double x, y;  ///< from the axis
    double square = x * x + y * y;
    double slowing = std::clamp((square - solid) / (1 - solid), 0.0, 1.0);
    static constexpr double solid = 0.8 * 0.8;

    Vector velocity() const {
        return {-2 * M_PI * (1 - slowing) * y, 2 * M_PI * (1 - slowing) * x, 0};
    }
    double stream_function() const {
        return -M_PI * (std::min(square, solid) + (1 - solid) * slowing * (1 - slowing / 2));
    }
};

/// Volume that flows through a square face per unit of time, up the axis it is normal to. It is a
/// difference of the stream function, so that all flows into a cell together are zero, whatever the
/// sizes of its neighbours.
inline double flow(std::size_t axis, const Vector& centre, double size) {
    const auto stream = [&](double x, double y) {
        return Vortex{centre[0] - 1 + x, centre[1] - 1 + y}.stream_function();
    };
    const double half = size / 2;
    if (axis == 0) return size * (stream(0, half) - stream(0, -half));
    if (axis == 1) return size * (stream(-half, 0) - stream(half, 0));
    return 0;
}

/// The solution: a blob, at first at (1.35, 1, 0.5), with a steep front and a long tail.
inline double exact(const Vector& x, double time) {
    const double c = std::cos(2 * M_PI * time);
    const double s = std::sin(2 * M_PI * time);
    const double ahead = c * (x[1] - 1) - s * (x[0] - 1);
    const double outwards = c * (x[0] - 1) + s * (x[1] - 1) - 0.35;
    const double r =
        std::hypot(ahead / (ahead > 0 ? 0.2 : 0.6), outwards / 0.35, (x[2] - 0.5) / 0.4);
    return r < 1 ? std::pow(std::cos(M_PI / 2 * r), 2) : 0;
}

/// What the solver keeps in the user data of each quadrant.
struct Cell {
    Vector centre{};
    double size = 0;
    double u = 0;                   ///< mean over the cell
    double gain = 0;                ///< of u times volume, in this step
    std::array<double, 6> slope{};  ///< of u across each face

    double volume() const { return size * size * size; }
    /// Along an axis: central, but at most twice what it is across either face.
    double limited_slope(std::size_t axis) const {
        const double a = slope[2 * axis];
        const double b = slope[2 * axis + 1];
        const double least = std::min(std::abs(a), std::abs(b));
        return a * b > 0 ? std::copysign(std::min(2 * least, std::abs(a + b) / 2), a) : 0;
    }
    double value(const Vector& x) const {
        double result = u;
        for (std::size_t d = 0; d < 3; ++d) result += limited_slope(d) * (x[d] - centre[d]);
        return result;
    }
    double jump() const {
        const auto [least, greatest] = std::minmax_element(slope.begin(), slope.end());
        return size * std::max(-*least, *greatest);
    }
};

inline Cell& cell_of(const p8est_quadrant_t& q) { return *static_cast<Cell*>(q.p.user_data); }

// What p4est calls while the forest changes.

inline void create(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    Cell& cell = *new (q->p.user_data) Cell;
    const p4est_qcoord_t half = P8EST_QUADRANT_LEN(q->level) / 2;
    p8est_qcoord_to_vertex(forest->connectivity, tree, q->x + half, q->y + half, q->z + half,
                           cell.centre.data());
    cell.size = std::ldexp(1.0, -q->level);
}

/// Puts eight cells in the place of one, or one in that of eight, with as much u as before.
inline void replace(p8est_t*, p4est_topidx_t, int outgoing_count, p8est_quadrant_t* outgoing[], int,
                    p8est_quadrant_t* incoming[]) {
    const bool refines = outgoing_count == 1;
    for (int c = 0; c < P8EST_CHILDREN; ++c) {
        const Cell& from = cell_of(*outgoing[refines ? 0 : c]);
        Cell& to = cell_of(*incoming[refines ? c : 0]);
        const double part = refines ? 1 : 1.0 / P8EST_CHILDREN;
        to.u += part * (refines ? from.value(to.centre) : from.u);
        for (std::size_t f = 0; f < 6; ++f) to.slope[f] += part * from.limited_slope(f / 2);
    }
}

inline const Fineness& fineness_of(const p8est_t* forest) {
    return *static_cast<const Fineness*>(forest->user_pointer);
}

inline int must_refine(p8est_t* forest, p4est_topidx_t, p8est_quadrant_t* q) {
    return cell_of(*q).jump() > fineness_of(forest).largest_jump;
}

inline int may_coarsen(p8est_t* forest, p4est_topidx_t, p8est_quadrant_t* family[]) {
    const Fineness& fineness = fineness_of(forest);
    const auto is_flat = [&](auto* q) { return cell_of(*q).jump() < 0.4 * fineness.largest_jump; };
    return family[0]->level > fineness.coarsest &&
           std::all_of(family, family + P8EST_CHILDREN, is_flat);
}

/// Copies of the cells around those of this rank, which other ranks have.
class Ghosts {
public:
    /// They are those of the forest as it is.
    void find(p8est_t* forest) {
        layer_.reset(p8est_ghost_new(forest, P8EST_CONNECT_FULL));
        cells_.resize(layer_->ghosts.elem_count);
    }
    void copy(p8est_t* forest) { p8est_ghost_exchange_data(forest, layer_.get(), cells_.data()); }

    p8est_ghost_t* layer() const { return layer_.get(); }
    Cell& operator[](p4est_locidx_t i) { return cells_[static_cast<std::size_t>(i)]; }

private:
    std::unique_ptr<p8est_ghost_t, decltype(&p8est_ghost_destroy)> layer_{nullptr,
                                                                          p8est_ghost_destroy};
    std::vector<Cell> cells_;
};

// What p4est calls for faces of cells of this rank.

struct FaceCall {
    Ghosts* ghosts;
    double time_step;
};

/// The cells on one side of a face: one, or the four smaller ones where the face hangs.
struct Side {
    std::size_t face;  ///< number of the face on these cells: 0 and 1 normal to x, and so on
    std::array<Cell*, 4> cells;  ///< four times the same where it is one

    Side(p8est_iter_face_info_t& info, int number, Ghosts& ghosts) {
        const auto& side = *p8est_iter_fside_array_index_int(&info.sides, number);
        face = static_cast<std::size_t>(side.face);
        const auto cell = [&](bool is_ghost, p8est_quadrant_t* q, p4est_locidx_t i) {
            return is_ghost ? &ghosts[i] : &cell_of(*q);
        };
        for (std::size_t i = 0; i < 4; ++i) {
            const auto& [are_ghosts, quad, numbers] = side.is.hanging;
            cells[i] = side.is_hanging ? cell(are_ghosts[i] != 0, quad[i], numbers[i])
                                       : cell(side.is.full.is_ghost != 0, side.is.full.quad,
                                              side.is.full.quadid);
        }
    }
    double mean() const { return (cells[0]->u + cells[1]->u + cells[2]->u + cells[3]->u) / 4; }
    void set_slope(double slope) const {
        for (Cell* cell : cells) cell->slope[face] = slope;
    }
};

inline void find_slope(p8est_iter_face_info_t* info, void* user_data) {
    Ghosts& ghosts = *static_cast<const FaceCall*>(user_data)->ghosts;
    const Side a(*info, 0, ghosts);
    if (info->sides.elem_count == 1) return a.set_slope(0);  // a wall
    // The middle of four smaller cells lies straight across from that of the larger one.
    const Side b(*info, 1, ghosts);
    const std::size_t axis = a.face / 2;
    const double distance = b.cells[0]->centre[axis] - a.cells[0]->centre[axis];
    const double slope = (b.mean() - a.mean()) / distance;
    a.set_slope(slope);
    b.set_slope(slope);
}

/// Moves u from one side to the other: the value upwind, at the point that comes to the middle of
/// the face in the middle of the step.
inline void exchange(p8est_iter_face_info_t* info, void* user_data) {
    if (info->sides.elem_count == 1) return;
    const auto [ghosts, time_step] = *static_cast<const FaceCall*>(user_data);
    const Side first(*info, 0, *ghosts);
    const Side second(*info, 1, *ghosts);
    const std::size_t axis = first.face / 2;
    const bool upwards = first.face % 2 == 1;
    const Side& lower_side = upwards ? first : second;
    const Side& upper_side = upwards ? second : first;
    const bool hangs = first.cells[0] != first.cells[1] || second.cells[0] != second.cells[1];
    for (std::size_t i = 0; i < (hangs ? 4 : 1); ++i) {
        Cell& lower = *lower_side.cells[i];
        Cell& upper = *upper_side.cells[i];
        const bool lower_is_smaller = lower.size < upper.size;
        const Cell& smaller = lower_is_smaller ? lower : upper;
        Vector x = smaller.centre;
        x[axis] += (lower_is_smaller ? 0.5 : -0.5) * smaller.size;
        const double volume = time_step * flow(axis, x, smaller.size);
        const Vector v = Vortex{x[0] - 1, x[1] - 1}.velocity();
        for (std::size_t d = 0; d < 3; ++d) x[d] -= time_step / 2 * v[d];
        const double amount = volume * (volume > 0 ? lower : upper).value(x);
        lower.gain -= amount;
        upper.gain += amount;
    }
}

// The solver.

template <class Function>
void for_each_cell(const p8est_t* forest, const Function& function) {
    for (p4est_topidx_t t = 0; t < forest->connectivity->num_trees; ++t) {
        sc_array_t& leaves = p8est_tree_array_index(forest->trees, t)->quadrants;
        for (std::size_t i = 0; i < leaves.elem_count; ++i) {
            function(cell_of(*p8est_quadrant_array_index(&leaves, i)));
        }
    }
}

/// The forest and the cells in it, at first those of the blob.
class Advection {
public:
    explicit Advection(const Fineness& fineness = {})
        : fineness_{fineness},
          trees_{p8est_connectivity_new_brick(2, 2, 1, 0, 0, 0), p8est_connectivity_destroy},
          forest_{p8est_new_ext(sc_MPI_COMM_WORLD, trees_.get(), 0, fineness.coarsest, 1,
                                sizeof(Cell), create, &fineness_),
                  p8est_destroy} {
        for (int level = fineness.coarsest; level <= fineness.finest; ++level) {
            if (level > fineness.coarsest) adapt();
            ghosts_.find(forest());
            for_each_cell(forest(), [](Cell& cell) { cell.u = exact(cell.centre, 0); });
        }
    }
    Advection(Advection&&) = delete;  // the forest knows where the fineness is

    p8est_t* forest() const { return forest_.get(); }

    void step() {
        if (++steps_ % steps_per_adaptation == 0) {
            adapt();
            ghosts_.find(forest());
        }
        find_slopes();
        ghosts_.copy(forest());
        for_each_face(exchange);
        for_each_cell(forest(), [](Cell& cell) {
            cell.u += cell.gain / cell.volume();
            cell.gain = 0;
        });
    }
    double time() const { return static_cast<double>(steps_) * fineness_.time_step(); }

private:
    void for_each_face(p8est_iter_face_t function) {
        FaceCall call{&ghosts_, fineness_.time_step()};
        p8est_iterate(forest(), ghosts_.layer(), &call, nullptr, function, nullptr, nullptr);
    }
    void find_slopes() {
        ghosts_.copy(forest());
        for_each_face(find_slope);
    }
    /// The ranks have about as many cells each afterwards.
    void adapt() {
        find_slopes();
        p8est_coarsen_ext(forest(), 0, 0, may_coarsen, create, replace);
        p8est_refine_ext(forest(), 0, fineness_.finest, must_refine, create, replace);
        p8est_balance_ext(forest(), P8EST_CONNECT_FULL, create, replace);
        p8est_partition(forest(), 1, nullptr);
    }

    Fineness fineness_;
    std::unique_ptr<p8est_connectivity_t, decltype(&p8est_connectivity_destroy)> trees_;
    std::unique_ptr<p8est_t, decltype(&p8est_destroy)> forest_;
    Ghosts ghosts_;
    long steps_ = 0;
};

/// Of the cells of all ranks.
struct Totals {
    double mass = 0, error = 0;  ///< error: from the exact solution in the L1 norm
    double least = 1, greatest = 0;
    double smallest = 1, largest = 0;  ///< sizes of cells
    double courant = 0;                ///< the largest Courant number

    explicit Totals(const Advection& solver) {
        const double time = solver.time();
        const double time_step = fineness_of(solver.forest()).time_step();
        for_each_cell(solver.forest(), [&](const Cell& cell) {
            mass += cell.u * cell.volume();
            error += std::abs(cell.u - exact(cell.centre, time)) * cell.volume();
            least = std::min(least, cell.u);
            greatest = std::max(greatest, cell.u);
            smallest = std::min(smallest, cell.size);
            largest = std::max(largest, cell.size);
            const Vector v = Vortex{cell.centre[0] - 1, cell.centre[1] - 1}.velocity();
            const double crossed = (std::abs(v[0]) + std::abs(v[1])) * time_step;
            courant = std::max(courant, crossed / cell.size);
        });
        reduce(solver.forest()->mpicomm, sc_MPI_SUM, {&mass, &error});
        reduce(solver.forest()->mpicomm, sc_MPI_MIN, {&least, &smallest});
        reduce(solver.forest()->mpicomm, sc_MPI_MAX, {&greatest, &largest, &courant});
    }

private:
    static void reduce(sc_MPI_Comm communicator, sc_MPI_Op operation,
                       std::initializer_list<double*> numbers) {
        for (double* number : numbers) {
            double all = 0;
            sc_MPI_Allreduce(number, &all, 1, sc_MPI_DOUBLE, operation, communicator);
            *number = all;
        }
    }
};

}  // namespace p4est_advection
