/* tled_device.c - the T4 forces on a GPU: arrays in place, then the loops of tled_cuda.cu. */
#include "tled/tled_device.h"
#include "tled/tled_impl.h"
#include "array.h"

struct _TLEDDevice {
  int    n_lanes, n_nodes, has_fibres;
  Array  laws;         /* TLEDLaw of each material                                  */
  Array  material;     /* int, n_packs                                              */
  Array  corner;       /* int, n_packs x 4 x TLED_LANES: node of each corner         */
  Array  G, V0;        /* double, as in TLEDBlocks                                   */
  Array  fibre;        /* double, as in TLEDBlocks; none: has_fibres is 0            */
  Array  offset, list; /* int: the corners 4 lane + a of each node, ascending        */
  Array  corner_force; /* double, n_lanes x 12 [N]                                   */
  Array  u, f;         /* double, n_nodes x 3                                        */
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
  int *corner, *offset, *list;

  PetscFunctionBegin;
  PetscCall(ArrayCreate(sizeof(int), 4 * (size_t)d->n_lanes, &d->corner));
  PetscCall(ArrayCreate(sizeof(int), (size_t)b->n_nodes + 1, &d->offset));
  PetscCall(ArrayCreate(sizeof(int), 4 * (size_t)d->n_lanes, &d->list));
  PetscCall(ArrayHostOverwrite(&d->corner, &corner));
  PetscCall(ArrayHostOverwrite(&d->offset, &offset));
  PetscCall(ArrayHostOverwrite(&d->list, &list));
  PetscCall(PetscArrayzero(offset, b->n_nodes + 1));
  for (int block = 0; block < b->n_blocks; block++)
    for (int k = 4 * TLED_LANES * b->pack_offset[block]; k < 4 * TLED_LANES * b->pack_offset[block + 1]; k++)
      corner[k] = b->node[b->node_offset[block] + b->local[k]];
  for (int pass = 0; pass < 2; pass++) { /* count, then fill */
    for (int l = 0; l < d->n_lanes; l++) {
      for (int a = 0; a < 4 && b->element[l] >= 0; a++) {
        const int node = corner[(4 * (l / TLED_LANES) + a) * TLED_LANES + l % TLED_LANES];
        if (pass) list[offset[node]++] = 4 * l + a;
        else offset[node + 1]++;
      }
    }
    for (int a = 0; a < b->n_nodes && !pass; a++) offset[a + 1] += offset[a];
  }
  for (int a = b->n_nodes; a > 0; a--) offset[a] = offset[a - 1];
  offset[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDDeviceCreate(TLED tled, TLEDDevice *device)
{
  const TLEDBlocks *b = &tled->blocks;
  TLEDDevice        d;

  PetscFunctionBegin;
  PetscCheck(tled->set_up && tled->loops.ops == &TLEDElementT4, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "the device has the forces of the element t4 of a body that is set up");
  PetscCheck(!tled->loops.viscous, PETSC_COMM_SELF, PETSC_ERR_SUP, "the device has no materials with a Prony series");
  PetscCall(PetscNew(&d));
  d->n_lanes = TLED_LANES * b->n_packs;
  d->n_nodes = b->n_nodes;
  PetscCall(FillCorners(b, d));
  PetscCall(FillArray(&d->laws, sizeof(TLEDLaw), (size_t)tled->loops.n_laws, tled->laws));
  PetscCall(FillArray(&d->material, sizeof(int), (size_t)b->n_packs, b->material));
  PetscCall(FillArray(&d->G, sizeof(double), 9 * (size_t)d->n_lanes, b->G));
  d->has_fibres = b->fibre != NULL;
  PetscCall(FillArray(&d->fibre, sizeof(double), 3 * (size_t)d->n_lanes, b->fibre));
  PetscCall(FillArray(&d->V0, sizeof(double), (size_t)d->n_lanes, b->V0));
  PetscCall(FillArray(&d->corner_force, sizeof(double), 12 * (size_t)d->n_lanes, NULL));
  PetscCall(FillArray(&d->u, sizeof(double), 3 * (size_t)d->n_nodes, NULL));
  PetscCall(FillArray(&d->f, sizeof(double), 3 * (size_t)d->n_nodes, NULL));
  *device = d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDDeviceForces(TLEDDevice d, const PetscReal u[], PetscReal f[])
{
#if defined(BYSSUS_HAVE_CUDA)
  const TLEDLaw *laws;
  const int    *material, *corner, *offset, *list;
  const double *G, *V0, *from, *fibre = NULL;
  double       *to, *corner_force, *out;
  int           status;

  PetscFunctionBegin;
  PetscCall(ArrayHostOverwrite(&d->u, &to));
  PetscCall(PetscArraycpy(to, u, 3 * d->n_nodes));
  PetscCall(ArrayDeviceRead(&d->laws, &laws));
  PetscCall(ArrayDeviceRead(&d->material, &material));
  PetscCall(ArrayDeviceRead(&d->corner, &corner));
  PetscCall(ArrayDeviceRead(&d->offset, &offset));
  PetscCall(ArrayDeviceRead(&d->list, &list));
  PetscCall(ArrayDeviceRead(&d->G, &G));
  PetscCall(ArrayDeviceRead(&d->V0, &V0));
  if (d->has_fibres) PetscCall(ArrayDeviceRead(&d->fibre, &fibre));
  PetscCall(ArrayDeviceRead(&d->u, &from));
  PetscCall(ArrayDeviceOverwrite(&d->corner_force, &corner_force));
  PetscCall(ArrayDeviceOverwrite(&d->f, &out));
  status = TLEDElementForces_CUDA(laws, material, d->n_lanes, corner, G, V0, fibre, from, corner_force);
  PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_GPU, "TLEDElementForces_CUDA failed with CUDA status %d", status);
  status = TLEDGatherForces_CUDA(d->n_nodes, offset, list, corner_force, out);
  PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_GPU, "TLEDGatherForces_CUDA failed with CUDA status %d", status);
  PetscCall(ArrayHostRead(&d->f, &from));
  PetscCall(PetscArraycpy(f, from, 3 * d->n_nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
#else
  PetscFunctionBegin;
  (void)d, (void)u, (void)f;
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_SUP, "this program was built without CUDA");
#endif
}

PetscErrorCode TLEDDeviceDestroy(TLEDDevice *device)
{
  TLEDDevice d = *device;

  PetscFunctionBegin;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayDestroy(&d->laws));
  PetscCall(ArrayDestroy(&d->material));
  PetscCall(ArrayDestroy(&d->corner));
  PetscCall(ArrayDestroy(&d->offset));
  PetscCall(ArrayDestroy(&d->list));
  PetscCall(ArrayDestroy(&d->G));
  PetscCall(ArrayDestroy(&d->V0));
  PetscCall(ArrayDestroy(&d->fibre));
  PetscCall(ArrayDestroy(&d->corner_force));
  PetscCall(ArrayDestroy(&d->u));
  PetscCall(ArrayDestroy(&d->f));
  PetscCall(PetscFree(d));
  *device = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
