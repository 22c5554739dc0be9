/* coupler_scene.c - all objects of a scene from the options database: what the scene does not name is not made. */
#include "coupler_impl.h"

static PetscBool HasName(const Names *names, const char name[])
{
  PetscBool same = PETSC_FALSE;

  for (PetscInt k = 0; k < names->n && !same; k++) (void)PetscStrcmp(names->name[k], name, &same);
  return same;
}

static PetscErrorCode ReadDomain(DomainParams *domain, PetscBool *present)
{
  PetscFunctionBegin;
  PetscCall(KeysSetDefaults(DomainKeys, domain));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-domain_min", present));
  if (!*present) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KeysSetFromOptions(DomainKeys, "domain_", domain));
  for (int k = 0; k < 3; k++) {
    static const char axis[] = "xyz";
    const char        low[] = {axis[k], 'm', 'i', 'n', 0}, high[] = {axis[k], 'm', 'a', 'x', 0}, name[] = {axis[k], 0};

    if (!(domain->max[k] > domain->min[k])) {
      InputError("domain.max", "is not above domain.min in %s\n%s runs from %g to %g m", name, name, (double)domain->min[k],
                 (double)domain->max[k]);
    }
    if (HasName(&domain->periodic, name) && (HasName(&domain->walls, low) || HasName(&domain->walls, high))) {
      InputError("domain.periodic", "%s cannot be periodic and have a wall (domain.walls has %s or %s)", name, low, high);
    }
  }
  PetscFunctionReturn(InputErrorCount() ? BY_ERR_INPUT : PETSC_SUCCESS);
}

static unsigned WallMask(const DomainParams *domain)
{
  static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  unsigned                 mask    = 0;

  for (int k = 0; k < 6; k++) mask |= (unsigned)HasName(&domain->walls, sides[k]) << k;
  return mask;
}

static unsigned PeriodicMask(const DomainParams *domain)
{
  static const char *const axes[] = {"x", "y", "z"};
  unsigned                 mask   = 0;

  for (int k = 0; k < 3; k++) mask |= (unsigned)HasName(&domain->periodic, axes[k]) << k;
  return mask;
}

/* a body must lie in the domain: not beyond a wall, and not altogether outside an open side */
static PetscErrorCode CheckInside(const char key[], const DomainParams *domain, PetscReal spacing, PetscInt n, const PetscReal x[])
{
  static const char axis[] = "xyz";
  const unsigned    walls  = WallMask(domain);

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscReal low = PETSC_MAX_REAL, high = PETSC_MIN_REAL;

    for (PetscInt a = 0; a < n; a++) {
      low  = PetscMin(low, x[3 * a + k]);
      high = PetscMax(high, x[3 * a + k]);
    }
    const PetscReal below = domain->min[k] - low, above = high - domain->max[k], slack = 0.01 * spacing;
    const PetscBool outside = (PetscBool)(high < domain->min[k] || low > domain->max[k]);

    if (outside || (below > slack && (walls >> (2 * k) & 1)) || (above > slack && (walls >> (2 * k + 1) & 1))) {
      PetscFunctionReturn(InputError(key, "lies outside the domain: %c from %g to %g m, the domain has %g to %g m\n"
                                     "move it with `translate` or enlarge the domain", axis[k], (double)low, (double)high,
                                     (double)domain->min[k], (double)domain->max[k]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces of the fluid and the changing substep feed the highest modes of the mesh, which no substep resolves; without any damping they
   grow until elements break. A body in water that names no stiffness damping gets a twentieth of the critical step: a twentieth of
   critical damping for the highest mode (explicit codes' linear bulk viscosity), falling with the frequency, so that the modes
   that one sees have next to none. */
static PetscErrorCode DampMesh(TLED tled, const char name[])
{
  TLEDParams *params;
  PetscReal   critical;
  PetscBool   named;
  char        option[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_stiffness_damping", name));
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &named));
  if (named) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TLEDGetParams(tled, &params));
  ByCall(TLEDGetCriticalStep(tled, &critical));
  if (critical < PETSC_MAX_REAL) params->stiffness_damping = 0.05 * critical;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadObstacle(const char name[], Surface *surface, PetscBool *slip)
{
  ObstacleParams params;
  char           prefix[2 * BY_NAME_MAX], key[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", name));
  PetscCall(KeysSetDefaults(ObstacleKeys, &params));
  PetscCall(KeysSetFromOptions(ObstacleKeys, prefix, &params));
  if (slip) *slip = params.slip;
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.surface", name));
  ByCall(SurfaceRead(key, params.surface, params.scale, params.translate, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* words of a list for a message */
static const char *Words(const Names *names, char text[], size_t n)
{
  size_t used = 0;

  snprintf(text, n, "none");
  for (PetscInt k = 0; k < names->n && used < n; k++) used += (size_t)snprintf(text + used, n - used, "%s%s", k ? ", " : "", names->name[k]);
  return text;
}

/* the walls and obstacles that a body's key `contact` names */
static PetscErrorCode AddContacts(TLED tled, const char name[], const DomainParams *domain)
{
  static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  TLEDParams              *params;
  TopParams                top;
  char                     key[2 * BY_NAME_MAX], walls[512], obstacles[512];

  PetscFunctionBegin;
  PetscCall(TLEDGetParams(tled, &params));
  PetscCall(KeysSetDefaults(TopKeys, &top));
  PetscCall(KeysSetFromOptions(TopKeys, "", &top));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.contact", name));
  for (PetscInt i = 0; i < params->contact.n; i++) {
    const char *with = params->contact.name[i];

    ByCall(CouplerRefuseMoving(key, with, domain));
    if (HasName(&top.obstacles, with)) {
      Surface surface;

      ByCall(ReadObstacle(with, &surface, NULL));
      PetscCall(TLEDAddContactSurface(tled, with, &surface));
      PetscCall(SurfaceDestroy(&surface));
    } else if (HasName(&domain->walls, with)) {
      for (int k = 0; k < 6; k++) {
        PetscBool       same;
        const PetscReal normal[3] = {k / 2 == 0 ? 1.0 - k % 2 * 2.0 : 0.0, k / 2 == 1 ? 1.0 - k % 2 * 2.0 : 0.0, k / 2 == 2 ? 1.0 - k % 2 * 2.0 : 0.0};

        PetscCall(PetscStrcmp(with, sides[k], &same));
        if (same) PetscCall(TLEDAddContactPlane(tled, with, k % 2 ? domain->max : domain->min, normal));
      }
    } else
      PetscFunctionReturn(InputError(key, "has %s, which is neither a wall of the domain nor an obstacle\nwalls (domain.walls): %s; obstacles: %s",
                                     with, Words(&domain->walls, walls, sizeof(walls)), Words(&top.obstacles, obstacles, sizeof(obstacles))));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the proxies of a surface, whose keys have the prefix <name>_proxy_ */
static PetscErrorCode SetUpProxy(Coupler c, Proxy proxy, const char name[], PetscInt n_nodes, const PetscReal x[], PetscInt n_triangles,
                                 const PetscInt triangles[])
{
  char prefix[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_proxy_", name));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)proxy, prefix));
  PetscCall(ProxySetSurface(proxy, n_nodes, x, n_triangles, triangles));
  PetscCall(ProxySetFluid(proxy, c->sph));
  PetscCall(ProxySetFromOptions(proxy));
  ByCall(ProxySetUp(proxy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUpBody(Coupler c, const char name[], const DomainParams *domain, TLED tled, Proxy *proxy)
{
  PetscInt         n_nodes, n_triangles;
  const PetscInt  *triangles;
  const PetscReal *X;
  SPHParams       *fluid;
  char             prefix[2 * BY_NAME_MAX], key[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", name));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)tled, prefix));
  ByCall(TLEDSetFromOptions(tled));
  PetscCall(TLEDSetGravity(tled, c->gravity));
  ByCall(AddContacts(tled, name, domain));
  ByCall(TLEDSetUp(tled));
  if (!c->sph) PetscFunctionReturn(PETSC_SUCCESS);
  ByCall(DampMesh(tled, name));
  PetscCall(TLEDGetSize(tled, &n_nodes, NULL));
  PetscCall(TLEDGetMesh(tled, NULL, NULL, &X));
  PetscCall(TLEDGetSurface(tled, PETSC_TRUE, &n_triangles, &triangles));
  PetscCall(SPHGetParams(c->sph, &fluid));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.mesh", name));
  ByCall(CheckInside(key, domain, fluid->spacing, n_nodes, X));
  PetscCall(ProxyCreate(PETSC_COMM_SELF, name, proxy));
  ByCall(SetUpProxy(c, *proxy, name, n_nodes, X, n_triangles, triangles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildBody(Coupler c, const char name[], const DomainParams *domain)
{
  TLED           tled;
  Proxy          proxy = NULL;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(TLEDCreate(PETSC_COMM_SELF, name, &tled));
  ierr = SetUpBody(c, name, domain, tled, &proxy);
  if (!ierr) PetscCall(CouplerAddBody(c, name, tled, proxy)); /* the coupler has them from here */
  else {
    PetscCall(ProxyDestroy(&proxy));
    PetscCall(TLEDDestroy(&tled));
  }
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Triangles of an obstacle that water can reach: without those that lie in a wall. Where a body stands on a wall both meet at an edge that is not
   there for the water; with proxies on the hidden face the body would be lifted off by half the weight of the water on it. */
static PetscErrorCode WetTriangles(const char name[], const Surface *surface, const DomainParams *domain, PetscReal spacing, PetscInt *n, PetscInt wet[])
{
  unsigned walls;

  PetscFunctionBegin;
  PetscCall(CouplerSealedWalls(name, domain, &walls));
  *n = 0;
  for (PetscInt t = 0; t < surface->n_triangles; t++) {
    const PetscInt *v      = surface->triangles + 3 * t;
    PetscBool       hidden = PETSC_FALSE;

    for (int k = 0; k < 6; k++) {
      const PetscReal at = k % 2 ? domain->max[k / 2] : domain->min[k / 2];
      PetscReal       off = 0.0;

      for (int a = 0; a < 3; a++) off = PetscMax(off, PetscAbsReal(surface->x[3 * v[a] + k / 2] - at));
      if ((walls >> k & 1) && off <= 0.01 * spacing) hidden = PETSC_TRUE;
    }
    if (hidden) continue;
    for (int a = 0; a < 3; a++) wet[3 * *n + a] = v[a];
    (*n)++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildObstacle(Coupler c, const char name[], const DomainParams *domain)
{
  Surface        surface;
  Proxy          proxy = NULL;
  SPHParams     *fluid;
  PetscBool      slip;
  PetscInt       n_wet = 0, *wet;
  char           key[2 * BY_NAME_MAX];
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ByCall(ReadObstacle(name, &surface, &slip));
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s.surface", name));
  PetscCall(SPHGetParams(c->sph, &fluid));
  ierr = CheckInside(key, domain, fluid->spacing, surface.n_nodes, surface.x);
  if (!ierr) {
    PetscCall(ProxyCreate(PETSC_COMM_SELF, name, &proxy));
    PetscCall(PetscMalloc1(3 * surface.n_triangles, &wet));
    PetscCall(WetTriangles(name, &surface, domain, fluid->spacing, &n_wet, wet));
    ierr = SetUpProxy(c, proxy, name, surface.n_nodes, surface.x, n_wet, wet);
    PetscCall(PetscFree(wet));
  }
  if (!ierr) PetscCall(CouplerAddObstacle(c, name, proxy, surface.n_nodes, surface.x, surface.n_triangles, surface.triangles));
  else PetscCall(ProxyDestroy(&proxy));
  PetscCall(SurfaceDestroy(&surface));
  ByCall(ierr);
  ByCall(CouplerReadObstacleMotion(c, c->n_surfaces - 1, slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* without a fluid an obstacle is there for the bodies that name it */
static PetscErrorCode CheckObstacles(const TopParams *top)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < top->obstacles.n; k++) {
    PetscBool used = PETSC_FALSE;

    for (PetscInt b = 0; b < top->bodies.n; b++) {
      TLEDParams body;
      char       prefix[2 * BY_NAME_MAX];

      PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", top->bodies.name[b]));
      PetscCall(KeysSetDefaults(TLEDKeys, &body));
      PetscCall(KeysSetFromOptions(TLEDKeys, prefix, &body));
      used = (PetscBool)(used || HasName(&body.contact, top->obstacles.name[k]));
    }
    if (!used)
      PetscFunctionReturn(InputError("obstacles", "has %s, on which nothing acts: the scene has no fluid, and no body has it in `contact`\n"
                                     "add a section `sph:`, or %s to a body's `contact`", top->obstacles.name[k], top->obstacles.name[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the probes that a body alone has: its displacement and velocity */
static PetscErrorCode BodyProbes(Coupler c, const Names *all, Names *probes)
{
  PetscFunctionBegin;
  probes->n = 0;
  for (PetscInt k = 0; k < all->n; k++) {
    ProbeParams params;
    char        prefix[2 * BY_NAME_MAX];
    PetscBool   same = PETSC_FALSE;

    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", all->name[k]));
    PetscCall(KeysSetDefaults(ProbeKeys, &params));
    PetscCall(KeysSetFromOptions(ProbeKeys, prefix, &params));
    for (PetscInt b = 0; b < c->n_bodies && !same; b++) PetscCall(PetscStrcmp(c->surface[b].name, params.body, &same));
    if (!same || (params.quantity != PROBE_DISPLACEMENT && params.quantity != PROBE_VELOCITY)) continue;
    PetscCall(PetscStrncpy(probes->name[probes->n++], all->name[k], BY_NAME_MAX));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerSetBodiesFromOptions - build the bodies of the scene in the options database, dry, and the probes on them

  Collective

  Input Parameter:
. coupler - a new coupler

  Errors:
  BY_ERR_INPUT when a body cannot be built, or there is none; each is reported

.seealso: CouplerSetFromOptions(), CouplerVerify()
@*/
PetscErrorCode CouplerSetBodiesFromOptions(Coupler c)
{
  TopParams    top;
  DomainParams domain;
  Names        probes;
  PetscBool    has_domain;

  PetscFunctionBegin;
  PetscCall(KeysSetDefaults(TopKeys, &top));
  PetscCall(KeysSetFromOptions(TopKeys, "", &top));
  PetscCall(PetscArraycpy(c->gravity, top.gravity, 3));
  ByCall(ReadDomain(&domain, &has_domain));
  if (!top.bodies.n) PetscFunctionReturn(InputError("bodies", "the scene has no body\nname one: `bodies: [name]`, and give it a section"));
  for (PetscInt k = 0; k < top.bodies.n; k++) {
    const PetscErrorCode ierr = BuildBody(c, top.bodies.name[k], &domain);
    if (ierr != BY_ERR_INPUT) PetscCall(ierr); /* go on, so that every bad body is reported */
  }
  if (InputErrorCount()) PetscFunctionReturn(BY_ERR_INPUT);
  PetscCall(BodyProbes(c, &top.probes, &probes));
  ByCall(CouplerAddProbes(c, &probes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CouplerSetFromOptions - build fluid, bodies, obstacles and probes of the scene in the options database

  Collective

  Input Parameter:
. coupler - a new coupler

  Errors:
  BY_ERR_INPUT when the scene cannot be built (mesh, groups, no fluid, a body outside the domain); each is reported

.seealso: SceneRead(), CouplerSetUp()
@*/
PetscErrorCode CouplerSetFromOptions(Coupler c)
{
  TopParams    top;
  DomainParams domain;
  PetscBool    has_domain, has_fluid;

  PetscFunctionBegin;
  PetscCall(KeysSetFromOptions(CouplerKeys, "coupler_", &c->params));
  PetscCall(KeysSetDefaults(TopKeys, &top));
  PetscCall(KeysSetFromOptions(TopKeys, "", &top));
  PetscCall(PetscArraycpy(c->gravity, top.gravity, 3));
  ByCall(ReadDomain(&domain, &has_domain));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-sph_spacing", &has_fluid));
  if (has_fluid && !has_domain) PetscFunctionReturn(InputError("sph.spacing", "a fluid needs a domain\nadd a section `domain: {min: ..., max: ...}`"));
  if (!has_fluid) ByCall(CheckObstacles(&top));
  if (!has_fluid && !top.bodies.n) PetscFunctionReturn(InputError("bodies", "the scene has neither a fluid (section `sph:`) nor a body (`bodies: [name]`)"));
  if (has_fluid) {
    PetscCall(SPHCreate(PETSC_COMM_SELF, &c->sph));
    PetscCall(SPHSetFromOptions(c->sph));
    PetscCall(SPHSetDomain(c->sph, domain.min, domain.max, WallMask(&domain), PeriodicMask(&domain)));
    PetscCall(SPHSetGravity(c->sph, c->gravity));
  }
  for (PetscInt k = 0; k < top.bodies.n; k++) {
    const PetscErrorCode ierr = BuildBody(c, top.bodies.name[k], &domain);
    if (ierr != BY_ERR_INPUT) PetscCall(ierr); /* go on, so that every bad body is reported */
  }
  for (PetscInt k = 0; k < top.obstacles.n && has_fluid; k++) {
    const PetscErrorCode ierr = BuildObstacle(c, top.obstacles.name[k], &domain);
    if (ierr != BY_ERR_INPUT) PetscCall(ierr);
  }
  if (has_fluid) ByCall(CouplerMoveDomain(c, &domain));
  if (InputErrorCount()) PetscFunctionReturn(BY_ERR_INPUT);
  if (has_fluid) PetscCall(CouplerAddNeighbours(c));
  if (has_fluid) ByCall(CouplerBuildFluid(c, &domain));
  ByCall(CouplerAddProbes(c, &top.probes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
