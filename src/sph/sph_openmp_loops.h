/* sph_openmp_loops.h - the pair loops for OpenMP: gather, call the formula, store. Compiled once per precision by
   sph_openmp_single.c and sph_openmp_double.c, which define SPH_REAL, SPH_TABLE and SPH_LABEL.

   Gradients are stored, three numbers a pair: on 24,000 particles one operator application takes 0.46 ms on two threads, 1.1 ms with
   components in three arrays and gathered neighbours, 2.7 ms when gradients are computed again (docs/verification/fluid-slice.md).
   A pair is handled four components wide; four accumulators hide the latency of the sum and fix its order. */
#include <math.h>
#include <stddef.h>

#include "sph_loops.h"
#include "sph_pair.h"

typedef SPH_REAL real;
/* four reals at any address that a real may have; the fourth lane of a gradient belongs to the next pair and is never used */
typedef real Vec4 __attribute__((vector_size(4 * sizeof(real)), aligned(sizeof(real)), may_alias));

#define SQRT(a) (sizeof(real) == sizeof(float) ? (real)sqrtf((float)(a)) : (real)sqrt((double)(a)))
#define BLOCK 64 /* candidates or pairs that are handled at a time: a multiple of every vector length */

static inline Vec4 Load4(const real *a) { return *(const Vec4 *)a; }
static inline void Store4(real *a, Vec4 v) { *(Vec4 *)a = v; }

static int Chunks(const SPHLoops *l) { return (l->n + SPH_PAIR_CHUNK - 1) / SPH_PAIR_CHUNK; }
static int ChunkEnd(const SPHLoops *l, int c) { return (c + 1) * SPH_PAIR_CHUNK < l->n ? (c + 1) * SPH_PAIR_CHUNK : l->n; }

/* append those of particles [from, to) that are within h of particle i, seen through the periodic shift; i itself is skipped */
static int Collect(const SPHLoops *l, int i, const real shift[3], int from, int to, int *list)
{
  const real *x = (const real *)l->near_x, *y = x + l->n, *z = y + l->n, h2 = (real)(l->h * l->h);
  const real  xi = x[i], yi = y[i], zi = z[i], sx = shift[0], sy = shift[1], sz = shift[2];
  int         n = 0;

  for (int first = from; first < to; first += BLOCK) {
    const int m = to - first < BLOCK ? to - first : BLOCK;
    real      r2[BLOCK];

#pragma omp simd
    for (int k = 0; k < m; k++) {
      const real dx = (xi - x[first + k]) + sx, dy = (yi - y[first + k]) + sy, dz = (zi - z[first + k]) + sz;
      r2[k] = dx*dx + dy*dy + dz*dz;
    }
    for (int k = 0; k < m; k++) {
      list[n] = first + k;
      n += r2[k] < h2 && first + k != i;
    }
  }
  return n;
}

/* neighbours of particle i from the 27 cells around its own; -1 when the slots [at, end) do not suffice */
static int Search(const SPHLoops *l, int i, int at, int end)
{
  const SPHGrid *g = &l->grid;
  const int      c = l->cell[i], cx = c % g->n[0], cy = (c / g->n[0]) % g->n[1], cz = c / (g->n[0] * g->n[1]);
  int            n = 0;

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
      const int base = g->n[0] * (row[1] + g->n[1] * row[2]);
      const int lo = cx > 0 ? cx - 1 : 0, hi = cx + 1 < g->n[0] ? cx + 1 : g->n[0] - 1;
      const int ranges[3][3] = {
        {lo, hi, 0}, {g->n[0] - 1, g->n[0] - 1, cx == 0 && g->periodic[0] ? 1 : 2}, {0, 0, cx == g->n[0] - 1 && g->periodic[0] ? -1 : 2}
      };
      for (int part = 0; part < 3; part++) {
        if (ranges[part][2] == 2) continue;
        const int from = g->start[base + ranges[part][0]], to = g->start[base + ranges[part][1] + 1];

        shift[0] = (real)(ranges[part][2] * g->period[0]);
        if (at + n + (to - from) >= end) return -1;
        n += Collect(l, i, shift, from, to, l->neighbour + at + n);
      }
    }
  }
  return n;
}

/* gradients of the pairs of particle i; returns sum_j m W_ij with i itself */
static double Gradients(const SPHLoops *l, int i, int at, int n)
{
  const real h = (real)l->h, mass = (real)l->mass;
  const int *list = l->neighbour + at;
  real      *gradient = (real *)l->gradient + 3 * (size_t)at;
  double     density = (double)SPHPairDensity(l->kernel, mass, 0, h);

  for (int first = 0; first < n; first += BLOCK) {
    const int m = n - first < BLOCK ? n - first : BLOCK;
    real      d[3][BLOCK], f[BLOCK], w[BLOCK];

    for (int k = 0; k < m; k++) {
      for (int a = 0; a < 3; a++) {
        double dx = l->x[3*i + a] - l->x[3*list[first + k] + a];
        if (l->grid.periodic[a]) dx -= l->grid.period[a] * rint(dx / l->grid.period[a]);
        d[a][k] = (real)dx;
      }
    }
    for (int k = m; k < BLOCK; k++) d[0][k] = d[1][k] = d[2][k] = h;
#pragma omp simd
    for (int k = 0; k < BLOCK; k++) {
      const real r = SQRT(d[0][k]*d[0][k] + d[1][k]*d[1][k] + d[2][k]*d[2][k]);
      f[k] = SPHPairGradient(l->kernel, mass, r, h);
      w[k] = SPHPairDensity(l->kernel, mass, r, h);
    }
    for (int k = 0; k < m; k++) {
      for (int a = 0; a < 3; a++) gradient[3*(first + k) + a] = f[k] * d[a][k];
      density += (double)w[k];
    }
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
#pragma omp parallel for schedule(dynamic, 1) reduction(|| : failed)
  for (int c = 0; c < Chunks(l); c++) {
    const int end = (c + 1) * SPH_PAIR_CHUNK * l->capacity;
    int       at = c * SPH_PAIR_CHUNK * l->capacity;

    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int n = Search(l, i, at, end);
      if (n < 0) {
        failed = 1;
        break;
      }
      l->start[i] = at;
      l->count[i] = n;
      density[i] = Gradients(l, i, at, n);
      at += n;
    }
  }
  return failed;
}

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

static void Viscosity(const SPHLoops *l, double mu_over_rho2, double a[])
{
  const real *v = (const real *)l->vector, *gradient = (const real *)l->gradient, h = (real)l->h;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i];
      const real *g = gradient + 3 * (size_t)l->start[i];
      Vec4        sum = {0};

      for (int k = 0; k < l->count[i]; k++, g += 3) {
        const int j = list[k];
        real      r2 = 0, v_dot_x = 0;

        for (int q = 0; q < 3; q++) {
          double dx = l->x[3*i + q] - l->x[3*j + q];
          if (l->grid.periodic[q]) dx -= l->grid.period[q] * rint(dx / l->grid.period[q]);
          r2 += (real)(dx * dx);
          v_dot_x += (v[4 * (size_t)i + q] - v[4 * (size_t)j + q]) * (real)dx;
        }
        sum += SPHPairViscosity((real)mu_over_rho2, v_dot_x, r2, h) * Load4(g);
      }
      for (int q = 0; q < 3; q++) a[3*i + q] += (double)sum[q];
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

const SPHLoopTable SPH_TABLE = {SPH_LABEL, (int)sizeof(real), Pairs,     SetWalls, SetPressure, SetVelocity, Acceleration,
                                GetVector, Rate,              Diagonal, Viscosity, Filter};
