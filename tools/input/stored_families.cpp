// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/hierarchy.hpp"

NESTGRID_STORED_FAMILIES()
