/* The least value of Himmelblau's function on [-5, 5]^2, proved by branch and bound: boxes whose lower bound is above a
 * value that is certainly taken somewhere hold no minimum and are dropped, the others are cut in four. The kernels come
 * from ../himmelblau.imp; nothing of Imp is in this program. */

#include "himmelblau.h"

#include <stdio.h>
#include <stdlib.h>

enum { MOST = 1 << 14 };

/* Boxes in rows: lower and upper end of x, then of y. */
static double boxes[MOST][2][2], parts[4 * MOST][2][2];
static double bounds[4 * MOST][2], middles[4 * MOST][2][2], values[4 * MOST][2];

int main(void)
{
    size_t count = 1, round, evaluated = 0;
    double best = INFINITY, least = 0.0;

    printf("code for level %u\n", (unsigned)himmelblau_level());
    if (himmelblau_level() == 0) {
        return 1;
    }
    boxes[0][0][0] = boxes[0][1][0] = -5.0;
    boxes[0][0][1] = boxes[0][1][1] = 5.0;
    for (round = 0; round < 26; round++) {
        size_t i, k, kept = 0;
        for (i = 0; i < count; i++) {
            for (k = 0; k < 4; k++) {
                int axis;
                for (axis = 0; axis < 2; axis++) {
                    double lo = boxes[i][axis][0], hi = boxes[i][axis][1], middle = 0.5 * (lo + hi);
                    int upper = axis == 0 ? k % 2 : k / 2;
                    double *part = parts[4 * i + k][axis];
                    part[0] = upper ? middle : lo;
                    part[1] = upper ? hi : middle;
                    /* A box of one point: what is taken there is certainly taken. */
                    middles[4 * i + k][axis][0] = middles[4 * i + k][axis][1] = 0.5 * (part[0] + part[1]);
                }
            }
        }
        himmelblau_f_interval(&parts[0][0][0], NULL, &bounds[0][0], NULL, 4 * count);
        himmelblau_f_interval(&middles[0][0][0], NULL, &values[0][0], NULL, 4 * count);
        evaluated += 8 * count;
        for (i = 0; i < 4 * count; i++) {
            if (values[i][1] < best) {
                best = values[i][1];
            }
        }
        least = INFINITY;
        for (i = 0; i < 4 * count; i++) {
            if (bounds[i][0] <= best && kept < MOST) {
                if (bounds[i][0] < least) {
                    least = bounds[i][0];
                }
                for (k = 0; k < 4; k++) {
                    boxes[kept][k / 2][k % 2] = parts[i][k / 2][k % 2];
                }
                kept++;
            }
        }
        if (kept == MOST) {
            fprintf(stderr, "too many boxes\n");
            return 1;
        }
        count = kept;
    }
    printf("the minimum lies in [%.3g, %.3g]; %lu boxes are left of %lu bounds\n", least, best,
           (unsigned long)count, (unsigned long)evaluated);
    if (!(least <= 0.0 && best >= 0.0 && best - least < 1e-10)) {
        fprintf(stderr, "wrong: the minimum is 0\n");
        return 1;
    }
    /* The minimum at (3, 2), by name, and for all a in [10.9, 11.1]. */
    {
        const double about[4] = {10.9, 11.1, 7.0, 7.0};
        const double outside[4] = {10.9, 12.1, 7.0, 7.0};
        imp_interval three = {3.0, 3.0}, two = {2.0, 2.0};
        imp_enclosure exact = himmelblau_f_interval_at(three, two, NULL);
        imp_enclosure wide = himmelblau_f_interval_at(three, two, about);
        printf("f(3, 2) = [%g, %g], for a in [10.9, 11.1]: [%g, %g]\n", exact.lo, exact.hi, wide.lo, wide.hi);
        if (exact.lo != 0.0 || exact.hi != 0.0 || himmelblau_f_value_at(3.0, 2.0, NULL) != 0.0) {
            return 1;
        }
        if (wide.lo > 0.0 || wide.hi < 0.0099 || wide.hi > 0.0101) {
            return 1;
        }
        if (!himmelblau_f_in_range(about) || himmelblau_f_in_range(outside)) {
            return 1;
        }
    }
    return 0;
}
