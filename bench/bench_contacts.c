/* bench.contacts - what proxies cost a step: a ball of radius R in water, one thread, least of several repetitions.

     bench.contacts [-radius 5] [-level 24] [-repeat 20] [-eta 1,0.4] [-kernels half_space,ellipsoid,sphere]

   Prints `contacts: kernel | kappa-bar | proxies | particles | touched | pairs | sample | update | moving | static` with processor milliseconds: sampling afresh,
   moving with the surface, contacts where the surface has moved, and where it has not. Lengths in h, dx = h/2. */
#include "../tests/unit/proxy/shapes.h"
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

int main(int argc, char *argv[])
{
  static const char *const names[] = {"half_space", "ellipsoid", "sphere"};
  PetscReal                radius = 5.0, eta[8] = {1.0, 0.4}, *x;
  PetscInt                 level = 24, repeat = 20, n_eta = 8, n = 0;
  PetscBool                given;
  Shape                    s;
  char                     kernels[64] = "half_space,ellipsoid,sphere";

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-radius", &radius, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-level", &level, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeat", &repeat, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-kernels", kernels, sizeof(kernels), NULL));
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-eta", eta, &n_eta, &given));
  if (!given) n_eta = 2;
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
