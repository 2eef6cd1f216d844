// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The whole of IsosurfaceVisitor, for the sources that instantiate it.
#pragma once

#include <levels/isosurface_bisections.hpp>
#include <levels/isosurface_cap.hpp>
#include <levels/isosurface_inspection.hpp>
#include <levels/isosurface_normals.hpp>
#include <levels/isosurface_plain.hpp>
#include <levels/isosurface_steps.hpp>
#include <levels/isosurface_tasks.hpp>
#include <levels/isosurface_transitions.hpp>
#include <levels/isosurface_vertices.hpp>
