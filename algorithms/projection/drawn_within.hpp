// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What all drawings under a projection have in common (drawing.hpp).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>

#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

// Each refuses what a drawing does not do.

void refuse_collapse(const Projection& projection, const char* drawing);
void refuse_budget(const Projection& projection, const char* drawing);
void refuse_distance(const Projection& projection);
void refuse_tolerance(const Projection& projection);
void refuse_slice_distance(const Projection& projection);
/// Refuses what is more than a threshold or a number of triangles.
void refuse_all_but_budgets(const Projection& projection, const char* drawing);
/// Checks what a drawing is asked for, before anything is drawn or exchanged: on ranks, all end
/// alike.
/// \param refuse throws for what this drawing does not do
template <class Refuse>
void check_first(const Prerolls& prerolls, const Projection& projection, const Work& work,
                 const char* drawing, const Refuse& refuse) {
    together(work.on(prerolls.field()).facts().shared, drawing, [&] {
        projection.check();
        refuse();
    });
}
/// The same for drawings of one walk, which have neither a drawing of their own nor several.
void check_one_walk(const Prerolls& prerolls, const Projection& projection, const Work& work,
                    const char* drawing);

/// The projection with its threshold, where it draws everything by saying nothing.
Projection told(Projection projection);

/// The polynomials of a field that the projection asks for within an error; or null.
std::shared_ptr<const HighOrder> polynomials_for(const Prerolls& prerolls,
                                                 const Projection& projection, const Work& work);

/// What is drawn of polynomials, as in VirtualOptions.
struct DrawnParts {
    decltype(VirtualOptions::values) values{};
    std::vector<const LevelFunction*> functions{};
    bool boundary = false;
};
/// Isosurfaces. \param cap whether what is inside them is drawn on the boundary, too
DrawnParts isosurfaces_at(std::span<const double> isovalues, bool cap);
/// Zeros of functions. \param cap as above
DrawnParts zeros_of(std::span<const LevelFunction* const> functions, bool cap);
/// The polynomials within a tolerance, of which infinity is one, and as finely as the lens of the
/// projection asks.
VirtualRefinement polynomials_at(const HighOrder& data, const Projection& projection,
                                 double tolerance, const DrawnParts& parts = {},
                                 int depth = VirtualOptions{}.depth);

/// Calls function(hierarchy), if that has the dimension, with the field as the work asks it.
template <class Function>
auto with_field(const Prerolls& prerolls, const Work& work, int dimension,
                const Function& function) {
    const FieldOnGrid field = work.on(prerolls.field());
    field.facts().require_dimension(dimension);
    return field.visit(function);
}

/// Asks a field of higher degree within the error that the projection asks for; nothing where it
/// asks for none, or where all leaves are straight and of degree 1.
/// \param ask called with the VirtualRefinement
template <class Ask>
auto from_polynomials(const Prerolls& prerolls, const Projection& projection, const Work& work,
                      const Ask& ask, const DrawnParts& parts = {}) {
    std::optional<std::invoke_result_t<const Ask&, const VirtualRefinement&>> result;
    if (const auto data = polynomials_for(prerolls, projection, work)) {
        result = ask(polynomials_at(*data, projection, projection.least_threshold(), parts));
    }
    return result;
}

/// The threshold that the projection gives, or the one that find() finds for its number.
template <class Find>
TriangleBudget threshold_of(const Projection& projection, const Work& work, const Find& find) {
    if (projection.max_triangles == 0) return {.threshold = projection.least_threshold()};
    work.begin("searching the threshold");
    return find();
}

/// From the least to the greatest value of polynomials, or a little more.
double range_of(const HighOrder& data);
/// The number of triangles of a drawing of polynomials, or nothing where there are more than
/// `most`.
using CountWithin =
    std::function<std::optional<std::uint64_t>(const VirtualRefinement&, std::uint64_t most)>;
/// The least tolerance at which a drawing of polynomials keeps within a number of triangles.
TriangleBudget find_tolerance(const HighOrder& data, const Projection& projection,
                              const CountWithin& count, const DrawnParts& parts = {});

/// Draws a field of higher degree, if it has the dimension: within the error that the projection
/// asks for, or the least one with its number of triangles. Nothing where it asks for neither, or
/// where all leaves are straight and of degree 1.
template <class Result, class Draw>
std::optional<Projected<Result>> within_error(const Prerolls& prerolls,
                                              const Projection& projection, const Work& work,
                                              int dimension, const Draw& draw,
                                              const CountWithin& count,
                                              const DrawnParts& parts = {}) {
    const auto data = polynomials_for(prerolls, projection, work);
    if (data == nullptr) return std::nullopt;
    work.on(prerolls.field()).facts().require_dimension(dimension);
    const TriangleBudget search = threshold_of(
        projection, work, [&] { return find_tolerance(*data, projection, count, parts); });
    work.begin("drawing");
    return Projected<Result>{draw(polynomials_at(*data, projection, search.threshold, parts)),
                             search};
}

/// The part of an error within which polynomials are drawn before edges are collapsed within the
/// rest, by the data that are drawn.
inline constexpr double polynomial_share = 0.25;
inline constexpr int greatest_depth = 16;  ///< of VirtualOptions
/// \throw InvalidInput where edges are not collapsed within what the projection asks for
void check_collapse(const HighOrder& data, const Projection& projection);

/// Draws a field of higher degree and collapses edges within the error that the projection asks
/// for. Nothing where it asks for none, or where all leaves are straight and of degree 1.
/// \param draw draw(polynomials, error of these)
/// \param collapse collapse(drawn, polynomials, what is left of the error)
template <class Result, class Draw, class Collapse>
std::optional<Projected<Result>> collapsed_within_error(const Prerolls& prerolls,
                                                        const Projection& projection,
                                                        const Work& work, int dimension,
                                                        const Draw& draw,
                                                        const Collapse& collapse) {
    if (!projection.collapse) return std::nullopt;
    const auto data = polynomials_for(prerolls, projection, work);
    if (data == nullptr) return std::nullopt;
    work.on(prerolls.field()).facts().require_dimension(dimension);
    check_collapse(*data, projection);
    const double error = projection.least_threshold();
    const double first = polynomial_share * error;
    work.begin("drawing");
    const VirtualRefinement fine = polynomials_at(*data, projection, first, {}, greatest_depth);
    Projected<Result> drawn{draw(fine, first), {.threshold = error}};
    if (drawn.cancelled) return drawn;
    work.begin("collapsing");
    collapse(drawn, fine, error - first);
    drawn.error_bound += first + data->jump();
    return drawn;
}

/// Calls draw(hierarchy, criterion, bounds) once, with a field of the dimension under the
/// projection.
///
/// \param isovalues of the level sets that are drawn
/// \param parts of polynomials that are drawn
template <class Draw>
auto draw_once(const Prerolls& prerolls, const Projection& projection,
               std::span<const double> isovalues, const Work& work, int dimension, const Draw& draw,
               const DrawnParts& parts = {}) {
    const auto within = [&](const VirtualRefinement& fine) {
        work.on(prerolls.field()).facts().require_dimension(dimension);
        work.begin("drawing");
        return draw(fine, fine.criterion(), fine.bounds());
    };
    if (auto drawn = from_polynomials(prerolls, projection, work, within, parts)) {
        return *std::move(drawn);
    }
    return with_field(prerolls, work, dimension, [&](const auto& hierarchy) {
        const Criteria criteria(prerolls, told(projection), isovalues, work);
        work.begin("drawing");
        return draw(hierarchy, criteria.criterion(), criteria.bounds());
    });
}

inline auto criteria_at(const Criteria& criteria) {
    return [&criteria](double threshold) { return criteria.at(threshold); };
}

}  // namespace nestgrid::engine
