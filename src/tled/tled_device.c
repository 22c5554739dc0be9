/* tled_device.c - the forces on a GPU: arrays in place, then the passes of an element by the loops of tled_cuda.cu. */
#include "tled/tled_device.h"
#include "tled/tled_impl.h"
#include "array.h"

_Static_assert(TLED_DEVICE_LANES == TLED_LANES, "the device's loops read the CPU's packs");

/* the passes of an element, in order; each reads what those before it wrote */
static const int t4_passes[]  = {TLED_PASS_FORCES_T4, TLED_PASS_GATHER};
static const int anp_passes[] = {TLED_PASS_VOLUMES, TLED_PASS_MEAN_VOLUME, TLED_PASS_PRESSURES, TLED_PASS_MEAN_PRESSURE,
                                 TLED_PASS_FORCES_ANP, TLED_PASS_GATHER};
static const int t10_passes[] = {TLED_PASS_FORCES_T10, TLED_PASS_GATHER};

/* Members of the same names as in TLEDThreads; an array that the body has no use for is empty. */
struct _TLEDDevice {
  TLEDThreads sizes; /* its numbers, no pointers */
  const int  *passes;
  int         n_passes;
  Array       laws, material, corner, first_point, offset, list;
  Array       G, V0, fibre, weight, u;
  Array       value, volume, pressure, corner_force, force;
};

static PetscErrorCode FillArray(Array *array, size_t element, size_t n, const void *from)
{
  void *to;

  PetscFunctionBegin;
  PetscCall(ArrayCreate(element, n, array));
  if (!from) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayHostOverwrite(array, &to));
  PetscCall(PetscMemcpy(to, from, element * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* nodes of the lanes' corners, and the corners of each node; padding belongs to node 0 of its block with forces that are zero, and
   is left out of the lists */
static PetscErrorCode FillCorners(const TLEDBlocks *b, TLEDDevice d)
{
  const int n_corners = b->n_corners, n_lanes = TLED_LANES * b->n_packs;
  int      *corner, *offset, *list;

  PetscFunctionBegin;
  PetscCall(ArrayCreate(sizeof(int), (size_t)n_corners * n_lanes, &d->corner));
  PetscCall(ArrayCreate(sizeof(int), (size_t)b->n_nodes + 1, &d->offset));
  PetscCall(ArrayCreate(sizeof(int), (size_t)n_corners * n_lanes, &d->list));
  PetscCall(ArrayHostOverwrite(&d->corner, &corner));
  PetscCall(ArrayHostOverwrite(&d->offset, &offset));
  PetscCall(ArrayHostOverwrite(&d->list, &list));
  PetscCall(PetscArrayzero(offset, b->n_nodes + 1));
  PetscCall(PetscArrayzero(list, n_corners * n_lanes)); /* padding leaves places at the end */
  for (int block = 0; block < b->n_blocks; block++)
    for (int k = n_corners * TLED_LANES * b->pack_offset[block]; k < n_corners * TLED_LANES * b->pack_offset[block + 1]; k++)
      corner[k] = b->node[b->node_offset[block] + b->local[k]];
  for (int pass = 0; pass < 2; pass++) { /* count, then fill */
    for (int l = 0; l < n_lanes; l++) {
      for (int a = 0; a < n_corners && b->element[l] >= 0; a++) {
        const int node = corner[(n_corners * (l / TLED_LANES) + a) * TLED_LANES + l % TLED_LANES];
        if (pass) list[offset[node]++] = n_corners * l + a;
        else offset[node + 1]++;
      }
    }
    for (int a = 0; a < b->n_nodes && !pass; a++) offset[a + 1] += offset[a];
  }
  for (int a = b->n_nodes; a > 0; a--) offset[a] = offset[a - 1];
  offset[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the body has the element and the materials that the loops know */
static PetscErrorCode CheckBody(TLED tled, TLEDDevice d)
{
  PetscFunctionBegin;
  PetscCheck(tled->set_up, PETSC_COMM_SELF, PETSC_ERR_ORDER, "the device takes a body that is set up");
  for (int k = 0; k < tled->loops.n_laws; k++)
    PetscCheck(!tled->laws[k].n_prony, PETSC_COMM_SELF, PETSC_ERR_SUP,
               "%s%s%s has a Prony series (prony_alpha, prony_tau): the device's loops have elastic materials only, use the CPU's",
               ((PetscObject)tled)->name, k ? "." : "", k ? tled->material_name[k] : "");
  if (tled->loops.ops == &TLEDElementT4) {
    d->passes   = t4_passes;
    d->n_passes = PETSC_STATIC_ARRAY_LENGTH(t4_passes);
  } else if (tled->loops.ops == &TLEDElementANP) {
    d->passes   = anp_passes;
    d->n_passes = PETSC_STATIC_ARRAY_LENGTH(anp_passes);
  } else {
    PetscCheck(tled->loops.ops == &TLEDElementT10, PETSC_COMM_SELF, PETSC_ERR_SUP, "the device has no element %s", tled->loops.ops->name);
    d->passes   = t10_passes;
    d->n_passes = PETSC_STATIC_ARRAY_LENGTH(t10_passes);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillDevice(TLED tled, TLEDDevice d)
{
  const TLEDBlocks *b       = &tled->blocks;
  const size_t      n_packs = (size_t)b->n_packs, n_lanes = TLED_LANES * n_packs, n_nodes = (size_t)b->n_nodes;
  const size_t      n_jacobians = b->n_corners == 10 ? (size_t)b->first_point[n_packs] : n_packs;
  const size_t      averaged = tled->loops.ops->averaged != 0, n_averages = averaged * n_nodes * (size_t)tled->loops.n_laws;

  PetscFunctionBegin;
  d->sizes.n_lanes   = (int)n_lanes;
  d->sizes.n_nodes   = b->n_nodes;
  d->sizes.n_laws    = tled->loops.n_laws;
  d->sizes.n_corners = b->n_corners;
  d->sizes.n_points  = b->n_points;
  PetscCall(FillCorners(b, d));
  PetscCall(FillArray(&d->laws, sizeof(TLEDLaw), (size_t)tled->loops.n_laws, tled->laws));
  PetscCall(FillArray(&d->material, sizeof(int), n_packs, b->material));
  PetscCall(FillArray(&d->first_point, sizeof(int), n_packs + 1, b->first_point));
  PetscCall(FillArray(&d->G, sizeof(double), 9 * TLED_LANES * n_jacobians, b->G));
  PetscCall(FillArray(&d->V0, sizeof(double), n_lanes * b->n_points, b->V0));
  PetscCall(FillArray(&d->fibre, sizeof(double), b->fibre ? 3 * n_lanes : 0, b->fibre));
  PetscCall(FillArray(&d->weight, sizeof(double), n_averages, averaged ? tled->loops.weight : NULL));
  PetscCall(FillArray(&d->u, sizeof(double), 3 * n_nodes, NULL));
  PetscCall(FillArray(&d->value, sizeof(double), averaged * n_lanes, NULL));
  PetscCall(FillArray(&d->volume, sizeof(double), n_averages, NULL));
  PetscCall(FillArray(&d->pressure, sizeof(double), n_averages, NULL));
  PetscCall(FillArray(&d->corner_force, sizeof(double), 3 * b->n_corners * n_lanes, NULL));
  PetscCall(FillArray(&d->force, sizeof(double), 3 * n_nodes, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDDeviceCreate(TLED tled, TLEDDevice *device)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(device));
  PetscErrorCode ierr = CheckBody(tled, *device);
  if (!ierr) ierr = FillDevice(tled, *device);
  if (ierr) (void)TLEDDeviceDestroy(device);
  PetscFunctionReturn(ierr);
}

/* pointer to an array on one side, which is read, or written all over; an empty one stays NULL */
static PetscErrorCode Lend(Array *array, PetscBool on_device, PetscBool written, void *p)
{
  PetscFunctionBegin;
  if (!array->n) PetscFunctionReturn(PETSC_SUCCESS);
  if (on_device) PetscCall(written ? ArrayDeviceOverwrite(array, p) : ArrayDeviceRead(array, p));
  else PetscCall(written ? ArrayHostOverwrite(array, p) : ArrayHostRead(array, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what the threads read and write on one side, at displacement u */
static PetscErrorCode LendAll(TLEDDevice d, PetscBool on_device, const PetscReal u[], TLEDThreads *t)
{
  double *to;

  PetscFunctionBegin;
  PetscCall(ArrayHostOverwrite(&d->u, &to));
  PetscCall(PetscArraycpy(to, u, 3 * d->sizes.n_nodes));
  *t = d->sizes;
  PetscCall(Lend(&d->laws, on_device, PETSC_FALSE, &t->laws));
  PetscCall(Lend(&d->material, on_device, PETSC_FALSE, &t->material));
  PetscCall(Lend(&d->corner, on_device, PETSC_FALSE, &t->corner));
  PetscCall(Lend(&d->first_point, on_device, PETSC_FALSE, &t->first_point));
  PetscCall(Lend(&d->offset, on_device, PETSC_FALSE, &t->offset));
  PetscCall(Lend(&d->list, on_device, PETSC_FALSE, &t->list));
  PetscCall(Lend(&d->G, on_device, PETSC_FALSE, &t->G));
  PetscCall(Lend(&d->V0, on_device, PETSC_FALSE, &t->V0));
  PetscCall(Lend(&d->fibre, on_device, PETSC_FALSE, &t->fibre));
  PetscCall(Lend(&d->weight, on_device, PETSC_FALSE, &t->weight));
  PetscCall(Lend(&d->u, on_device, PETSC_FALSE, &t->u));
  PetscCall(Lend(&d->value, on_device, PETSC_TRUE, &t->value));
  PetscCall(Lend(&d->volume, on_device, PETSC_TRUE, &t->volume));
  PetscCall(Lend(&d->pressure, on_device, PETSC_TRUE, &t->pressure));
  PetscCall(Lend(&d->corner_force, on_device, PETSC_TRUE, &t->corner_force));
  PetscCall(Lend(&d->force, on_device, PETSC_TRUE, &t->force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the passes one after the other, then f on the host */
static PetscErrorCode RunPasses(TLEDDevice d, PetscBool on_device, TLEDPassRun run, const PetscReal u[], PetscReal f[])
{
  TLEDThreads   threads;
  const double *from;

  PetscFunctionBegin;
  PetscCall(LendAll(d, on_device, u, &threads));
  for (int p = 0; p < d->n_passes; p++) {
    const int status = run(&threads, d->passes[p]);
    PetscCheck(!status, PETSC_COMM_SELF, on_device ? PETSC_ERR_GPU : PETSC_ERR_LIB, "pass %d of the loops failed with status %d",
               d->passes[p], status);
  }
#if defined(BYSSUS_HAVE_CUDA)
  if (on_device) {
    const int status = TLEDWait_CUDA();
    PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_GPU, "the loops failed with CUDA status %d", status);
  }
#endif
  PetscCall(ArrayHostRead(&d->force, &from));
  PetscCall(PetscArraycpy(f, from, 3 * d->sizes.n_nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDDeviceForces(TLEDDevice d, const PetscReal u[], PetscReal f[])
{
  PetscFunctionBegin;
#if defined(BYSSUS_HAVE_CUDA)
  PetscCall(RunPasses(d, PETSC_TRUE, TLEDPass_CUDA, u, f));
  PetscFunctionReturn(PETSC_SUCCESS);
#else
  (void)d, (void)u, (void)f;
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_SUP, "this program was built without CUDA");
#endif
}

PetscErrorCode TLEDDeviceForcesOnHost(TLEDDevice d, TLEDPassRun run, const PetscReal u[], PetscReal f[])
{
  PetscFunctionBegin;
  PetscCall(RunPasses(d, PETSC_FALSE, run, u, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDDeviceDestroy(TLEDDevice *device)
{
  TLEDDevice d = *device;

  PetscFunctionBegin;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  Array *const arrays[] = {&d->laws,   &d->material, &d->corner, &d->first_point, &d->offset, &d->list,     &d->G,            &d->V0,
                           &d->fibre,  &d->weight,   &d->u,      &d->value,       &d->volume, &d->pressure, &d->corner_force, &d->force};
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(arrays); k++) PetscCall(ArrayDestroy(arrays[k]));
  PetscCall(PetscFree(d));
  *device = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
