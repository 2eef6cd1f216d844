// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

/// Runs work() in a child process that has an X display, as Debian's VTK needs one to draw: that of
/// the environment or, where work() fails on it, an Xvfb for as long as it takes. What the work
/// prints is thrown away.
/// \param work returns whether it has succeeded
/// \throw nestgrid::IoError where work() succeeds on no display, or there is none
void run_with_display(const std::function<bool()>& work);
