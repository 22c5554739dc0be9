/* device.h - bodies for the tests of the device's loops: every element and rule, straight and curved, of two materials each, with
   fibres that differ from element to element; and what forces on them must be. */
#ifndef BY_TEST_DEVICE_H
#define BY_TEST_DEVICE_H

#include "unit/tled/block.h"
#include "tled/tled_device.h"

/* A kind of body. The half of a curved one is straight, so that both kinds of packs are there. */
typedef struct {
  const char *name;
  int         element, quadrature;
  double      bend; /* [m] */
} DeviceBody;

static const DeviceBody device_bodies[] = {
  {"t4", TLED_ELEMENT_T4, TLED_QUADRATURE_4, 0.0},
  {"anp", TLED_ELEMENT_ANP, TLED_QUADRATURE_4, 0.0},
  {"t10, 4 points, straight", TLED_ELEMENT_T10, TLED_QUADRATURE_4, 0.0},
  {"t10, 4 points, half curved", TLED_ELEMENT_T10, TLED_QUADRATURE_4, 0.004},
  {"t10, 14 points, straight", TLED_ELEMENT_T10, TLED_QUADRATURE_14, 0.0},
  {"t10, 14 points, half curved", TLED_ELEMENT_T10, TLED_QUADRATURE_14, 0.004},
};
#define DEVICE_BODIES ((int)(sizeof device_bodies / sizeof *device_bodies))

/* several blocks, and packs that are not full where a block or a material ends; body.h's box without slivers has 4 triangles for each
   pair of squares on its sides, then 6 tetrahedra a cell */
static const int device_cells[3] = {6, 4, 3};
#define DEVICE_TRIANGLES (4 * (6 * 4 + 4 * 3 + 3 * 6))
#define DEVICE_TETS      (6 * 6 * 4 * 3)

/* parameters of a law; `stiff` times as stiff as the reference beam */
static inline void SetLaw(TLEDMaterialParams *m, int law, double stiff)
{
  m->material        = law;
  m->young           = law == TLED_MATERIAL_MOONEY_RIVLIN ? 0.0 : 3e6 * stiff;
  m->c10             = law == TLED_MATERIAL_MOONEY_RIVLIN ? 4e5 * stiff : 0.0;
  m->c01             = law == TLED_MATERIAL_MOONEY_RIVLIN ? 1.8e5 * stiff : 0.0;
  m->fibre_stiffness = law == TLED_MATERIAL_TRANSVERSELY_ISOTROPIC ? 2e6 * stiff : 0.0;
  snprintf(m->fibre_field, sizeof m->fibre_field, "%s", law == TLED_MATERIAL_TRANSVERSELY_ISOTROPIC ? "muscle" : "");
}

/* directions of the fibres, another one in each element */
static inline void AppendFibres(const char path[])
{
  FILE *f = fopen(path, "a");

  assert_non_null(f);
  fprintf(f, "$ElementData\n1\n\"muscle\"\n1\n0.0\n3\n0\n3\n%d\n", DEVICE_TETS);
  for (int e = 0; e < DEVICE_TETS; e++)
    fprintf(f, "%d %.6f %.6f %.6f\n", DEVICE_TRIANGLES + e + 1, 1.0 + sin(e), cos(3.0 * e), 0.1 + sin(5.0 * e));
  fprintf(f, "$EndElementData\n");
  assert_int_equal(fclose(f), 0);
}

/* a body, set up, whose lower half is of the law and the upper of the next one */
static inline TLED NewDeviceBody(const DeviceBody *kind, int law)
{
  const Block        block = {.n = {device_cells[0], device_cells[1], device_cells[2]}, .size = {0.4, 0.25, 0.2}, .n_lower = 2,
                              .order = kind->element == TLED_ELEMENT_T10 ? 2 : 1, .bend = kind->bend};
  TLEDParams        *p;
  TLEDMaterialParams upper;
  TLED               tled = NewBlock(&block, &p);

  AppendFibres(p->mesh);
  p->element    = kind->element;
  p->quadrature = kind->quadrature;
  SetLaw(&p->elastic, law, 1.0);
  upper           = p->elastic;
  upper.volumes.n = 0;
  upper.poisson   = 0.45;
  SetLaw(&upper, (law + 1) % (TLED_MATERIAL_TRANSVERSELY_ISOTROPIC + 1), 7.0);
  AddName(&upper.volumes, "upper");
  assert_petsc(TLEDAddMaterial(tled, "stiffer", &upper));
  assert_petsc(TLEDSetUp(tled));
  RemoveBlock(p);
  return tled;
}

static double device_amplitude = 1.0;

static inline void DeviceBend(const PetscReal X[3], PetscReal u[3])
{
  u[0] = device_amplitude * (-0.3 * X[0] * X[2] + 0.02 * sin(9 * X[1]));
  u[1] = device_amplitude * (0.05 * X[1] * X[0] + 0.02 * sin(8 * X[1] + 5 * X[2]));
  u[2] = device_amplitude * (-0.25 * X[0] * X[0] + 0.03 * cos(7 * X[2]));
}

typedef PetscErrorCode (*DeviceForces)(TLEDDevice device, const PetscReal u[], PetscReal f[]);

/* The first of the functions gives the CPU's forces to 1e-12 of the largest: some 1e2 operations of 1e-16 a contribution, fused and
   added in another order, 4 to 14 points and up to 24 elements a node. The others give the same bits as the first. */
static inline void CheckDeviceForces(TLED tled, const char name[], int law, int n_functions, const DeviceForces functions[])
{
  TLEDDevice       device;
  Vec              u, f;
  const PetscReal *ua, *fa;
  PetscReal       *first, *other, top;
  PetscInt         n;

  assert_petsc(TLEDGetSize(tled, &n, NULL));
  assert_petsc(TLEDGetVectors(tled, &u, NULL, NULL));
  assert_petsc(VecDuplicate(u, &f));
  SetVec(tled, u, DeviceBend);
  assert_petsc(TLEDInternalForce(tled, u, f));
  assert_petsc(VecNorm(f, NORM_INFINITY, &top));
  assert_true(top > 1.0); /* [N] */
  assert_petsc(PetscMalloc2(3 * n, &first, 3 * n, &other));
  assert_petsc(TLEDDeviceCreate(tled, &device));
  assert_petsc(VecGetArrayRead(u, &ua));
  assert_petsc(VecGetArrayRead(f, &fa));
  assert_petsc(functions[0](device, ua, first));
  for (PetscInt k = 0; k < 3 * n; k++) {
    if (!(fabs(first[k] - fa[k]) <= 1e-12 * ToleranceScale() * top))
      fail_msg("%s, law %d, amplitude %g, node %d: force %.16g, on the CPU %.16g, largest %g", name, law, device_amplitude, (int)k / 3,
               first[k], fa[k], top);
  }
  for (int i = 1; i < n_functions; i++) {
    assert_petsc(functions[i](device, ua, other));
    assert_memory_equal(other, first, 3 * (size_t)n * sizeof *other);
  }
  assert_petsc(VecRestoreArrayRead(u, &ua));
  assert_petsc(VecRestoreArrayRead(f, &fa));
  assert_petsc(TLEDDeviceDestroy(&device));
  assert_petsc(PetscFree2(first, other));
  assert_petsc(VecDestroy(&f));
}

/* the same for all bodies and laws, at small and large displacements */
static inline void CheckDeviceBodies(int n_functions, const DeviceForces functions[])
{
  for (int k = 0; k < DEVICE_BODIES; k++) {
    for (int law = 0; law <= TLED_MATERIAL_TRANSVERSELY_ISOTROPIC; law++) {
      TLED tled = NewDeviceBody(&device_bodies[k], law);
      for (device_amplitude = 0.05; device_amplitude < 1.1; device_amplitude += 0.95)
        CheckDeviceForces(tled, device_bodies[k].name, law, n_functions, functions);
      assert_petsc(TLEDDestroy(&tled));
    }
  }
}

#endif
