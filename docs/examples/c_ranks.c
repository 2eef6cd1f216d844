/* SPDX-FileCopyrightText: the nestgrid authors
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * A distributed grid in plain C over MPI: the square of c_grid.c, of which each rank has some of
 * the triangles on level 3, with all below them. All ranks draw one closed line.
 *     mpirun -n 4 c_ranks
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpi.h>

#include <nestgrid/algorithms/isosurface.h>

enum { LEVELS = 8, SHARED_LEVEL = 3, PARTS = 2 << (2 * SHARED_LEVEL) };

typedef struct {
    float x[3][2]; /* multiples of 2^-LEVELS: exact */
    int level;
    int part; /* of the parts below it, the first; of the one above it, the number */
} triangle;

static const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
static const int coarse_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
static const nestgrid_stencil midpoints[3] = {
    {2, {0, 1}, {0.5, 0.5}, 0}, {2, {1, 2}, {0.5, 0.5}, 0}, {2, {2, 0}, {0.5, 0.5}, 0}};
static const nestgrid_child quarters[4] = {{NESTGRID_TRIANGLE, {0, 3, 5}, 1},
                                           {NESTGRID_TRIANGLE, {3, 1, 4}, 1},
                                           {NESTGRID_TRIANGLE, {5, 4, 2}, 1},
                                           {NESTGRID_TRIANGLE, {3, 4, 5}, 1}};
static const nestgrid_rule red = {"red", NESTGRID_TRIANGLE, 3, midpoints, 4, quarters};

static triangle load(const nestgrid_element* e) {
    triangle t;
    memcpy(&t, e, sizeof t);
    return t;
}
static double circle(const float x[2]) { return hypot(x[0] - 0.4, x[1] - 0.55); }

static int is_leaf(const triangle* t) {
    const float centre[2] = {(t->x[0][0] + t->x[1][0] + t->x[2][0]) / 3,
                             (t->x[0][1] + t->x[1][1] + t->x[2][1]) / 3};
    return t->level >= LEVELS || fabs(circle(centre) - 0.3) >= ldexp(1.5, -t->level);
}
static void all_nodes(const triangle* t, float x[6][2]) {
    memcpy(x, t->x, sizeof t->x);
    for (int n = 0; n < 3; ++n) {
        for (int d = 0; d < 2; ++d) x[3 + n][d] = (x[n][d] + x[(n + 1) % 3][d]) / 2;
    }
}
static triangle child_of(const triangle* t, int c) {
    triangle child = {{{0}}, t->level + 1, t->part};
    float x[6][2];
    all_nodes(t, x);
    for (int k = 0; k < 3; ++k) memcpy(child.x[k], x[quarters[c].corner[k]], sizeof x[0]);
    if (t->level < SHARED_LEVEL) child.part += c << (2 * (SHARED_LEVEL - child.level));
    return child;
}

/* Ranks have the parts in order; a larger leaf is with its first part. */
static int presence_of(const nestgrid_ranks* ranks, const triangle* t) {
    if (t->level >= SHARED_LEVEL || is_leaf(t)) {
        return t->part * ranks->count / PARTS == ranks->rank ? 0 : 3;
    }
    int here = 0, elsewhere = 0, first = 0;
    for (int c = 0; c < 4; ++c) {
        const triangle child = child_of(t, c);
        const int is = presence_of(ranks, &child);
        if (c == 0) first = is;
        here += is == 0;
        elsewhere += is == 3;
    }
    return here == 4 ? 0 : elsewhere == 4 ? 3 : first <= 1 ? 1 : 2;
}

/* The grid and the field; self is the table of the ranks. */

static int presence(const void* self, void* context, const nestgrid_element* e, int* which) {
    const triangle t = load(e);
    (void)context;
    *which = presence_of(self, &t);
    return 0;
}
static int coarse_count(const void* self, size_t* count) {
    (void)self;
    *count = 2;
    return 0;
}
static int coarse(const void* self, void* context, size_t i, nestgrid_coarse* out) {
    triangle t = {{{0}}, 0, (int)i * PARTS / 2};
    (void)self;
    (void)context;
    memset(out, 0, sizeof *out);
    for (int k = 0; k < 3; ++k) {
        const int node = coarse_triangles[i][k];
        for (int d = 0; d < 2; ++d) out->corners[k][d] = t.x[k][d] = square[node][d];
        out->ids[k] = (uint64_t)node;
    }
    memcpy(&out->element, &t, sizeof t);
    out->shape = NESTGRID_TRIANGLE;
    out->orientation = 1;
    return 0;
}
static int split(const void* self, void* context, const nestgrid_element* e, int* rule) {
    const triangle t = load(e);
    (void)self;
    (void)context;
    *rule = is_leaf(&t) ? -1 : 0;
    return 0;
}
static int children(const void* self, void* context, const nestgrid_element* e, size_t count,
                    nestgrid_element* out) {
    const triangle t = load(e);
    (void)self;
    (void)context;
    for (size_t c = 0; c < count; ++c) {
        const triangle child = child_of(&t, (int)c);
        memset(&out[c], 0, sizeof out[c]);
        memcpy(&out[c], &child, sizeof child);
    }
    return 0;
}
/* A solver that has no value of a node here sets its bit in *missing. */
static int coarse_values(const void* self, void* context, size_t i, size_t count, void* out,
                         uint64_t* missing) {
    (void)self;
    (void)context;
    for (size_t k = 0; k < count; ++k) {
        ((double*)out)[k] = circle(square[coarse_triangles[i][k]]);
    }
    *missing = 0;
    return 0;
}
static int new_values(const void* self, void* context, const nestgrid_element* e, uint64_t which,
                      size_t count, void* out, uint64_t* missing) {
    const triangle t = load(e);
    float x[6][2];
    (void)self;
    (void)context;
    all_nodes(&t, x);
    for (size_t n = 0; n < count; ++n) {
        if (which >> n & 1) ((double*)out)[n] = circle(x[3 + n]);
    }
    *missing = 0;
    return 0;
}

/* The ranks, by MPI. */
/* [ranks] */
typedef struct {
    MPI_Comm communicator; /* one of its own */
    int count;
    int *sent, *from, *received, *to; /* bytes for each rank and of each, and where they begin */
    char *out, *in;
    nestgrid_message* messages;
} connection;

/* Receives into c->in what c->received says. */
static size_t tell(connection* c) {
    size_t count = 0;
    for (int r = 0; r < c->count; ++r) {
        c->messages[count] = (nestgrid_message){r, (size_t)c->received[r], c->in + c->to[r]};
        if (c->received[r] > 0) ++count;
    }
    return count;
}
static int sums(const int* sizes, int* begins, int count) {
    int sum = 0;
    for (int r = 0; r < count; ++r) {
        begins[r] = sum;
        sum += sizes[r];
    }
    return sum;
}
static int exchange(void* self, size_t sent, const nestgrid_message* to, size_t* received,
                    const nestgrid_message** from) {
    connection* c = self;
    memset(c->sent, 0, sizeof(int) * (size_t)c->count);
    for (size_t i = 0; i < sent; ++i) c->sent[to[i].rank] = (int)to[i].size;
    c->out = realloc(c->out, (size_t)sums(c->sent, c->from, c->count) + 1);
    for (size_t i = 0; i < sent; ++i) memcpy(c->out + c->from[to[i].rank], to[i].bytes, to[i].size);
    MPI_Alltoall(c->sent, 1, MPI_INT, c->received, 1, MPI_INT, c->communicator);
    c->in = realloc(c->in, (size_t)sums(c->received, c->to, c->count) + 1);
    MPI_Alltoallv(c->out, c->sent, c->from, MPI_BYTE, c->in, c->received, c->to, MPI_BYTE,
                  c->communicator);
    *received = tell(c);
    *from = c->messages;
    return 0;
}
static int gather(void* self, size_t size, const void* own, const nestgrid_message** from) {
    connection* c = self;
    int mine = (int)size;
    MPI_Allgather(&mine, 1, MPI_INT, c->received, 1, MPI_INT, c->communicator);
    c->in = realloc(c->in, (size_t)sums(c->received, c->to, c->count) + 1);
    MPI_Allgatherv(own, mine, MPI_BYTE, c->in, c->received, c->to, MPI_BYTE, c->communicator);
    for (int r = 0; r < c->count; ++r) {
        c->messages[r] = (nestgrid_message){r, (size_t)c->received[r], c->in + c->to[r]};
    }
    *from = c->messages;
    return 0;
}
static int reduce(void* self, size_t size, uint64_t* numbers, int how) {
    const connection* c = self;
    MPI_Allreduce(MPI_IN_PLACE, numbers, (int)size, MPI_UINT64_T,
                  how == NESTGRID_MAX   ? MPI_MAX
                  : how == NESTGRID_MIN ? MPI_MIN
                                        : MPI_SUM,
                  c->communicator);
    return 0;
}
/* [ranks] */

static int draw(nestgrid_ranks* ranks) {
    char message[300] = "";
    nestgrid_grid grid = {.size = sizeof grid,
                          .self = ranks,
                          .dimension = 2,
                          .rule_count = 1,
                          .rules = &red,
                          .coarse_count = coarse_count,
                          .coarse = coarse,
                          .split = split,
                          .children = children,
                          .presence = presence};
    nestgrid_field field = {.size = sizeof field,
                            .value_type = NESTGRID_DOUBLE,
                            .components = 1,
                            .coarse_values = coarse_values,
                            .new_values = new_values};
    nestgrid_options options = {.size = sizeof options, .error = 1e-4, .ranks = ranks};
    nestgrid_surface piece;
    nestgrid_joined joined = {.size = sizeof joined};
    if (nestgrid_isosurface_with(&grid, &field, 0.3, &options, &piece, message, sizeof message) ||
        nestgrid_join(&piece, &joined, message, sizeof message)) {
        fprintf(stderr, "no isoline: %s\n", message);
        return 1;
    }
    if (ranks->rank == 0) {
        printf("%d ranks, %llu segments in %llu lines, %llu open ends\n", ranks->count,
               (unsigned long long)joined.simplices, (unsigned long long)joined.components,
               (unsigned long long)joined.open);
    }
    nestgrid_joined_free(&joined);
    nestgrid_surface_free(&piece);
    return 0;
}

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    connection c = {.in = NULL};
    nestgrid_ranks ranks = {
        .size = sizeof ranks, .self = &c, .exchange = exchange, .gather = gather, .reduce = reduce};
    MPI_Comm_dup(MPI_COMM_WORLD, &c.communicator);
    MPI_Comm_rank(c.communicator, &ranks.rank);
    MPI_Comm_size(c.communicator, &ranks.count);
    c.count = ranks.count;
    int* numbers = calloc(4 * (size_t)c.count, sizeof *numbers);
    c.sent = numbers;
    c.from = numbers + c.count;
    c.received = numbers + 2 * c.count;
    c.to = numbers + 3 * c.count;
    c.messages = calloc((size_t)c.count + 1, sizeof *c.messages);
    const int failed = draw(&ranks);
    free(numbers);
    free(c.messages);
    free(c.in);
    free(c.out);
    MPI_Comm_free(&c.communicator);
    MPI_Finalize();
    return failed;
}
