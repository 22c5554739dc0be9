/* proxy_patch.c - force on a part of the surface, for gauges: proxies stand for pieces of triangles, which a box cuts. */
#include "proxy/proxy_impl.h"

#define CORNERS 9 /* a triangle has at most six more after six cuts */

/* cut the polygon at coordinate k: keep sign (x_k - at) >= 0; number of its corners afterwards */
static int Cut(int n, double p[CORNERS][3], int k, double at, double sign)
{
  double q[CORNERS][3];
  int    m = 0;

  for (int i = 0; i < n; i++) {
    const double *a = p[i], *b = p[(i + 1)%n], da = sign*(a[k] - at), db = sign*(b[k] - at);
    if (da >= 0.0) {
      for (int d = 0; d < 3; d++) q[m][d] = a[d];
      m++;
    }
    if ((da >= 0.0) != (db >= 0.0)) {
      for (int d = 0; d < 3; d++) q[m][d] = a[d] + da/(da - db)*(b[d] - a[d]);
      m++;
    }
  }
  for (int i = 0; i < m; i++) {
    for (int d = 0; d < 3; d++) p[i][d] = q[i][d];
  }
  return m;
}

/* area of the part of a triangle that lies in a box */
static double AreaInBox(const double corner[3][3], const double lo[3], const double hi[3])
{
  double p[CORNERS][3], sum[3] = {0, 0, 0};
  int    n = 3;

  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) p[i][k] = corner[i][k];
  }
  for (int k = 0; k < 3 && n; k++) {
    n = Cut(n, p, k, lo[k], 1.0);
    if (n) n = Cut(n, p, k, hi[k], -1.0);
  }
  for (int i = 1; i + 1 < n; i++) {
    double a[3], b[3], c[3];
    Sub3(p[i], p[0], a);
    Sub3(p[i + 1], p[0], b);
    Cross3(a, b, c);
    for (int k = 0; k < 3; k++) sum[k] += 0.5*c[k];
  }
  return Norm3(sum);
}

/* does the box of triangle t miss the box? */
static int Misses(const ProxySurface *s, PetscInt t, const double lo[3], const double hi[3])
{
  for (int k = 0; k < 3; k++) {
    const double a = s->X[3*s->triangles[3*t] + k], b = s->X[3*s->triangles[3*t + 1] + k], c = s->X[3*s->triangles[3*t + 2] + k];
    if (PetscMax(a, PetscMax(b, c)) < lo[k] || PetscMin(a, PetscMin(b, c)) > hi[k]) return 1;
  }
  return 0;
}

/* add what the pieces of triangle t in the box have: push[] by proxy of the sampling [Pa], sums of force [N] and area [m^2] */
static void AddTriangle(const Proxy p, PetscInt t, const double lo[3], const double hi[3], const double push[], double sum[2])
{
  const ProxySurface  *s  = &p->surface;
  const ProxySampling *q  = &p->sampling;
  const PetscInt       m  = (PetscInt)floor(sqrt((double)(q->piece_start[t + 1] - q->piece_start[t])) + 0.5), *v = &s->triangles[3*t];
  PetscInt             piece = q->piece_start[t];
  double               whole[3][3], a[3], b[3], c[3];

  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) whole[i][k] = s->X[3*v[i] + k];
  }
  Sub3(whole[1], whole[0], a);
  Sub3(whole[2], whole[0], b);
  Cross3(a, b, c);
  const double scale = p->geometry.area[t]/(0.5*Norm3(c)); // of the deformed to the reference area
  for (PetscInt i = 0; i < m; i++) {
    for (PetscInt j = 0; j < m - i; j++) {
      for (int down = 0; down < (i + j < m - 1 ? 2 : 1); down++, piece++) {
        const double u[3] = {down ? i + 1.0 : i, down ? i : i + 1.0, down ? i + 1.0 : i}, w[3] = {down ? j + 1.0 : j, down ? j + 1.0 : j, down ? j : j + 1.0};
        double       corner[3][3];
        for (int n = 0; n < 3; n++) {
          for (int k = 0; k < 3; k++) corner[n][k] = whole[0][k] + (u[n]*a[k] + w[n]*b[k])/m;
        }
        const double area = scale*AreaInBox(corner, lo, hi);
        sum[0] += area*push[q->piece_owner[piece]];
        sum[1] += area;
      }
    }
  }
}

/*@
  ProxyGetPatch - force along the normals on the part of the surface that a box cuts out of it, in its reference position

  Input Parameters:
+ proxy - set up
. min   - lower corner of the box [m]
. max   - upper corner
- force - of the fluid on each proxy in use [N], n x 3; NULL: none

  Output Parameters:
+ push - force into the surface [N]
- area - of the patch as it is now [m^2]; 0: the box misses the surface

  Note: The force on a proxy is spread over the area that it stands for, which proxies that are far apart share with several patches.
  Tests: tests/unit/proxy/test_patch.c, tests/coupled/gauges
@*/
PetscErrorCode ProxyGetPatch(Proxy p, const PetscReal min[3], const PetscReal max[3], const PetscReal force[], PetscReal *push, PetscReal *area)
{
  const double tol = 1e-6*p->fluid.dx; // a flat box may hold a flat face
  double       lo[3], hi[3], sum[2] = {0.0, 0.0}, *pressure;

  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  for (int k = 0; k < 3; k++) lo[k] = min[k] - tol, hi[k] = max[k] + tol;
  PetscCall(PetscCalloc1(p->sampling.n, &pressure));
  for (PetscInt j = 0; force && j < p->n; j++) {
    if (p->area[j] > 0.0) pressure[p->active[j]] = -Dot3(&force[3*j], &p->normal[3*j])/p->area[j];
  }
  for (PetscInt t = 0; t < p->surface.n_triangles; t++) {
    if (!Misses(&p->surface, t, lo, hi)) AddTriangle(p, t, lo, hi, pressure, sum);
  }
  PetscCall(PetscFree(pressure));
  *push = sum[0];
  *area = sum[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}
