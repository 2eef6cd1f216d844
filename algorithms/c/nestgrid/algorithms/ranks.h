/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * The processes that each have a part of a distributed grid, for C and Fortran codes: how they send
 * each other messages. docs/examples/c_ranks.c does it by MPI.
 */
#ifndef NESTGRID_ALGORITHMS_RANKS_H
#define NESTGRID_ALGORITHMS_RANKS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a reduction makes of the numbers of all ranks. */
enum { NESTGRID_MAX = 0, NESTGRID_MIN, NESTGRID_SUM };

/** Bytes for a rank, or from one. */
typedef struct nestgrid_message {
    int rank;
    size_t size; /* number of bytes */
    const void* bytes;
} nestgrid_message;

/** The processes of a distributed grid, of which this is one. All ranks call the functions in the
 * same order, each by one thread, and they return 0, or another number where they fail. Messages of
 * the program itself must not be taken for these: over MPI, by a communicator of their own. */
typedef struct nestgrid_ranks {
    size_t size; /* sizeof the struct */
    void* self;  /* handed to every function */
    int rank;    /* of this process, 0 to count - 1 */
    int count;   /* of processes */
    /* Sends messages, at most one to each rank, perhaps to this one; most ranks get none. Receives
     * `received` messages, which stay valid until the next call. */
    int (*exchange)(void* self, size_t sent, const nestgrid_message* to, size_t* received,
                    const nestgrid_message** from);
    /* Gives each rank what each rank has: `count` messages in the order of ranks, which stay valid
     * until the next call. */
    int (*gather)(void* self, size_t size, const void* own, const nestgrid_message** from);
    /* Replaces each number by its greatest, its least or its sum over all ranks, as `how` says:
     * NESTGRID_MAX ... Sums are modulo 2^64. */
    int (*reduce)(void* self, size_t size, uint64_t* numbers, int how);
    /* Optional: a sentence that says why a function failed; or NULL. */
    const char* (*last_error)(void* self);
} nestgrid_ranks;

#ifdef __cplusplus
}
#endif

#endif
