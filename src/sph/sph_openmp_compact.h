/* sph_openmp_compact.h - the loops of the compact Laplacian and of corrected gradients; included by sph_openmp_loops.h, which has the types.

   An application reads 12 bytes a pair (index, coefficient, neighbour's pressure) in place of the 52 of the two passes of D D^T. */

/* walls that particle i touches, from its distances; returns how many */
static int Touched(const SPHLoops *l, const double distance[], int wall[SPH_IMAGES])
{
  int n = 0;

  for (int k = 0; k < SPH_IMAGES; k++)
    if (distance[k] < l->h) wall[n++] = k;
  return n;
}

/* sum of m |F| over the images of one neighbour in the walls touched, each side of an axis alone, edges and corners included; adds
   m |F| r'^2 of them to *trace */
static double Images(const SPHLoops *l, const double di[], const double dj[], int touched, const int wall[], double r2, double *trace)
{
  double sum = 0;

  for (int subset = 1; subset < 1 << touched; subset++) {
    double image2 = r2;
    int    sides = 0, both = 0;

    for (int k = 0; k < touched; k++) {
      if (!(subset >> k & 1)) continue;
      both |= wall[k] < 6 && (sides >> (wall[k] ^ 1) & 1);
      sides |= 1 << wall[k];
      image2 = SPHPairImage(image2, di[wall[k]], dj[wall[k]]);
    }
    if (both || image2 >= l->h * l->h) continue;
    const double f = -(double)SPHPairGradient(l->kernel, (real)l->mass, (real)sqrt(image2), (real)l->h);
    sum += f;
    *trace += f * image2;
  }
  return sum;
}

/* displacements of neighbours [first, first + m) of the list, squared distances, m |F|; whole vectors, zero beyond m */
static void Displacements(const SPHLoops *l, int i, const int *list, int m, real d[3][BLOCK], real r2[BLOCK], real f[BLOCK])
{
  const real h = (real)l->h, mass = (real)l->mass;
  const int  whole = (m + 15) & ~15;

  for (int k = 0; k < m; k++) {
    for (int a = 0; a < 3; a++) {
      double dx = l->x[3*i + a] - l->x[3*list[k] + a];
      if (l->grid.periodic[a]) dx -= l->grid.period[a] * rint(dx / l->grid.period[a]);
      d[a][k] = (real)dx;
    }
  }
  for (int k = m; k < whole; k++) {
    d[0][k] = h;
    d[1][k] = d[2][k] = 0;
  }
#pragma omp simd
  for (int k = 0; k < whole; k++) {
    r2[k] = d[0][k]*d[0][k] + d[1][k]*d[1][k] + d[2][k]*d[2][k];
    f[k]  = -SPHPairGradient(l->kernel, mass, SQRT(r2[k]), h);
  }
}

/* compact = m |F|, images in walls included; moments = sum m |F| d d^T of the pairs alone (xx xy xz yy yz zz), trace with the images */
static void Compact(const SPHLoops *l, const double distance[], double moments[], double trace[])
{
#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const double *di   = distance + SPH_IMAGES * (size_t)i;
      real         *out  = (real *)l->compact + l->start[i];
      double        M[6] = {0, 0, 0, 0, 0, 0}, images = 0;
      int           wall[SPH_IMAGES];
      const int     touched = Touched(l, di, wall);

      for (int first = 0; first < l->count[i]; first += BLOCK) {
        const int  m = l->count[i] - first < BLOCK ? l->count[i] - first : BLOCK, *list = l->neighbour + l->start[i] + first;
        real       d[3][BLOCK], r2[BLOCK], f[BLOCK], xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

        Displacements(l, i, list, m, d, r2, f);
#pragma omp simd reduction(+ : xx, xy, xz, yy, yz, zz)
        for (int k = 0; k < ((m + 15) & ~15); k++) {
          xx += f[k] * d[0][k]*d[0][k];
          xy += f[k] * d[0][k]*d[1][k];
          xz += f[k] * d[0][k]*d[2][k];
          yy += f[k] * d[1][k]*d[1][k];
          yz += f[k] * d[1][k]*d[2][k];
          zz += f[k] * d[2][k]*d[2][k];
        }
        M[0] += (double)xx;
        M[1] += (double)xy;
        M[2] += (double)xz;
        M[3] += (double)yy;
        M[4] += (double)yz;
        M[5] += (double)zz;
        for (int k = 0; touched && k < m; k++) f[k] += (real)Images(l, di, distance + SPH_IMAGES * (size_t)list[k], touched, wall, (double)r2[k], &images);
        for (int k = 0; k < m; k++) out[first + k] = f[k];
      }
      if (touched) (void)Images(l, di, di, touched, wall, 0.0, &images); // its own image has its own pressure: no coefficient
      for (int k = 0; k < 6; k++) moments[6 * (size_t)i + k] = M[k];
      trace[i] = M[0] + M[3] + M[5] + images;
    }
  }
}

/* compact_ij *= SPHPairStretch; diagonal_i = sum of the row */
static void ScaleCompact(const SPHLoops *l, const double N[], double diagonal[])
{
#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const real *g   = (const real *)l->gradient + 3 * (size_t)l->start[i];
      real       *row = (real *)l->compact + l->start[i];
      double      sum = 0;

      for (int k = 0; k < l->count[i]; k++) {
        row[k] *= SPHPairStretch(N + 6 * (size_t)i, N + 6 * (size_t)l->neighbour[l->start[i] + k], g + 3 * k);
        sum += (double)row[k];
      }
      diagonal[i] = sum;
    }
  }
}

/* out_i = factor scale_i sum_j compact_ij (p_i - p_j) */
static void Laplacian(const SPHLoops *l, double factor, const double scale[], double out[])
{
  const real *p = (const real *)l->pressure;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i], n = l->count[i];
      const real *row = (const real *)l->compact + l->start[i], pi = p[i];
      real        sum = 0;

#pragma omp simd reduction(+ : sum)
      for (int k = 0; k < n; k++) sum += SPHPairLaplacian(row[k], pi, p[list[k]]);
      out[i] = factor * (scale ? scale[i] : 1.0) * (double)sum;
    }
  }
}

/* vector_i = sum_j (p_j - p_i) m grad W_ij */
static void Difference(const SPHLoops *l)
{
  const real *p = (const real *)l->pressure, *gradient = (const real *)l->gradient;
  real       *a = (real *)l->vector;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i], n = l->count[i];
      const real *g = gradient + 3 * (size_t)l->start[i], pi = p[i];
      Vec4        s0 = {0}, s1 = {0};
      int         k = 0;

      for (; k + 2 <= n; k += 2, g += 6) {
        s0 += (p[list[k]] - pi) * Load4(g);
        s1 += (p[list[k + 1]] - pi) * Load4(g + 3);
      }
      if (k < n) s0 += (p[list[k]] - pi) * Load4(g);
      Store4(a + 4 * (size_t)i, s0 + s1);
    }
  }
}

/* how far the vector of particle i is from those around it, weighted by compact */
static void Deviation(const SPHLoops *l, int i, double out[3])
{
  const real *v = (const real *)l->vector, *row = (const real *)l->compact + l->start[i];
  const int  *list = l->neighbour + l->start[i];
  const Vec4  vi   = Load4(v + 4 * (size_t)i);
  Vec4        sum  = {0};
  real        all  = 0;

  for (int k = 0; k < l->count[i]; k++) {
    sum += row[k] * (vi - Load4(v + 4 * (size_t)list[k]));
    all += row[k];
  }
  for (int a = 0; a < 3; a++) out[a] = all > 0 ? (double)(sum[a] / all) : 0.0;
}

/* out_i[3 a + b] = sum_j (v_j - v_i)_a (m grad W_ij)_b of vector; deviation may be NULL */
static void VelocityGradient(const SPHLoops *l, double out[], double deviation[])
{
  const real *v = (const real *)l->vector, *gradient = (const real *)l->gradient;

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      const int  *list = l->neighbour + l->start[i];
      const real *g = gradient + 3 * (size_t)l->start[i], *vi = v + 4 * (size_t)i;
      Vec4        s0 = {0}, s1 = {0}, s2 = {0};

      for (int k = 0; k < l->count[i]; k++, g += 3) {
        const real *vj = v + 4 * (size_t)list[k];
        const Vec4  w  = Load4(g);

        s0 += (vj[0] - vi[0]) * w;
        s1 += (vj[1] - vi[1]) * w;
        s2 += (vj[2] - vi[2]) * w;
      }
      if (deviation) Deviation(l, i, deviation + 3 * (size_t)i);
      for (int b = 0; b < 3; b++) {
        out[9 * (size_t)i + (size_t)b]     = (double)s0[b];
        out[9 * (size_t)i + (size_t)b + 3] = (double)s1[b];
        out[9 * (size_t)i + (size_t)b + 6] = (double)s2[b];
      }
    }
  }
}

/* out_i = sum_j weight(W_ij/w0) m grad W_ij, n x 3 */
static void Concentration(const SPHLoops *l, double w0, double out[])
{
  const real h = (real)l->h, per_w0 = (real)(1.0 / w0);

#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < Chunks(l); c++) {
    for (int i = c * SPH_PAIR_CHUNK; i < ChunkEnd(l, c); i++) {
      double sum[3] = {0, 0, 0};

      for (int first = 0; first < l->count[i]; first += BLOCK) {
        const int  m = l->count[i] - first < BLOCK ? l->count[i] - first : BLOCK, *list = l->neighbour + l->start[i] + first;
        real       d[3][BLOCK], r2[BLOCK], f[BLOCK], x = 0, y = 0, z = 0;

        Displacements(l, i, list, m, d, r2, f);
#pragma omp simd reduction(+ : x, y, z)
        for (int k = 0; k < ((m + 15) & ~15); k++) {
          const real w = f[k] * SPHPairConcentration(SPHKernelW(l->kernel, SQRT(r2[k]), h) * per_w0);
          x -= w * d[0][k];
          y -= w * d[1][k];
          z -= w * d[2][k];
        }
        sum[0] += (double)x;
        sum[1] += (double)y;
        sum[2] += (double)z;
      }
      for (int a = 0; a < 3; a++) out[3 * (size_t)i + (size_t)a] = sum[a];
    }
  }
}
