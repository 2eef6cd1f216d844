// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the laws of check_grid share: the hierarchy, what is known of its nodes, the names of its
// elements, and the ways to say what is wrong.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/check_grid.hpp>

#include "known_nodes.hpp"

namespace nestgrid::detail {

/// What fail() throws.
struct ViolationFound {
    GridViolation violation;
};

class Inspection {
public:
    /// Hierarchy and options are borrowed.
    /// \param epsilon of the type that the field has
    Inspection(const Hierarchy<double>& hierarchy, double epsilon, const CheckOptions& options)
        : hierarchy_{&hierarchy}, epsilon_{epsilon}, options_{&options}, task_{hierarchy.open()} {}

    const Hierarchy<double>& hierarchy() const { return *hierarchy_; }
    const HierarchyFacts& facts() const { return hierarchy_->facts(); }
    bool offers(Feature feature) const { return hierarchy_->offers(feature); }
    std::size_t components() const { return static_cast<std::size_t>(facts().components); }
    const CheckOptions& options() const { return *options_; }
    Task* task() const { return task_.get(); }
    KnownNodes& nodes() { return nodes_; }

    /// How far values may be from those that they should have.
    /// \param ulps what rounding makes of them, in units of the field's epsilon
    double tolerance(int ulps) const;

    /// \return names an element by the way to it
    std::size_t add_step(std::size_t father, std::size_t number);
    std::size_t add_first_step(std::size_t coarse) { return add_step(no_step, coarse); }
    /// As in "element 3/0/1".
    std::string name(std::size_t step) const;

    /// What to say of an element of another shape than that of which all elements should be.
    std::string broken_promise() const;

    /// \throw ViolationFound
    [[noreturn]] static void fail(Law law, const std::string& sentence);
    /// Nobody looks at values of nodes that hidden leaves alone have. Which these are is known
    /// when all elements have been shown, so such violations wait.
    ///
    /// \throw ViolationFound where the hierarchy hides nothing
    void fail_unless_hidden(NodeKey place, Law law, const std::string& sentence);
    /// Throws what has waited so, and is not hidden.
    ///
    /// \throw ViolationFound
    void finish_hidden() const;
    /// Reports a node that may be made in two ways unless it hangs.
    void fail_if_hanging(NodeKey place, Law law, const std::string& sentence);
    /// Throws what waits for a node that turns out to hang.
    ///
    /// \throw ViolationFound
    void finish_hanging(NodeKey place, const std::string& more) const;
    /// Tells what is legal and may yet not be meant, where somebody listens.
    void note(const std::string& sentence) const;

private:
    struct Step {  // the way to an element
        std::size_t father;
        std::size_t number;
    };
    static constexpr std::size_t no_step = ~std::size_t{0};

    const Hierarchy<double>* hierarchy_;
    double epsilon_;
    const CheckOptions* options_;
    std::unique_ptr<Task> task_;
    std::vector<Step> steps_;
    KnownNodes nodes_;
    std::vector<std::pair<NodeKey, GridViolation>> unless_hidden_;  // in the order of their finding
    std::map<NodeKey, GridViolation> if_hanging_;
};

}  // namespace nestgrid::detail
