/* sph_openmp_loops.h - the pair loops for OpenMP: gather, call the formula, store. Compiled once per precision by
   sph_openmp_single.c and sph_openmp_double.c, which define SPH_REAL, SPH_TABLE and SPH_LABEL.

   Gradients are stored, three numbers a pair: on 24,000 particles one operator application takes 0.46 ms on two threads, 1.1 ms with
   components in three arrays and gathered neighbours, 2.7 ms when gradients are computed again (docs/verification/fluid-slice.md).
   A pair is handled four components wide; four accumulators hide the latency of the sum and fix its order. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "sph_loops.h"
#include "sph_pair.h"

typedef SPH_REAL real;
/* four reals at any address that a real may have; the fourth lane of a gradient belongs to the next pair and is never used */
typedef real Vec4 __attribute__((vector_size(4 * sizeof(real)), aligned(sizeof(real)), may_alias));

#define SQRT(a) (sizeof(real) == sizeof(float) ? (real)sqrtf((float)(a)) : (real)sqrt((double)(a)))
#define BLOCK 64 /* candidates or pairs that are handled at a time: a multiple of every vector length */

/* byte of the lowest bit, as it lies in memory */
static inline int FirstByte(uint64_t flags)
{
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  return __builtin_ctzll(flags) >> 3;
#else
  return 7 - (__builtin_ctzll(flags) >> 3);
#endif
}

static inline Vec4 Load4(const real *a) { return *(const Vec4 *)a; }
static inline void Store4(real *a, Vec4 v) { *(Vec4 *)a = v; }

static int Chunks(const SPHLoops *l) { return (l->n + SPH_PAIR_CHUNK - 1) / SPH_PAIR_CHUNK; }
static int ChunkEnd(const SPHLoops *l, int c) { return (c + 1) * SPH_PAIR_CHUNK < l->n ? (c + 1) * SPH_PAIR_CHUNK : l->n; }

/* candidates: the particles of the 27 cells around one cell, moved to the nearest periodic image; all particles of the cell share them */
typedef struct {
  int            n, allocated; /* allocated is a multiple of BLOCK */
  real          *x, *y, *z;    /* from the grid's corner           */
  int           *index;
  unsigned char *near;         /* one flag each                    */
  int            cell;
} Candidates;

static void FreeCandidates(Candidates *c)
{
  free(c->x);
  free(c->index);
  free(c->near);
}

/* room for n more; 0 when there is no memory */
static int Reserve(Candidates *c, int n)
{
  real *x;

  if (c->n + n + BLOCK <= c->allocated) return 1;
  const int allocated = (2 * (c->n + n) + 16 * BLOCK) / BLOCK * BLOCK;

  x = (real *)malloc(3 * sizeof(real) * (size_t)allocated);
  if (!x) return 0;
  for (int k = 0; k < c->n; k++) {
    x[k]                 = c->x[k];
    x[allocated + k]     = c->y[k];
    x[2 * allocated + k] = c->z[k];
  }
  free(c->x);
  c->x         = x;
  c->y         = x + allocated;
  c->z         = x + 2 * allocated;
  c->index     = (int *)realloc(c->index, sizeof(int) * (size_t)allocated);
  c->near      = (unsigned char *)realloc(c->near, (size_t)allocated);
  c->allocated = allocated;
  return c->index && c->near;
}

/* candidates of particles [from, to) seen through a periodic shift */
static int Append(const SPHLoops *l, Candidates *c, const real shift[3], int from, int to)
{
  const real *x = (const real *)l->near_x, *y = x + l->n, *z = y + l->n;

  if (!Reserve(c, to - from)) return 0;
  for (int j = from; j < to; j++, c->n++) {
    c->x[c->n]     = x[j] - shift[0];
    c->y[c->n]     = y[j] - shift[1];
    c->z[c->n]     = z[j] - shift[2];
    c->index[c->n] = j;
  }
  return 1;
}

/* candidates of the particles of a cell; 0 when there is no memory */
static int Gather(const SPHLoops *l, int cell, Candidates *c)
{
  const SPHGrid *g  = &l->grid;
  const int      cx = cell % g->n[0], cy = (cell / g->n[0]) % g->n[1], cz = cell / (g->n[0] * g->n[1]);

  c->n    = 0;
  c->cell = cell;
  for (int dz = -1; dz <= 1; dz++) {
    for (int dy = -1; dy <= 1; dy++) {
      int  row[3] = {cx - 1, cy + dy, cz + dz}, outside = 0;
      real shift[3] = {0, 0, 0};

      for (int k = 1; k < 3; k++) {
        if (row[k] >= 0 && row[k] < g->n[k]) continue;
        if (!g->periodic[k]) outside = 1;
        shift[k] = row[k] < 0 ? (real)g->period[k] : -(real)g->period[k];
        row[k] += row[k] < 0 ? g->n[k] : -g->n[k];
      }
      if (outside) continue;

      // the three cells along x are one range of particles, or two where the row wraps around
      const int base = g->n[0] * (row[1] + g->n[1] * row[2]), last = g->n[0] - 1;
      const int lo = cx > 0 ? cx - 1 : 0, hi = cx < last ? cx + 1 : last;

      if (!Append(l, c, shift, g->start[base + lo], g->start[base + hi + 1])) return 0;
      if (g->periodic[0] && cx == 0) {
        shift[0] = (real)g->period[0];
        if (!Append(l, c, shift, g->start[base + last], g->start[base + last + 1])) return 0;
      }
      if (g->periodic[0] && cx == last) {
        shift[0] = -(real)g->period[0];
        if (!Append(l, c, shift, g->start[base], g->start[base + 1])) return 0;
      }
    }
  }
  return 1;
}

/* list[] = candidates within h of particle i, without i; returns how many, or -1 when there are more than `room` */
static int Collect(const SPHLoops *l, const Candidates *c, int i, int *list, int room)
{
  const real    *x = (const real *)l->near_x, h2 = (real)(l->h * l->h), xi = x[i], yi = x[l->n + i], zi = x[2 * l->n + i];
  const real    *cx = c->x, *cy = c->y, *cz = c->z;
  unsigned char *near = c->near;
  int            n = 0;

  // whole vectors: what lies beyond the last candidate is cleared below
#pragma omp simd
  for (int k = 0; k < ((c->n + 15) & ~15); k++) {
    const real dx = xi - cx[k], dy = yi - cy[k], dz = zi - cz[k];
    near[k] = dx*dx + dy*dy + dz*dz < h2;
  }
  for (int k = c->n; k < ((c->n + 7) & ~7); k++) near[k] = 0;

  // one in seven is near: look at eight flags at a time
  for (int k = 0; k < c->n; k += 8) {
    uint64_t flags;
    memcpy(&flags, near + k, 8);
    if (n + 8 > room) return -1;
    for (; flags; flags &= flags - 1) {
      const int j = c->index[k + FirstByte(flags)];
      if (j != i) list[n++] = j;
    }
  }
  return n;
}

/* sum_j m W_ij with i itself, for particles at x; `gradient` gets those of the pairs of particle i, when there is one */
static double SumPairs(const SPHLoops *l, const double x[], int i, int at, int n, real *gradient)
{
  const real h = (real)l->h, mass = (real)l->mass;
  const int *list = l->neighbour + at, periodic = l->grid.periodic[0] || l->grid.periodic[1] || l->grid.periodic[2];
  const double xi[3] = {x[3*i], x[3*i + 1], x[3*i + 2]};
  double     density = (double)SPHPairDensity(l->kernel, mass, 0, h);

  for (int first = 0; first < n; first += BLOCK) {
    const int m = n - first < BLOCK ? n - first : BLOCK, whole = (m + 15) & ~15; // whole vectors
    real      d[3][BLOCK], r[BLOCK], f[BLOCK], w[BLOCK];

    for (int k = 0; k < m; k++) {
      const double *xj = x + 3*list[first + k];
      double        dx[3] = {xi[0] - xj[0], xi[1] - xj[1], xi[2] - xj[2]};

      for (int a = 0; a < 3 && periodic; a++)
        if (l->grid.periodic[a]) dx[a] -= l->grid.period[a] * rint(dx[a] / l->grid.period[a]);
      for (int a = 0; a < 3; a++) d[a][k] = (real)dx[a];
    }
    for (int k = m; k < whole; k++) d[0][k] = d[1][k] = d[2][k] = h;
#pragma omp simd
    for (int k = 0; k < whole; k++) {
      r[k] = SQRT(d[0][k]*d[0][k] + d[1][k]*d[1][k] + d[2][k]*d[2][k]);
      w[k] = SPHPairDensity(l->kernel, mass, r[k], h);
    }
    for (int k = 0; k < m; k++) density += (double)w[k];
    if (!gradient) continue;
#pragma omp simd
    for (int k = 0; k < whole; k++) f[k] = SPHPairGradient(l->gradient_kernel, mass, r[k], h);
    for (int k = 0; k < m; k++)
      for (int a = 0; a < 3; a++) gradient[3*(first + k) + a] = f[k] * d[a][k];
  }
  return density;
}

static int Pairs(const SPHLoops *l, double density[])
{
  real *x = (real *)l->near_x;
  int   failed = 0;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < l->n; i++)
    for (int a = 0; a < 3; a++) x[a*l->n + i] = (real)(l->x[3*i + a] - l->grid.lo[a]);
#pragma omp parallel reduction(max : failed)
  {
    Candidates candidates = {0, 0, NULL, NULL, NULL, NULL, NULL, -1};

#pragma omp for schedule(dynamic, 1)
    for (int c = 0; c < Chunks(l); c++) {
      const int end = (c + 1) * SPH_PAIR_CHUNK * l->capacity;
      int       at = c * SPH_PAIR_CHUNK * l->capacity;

      for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
        if (l->cell[i] != candidates.cell && !Gather(l, l->cell[i], &candidates)) {
          failed = 2;
          break;
        }
        const int n = Collect(l, &candidates, i, l->neighbour + at, end - at);
        if (n < 0) {
          failed = failed > 1 ? failed : 1;
          break;
        }
        l->start[i] = at;
        l->count[i] = n;
        density[i]  = SumPairs(l, l->x, i, at, n, (real *)l->gradient + 3 * (size_t)at);
        at += n;
      }
    }
    FreeCandidates(&candidates);
  }
  return failed;
}

/* the lists as they are, particles at x */
static void AtPositions(const SPHLoops *l, const double x[], double density[], real *gradient)
{
#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++)
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) density[i] = SumPairs(l, x, i, l->start[i], l->count[i], gradient ? gradient + 3 * (size_t)l->start[i] : NULL);
}

static void Move(const SPHLoops *l, const double x[], double density[]) { AtPositions(l, x, density, (real *)l->gradient); }
static void Density(const SPHLoops *l, const double x[], double density[]) { AtPositions(l, x, density, NULL); }

static void SetVec4(const SPHLoops *l, const double a[], void *out)
{
#pragma omp parallel for schedule(static)
  for (int i = 0; i < l->n; i++) {
    real *o = (real *)out + 4 * (size_t)i;
    for (int k = 0; k < 3; k++) o[k] = (real)a[3*i + k];
    o[3] = 0;
  }
}

static void SetWalls(const SPHLoops *l, const double G[]) { SetVec4(l, G, l->wall); }
static void SetVelocity(const SPHLoops *l, const double v[]) { SetVec4(l, v, l->vector); }

static void SetPressure(const SPHLoops *l, const double p[], const double scale[])
{
  real *out = (real *)l->pressure;

#pragma omp parallel for schedule(static)
  for (int i = 0; i < l->n; i++) out[i] = (real)(scale ? p[i] * scale[i] : p[i]);
}

static void GetVector(const SPHLoops *l, double a[])
{
#pragma omp parallel for schedule(static)
  for (int i = 0; i < l->n; i++)
    for (int k = 0; k < 3; k++) a[3*i + k] = (double)((const real *)l->vector)[4 * (size_t)i + k];
}

/* a_i = - sum_j (p_i + p_j) m grad W_ij - p_i G_i */
static void Acceleration(const SPHLoops *l)
{
  const real *p = (const real *)l->pressure, *gradient = (const real *)l->gradient, *G = (const real *)l->wall;
  real       *a = (real *)l->vector;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i], n = l->count[i];
      const real *g = gradient + 3 * (size_t)l->start[i], pi = p[i];
      Vec4        s0 = {0}, s1 = {0}, s2 = {0}, s3 = {0};
      int         k = 0;

      if (l->held && l->held[i] == SPH_LOOPS_HELD) {
        Store4(a + 4 * (size_t)i, s0);
        continue;
      }
      for (; k + 4 <= n; k += 4, g += 12) {
        s0 += SPHPairPressure(pi, p[list[k]]) * Load4(g);
        s1 += SPHPairPressure(pi, p[list[k + 1]]) * Load4(g + 3);
        s2 += SPHPairPressure(pi, p[list[k + 2]]) * Load4(g + 6);
        s3 += SPHPairPressure(pi, p[list[k + 3]]) * Load4(g + 9);
      }
      for (; k < n; k++, g += 3) s0 += SPHPairPressure(pi, p[list[k]]) * Load4(g);
      Store4(a + 4 * (size_t)i, -((s0 + s1) + (s2 + s3)) - pi * Load4(G + 4 * (size_t)i));
    }
  }
}

/* rate_i = factor scale_i [ sum_j (a_i - a_j) . m grad W_ij + a_i . G_i ]; the products of a pair stay in their lanes until the
   end of the sum (SPHPairRate, one lane a component) */
static void Rate(const SPHLoops *l, double factor, const double scale[], double rate[])
{
  const real *a = (const real *)l->vector, *gradient = (const real *)l->gradient, *G = (const real *)l->wall;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i], n = l->count[i];
      const real *g = gradient + 3 * (size_t)l->start[i];
      const Vec4  ai = Load4(a + 4 * (size_t)i);
      Vec4        s0 = ai * Load4(G + 4 * (size_t)i), s1 = {0}, s2 = {0}, s3 = {0};
      int         k = 0;

      for (; k + 4 <= n; k += 4, g += 12) {
        s0 += (ai - Load4(a + 4 * (size_t)list[k])) * Load4(g);
        s1 += (ai - Load4(a + 4 * (size_t)list[k + 1])) * Load4(g + 3);
        s2 += (ai - Load4(a + 4 * (size_t)list[k + 2])) * Load4(g + 6);
        s3 += (ai - Load4(a + 4 * (size_t)list[k + 3])) * Load4(g + 9);
      }
      for (; k < n; k++, g += 3) s0 += (ai - Load4(a + 4 * (size_t)list[k])) * Load4(g);
      s0 = (s0 + s1) + (s2 + s3);
      rate[i] = factor * (scale ? scale[i] : 1.0) * (double)(s0[0] + s0[1] + s0[2]);
    }
  }
}

/* (D D^T)_ii = |sum_j m grad W_ij + G_i|^2 + sum_j |m grad W_ij|^2 */
static void Diagonal(const SPHLoops *l, double diagonal[])
{
  const real *gradient = (const real *)l->gradient, *G = (const real *)l->wall;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const real *g = gradient + 3 * (size_t)l->start[i];
      Vec4        sum = Load4(G + 4 * (size_t)i), square = {0};

      for (int k = 0; k < l->count[i]; k++, g += 3) {
        sum += Load4(g);
        square += Load4(g) * Load4(g);
      }
      square += sum * sum;
      diagonal[i] = (double)(square[0] + square[1] + square[2]);
    }
  }
}

/* a_i += Monaghan's viscous acceleration of pairs that approach each other: artificial viscosity */
static void Artificial(const SPHLoops *l, double mu_over_rho2, double a[])
{
  const real *v = (const real *)l->vector, *gradient = (const real *)l->gradient, h = (real)l->h, mu = (real)mu_over_rho2;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i];
      const real *g = gradient + 3 * (size_t)l->start[i];
      const Vec4  vi = Load4(v + 4 * (size_t)i);
      Vec4        sum = {0};

      for (int k = 0; k < l->count[i]; k++, g += 3) {
        const int  j = list[k];
        const Vec4 v_ij = vi - Load4(v + 4 * (size_t)j);
        real       r2 = 0, v_dot_x = 0;

        for (int q = 0; q < 3; q++) {
          double dx = l->x[3*i + q] - l->x[3*j + q];
          if (l->grid.periodic[q]) dx -= l->grid.period[q] * rint(dx / l->grid.period[q]);
          r2 += (real)(dx * dx);
          v_dot_x += v_ij[q] * (real)dx;
        }
        if (v_dot_x < 0) sum += SPHPairViscosityMonaghan(mu, v_dot_x, r2, h) * Load4(g);
      }
      for (int q = 0; q < 3; q++) a[3*i + q] += (double)sum[q];
    }
  }
}

/* weights of all pairs, by Monaghan's form when `central`, else by Morris's */
static void ViscousWeights(const SPHLoops *l, int central, double mu, const double volume[])
{
  const real *gradient = (const real *)l->gradient, h = (real)l->h;
  real       *weight = (real *)l->viscous;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      for (int k = l->start[i]; k < l->start[i] + l->count[i]; k++) {
        const int   j = l->neighbour[k];
        const real *g = gradient + 3 * (size_t)k, mu_over_rho2 = (real)(mu * (volume[i] * volume[j]));
        real        r2 = 0, x_dot_g = 0;

        for (int q = 0; q < 3; q++) {
          double dx = l->x[3*i + q] - l->x[3*j + q];
          if (l->grid.periodic[q]) dx -= l->grid.period[q] * rint(dx / l->grid.period[q]);
          r2 += (real)(dx * dx);
          x_dot_g += g[q] * (real)dx;
        }
        // v . x = (v . g) r^2/(x . g); at the rim of the kernel the gradient is nothing and so is its part
        if (!central) weight[k] = SPHPairViscosityMorris(mu_over_rho2, x_dot_g, r2, h);
        else weight[k] = x_dot_g < (real)-1e-24 ? SPHPairViscosityMonaghan(mu_over_rho2, r2 / x_dot_g, r2, h) : 0;
      }
    }
  }
}

/* a_i = sum_j w v_ij (Morris), sum_j w (v_ij . g) g (Monaghan). Differences and sums are double whatever `real` is: a stiff flow is the
   small difference of large velocities, and momentum stays pair by pair. */
static void Viscous(const SPHLoops *l, int central, const double v[], double a[])
{
  const real *gradient = (const real *)l->gradient, *weight = (const real *)l->viscous;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const double vx = v[3*i], vy = v[3*i + 1], vz = v[3*i + 2];
      double       x = 0, y = 0, z = 0;

      for (int k = l->start[i]; k < l->start[i] + l->count[i]; k++) {
        const double *vj = v + 3 * (size_t)l->neighbour[k], w = (double)weight[k], dx = vx - vj[0], dy = vy - vj[1], dz = vz - vj[2];

        if (central) {
          const real  *g = gradient + 3 * (size_t)k;
          const double s = w * (dx * (double)g[0] + dy * (double)g[1] + dz * (double)g[2]);
          x += s * (double)g[0];
          y += s * (double)g[1];
          z += s * (double)g[2];
        } else {
          x += w * dx;
          y += w * dy;
          z += w * dz;
        }
      }
      a[3*i]     = x;
      a[3*i + 1] = y;
      a[3*i + 2] = z;
    }
  }
}

static void ViscousDiagonal(const SPHLoops *l, int central, double diagonal[])
{
  const real *gradient = (const real *)l->gradient, *weight = (const real *)l->viscous;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      double sum[3] = {0, 0, 0};

      for (int k = l->start[i]; k < l->start[i] + l->count[i]; k++)
        for (int q = 0; q < 3; q++) sum[q] -= (double)weight[k] * (central ? (double)(gradient[3 * (size_t)k + q] * gradient[3 * (size_t)k + q]) : 1.0);
      for (int q = 0; q < 3; q++) diagonal[3*i + q] = sum[q];
    }
  }
}

/* a_i += factor sum_j [ (v_i - v_j) . g ] g, g = m grad W_ij */
static void Filter(const SPHLoops *l, double factor, double a[])
{
  const real *v = (const real *)l->vector, *gradient = (const real *)l->gradient;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i], n = l->count[i];
      const real *g = gradient + 3 * (size_t)l->start[i], *vi = v + 4 * (size_t)i;
      Vec4        s0 = {0}, s1 = {0};
      int         k = 0;

      for (; k + 2 <= n; k += 2, g += 6) {
        s0 += SPHPairRate(vi, v + 4 * (size_t)list[k], g) * Load4(g);
        s1 += SPHPairRate(vi, v + 4 * (size_t)list[k + 1], g + 3) * Load4(g + 3);
      }
      if (k < n) s0 += SPHPairRate(vi, v + 4 * (size_t)list[k], g) * Load4(g);
      s0 += s1;
      for (int q = 0; q < 3; q++) a[3*i + q] += factor * (double)s0[q];
    }
  }
}

/* kernel of the density at the distances of the pairs of particle i, particles at x */
static inline real PairDistance(const SPHLoops *l, const double x[], int i, int j)
{
  double r2 = 0;

  for (int q = 0; q < 3; q++) {
    double dx = x[3*i + q] - x[3*j + q];
    if (l->grid.periodic[q]) dx -= l->grid.period[q] * rint(dx / l->grid.period[q]);
    r2 += dx * dx;
  }
  return SQRT((real)r2);
}

/* a_i += factor sum_j V (v_j - v_i) W_ij */
static void Smooth(const SPHLoops *l, double factor, double a[])
{
  const real *v = (const real *)l->vector, h = (real)l->h, volume = (real)(l->mass / l->rho0);

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int *list = l->neighbour + l->start[i];
      const Vec4 vi = Load4(v + 4 * (size_t)i);
      Vec4       sum = {0};

      for (int k = 0; k < l->count[i]; k++) sum += SPHPairSmooth(l->kernel, volume, PairDistance(l, l->x, i, list[k]), h) * (Load4(v + 4 * (size_t)list[k]) - vi);
      for (int q = 0; q < 3; q++) a[3*i + q] += factor * (double)sum[q];
    }
  }
}

/* a_i -= sum_j k (W_ij/W(distance))^n m grad W_ij */
static void Repulsion(const SPHLoops *l, const double x[], double strength, double distance, double n, double a[])
{
  const real *gradient = (const real *)l->gradient, h = (real)l->h, W0 = SPHKernelW(l->kernel, (real)distance, h);

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i];
      const real *g = gradient + 3 * (size_t)l->start[i];
      Vec4        sum = {0};

      for (int k = 0; k < l->count[i]; k++, g += 3)
        sum += SPHPairRepulsion((real)strength, SPHKernelW(l->kernel, PairDistance(l, x, i, list[k]), h) / W0, (real)n) * Load4(g);
      for (int q = 0; q < 3; q++) a[3*i + q] -= (double)sum[q];
    }
  }
}

#include "sph_openmp_compact.h"

const SPHLoopTable SPH_TABLE = {SPH_LABEL, (int)sizeof(real), Pairs, Move,     Density,   SetWalls, SetPressure, SetVelocity, Acceleration,
                                GetVector, Rate,              Diagonal, Artificial, ViscousWeights, Viscous, ViscousDiagonal, Filter,
                                Compact,   ScaleCompact, Laplacian, Difference, VelocityGradient, Concentration,
                                Smooth,    Repulsion};
