/* coupler_stop.c - no particle ends a step inside a body.

   Pressure keeps the water out of a surface as the proxies see it, averaged over their supports and as the solid's answer was predicted. A lone
   particle at impact speed, a sharp edge, a dent smaller than a support can still let one end a step inside by a tenth of dx. So before the
   particles move, those near a surface are held against its triangles at the end of the step: where a particle would end inside, the
   normal part of its velocity relative to the triangle is cut (a plastic impact, SPHStopLacking), and the triangle's nodes get the
   opposite impulse by the foot's barycentric weights. Momentum is kept; still water never comes so near. */
#include "coupler_impl.h"
#include "mat3.h"

typedef struct {
  PetscInt         n, n_triangles;
  const PetscInt  *triangles;
  const PetscReal *x;                  /* nodes at the end of the step             */
  PetscReal       *at, *distance, *weights, *winding;
  PetscInt        *triangle;
} Near;

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
  near->x           = s->x;
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

/* give the nodes of a body the impulses J (n x 3 [N s]); the moment about the origin that the fluid lost is `moment` [N m s] */
static PetscErrorCode TakeImpulses(CouplerSurface *s, const PetscReal J[], const PetscReal moment[3])
{
  const PetscReal *mass, *x, *velocity;
  const PetscBool *constrained;
  PetscReal       *v, given[3];
  PetscBool        is_free;
  Vec              U, V, F;

  PetscFunctionBegin;
  PetscCall(TLEDGetMass(s->tled, &mass));
  PetscCall(TLEDIsConstrained(s->tled, &constrained));
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArray(V, &v));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) {
    const PetscReal gain = constrained[i / 3] ? 0.0 : J[i] / mass[i / 3];

    s->work_solid += J[i] * (v[i] + 0.5 * gain);
    v[i] += gain;
  }
  PetscCall(VecRestoreArray(V, &v));
  PetscCall(TLEDIsFree(s->tled, &is_free));
  if (!is_free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TLEDGetPositions(s->tled, &x, &velocity));
  CouplerMoment(s->n_nodes, x, J, given);
  for (int k = 0; k < 3; k++) given[k] = moment[k] - given[k];
  PetscCall(CouplerAddRotation(s, given));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* particles of surface k, after the kick of the fluid and the step of the body */
static PetscErrorCode StopAtSurface(Coupler c, PetscInt k, PetscReal dt)
{
  CouplerSurface    *s = &c->surface[k];
  const SPHContacts *q = &c->contacts[k];
  const PetscReal   *x, *v, *p, *rho;
  const PetscInt    *id;
  PetscReal          moment[3] = {0, 0, 0};
  PetscInt           n_stopped = 0;
  Near               near;

  PetscFunctionBegin;
  PetscCall(FindNear(c, k, dt, &near));
  PetscCall(FindInside(&near));
  PetscCall(SPHGetState(c->sph, &x, &v, &p, &rho, &id));
  if (s->tled) PetscCall(PetscArrayzero(s->answer, 3 * s->n_nodes));
  for (PetscInt t = 0; t < near.n; t++) {
    const PetscReal  sign = near.winding[t] > 0.5 ? -1.0 : 1.0, *vi = &v[3 * q->particle[t]];
    const PetscInt  *node;
    PetscReal        normal[3], wall[3] = {0, 0, 0}, change[3], m[3];

    if (near.triangle[t] < 0) continue;
    node = &near.triangles[3 * near.triangle[t]];
    Outward(&near, t, sign, normal);
    for (int a = 0; s->tled && a < 3; a++) {
      for (int i = 0; i < 3; i++) wall[i] += near.weights[3 * t + a] * s->mean_velocity[3 * node[a] + i];
    }
    const PetscReal speed   = Dot3(vi, normal) - Dot3(wall, normal);
    const PetscReal lacking = SPHStopLacking(c->sph, sign * near.distance[t] - dt * speed, speed, dt);

    if (lacking == 0.0) continue;
    n_stopped++;
    for (int i = 0; i < 3; i++) change[i] = lacking * normal[i];
    PetscCall(SPHAddVelocity(c->sph, q->particle[t], change));
    Cross3(&q->position[3 * t], change, m);
    for (int i = 0; i < 3; i++) {
      moment[i] -= c->mass * m[i];
      s->total[i] -= c->mass * change[i] / dt;
      s->work_fluid -= c->mass * change[i] * wall[i];
      for (int a = 0; s->tled && a < 3; a++) s->answer[3 * node[a] + i] -= c->mass * near.weights[3 * t + a] * change[i];
    }
  }
  if (n_stopped && s->tled) PetscCall(TakeImpulses(s, s->answer, moment));
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
