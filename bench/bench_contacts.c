/* bench.contacts - what proxies cost a step: a ball of radius R in water, one thread, least of several repetitions.

     bench.contacts [-radius 5] [-level 24] [-repeat 20] [-eta 1,0.4] [-kernels half_space,ellipsoid,sphere]

     bench.contacts -stretch [-eta 1,0.4]

   Prints `contacts: kernel | kappa-bar | proxies | particles | touched | pairs | sample | update | moving | static` with processor milliseconds: sampling afresh,
   moving with the surface, contacts where the surface has moved, and where it has not. Lengths in h, dx = h/2.

   -stretch: a ball of radius 2.5 h becomes an ellipsoid of the same volume, 1.8 times as long, in 60 steps, as a body that deforms. Prints
   `stretch: tolerance | kappa-bar | samplings | proxies | update | mean | rms | largest`: processor milliseconds of an update, samplings included, and the errors of
   phi over all steps at 300 points within h of the surface, against the kernel's part in the ellipsoid (bench_parts.h). */
#include "../tests/unit/proxy/shapes.h"
#include "bench_parts.h"
#include "proxy/proxy_impl.h"
#include <stdio.h>
#include <time.h>

static double Milliseconds(void)
{
  struct timespec t;
  (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3*(double)t.tv_sec + 1e-6*(double)t.tv_nsec;
}

/* a lattice of spacing 1/2, stirred by a tenth, outside the ball as far as 3.5 h */
static PetscErrorCode Water(double radius, PetscInt *n, PetscReal **x)
{
  const int     m = (int)(2.0*(radius + 3.5)) + 1;
  unsigned long state = 1;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3*(2*m + 1)*(2*m + 1)*(2*m + 1), x));
  *n = 0;
  for (int i = 0; i < (2*m + 1)*(2*m + 1)*(2*m + 1); i++) {
    double p[3] = {0.5*(i%(2*m + 1) - m), 0.5*(i/(2*m + 1)%(2*m + 1) - m), 0.5*(i/(2*m + 1)/(2*m + 1) - m)};
    for (int k = 0; k < 3; k++) {
      state = state*6364136223846793005UL + 1442695040888963407UL;
      p[k] += 0.1*((double)(state >> 11)/9007199254740992.0 - 0.5);
    }
    const double r = Norm3(p);
    if (r < radius + 0.1 || r > radius + 3.5) continue;
    for (int k = 0; k < 3; k++) (*x)[3*(*n) + k] = p[k];
    (*n)++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Measure(const Shape *s, int kernel, const char name[], double eta, PetscInt repeat, PetscInt n, const PetscReal x[])
{
  const ProxyFluid fluid = {1.0, 0.5, SPH_CUBIC, SPH_CUBIC, {-50, -50, -50}, {50, 50, 50}, 0, 0, {0}};
  double           least[4] = {1e300, 1e300, 1e300, 1e300}, *moved;
  ProxyParams     *params;
  SPHContacts      c;
  Proxy            p;

  PetscFunctionBegin;
  PetscCall(ProxyCreate(PETSC_COMM_SELF, "body", &p));
  PetscCall(ProxyGetParams(p, &params));
  params->kernel = kernel;
  params->kappa  = eta;
  PetscCall(ProxySetSurface(p, s->n_nodes, s->x, s->n_triangles, s->triangles));
  PetscCall(ProxySetFluidScale(p, &fluid));
  PetscCall(ProxySetUp(p));
  PetscCall(PetscMalloc1(3*s->n_nodes, &moved));
  for (PetscInt r = 0; r < repeat; r++) {
    for (int i = 0; i < 3*s->n_nodes; i++) moved[i] = s->x[i]*(1.0 + 1e-9*(double)(r + 1));
    double at[5];
    at[0] = Milliseconds();
    PetscCall(ProxySetSampling(p, s->x));
    at[1] = Milliseconds();
    PetscCall(ProxyUpdate(p, moved, moved));
    at[2] = Milliseconds();
    PetscCall(ProxyFindContacts(p, n, x, &c));
    at[3] = Milliseconds();
    PetscCall(ProxyFindContacts(p, n, x, &c));
    at[4] = Milliseconds();
    for (int k = 0; k < 4; k++) least[k] = PetscMin(least[k], at[k + 1] - at[k]);
  }
  printf("contacts: %s | %g | %d | %d | %d | %d | %.2f | %.2f | %.2f | %.2f\n", name, eta, (int)p->n, (int)n, (int)c.n_touched, (int)c.start[c.n_touched], least[0], least[1],
         least[2], least[3]);
  PetscCall(PetscFree(moved));
  PetscCall(ProxyDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 300 places within h off the ellipsoid: directions of a Fibonacci lattice, heights by the golden ratio */
static void Around(const double half[3], int i, double x[3])
{
  const double z = 1.0 - (2.0*i + 1.0)/300.0, angle = 2.39996322972865332*i, r = sqrt(1.0 - z*z), up = 0.02 + 0.9*fmod(0.618033988749895*i, 1.0);
  double       n[3] = {r*cos(angle), r*sin(angle), z}, g[3], l;

  for (int k = 0; k < 3; k++) g[k] = n[k]/half[k];
  l = Norm3(g);
  for (int k = 0; k < 3; k++) x[k] = half[k]*n[k] + up*g[k]/l;
}

static PetscErrorCode Stretch(const PartRule *rule, double tolerance, double eta)
{
  enum { STEPS = 60, POINTS = 300 };
  const ProxyFluid fluid = {1.0, 0.5, SPH_CUBIC, SPH_CUBIC, {-50, -50, -50}, {50, 50, 50}, 0, 0, {0}};
  Shape            s = ShapeSphere(2.5, 12);
  double           spent = 0.0, sum = 0.0, square = 0.0, most = 0.0, x[3*POINTS], *node;
  ProxyParams     *params;
  SPHContacts      c;
  Proxy            p;

  PetscFunctionBegin;
  PetscCall(ProxyCreate(PETSC_COMM_SELF, "body", &p));
  PetscCall(ProxyGetParams(p, &params));
  params->kappa = eta, params->factor = 1.0, params->inset = 0.0, params->resample_tolerance = tolerance;
  PetscCall(ProxySetSurface(p, s.n_nodes, s.x, s.n_triangles, s.triangles));
  PetscCall(ProxySetFluidScale(p, &fluid));
  PetscCall(ProxySetUp(p));
  PetscCall(PetscMalloc1(3*s.n_nodes, &node));
  for (int step = 1; step <= STEPS; step++) {
    const double   stretch = 1.0 + 0.8*step/STEPS, factor[3] = {stretch, 1.0/sqrt(stretch), 1.0/sqrt(stretch)};
    const PartBody body = {PART_ELLIPSOID, {2.5*factor[0], 2.5*factor[1], 2.5*factor[2]}};
    for (int i = 0; i < 3*s.n_nodes; i++) node[i] = s.x[i]*factor[i%3];
    for (int i = 0; i < POINTS; i++) Around(body.size, i, &x[3*i]);
    const double begin = Milliseconds();
    PetscCall(ProxyUpdate(p, node, node));
    spent += Milliseconds() - begin;
    PetscCall(ProxyFindContacts(p, POINTS, x, &c));
    for (int i = 0, t = 0; i < POINTS; i++) {
      double       grad[3];
      const double phi = t < c.n_touched && c.particle[t] == i ? c.phi[t++] : 0.0, error = phi - PartPhi(rule, &body, &x[3*i], grad);
      sum += error/(STEPS*POINTS), square += error*error/(STEPS*POINTS), most = fmax(most, fabs(error));
    }
  }
  printf("stretch: %g | %g | %d | %d | %.2f | %.1e | %.1e | %.1e\n", tolerance, eta, (int)p->n_samplings, (int)p->n, spent/STEPS, sum, sqrt(square), most);
  PetscCall(PetscFree(node));
  PetscCall(ProxyDestroy(&p));
  ShapeFree(&s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char *argv[])
{
  static const char *const names[] = {"half_space", "ellipsoid", "sphere"};
  PetscReal                radius = 5.0, eta[8] = {1.0, 0.4}, *x;
  PetscInt                 level = 24, repeat = 20, n_eta = 8, n = 0;
  PetscBool                given, stretch;
  Shape                    s;
  char                     kernels[64] = "half_space,ellipsoid,sphere";

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-radius", &radius, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-level", &level, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeat", &repeat, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-kernels", kernels, sizeof(kernels), NULL));
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-eta", eta, &n_eta, &given));
  if (!given) n_eta = 2;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-stretch", &stretch));
  if (stretch) {
    static const double tolerances[] = {0.0, 0.02, 0.1, 0.3, 10.0};
    PartRule            rule;
    PartRuleCreate(SPH_CUBIC, &rule);
    for (int k = 0; k < 5*n_eta; k++) PetscCall(Stretch(&rule, tolerances[k%5], eta[k/5]));
    PetscCall(PetscFinalize());
    return 0;
  }
  s = ShapeSphere(radius, (int)level);
  PetscCall(Water(radius, &n, &x));
  printf("triangles %d\n", s.n_triangles);
  for (int k = 0; k < 3; k++) {
    if (!strstr(kernels, names[k])) continue;
    for (PetscInt e = 0; e < n_eta; e++) PetscCall(Measure(&s, k, names[k], eta[e], repeat, n, x));
  }
  PetscCall(PetscFree(x));
  ShapeFree(&s);
  PetscCall(PetscFinalize());
  return 0;
}
