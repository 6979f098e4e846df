/* Regolith under one footpad, taken at one point: the centre of its base.

   Normal force: rate-independent compaction, F = phi K d_m, phi = 1 - (d_m - d)/b in [0, 1], d_m the greatest depth so far.
   Tangential: Coulomb's friction, mu F v/sqrt(v^2 + v_s^2) against the slip. No plowing, no damping, no torque: a simpler soil than
   RegolithContact's on purpose.

   The pad is integrated here against the law over the interval, with the reduced interface model the leg offers:
       a = a_f + Y F + A_x (x - x_n - V_b t - A_b t^2/2) + A_v (v - v_n - A_b t)
   by small steps, implicit in A_v. Without that a force that knows nothing of the pad's motion until the interval is over would need
   intervals of microseconds. */

#include <math.h>
#include <string.h>
#include "unit.h"

typedef struct { double x[3], v[3], f[3], depth; } Pad;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void apply(const double m[9], const double a[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = dot(m + 3 * i, a);
}

static void inverse(const double m[9], double out[9]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out[3 * i + j] = m[3 * a + c] * m[3 * b + d] - m[3 * a + d] * m[3 * b + c];
        }
    double determinant = m[0] * out[0] + m[1] * out[3] + m[2] * out[6];
    for (int k = 0; k < 9; k++) out[k] /= determinant;
}

static void normal(const double v[], double n[3]) {
    double slope = v[GROUND_SLOPE], azimuth = v[GROUND_AZIMUTH];
    n[0] = cos(slope);
    n[1] = sin(slope) * sin(azimuth);
    n[2] = -sin(slope) * cos(azimuth);
}

/* Of the base's centre, `footpad_height` below the ball joint along the surface's normal. */
static double depth_of(const double v[], const double n[3], const double x[3]) {
    double from[3] = {x[0] - v[GROUND_ORIGIN], x[1] - v[GROUND_ORIGIN + 1], x[2] - v[GROUND_ORIGIN + 2]};
    return v[FOOTPAD_HEIGHT] - dot(n, from);
}

static void push(double v[], const double n[3], Pad* p) {
    p->depth = depth_of(v, n, p->x);
    memset(p->f, 0, sizeof p->f);
    if (p->depth <= 0.0) return;
    if (p->depth > v[DEEPEST]) v[DEEPEST] = p->depth;
    double share = 1.0 - (v[DEEPEST] - p->depth) / v[REBOUND_BAND];
    if (share <= 0.0) return;
    double force = share * v[BEARING_STRENGTH] * v[DEEPEST], sinking = dot(n, p->v), slip[3];
    for (int i = 0; i < 3; i++) slip[i] = p->v[i] - sinking * n[i];
    double k = v[FRICTION] * force / sqrt(dot(slip, slip) + v[SLIP_VELOCITY] * v[SLIP_VELOCITY]);
    for (int i = 0; i < 3; i++) p->f[i] = force * n[i] - k * slip[i];
}

static void show(double v[], const double n[3], const Pad* p) {
    v[PENETRATION] = p->depth;
    v[GAP] = -p->depth / n[0];
    v[NORMAL_FORCE] = dot(n, p->f);
    v[CONTACT] = p->depth > 0.0;
    v[SKID] = sqrt(dot(v + SLIDE, v + SLIDE));
    for (int i = 0; i < 3; i++) {
        v[PAD_FORCE + i] = p->f[i];
        v[PAD_PREDICTED_POSITION + i] = p->x[i];
        v[PAD_PREDICTED_VELOCITY + i] = p->v[i];
    }
}

const char* unit_start(double v[VALUES], double time) {
    double n[3];
    Pad pad;
    if (v[LONGEST_SUBSTEP] <= 0.0) return "longest_substep is not positive, expects e.g. 2e-6 s";
    normal(v, n);
    memcpy(pad.x, v + PAD_POSITION, sizeof pad.x);
    memcpy(pad.v, v + PAD_VELOCITY, sizeof pad.v);
    push(v, n, &pad);
    show(v, n, &pad);
    memcpy(v + PAD_FORCE_MEAN, pad.f, sizeof pad.f);
    return 0;
}

const char* unit_step(double v[VALUES], double time, double step) {
    const double *x0 = v + PAD_POSITION, *v0 = v + PAD_VELOCITY, *base = v + PAD_MODEL_BASE_VELOCITY;
    const double* accelerated = v + PAD_MODEL_BASE_ACCELERATION;
    double n[3], matrix[9], solve[9], before[3], impulse[3] = {0.0, 0.0, 0.0};
    if (!(step > 0.0)) return "the step is not positive";
    int count = (int)ceil(step / v[LONGEST_SUBSTEP]);
    double h = step / count;
    Pad pad;
    normal(v, n);
    memcpy(pad.x, x0, sizeof pad.x);
    memcpy(pad.v, v0, sizeof pad.v);
    for (int k = 0; k < 9; k++) matrix[k] = (k % 4 == 0) - h * v[PAD_MODEL_DAMPING + k];
    inverse(matrix, solve);
    push(v, n, &pad);
    memcpy(before, pad.f, sizeof before);
    for (int s = 0; s < count; s++) {
        double t = s * h, lag[3], drift[3], stiff[3], damped[3], pushed[3], next[3];
        for (int i = 0; i < 3; i++) {
            lag[i] = pad.x[i] - x0[i] - base[i] * t - 0.5 * accelerated[i] * t * t;
            drift[i] = v0[i] + accelerated[i] * (t + h);
        }
        apply(v + PAD_MODEL_STIFFNESS, lag, stiff);
        apply(v + PAD_MODEL_DAMPING, drift, damped);
        apply(v + PAD_MODEL_MOBILITY, pad.f, pushed);
        for (int i = 0; i < 3; i++) next[i] = pad.v[i] + h * (v[PAD_MODEL_ACCELERATION + i] + pushed[i] + stiff[i] - damped[i]);
        apply(solve, next, pad.v);
        for (int i = 0; i < 3; i++) {
            pad.x[i] += h * pad.v[i];
            impulse[i] += h * pad.f[i];
        }
        v[PAD_WORK] -= h * dot(pad.f, pad.v);
        double sinking = dot(n, pad.v);
        for (int i = 0; i < 3; i++) v[SLIDE + i] += pad.depth > 0.0 ? h * (pad.v[i] - sinking * n[i]) : 0.0;
        push(v, n, &pad);
    }
    show(v, n, &pad);
    for (int i = 0; i < 3; i++) {
        v[PAD_FORCE_MEAN + i] = impulse[i] / step;
        v[PAD_FORCE_SLOPE + i] = (pad.f[i] - before[i]) / step;
    }
    return isfinite(dot(pad.f, pad.f)) ? 0 : "the pad's motion is not finite; lower longest_substep";
}
