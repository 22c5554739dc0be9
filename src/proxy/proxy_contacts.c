/* proxy_contacts.c - which particles touch the surface, and how: cells over the supports of the proxies, then one gather per
   particle. Chunks of particles are fixed, so the result does not depend on the number of threads. */
#include "proxy/proxy_impl.h"
#include "proxy/proxy_combine.h"

#define CHUNK 1024 /* particles per result buffer */

/* results of one chunk of particles; plain malloc because it grows inside a parallel region */
typedef struct {
  PetscInt   n_touched, n_pairs, touched_capacity, pair_capacity;
  PetscInt  *particle, *n_of, *proxy; /* by touched particle, number of its pairs; by pair */
  PetscReal *value, *share;           /* position, phi, grad (7) by touched; 3 by pair     */
} Chunk;

/* one pair at the particle at hand */
typedef struct {
  PetscInt  proxy;
  int       slot, image;
  ProxyPair pair;
  double    exposed, grad_exposed[3]; /* when some lie on walls */
} Touch;

static int ChunkReserve(Chunk *c, PetscInt n_pairs)
{
  if (c->n_touched == c->touched_capacity) {
    c->touched_capacity = c->touched_capacity ? 2*c->touched_capacity : 128;
    c->particle = (PetscInt *)realloc(c->particle, sizeof(PetscInt)*(size_t)c->touched_capacity);
    c->n_of     = (PetscInt *)realloc(c->n_of, sizeof(PetscInt)*(size_t)c->touched_capacity);
    c->value    = (PetscReal *)realloc(c->value, 7*sizeof(PetscReal)*(size_t)c->touched_capacity);
  }
  if (c->n_pairs + n_pairs > c->pair_capacity) {
    c->pair_capacity = 2*(c->pair_capacity + n_pairs);
    c->proxy = (PetscInt *)realloc(c->proxy, sizeof(PetscInt)*(size_t)c->pair_capacity);
    c->share = (PetscReal *)realloc(c->share, 3*sizeof(PetscReal)*(size_t)c->pair_capacity);
  }
  return c->particle && c->n_of && c->value && (!c->pair_capacity || (c->proxy && c->share));
}

PetscErrorCode ProxyContactsDestroy(Proxy proxy)
{
  Chunk *chunks = (Chunk *)proxy->chunks;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < proxy->n_chunks; i++) {
    free(chunks[i].particle);
    free(chunks[i].n_of);
    free(chunks[i].proxy);
    free(chunks[i].value);
    free(chunks[i].share);
  }
  free(chunks);
  proxy->chunks = NULL;
  PetscCall(PetscFree(proxy->cells.start));
  PetscCall(PetscFree(proxy->cells.entry));
  PetscCall(PetscFree5(proxy->contacts.particle, proxy->contacts.position, proxy->contacts.phi, proxy->contacts.grad, proxy->contacts.start));
  PetscCall(PetscFree2(proxy->contacts.proxy, proxy->contacts.share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* shift that brings the surface's first node into the periodic box: images are counted from there */
static void BaseShift(const Proxy p, double base[3])
{
  for (int k = 0; k < 3; k++) {
    const double L = ProxyPeriod(&p->fluid, k);
    base[k] = L > 0.0 ? -L*floor((p->geometry.x[3*p->surface.triangles[0] + k] - p->fluid.min[k])/L) : 0.0;
  }
}
static inline void ImageShift(const ProxyFluid *fluid, const double base[3], int image, double shift[3])
{
  if (!fluid->periodic) {
    shift[0] = shift[1] = shift[2] = 0.0;
    return;
  }
  shift[0] = base[0] + (image%3 - 1)*ProxyPeriod(fluid, 0);
  shift[1] = base[1] + (image/3%3 - 1)*ProxyPeriod(fluid, 1);
  shift[2] = base[2] + (image/9 - 1)*ProxyPeriod(fluid, 2);
}

static void SetReach(const ProxyPoint *b, double half, double radius, ProxyReach *reach)
{
  for (int k = 0; k < 3; k++) reach->x[k] = b->x[k], reach->n[k] = b->n[k];
  reach->radius2 = radius*radius*(1.0 + 1e-12);
  reach->half    = half;
}

/* range of cells of one image of a support; empty: 0 */
static int CellRange(const ProxyCells *c, const double n[3], const double middle[3], double half, double radius, PetscInt lo[3], PetscInt hi[3])
{
  for (int k = 0; k < 3; k++) {
    const double e = fabs(n[k])*half + sqrt(PetscMax(0.0, 1.0 - n[k]*n[k]))*radius;
    const double a = floor((middle[k] - e - c->lo[k])/c->cell), b = floor((middle[k] + e - c->lo[k])/c->cell);
    if (b < 0.0 || a >= c->dims[k]) return 0;
    lo[k] = (PetscInt)PetscMax(0.0, a);
    hi[k] = (PetscInt)PetscMin(c->dims[k] - 1.0, b);
  }
  return 1;
}

/* Box of all supports, inside the domain along periodic axes, in cells of h (larger when there would be more than four million). */
static void SizeCells(const Proxy p, ProxyCells *c)
{
  double hi[3], n_cells;

  for (int k = 0; k < 3; k++) c->lo[k] = PETSC_MAX_REAL, hi[k] = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < p->n; i++) {
    double half, radius;
    ProxySupport(p, &p->points[i], &half, &radius);
    SetReach(&p->points[i], half, radius, &p->reach[i]);
    for (int k = 0; k < 3; k++) {
      const double n = p->points[i].n[k], e = fabs(n)*half + sqrt(PetscMax(0.0, 1.0 - n*n))*radius;
      c->lo[k] = PetscMin(c->lo[k], p->points[i].x[k] - e);
      hi[k]    = PetscMax(hi[k], p->points[i].x[k] + e);
    }
  }
  for (int k = 0; k < 3; k++) {
    if (ProxyPeriod(&p->fluid, k) > 0.0) c->lo[k] = p->fluid.min[k], hi[k] = p->fluid.max[k];
  }
  c->cell = p->fluid.h/1.26;
  do {
    c->cell *= 1.26;
    n_cells = 1.0;
    for (int k = 0; k < 3; k++) n_cells *= floor((hi[k] - c->lo[k])/c->cell) + 1.0;
  } while (n_cells > 4e6);
  for (int k = 0; k < 3; k++) c->dims[k] = (PetscInt)floor((hi[k] - c->lo[k])/c->cell) + 1;
}

/* visit the cells of every image of every support: count them (entry NULL), or write them at start[cell + 1]++ */
static void VisitCells(const Proxy p, ProxyCells *c, PetscInt *entry)
{
  double base[3];

  BaseShift(p, base);
  for (PetscInt i = 0; i < p->n; i++) {
    const double *n = p->points[i].n, corner = 0.5*sqrt(3.0)*c->cell;
    double        half, radius;
    ProxySupport(p, &p->points[i], &half, &radius);
    for (int image = 0; image < 27; image++) {
      double   shift[3], at[3];
      PetscInt lo[3], hi[3];
      int      skip = 0;
      for (int k = 0, m = image; k < 3; k++, m /= 3) skip |= m%3 != 1 && ProxyPeriod(&p->fluid, k) == 0.0;
      if (skip) continue;
      ImageShift(&p->fluid, base, image, shift);
      for (int k = 0; k < 3; k++) at[k] = p->points[i].x[k] + shift[k];
      if (!CellRange(c, n, at, half, radius, lo, hi)) continue;
      for (PetscInt z = lo[2]; z <= hi[2]; z++) {
        for (PetscInt y = lo[1]; y <= hi[1]; y++) {
          for (PetscInt x = lo[0]; x <= hi[0]; x++) {
            const PetscInt cell = (z*c->dims[1] + y)*c->dims[0] + x;
            const double   r[3] = {c->lo[0] + (x + 0.5)*c->cell - at[0], c->lo[1] + (y + 0.5)*c->cell - at[1], c->lo[2] + (z + 0.5)*c->cell - at[2]};
            const double   up = Dot3(n, r), t2 = Dot3(r, r) - up*up;
            if (fabs(up) > half + corner || t2 > (radius + corner)*(radius + corner)) continue;
            if (entry) entry[c->start[cell + 1]++] = 27*i + image;
            else c->start[cell + 2]++;
          }
        }
      }
    }
  }
}

static PetscErrorCode BuildCells(Proxy p)
{
  ProxyCells *c = &p->cells;
  size_t      n_cells, n_entries;

  PetscFunctionBegin;
  SizeCells(p, c);
  n_cells = (size_t)c->dims[0]*(size_t)c->dims[1]*(size_t)c->dims[2];
  if (n_cells + 2 > c->n_start) {
    PetscCall(PetscFree(c->start));
    c->n_start = n_cells + n_cells/2 + 2;
    PetscCall(PetscMalloc1(c->n_start, &c->start));
  }
  PetscCall(PetscArrayzero(c->start, n_cells + 2));
  VisitCells(p, c, NULL);
  for (size_t i = 0; i < n_cells; i++) c->start[i + 2] += c->start[i + 1];
  n_entries = (size_t)c->start[n_cells + 1];
  if (n_entries > c->n_entry) {
    PetscCall(PetscFree(c->entry));
    c->n_entry = n_entries + n_entries/2;
    PetscCall(PetscMalloc1(c->n_entry, &c->entry));
  }
  VisitCells(p, c, c->entry);
  c->longest = 0;
  for (size_t i = 0; i < n_cells; i++) c->longest = PetscMax(c->longest, c->start[i + 1] - c->start[i]);
  p->cells_valid = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shepard means of the pairs in one slot (method 4.4) */
static void PatchMeans(const Proxy p, const double x[3], const double base[3], const Touch touch[], int n, int slot, ProxyPatchValue *v)
{
  double D = 0.0, gD[3] = {0}, lambda = 0.0, z = 0.0, gl[3] = {0}, gz[3] = {0}, m[3] = {0}, gm[9] = {0}, f[3] = {0}, E = 0.0, gE[3] = {0};

  v->coverage = 0.0;
  for (int k = 0; k < 3; k++) v->grad_coverage[k] = 0.0;
  for (int i = 0; i < n; i++) {
    const ProxyPair  *q = &touch[i].pair;
    const ProxyPoint *b = &p->points[touch[i].proxy];
    double            shift[3];
    if (touch[i].slot != slot) continue;
    ImageShift(&p->fluid, base, touch[i].image, shift);
    D += q->w;
    lambda += q->w*q->lambda;
    z += q->w*q->z;
    if (p->hides) E += q->w*touch[i].exposed;
    v->coverage += q->cover;
    for (int k = 0; k < 3; k++) {
      gD[k] += q->grad_w[k];
      gl[k] += q->grad_w[k]*q->lambda + q->w*q->grad_lambda[k];
      gz[k] += q->grad_w[k]*q->z + q->w*q->grad_z[k];
      m[k] += q->w*b->n[k];
      for (int j = 0; j < 3; j++) gm[3*k + j] += b->n[k]*q->grad_w[j];
      if (p->hides) gE[k] += q->grad_w[k]*touch[i].exposed + q->w*touch[i].grad_exposed[k];
      f[k] += q->w*(p->centre[3*touch[i].proxy + k] + shift[k] - x[k]);
      v->grad_coverage[k] += q->grad_cover[k];
    }
  }
  v->lambda = lambda/D;
  v->z      = z/D;
  v->exposed = E/D;
  for (int k = 0; k < 3; k++) {
    v->grad_lambda[k] = (gl[k] - v->lambda*gD[k])/D;
    v->grad_z[k]      = (gz[k] - v->z*gD[k])/D;
    v->grad_exposed[k] = (gE[k] - v->exposed*gD[k])/D;
    v->n[k]           = m[k]/D;
    v->foot[k]        = f[k]/D;
    for (int j = 0; j < 3; j++) v->grad_n[3*k + j] = (gm[3*k + j] - v->n[k]*gD[j])/D;
  }
}

static inline int OutOfReach(const ProxyReach *reach, const double r[3])
{
  const double up = Dot3(reach->n, r);
  return Dot3(r, r) - up*up > reach->radius2 || fabs(up) > reach->half;
}

/* gather the pairs of a particle; returns their number, *n_slots patches among them, sums of weights by slot, whether the particle is
   clearly in front; 0 when nothing touches */
static int GatherHalfSpace(const Proxy p, const double x[3], const double base[3], PetscInt begin, PetscInt end, Touch touch[], int *n_slots,
                           PetscInt slots[PROXY_PATCHES], double D[PROXY_PATCHES], int *in_front)
{
  double z_min = PETSC_MAX_REAL, z_sum = 0.0, cover = 0.0;
  int    n = 0;

  *n_slots = 0;
  for (PetscInt e = begin; e < end; e++) {
    const PetscInt    i = p->cells.entry[e]/27;
    const ProxyPoint *b = &p->points[i];
    double            r[3], shift[3];
    int               slot = 0;
    ImageShift(&p->fluid, base, p->cells.entry[e]%27, shift);
    for (int k = 0; k < 3; k++) r[k] = x[k] - p->reach[i].x[k] - shift[k];
    if (OutOfReach(&p->reach[i], r)) continue;
    if (!ProxyPairHalfSpace(p->fluid.kernel, p->fluid.gradient_kernel, p->fluid.h, b, r, &touch[n].pair) || !(touch[n].pair.w > 0.0)) continue;
    const PetscInt patch = p->patch[i];
    while (slot < *n_slots && slots[slot] != patch) slot++;
    if (slot == PROXY_PATCHES) continue;
    if (slot == *n_slots) {
      slots[slot] = patch;
      D[slot]     = 0.0;
      (*n_slots)++;
    }
    D[slot] += touch[n].pair.w;
    z_min = PetscMin(z_min, touch[n].pair.z);
    z_sum += touch[n].pair.w*touch[n].pair.z;
    cover += touch[n].pair.cover;
    touch[n].slot  = slot;
    touch[n].proxy = i;
    touch[n].image = (int)(p->cells.entry[e]%27);
    n++;
  }
  *in_front = z_sum >= 0.0 && cover >= PROXY_MIN_COVERAGE;
  return z_min < p->fluid.h ? n : 0;
}

static void ExposeTouched(const Proxy p, const double x[3], const double base[3], Touch touch[], int n)
{
  ProxyFoot last;

  last.neighbour = -1;
  for (int i = 0; i < n; i++) {
    double shift[3], at[3];
    ImageShift(&p->fluid, base, touch[i].image, shift);
    for (int k = 0; k < 3; k++) at[k] = x[k] - shift[k];
    touch[i].exposed = ProxyExposureAt(p, touch[i].proxy, at, &last, touch[i].grad_exposed);
  }
}

/* Past the end of all that is in reach: phi fades to nothing. Sums of Shepard means would not: sparse proxies, with far-reaching weights, carry a half space
   as far past an edge as the octagons around their parts reach, after the face behind the edge has come out of reach. */
static double FadePast(double h, const Touch touch[], int n, int n_slots, double phi, double grad[][3])
{
  int    nearest[PROXY_PATCHES];
  double sum = 0.0, slope;

  // of each patch the least distance b_s; past = (sum b_s^-4)^(-1/4), about the least of them, smooth where two are the same
  for (int s = 0; s < n_slots; s++) nearest[s] = -1;
  for (int i = 0; i < n; i++) {
    int *best = &nearest[touch[i].slot];
    if (*best < 0 || touch[i].pair.beyond < touch[*best].pair.beyond) *best = i;
  }
  for (int s = 0; s < n_slots; s++) {
    const double b = touch[nearest[s]].pair.beyond/h;
    if (b <= PROXY_PAST_BEGIN) return phi;
    sum += 1.0/(b*b*b*b);
  }
  const double past = pow(sum, -0.25), width = PROXY_PAST_END - PROXY_PAST_BEGIN;
  if (past <= PROXY_PAST_BEGIN) return phi;
  const double fade = ProxySmoothStep((PROXY_PAST_END - past)/width, &slope);
  for (int s = 0; s < n_slots; s++) {
    const ProxyPair *q = &touch[nearest[s]].pair;
    const double     part = past*h/q->beyond, change = phi*slope/(width*h)*part*part*part*part*part;
    for (int k = 0; k < 3; k++) grad[s][k] = fade*grad[s][k] - change*q->out[k];
  }
  return fade*phi;
}

/* phi and the gradient's part of each patch at a particle */
static double PhiHalfSpace(const Proxy p, const double x[3], const double base[3], Touch touch[], int n, int n_slots,
                           const PetscInt slots[], const double D[], int in_front, double grad[][3])
{
  ProxyPatchValue value[PROXY_PATCHES];

  // the usual case: in front of one patch without open rims
  if (n_slots == 1 && !p->surface.patch_open[slots[0]] && in_front && !p->hides) {
    double lambda = 0.0, gD[3] = {0}, g[3] = {0};
    for (int i = 0; i < n; i++) {
      const ProxyPair *q = &touch[i].pair;
      lambda += q->w*q->lambda;
      for (int k = 0; k < 3; k++) {
        gD[k] += q->grad_w[k];
        g[k] += q->grad_w[k]*q->lambda + q->w*q->grad_lambda[k];
      }
    }
    lambda /= D[0];
    for (int k = 0; k < 3; k++) grad[0][k] = p->factor*(g[k] - lambda*gD[k])/D[0];
    return p->factor*lambda;
  }
  if (p->hides) ExposeTouched(p, x, base, touch, n);
  for (int s = 0; s < n_slots; s++) {
    PatchMeans(p, x, base, touch, n, s, &value[s]);
    value[s].open = p->surface.patch_open[slots[s]];
  }
  return p->hides ? ProxyExposedPhi(n_slots, p->fluid.h, p->factor, value, grad) : ProxyBodyPhi(n_slots, p->fluid.h, p->factor, value, grad);
}

/* write one touched particle and its pairs; proxies with less than 1e-14 of the weight are left out */
static int Emit(Chunk *c, const Proxy p, PetscInt particle, const double x[3], const double base[3], double phi, const Touch touch[], int n,
                const double D[], double grad[][3])
{
  double   total[3] = {0}, shift[3], best = -1.0;
  int      image = 13;
  PetscInt first;

  if (!ChunkReserve(c, n)) return 0;
  first = c->n_pairs;
  for (int i = 0; i < n; i++) {
    const double f = D ? touch[i].pair.w/D[touch[i].slot] : 1.0, *g = grad[D ? touch[i].slot : i];
    const double size = D ? f : fabs(touch[i].pair.w);
    if (D && f < 1e-14) continue;
    if (size > best) best = size, image = touch[i].image;
    for (int k = 0; k < 3; k++) total[k] += c->share[3*c->n_pairs + k] = f*g[k];
    c->proxy[c->n_pairs++] = touch[i].proxy;
  }
  ImageShift(&p->fluid, base, image, shift);
  c->particle[c->n_touched] = particle;
  c->n_of[c->n_touched]     = c->n_pairs - first;
  for (int k = 0; k < 3; k++) {
    c->value[7*c->n_touched + k]     = x[k] - shift[k];
    c->value[7*c->n_touched + 4 + k] = total[k];
  }
  c->value[7*c->n_touched + 3] = phi;
  c->n_touched++;
  return 1;
}

/* the paper's kernel: phi = sum of V_b W_b, each proxy has its own gradient */
static int ParticleEllipsoid(Chunk *c, const Proxy p, PetscInt particle, const double x[3], const double base[3], PetscInt begin, PetscInt end,
                             Touch touch[], double grad[][3])
{
  ProxyFoot last;
  double    phi  = 0.0;
  int       n    = 0;

  last.neighbour = -1;
  for (PetscInt e = begin; e < end; e++) {
    const PetscInt    i = p->cells.entry[e]/27;
    const ProxyPoint *b = &p->points[i];
    double            r[3], shift[3];
    ImageShift(&p->fluid, base, p->cells.entry[e]%27, shift);
    for (int k = 0; k < 3; k++) r[k] = x[k] - p->reach[i].x[k] - shift[k];
    if (OutOfReach(&p->reach[i], r)) continue;
    double part = ProxyPairEllipsoid(p->fluid.kernel, p->fluid.gradient_kernel, p->fluid.h, b, r, grad[n]);
    if (part == 0.0) continue;
    if (p->hides) {
      double at[3], slope[3];
      for (int k = 0; k < 3; k++) at[k] = x[k] - shift[k];
      const double exposed = ProxyExposureAt(p, i, at, &last, slope);
      for (int k = 0; k < 3; k++) grad[n][k] = exposed*grad[n][k] + part*slope[k];
      part *= exposed;
      if (part == 0.0) continue;
    }
    phi += part;
    touch[n].pair.w = part;
    touch[n].proxy  = i;
    touch[n].image  = (int)(p->cells.entry[e]%27);
    n++;
  }
  return n ? Emit(c, p, particle, x, base, phi, touch, n, NULL, grad) : 1;
}

static int ParticleHalfSpace(Chunk *c, const Proxy p, PetscInt particle, const double x[3], const double base[3], PetscInt begin, PetscInt end,
                             Touch touch[])
{
  PetscInt  slots[PROXY_PATCHES];
  double    D[PROXY_PATCHES], grad[PROXY_PATCHES][3];
  int       n_slots, in_front;
  const int n = GatherHalfSpace(p, x, base, begin, end, touch, &n_slots, slots, D, &in_front);

  if (!n) return 1;
  const double phi = FadePast(p->fluid.h, touch, n, n_slots, PhiHalfSpace(p, x, base, touch, n, n_slots, slots, D, in_front, grad), grad);
  // a face that lies on a wall does not act, but nothing may pass through it either: those near it are known to who stops them
  return phi > 0.0 || p->hides ? Emit(c, p, particle, x, base, phi, touch, n, D, grad) : 1;
}

/* all particles of one chunk; 0 when memory ran out */
static int RunChunk(Chunk *c, const Proxy p, PetscInt begin, PetscInt end, const PetscReal x[], const double base[3], Touch touch[],
                    double grad[][3])
{
  const ProxyCells *cells = &p->cells;
  int               good  = 1;

  c->n_touched = c->n_pairs = 0;
  for (PetscInt i = begin; i < end && good; i++) {
    PetscInt cell = 0;
    for (int k = 2; k >= 0; k--) {
      const double at = floor((x[3*i + k] - cells->lo[k])/cells->cell);
      if (!(at >= 0.0 && at < cells->dims[k])) {
        // the end of a periodic axis belongs to its last cell
        if (ProxyPeriod(&p->fluid, k) == 0.0 || !(at >= -1.0 && at <= cells->dims[k])) cell = -1;
        else cell = cell*cells->dims[k] + (at < 0.0 ? 0 : cells->dims[k] - 1);
      } else cell = cell*cells->dims[k] + (PetscInt)at;
      if (cell < 0) break;
    }
    if (cell < 0 || cells->start[cell] == cells->start[cell + 1]) continue;
    if (p->params.kernel != PROXY_KERNEL_HALF_SPACE) good = ParticleEllipsoid(c, p, i, &x[3*i], base, cells->start[cell], cells->start[cell + 1], touch, grad);
    else good = ParticleHalfSpace(c, p, i, &x[3*i], base, cells->start[cell], cells->start[cell + 1], touch);
  }
  return good;
}

/* chunks one after another into the arrays that the fluid reads */
static PetscErrorCode Collect(Proxy p, PetscInt n_chunks, SPHContacts *out)
{
  Chunk      *chunks = (Chunk *)p->chunks;
  SPHContacts *c = &p->contacts;
  PetscInt    n_touched = 0, n_pairs = 0, *particle, *start, *proxy, *at;
  PetscReal  *position, *phi, *grad, *share;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n_chunks; i++) {
    n_touched += chunks[i].n_touched;
    n_pairs += chunks[i].n_pairs;
  }
  if (n_touched + 1 > p->touched_capacity) {
    PetscCall(PetscFree5(c->particle, c->position, c->phi, c->grad, c->start));
    p->touched_capacity = n_touched + n_touched/2 + 16;
    PetscCall(PetscMalloc5(p->touched_capacity, &c->particle, 3*p->touched_capacity, &c->position, p->touched_capacity, &c->phi, 3*p->touched_capacity, &c->grad, p->touched_capacity + 1, &c->start));
  }
  if (n_pairs > p->pair_capacity) {
    PetscCall(PetscFree2(c->proxy, c->share));
    p->pair_capacity = n_pairs + n_pairs/2;
    PetscCall(PetscMalloc2(p->pair_capacity, &c->proxy, 3*p->pair_capacity, &c->share));
  }
  // the fluid may only read these arrays: they are ours
  particle = (PetscInt *)c->particle, start = (PetscInt *)c->start, proxy = (PetscInt *)c->proxy;
  position = (PetscReal *)c->position, phi = (PetscReal *)c->phi, grad = (PetscReal *)c->grad, share = (PetscReal *)c->share;
  PetscCall(PetscMalloc1(2*(n_chunks + 1), &at));
  at[0] = at[1] = 0;
  for (PetscInt i = 0; i < n_chunks; i++) {
    at[2*i + 2] = at[2*i] + chunks[i].n_touched;
    at[2*i + 3] = at[2*i + 1] + chunks[i].n_pairs;
  }
#pragma omp parallel for schedule(dynamic, 4) if(n_chunks > 1)
  for (PetscInt i = 0; i < n_chunks; i++) {
    const Chunk *k = &chunks[i];
    PetscInt     pair = at[2*i + 1];
    for (PetscInt t = 0; t < k->n_touched; t++) {
      const PetscInt j = at[2*i] + t;
      particle[j] = k->particle[t];
      phi[j]      = k->value[7*t + 3];
      start[j]    = pair;
      pair += k->n_of[t];
      for (int d = 0; d < 3; d++) {
        position[3*j + d] = k->value[7*t + d];
        grad[3*j + d]     = k->value[7*t + 4 + d];
      }
    }
    for (PetscInt q = 0; q < k->n_pairs; q++) {
      proxy[at[2*i + 1] + q] = k->proxy[q];
      for (int d = 0; d < 3; d++) share[3*(at[2*i + 1] + q) + d] = k->share[3*q + d];
    }
  }
  start[n_touched] = n_pairs;
  PetscCall(PetscFree(at));
  *out           = *c;
  out->n_touched = n_touched;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* contacts of n particles at x (n x 3 [m], inside the domain along periodic axes) with the proxies where they are now */
PetscErrorCode ProxyFindContacts(Proxy p, PetscInt n, const PetscReal x[], SPHContacts *contacts)
{
  const PetscInt n_chunks = (n + CHUNK - 1)/CHUNK;
  double         base[3];
  int            good = 1;

  PetscFunctionBegin;
  if (!p->n) {
    PetscCall(Collect(p, 0, contacts));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!p->cells_valid) PetscCall(BuildCells(p));
  if (n_chunks > p->n_chunks) {
    Chunk *more = (Chunk *)realloc(p->chunks, sizeof(Chunk)*(size_t)n_chunks);
    PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for %" PetscInt_FMT " contact buffers", n_chunks);
    PetscCall(PetscMemzero(more + p->n_chunks, sizeof(Chunk)*(size_t)(n_chunks - p->n_chunks)));
    p->chunks   = more;
    p->n_chunks = n_chunks;
  }
  BaseShift(p, base);
#pragma omp parallel reduction(&& : good) if(n_chunks > 1)
  {
    Touch  *touch = (Touch *)malloc(sizeof(Touch)*(size_t)(p->cells.longest + 1));
    double(*grad)[3] = (double(*)[3])malloc(3*sizeof(double)*(size_t)(p->cells.longest + 1));
    good = touch && grad;
#pragma omp for schedule(dynamic, 1)
    for (PetscInt i = 0; i < n_chunks; i++) {
      if (good) good = RunChunk(&((Chunk *)p->chunks)[i], p, CHUNK*i, PetscMin(n, CHUNK*(i + 1)), x, base, touch, grad);
    }
    free(touch);
    free(grad);
  }
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the contacts of %s", p->name);
  PetscCall(Collect(p, n_chunks, contacts));
  PetscCall(ProxySpread(p));
  contacts->n_proxies = p->n;
  contacts->area      = p->area;
  contacts->velocity  = p->node_velocity ? p->velocity : NULL;
  contacts->place     = p->place;
  contacts->rotation  = p->rotation;
  contacts->force     = p->force;
  PetscFunctionReturn(PETSC_SUCCESS);
}
