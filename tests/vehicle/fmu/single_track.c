/* A linear single-track car at a speed of its own, in co-simulation, for FMI 2.0 and, with -DFMI3, for FMI 3.0.
   Runge-Kutta of fourth order at 0.25 ms. Velocities are those of the rear axle. */
#include <stdlib.h>
#include <string.h>

enum { DELTA, THROTTLE, BRAKE, V, VY, R, V0, VG, COUNT };
typedef struct { double v[COUNT]; } Car;
static const double M = 1200.0, I = 1800.0, LF = 1.2, LR = 1.4, CF = 90000.0, CR = 110000.0, H = 0.00025;

static void slopes(const Car *c, double vy, double r, double *dvy, double *dr) {
    double v = c->v[V] > 1.0 ? c->v[V] : 1.0, d = c->v[DELTA];
    double ff = CF * (d - (vy + LF * r) / v), fr = CR * (-(vy - LR * r) / v);
    *dvy = (ff + fr) / M - v * r;
    *dr = (LF * ff - LR * fr) / I;
}
static void out(Car *c) { c->v[VY] = c->v[VG] - LR * c->v[R]; }
static void start(Car *c) { c->v[V] = c->v[V0]; c->v[VG] = c->v[R] = 0.0; out(c); }
static void clear(Car *c) { memset(c->v, 0, sizeof c->v); }
static void step(Car *c, double dt) {
    int n = (int)(dt / H + 0.5);
    for (int k = 0; k < n; k++) {
        double y = c->v[VG], r = c->v[R], a1, b1, a2, b2, a3, b3, a4, b4;
        slopes(c, y, r, &a1, &b1);
        slopes(c, y + 0.5 * H * a1, r + 0.5 * H * b1, &a2, &b2);
        slopes(c, y + 0.5 * H * a2, r + 0.5 * H * b2, &a3, &b3);
        slopes(c, y + H * a3, r + H * b3, &a4, &b4);
        c->v[VG] = y + H * (a1 + 2 * a2 + 2 * a3 + a4) / 6;
        c->v[R] = r + H * (b1 + 2 * b2 + 2 * b3 + b4) / 6;
        c->v[V] += H * (3.0 * c->v[THROTTLE] - 8.0 * c->v[BRAKE]);
        if (c->v[V] < 0.0) c->v[V] = 0.0;
    }
    out(c);
}
/* What it is asked for and cannot do: to begin backwards, and to brake twice as hard as it can. Beyond that it has no
   number for its speed. */
static int begun(const Car *c) { return c->v[V0] < 0.0 ? 3 : 0; }
static int stepped(Car *c) {
    if (c->v[BRAKE] > 3.0) c->v[V] = 0.0 / 0.0;
    return c->v[BRAKE] == 2.0 ? 3 : 0;
}
#define API __attribute__((visibility("default")))
#ifndef FMI3
API const char *fmi2GetTypesPlatform(void) { return "default"; }
API const char *fmi2GetVersion(void) { return "2.0"; }
API int fmi2SetDebugLogging(void *c, int on, size_t n, const char **k) { return 0; }
API void *fmi2Instantiate(const char *n, int t, const char *g, const char *r, const void *f, int v, int l) {
    return calloc(1, sizeof(Car));
}
API void fmi2FreeInstance(void *c) { free(c); }
API int fmi2SetupExperiment(void *c, int a, double t, double s, int b, double e) { return 0; }
API int fmi2EnterInitializationMode(void *c) { return 0; }
API int fmi2ExitInitializationMode(void *c) { start(c); return begun(c); }
API int fmi2Terminate(void *c) { return 0; }
API int fmi2Reset(void *c) { clear(c); return 0; }
API int fmi2GetReal(void *c, const unsigned *r, size_t n, double *v) {
    for (size_t k = 0; k < n; k++) v[k] = ((Car *)c)->v[r[k]];
    return 0;
}
API int fmi2SetReal(void *c, const unsigned *r, size_t n, const double *v) {
    for (size_t k = 0; k < n; k++) ((Car *)c)->v[r[k]] = v[k];
    return 0;
}
API int fmi2DoStep(void *c, double t, double dt, int p) { step(c, dt); return stepped(c); }
/* What nobody calls must be there all the same. */
#define NONE(name) API int fmi2##name(void) { return 3; }
NONE(GetInteger) NONE(GetBoolean) NONE(GetString) NONE(SetInteger) NONE(SetBoolean) NONE(SetString)
NONE(GetFMUstate) NONE(SetFMUstate) NONE(FreeFMUstate) NONE(SerializedFMUstateSize) NONE(SerializeFMUstate)
NONE(DeSerializeFMUstate) NONE(GetDirectionalDerivative) NONE(SetRealInputDerivatives)
NONE(GetRealOutputDerivatives) NONE(CancelStep) NONE(GetStatus) NONE(GetRealStatus) NONE(GetIntegerStatus)
NONE(GetBooleanStatus) NONE(GetStringStatus)
#undef NONE
#else
#include <stdbool.h>
/* What nobody calls must be there all the same. */
#define NONE(name) API int fmi3##name(void) { return 3; }
NONE(GetFloat32) NONE(GetInt8) NONE(GetUInt8) NONE(GetInt16) NONE(GetUInt16) NONE(GetInt32) NONE(GetUInt32)
NONE(GetInt64) NONE(GetUInt64) NONE(GetBoolean) NONE(GetString) NONE(GetBinary) NONE(GetClock) NONE(SetFloat32)
NONE(SetInt8) NONE(SetUInt8) NONE(SetInt16) NONE(SetUInt16) NONE(SetInt32) NONE(SetUInt32) NONE(SetInt64)
NONE(SetUInt64) NONE(SetBoolean) NONE(SetString) NONE(SetBinary) NONE(SetClock)
NONE(GetNumberOfVariableDependencies) NONE(GetVariableDependencies) NONE(GetFMUState) NONE(SetFMUState)
NONE(FreeFMUState) NONE(SerializedFMUStateSize) NONE(SerializeFMUState) NONE(DeserializeFMUState)
NONE(GetDirectionalDerivative) NONE(GetAdjointDerivative) NONE(EnterConfigurationMode) NONE(ExitConfigurationMode)
NONE(GetIntervalDecimal) NONE(GetIntervalFraction) NONE(GetShiftDecimal) NONE(GetShiftFraction)
NONE(SetIntervalDecimal) NONE(SetIntervalFraction) NONE(SetShiftDecimal) NONE(SetShiftFraction)
NONE(EvaluateDiscreteStates) NONE(UpdateDiscreteStates) NONE(EnterEventMode) NONE(EnterStepMode)
NONE(GetOutputDerivatives)
NONE(ActivateModelPartition) NONE(CompletedIntegratorStep) NONE(EnterContinuousTimeMode)
NONE(GetContinuousStateDerivatives) NONE(GetContinuousStates) NONE(GetEventIndicators)
NONE(GetNominalsOfContinuousStates) NONE(GetNumberOfContinuousStates) NONE(GetNumberOfEventIndicators)
NONE(InstantiateModelExchange) NONE(InstantiateScheduledExecution) NONE(SetContinuousStates) NONE(SetTime)
#undef NONE
API const char *fmi3GetVersion(void) { return "3.0"; }
API int fmi3SetDebugLogging(void *c, bool on, size_t n, const char **k) { return 0; }
API void *fmi3InstantiateCoSimulation(const char *n, const char *g, const char *r, bool v, bool l, bool e, bool y,
                                      const unsigned *q, size_t m, void *env, void *log, void *up) {
    return calloc(1, sizeof(Car));
}
API void fmi3FreeInstance(void *c) { free(c); }
API int fmi3EnterInitializationMode(void *c, bool a, double t, double s, bool b, double e) { return 0; }
API int fmi3ExitInitializationMode(void *c) { start(c); return begun(c); }
API int fmi3Terminate(void *c) { return 0; }
API int fmi3Reset(void *c) { clear(c); return 0; }
API int fmi3GetFloat64(void *c, const unsigned *r, size_t n, double *v, size_t m) {
    for (size_t k = 0; k < n; k++) v[k] = ((Car *)c)->v[r[k]];
    return 0;
}
API int fmi3SetFloat64(void *c, const unsigned *r, size_t n, const double *v, size_t m) {
    for (size_t k = 0; k < n; k++) ((Car *)c)->v[r[k]] = v[k];
    return 0;
}
API int fmi3DoStep(void *c, double t, double dt, bool p, bool *e, bool *x, bool *y, double *last) {
    *e = *x = *y = false;
    *last = t + dt;
    step(c, dt);
    return stepped(c);
}
#endif
