/* sph_open_setup.c - openings as a scene says them: keys, geometry of the patch, columns of particles. */
#include <math.h>
#include <string.h>

#include "mat3.h"
#include "sph_open.h"

static const char *const Sides[]    = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax", NULL};
static const char *const Axes[]     = {"x", "y", "z", NULL};
static const char *const Profiles[] = {"uniform", "parabolic", "table", NULL};

#define FAR 1e6 /* [m] */
#define IN(f)  offsetof(SPHInflowParams, f)
#define OUT(f) offsetof(SPHOutflowParams, f)
#define TAP(f) offsetof(SPHSourceParams, f)

// clang-format off
const Key SPHInflowKeys[] = {
  {"side",         KEY_CHOICE, IN(side),         "",    NULL, 0, 0, KEY_REQUIRED, Sides, "side of the domain through which water enters; where it is a wall, the rectangle is a hole in it"},
  {"min",          KEY_VEC3,   IN(min),          "m",   "-1e6, -1e6, -1e6", -FAR, FAR, 0, NULL, "lower corner of a rectangle on the side; beyond the domain: the whole side"},
  {"max",          KEY_VEC3,   IN(max),          "m",   "1e6, 1e6, 1e6", -FAR, FAR, 0, NULL, "upper corner"},
  {"velocity",     KEY_REAL,   IN(velocity),     "m/s", NULL, 0, 1e4, KEY_LO_OPEN | KEY_REQUIRED, NULL, "mean speed over the rectangle, into the domain; with a table: factor on it"},
  {"profile",      KEY_CHOICE, IN(profile),      "",    "uniform", 0, 0, 0, Profiles, "over the rectangle: uniform, parabolic across profile_axis, or a table"},
  {"profile_axis", KEY_CHOICE, IN(profile_axis), "",    "z", 0, 0, 0, Axes, "axis across which the profile varies"},
  {"profile_table", KEY_FILE,  IN(profile_table), "",   "", 0, 0, 0, NULL, "CSV file of coordinate [m] along profile_axis and speed over velocity"},
  COURSE_KEYS(SPHInflowParams, course),
  KEY_END};

const Key SPHOutflowKeys[] = {
  {"side",     KEY_CHOICE, OUT(side),     "",    NULL, 0, 0, KEY_REQUIRED, Sides, "side of the domain through which water leaves; where it is a wall, the rectangle is a hole in it"},
  {"min",      KEY_VEC3,   OUT(min),      "m",   "-1e6, -1e6, -1e6", -FAR, FAR, 0, NULL, "lower corner of a rectangle on the side; beyond the domain: the whole side"},
  {"max",      KEY_VEC3,   OUT(max),      "m",   "1e6, 1e6, 1e6", -FAR, FAR, 0, NULL, "upper corner"},
  {"velocity", KEY_REAL,   OUT(velocity), "m/s", "-1", -1, 1e4, 0, NULL, "uniform speed out of the domain; -1 = what arrives leaves, against the pressure that is given"},
  {"pressure", KEY_REAL,   OUT(pressure), "Pa",  "0", 0, 1e9, 0, NULL, "downstream; without velocity"},
  {"level",    KEY_REAL,   OUT(level),    "m",   "-1e6", -FAR, FAR, 0, NULL, "height of still water downstream, against gravity, whose pressure is given as well; -1e6 = none"},
  COURSE_KEYS(SPHOutflowParams, course),
  KEY_END};

const Key SPHSourceKeys[] = {
  {"center",    KEY_VEC3, TAP(center),    "m",     NULL, -FAR, FAR, KEY_REQUIRED, NULL, "centre of the disc out of which water comes"},
  {"direction", KEY_VEC3, TAP(direction), "1",     NULL, -FAR, FAR, KEY_REQUIRED, NULL, "in which it comes; its length does not matter"},
  {"radius",    KEY_REAL, TAP(radius),    "m",     NULL, 0, FAR, KEY_LO_OPEN | KEY_REQUIRED, NULL, "of the disc"},
  {"velocity",  KEY_REAL, TAP(velocity),  "m/s",   "0", 0, 1e4, 0, NULL, "mean speed"},
  {"flow_rate", KEY_REAL, TAP(flow_rate), "m^3/s", "0", 0, 1e9, 0, NULL, "in place of velocity"},
  {"profile",   KEY_CHOICE, TAP(profile), "",      "uniform", 0, 0, 0, Profiles, "over the disc: uniform or parabolic"},
  {"volume",    KEY_REAL, TAP(volume),    "m^3",   "0", 0, 1e9, 0, NULL, "that comes out of it, then it is dry; 0 = no end"},
  COURSE_KEYS(SPHSourceParams, course),
  KEY_END};
// clang-format on

PetscReal SPHParticleVolume_Internal(SPH sph) { return sph->particle_volume > 0 ? sph->particle_volume : PetscPowReal(sph->params.spacing, 3); }

/* the next opening, its course read */
static PetscErrorCode Add(SPH sph, const char kind[], const char name[], const CourseParams *course, SPHOpening **opening)
{
  char        section[2 * BY_NAME_MAX];
  SPHOpening *o;

  PetscFunctionBegin;
  PetscCheck(!sph->setup, PetscObjectComm((PetscObject)sph), PETSC_ERR_ORDER, "openings are added before SPHSetUp()");
  PetscCall(PetscSNPrintf(section, sizeof(section), "sph.%s", name));
  if (sph->n_openings == SPH_OPENINGS_MAX) PetscFunctionReturn(InputError(kind, "names more than %d openings in all", SPH_OPENINGS_MAX));
  PetscCall(PetscRealloc(sizeof(SPHOpening) * (size_t)(sph->n_openings + 1), &sph->opening));
  o = &sph->opening[sph->n_openings++];
  PetscCall(PetscMemzero(o, sizeof(*o)));
  PetscCall(PetscStrncpy(o->name, name, sizeof(o->name)));
  o->side  = -1;
  *opening = o;
  ByCall(CourseCreate(section, course, &o->course));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the rectangle from min to max on a side of the domain, the flow along `sign` times the inward normal */
static PetscErrorCode OnSide(SPH sph, SPHOpening *o, int side, const PetscReal min[3], const PetscReal max[3], PetscReal sign)
{
  const int axis = side / 2;
  char      key[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.side", o->name));
  if (sph->periodic >> axis & 1) PetscFunctionReturn(InputError(key, "is a side where the domain repeats (domain.periodic has %s)", Axes[axis]));
  o->side         = side;
  o->whole        = (PetscBool)!(sph->walls >> side & 1);
  o->center[axis] = side % 2 ? sph->max[axis] : sph->min[axis];
  o->n[axis]      = sign * (side % 2 ? -1.0 : 1.0);
  for (int q = 0; q < 2; q++) {
    const int       k  = (axis + 1 + q) % 3;
    const PetscReal lo = PetscMax(min[k], sph->min[k]), hi = PetscMin(max[k], sph->max[k]);

    if (!(hi > lo)) PetscFunctionReturn(InputError(key, "has no part of the rectangle from min to max: it is empty in %s", Axes[k]));
    o->whole     = (PetscBool)(o->whole && lo <= sph->min[k] && hi >= sph->max[k]);
    o->center[k] = 0.5 * (lo + hi);
    o->half[q]   = 0.5 * (hi - lo);
    (q ? o->b : o->a)[k] = 1.0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* columns over the patch as near to the spacing as fits it; a disc keeps the shells of a lattice that come nearest to its area, and the columns
   get their share of it */
static PetscErrorCode MakeColumns(SPH sph, SPHOpening *o)
{
  const PetscReal dx = sph->params.spacing;
  PetscReal       limit = PETSC_MAX_REAL, sum = 0.0;
  PetscInt        n = 0;

  PetscFunctionBegin;
  for (int q = 0; q < 2; q++) {
    const PetscReal width = 2.0 * (o->disc ? o->half[0] : o->half[q]);
    o->cells[q] = PetscMax(1, (PetscInt)floor(width / dx + 0.5));
    o->cell[q]  = width / o->cells[q];
  }
  if (o->disc) limit = PetscSqr(o->half[0]) * (1.0 + 1e-9);
  PetscCall(PetscMalloc3(o->cells[0] * o->cells[1], &o->column_of, 2 * o->cells[0] * o->cells[1], &o->column, o->cells[0] * o->cells[1], &o->last));
  for (PetscInt j = 0; j < o->cells[1]; j++) {
    for (PetscInt i = 0; i < o->cells[0]; i++) {
      const PetscReal a = (i + 0.5 - 0.5 * o->cells[0]) * o->cell[0], b = (j + 0.5 - 0.5 * o->cells[1]) * o->cell[1];

      o->column_of[i + o->cells[0] * j] = -1;
      if (o->disc && a * a + b * b > limit) continue;
      o->column[2 * n]                  = a;
      o->column[2 * n + 1]              = b;
      o->column_of[i + o->cells[0] * j] = n++;
    }
  }
  o->n_columns = n;
  if (o->disc) { // the columns' area is the disc's: they move in or out a little
    const PetscReal factor = o->half[0] * sqrt(PETSC_PI / n) / o->cell[0];
    o->cell[0] *= factor;
    o->cell[1] *= factor;
    for (PetscInt c = 0; c < 2 * n; c++) o->column[c] *= factor;
    o->half[1] = o->half[0] + 0.25 * o->cell[0];
  }
  o->step   = SPHParticleVolume_Internal(sph) / (o->cell[0] * o->cell[1]);
  o->length = sph->h + o->step;
  o->scale  = 1.0;
  for (PetscInt c = 0; c < n && o->profile == SPH_PROFILE_PARABOLIC; c++) {
    const PetscReal *ab = o->column + 2 * c, xi = o->profile_axis < 0 ? sqrt(ab[0] * ab[0] + ab[1] * ab[1]) / o->half[0] : ab[o->profile_axis] / o->half[o->profile_axis];
    sum += PetscMax(0.0, 1.0 - xi * xi);
  }
  if (sum > 0) o->scale = n / sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SPHAddInflow - a rectangle on a side of the domain through which particles enter with a given velocity

  Input Parameters:
+ sph  - the fluid, its domain known, before SPHSetUp()
. name - for messages: section sph.<name>
- p    - what the scene says

  Errors: BY_ERR_INPUT, reported
@*/
PetscErrorCode SPHAddInflow(SPH sph, const char name[], const SPHInflowParams *p)
{
  SPHOpening *o;
  char        key[2 * BY_NAME_MAX];
  const int   axis = p->side / 2;

  PetscFunctionBegin;
  ByCall(Add(sph, "sph.inflow", name, &p->course, &o));
  o->inlet    = PETSC_TRUE;
  o->velocity = p->velocity;
  o->profile  = p->profile;
  ByCall(OnSide(sph, o, p->side, p->min, p->max, 1.0));
  o->whole          = PETSC_FALSE; // what comes back beside the rectangle is no inflow
  o->profile_axis   = p->profile_axis == (axis + 1) % 3 ? 0 : 1;
  o->profile_origin = o->center[p->profile_axis];
  PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.profile_axis", name));
  if (p->profile != SPH_PROFILE_UNIFORM && p->profile_axis == axis)
    PetscFunctionReturn(InputError(key, "is the axis along which the water enters\nexpected one of the two across: %s or %s", Axes[(axis + 1) % 3], Axes[(axis + 2) % 3]));
  if (p->profile == SPH_PROFILE_TABLE) {
    CourseParams table = {.kind = COURSE_TABLE};

    PetscCall(PetscStrncpy(table.table, p->profile_table, sizeof(table.table)));
    PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.profile", name));
    ByCall(CourseCreate(key, &table, &o->table));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ SPHAddOutflow - a rectangle on a side of the domain through which particles leave @*/
PetscErrorCode SPHAddOutflow(SPH sph, const char name[], const SPHOutflowParams *p)
{
  SPHOpening *o;

  PetscFunctionBegin;
  ByCall(Add(sph, "sph.outflow", name, &p->course, &o));
  o->velocity  = p->velocity >= 0 ? p->velocity : -1.0;
  o->pressure  = p->pressure;
  o->level     = p->level;
  o->has_level = (PetscBool)(p->level > -0.9 * FAR);
  o->length    = -1.0;
  ByCall(OnSide(sph, o, p->side, p->min, p->max, -1.0));
  if (o->velocity < 0 && (o->has_level || o->pressure > 0)) sph->gives_pressure = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ SPHAddSource - a disc, a tap, out of which particles come @*/
PetscErrorCode SPHAddSource(SPH sph, const char name[], const SPHSourceParams *p)
{
  const PetscReal length = Norm3(p->direction), area = PETSC_PI * PetscSqr(p->radius);
  SPHOpening     *o;
  char            key[2 * BY_NAME_MAX];
  int             least = 0;

  PetscFunctionBegin;
  ByCall(Add(sph, "sph.sources", name, &p->course, &o));
  PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.direction", name));
  if (!(length > 0)) PetscFunctionReturn(InputError(key, "is zero: it must say where the water goes"));
  PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.velocity", name));
  if (!(p->velocity > 0) == !(p->flow_rate > 0)) PetscFunctionReturn(InputError(key, "or flow_rate must be given, one of the two, > 0"));
  PetscCall(PetscSNPrintf(key, sizeof(key), "sph.%s.profile", name));
  if (p->profile == SPH_PROFILE_TABLE) PetscFunctionReturn(InputError(key, "cannot be a table on a disc\nexpected uniform or parabolic"));
  o->inlet        = PETSC_TRUE;
  o->disc         = PETSC_TRUE;
  o->velocity     = p->velocity > 0 ? p->velocity : p->flow_rate / area;
  o->profile      = p->profile;
  o->profile_axis = -1;
  o->volume       = p->volume;
  o->half[0] = o->half[1] = p->radius;
  for (int k = 0; k < 3; k++) {
    o->center[k] = p->center[k];
    o->n[k]      = p->direction[k] / length;
    if (PetscAbsReal(o->n[k]) < PetscAbsReal(o->n[least]) - 1e-12) least = k;
  }
  o->a[least] = 1.0;
  Cross3(o->n, o->a, o->b);
  for (int k = 0; k < 3; k++) o->b[k] /= sqrt(1.0 - PetscSqr(o->n[least]));
  Cross3(o->b, o->n, o->a);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* openings of the lists inflow, outflow and sources, from the options sph_<name>_* */
PetscErrorCode SPHOpenFromOptions_Internal(SPH sph)
{
  const Names *names[] = {&sph->params.inflow, &sph->params.outflow, &sph->params.sources};

  PetscFunctionBegin;
  for (int kind = 0; kind < 3; kind++) {
    for (PetscInt k = 0; k < names[kind]->n; k++) {
      const char      *name = names[kind]->name[k];
      char             prefix[2 * BY_NAME_MAX];
      SPHInflowParams  in;
      SPHOutflowParams out;
      SPHSourceParams  tap;
      const Key       *keys[]   = {SPHInflowKeys, SPHOutflowKeys, SPHSourceKeys};
      void *const      params[] = {&in, &out, &tap};

      PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "sph_%s_", name));
      PetscCall(KeysSetDefaults(keys[kind], params[kind]));
      PetscCall(KeysSetFromOptions(keys[kind], prefix, params[kind]));
      if (kind == 0) ByCall(SPHAddInflow(sph, name, &in));
      if (kind == 1) ByCall(SPHAddOutflow(sph, name, &out));
      if (kind == 2) ByCall(SPHAddSource(sph, name, &tap));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fastest mean speed of an opening [m/s]: the flow's own speed where nothing else gives one */
PetscReal SPHOpenSpeed_Internal(SPH sph)
{
  PetscReal speed = 0.0;

  for (PetscInt k = 0; k < sph->n_openings; k++) speed = PetscMax(speed, sph->opening[k].velocity);
  return speed;
}

/* part of SPHSetUp(): columns and buffers */
PetscErrorCode SPHOpenSetUp_Internal(SPH sph)
{
  PetscFunctionBegin;
  if (!sph->n_openings) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SPHAddArray_Internal(sph, &sph->kind, sizeof(*sph->kind)));
  PetscCall(SPHAddArray_Internal(sph, &sph->opened_by, sizeof(*sph->opened_by)));
  for (PetscInt k = 0; k < sph->n_openings; k++) {
    if (sph->opening[k].inlet) PetscCall(MakeColumns(sph, &sph->opening[k]));
    else sph->opening[k].length = sph->h + sph->params.spacing;
  }
  PetscCall(SPHOpenMirror_Internal(sph));
  PetscCall(SPHExchange_Internal(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SPHOpenDestroy_Internal(SPH sph)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < sph->n_openings; k++) {
    SPHOpening *o = &sph->opening[k];

    PetscCall(CourseDestroy(&o->course));
    PetscCall(CourseDestroy(&o->table));
    PetscCall(PetscFree3(o->column_of, o->column, o->last));
  }
  PetscCall(PetscFree(sph->opening));
  PetscFunctionReturn(PETSC_SUCCESS);
}
