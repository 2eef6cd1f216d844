// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The laws that check_grid asks. All borrow the inspection.
#pragma once

#include <memory>

#include "grid_law.hpp"
#include "inspection.hpp"

namespace nestgrid::detail {

using GridLawPointer = std::unique_ptr<GridLaw>;

// Coarse elements, and how they fit together (coarse_laws.cpp).
GridLawPointer coarse_shape_law(Inspection& inspection);
GridLawPointer coarse_node_law(Inspection& inspection);
GridLawPointer coarse_volume_law(Inspection& inspection);
GridLawPointer coarse_face_law(Inspection& inspection);
GridLawPointer coarse_contact_law(Inspection& inspection);

// Elements and their children (split_laws.cpp).
GridLawPointer depth_law(Inspection& inspection);
GridLawPointer own_corner_law(Inspection& inspection);
GridLawPointer rule_law(Inspection& inspection);
GridLawPointer repetition_law(Inspection& inspection);
GridLawPointer hidden_law(Inspection& inspection);
GridLawPointer presence_law(Inspection& inspection);

// Nodes (node_laws.cpp).
GridLawPointer stencil_law(Inspection& inspection);
GridLawPointer key_law(Inspection& inspection);
GridLawPointer value_law(Inspection& inspection);

/// Finds the nodes that hang, and tells KnownNodes.
GridLawPointer hanging_law(Inspection& inspection);
/// Requires that the hanging law stands before it.
GridLawPointer degree_law(Inspection& inspection);
/// The same.
GridLawPointer curved_law(Inspection& inspection);

}  // namespace nestgrid::detail
