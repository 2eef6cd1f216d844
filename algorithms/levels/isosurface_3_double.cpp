// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <levels/isosurface_engine.hpp>

template class nestgrid::engine::IsosurfaceVisitor<3, double, true>;
template class nestgrid::engine::IsosurfaceVisitor<3, double, false>;
