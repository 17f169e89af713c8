/* Seconds that a number of calls take, after one that finds caches and predictors as others left them. The clock is read
   outside of Python. */
#include <time.h>

typedef void kernel(const double *, const double *, double, double, double *, double *, double *, double *, long);

double timed(kernel *run, const double *gap, const double *rate, double zeta, double alpha, double *force,
             double *by_gap, double *by_rate, double *by_alpha, long count, int calls)
{
    struct timespec start, end;
    run(gap, rate, zeta, alpha, force, by_gap, by_rate, by_alpha, count);
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (int call = 0; call < calls; call++) {
        run(gap, rate, zeta, alpha, force, by_gap, by_rate, by_alpha, count);
        __asm__ volatile("" ::: "memory");
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    return (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
}
