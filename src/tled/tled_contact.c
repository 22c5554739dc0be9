/* tled_contact.c - contact of a body's surface with planes and obstacles at rest, by a penalty on its nodes (tled_contact.h). */
#include "tled/tled_impl.h"
#include "tled/tled_contact.h"

#define STIFFNESS 2.0  /* times Young's modulus over the mean edge of the surface: the default, see TLEDContactSetUp_Private()    */
#define SOFT      0.01 /* of the mean edge: depth over which the pressure sets in                                             */
#define DEEPEST   0.9  /* of the reach (the mean edge): a node deeper in an obstacle has gone through its surface             */

static PetscErrorCode AddObstacle(TLED tled, const char name[], TLEDObstacle **obstacle)
{
  TLEDContact *c = &tled->contact;

  PetscFunctionBegin;
  PetscCheck(!tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "contact is added before TLEDSetUp()");
  PetscCall(PetscRealloc((size_t)(c->n + 1) * sizeof *c->item, &c->item));
  *obstacle = &c->item[c->n++];
  PetscCall(PetscMemzero(*obstacle, sizeof **obstacle));
  PetscCall(PetscStrncpy((*obstacle)->name, name, sizeof(*obstacle)->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDAddContactPlane - a plane that the body cannot pass, before TLEDSetUp()

  Input Parameters:
+ tled   - the body
. name   - name of the plane, for messages
. point  - a point of it [m]
- normal - towards the side where the body may be, any length

.seealso: TLEDAddContactSurface()
@*/
PetscErrorCode TLEDAddContactPlane(TLED tled, const char name[], const PetscReal point[3], const PetscReal normal[3])
{
  const PetscReal length = Norm3(normal);
  TLEDObstacle   *obstacle;

  PetscFunctionBegin;
  PetscCheck(length > 0.0, PetscObjectComm((PetscObject)tled), PETSC_ERR_ARG_OUTOFRANGE, "the normal of the plane %s has no length", name);
  PetscCall(AddObstacle(tled, name, &obstacle));
  for (int k = 0; k < 3; k++) obstacle->normal[k] = normal[k] / length;
  obstacle->offset = Dot3(obstacle->normal, point);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TLEDAddContactSurface - a closed surface at rest into which the body cannot go, before TLEDSetUp()

  Input Parameters:
+ tled    - the body
. name    - name of the obstacle, for messages
- surface - closed, outward (SurfaceRead()); copied

.seealso: TLEDAddContactPlane()
@*/
PetscErrorCode TLEDAddContactSurface(TLED tled, const char name[], const Surface *surface)
{
  TLEDObstacle *obstacle;

  PetscFunctionBegin;
  PetscCall(AddObstacle(tled, name, &obstacle));
  obstacle->surface.n_nodes     = surface->n_nodes;
  obstacle->surface.n_triangles = surface->n_triangles;
  PetscCall(PetscMalloc1(3 * surface->n_nodes, &obstacle->surface.x));
  PetscCall(PetscMalloc1(3 * surface->n_triangles, &obstacle->surface.triangles));
  PetscCall(PetscArraycpy(obstacle->surface.x, surface->x, 3 * surface->n_nodes));
  PetscCall(PetscArraycpy(obstacle->surface.triangles, surface->triangles, 3 * surface->n_triangles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* area of the undeformed surface that each node stands for, a third of the triangles around it; returns their mean edge */
static PetscReal SpreadArea(const TLEDMesh *mesh, PetscReal area[])
{
  PetscReal edges = 0.0;

  for (PetscInt t = 0; t < mesh->n_triangles; t++) {
    const PetscInt *v = &mesh->triangles[3 * t];
    double          a[3], b[3], c[3], n[3];
    Sub3(&mesh->X[3 * v[1]], &mesh->X[3 * v[0]], a);
    Sub3(&mesh->X[3 * v[2]], &mesh->X[3 * v[0]], b);
    Sub3(&mesh->X[3 * v[2]], &mesh->X[3 * v[1]], c);
    Cross3(a, b, n);
    edges += Norm3(a) + Norm3(b) + Norm3(c);
    for (int k = 0; k < 3; k++) area[v[k]] += Norm3(n) / 6.0;
  }
  return edges / (3.0 * (PetscReal)mesh->n_triangles);
}

/* no node may start deep in an obstacle: it could not tell the way out */
static PetscErrorCode CheckStart(TLED tled, const TLEDObstacle *o)
{
  const TLEDContact *c    = &tled->contact;
  const TLEDMesh    *mesh = &tled->mesh;
  PetscReal         *winding, *distance, deepest = 0.0;
  char               key[2 * BY_NAME_MAX + 16];
  PetscInt           worst = -1;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(mesh->n_nodes, &winding, mesh->n_nodes, &distance));
  if (o->index) {
    PetscCall(SurfaceWinding(mesh->n_nodes, mesh->X, o->surface.x, o->surface.n_triangles, o->surface.triangles, winding));
    PetscCall(SurfaceDistance(mesh->n_nodes, mesh->X, o->surface.x, o->surface.n_triangles, o->surface.triangles, c->reach, distance));
  }
  for (PetscInt a = 0; a < mesh->n_nodes; a++) {
    PetscReal depth = o->index ? (winding[a] > 0.5 ? PetscMin(distance[a], c->reach) : 0.0) : o->offset - Dot3(o->normal, &mesh->X[3 * a]);
    if (!(c->area[a] > 0.0) || depth <= deepest) continue;
    deepest = depth, worst = a;
  }
  PetscCall(PetscFree2(winding, distance));
  if (deepest <= 0.5 * c->reach) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.contact", ((PetscObject)tled)->name));
  PetscFunctionReturn(InputError(key,
                                 "has %s, in which the body starts: its node at (%g, %g, %g) m lies %s%.3g m beyond the surface\n"
                                 "move it with `translate`",
                                 o->name, (double)mesh->X[3 * worst], (double)mesh->X[3 * worst + 1], (double)mesh->X[3 * worst + 2],
                                 o->index && deepest >= c->reach ? "more than " : "", (double)deepest));
}

/* largest Young's modulus at small strain of the body's materials [Pa] */
static PetscReal Young(TLED tled)
{
  PetscReal most = 0.0;

  for (int k = 0; k < tled->loops.n_laws; k++) most = PetscMax(most, 2.0 * tled->laws[k].mu * (1.0 + TLEDPoisson(&tled->laws[k])));
  return most;
}

/* largest eigenvalue that sum n n^T over surfaces touched at once may have: opposite planes never are, and count once */
static PetscReal Crowding(const TLEDContact *c)
{
  PetscReal N[9] = {0.0}, most = 0.0, surfaces = 0.0;

  for (PetscInt i = 0; i < c->n; i++) {
    PetscBool opposite = PETSC_FALSE;
    if (c->item[i].surface.n_triangles) surfaces += 1.0;
    for (PetscInt j = 0; j < i; j++)
      opposite = (PetscBool)(opposite || (!c->item[j].surface.n_triangles && PetscAbsReal(Dot3(c->item[i].normal, c->item[j].normal)) > 1.0 - 1e-12));
    for (int k = 0; k < 9 && !opposite && !c->item[i].surface.n_triangles; k++) N[k] += c->item[i].normal[k / 3] * c->item[i].normal[k % 3];
  }
  for (int i = 0; i < 3; i++) most = PetscMax(most, PetscAbsReal(N[3 * i]) + PetscAbsReal(N[3 * i + 1]) + PetscAbsReal(N[3 * i + 2]));
  return most + surfaces;
}

/*
  TLEDContactSetUp_Private - areas, stiffness, and the obstacles' search; nothing is made when there are none

  The stiffness is the key contact_stiffness or, where that is 0, twice the largest Young's modulus over the mean edge h of the surface's triangles: a
  contact pressure p presses nodes p h/(2 E) deep, half of what it shortens one layer of elements by, and the stable step suffers
  little: k A/m is of the order 4 E/(rho h^2), omega_max^2 some 30 to 60 times E/(rho h^2).

  Errors: BY_ERR_INPUT, reported, when the body starts within an obstacle
*/
PetscErrorCode TLEDContactSetUp_Private(TLED tled)
{
  TLEDContact   *c = &tled->contact;
  const PetscInt n = tled->mesh.n_nodes;

  PetscFunctionBegin;
  if (!c->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(n, &c->area));
  c->reach     = SpreadArea(&tled->mesh, c->area);
  c->soft      = SOFT * c->reach;
  c->stiffness = tled->params.contact_stiffness;
  if (!(c->stiffness > 0.0)) c->stiffness = STIFFNESS * Young(tled) / c->reach;
  c->crowding = Crowding(c);
  for (PetscInt i = 0; i < c->n; i++) {
    TLEDObstacle *o = &c->item[i];
    if (o->surface.n_triangles) {
      PetscCall(SurfaceIndexCreate(o->surface.n_nodes, o->surface.x, o->surface.n_triangles, o->surface.triangles, c->reach, &o->index));
      PetscCall(PetscCalloc1(4 * n, &o->last)); /* distance 0 at the origin: nothing is known */
    }
    ByCall(CheckStart(tled, o));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDContactDestroy_Private(TLEDContact *c)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->n; i++) {
    PetscCall(SurfaceDestroy(&c->item[i].surface));
    PetscCall(SurfaceIndexDestroy(&c->item[i].index));
    PetscCall(PetscFree(c->item[i].last));
  }
  PetscCall(PetscFree(c->item));
  PetscCall(PetscFree(c->area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a node at x is to an obstacle; 0 when it does not touch. For a surface what was last known of the node's distance saves
   most searches: it changes by no more than the node has moved. The answer does not depend on it. */
static int Touches(TLEDObstacle *o, PetscReal reach, PetscInt a, const double x[3], SurfaceFoot *foot)
{
  double moved[3];

  if (!o->index) {
    foot->distance = Dot3(o->normal, x) - o->offset;
    foot->kind     = 2;
    for (int k = 0; k < 3; k++) foot->normal[k] = o->normal[k], foot->along[k] = 0.0;
    return foot->distance < 0.0;
  }
  double *last = &o->last[4 * a];
  Sub3(x, last, moved);
  const double way = Norm3(moved), within = last[3] == 0.0 ? reach : PetscMin(reach, PetscAbsReal(last[3]) + way * (1.0 + 1e-9));
  if (last[3] > way) return 0;
  const int found = SurfaceIndexNearest(o->index, x, within, foot);
  for (int k = 0; k < 3; k++) last[k] = x[k];
  last[3] = found ? foot->distance : within;
  return found && foot->distance < 0.0;
}

/* contact of node a at displacement u: adds to the force f [N] and the stiffness K [N/m], returns the stored energy [J]; f and K may be
   NULL. deep counts obstacles that the node is about to pass. Any thread may call it, for its own nodes. */
double TLEDContactAt_Private(TLED tled, PetscInt a, const double u[3], double f[3], double K[9], double *deep)
{
  TLEDContact *c      = &tled->contact;
  const double area   = c->area[a];
  double       energy = 0.0, x[3], slope, W;
  SurfaceFoot  foot;

  if (!(area > 0.0)) return 0.0;
  for (int k = 0; k < 3; k++) x[k] = tled->mesh.X[3 * a + k] + u[k];
  for (PetscInt i = 0; i < c->n; i++) {
    if (!Touches(&c->item[i], c->reach, a, x, &foot)) continue;
    const double p = TLEDContactPressure(-foot.distance, c->stiffness, c->soft, &slope, &W);
    energy += area * W;
    for (int k = 0; k < 3 && f; k++) f[k] += area * p * foot.normal[k];
    if (K) TLEDContactStiffness(area, p, slope, -foot.distance, foot.normal, foot.kind, foot.along, K);
    if (c->item[i].index && -foot.distance > DEEPEST * c->reach && deep) *deep += 1.0;
  }
  return energy;
}

/* stored energy [J] at displacement u, added in the order of the nodes */
double TLEDContactEnergy_Private(TLED tled, const double u[])
{
  double energy = 0.0;

  for (PetscInt a = 0; a < tled->mesh.n_nodes && tled->contact.n; a++) energy += TLEDContactAt_Private(tled, a, &u[3 * a], NULL, NULL, NULL);
  return energy;
}

/* largest stiffness over mass of a node's contact [1/s^2] for lumped masses `mass`; 0 without contact */
double TLEDContactRate_Private(TLED tled, const double mass[])
{
  const TLEDContact *c    = &tled->contact;
  double             most = 0.0;

  for (PetscInt a = 0; a < tled->mesh.n_nodes && c->n; a++) most = PetscMax(most, c->crowding * c->stiffness * c->area[a] / mass[a]);
  return most;
}

/* Is every node still on the side of the obstacles' surfaces where it was, when it goes from u to x in one step? One that goes farther than
   it can look, or comes to lie deeper, could have passed one. */
PetscBool TLEDContactKeepsSides_Private(TLED tled, const double u[], const double x[])
{
  const TLEDContact *c        = &tled->contact;
  PetscBool          surfaces = PETSC_FALSE;
  double             deep     = 0.0;

  for (PetscInt i = 0; i < c->n; i++) surfaces = (PetscBool)(surfaces || c->item[i].index);
  for (PetscInt a = 0; a < tled->mesh.n_nodes && surfaces; a++) {
    double way[3];
    Sub3(&x[3 * a], &u[3 * a], way);
    if (c->area[a] > 0.0 && Norm3(way) > DEEPEST * c->reach) return PETSC_FALSE;
    (void)TLEDContactAt_Private(tled, a, &x[3 * a], NULL, NULL, &deep);
    if (deep > 0.0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* write the breakdown message of a node that has passed an obstacle's surface, or was about to; returns BY_ERR_BREAKDOWN */
PetscErrorCode TLEDContactReport_Private(TLED tled, const PetscReal u[], PetscReal time)
{
  char     place[128] = "";
  double   deep       = 0.0;
  PetscInt a;

  PetscFunctionBegin;
  for (a = 0; a < tled->mesh.n_nodes && !(deep > 0.0); a++) (void)TLEDContactAt_Private(tled, a, &u[3 * a], NULL, NULL, &deep);
  if (deep > 0.0) {
    const PetscReal *X = &tled->mesh.X[3 * (a - 1)];
    PetscCall(PetscSNPrintf(place, sizeof place, " at (%.4g, %.4g, %.4g) m", (double)(X[0] + u[3 * a - 3]), (double)(X[1] + u[3 * a - 2]),
                            (double)(X[2] + u[3 * a - 1])));
  }
  PetscCall(PetscSNPrintf(tled->breakdown, TLED_MESSAGE,
                          "body %s: a node%s, time %.6g s, is pressed through the surface of an obstacle of its key contact; "
                          "contact_stiffness, %.3g Pa/m, is too small",
                          ((PetscObject)tled)->name, place, (double)time, (double)tled->contact.stiffness));
  PetscFunctionReturn(BY_ERR_BREAKDOWN);
}
