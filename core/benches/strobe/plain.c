/* The stroboscopic map of x'' + H(x) (2 zeta x' + x) = A cos t + W in plain C, as one would write it with care: closed forms
 * between switches, steps until the sign of x changes, then Newton's method from the secant, kept within the bracket.
 *
 * Reads lines "periods step x v" and answers each with "nanoseconds x v". */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <time.h>

typedef struct {
    double zeta, load, drive; /* of the equation; the forcing has frequency one */
    double rate;              /* of the damped oscillation */
    double cosine, sine;      /* particular solution in contact: load + cosine cos t + sine sin t */
} oscillator;

/* A motion from phase t: its constants, and what they are multiplied with. */
typedef struct {
    double t, a, b;
    int contact;
} motion;

typedef struct {
    double x, v, cosine, sine;
} state;

static oscillator make(double zeta, double load, double drive) {
    oscillator o = {zeta, load, drive, sqrt(1 - zeta * zeta), 0, 0};
    /* At resonance (1 - 1) the cosine has no part. */
    o.sine = drive / (2 * zeta);
    return o;
}

static inline state at(const oscillator *o, const motion *m, double s) {
    state y;
    sincos(m->t + s, &y.sine, &y.cosine);
    if (m->contact) {
        double c, d;
        sincos(o->rate * s, &d, &c);
        double e = exp(-o->zeta * s);
        double u = e * (m->a * c + m->b * d);
        double w = e * (m->b * c - m->a * d);
        y.x = o->load + o->cosine * y.cosine + o->sine * y.sine + u;
        y.v = o->sine * y.cosine - o->cosine * y.sine - o->zeta * u + o->rate * w;
    } else {
        y.x = m->a + (m->b + 0.5 * o->load * s) * s - o->drive * y.cosine;
        y.v = m->b + o->load * s + o->drive * y.sine;
    }
    return y;
}

static inline motion begin(const oscillator *o, double t, state y, int contact) {
    motion m = {t, 0, 0, contact};
    if (contact) {
        m.a = y.x - o->load - o->cosine * y.cosine - o->sine * y.sine;
        m.b = (y.v - o->sine * y.cosine + o->cosine * y.sine + o->zeta * m.a) / o->rate;
    } else {
        m.a = y.x + o->drive * y.cosine;
        m.b = y.v - o->drive * y.sine;
    }
    return m;
}

static void period(const oscillator *o, double step, double *x, double *v) {
    state y = {*x, *v, 1, 0};
    motion m = begin(o, 0, y, *x > 0 || (*x == 0 && *v > 0));
    for (;;) {
        double left = 2 * M_PI - m.t, before = 0, s = 0, sign = m.contact ? 1 : -1;
        state last = y;
        for (;;) {
            before = s;
            last = y;
            s += step;
            if (s > left)
                s = left;
            y = at(o, &m, s);
            if (sign * y.x <= 0)
                break;
            if (s == left) {
                *x = y.x;
                *v = y.v;
                return;
            }
        }
        double low = before, high = s, guess = before + (s - before) * last.x / (last.x - y.x);
        for (int i = 0; i < 60; i++) {
            if (!(guess > low && guess < high))
                guess = 0.5 * (low + high);
            y = at(o, &m, guess);
            if (sign * y.x > 0)
                low = guess;
            else
                high = guess;
            double change = y.x / y.v;
            guess -= change;
            if (fabs(change) < 1e-8) {
                y = at(o, &m, guess);
                break;
            }
        }
        y.x = 0;
        m = begin(o, m.t + guess, y, !m.contact);
    }
}

int main(void) {
    oscillator o = make(0.032, 1.0, 1.78);
    long periods;
    double step, x, v;
    while (scanf("%ld %lf %lf %lf", &periods, &step, &x, &v) == 4) {
        struct timespec from, to;
        clock_gettime(CLOCK_MONOTONIC, &from);
        for (long i = 0; i < periods; i++)
            period(&o, step, &x, &v);
        clock_gettime(CLOCK_MONOTONIC, &to);
        double ns = 1e9 * (to.tv_sec - from.tv_sec) + (to.tv_nsec - from.tv_nsec);
        printf("%.0f %.17g %.17g\n", ns, x, v);
        fflush(stdout);
    }
    return 0;
}
