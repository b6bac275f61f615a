/* Calls every function of an object in every way and compares each bit with what the JIT gave for the same boxes and points.
 *
 *     driver FIXTURE LEVEL
 *
 * `table.c`, written with the fixture, lists the routines. LEVEL is what `unit_level()` must say; 0 accepts any. */
#include "table.h"
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
typedef struct { unsigned control; } environment;
static environment get_environment(void) { return (environment){_mm_getcsr()}; }
static void set_environment(environment e) { _mm_setcsr(e.control); }
/* The default; all flags set, downward, flushing (FTZ, DAZ); no exception masked, towards zero. */
static const environment environments[] = {{0x1f80}, {0x1f80 | 0x2000 | 0x8040 | 0x3f}, {0x6000}};
#elif defined(__aarch64__)
typedef struct { unsigned long control, flags; } environment;
static environment get_environment(void) {
    environment e;
    __asm__ volatile("mrs %0, fpcr\n mrs %1, fpsr" : "=r"(e.control), "=r"(e.flags));
    return e;
}
static void set_environment(environment e) {
    __asm__ volatile("msr fpcr, %0\n msr fpsr, %1" : : "r"(e.control), "r"(e.flags));
}
/* The default; all flags set, downward, flushing, NaNs replaced; towards zero. */
static const environment environments[] = {{0, 0}, {0x3800000, 0x1f}, {0xc00000, 0}};
#endif

static void fail(const struct routine *r, const char *what, size_t count) {
    printf("%s, %zu rows: %s\n", r->name, count, what);
    exit(1);
}

static double number(const char *p, size_t size) {
    float f;
    double d;
    if (size == 4) return memcpy(&f, p, 4), f;
    return memcpy(&d, p, 8), d;
}

/* Equal bits. A NaN is a NaN: its sign and payload are not specified and differ between processors. */
static int same(const char *a, const char *b, size_t size) {
    if (memcmp(a, b, size) == 0) return 1;
    double x = number(a, size), y = number(b, size);
    return x != x && y != y;
}

struct data {
    char *inputs, *parameters, *expected[2];
    uint32_t *verdicts[2];
};
static struct data *all;

static size_t ends(const struct routine *r) { return r->points ? 1 : 2; }

/* An array with bytes around it that must not change, at any address. */
struct guarded { char *whole, *bytes; size_t length; };

static struct guarded guard(size_t length, size_t misalignment) {
    struct guarded g = {malloc(length + 128 + misalignment), 0, length};
    memset(g.whole, 0xa5, length + 128 + misalignment);
    g.bytes = g.whole + 64 + misalignment;
    return g;
}

static int intact(struct guarded g) {
    for (size_t i = 1; i <= 64; i++)
        if ((unsigned char)g.bytes[-(long)i] != 0xa5 || (unsigned char)g.bytes[g.length + i - 1] != 0xa5) return 0;
    return 1;
}

/* numbers[count][width] to numbers[width][count]. */
static void transpose(char *to, const char *from, size_t count, size_t width, size_t size) {
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < width; j++) memcpy(to + (j * count + i) * size, from + (i * width + j) * size, size);
}

static void call(const struct routine *r, function f, const void *inputs, const void *parameters, void *outputs, uint32_t *verdicts,
                 size_t count, environment e) {
    set_environment(e);
    if (r->points)
        ((points_function)f)(inputs, parameters, outputs, count);
    else
        ((boxes_function)f)(inputs, parameters, outputs, verdicts, count);
    environment after = get_environment();
    set_environment(environments[0]);
    if (memcmp(&after, &e, sizeof e) != 0) fail(r, "the floating-point environment is not restored", count);
}

static void rows_or_columns(const struct routine *r, const struct data *d, size_t count, int columns, int defaults, int silent,
                            environment e, size_t misalignment) {
    size_t in_width = r->variables * ends(r), out_width = r->outputs * ends(r), size = r->size;
    struct guarded inputs = guard(count * in_width * size, misalignment);
    struct guarded outputs = guard(count * out_width * size, misalignment);
    struct guarded verdicts = guard(count * r->outputs * 4, misalignment);
    struct guarded parameters = guard(r->parameters * ends(r) * size, misalignment);
    memcpy(parameters.bytes, d->parameters, parameters.length);
    if (columns)
        transpose(inputs.bytes, d->inputs, count, in_width, size);
    else
        memcpy(inputs.bytes, d->inputs, inputs.length);
    call(r, columns ? r->columns : r->rows, inputs.bytes, defaults ? NULL : parameters.bytes, outputs.bytes,
         silent ? NULL : (uint32_t *)verdicts.bytes, count, e);
    if (!intact(inputs) || !intact(outputs) || !intact(verdicts)) fail(r, "written beyond an array", count);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < out_width; j++) {
            const char *got = outputs.bytes + (columns ? j * count + i : i * out_width + j) * size;
            const char *want = d->expected[defaults] + (i * out_width + j) * size;
            if (!same(got, want, size)) {
                printf("row %zu, number %zu: %a is not %a\n", i, j, number(got, size), number(want, size));
                fail(r, columns ? "columns" : "rows", count);
            }
        }
        for (size_t j = 0; j < r->outputs && !r->points && !silent; j++) {
            uint32_t got;
            memcpy(&got, verdicts.bytes + (columns ? j * count + i : i * r->outputs + j) * 4, 4);
            if (got != d->verdicts[defaults][i * r->outputs + j]) fail(r, "verdicts", count);
        }
    }
    free(inputs.whole), free(outputs.whole), free(verdicts.whole), free(parameters.whole);
}

static void store_negated(char *to, const char *from, size_t size) {
    memcpy(to, from, size);
    to[size - 1] ^= 0x80;
}

static void set_infinity(char *to, size_t size) {
    float f = 1.0f / 0.0f;
    double d = 1.0 / 0.0;
    memcpy(to, size == 4 ? (char *)&f : (char *)&d, size);
}

/* Lower and upper end as kernels take them. */
static void native(char *negated, char *upper, const char *interval, size_t size) {
    if (number(interval, size) <= number(interval + size, size)) {
        store_negated(negated, interval, size);
        memcpy(upper, interval + size, size);
    } else {
        set_infinity(negated, size), set_infinity(upper, size);
    }
}

static void packets(const struct routine *r, const struct data *d, int defaults, environment e) {
    size_t size = r->size, lanes = 64 / size, groups = (r->count + lanes - 1) / lanes;
    size_t in_slots = r->variables * ends(r), out_slots = r->outputs * (r->points ? 1 : 3);
    char *inputs = aligned_alloc(64, groups * in_slots * 64), *outputs = aligned_alloc(64, groups * out_slots * 64);
    char *uniforms = calloc(r->parameters * 2 + 1, size);
    for (size_t i = 0; i < groups * lanes; i++) {
        size_t row = i < r->count ? i : r->count - 1;
        for (size_t v = 0; v < r->variables; v++) {
            char *slot = inputs + ((i / lanes) * in_slots + v * ends(r)) * 64 + (i % lanes) * size;
            const char *from = d->inputs + (row * r->variables + v) * ends(r) * size;
            if (r->points)
                memcpy(slot, from, size);
            else
                native(slot, slot + 64, from, size);
        }
    }
    for (size_t p = 0; p < r->parameters; p++) {
        if (r->points)
            memcpy(uniforms + p * size, d->parameters + p * size, size);
        else
            native(uniforms + 2 * p * size, uniforms + (2 * p + 1) * size, d->parameters + 2 * p * size, size);
    }
    set_environment(e);
    ((packets_function)r->packets)(inputs, defaults ? NULL : uniforms, outputs, groups);
    environment after = get_environment();
    set_environment(environments[0]);
    if (memcmp(&after, &e, sizeof e) != 0) fail(r, "the floating-point environment is not restored", r->count);
    for (size_t i = 0; i < r->count; i++) {
        for (size_t o = 0; o < r->outputs; o++) {
            const char *slot = outputs + ((i / lanes) * out_slots + o * (r->points ? 1 : 3)) * 64 + (i % lanes) * size;
            const char *want = d->expected[defaults] + (i * r->outputs + o) * ends(r) * size;
            char got[16];
            if (r->points) {
                memcpy(got, slot, size);
            } else {
                store_negated(got, slot, size);
                memcpy(got + size, slot + 64, size);
                uint32_t verdict;
                memcpy(&verdict, slot + 128, 4);
                if (!r->silent && verdict != d->verdicts[defaults][i * r->outputs + o]) fail(r, "verdicts of packets", r->count);
            }
            for (size_t j = 0; j < ends(r); j++)
                if (!same(got + j * size, want + j * size, size)) fail(r, "packets", r->count);
        }
    }
    free(inputs), free(outputs), free(uniforms);
}

static void *all_rows(void *unused) {
    for (size_t i = 0; i < routines; i++) rows_or_columns(&table[i], &all[i], table[i].count, 0, 0, 0, environments[0], 0);
    return unused;
}

static void *take(FILE *file, size_t bytes) {
    void *memory = malloc(bytes + 1);
    if (fread(memory, 1, bytes, file) != bytes) printf("the fixture is too short\n"), exit(1);
    return memory;
}

int main(int argc, char **argv) {
    FILE *file = argc == 3 ? fopen(argv[1], "rb") : NULL;
    if (!file) return printf("usage: driver FIXTURE LEVEL\n"), 1;
    all = calloc(routines, sizeof *all);
    for (size_t i = 0; i < routines; i++) {
        const struct routine *r = &table[i];
        all[i].inputs = take(file, r->count * r->variables * ends(r) * r->size);
        all[i].parameters = take(file, r->parameters * ends(r) * r->size);
        for (int defaults = 0; defaults < 2; defaults++) {
            all[i].expected[defaults] = take(file, r->count * r->outputs * ends(r) * r->size);
            all[i].verdicts[defaults] = r->points ? NULL : take(file, r->count * r->outputs * 4);
        }
    }
    if (fgetc(file) != EOF) return printf("the fixture is too long\n"), 1;

    /* Eight threads make the first calls, before the level is known. */
    pthread_t threads[8];
    for (int i = 0; i < 8; i++) pthread_create(&threads[i], NULL, all_rows, NULL);
    for (int i = 0; i < 8; i++) pthread_join(threads[i], NULL);
    unsigned level = unit_level(), wanted = (unsigned)atoi(argv[2]);
    if (wanted && level != wanted) return printf("level %u is not %u\n", level, wanted), 1;
    if (unit_abi != 1) return printf("the ABI's version is %u\n", unit_abi), 1;

    for (size_t i = 0; i < routines; i++) {
        const struct routine *r = &table[i];
        static const size_t counts[] = {0, 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 33};
        for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
            for (int columns = 0; columns < 2; columns++)
                if (counts[c] <= r->count)
                    rows_or_columns(r, &all[i], counts[c], columns, c % 2, c % 3 == 2, environments[c % 3], c % 4);
        for (int k = 0; k < 4; k++)
            rows_or_columns(r, &all[i], r->count, k % 2, k / 2, 0, environments[k % 3], k == 3);
        for (int k = 0; k < 2; k++) packets(r, &all[i], k, environments[k + 1]);
    }
    printf("%zu routines agree with the JIT at level %u\n", routines, level);
    return 0;
}
