/* What a person writes: structure of arrays, one logarithm and one exponential a sample, or one square root. At a gap of zero
   the power is not guarded. */
#include <math.h>

#define ARGUMENTS                                                                                                      \
    const double *restrict gap, const double *restrict rate, double zeta, double alpha, double *restrict force,        \
        double *restrict by_gap, double *restrict by_rate, double *restrict by_alpha, long count

void power(ARGUMENTS)
{
    for (long i = 0; i < count; i++) {
        double logarithm = log(fabs(gap[i]));
        double slope = exp((alpha - 1) * logarithm);
        double value = slope * gap[i];
        force[i] = 2 * zeta * rate[i] + value;
        by_gap[i] = alpha * slope;
        by_rate[i] = 2 * zeta;
        by_alpha[i] = value * logarithm;
    }
}

/* Logarithms first, then exponentials: each loop keeps its constants in registers. The count is a multiple of the block. */
void power_in_blocks(ARGUMENTS)
{
    enum { BLOCK = 64 };
    double logarithm[BLOCK], slope[BLOCK];
    for (long start = 0; start < count; start += BLOCK) {
        for (long i = 0; i < BLOCK; i++)
            logarithm[i] = log(fabs(gap[start + i]));
        for (long i = 0; i < BLOCK; i++)
            slope[i] = exp((alpha - 1) * logarithm[i]);
        for (long i = 0; i < BLOCK; i++) {
            double value = slope[i] * gap[start + i];
            force[start + i] = 2 * zeta * rate[start + i] + value;
            by_gap[start + i] = alpha * slope[i];
            by_rate[start + i] = 2 * zeta;
            by_alpha[start + i] = value * logarithm[i];
        }
    }
}

void three_halves(ARGUMENTS)
{
    (void)alpha;
    (void)by_alpha;
    for (long i = 0; i < count; i++) {
        double root = sqrt(fabs(gap[i]));
        force[i] = 2 * zeta * rate[i] + gap[i] * root;
        by_gap[i] = 1.5 * root;
        by_rate[i] = 2 * zeta;
    }
}
