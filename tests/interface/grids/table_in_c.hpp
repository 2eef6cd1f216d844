// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Any grid and field behind tables, as a C code would fill them: rules as plain numbers, exceptions
// as codes and sentences.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <nestgrid/detail/operations.hpp>
#include <nestgrid/table.hpp>

namespace nestgrid_test {

using nestgrid::detail::components_of;

/// The sentence of the last failure on this thread.
inline std::string& last_sentence() {
    thread_local std::string sentence;
    return sentence;
}
inline const char* say_last_sentence(const void*, void*) { return last_sentence().c_str(); }

/// Nothing is thrown through a table: 1 stands for InvalidInput, 2 for GridError, 3 for the rest.
template <class Function>
int guarded(Function&& function) noexcept {
    try {
        function();
        return 0;
    } catch (const nestgrid::InvalidInput& e) {
        last_sentence() = e.what();
        return 1;
    } catch (const nestgrid::GridError& e) {
        last_sentence() = e.what();
        return 2;
    } catch (const std::exception& e) {
        last_sentence() = e.what();
        return 3;
    }
}

using Rows = double (*)[3];  // NOLINT(modernize-avoid-c-arrays)

inline std::span<nestgrid::Point> as_points(Rows rows, std::size_t count) {
    return {reinterpret_cast<nestgrid::Point*>(rows), count};
}

/// How elements and contexts of a grid cross a table.
template <class Grid>
struct Crossing {
    using Element = nestgrid::ElementOf<Grid>;
    using Context = nestgrid::Context<Grid>;
    static_assert(std::is_trivially_copyable_v<Element> &&
                  sizeof(Element) <= sizeof(nestgrid_element));

    static Element load(const nestgrid_element* e) {
        Element element;
        std::memcpy(static_cast<void*>(&element), e, sizeof(element));
        return element;
    }
    static void store(const Element& element, nestgrid_element* e) {
        *e = {};
        std::memcpy(e, &element, sizeof(element));
    }
    /// Hands the task's state to function, or an empty one where the grid has none.
    template <class Function>
    static decltype(auto) with(void* context, Function&& function) {
        if constexpr (std::is_same_v<Context, nestgrid::NoContext>) {
            nestgrid::NoContext none;
            return function(none);
        } else {
            return function(*static_cast<Context*>(context));
        }
    }
};

/// A grid, which is borrowed, and its table.
template <class Grid>
class TableInC {
    using Cross = Crossing<Grid>;
    using Element = typename Cross::Element;
    using Feature = nestgrid::Feature;

public:
    explicit TableInC(const Grid& grid) : grid_{&grid} {
        const int code = guarded([&] { collect_rules(); });
        if (code != 0) rules_.clear();  // a grid that throws
        for (const nestgrid::Rule* rule : rules_) write(*rule);
        table.size = sizeof(table);
        table.self = this;
        table.dimension = Grid::dimension;
        table.rule_count = static_cast<int>(in_c_.size());
        table.rules = in_c_.data();
        fill_required();
        fill_optional();
    }
    TableInC(const TableInC&) = delete;
    TableInC& operator=(const TableInC&) = delete;

    nestgrid_grid table{};

private:
    using E = const nestgrid_element*;

    static const Grid& grid(const void* self) { return *static_cast<const TableInC*>(self)->grid_; }

    void collect_rules() {
        nestgrid::Context<Grid> context = nestgrid::make_context(*grid_);
        std::set<const nestgrid::Rule*> found;
        for (std::size_t i = 0; i < grid_->coarse_count(); ++i) {
            collect_rules(nestgrid::detail::call_coarse(*grid_, context, i).element, context,
                          found);
        }
    }
    void collect_rules(const Element& e, nestgrid::Context<Grid>& context,
                       std::set<const nestgrid::Rule*>& found) {
        const nestgrid::Rule* rule = nestgrid::detail::call_split(*grid_, context, e);
        if (rule == nullptr) return;
        if (found.insert(rule).second) rules_.push_back(rule);
        std::vector<Element> children(rule->children.size());
        nestgrid::detail::call_children(*grid_, context, e, std::span<Element>(children));
        for (const Element& child : children) collect_rules(child, context, found);
    }
    void write(const nestgrid::Rule& rule) {
        auto& nodes = *stencils_.emplace_back(std::make_unique<std::vector<nestgrid_stencil>>());
        for (const nestgrid::Stencil& s : rule.new_nodes) {
            nestgrid_stencil& c = nodes.emplace_back();
            c.count = s.count;
            c.number = s.number;
            std::copy(s.parent.begin(), s.parent.end(), &c.parent[0]);
            std::copy(s.weight.begin(), s.weight.end(), &c.weight[0]);
        }
        auto& children = *children_.emplace_back(std::make_unique<std::vector<nestgrid_child>>());
        for (const nestgrid::Child& child : rule.children) {
            nestgrid_child& c = children.emplace_back();
            c.shape = static_cast<int>(child.shape);
            c.orientation = child.orientation;
            std::copy(child.corner.begin(), child.corner.end(), &c.corner[0]);
        }
        in_c_.push_back({rule.name.c_str(), static_cast<int>(rule.parent), rule.new_node_count(),
                         nodes.data(), rule.child_count(), children.data()});
    }

    void fill_required() {
        table.last_error = say_last_sentence;
        table.coarse_count = [](const void* self, std::size_t* count) {
            return guarded([&] { *count = grid(self).coarse_count(); });
        };
        table.coarse = [](const void* self, void* context, std::size_t i, nestgrid_coarse* out) {
            return guarded([&] {
                const auto c = Cross::with(context, [&](auto& ctx) {
                    return nestgrid::detail::call_coarse(grid(self), ctx, i);
                });
                Cross::store(c.element, &out->element);
                out->shape = static_cast<int>(c.shape);
                for (std::size_t k = 0; k < nestgrid::max_corners; ++k) {
                    std::copy_n(c.corners[k].begin(), 3, &out->corners[k][0]);
                    out->ids[k] = c.ids[k];
                }
                out->orientation = c.orientation;
            });
        };
        table.split = [](const void* self, void* context, E e, int* number) {
            return guarded([&] {
                const nestgrid::Rule* rule = Cross::with(context, [&](auto& ctx) {
                    return nestgrid::detail::call_split(grid(self), ctx, Cross::load(e));
                });
                const auto& rules = static_cast<const TableInC*>(self)->rules_;
                const auto at = std::find(rules.begin(), rules.end(), rule);
                *number = rule == nullptr ? -1 : static_cast<int>(at - rules.begin());
            });
        };
        table.children = [](const void* self, void* context, E e, std::size_t count,
                            nestgrid_element* out) {
            return guarded([&] {
                std::array<Element, nestgrid::max_children> children;
                const std::span<Element> wanted = std::span(children).first(count);
                Cross::with(context, [&](auto& ctx) {
                    nestgrid::detail::call_children(grid(self), ctx, Cross::load(e), wanted);
                });
                for (std::size_t k = 0; k < count; ++k) Cross::store(children[k], out + k);
            });
        };
        table.epoch = [](const void* self, std::uint64_t* out) {
            return guarded([&] { *out = nestgrid::epoch(grid(self)); });
        };
        if constexpr (requires { grid_->conforming(); }) {
            table.conforming = grid_->conforming() ? 1 : 0;
        }
        using Context = nestgrid::Context<Grid>;
        if constexpr (!std::is_same_v<Context, nestgrid::NoContext>) {
            table.make_context = [](const void* self) {
                void* context = nullptr;
                guarded([&] { context = new Context(nestgrid::make_context(grid(self))); });
                return context;
            };
            table.free_context = [](const void*, void* context) {
                delete static_cast<Context*>(context);
            };
        }
    }

    static constexpr bool has(Feature feature) { return nestgrid::may_offer<Grid>(feature); }
    bool offered(Feature feature) const { return nestgrid::offers(*grid_, feature); }

    void fill_optional() {
        if constexpr (has(Feature::own_keys)) {
            if (offered(Feature::own_keys)) fill_keys();
        }
        if constexpr (has(Feature::own_positions)) {
            if (offered(Feature::own_positions)) table.corner_positions = corner_positions;
        }
        if constexpr (has(Feature::new_positions)) {
            if (offered(Feature::new_positions)) table.new_positions = new_positions;
        }
        if constexpr (has(Feature::constrained)) {
            if (offered(Feature::constrained)) table.constrained = constrained;
        }
        if constexpr (has(Feature::hanging_parents)) {
            if (offered(Feature::hanging_parents)) table.hanging_parents = hanging_parents;
        }
        if constexpr (has(Feature::masked)) {
            if (offered(Feature::masked)) table.masked = masked;
        }
        if constexpr (has(Feature::hidden)) {
            if (offered(Feature::hidden)) table.hidden = hidden;
        }
        if constexpr (has(Feature::presence)) {
            if (offered(Feature::presence)) table.presence = presence;
        }
        if constexpr (has(Feature::geometry_degree)) {
            if (offered(Feature::geometry_degree)) {
                table.geometry_degree = geometry_degree;
                table.map = map;
            }
        }
        if constexpr (has(Feature::outside)) {
            if (offered(Feature::outside)) table.outside = outside;
        }
        if constexpr (has(Feature::boundary_faces)) {
            if (offered(Feature::boundary_faces)) table.boundary_faces = boundary_faces;
        }
    }
    void fill_keys() {
        table.corner_keys = corner_keys;
        table.new_keys = new_keys;
        table.node_count = nestgrid::dense_key_count(*grid_);
    }

    static int copy(std::span<const nestgrid::NodeKey> keys, std::uint64_t* out) {
        std::transform(keys.begin(), keys.end(), out,
                       [](auto key) { return static_cast<std::uint64_t>(key); });
        return 0;
    }
    static int corner_keys(const void* self, void* context, E e, std::size_t count,
                           std::uint64_t* out) {
        return guarded([&] {
            std::array<nestgrid::NodeKey, nestgrid::max_corners> keys;
            const std::span<nestgrid::NodeKey> wanted = std::span(keys).first(count);
            Cross::with(context, [&](auto& ctx) {
                nestgrid::detail::call_corner_keys(grid(self), ctx, Cross::load(e), wanted);
            });
            copy(wanted, out);
        });
    }
    static int new_keys(const void* self, void* context, E e, std::size_t count,
                        std::uint64_t* out) {
        return guarded([&] {
            std::array<nestgrid::NodeKey, nestgrid::max_new_nodes> keys;
            const std::span<nestgrid::NodeKey> wanted = std::span(keys).first(count);
            Cross::with(context, [&](auto& ctx) {
                nestgrid::detail::call_new_keys(grid(self), ctx, Cross::load(e), wanted);
            });
            copy(wanted, out);
        });
    }
    static int corner_positions(const void* self, void* context, E e, std::size_t count, Rows out) {
        return guarded([&] {
            Cross::with(context, [&](auto& ctx) {
                nestgrid::detail::call_corner_positions(grid(self), ctx, Cross::load(e),
                                                        as_points(out, count));
            });
        });
    }
    static int new_positions(const void* self, void* context, E e, std::uint64_t which,
                             std::size_t count, Rows out) {
        return guarded([&] {
            Cross::with(context, [&](auto& ctx) {
                nestgrid::detail::call_new_positions(grid(self), ctx, Cross::load(e),
                                                     nestgrid::NodeMask{which},
                                                     as_points(out, count));
            });
        });
    }
    static int constrained(const void* self, void* context, E e, std::uint64_t* nodes) {
        return guarded([&] {
            *nodes = Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_constrained(grid(self), ctx, Cross::load(e));
            });
        });
    }
    static int hanging_parents(const void* self, std::uint64_t node, std::uint64_t* out) {
        return guarded([&] { copy(grid(self).hanging_parents(node), out); });
    }
    static int masked(const void* self, void* context, E e, int* answer) {
        return guarded([&] {
            *answer = Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_masked(grid(self), ctx, Cross::load(e)) ? 1 : 0;
            });
        });
    }
    static int hidden(const void* self, void* context, E e, int* answer) {
        return guarded([&] {
            *answer = static_cast<int>(Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_hidden(grid(self), ctx, Cross::load(e));
            }));
        });
    }
    static int presence(const void* self, void* context, E e, int* answer) {
        return guarded([&] {
            *answer = static_cast<int>(Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_presence(grid(self), ctx, Cross::load(e));
            }));
        });
    }
    static int geometry_degree(const void* self, void* context, E e, int* degree) {
        return guarded([&] {
            *degree = Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_geometry_degree(grid(self), ctx, Cross::load(e));
            });
        });
    }
    static int map(const void* self, void* context, E e, std::size_t count,
                   const double (*reference)[3], Rows out) {
        return guarded([&] {
            Cross::with(context, [&](auto& ctx) {
                nestgrid::detail::call_map(
                    grid(self), ctx, Cross::load(e),
                    std::span(reinterpret_cast<const nestgrid::Point*>(reference), count),
                    as_points(out, count));
            });
        });
    }
    static int outside(const void* self, void* context, E e, std::uint64_t* nodes) {
        return guarded([&] {
            *nodes = Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_outside(grid(self), ctx, Cross::load(e));
            });
        });
    }
    static int boundary_faces(const void* self, void* context, E e, unsigned* faces) {
        return guarded([&] {
            *faces = Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_boundary_faces(grid(self), ctx, Cross::load(e));
            });
        });
    }

    const Grid* grid_;
    std::vector<const nestgrid::Rule*> rules_;
    std::vector<std::unique_ptr<std::vector<nestgrid_stencil>>> stencils_;
    std::vector<std::unique_ptr<std::vector<nestgrid_child>>> children_;
    std::vector<nestgrid_rule> in_c_;
};

/// The table of a field on a grid of the same type as the first argument; the field is borrowed.
template <class Grid, class Field>
nestgrid_field field_in_c(const Grid&, const Field& model) {
    using Real = typename Field::value_type;
    using Cross = Crossing<Grid>;
    static constexpr auto components = static_cast<std::size_t>(components_of<Field>());
    static constexpr auto field = [](const void* self) -> const Field& {
        return *static_cast<const Field*>(self);
    };
    static constexpr auto values = [](void* out, std::size_t count) {
        return std::span<Real>(static_cast<Real*>(out), count * components);
    };
    nestgrid_field t{};
    t.size = sizeof(t);
    t.self = &model;
    t.value_type = std::is_same_v<Real, float> ? NESTGRID_FLOAT : NESTGRID_DOUBLE;
    t.components = components_of<Field>();
    t.last_error = say_last_sentence;
    t.coarse_values = [](const void* self, void* context, std::size_t i, std::size_t count,
                         void* out, std::uint64_t* missing) {
        return guarded([&] {
            *missing = Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_coarse_values(field(self), ctx, i,
                                                            values(out, count));
            });
        });
    };
    t.new_values = [](const void* self, void* context, const nestgrid_element* e,
                      std::uint64_t which, std::size_t count, void* out, std::uint64_t* missing) {
        return guarded([&] {
            *missing = Cross::with(context, [&](auto& ctx) {
                return nestgrid::detail::call_new_values(field(self), ctx, Cross::load(e),
                                                         nestgrid::NodeMask{which},
                                                         values(out, count));
            });
        });
    };
    if constexpr (nestgrid::detail::offers_corner_gradients<Field, nestgrid::Context<Grid>,
                                                            const nestgrid::ElementOf<Grid>&,
                                                            std::span<nestgrid::Point>>) {
        if (nestgrid::offers_gradients<Grid>(model)) {
            t.corner_gradients = [](const void* self, void* context, const nestgrid_element* e,
                                    std::size_t count, double(*out)[3]) {
                return guarded([&] {
                    Cross::with(context, [&](auto& ctx) {
                        nestgrid::detail::call_corner_gradients(field(self), ctx, Cross::load(e),
                                                                as_points(out, count));
                    });
                });
            };
        }
    }
    if constexpr (nestgrid::detail::offers_degree<Field, nestgrid::Context<Grid>,
                                                  const nestgrid::ElementOf<Grid>&>) {
        t.degree = [](const void* self, void* context, const nestgrid_element* e, int* degree) {
            return guarded([&] {
                *degree = Cross::with(context, [&](auto& ctx) {
                    return nestgrid::detail::call_degree(field(self), ctx, Cross::load(e));
                });
            });
        };
        t.evaluate = [](const void* self, void* context, const nestgrid_element* e,
                        std::size_t count, const double(*reference)[3], void* out) {
            return guarded([&] {
                Cross::with(context, [&](auto& ctx) {
                    nestgrid::detail::call_evaluate(
                        field(self), ctx, Cross::load(e),
                        std::span(reinterpret_cast<const nestgrid::Point*>(reference), count),
                        values(out, count));
                });
            });
        };
    }
    return t;
}

/// A grid and a field on it, opened from tables.
template <class Grid, class Field>
struct BehindTables {
    using Real = typename Field::value_type;

    BehindTables(const Grid& grid, const Field& field)
        : table(grid),
          hierarchy(nestgrid::open_table<Real>(table.table, field_in_c(grid, field))) {}

    TableInC<Grid> table;
    std::unique_ptr<const nestgrid::Hierarchy<Real>> hierarchy;
};

}  // namespace nestgrid_test
