// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Memory of whole programs, of VTK's arrays too: malloc and its kin are counted in programs that
// link counted_heap.cpp. For glibc.
#pragma once

#include <cstddef>
#include <functional>

/// Bytes in use now, as the heap rounds them.
std::size_t heap_bytes();

/// The most bytes that were in use during a call, beyond those before it.
std::size_t peak_heap_bytes(const std::function<void()>& call);
