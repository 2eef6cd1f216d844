// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of check_grid: all elements that make a node agree about it.
#include <cmath>
#include <cstdio>
#include <optional>

#include "laws.hpp"

namespace nestgrid::detail {

namespace {

/// As many digits as tell apart any two numbers.
std::string all_digits(double number) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.17g", number);
    return text.data();
}

/// As in "node 9 of element 3/0/1".
std::string node_name(const Inspection& inspection, const MadeNode& made) {
    return "node " + std::to_string(made.number) + " of " + inspection.name(made.element.step);
}

/// As in "node 9 of element 3/0/1 and in element 3/0/2".
std::string both_names(Inspection& inspection, const MadeNode& made) {
    return node_name(inspection, made) + " and in " +
           inspection.name(inspection.nodes()[made.known].element);
}

/// A node has one set of parents and weights; or does not hang, where the grid gives parents.
class StencilLaw final : public GridLaw {
public:
    explicit StencilLaw(Inspection& inspection) : inspection_{&inspection} {}

    void visit(const MadeNode& made) override {
        if (made.stencil == nullptr) return;
        const Stencil& stencil = *made.stencil;
        Origin origin{0, made.element.step, parents_.size(), stencil.count};
        for (std::size_t i = 0; i < stencil.count; ++i) {
            origin.signature +=
                mix(made.nodes[stencil.parent[i]].key +
                    static_cast<std::uint64_t>(std::llround(stencil.weight[i] * 0x1p40)));
        }
        const auto [known, is_new] = origins_.insert(made.node().place, origin);
        if (!is_new && known->signature == origin.signature) return;
        for (std::size_t i = 0; i < stencil.count; ++i) {
            parents_.push_back({stencil.weight[i], made.nodes[stencil.parent[i]].position});
        }
        if (is_new) return;
        const std::string sentence = "one node has two stencils: " + text(origin) + " as " +
                                     node_name(*inspection_, made) + ", and " + text(*known) +
                                     " in " + inspection_->name(known->element);
        if (!inspection_->offers(Feature::hanging_parents)) {
            Inspection::fail(Law::one_stencil, sentence);
        }
        inspection_->fail_if_hanging(made.node().place, Law::one_stencil, sentence);
    }

private:
    /// How a node is made: what is compared, and what is printed.
    struct Origin {
        NodeKey signature = 0;    // hash of the keys and weights of the parents
        std::size_t element = 0;  // that made the node first
        std::size_t first = 0;    // of its parents in parents_
        std::size_t count = 0;
    };
    struct WeightedPoint {
        double weight;
        Point x;
    };

    /// As in "0.5 * (0, 0, 0) + 0.5 * (1, 0, 0)".
    std::string text(const Origin& origin) const {
        std::string sum;
        for (const auto& [weight, x] : std::span(parents_).subspan(origin.first, origin.count)) {
            std::array<char, 160> term;
            std::snprintf(term.data(), term.size(), "%s%g * (%g, %g, %g)", sum.empty() ? "" : " + ",
                          weight, x[0], x[1], x[2]);
            sum += term.data();
        }
        return sum;
    }

    Inspection* inspection_;
    KeyTable<NodeKey, Origin> origins_;  // of new nodes, by place
    std::vector<WeightedPoint> parents_;
};

/// A node has one key, no two nodes have the same one, and keys are below node_count().
class KeyLaw final : public GridLaw {
public:
    explicit KeyLaw(Inspection& inspection) : inspection_{&inspection} {}

    void visit(const MadeNode& made) override {
        const NodeKey key = made.node().key;
        const std::size_t count = inspection_->facts().node_count;
        if (count > 0 && key >= count) {
            Inspection::fail(Law::dense_key, "the key of " + node_name(*inspection_, made) +
                                                 " is not below node_count()");
        }
        const KnownNodes& nodes = inspection_->nodes();
        if (nodes[made.known].key != key) {
            Inspection::fail(Law::one_stencil,
                             "one node has two keys: as " + both_names(*inspection_, made));
        }
        const std::size_t first = *nodes.find_key(key);
        if (first == made.known) return;
        Inspection::fail(Law::key_place, node_name(*inspection_, made) +
                                             " has the key of a node at another place, made by " +
                                             inspection_->name(nodes[first].element));
    }

private:
    Inspection* inspection_;
};

/// The field gives each node one value, a finite number.
class ValueLaw final : public GridLaw {
public:
    explicit ValueLaw(Inspection& inspection) : inspection_{&inspection} {}

    void visit(const MadeNode& made) override {
        const NodeKey place = made.node().place;
        if (!made.has_value) {
            const char* const which = made.stencil == nullptr ? "corner" : "new node";
            inspection_->fail_unless_hidden(place, Law::value_present,
                                            "the field lacks a value at a " + std::string(which) +
                                                " of " + inspection_->name(made.element.step));
        }
        for (const double value : made.values) check_finite(made, value);
        if (made.is_new) return;
        const auto known = inspection_->nodes().values(made.known, made.values.size());
        const auto component = find_difference(made.values, known);
        if (!component) return;
        inspection_->fail_unless_hidden(
            place, Law::value_unique,
            "the field gives one node two values, " + all_digits(made.values[*component]) +
                " and " + all_digits(known[*component]) + ": as " + both_names(*inspection_, made));
    }

private:
    void check_finite(const MadeNode& made, double value) {
        if (std::isfinite(value)) return inspection_->nodes().note_value(value);
        const std::size_t corners = made.element.corners().size();
        const std::string which = made.stencil == nullptr
                                      ? "corner " + std::to_string(made.number)
                                      : "new node " + std::to_string(made.number - corners);
        inspection_->fail_unless_hidden(made.node().place, Law::value_finite,
                                        "the field's value at " + which + " of " +
                                            inspection_->name(made.element.step) +
                                            " is not a finite number");
    }
    /// The first component in which values differ.
    std::optional<std::size_t> find_difference(std::span<const double> values,
                                               std::span<const double> known) const {
        const double tolerance =
            inspection_->options().node_value_tolerance * inspection_->nodes().largest_value();
        for (std::size_t q = 0; q < values.size(); ++q) {
            if (!(std::abs(values[q] - known[q]) <= tolerance)) return q;
        }
        return std::nullopt;
    }

    Inspection* inspection_;
};

}  // namespace

GridLawPointer stencil_law(Inspection& inspection) {
    return std::make_unique<StencilLaw>(inspection);
}
GridLawPointer key_law(Inspection& inspection) { return std::make_unique<KeyLaw>(inspection); }
GridLawPointer value_law(Inspection& inspection) { return std::make_unique<ValueLaw>(inspection); }

}  // namespace nestgrid::detail
