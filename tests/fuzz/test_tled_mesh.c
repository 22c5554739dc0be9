/* Damaged gmsh files: whatever happens to the bytes of a mesh, reading it ends in a body or in a report, never in a crash. Run it
   under AddressSanitizer to make reads beyond an array visible. */
#include "unit/tled/cube.h"

#define N_DAMAGES 1500

static unsigned Random(unsigned *seed)
{
  *seed = 1664525u * *seed + 1013904223u;
  return *seed >> 8;
}

/* change, drop, double or cut something of text (n bytes, room for twice as many) */
static size_t Damage(char text[], size_t n, unsigned *seed)
{
  static const char letters[] = "0123456789-. \n$e";
  const size_t      at = Random(seed) % n, length = 1 + Random(seed) % 8;

  switch (Random(seed) % 5) {
  case 0:
    text[at] = letters[Random(seed) % (sizeof letters - 1)];
    return n;
  case 1:
    text[at] = (char)Random(seed);
    return n;
  case 2: /* drop a few bytes */
    if (at + length >= n) return n;
    memmove(text + at, text + at + length, n - at - length);
    return n - length;
  case 3: /* write a few bytes twice */
    if (at + length >= n) return n;
    memmove(text + at + length, text + at, n - at);
    return n + length;
  default:
    return Random(seed) % 8 ? n : at + 1;
  }
}

/* damage a whole file in many ways, read each */
static void ReadDamaged(const char path[], unsigned *seed, int *n_read, int *n_reported)
{
  static char whole[16384], text[32768];
  FILE       *null = fopen("/dev/null", "w"), *f = fopen(path, "r");
  const size_t size = fread(whole, 1, sizeof whole, f);

  fclose(f);
  assert_true(size < sizeof whole);
  for (int k = 0; k < N_DAMAGES; k++) {
    TLEDParams    *p;
    TLED           tled = NewBody("", &p);
    PetscErrorCode ierr;
    size_t         n   = size;
    const int      old = dup(2);

    memcpy(text, whole, size);
    for (unsigned d = 0; d <= Random(seed) % 3; d++) n = Damage(text, n, seed);
    f = fopen(path, "w");
    fwrite(text, 1, n, f);
    fclose(f);
    snprintf(p->mesh, sizeof p->mesh, "%s", path);
    p->element = TLED_ELEMENT_AUTO;
    AddName(&p->fixed, "floor");
    fflush(stderr);
    dup2(fileno(null), 2);
    ierr = TLEDSetUp(tled);
    fflush(stderr);
    dup2(old, 2);
    close(old);
    if (ierr && ierr != BY_ERR_INPUT) fail_msg("damage %d: error %d, neither read nor reported", k, (int)ierr);
    *n_read += !ierr, *n_reported += ierr != 0;
    assert_petsc(TLEDDestroy(&tled));
  }
  fclose(null);
}

static void DamagedMesh_IsReadOrReported(void **state)
{
  char     path[256];
  unsigned seed   = 1;
  int      n_read = 0, n_reported = 0;

  (void)state;
  snprintf(path, sizeof path, "/tmp/byssus_fuzz_mesh_%d.msh", (int)getpid());
  for (int i = 0; i < 6; i++) { /* both formats: linear text, quadratic text, quadratic binary */
    const CubeFile file = {i % 2 ? 22 : 41, i / 2 == 2, 0.0, 1};
    if (i < 2) WriteCube(path, file.version, 0, 0, NULL);
    else WriteCube2(path, &file);
    ReadDamaged(path, &seed, &n_read, &n_reported);
  }
  unlink(path);
  printf("%d files read all the same, %d reported\n", n_read, n_reported);
  assert_true(n_read > 100 && n_reported > 1000);
}

CHECK_MAIN(cmocka_unit_test(DamagedMesh_IsReadOrReported))
