/* A rate gyro that knows degrees: a first-order lag, exact for an input that runs straight over the step.

       y = u + k (t - tau) + (y0 - u + k tau) exp(-t/tau)        u the rate at the start of the step, k its slope */

#include <math.h>
#include "unit.h"

const char* unit_start(double v[VALUES], double time) {
    if (v[TIME_CONSTANT] <= 0.0) return "time_constant is not positive, expects e.g. 0.05 s";
    for (int i = 0; i < 3; i++) v[TELEMETRY_YAW + i] = v[RATES_YAW + 2 * i];
    return 0;
}

const char* unit_step(double v[VALUES], double time, double step) {
    double tau = v[TIME_CONSTANT], left = exp(-step / tau);
    for (int i = 0; i < 3; i++) {
        double u = v[RATES_YAW + 2 * i], k = v[RATES_YAW_SLOPE + 2 * i], *y = v + TELEMETRY_YAW + i;
        *y = u + k * (step - tau) + (*y - u + k * tau) * left;
    }
    return 0;
}
