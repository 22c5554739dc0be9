/* floor.h - surfaces that touch the fluid, given as src/proxy gives them: a floor of a few proxies that is the plane exactly. */
#ifndef BY_TEST_FLOOR_H
#define BY_TEST_FLOOR_H

#include "fluid.h"

#include "sph/sph_impl.h"

#define N_MAX 512

typedef struct {
  SPHContacts contacts;
  PetscInt    particle[N_MAX], start[N_MAX + 1], proxy[2 * N_MAX];
  PetscReal   position[3 * N_MAX], phi[N_MAX], grad[3 * N_MAX], share[6 * N_MAX], velocity[12], force[12];
} Floor;

/* contacts of the plane x_axis = 0 as a surface of four proxies; a pair of proxies shares each particle 0.3 : 0.7 */
static inline void Touch(SPH sph, int axis, Floor *f)
{
  PetscInt m = 0;

  f->start[0] = 0;
  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal d = sph->x[3 * i + axis];

    if (d >= sph->h) continue;
    f->particle[m] = i;
    f->phi[m]      = sph->wall_factor * SPHHalfSpace(sph->params.kernel, d, sph->h);
    for (int k = 0; k < 3; k++) {
      f->position[3 * m + k]  = sph->x[3 * i + k];
      f->grad[3 * m + k]      = k == axis ? sph->wall_factor * SPHHalfSpaceSlope(sph->gradient_kernel, d, sph->h) : 0.0;
      f->share[6 * m + k]     = 0.3 * f->grad[3 * m + k];
      f->share[6 * m + 3 + k] = 0.7 * f->grad[3 * m + k];
    }
    f->proxy[2 * m]     = sph->id[i] % 4;
    f->proxy[2 * m + 1] = (sph->id[i] + 1) % 4;
    m++;
    f->start[m] = 2 * m;
  }
  f->contacts           = (SPHContacts){0};
  f->contacts.n_touched = m;
  f->contacts.particle  = f->particle;
  f->contacts.position  = f->position;
  f->contacts.phi       = f->phi;
  f->contacts.grad      = f->grad;
  f->contacts.start     = f->start;
  f->contacts.proxy     = f->proxy;
  f->contacts.share     = f->share;
  f->contacts.n_proxies = 4;
  f->contacts.velocity  = f->velocity;
  f->contacts.force     = f->force;
  for (int k = 0; k < 12; k++) f->velocity[k] = 0.0;
}

#endif
