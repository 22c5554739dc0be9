/* coupler_profile.c - velocity or pressure of the water on a line or a rectangle, written with the fields: a file <probe>.csv with a row for every
   point and time, so
   that one line reads it:  t, x, y, z, u, v, w = numpy.loadtxt("RUN/probe.csv", delimiter=",", skiprows=1, unpack=True).reshape(7, -1, n) */
#include <math.h>

#include "coupler_impl.h"

/* checks `to` and `samples` of a probe that names them: how many points, and where */
PetscErrorCode CouplerProbeSamples(CouplerProbe *probe)
{
  ProbeParams *p = &probe->params;
  char         key[2 * BY_NAME_MAX], option[2 * BY_NAME_MAX];
  PetscBool    has_to;
  PetscInt     n_differ = 0;
  PetscReal    total    = 1.0;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_to", probe->name));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &has_to));
  if (!has_to && !p->samples.n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.%s", probe->name, has_to ? "to" : "samples"));
  if (p->body[0] || (p->quantity != PROBE_VELOCITY && p->quantity != PROBE_PRESSURE)) {
    PetscFunctionReturn(InputError(key, "belongs to `velocity` or `pressure` of the water, without `body`"));
  }
  if (!has_to) PetscFunctionReturn(InputError(key, "needs `to`, the far end of the line that begins at `at`"));
  for (int k = 0; k < 3; k++) n_differ += p->to[k] != p->at[k];
  if (!n_differ) PetscFunctionReturn(InputError(key, "is the same place as `at`"));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.samples", probe->name));
  if (p->samples.n != 1 && p->samples.n != 2) PetscFunctionReturn(InputError(key, "expected the number of points: n on a line, [n, m] on a rectangle"));
  if (p->samples.n == 2 && n_differ != 2) {
    PetscFunctionReturn(InputError(key, "two numbers are for a rectangle: `at` and `to` must differ along two axes, and agree along the third"));
  }
  for (PetscInt k = 0; k < p->samples.n; k++) {
    if (p->samples.value[k] != PetscFloorReal(p->samples.value[k])) PetscFunctionReturn(InputError(key, "expected integers"));
    total *= p->samples.value[k];
  }
  if (total > 1e6) PetscFunctionReturn(InputError(key, "are %g points, more than a million", (double)total));
  probe->n_points = (PetscInt)total;
  probe->n_across = p->samples.n == 2 ? (PetscInt)p->samples.value[1] : 1;
  PetscCall(PetscSNPrintf(key, sizeof(key), "probes"));
  for (int k = 0; k < 2; k++) {
    static const char *const taken[] = {"ledger", "probes"};
    PetscBool                same;

    PetscCall(PetscStrcmp(probe->name, taken[k], &same));
    if (same) PetscFunctionReturn(InputError(key, "has a line or rectangle named %s, and %s.csv is another file of the run\ngive it another name", taken[k], taken[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* place of point j: along the line; on a rectangle the points along its first side (the lower axis) follow each other */
static void PointAt(const CouplerProbe *probe, PetscInt j, PetscReal x[3])
{
  const ProbeParams *p = &probe->params;
  const PetscInt     n = probe->n_points / probe->n_across, along = j % n, across = j / n;
  int                sides = 0;

  for (int k = 0; k < 3; k++) {
    const PetscBool second = (PetscBool)(probe->n_across > 1 && p->to[k] != p->at[k] && sides++ == 1);
    const PetscReal s      = second ? (PetscReal)across / (PetscReal)(probe->n_across - 1) : (PetscReal)along / (PetscReal)(n - 1);

    x[k] = p->at[k] + s * (p->to[k] - p->at[k]);
  }
}

PetscErrorCode CouplerProfileCreate(const CouplerProbe *probe, const char directory[], PetscBool append, PetscReal time, Table *table)
{
  static const char *const velocity[] = {"time [s]", "x [m]", "y [m]", "z [m]", "velocity_x [m/s]", "velocity_y [m/s]", "velocity_z [m/s]"};
  static const char *const pressure[] = {"time [s]", "x [m]", "y [m]", "z [m]", "pressure [Pa]"};
  const PetscBool          vector     = (PetscBool)(probe->params.quantity == PROBE_VELOCITY);
  char                     file[BY_NAME_MAX + 8];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s.csv", probe->name));
  ByCall(TableCreate(directory, file, vector ? 7 : 5, vector ? velocity : pressure, append, time, table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the values now; `nan` where no water is within h */
PetscErrorCode CouplerProfileWrite(Coupler c, const CouplerProbe *probe, Table table)
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < probe->n_points; j++) {
    PetscReal row[7] = {c->time}, *x = row + 1, pressure, velocity[3];
    PetscBool wet;

    PointAt(probe, j, x);
    PetscCall(SPHInterpolate(c->sph, x, &pressure, velocity, &wet));
    if (probe->params.quantity == PROBE_PRESSURE) row[4] = wet ? pressure : NAN;
    else
      for (int k = 0; k < 3; k++) row[4 + k] = wet ? velocity[k] : NAN;
    ByCall(TableWrite(table, row));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
