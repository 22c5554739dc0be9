/* coupler_fields.c - what the water does to a surface, as fields of its proxies and nodes (method 4.3, [Yuan] eq. 31). */
#include "coupler_fields.h"
#include "sph/sph_kernel.h"

/* what a proxy sees: sums of V W, and of that times pressure and velocity; of |share| p, and of its part along the normal */
enum { SEEN, SEEN_PRESSURE, SEEN_VELOCITY, PUSH = SEEN_VELOCITY + 3, PUSH_NORMAL, N_SEEN };

/* A sparse proxy takes forces from around it whose directions differ on a curved surface: their sum is smaller than the pressure times its area by
   the mean cosine to its normal (0.9 on a ball of 5 dx with 49 proxies), which `pressure` makes good, but not for more than this */
#define LEAST_COSINE 0.5

/* Sums over the particles that touch each proxy. W is the fluid's kernel at the distance of the particle's image from the proxy, at the start of
   the step. */
static PetscErrorCode SumWater(Coupler c, const SPHContacts *contacts, const PetscReal x[], const PetscReal normal[], PetscReal sum[])
{
  const PetscReal *v, *p, volume = c->mass / c->rest_density;
  SPHParams       *params;
  PetscReal        h;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(c->sph, &params));
  PetscCall(SPHGetSupport(c->sph, &h));
  PetscCall(SPHGetState(c->sph, NULL, &v, &p, NULL, NULL));
  for (PetscInt t = 0; t < contacts->n_touched; t++) {
    const PetscInt i = contacts->particle[t];

    for (PetscInt k = contacts->start[t]; k < contacts->start[t + 1]; k++) {
      PetscReal *s = &sum[N_SEEN * contacts->proxy[k]];
      double     r[3];

      Sub3(&contacts->position[3 * t], &x[3 * contacts->proxy[k]], r);
      const PetscReal part = volume * SPHKernelW(params->kernel, Norm3(r), h);
      s[SEEN] += part;
      s[SEEN_PRESSURE] += part * p[i];
      for (int d = 0; d < 3; d++) s[SEEN_VELOCITY + d] += part * v[3 * i + d];
      s[PUSH] += PetscAbsReal(p[i]) * Norm3(&contacts->share[3 * k]);
      s[PUSH_NORMAL] -= PetscAbsReal(p[i]) * Dot3(&contacts->share[3 * k], &normal[3 * contacts->proxy[k]]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fields of the proxies; 0 where they see nothing */
static PetscErrorCode AtProxies(Coupler c, PetscInt k, CouplerFields *fields)
{
  CouplerSurface  *s = &c->surface[k];
  const PetscReal *x, *normal, *area;
  PetscReal       *sum;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(ProxyGetPoints(s->proxy, &n, &x, &normal, NULL, &area));
  PetscCall(PetscCalloc1(N_SEEN * n, &sum));
  PetscCall(SumWater(c, &c->contacts[k], x, normal, sum));
  for (PetscInt b = 0; b < n; b++) {
    const PetscReal *seen = &sum[N_SEEN * b];

    const PetscReal  cosine = seen[PUSH] > 0.0 ? PetscMax(LEAST_COSINE, seen[PUSH_NORMAL] / seen[PUSH]) : 1.0;

    if (c->step > 0 && area[b] > 0.0) fields->pressure[b] = -Dot3(&s->proxy_force[3 * b], &normal[3 * b]) / (cosine * area[b]);
    fields->water[b] = 2.0 * seen[SEEN];
    if (!(seen[SEEN] > 0.0)) continue;
    fields->water_pressure[b] = seen[SEEN_PRESSURE] / seen[SEEN];
    for (int d = 0; d < 3; d++) fields->water_velocity[3 * b + d] = seen[SEEN_VELOCITY + d] / seen[SEEN];
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the same at the nodes; the water's own values count where there is water */
static PetscErrorCode AtNodes(Proxy proxy, PetscInt n_nodes, const CouplerFields *from, CouplerFields *fields)
{
  const PetscReal *area;
  PetscReal       *value, *weight, *node;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(ProxyGetPoints(proxy, &n, NULL, NULL, NULL, &area));
  PetscCall(PetscMalloc3(4 * n, &value, n, &weight, 4 * n_nodes, &node));
  PetscCall(ProxyToNodes(proxy, 1, from->pressure, NULL, fields->pressure));
  PetscCall(ProxyToNodes(proxy, 1, from->water, NULL, fields->water));
  for (PetscInt b = 0; b < n; b++) {
    weight[b]    = area[b] * from->water[b];
    value[4 * b] = from->water_pressure[b];
    PetscCall(PetscArraycpy(&value[4 * b + 1], &from->water_velocity[3 * b], 3));
  }
  PetscCall(ProxyToNodes(proxy, 4, value, weight, node));
  for (PetscInt a = 0; a < n_nodes; a++) {
    fields->water_pressure[a] = node[4 * a];
    PetscCall(PetscArraycpy(&fields->water_velocity[3 * a], &node[4 * a + 1], 3));
  }
  PetscCall(PetscFree3(value, weight, node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Allocate(PetscInt n, CouplerFields *fields)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc4(n, &fields->pressure, n, &fields->water, n, &fields->water_pressure, 3 * n, &fields->water_velocity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerFieldsCreate - fields of the water on body or obstacle k, at its proxies and at its nodes, of the last step

  Input Parameters:
+ coupler - after a step, or set up with its first contacts
- k       - body or, counting on, obstacle, with proxies

  Output Parameters:
+ proxies - at its proxies
- nodes   - at its nodes; zero at nodes that are not wetted

  Notes:
  `pressure` is the force of the fluid's pressure along the outward normals, over area: what loads the surface, and what a gauge `pressure` on the
  body measures. `water_pressure` and `water_velocity` are Shepard means over the particles within h in front of the surface, sum V A W / sum V W. In
  still water particles of the first layer carry 1.9 times the hydrostatic pressure and those of the second less (method 2), which weighs on the second mean but not
  on the first. `water` is the part of the kernel in front of the surface that particles fill: about 1 under water, 0 where nothing is within h;
  there all fields are 0. Of viscous forces `pressure` has the normal part. Before the first step there is no force, and `pressure` is 0. Nodes get
  what fits the proxies around them (ProxyToNodes()).

.seealso: CouplerFieldsDestroy(), ProxyToNodes()
@*/
PetscErrorCode CouplerFieldsCreate(Coupler c, PetscInt k, CouplerFields *proxies, CouplerFields *nodes)
{
  CouplerSurface *s = &c->surface[k];
  PetscInt        n;

  PetscFunctionBegin;
  PetscCall(ProxyGetPoints(s->proxy, &n, NULL, NULL, NULL, NULL));
  PetscCall(Allocate(n, proxies));
  PetscCall(Allocate(s->n_nodes, nodes));
  PetscCall(AtProxies(c, k, proxies));
  PetscCall(AtNodes(s->proxy, s->n_nodes, proxies, nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerFieldsDestroy(CouplerFields *fields)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(fields->pressure, fields->water, fields->water_pressure, fields->water_velocity));
  PetscFunctionReturn(PETSC_SUCCESS);
}
