/* coupler_probes.c - gauges: points of bodies, pressure and velocity of the water, its height and flow, force and pressure on bodies, obstacles
   and walls. */
#include <math.h>

#include "coupler_impl.h"
#include "tled/tled_t10.h"

#define WATER PETSC_MIN_INT

/* Barycentric coordinates L of a point in the tetrahedron of four vertices, false when it is flat; with ten nodes those at which the
   quadratic map from L to places meets the point, by Newton's method. */
static PetscBool PlaceInElement(PetscInt n_nodes, const PetscReal X[], const PetscReal at[3], PetscReal L[4])
{
  double D[9], inverse[9], r[3], w[3], N[10];

  for (int a = 0; a < 3; a++) {
    for (int k = 0; k < 3; k++) D[3 * k + a] = X[3 * (a + 1) + k] - X[k];
  }
  if (Invert3(D, inverse) == 0.0) return PETSC_FALSE;
  Sub3(at, X, r);
  Mul3(inverse, r, w);
  for (int a = 0; a < 3; a++) L[a + 1] = w[a];
  L[0] = 1.0 - w[0] - w[1] - w[2];
  for (int pass = 0; pass < 8 && n_nodes == 10; pass++) {
    for (int a = 0; a < 4; a++)
      if (L[a] < -1.0 || L[a] > 2.0) return PETSC_FALSE; /* far outside, also of a curved element */
    TLEDShapeT10(L, N);
    for (int k = 0; k < 3; k++) {
      r[k] = at[k];
      for (int a = 0; a < 10; a++) r[k] -= N[a] * X[3 * a + k];
    }
    if (TLEDJacobianT10(L, X, inverse) == 0.0) return PETSC_FALSE;
    Mul3(inverse, r, w);
    for (int a = 0; a < 3; a++) L[a + 1] += w[a];
    L[0] = 1.0 - L[1] - L[2] - L[3];
  }
  return PETSC_TRUE;
}

/* Place of a point of the undeformed body, as weights of an element's nodes: the shape functions of the tetrahedron that holds it, else
   (up to a tenth of the body's size away) the nearest node. */
static PetscErrorCode LocatePoint(CouplerSurface *s, const char key[], const PetscReal at[3], CouplerProbe *probe)
{
  PetscInt         n_nodes, n_tets, n;
  const PetscInt  *tets;
  const PetscReal *X;
  PetscReal        nearest = PETSC_MAX_REAL, low[3], high[3], size = 0.0;

  PetscFunctionBegin;
  PetscCall(TLEDGetSize(s->tled, &n_nodes, &n_tets));
  PetscCall(TLEDGetMesh(s->tled, &n, &tets, &X));
  probe->n_nodes = n;
  for (PetscInt e = 0; e < n_tets; e++) {
    PetscReal x[30], L[4];

    for (PetscInt k = 0; k < 3 * n; k++) x[k] = X[3 * tets[n * e + k / 3] + k % 3];
    if (!PlaceInElement(n, x, at, L) || !(L[0] > -1e-9 && L[1] > -1e-9 && L[2] > -1e-9 && L[3] > -1e-9)) continue;
    for (PetscInt a = 0; a < n; a++) probe->node[a] = tets[n * e + a];
    if (n == 10) TLEDShapeT10(L, probe->weight);
    else PetscCall(PetscArraycpy(probe->weight, L, 4));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int k = 0; k < 3; k++) {
    low[k]  = PETSC_MAX_REAL;
    high[k] = PETSC_MIN_REAL;
  }
  for (PetscInt a = 0; a < n_nodes; a++) {
    double r[3];

    Sub3(at, &X[3 * a], r);
    for (int k = 0; k < 3; k++) {
      low[k]  = PetscMin(low[k], X[3 * a + k]);
      high[k] = PetscMax(high[k], X[3 * a + k]);
    }
    if (Norm3(r) >= nearest) continue;
    nearest = Norm3(r);
    for (PetscInt b = 0; b < n; b++) {
      probe->node[b]   = a;
      probe->weight[b] = b == 0;
    }
  }
  for (int k = 0; k < 3; k++) size = PetscMax(size, high[k] - low[k]);
  if (nearest > 0.1 * size) {
    PetscFunctionReturn(InputError(key, "is not in the body %s: its nearest node is %g m away\nthe body spans (%g, %g, %g) to (%g, %g, %g) m", s->name,
                                   (double)nearest, (double)low[0], (double)low[1], (double)low[2], (double)high[0], (double)high[1], (double)high[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindSurface(Coupler c, const char name[], PetscInt *surface)
{
  static const char *const walls[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  PetscBool                same;

  PetscFunctionBegin;
  *surface = WATER;
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    PetscCall(PetscStrcmp(c->surface[k].name, name, &same));
    if (same) *surface = k;
  }
  for (PetscInt k = 0; k < 6; k++) {
    PetscCall(PetscStrcmp(walls[k], name, &same));
    if (same && *surface == WATER) *surface = -1 - k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* whether the scene names <probe>.<key> */
static PetscBool IsNamed(const CouplerProbe *probe, const char key[])
{
  char      option[2 * BY_NAME_MAX];
  PetscBool named = PETSC_FALSE;

  (void)PetscSNPrintf(option, sizeof(option), "-%s_%s", probe->name, key);
  (void)PetscOptionsHasName(NULL, NULL, option, &named);
  return named;
}

/* the rectangle of a flow rate: flat along one axis */
static PetscErrorCode CheckRectangle(const CouplerProbe *probe, const char key[])
{
  const ProbeParams *p      = &probe->params;
  PetscInt           n_flat = 0;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    n_flat += p->min[k] == p->max[k];
    if (p->min[k] > p->max[k]) PetscFunctionReturn(InputError(key, "is below `min` along %c", "xyz"[k]));
  }
  if (n_flat != 1) PetscFunctionReturn(InputError(key, "must agree with `min` along one axis, the normal of the rectangle, and be above it along the others"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the box of a pressure on a wall, obstacle or body */
static PetscErrorCode CheckPatch(Coupler c, CouplerProbe *probe, const char key[])
{
  const ProbeParams *p = &probe->params;
  PetscReal          area, min[3], max[3];
  unsigned           walls, periodic;
  const PetscInt     wall = -1 - probe->surface;
  char               body[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++)
    if (p->min[k] > p->max[k]) PetscFunctionReturn(InputError(key, "is below `min` along %c", "xyz"[k]));
  if (probe->surface >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SPHGetDomain(c->sph, min, max, &walls, &periodic));
  PetscCall(PetscSNPrintf(body, sizeof(body), "%s.body", probe->name));
  if (!(walls >> wall & 1)) PetscFunctionReturn(InputError(body, "is an open side of the domain: pressure acts on walls\nadd it to domain.walls"));
  PetscCall(SPHAddPatch(c->sph, wall, p->min, p->max, &probe->patch));
  PetscCall(SPHGetPatch(c->sph, probe->patch, NULL, &area));
  if (!(area > 0)) PetscFunctionReturn(InputError(key, "makes a patch without area on the wall %s: it must be above `min` along the wall and overlap the domain", p->body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `min` and `max`: needed by a flow rate and by a pressure on a surface, by nothing else */
static PetscErrorCode CheckBox(Coupler c, CouplerProbe *probe)
{
  const ProbeParams *p       = &probe->params;
  const PetscBool    patch   = (PetscBool)(p->quantity == PROBE_PRESSURE && probe->surface != WATER);
  const PetscBool    needed  = (PetscBool)(patch || p->quantity == PROBE_FLOW_RATE);
  const char *const  words[] = {"min", "max"};
  char               key[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscSNPrintf(key, sizeof(key), "%s.%s", probe->name, words[k]));
    if (IsNamed(probe, words[k]) == needed) continue;
    if (!needed) PetscFunctionReturn(InputError(key, "belongs to `flow_rate`, and to `pressure` on a body, obstacle or wall"));
    PetscFunctionReturn(InputError(key, "is missing\n%s", patch ? "the pressure on a surface is averaged over the part of it in the box `min` to `max`, a spacing or more wide"
                                                                  : "the flow is counted through the rectangle `min` to `max`, flat along its normal"));
  }
  if (patch) ByCall(CheckPatch(c, probe, key));
  if (p->quantity == PROBE_FLOW_RATE) ByCall(CheckRectangle(probe, key));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsOfWater(int quantity)
{
  return (PetscBool)(quantity == PROBE_HEIGHT || quantity == PROBE_SURFACE || quantity == PROBE_FLOW_RATE);
}

static PetscErrorCode AddProbe(Coupler c, const char name[])
{
  CouplerProbe *probe = &c->probe[c->n_probes];
  char          prefix[2 * BY_NAME_MAX], key[2 * BY_NAME_MAX];
  ProbeParams  *p = &probe->params;
  PetscBool     is_body;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(probe->name, name, sizeof(probe->name)));
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", name));
  PetscCall(KeysSetDefaults(ProbeKeys, p));
  PetscCall(KeysSetFromOptions(ProbeKeys, prefix, p));
  PetscCall(FindSurface(c, p->body, &probe->surface));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.body", name));
  if (p->body[0] && probe->surface == WATER) {
    PetscFunctionReturn(InputError(key, "is not a body, an obstacle or a wall of this scene\nwalls are xmin xmax ymin ymax zmin zmax"));
  }
  is_body = (PetscBool)(probe->surface >= 0 && probe->surface < c->n_bodies);
  if (p->quantity == PROBE_DISPLACEMENT && !is_body) {
    PetscFunctionReturn(InputError(key, "must name an elastic body: only those have a displacement"));
  }
  if (p->quantity == PROBE_FORCE && probe->surface == WATER) PetscFunctionReturn(InputError(key, "must name what the force acts on: a body, an obstacle or a wall"));
  if (p->quantity == PROBE_MOMENT && probe->surface < 0) PetscFunctionReturn(InputError(key, "must name what the moment acts on: a body or an obstacle"));
  if (p->quantity == PROBE_POWER && (probe->surface == WATER || is_body)) PetscFunctionReturn(InputError(key, "must name a wall or an obstacle: what moves by prescription"));
  if (p->quantity == PROBE_VELOCITY && probe->surface >= c->n_bodies) PetscFunctionReturn(InputError(key, "must not be an obstacle, whose velocity the scene says itself"));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.quantity", name));
  if (!c->sph && (IsOfWater(p->quantity) || p->quantity == PROBE_PRESSURE || p->quantity == PROBE_FORCE || p->quantity == PROBE_MOMENT || p->quantity == PROBE_POWER || (p->quantity == PROBE_VELOCITY && !is_body))) {
    PetscFunctionReturn(InputError(key, "needs a fluid, and the scene has none"));
  }
  if (IsOfWater(p->quantity) && p->body[0]) PetscFunctionReturn(InputError(key, "is a quantity of the water at a place; leave out `body`"));
  ByCall(CheckBox(c, probe));
  ByCall(CouplerProbeSamples(probe));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.mean", name));
  if (p->mean && probe->n_points) PetscFunctionReturn(InputError(key, "belongs to a row of probes.csv; a line or rectangle is of one moment"));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.at", name));
  if (is_body && (p->quantity == PROBE_DISPLACEMENT || p->quantity == PROBE_VELOCITY)) ByCall(LocatePoint(&c->surface[probe->surface], key, p->at, probe));
  c->n_probes++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerAddProbes(Coupler c, const Names *names)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < names->n; k++) {
    const PetscErrorCode ierr = AddProbe(c, names->name[k]);
    if (ierr != BY_ERR_INPUT) PetscCall(ierr);
  }
  PetscFunctionReturn(InputErrorCount() ? BY_ERR_INPUT : PETSC_SUCCESS);
}

/* columns of a probe in probes.csv: none for a line, which has a file of its own */
static int Columns(const CouplerProbe *probe)
{
  const int q = probe->params.quantity;

  if (probe->n_points) return 0;
  return q == PROBE_DISPLACEMENT || q == PROBE_VELOCITY || q == PROBE_FORCE || q == PROBE_MOMENT ? 3 : 1;
}

/* column headers "name [unit]" or "name_x [unit]"; headers has room for 3 columns a probe and the time */
PetscErrorCode CouplerProbeHeaders(Coupler c, PetscInt *n, char headers[][2 * BY_NAME_MAX])
{
  static const char *const units[] = {"m", "m/s", "Pa", "m", "N", "m", "m^3/s", "W", "N m"};

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(headers[0], "time [s]", 2 * BY_NAME_MAX));
  *n = 1;
  for (PetscInt k = 0; k < c->n_probes; k++) {
    const CouplerProbe *probe = &c->probe[k];
    const char         *unit  = units[probe->params.quantity];

    for (int i = 0; i < Columns(probe); i++) {
      if (Columns(probe) == 3) PetscCall(PetscSNPrintf(headers[(*n)++], 2 * BY_NAME_MAX, "%s_%c [%s]", probe->name, "xyz"[i], unit));
      else PetscCall(PetscSNPrintf(headers[(*n)++], 2 * BY_NAME_MAX, "%s [%s]", probe->name, unit));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BodyPoint(CouplerSurface *s, const CouplerProbe *probe, PetscReal value[3])
{
  const PetscReal *x, *v, *X;

  PetscFunctionBegin;
  PetscCall(TLEDGetPositions(s->tled, &x, &v));
  PetscCall(TLEDGetMesh(s->tled, NULL, NULL, &X));
  for (int k = 0; k < 3; k++) {
    value[k] = 0.0;
    for (PetscInt a = 0; a < probe->n_nodes; a++) {
      const PetscInt i = 3 * probe->node[a] + k;

      value[k] += probe->weight[a] * (probe->params.quantity == PROBE_VELOCITY ? v[i] : x[i] - X[i]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mean pressure on the part of the undeformed surface that lies in the box; nan when the box misses it */
static PetscErrorCode ProxyPatch(Coupler c, const CouplerProbe *probe, PetscReal *pressure)
{
  CouplerSurface *s = &c->surface[probe->surface];
  PetscReal       force, area;

  PetscFunctionBegin;
  *pressure = NAN;
  if (!s->proxy) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProxyGetPatch(s->proxy, probe->params.min, probe->params.max, c->step > 0 ? s->proxy_force : NULL, &force, &area));
  if (area > 0.0) *pressure = force / area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PatchPressure(Coupler c, const CouplerProbe *probe, PetscReal *pressure)
{
  PetscReal force, area;

  PetscFunctionBegin;
  if (probe->surface >= 0) PetscCall(ProxyPatch(c, probe, pressure));
  else {
    PetscCall(SPHGetPatch(c->sph, probe->patch, &force, &area));
    *pressure = force / area;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* moment of the last step's forces about a place: that about the origin, less at x total [N m] */
static void MomentAbout(const CouplerSurface *s, const PetscReal at[3], PetscReal moment[3])
{
  PetscReal lever[3];

  Cross3(at, s->total, lever);
  for (int i = 0; i < 3; i++) moment[i] = s->moment[i] - lever[i];
}

static PetscErrorCode ProbeValue(Coupler c, const CouplerProbe *probe, PetscReal value[3])
{
  PetscReal pressure, velocity[3], walls[18];
  PetscBool wet;

  PetscFunctionBegin;
  switch (probe->params.quantity) {
  case PROBE_FORCE:
    if (probe->surface >= 0) PetscCall(CouplerGetForce(c, probe->surface, value));
    else {
      PetscCall(SPHGetWallForces(c->sph, walls));
      for (int k = 0; k < 3; k++) value[k] = walls[3 * (-1 - probe->surface) + k];
    }
    break;
  case PROBE_MOMENT:
    MomentAbout(&c->surface[probe->surface], probe->params.at, value);
    break;
  case PROBE_POWER:
    PetscCall(SPHGetWallPowers(c->sph, walls));
    *value = probe->surface >= 0 ? c->surface[probe->surface].power : walls[-1 - probe->surface];
    break;
  case PROBE_HEIGHT:
    PetscCall(SPHGetHeight(c->sph, probe->params.at, value));
    break;
  case PROBE_SURFACE:
    PetscCall(SPHGetSurface(c->sph, probe->params.at, value));
    break;
  case PROBE_FLOW_RATE:
    for (PetscInt k = 0; k < 3; k++)
      if (probe->params.min[k] == probe->params.max[k]) PetscCall(SPHGetFlowRate(c->sph, k, probe->params.min, probe->params.max, value));
    break;
  case PROBE_PRESSURE:
    if (probe->surface != WATER) PetscCall(PatchPressure(c, probe, value));
    else PetscCall(SPHInterpolate(c->sph, probe->params.at, value, velocity, &wet));
    break;
  default:
    if (probe->surface >= 0) PetscCall(BodyPoint(&c->surface[probe->surface], probe, value));
    else PetscCall(SPHInterpolate(c->sph, probe->params.at, &pressure, value, &wet));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerProbeStep(Coupler c, PetscReal dt)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_probes; k++) {
    CouplerProbe *probe    = &c->probe[k];
    PetscReal     value[3] = {0, 0, 0};

    if (!probe->params.mean) continue;
    PetscCall(ProbeValue(c, probe, value));
    for (int i = 0; i < 3; i++) probe->sum[i] += value[i] * dt;
    probe->time += dt;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* values of the moment, or means since the last row, which begin anew */
PetscErrorCode CouplerProbeRow(Coupler c, PetscReal row[])
{
  PetscInt n = 0;

  PetscFunctionBegin;
  row[n++] = c->time;
  for (PetscInt k = 0; k < c->n_probes; k++) {
    CouplerProbe *probe    = &c->probe[k];
    PetscReal     value[3] = {0, 0, 0};

    if (!Columns(probe)) continue;
    if (probe->time > 0) {
      for (int i = 0; i < 3; i++) value[i] = probe->sum[i] / probe->time;
    } else PetscCall(ProbeValue(c, probe, value));
    for (int i = 0; i < Columns(probe); i++) row[n++] = value[i];
    probe->time = 0.0;
    PetscCall(PetscArrayzero(probe->sum, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
