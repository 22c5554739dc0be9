/* sample.c - the program with small tables and a simulation that ends as its scene says: src/main.c is linked to this in place
   of the coupler, so that command line, reports and exit statuses are tested without physics. */
#include "scene.h"

#include <petscksp.h>
#include <stdio.h>

typedef struct {
  PetscReal spacing;
  int       ends;
} SampleParams;

static const char *const ends[] = {"done", "failure", "input", "breakdown", "interrupted", NULL};

static const Key sample_keys[] = {
    {"spacing", KEY_REAL, offsetof(SampleParams, spacing), "m", NULL, 0, PETSC_MAX_REAL, KEY_LO_OPEN | KEY_REQUIRED, NULL,
     "particle spacing"},
    {"ends", KEY_CHOICE, offsetof(SampleParams, ends), "", "done", 0, 0, 0, ends, "how the simulation ends"},
    KEY_END};
static const Key no_keys[] = {KEY_END};

PETSC_VISIBILITY_PUBLIC const SceneSection CouplerSchema[] = {
    {"", no_keys, NULL, NULL, NULL},
    {"sph", sample_keys, NULL, NULL, "the fluid"},
    {NULL, NULL, NULL, NULL, NULL},
};

PetscErrorCode CouplerRun(Scene scene, const char resume[]);
PetscErrorCode CouplerCheck(Scene scene);
PetscErrorCode CouplerVerify(Scene scene, char directory[], PetscBool *picture);

PetscErrorCode CouplerRun(Scene scene, const char resume[])
{
  /* as in coupler.h: BY_ERR_INTERRUPTED is 9004 */
  const PetscErrorCode codes[] = {PETSC_SUCCESS, PETSC_ERR_LIB, BY_ERR_INPUT, BY_ERR_BREAKDOWN, (PetscErrorCode)9004};
  SampleParams         params;
  KSP                  ksp;

  PetscFunctionBegin;
  (void)scene;
  PetscCall(KeysSetDefaults(sample_keys, &params));
  PetscCall(KeysSetFromOptions(sample_keys, "sph_", &params));

  /* a solver, so that options of PETSc's find their reader */
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPDestroy(&ksp));
  printf("spacing %g\n", params.spacing);
  if (resume) printf("resumed from %s\n", resume);
  if (codes[params.ends] == BY_ERR_INPUT)
    PetscFunctionReturn(InputError("sph.spacing", "is too coarse for this body\nexpected at most 0.01"));
  PetscFunctionReturn(codes[params.ends]);
}

PetscErrorCode CouplerCheck(Scene scene)
{
  PetscFunctionBegin;
  (void)scene;
  printf("plan\n");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerVerify(Scene scene, char directory[], PetscBool *picture)
{
  PetscFunctionBegin;
  (void)scene;
  directory[0] = 0;
  *picture     = PETSC_FALSE;
  printf("verified\n");
  PetscFunctionReturn(PETSC_SUCCESS);
}
