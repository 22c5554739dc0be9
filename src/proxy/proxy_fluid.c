/* proxy_fluid.c - the one place where proxies meet the fluid object. */
#include "proxy/proxy_impl.h"

PetscErrorCode ProxySetFluidScale(Proxy proxy, const ProxyFluid *fluid)
{
  PetscFunctionBegin;
  PetscCheck(!proxy->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "set the fluid before ProxySetUp()");
  proxy->fluid     = *fluid;
  proxy->has_fluid = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxySetFluid - tell the proxies of the fluid: support radius, spacing, kernel, periodic box; its particles are what ProxyGetContacts() asks for

  Input Parameters:
+ proxy - the proxies, before ProxySetUp()
- sph   - the fluid, parameters and domain set; borrowed, must outlive the proxies
@*/
PetscErrorCode ProxySetFluid(Proxy proxy, SPH sph)
{
  ProxyFluid fluid;
  SPHParams *params;

  PetscFunctionBegin;
  PetscCall(SPHGetParams(sph, &params));
  fluid.h      = params->support*params->spacing;
  fluid.dx     = params->spacing;
  fluid.kernel = params->kernel;
  fluid.gradient_kernel = SPHGradientKernel(params);
  PetscCall(SPHGetDomain(sph, fluid.min, fluid.max, &fluid.walls, &fluid.periodic));
  for (int k = 0; k < 6; k++) fluid.plane[k] = k % 2 ? fluid.max[k/2] : fluid.min[k/2];
  PetscCall(ProxySetFluidScale(proxy, &fluid));
  proxy->sph = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ProxyGetContacts - which particles of the fluid touch the surface, and how (method 4.3, 4.4)

  Input Parameter:
. proxy - the proxies, set up; the fluid's neighbours are current

  Output Parameter:
. contacts - see SPHContacts; arrays belong to the proxy and last until its next call. `position` is the periodic image near the proxy
  with the largest part of the particle.

  Notes:
  A body that reaches through a whole period meets its own image: both act on a particle as one surface.
@*/
PetscErrorCode ProxyGetContacts(Proxy proxy, SPHContacts *contacts)
{
  const PetscReal *x;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCheck(proxy->sph && proxy->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetFluid() and ProxySetUp() first");
  PetscCall(SPHGetSize(proxy->sph, &n));
  PetscCall(SPHGetState(proxy->sph, &x, NULL, NULL, NULL, NULL));
  PetscCall(ProxyFindContacts(proxy, n, x, contacts));
  PetscFunctionReturn(PETSC_SUCCESS);
}
