/* Guidance, navigation and control of the last seconds: descent-rate hold, attitude hold with jets, engine cut-off on contact.

   Sampled. At each sample, with what the inputs were then:
       engine   T = m (g + (-w_c - v_x)/tau) / cos(tilt), within its limits; v_x up, w_c the descent rate commanded
       jets     about each axis, s = (angle - command) + lead * rate;  |s| > deadband: full torque against s, else none
       contact  of any pad: from the next sample on neither jets nor engine, whose thrust falls to zero over decay_time
   Between samples everything is held. Angles are small: yaw, pitch and roll are taken as turns about X, Y and Z. */

#include <math.h>
#include "unit.h"

enum { DESCENT = 1, SHUT_DOWN = 2 };
static const double LATE = 1e-9;   /* s: a step that starts this much before a sample is at it */

static double clipped(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

static int touching(const double v[]) {
    for (int k = 0; k < 8; k++)
        if (v[CONTACT1 + k] != 0.0) return 1;
    return 0;
}

static void give(double v[], double thrust, const double torque[3]) {
    v[ENGINE_THRUST] = v[ENGINE_FORCE] = thrust;
    for (int i = 0; i < 3; i++) v[ENGINE_TORQUE + i] = torque[i];
    v[ENGINE_ON] = thrust > 0.0;
}

static double descent_thrust(const double v[]) {
    double upright = cos(v[ATTITUDE_PITCH]) * cos(v[ATTITUDE_ROLL]);
    double wanted = v[GRAVITY] + (-v[DESCENT_RATE] - v[BODY_VELOCITY]) / v[RATE_TIME];
    return clipped(v[MASS] * wanted / clipped(upright, 0.5, 1.0), v[THRUST_MINIMUM], v[THRUST_MAXIMUM]);
}

static void sample(double v[], double time) {
    double torque[3] = {0.0, 0.0, 0.0};
    if (v[PHASE] == DESCENT && touching(v)) {
        v[PHASE] = SHUT_DOWN;
        v[SHUT_DOWN_TIME] = time;
        v[THRUST_AT_SHUT_DOWN] = v[ENGINE_THRUST];
    }
    if (v[PHASE] == SHUT_DOWN) {
        double left = v[DECAY_TIME] > 0.0 ? 1.0 - (time - v[SHUT_DOWN_TIME]) / v[DECAY_TIME] : 0.0;
        give(v, left > 0.0 ? left * v[THRUST_AT_SHUT_DOWN] : 0.0, torque);
        return;
    }
    for (int i = 0; i < 3; i++) {
        double s = v[ATTITUDE_YAW + i] - v[ATTITUDE_COMMAND + i] + v[LEAD] * v[RATES_YAW + i];
        if (fabs(s) > v[DEADBAND]) torque[i] = s > 0.0 ? -v[JET_TORQUE + i] : v[JET_TORQUE + i];
    }
    give(v, descent_thrust(v), torque);
}

const char* unit_start(double v[VALUES], double time) {
    double torque[3] = {0.0, 0.0, 0.0};
    if (v[MASS] <= 0.0) return "mass is not positive, expects kg of the vehicle";
    if (v[SAMPLE_TIME] <= 0.0) return "sample_time is not positive, expects e.g. 0.05 s";
    if (v[RATE_TIME] <= 0.0) return "rate_time is not positive, expects e.g. 0.5 s";
    if (v[THRUST_MAXIMUM] < v[THRUST_MINIMUM]) return "thrust_maximum is below thrust_minimum; exchange them";
    v[PHASE] = DESCENT;
    v[NEXT_EVENT_TIME] = time;
    give(v, clipped(v[MASS] * v[GRAVITY], v[THRUST_MINIMUM], v[THRUST_MAXIMUM]), torque);
    return 0;
}

const char* unit_step(double v[VALUES], double time, double step) {
    if (time >= v[NEXT_EVENT_TIME] - LATE) sample(v, time);
    while (v[NEXT_EVENT_TIME] < time + LATE) v[NEXT_EVENT_TIME] += v[SAMPLE_TIME];
    return 0;
}
