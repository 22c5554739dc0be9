/* coupler_stop.c - no particle ends a step inside a body.

   Pressure keeps the water out of a surface as the proxies see it, averaged over their supports and as the solid's answer was predicted. A lone
   particle at impact speed, a sharp edge, a dent smaller than a support can still let one end a step inside by a tenth of dx. So before the
   particles move, those near a surface are held against its triangles at the end of the step. Where a particle would end inside it meets
   the triangle in a plastic impact, with the nodes' masses: the normal relative speed goes, momentum stays, energy never grows.
   What is then still missing to SPH_STOP_GAP the particle is moved along the normal, without momentum. Still water never comes so near. In a crevice what leads
   out of one triangle leads into another: those that were stopped are looked at again, a few times. */
#include "coupler_impl.h"
#include "mat3.h"

#define STOP_PASSES 4   /* how often one particle may be stopped in a step                                   */
#define STOP_AGAIN  0.5 /* of SPH_STOP_GAP: what comes nearer by a stop elsewhere is stopped again           */

typedef struct {
  PetscInt         n, n_triangles;
  const PetscInt  *triangles;
  const PetscReal *x;                  /* nodes at the end of the step             */
  PetscReal       *at, *distance, *weights, *winding;
  PetscInt        *triangle;
} Near;

/* In a periodic domain the image of a particle that touches proxies need not be the one that is nearest to the triangles: where a surface spans the
   domain, the particle itself may be. Take that one where it is nearer. */
static PetscErrorCode TryParticles(Near *near, const SPHContacts *q, const PetscReal x[], const PetscReal v[], PetscReal dt, PetscReal reach)
{
  PetscInt   n = 0, *which, *triangle;
  PetscReal *at, *distance, *weights;

  PetscFunctionBegin;
  PetscCall(PetscMalloc5(near->n, &which, near->n, &triangle, 3 * near->n, &at, near->n, &distance, 3 * near->n, &weights));
  for (PetscInt t = 0; t < near->n; t++) {
    const PetscInt i = 3 * q->particle[t];

    if (x[i] == q->position[3 * t] && x[i + 1] == q->position[3 * t + 1] && x[i + 2] == q->position[3 * t + 2]) continue;
    for (int k = 0; k < 3; k++) at[3 * n + k] = x[i + k] + dt * v[i + k];
    which[n++] = t;
  }
  if (n) PetscCall(SurfaceClosest(n, at, near->x, near->n_triangles, near->triangles, reach, distance, triangle, weights));
  for (PetscInt j = 0; j < n; j++) {
    const PetscInt t = which[j];

    if (triangle[j] < 0 || (near->triangle[t] >= 0 && near->distance[t] <= distance[j])) continue;
    near->triangle[t] = triangle[j];
    near->distance[t] = distance[j];
    PetscCall(PetscArraycpy(near->at + 3 * t, at + 3 * j, 3));
    PetscCall(PetscArraycpy(near->weights + 3 * t, weights + 3 * j, 3));
  }
  PetscCall(PetscFree5(which, triangle, at, distance, weights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the touched particles of surface k where they would end, and the closest triangles */
static PetscErrorCode FindNear(Coupler c, PetscInt k, PetscReal dt, Near *near)
{
  CouplerSurface    *s = &c->surface[k];
  const SPHContacts *q = &c->contacts[k];
  const PetscReal   *x, *v, *p, *rho, *velocity;
  const PetscInt    *id;
  SPHParams         *params;

  PetscFunctionBegin;
  near->n           = q->n_touched;
  near->x           = s->moves ? s->x_next : s->x;
  near->triangles   = s->triangles;
  near->n_triangles = s->n_triangles;
  if (s->tled) {
    PetscCall(TLEDGetSurface(s->tled, PETSC_FALSE, &near->n_triangles, &near->triangles));
    PetscCall(TLEDGetPositions(s->tled, &near->x, &velocity));
  }
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(SPHGetState(c->sph, &x, &v, &p, &rho, &id));
  PetscCall(PetscMalloc5(3 * near->n, &near->at, near->n, &near->distance, 3 * near->n, &near->weights, near->n, &near->winding, near->n, &near->triangle));
  for (PetscInt t = 0; t < near->n; t++) {
    for (int i = 0; i < 3; i++) near->at[3 * t + i] = q->position[3 * t + i] + dt * v[3 * q->particle[t] + i];
  }
  PetscCall(SurfaceClosest(near->n, near->at, near->x, near->n_triangles, near->triangles, 0.5 * params->spacing, near->distance, near->triangle, near->weights));
  PetscCall(TryParticles(near, q, x, v, dt, 0.5 * params->spacing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* winding numbers of those that have a triangle in reach; the others are 0 */
static PetscErrorCode FindInside(Near *near)
{
  PetscInt   n = 0, *which;
  PetscReal *points, *winding;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(near->n, &which, 3 * near->n, &points, near->n, &winding));
  for (PetscInt t = 0; t < near->n; t++) {
    near->winding[t] = 0.0;
    if (near->triangle[t] < 0) continue;
    for (int i = 0; i < 3; i++) points[3 * n + i] = near->at[3 * t + i];
    which[n++] = t;
  }
  PetscCall(SurfaceWinding(n, points, near->x, near->n_triangles, near->triangles, winding));
  for (PetscInt j = 0; j < n; j++) near->winding[which[j]] = winding[j];
  PetscCall(PetscFree3(which, points, winding));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* outward direction at the foot of a particle on its triangle: to the particle, or away from it when it is inside; the triangle's own
   normal when it lies on it */
static void Outward(const Near *near, PetscInt t, PetscReal sign, PetscReal normal[3])
{
  const PetscInt *v = &near->triangles[3 * near->triangle[t]];
  double          a[3], b[3], length;

  for (int i = 0; i < 3; i++) {
    normal[i] = near->at[3 * t + i];
    for (int j = 0; j < 3; j++) normal[i] -= near->weights[3 * t + j] * near->x[3 * v[j] + i];
    normal[i] *= sign;
  }
  Sub3(&near->x[3 * v[1]], &near->x[3 * v[0]], a);
  Sub3(&near->x[3 * v[2]], &near->x[3 * v[0]], b);
  if (Norm3(normal) < 1e-9 * (Norm3(a) + Norm3(b))) Cross3(a, b, normal);
  length = Norm3(normal);
  for (int i = 0; i < 3; i++) normal[i] /= length;
}

/* Impulse of a plastic impact of particle t with its triangle along the normal [N s]: takes the approaching relative speed away and gives
   the nodes their part, which move in their free directions P n only; v are the nodes' velocities. An obstacle that
   moves has any mass. */
static PetscReal Impact(CouplerSurface *s, const Near *near, PetscInt t, PetscReal particle_mass, const PetscReal vi[3], const PetscReal normal[3],
                        const PetscReal mass[], PetscReal v[], PetscReal dt)
{
  const PetscInt *node    = &near->triangles[3 * near->triangle[t]];
  PetscReal       inverse = 1.0 / particle_mass, speed = Dot3(vi, normal), wall = 0.0, work = 0.0, way[3][3], J;

  for (int a = 0; s->tled && a < 3; a++) {
    const PetscReal  w = near->weights[3 * t + a];
    const PetscReal *P;

    (void)TLEDGetProjector(s->tled, node[a], &P);
    for (int i = 0; i < 3; i++) way[a][i] = P ? Dot3(&P[3 * i], normal) : normal[i];
    speed -= w * Dot3(&v[3 * node[a]], normal);
    inverse += w * w / mass[node[a]] * Dot3(way[a], normal);
  }
  for (int a = 0; s->moves && a < 3; a++) wall += near->weights[3 * t + a] * Dot3(&s->v_nodes[3 * node[a]], normal);
  speed -= wall;
  J = PetscMax(0.0, -speed / inverse);
  s->power -= J * wall / dt;
  for (int a = 0; s->tled && a < 3; a++) {
    for (int i = 0; i < 3; i++) {
      const PetscReal gain = -J * near->weights[3 * t + a] / mass[node[a]] * way[a][i];

      work += mass[node[a]] * gain * (v[3 * node[a] + i] + 0.5 * gain);
      v[3 * node[a] + i] += gain;
    }
  }
  s->work_solid += work;
  s->work_fluid += work; // what is lost besides is heat, not work
  return J;
}

/* those that were stopped, whose ends have changed: the closest triangles again */
static PetscErrorCode FindAgain(Near *near, PetscReal reach)
{
  PetscInt   n = 0, *which, *triangle;
  PetscReal *at, *distance, *weights;

  PetscFunctionBegin;
  PetscCall(PetscMalloc5(near->n, &which, near->n, &triangle, 3 * near->n, &at, near->n, &distance, 3 * near->n, &weights));
  for (PetscInt t = 0; t < near->n; t++) {
    if (near->triangle[t] < 0) continue;
    PetscCall(PetscArraycpy(at + 3 * n, near->at + 3 * t, 3));
    which[n++] = t;
  }
  PetscCall(SurfaceClosest(n, at, near->x, near->n_triangles, near->triangles, reach, distance, triangle, weights));
  for (PetscInt j = 0; j < n; j++) {
    const PetscInt t = which[j];

    near->triangle[t] = triangle[j];
    near->distance[t] = distance[j];
    PetscCall(PetscArraycpy(near->weights + 3 * t, weights + 3 * j, 3));
  }
  PetscCall(PetscFree5(which, triangle, at, distance, weights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All particles of a surface, one after another, that end nearer than `stop`; lost: angular momentum that the water has lost [N m s]. The others'
   triangles are forgotten; n_stopped: how many are left. */
static PetscErrorCode StopParticles(Coupler c, PetscInt k, PetscReal dt, Near *near, PetscReal nearest, PetscReal v_nodes[], PetscReal lost[3], PetscInt *n_stopped)
{
  CouplerSurface    *s = &c->surface[k];
  const SPHContacts *q = &c->contacts[k];
  const PetscReal   *x, *v, *p, *rho, *mass = NULL;
  const PetscInt    *id;
  SPHParams         *params;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(SPHGetState(c->sph, &x, &v, &p, &rho, &id));
  if (s->tled) PetscCall(TLEDGetMass(s->tled, &mass));
  *n_stopped = 0;
  for (PetscInt t = 0; t < near->n; t++) {
    const PetscReal gap = (near->winding[t] > 0.5 ? -1.0 : 1.0) * near->distance[t], stop = SPH_STOP_GAP * params->spacing;
    PetscReal       normal[3], change[3], shift[3], vi[3], m[3], J;

    if (near->triangle[t] < 0 || gap >= nearest) {
      near->triangle[t] = -1;
      continue;
    }
    (*n_stopped)++;
    Outward(near, t, gap < 0.0 ? -1.0 : 1.0, normal);
    for (int i = 0; i < 3; i++) vi[i] = v[3 * q->particle[t] + i];
    J = Impact(s, near, t, c->mass, vi, normal, mass, v_nodes, dt);
    for (int i = 0; i < 3; i++) {
      change[i] = J / c->mass * normal[i];
      shift[i]  = PetscMax(0.0, stop - gap - dt * J / c->mass) * normal[i];
      vi[i] += change[i];
      near->at[3 * t + i] += dt * change[i] + shift[i];
      s->total[i] -= c->mass * change[i] / dt;
    }
    PetscCall(SPHStop(c->sph, q->particle[t], change, shift));
    Cross3(&q->position[3 * t], change, m);
    for (int i = 0; i < 3; i++) {
      lost[i] -= c->mass * m[i];
      s->moment[i] -= c->mass * m[i] / dt;
    }
    Cross3(shift, vi, m);
    for (int i = 0; i < 3; i++) lost[i] -= c->mass * m[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* particles of surface k, after the kick of the fluid and the step of the body */
static PetscErrorCode StopAtSurface(Coupler c, PetscInt k, PetscReal dt)
{
  CouplerSurface *s = &c->surface[k];
  PetscReal       lost[3] = {0, 0, 0}, before[3], after[3], *v = NULL;
  PetscBool       is_free = PETSC_FALSE;
  Vec             U, V = NULL, F;
  SPHParams      *params;
  PetscInt        n_stopped;
  Near            near;

  PetscFunctionBegin;
  PetscCall(FindNear(c, k, dt, &near));
  PetscCall(FindInside(&near));
  if (s->tled) {
    PetscCall(TLEDIsFree(s->tled, &is_free));
    if (is_free) PetscCall(CouplerAngularMomentum(s, before, NULL));
    PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
    PetscCall(VecGetArray(V, &v));
  }
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(StopParticles(c, k, dt, &near, SPH_STOP_GAP * params->spacing, v, lost, &n_stopped));
  for (int pass = 1; pass < STOP_PASSES && n_stopped; pass++) {
    PetscCall(FindAgain(&near, 0.5 * params->spacing));
    PetscCall(FindInside(&near));
    PetscCall(StopParticles(c, k, dt, &near, STOP_AGAIN * SPH_STOP_GAP * params->spacing, v, lost, &n_stopped));
  }
  if (s->tled) PetscCall(VecRestoreArray(V, &v));
  if (is_free) {
    // impulses act where particles and nodes are at different instants: a free body gets the difference
    PetscCall(CouplerAngularMomentum(s, after, NULL));
    for (int i = 0; i < 3; i++) lost[i] -= after[i] - before[i];
    PetscCall(CouplerAddRotation(s, lost));
  }
  PetscCall(PetscFree5(near.at, near.distance, near.weights, near.winding, near.triangle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* stop particles at all bodies and obstacles, between SPHKick and SPHDrift */
PetscErrorCode CouplerStop(Coupler c, PetscReal dt)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    if (c->surface[k].proxy && c->contacts[k].n_touched) PetscCall(StopAtSurface(c, k, dt));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* move particles that start inside a body, or nearer than the stop, out to it; n_moved tells how many there were */
PetscErrorCode CouplerPushOut(Coupler c, PetscInt *n_moved)
{
  const PetscReal still[3] = {0, 0, 0};
  SPHParams      *params;

  PetscFunctionBegin;
  *n_moved = 0;
  PetscCall(SPHGetParams(c->sph, &params));
  for (PetscInt k = 0; k < c->n_surfaces; k++) {
    Near near;

    if (!c->surface[k].proxy || !c->contacts[k].n_touched) continue;
    PetscCall(FindNear(c, k, 0.0, &near));
    PetscCall(FindInside(&near));
    for (PetscInt t = 0; t < near.n; t++) {
      const PetscReal gap = (near.winding[t] > 0.5 ? -1.0 : 1.0) * near.distance[t], stop = SPH_STOP_GAP * params->spacing;
      PetscReal       normal[3], shift[3];

      if (near.triangle[t] < 0 || gap >= stop) continue;
      Outward(&near, t, gap < 0.0 ? -1.0 : 1.0, normal);
      for (int i = 0; i < 3; i++) shift[i] = (stop - gap) * normal[i];
      PetscCall(SPHStop(c->sph, c->contacts[k].particle[t], still, shift));
      (*n_moved)++;
    }
    PetscCall(PetscFree5(near.at, near.distance, near.weights, near.winding, near.triangle));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
