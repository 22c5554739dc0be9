/* bench.proxy - what a sampling of a surface costs in accuracy, without a fluid's noise.

     bench.proxy [-points 6000] [-only SHAPE] [-affine] [-shapes]

   affine: a flat surface and the same stretched by 1/kappa-bar in its plane, sampled at kappa-bar: density and normal force at particles that are stretched with
   it (method 4.3). Prints `affine: kernel | kappa-bar | proxies | density | normal force | tangential`: largest differences over the largest value.

   shapes: the surface of a body whose part of the kernel is known (bench_parts.h), meshed at h/4, sampled by every measure at several densities, for every
   kernel. Points fill the water within h of the body as a Halton sequence does. With hydrostatic pressure p, zero at twice the body's half height above its
   middle, the force on the body is the integral of p grad phi over the water; the same points serve the exact phi, so that only the difference counts. Prints
   `shape: name | kernel | measure | eta | proxies | force | moment | load | mean | rms | largest | seconds`: force's error over the exact force, moment's over force times
   half height, integral of p |error of grad phi| over that of p |grad phi|, mean, rms and largest error of phi, processor seconds to sample and place. Half-space proxies without their
   calibrated inset and factor, which the exact part does not have; ellipsoids and spheres as they are calibrated, which phi does not describe: their
   force and load are scaled by the force of their densest uniform sampling, so that what is left is what a sampling does.

   Lengths in h, dx = h/2, cubic spline. */
#include "../tests/unit/proxy/shapes.h"
#include "bench_parts.h"
#include "proxy/proxy_impl.h"
#include <stdio.h>
#include <time.h>

static const char *const kernels[] = {"half_space", "ellipsoid", "sphere"};
static const char *const shapes[]  = {"plane", "ball", "cylinder", "box", "ellipsoid", "waves", "slim"};
static const PartBody    bodies[]  = {{PART_PLANE, {3, 3, 0}},   {PART_BALL, {2.5, 2.5, 2.5}},   {PART_CYLINDER, {2.5, 2.5, 4}},
                                      {PART_BOX, {3, 2, 2.5}}, {PART_ELLIPSOID, {6, 4, 2.5}}, {PART_WAVES, {0.5, 0.5, 6}},   {PART_ELLIPSOID, {8, 4, 2}}};
static const double      up[3]     = {0.36, -0.48, 0.8};

/* points in the water within h of a body, with what is exact there */
typedef struct {
  PetscInt n;
  double  *x, *phi, *grad, *pressure;
  double   volume, half; /* that a point stands for; half height of the body */
} Water;

static double Seconds(void)
{
  struct timespec t;
  (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

static double Halton(int i, int base)
{
  double f = 1.0, x = 0.0;
  for (; i > 0; i /= base) f /= base, x += f*(i%base);
  return x;
}

static int IsOpen(const PartBody *b) { return b->kind == PART_PLANE || b->kind == PART_WAVES; }

/* mesh of a body, edges of h/4, in its volume: corners of a round one lie a little outside of it as the middles of its triangles lie inside */
static Shape Mesh(const PartBody *b)
{
  const double *s = b->size, e = 0.25, wide = 9.0;
  double        volume = 8.0*s[0]*s[1]*s[2], grow;
  Shape         shape;

  if (b->kind == PART_BOX) return ShapeBox(s[0], s[1], s[2], (int)(2*s[0]/e), (int)(2*s[1]/e), (int)(2*s[2]/e));
  if (b->kind == PART_CYLINDER) shape = ShapeCylinder(s[0], 2.0*s[2], (int)(2.0*BY_PI*s[0]/e), (int)(2.0*s[2]/e)), volume *= BY_PI/4.0;
  else if (IsOpen(b)) shape = ShapePlate(wide, wide, (int)(2*wide/e), (int)(2*wide/e), 0.2);
  else shape = ShapeSphere(1.0, (int)(1.1*fmax(s[0], fmax(s[1], s[2]))/e)), volume *= BY_PI/6.0;
  for (int v = 0; v < shape.n_nodes; v++) {
    double *x = &shape.x[3*v];
    if (b->kind == PART_WAVES) x[2] = PartWave(b, x[0], x[1]);
    for (int k = 0; k < 3 && (b->kind == PART_BALL || b->kind == PART_ELLIPSOID); k++) x[k] *= s[k];
  }
  grow = IsOpen(b) ? 1.0 : b->kind == PART_CYLINDER ? sqrt(volume/ShapeVolume(&shape)) : cbrt(volume/ShapeVolume(&shape));
  for (int v = 0; v < 3*shape.n_nodes; v++) shape.x[v] *= b->kind == PART_CYLINDER && v%3 == 2 ? 1.0 : grow;
  return shape;
}

/* Points, exact phi, and pressure with rho g = 1. A plane and waves are seen through a window of one wave length. */
static PetscErrorCode FillWater(const PartRule *rule, const PartBody *b, PetscInt n_wanted, Water *w)
{
  double low[3], size[3], box = 1.0, level;
  int    n_tried = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc4(3*n_wanted, &w->x, n_wanted, &w->phi, 3*n_wanted, &w->grad, n_wanted, &w->pressure));
  for (int k = 0; k < 3; k++) {
    const double half = b->kind == PART_PLANE ? 3.0 : b->kind == PART_WAVES ? (k < 2 ? 3.0 : 0.5) : b->size[k];
    low[k]  = IsOpen(b) && k < 2 ? -half : b->kind == PART_PLANE ? 0.0 : -half - 1.0;
    size[k] = IsOpen(b) && k < 2 ? 2.0*half : b->kind == PART_PLANE ? 1.0 : 2.0*half + 2.0;
    box *= size[k];
  }
  w->half = b->kind == PART_BOX ? fabs(up[0])*b->size[0] + fabs(up[1])*b->size[1] + fabs(up[2])*b->size[2]
          : b->kind == PART_CYLINDER ? b->size[0]*sqrt(up[0]*up[0] + up[1]*up[1]) + fabs(up[2])*b->size[2]
          : IsOpen(b) ? 3.0 : sqrt(up[0]*up[0]*b->size[0]*b->size[0] + up[1]*up[1]*b->size[1]*b->size[1] + up[2]*up[2]*b->size[2]*b->size[2]);
  level = 2.0*w->half;
  for (w->n = 0; w->n < n_wanted; n_tried++) {
    double *x = &w->x[3*w->n];
    for (int k = 0; k < 3; k++) x[k] = low[k] + size[k]*Halton(n_tried + 1, k == 0 ? 2 : k == 1 ? 3 : 5);
    if (PartInside(b, x)) continue;
    w->phi[w->n] = PartPhi(rule, b, x, &w->grad[3*w->n]);
    if (w->phi[w->n] <= 0.0) continue;
    w->pressure[w->n] = level - Dot3(up, x);
    w->n++;
  }
  w->volume = box/n_tried;
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  double force[3], moment[3], load; /* integrals of p g, x cross p g, p |g| */
} Push;

static void AddPush(const Water *w, PetscInt i, const double g[3], Push *push)
{
  double       f[3], m[3];
  const double p = w->pressure[i]*w->volume;

  for (int k = 0; k < 3; k++) f[k] = p*g[k];
  Cross3(&w->x[3*i], f, m);
  for (int k = 0; k < 3; k++) push->force[k] += f[k], push->moment[k] += m[k];
  push->load += Norm3(f);
}

/* proxies with the measure: 0 uniform, 1 gaussian, 2 principal */
static PetscErrorCode Sampled(const Shape *s, int kernel, int measure, double eta, Proxy *proxy)
{
  const ProxyFluid fluid = {.h = 1.0, .dx = 0.5, .kernel = SPH_CUBIC, .gradient_kernel = SPH_CUBIC, .min = {-50, -50, -50}, .max = {50, 50, 50}};
  ProxyParams     *params;

  PetscFunctionBegin;
  PetscCall(ProxyCreate(PETSC_COMM_SELF, "body", proxy));
  PetscCall(ProxyGetParams(*proxy, &params));
  params->kernel = kernel;
  if (measure == 0) params->kappa = eta;
  else params->measure = measure == 1 ? PROXY_MEASURE_GAUSSIAN : PROXY_MEASURE_PRINCIPAL, params->eta_min = eta;
  if (kernel == PROXY_KERNEL_HALF_SPACE) params->inset = 0.0, params->factor = 1.0;
  PetscCall(ProxySetSurface(*proxy, s->n_nodes, s->x, s->n_triangles, s->triangles));
  PetscCall(ProxySetFluidScale(*proxy, &fluid));
  PetscCall(ProxySetUp(*proxy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one row; `scale` is what the force is multiplied with: made by the densest uniform sampling of ellipsoids and spheres */
static PetscErrorCode Row(int shape, const Shape *mesh, const Water *w, int kernel, int measure, double eta, double *scale)
{
  static const char *const measures[] = {"uniform", "gaussian", "principal"};
  const double             begin = Seconds();
  Push                     exact = {{0}, {0}, 0}, got = {{0}, {0}, 0};
  SPHContacts              c;
  Proxy                    proxy;
  PetscInt                 n;
  double                   mean = 0.0, square = 0.0, load = 0.0, largest = 0.0, force[3], moment[3], seconds;

  PetscFunctionBegin;
  PetscCall(Sampled(mesh, kernel, measure, eta, &proxy));
  seconds = Seconds() - begin;
  PetscCall(ProxyGetPoints(proxy, &n, NULL, NULL, NULL, NULL));
  PetscCall(ProxyFindContacts(proxy, w->n, w->x, &c));
  for (PetscInt pass = 0; pass < 2; pass++) {
    got = exact = (Push){{0}, {0}, 0};
    load = 0.0;
    for (PetscInt i = 0, t = 0; i < w->n; i++) {
      const PetscBool touched = (PetscBool)(t < c.n_touched && c.particle[t] == i);
      double          g[3] = {0, 0, 0}, d[3];
      for (int k = 0; k < 3 && touched; k++) g[k] = *scale*c.grad[3*t + k];
      Sub3(g, &w->grad[3*i], d);
      AddPush(w, i, &w->grad[3*i], &exact);
      AddPush(w, i, g, &got);
      load += w->pressure[i]*w->volume*Norm3(d);
      const double off = (touched ? c.phi[t] : 0.0) - w->phi[i];
      if (pass) mean += off/w->n, square += off*off/w->n, largest = fmax(largest, fabs(off));
      t += touched;
    }
    if (pass == 0 && kernel != PROXY_KERNEL_HALF_SPACE && measure == 0 && eta == 1.0) *scale = Dot3(exact.force, exact.force)/Dot3(got.force, exact.force);
  }
  Sub3(got.force, exact.force, force);
  Sub3(got.moment, exact.moment, moment);
  const double size = Norm3(exact.force);
  printf("shape: %s | %s | %s | %g | %d | %.3e | %.3e | %.3e | %.2e | %.2e | %.2e | %.3f\n", shapes[shape], kernels[kernel], measures[measure], eta, (int)n, Norm3(force)/size,
         Norm3(moment)/(size*w->half), load/exact.load, mean, sqrt(square), largest, seconds);
  PetscCall(ProxyDestroy(&proxy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Shapes(const char only[], PetscInt n_points)
{
  static const double etas[] = {1.0, 0.8, 0.6, 0.5, 0.4, 0.3, 0.2};
  PartRule           *rule;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(1, &rule));
  PartRuleCreate(SPH_CUBIC, rule);
  for (int s = 0; s < (int)(sizeof(shapes)/sizeof(shapes[0])); s++) {
    Shape     mesh;
    Water     water;
    PetscBool same;

    PetscCall(PetscStrcmp(only, shapes[s], &same));
    if (only[0] && !same) continue;
    mesh = Mesh(&bodies[s]);
    PetscCall(FillWater(rule, &bodies[s], bodies[s].kind == PART_WAVES ? n_points/2 : n_points, &water));
    for (int kernel = 0; kernel < 3; kernel++) {
      double scale = 1.0;
      for (int measure = 0; measure < (IsOpen(&bodies[s]) && bodies[s].kind == PART_PLANE ? 1 : 3); measure++) {
        for (size_t k = measure > 0; k < sizeof(etas)/sizeof(etas[0]); k++) PetscCall(Row(s, &mesh, &water, kernel, measure, etas[k], &scale));
      }
    }
    fflush(stdout);
    PetscCall(PetscFree4(water.x, water.phi, water.grad, water.pressure));
    ShapeFree(&mesh);
  }
  PetscCall(PetscFree(rule));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a flat square sampled at kappa, and the points that go with it, stretched by 1/kappa in the plane */
static PetscErrorCode Flat(int kernel, double kappa, PetscInt n, const double at[], PetscInt *n_proxies, double phi[], double grad[])
{
  Shape       plate = ShapePlate(4.0/kappa, 4.0/kappa, 16, 16, 0.0);
  SPHContacts c;
  Proxy       proxy;
  double     *x;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3*n, &x));
  for (PetscInt i = 0; i < n; i++) x[3*i] = at[3*i]/kappa, x[3*i + 1] = at[3*i + 1]/kappa, x[3*i + 2] = at[3*i + 2];
  PetscCall(Sampled(&plate, kernel, 0, kappa, &proxy));
  PetscCall(ProxyGetPoints(proxy, n_proxies, NULL, NULL, NULL, NULL));
  PetscCall(ProxyFindContacts(proxy, n, x, &c));
  PetscCall(PetscArrayzero(phi, n));
  PetscCall(PetscArrayzero(grad, 3*n));
  for (PetscInt t = 0; t < c.n_touched; t++) {
    phi[c.particle[t]] = c.phi[t];
    for (int k = 0; k < 3; k++) grad[3*c.particle[t] + k] = c.grad[3*t + k];
  }
  PetscCall(ProxyDestroy(&proxy));
  PetscCall(PetscFree(x));
  ShapeFree(&plate);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Affine(void)
{
  enum { N = 500 };
  static const double kappas[] = {0.8, 0.6, 0.4, 0.2};
  double              at[3*N], phi[N], grad[3*N], phi1[N], grad1[3*N];
  PetscInt            n;

  PetscFunctionBegin;
  for (int i = 0; i < N; i++) {
    at[3*i]     = 4.0*Halton(i + 1, 2) - 2.0;
    at[3*i + 1] = 4.0*Halton(i + 1, 3) - 2.0;
    at[3*i + 2] = 0.01 + 0.98*Halton(i + 1, 5);
  }
  for (int kernel = 0; kernel < 3; kernel++) {
    PetscCall(Flat(kernel, 1.0, N, at, &n, phi1, grad1));
    for (size_t k = 0; k < sizeof(kappas)/sizeof(kappas[0]); k++) {
      double density = 0.0, normal = 0.0, tangential = 0.0, top = 0.0, top_grad = 0.0;
      PetscCall(Flat(kernel, kappas[k], N, at, &n, phi, grad));
      for (int i = 0; i < N; i++) {
        top        = fmax(top, phi1[i]);
        top_grad   = fmax(top_grad, fabs(grad1[3*i + 2]));
        density    = fmax(density, fabs(phi[i] - phi1[i]));
        normal     = fmax(normal, fabs(grad[3*i + 2] - grad1[3*i + 2]));
        for (int d = 0; d < 2; d++) tangential = fmax(tangential, fabs(grad[3*i + d] - kappas[k]*grad1[3*i + d]));
      }
      printf("affine: %s | %g | %d | %.1e | %.1e | %.1e\n", kernels[kernel], kappas[k], (int)n, density/top, normal/top_grad, tangential/top_grad);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscInt  n_points = 6000;
  char      only[32] = "";
  PetscBool affine = PETSC_FALSE, all = PETSC_FALSE;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-points", &n_points, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-only", only, sizeof(only), NULL));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-affine", &affine));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-shapes", &all));
  if (affine || !all) PetscCall(Affine());
  if (all || !affine) PetscCall(Shapes(only, n_points));
  PetscCall(PetscFinalize());
  return 0;
}
