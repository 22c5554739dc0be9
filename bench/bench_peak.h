/* bench_peak.h - what this machine can do at most: arithmetic in registers, and moving numbers from memory. */
#ifndef BY_BENCH_PEAK_H
#define BY_BENCH_PEAK_H

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
  int    threads;
  double gflops; /* multiply-adds in registers, two flops each, double precision */
  double gbytes; /* triad, 24 bytes an iteration as STREAM counts                */
} Peak;

/* eight doubles: a register of AVX-512, two of AVX2 */
typedef double PeakVector __attribute__((vector_size(64)));

#define PEAK_CHAINS  12      /* independent chains: latency 4 to 5 cycles times 2 units a cycle       */
#define PEAK_ROUNDS  8000000 /* of all chains                                                          */
#define PEAK_NUMBERS (1 << 25) /* of each array of the triad: 268 MB, far beyond any cache              */

/* x <- x c + s in independent chains; the sum keeps the compiler from dropping it */
static double PeakChains(long rounds)
{
  PeakVector       x[PEAK_CHAINS], sum = {0.0};
  const PeakVector c = {0.999999, 0.999999, 0.999999, 0.999999, 0.999999, 0.999999, 0.999999, 0.999999}, s = c * 1e-6;

  for (int k = 0; k < PEAK_CHAINS; k++) x[k] = c + 1e-3 * k;
  for (long r = 0; r < rounds; r++) {
#pragma GCC unroll 12
    for (int k = 0; k < PEAK_CHAINS; k++) x[k] = x[k] * c + s;
  }
  for (int k = 0; k < PEAK_CHAINS; k++) sum += x[k];
  return sum[0] + sum[7];
}

/* best of a few: what others do on the machine only lengthens it */
static double PeakArithmetic(int threads, double *keep)
{
  double best = 1e300, total = 0.0;

  for (int repeat = 0; repeat < 5; repeat++) {
    const double start = omp_get_wtime();

#pragma omp parallel num_threads(threads) reduction(+ : total)
    total += PeakChains(PEAK_ROUNDS);
    const double seconds = omp_get_wtime() - start;
    if (seconds < best) best = seconds;
  }
  *keep += total;
  return 1e-9 * 2.0 * 8.0 * PEAK_CHAINS * PEAK_ROUNDS * threads / best;
}

static double PeakTriad(int threads, double *a, double *b, double *c)
{
  double best = 1e300;

  for (int repeat = 0; repeat < 6; repeat++) {
    const double start = omp_get_wtime();

#pragma omp parallel for simd num_threads(threads) schedule(static)
    for (long k = 0; k < PEAK_NUMBERS; k++) a[k] = b[k] + 3.0 * c[k];
    const double seconds = omp_get_wtime() - start;
    if (repeat && seconds < best) best = seconds;
  }
  return 1e-9 * 24.0 * PEAK_NUMBERS / best;
}

/* peak[0] on one thread, peak[1] on all (the same on a machine with one) */
static void PeakMeasure(Peak peak[2])
{
  double *arrays = malloc(3 * sizeof(double) * PEAK_NUMBERS), keep = 0.0;

  if (!arrays) {
    fprintf(stderr, "no memory for the triad\n");
    exit(1);
  }
#pragma omp parallel for schedule(static)
  for (long k = 0; k < PEAK_NUMBERS; k++) {
    arrays[k]                    = 0.0;
    arrays[PEAK_NUMBERS + k]     = 1.0;
    arrays[2 * PEAK_NUMBERS + k] = 2.0;
  }
  printf("%8s %22s %26s\n", "threads", "multiply-add, Gflop/s", "triad a = b + s c, GB/s");
  for (int t = 0; t < 2; t++) {
    peak[t].threads = t ? omp_get_num_procs() : 1;
    peak[t].gflops  = PeakArithmetic(peak[t].threads, &keep);
    peak[t].gbytes  = PeakTriad(peak[t].threads, arrays, arrays + PEAK_NUMBERS, arrays + 2 * PEAK_NUMBERS);
    printf("%8d %22.1f %26.1f\n", peak[t].threads, peak[t].gflops, peak[t].gbytes);
    if (omp_get_num_procs() == 1) {
      peak[1] = peak[0];
      break;
    }
  }
  if (keep == 0.0) printf("\n"); /* never: the sum is used */
  fflush(stdout);
  free(arrays);
}

#endif
