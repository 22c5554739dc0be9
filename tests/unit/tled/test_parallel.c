/* mpirun -n 2: the implicit solver on all ranks gives on each the state that it gives on one rank alone, with a direct solver and with
   multigrid; so do the modes. */
#include "unit/tled/body.h"
#include "tled/tled_implicit.h"

#define MULTIGRID "-body_implicit_direct_below 0 -body_implicit_pc_gamg_coarse_eq_limit 200" /* two levels of 579 unknowns */
#define SAME 1e-10 /* of the largest displacement */

typedef struct {
  const char *name, *options; /* of the solver */
  int         element;
  double      poisson;
  PetscBool   dynamic;
} Case;

static const Case cases[] = {
    {"t4, direct", "", TLED_ELEMENT_T4, 0.3, PETSC_FALSE},
    {"anp, direct", "", TLED_ELEMENT_ANP, 0.45, PETSC_FALSE},
    {"t4, multigrid", MULTIGRID, TLED_ELEMENT_T4, 0.3, PETSC_FALSE},
    {"anp, multigrid", MULTIGRID, TLED_ELEMENT_ANP, 0.45, PETSC_FALSE},
    {"t4 in time, direct", "", TLED_ELEMENT_T4, 0.3, PETSC_TRUE},
    {"t4 in time, multigrid", MULTIGRID, TLED_ELEMENT_T4, 0.3, PETSC_TRUE},
};

static TLED Solved(const Case *c, MPI_Comm comm, TLEDImplicitStats *it)
{
  const PetscReal     g[3] = {0.0, 0.0, -9.81};
  TLEDParams         *p;
  TLED                tled = NewBody("tests/meshes/beam_h1.msh", &p);
  TLEDImplicit        implicit;
  TLEDImplicitParams *ip;

  p->elastic.poisson = c->poisson;
  p->element         = c->element;
  AddName(&p->fixed, "clamp");
  assert_petsc(TLEDSetGravity(tled, g));
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(PetscOptionsInsertString(NULL, c->options));
  assert_petsc(TLEDImplicitCreate(comm, tled, &implicit));
  assert_petsc(TLEDImplicitSetFromOptions(implicit));
  assert_petsc(TLEDImplicitGetParams(implicit, &ip));
  ip->tolerance = 1e-12;
  if (c->dynamic) assert_petsc(TLEDImplicitAdvance(implicit, 0.005, 8));
  else assert_petsc(TLEDImplicitSolveStatic(implicit, 0.0));
  assert_petsc(TLEDImplicitGetStats(implicit, it));
  assert_petsc(TLEDImplicitDestroy(&implicit));
  assert_petsc(PetscOptionsClearValue(NULL, "-body_implicit_direct_below"));
  assert_petsc(PetscOptionsClearValue(NULL, "-body_implicit_pc_gamg_coarse_eq_limit"));
  return tled;
}

static PetscReal Difference(TLED one, TLED other, PetscInt which, PetscReal *size)
{
  Vec              a[2], b[2];
  const PetscReal *x, *y;
  PetscReal        worst = 0.0;
  PetscInt         n;

  assert_petsc(TLEDGetVectors(one, &a[0], &a[1], NULL));
  assert_petsc(TLEDGetVectors(other, &b[0], &b[1], NULL));
  assert_petsc(VecGetSize(a[which], &n));
  assert_petsc(VecGetArrayRead(a[which], &x));
  assert_petsc(VecGetArrayRead(b[which], &y));
  *size = 0.0;
  for (PetscInt k = 0; k < n; k++) worst = fmax(worst, fabs(x[k] - y[k])), *size = fmax(*size, fabs(x[k]));
  assert_petsc(VecRestoreArrayRead(a[which], &x));
  assert_petsc(VecRestoreArrayRead(b[which], &y));
  return worst;
}

static void AllRanks_GiveTheAnswerOfOne(void **state)
{
  PetscMPIInt size, rank;

  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    TLEDImplicitStats alone_it, all_it;
    TLED              alone = Solved(&cases[i], PETSC_COMM_SELF, &alone_it), all = Solved(&cases[i], PETSC_COMM_WORLD, &all_it);
    PetscReal         u, v, u_size, v_size;

    u = Difference(alone, all, 0, &u_size);
    v = Difference(alone, all, 1, &v_size);
    if (!rank)
      printf("%d ranks, %s: u within %.1e of one rank's; %d and %d Newton iterations, %d and %d linear\n", size, cases[i].name, u / u_size,
             (int)alone_it.newton, (int)all_it.newton, (int)alone_it.linear, (int)all_it.linear);
    assert_close(u, 0.0, SAME, u_size);
    if (cases[i].dynamic) assert_close(v, 0.0, SAME, v_size);
    assert_petsc(TLEDDestroy(&alone));
    assert_petsc(TLEDDestroy(&all));
  }
}

static void Modes_AreThoseOfOneRank(void **state)
{
  TLEDParams *p;
  TLED        tled = NewBody("tests/meshes/beam_h1.msh", &p);
  PetscReal   one[4], all[4], *shapes, *own;
  PetscInt    n;
  PetscBool   have;

  (void)state;
  assert_petsc(TLEDHaveModes(&have));
  if (!have) skip();
  AddName(&p->fixed, "clamp");
  assert_petsc(TLEDSetUp(tled));
  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(PetscMalloc2(12 * n, &shapes, 12 * n, &own));
  assert_petsc(TLEDModes(PETSC_COMM_SELF, tled, 4, one, own));
  assert_petsc(TLEDModes(PETSC_COMM_WORLD, tled, 4, all, shapes));
  for (int k = 0; k < 4; k++) assert_close(all[k], one[k], 1e-9, one[k]);
  for (PetscInt k = 0; k < 12 * n; k++) assert_close(shapes[k], own[k], 1e-5, 1.0); /* kg^-1/2; the lowest two are 0.8 % apart */
  assert_petsc(PetscFree2(shapes, own));
  assert_petsc(TLEDDestroy(&tled));
}

CHECK_MAIN(cmocka_unit_test(AllRanks_GiveTheAnswerOfOne), cmocka_unit_test(Modes_AreThoseOfOneRank))
