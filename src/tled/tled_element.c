/* tled_element.c - the kinds of elements, which of them a body has, and one integration point of an element for the loops that are
   not part of a step. */
#include "tled/tled_impl.h"
#include "tled/tled_t10.h"

/* linear tetrahedra: the gradients of nodes 1 to 3 are stored, that of node 0 is minus their sum */
static void PointLinear(const TLEDBlocks *b, int l, int point, double G[], double *V0)
{
  const int pack = l / TLED_LANES, lane = l % TLED_LANES;

  (void)point; /* the only one */
  for (int k = 0; k < 9; k++) G[3 + k] = b->G[(9 * pack + k) * TLED_LANES + lane];
  for (int k = 0; k < 3; k++) G[k] = -(G[3 + k] + G[6 + k] + G[9 + k]);
  *V0 = b->V0[l];
}

/* ten-node tetrahedra: Jinv is stored, and the weight times the Jacobian as volume of the point */
static void PointQuadratic(const TLEDBlocks *b, int l, int point, double G[], double *V0)
{
  const int pack = l / TLED_LANES, lane = l % TLED_LANES, place = (b->n_points * pack + point) * TLED_LANES;
  const int jacobian = TLEDJacobianPlace(b, pack, point);
  double    L[4], Jinv[9];

  (void)TLEDQuadratureT10(b->n_points, point, L);
  for (int k = 0; k < 9; k++) Jinv[k] = b->G[(9 * jacobian + k) * TLED_LANES + lane];
  TLEDGradientsT10(L, Jinv, G);
  *V0 = b->V0[place + lane];
}

const TLEDElementOps TLEDElementT4  = {"t4", 4, 0, TLEDForcesT4_OpenMP, PointLinear};
const TLEDElementOps TLEDElementANP = {"anp", 4, 1, TLEDForcesANP_OpenMP, PointLinear};
const TLEDElementOps TLEDElementT10 = {"t10", 10, 0, TLEDForcesT10_OpenMP, PointQuadratic};

/*
  TLEDElementPick_Private - loops->ops from the key `element`, the laws and the mesh, which are known

  Errors: BY_ERR_INPUT, reported: element and order of the mesh disagree
*/
PetscErrorCode TLEDElementPick_Private(TLED tled)
{
  const PetscBool quadratic = (PetscBool)(tled->mesh.n_corners == 10);
  const int       wanted    = tled->params.element;
  PetscBool       soft      = PETSC_FALSE; /* a nearly incompressible material */
  char            key[2 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.element", ((PetscObject)tled)->name));
  if (quadratic && wanted != TLED_ELEMENT_AUTO && wanted != TLED_ELEMENT_T10)
    PetscFunctionReturn(InputError(key, "does not go with the mesh, which is of second order (10-node tetrahedra)\n"
                                        "  expected t10 or auto, or a mesh of first order (gmsh -3 -order 1)"));
  if (!quadratic && wanted == TLED_ELEMENT_T10)
    PetscFunctionReturn(InputError(key, "does not go with the mesh, which is of first order (4-node tetrahedra)\n"
                                        "  expected a mesh of second order: gmsh body.msh -3 -order 2 -o body2.msh"));
  for (PetscInt k = 0; k < tled->n_materials; k++) soft = (PetscBool)(soft || TLEDPoisson(&tled->laws[k]) > 0.4);
  if (quadratic) tled->loops.ops = &TLEDElementT10;
  else if (tled->params.element == TLED_ELEMENT_ANP || (tled->params.element == TLED_ELEMENT_AUTO && soft))
    tled->loops.ops = &TLEDElementANP;
  else tled->loops.ops = &TLEDElementT4;
  tled->loops.anp = tled->loops.ops->averaged;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what TLEDPointAt_Private() needs to know at displacement u before it: the nodal volume ratios, where the element averages them */
void TLEDKnowVolumes_Private(const TLEDLoops *w, const PetscReal u[])
{
  if (!w->ops->averaged) return;
#pragma omp parallel num_threads(TLEDThreads_OpenMP(w))
  TLEDNodalVolumes_OpenMP(w, u);
}

/*
  TLEDPointAt_Private - one integration point of an element at displacement u

  Input Parameters:
+ loops - with the nodal volume ratios at u in loops->nodal (TLEDKnowVolumes_Private()) when the element averages them
. tets  - nodes of all elements
. lane  - place of the element, not padding
. point - number of the integration point
- u     - displacement [m], n_nodes x 3, NULL for the reference state

  Output Parameter:
. p - law, gradients, volume, deformation
*/
void TLEDPointAt_Private(const TLEDLoops *w, const PetscInt tets[], int lane, int point, const double u[], TLEDPoint *p)
{
  const TLEDBlocks *b      = w->blocks;
  const int         n      = w->ops->n_corners;
  const PetscInt   *corner = &tets[n * b->element[lane]];

  TLEDLocalLawAt_Private(w, lane, point, &p->law);
  w->ops->point(b, lane, point, p->G, &p->V0);
  for (int k = 0; k < 9; k++) p->H[k] = 0.0;
  for (int a = 1; a < n && u; a++) /* differences keep the digits of small strains in a body that has moved far */
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) p->H[3 * i + j] += (u[3 * corner[a] + i] - u[3 * corner[0] + i]) * p->G[3 * a + j];
  p->jm1 = TLEDJacobianMinusOne(p->H);
  for (int k = 0; k < 9; k++) p->seen[k] = p->H[k];
  if (w->ops->averaged && u) {
    double jbar = 0.0;
    for (int a = 0; a < 4; a++) jbar += 0.25 * w->nodal[TLEDAverageOf(w, corner[a], b->material[lane / TLED_LANES])];
    (void)TLEDAverageGradient(p->H, 1.0 / (1.0 + p->jm1), 1.0 + jbar, p->seen);
  }
}
