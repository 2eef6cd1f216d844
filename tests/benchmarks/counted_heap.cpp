// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "counted_heap.hpp"

#include <malloc.h>

#include <atomic>
#include <cerrno>

namespace {

std::atomic<std::size_t> bytes = 0;
std::atomic<std::size_t> peak = 0;

void* taken(void* block) {
    const std::size_t size = malloc_usable_size(block);
    const std::size_t now = bytes.fetch_add(size, std::memory_order_relaxed) + size;
    std::size_t most = peak.load(std::memory_order_relaxed);
    while (now > most && !peak.compare_exchange_weak(most, now, std::memory_order_relaxed)) {
    }
    return block;
}

void give_back(void* block) {
    bytes.fetch_sub(malloc_usable_size(block), std::memory_order_relaxed);
}

}  // namespace

// glibc's own, under the names for those who take the place of malloc.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming)
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)

void* malloc(std::size_t size) { return taken(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) { return taken(__libc_calloc(count, size)); }
void* realloc(void* block, std::size_t size) {
    give_back(block);
    void* const moved = __libc_realloc(block, size);
    return taken(moved == nullptr && size != 0 ? block : moved);
}
void* memalign(std::size_t alignment, std::size_t size) {
    return taken(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
    *block = memalign(alignment, size);
    return *block == nullptr ? ENOMEM : 0;
}
void free(void* block) {
    give_back(block);
    __libc_free(block);
}
}

std::size_t heap_bytes() { return bytes; }

std::size_t peak_heap_bytes(const std::function<void()>& call) {
    const std::size_t before = bytes;
    peak = before;
    call();
    return peak - before;
}
