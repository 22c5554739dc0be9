/* tled_load.c - loads of the scene on nodes: pressure that follows the surface, tractions, body forces, forces; all that acts on the
   body from outside, and its stiffness. */
#include "tled/tled_impl.h"
#include "tled/tled_load.h"
#include "tled/tled_t10.h"
#include <string.h>

#define ROW(key, type, unit, def, lo, hi, flags, choices, help) {#key, type, offsetof(TLEDLoadParams, key), unit, def, lo, hi, flags, choices, help}

const Key TLEDLoadKeys[] = {
    ROW(groups, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "physical groups of the mesh on which it acts: surfaces, for body_force volumes"),
    ROW(pressure, KEY_REAL, "Pa", "0", -1e15, 1e15, 0, NULL, "against the surface, which it follows as that moves and deforms"),
    ROW(traction, KEY_VEC3, "Pa", "0,0,0", -1e15, 1e15, 0, NULL, "force per area of the undeformed surface"),
    ROW(body_force, KEY_VEC3, "N/m^3", "0,0,0", -1e15, 1e15, 0, NULL, "force per undeformed volume"),
    ROW(force, KEY_VEC3, "N", "0,0,0", -1e15, 1e15, 0, NULL, "total force, the same on every node of the groups, or all on the node at `at`"),
    ROW(at, KEY_REALS, "m", NULL, -1e9, 1e9, 0, NULL, "place in the undeformed body whose nearest node takes the force"),
    COURSE_KEYS(TLEDLoadParams, course),
    KEY_END};

/*@
  TLEDAddLoad - a load, before TLEDSetUp()

  Input Parameters:
+ tled   - the body
. name   - name of the load, for messages
- params - where it acts and how; KeysSetDefaults(TLEDLoadKeys, &params) gives none

  TLEDSetFromOptions() does it for each name in the body's key `loads`, with the options -<body>_<name>_<key>.

.seealso: TLEDSetUp(), TLEDAddConstraint()
@*/
PetscErrorCode TLEDAddLoad(TLED tled, const char name[], const TLEDLoadParams *params)
{
  TLEDLoads *l = &tled->loads;

  PetscFunctionBegin;
  PetscCheck(!tled->set_up, PetscObjectComm((PetscObject)tled), PETSC_ERR_ORDER, "TLEDAddLoad() comes before TLEDSetUp()");
  PetscCall(PetscRealloc((size_t)(l->n + 1) * sizeof *l->item, &l->item));
  PetscCall(PetscMemzero(&l->item[l->n], sizeof *l->item));
  PetscCall(PetscSNPrintf(l->item[l->n].key, sizeof l->item->key, "%s.%s", ((PetscObject)tled)->name, name));
  l->item[l->n++].params = *params;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the loads that the body's parameters name, from the options */
PetscErrorCode TLEDLoadsFromOptions_Private(TLED tled)
{
  const Names   *names = &tled->params.loads;
  TLEDLoadParams params;
  char           prefix[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < names->n; i++) {
    PetscCall(PetscSNPrintf(prefix, sizeof prefix, "%s%s_", ((PetscObject)tled)->prefix, names->name[i]));
    PetscCall(KeysSetDefaults(TLEDLoadKeys, &params));
    PetscCall(KeysSetFromOptions(TLEDLoadKeys, prefix, &params));
    PetscCall(TLEDAddLoad(tled, names->name[i], &params));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Given(const PetscReal x[3]) { return (PetscBool)(x[0] != 0.0 || x[1] != 0.0 || x[2] != 0.0); }

/* what does not go together within a section */
static PetscErrorCode CheckLoad(const TLEDLoad *l)
{
  const TLEDLoadParams *p     = &l->params;
  const PetscBool       force = Given(p->force), at = (PetscBool)(p->at.n > 0);
  const PetscBool       spread = (PetscBool)(p->pressure != 0.0 || Given(p->traction) || Given(p->body_force));
  char                  key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.at", l->key));
  if (at && p->at.n != 3) PetscFunctionReturn(InputError(key, "does not have three components\nexpected a place [x, y, z] [m]"));
  if (at && !force) PetscFunctionReturn(InputError(key, "belongs to a force, and none is given\nadd force: [x, y, z] [N]"));
  if (at && p->groups.n && !spread) PetscFunctionReturn(InputError(key, "goes with no groups: the force acts on one node\nleave out groups, or at"));
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.pressure", l->key));
  if (!force && !spread) PetscFunctionReturn(InputError(key, "and all others are zero\nexpected a pressure [Pa], traction [Pa], body_force [N/m^3] or force [N]"));
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.groups", l->key));
  if (!p->groups.n && (spread || !at)) PetscFunctionReturn(InputError(key, "names no group of the mesh\nexpected a list of physical groups"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one dead force [N] of load i on a node */
typedef struct {
  PetscInt  node, load;
  PetscReal force[3];
} Dead;

typedef struct {
  PetscInt n, capacity;
  Dead    *item;
} DeadList;

static PetscErrorCode AddDead(DeadList *list, PetscInt node, PetscInt load, const PetscReal direction[3], PetscReal share)
{
  Dead *d;

  PetscFunctionBegin;
  if (list->n == list->capacity) {
    list->capacity = 2 * list->capacity + 256;
    PetscCall(PetscRealloc((size_t)list->capacity * sizeof *list->item, &list->item));
  }
  d       = &list->item[list->n++];
  d->node = node, d->load = load;
  for (int k = 0; k < 3; k++) d->force[k] = share * direction[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void GetNodes(const PetscReal X[], PetscInt n, const PetscInt node[], PetscReal x[])
{
  for (PetscInt k = 0; k < 3 * n; k++) x[k] = X[3 * node[k / 3] + k % 3];
}

/* pressure and traction of load i on the faces of a surface group */
static PetscErrorCode LoadFaces(TLED tled, PetscInt i, const TLEDGroup *group, DeadList *dead)
{
  TLEDLoads            *l     = &tled->loads;
  const TLEDMesh       *mesh  = &tled->mesh;
  const TLEDLoadParams *p     = &l->item[i].params;
  const PetscInt        n     = mesh->n_face_nodes, n_cut = n == 3 ? 1 : 4;
  PetscReal             x[18], share[6];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < group->n_triangles; k++) {
    const PetscInt  face = group->triangles[k] / n_cut;
    const PetscInt *node = &mesh->faces[n * face];
    if (k && face == group->triangles[k - 1] / n_cut) continue;
    if (p->pressure != 0.0) {
      PetscCall(PetscRealloc((size_t)(l->n_faces + 1) * sizeof *l->face, &l->face));
      PetscCall(PetscRealloc((size_t)(l->n_faces + 1) * sizeof *l->face_load, &l->face_load));
      l->face[l->n_faces] = (int)face, l->face_load[l->n_faces++] = (int)i;
    }
    if (!Given(p->traction)) continue;
    GetNodes(mesh->X, n, node, x);
    TLEDFaceShares((int)n, x, share);
    for (PetscInt a = 0; a < n; a++) PetscCall(AddDead(dead, node[a], i, p->traction, share[a]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* shares int N_a dV of an element's volume, exactly also where its edges are curved */
static void VolumeShares(const TLEDMesh *mesh, PetscInt e, PetscReal share[])
{
  const PetscInt n = mesh->n_corners;
  PetscReal      x[30], L[4], N[10], G[9];

  GetNodes(mesh->X, n, &mesh->tets[n * e], x);
  for (PetscInt a = 0; a < n; a++) share[a] = n == 4 ? 0.25 * TLEDReferenceGradients(x, G) : 0.0;
  for (int q = 0; q < TLED_T10_POINTS_FINE && n == 10; q++) {
    const double w = TLEDQuadratureT10(TLED_T10_POINTS_FINE, q, L) * TLEDJacobianT10(L, x, G);
    TLEDShapeT10(L, N);
    for (int a = 0; a < 10; a++) share[a] += w * N[a];
  }
}

/* the node nearest to a place in the reference state, not farther than the largest element is long */
static PetscErrorCode NearestNode(TLED tled, const TLEDLoad *l, PetscInt *nearest)
{
  const TLEDMesh *mesh = &tled->mesh;
  PetscReal       best = PETSC_MAX_REAL, longest = 0.0, r[3];
  char            key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  for (PetscInt a = 0; a < mesh->n_nodes; a++) {
    Sub3(&mesh->X[3 * a], l->params.at.value, r);
    if (Norm3(r) < best) best = Norm3(r), *nearest = a;
  }
  for (PetscInt e = 0; e < mesh->n_tets; e++)
    for (int a = 1; a < 4; a++) {
      Sub3(&mesh->X[3 * mesh->tets[mesh->n_corners * e + a]], &mesh->X[3 * mesh->tets[mesh->n_corners * e]], r);
      longest = PetscMax(longest, Norm3(r));
    }
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.at", l->key));
  if (best > longest)
    PetscFunctionReturn(InputError(key, "lies outside of the body: %.3g m from its nearest node\nexpected a place in the undeformed body, after scale and translate", (double)best));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the force of load i on its nodes, each once */
static PetscErrorCode SpreadForce(TLED tled, PetscInt i, DeadList *dead)
{
  const TLEDLoad  *l = &tled->loads.item[i];
  const TLEDGroup *group;
  PetscBool       *in;
  PetscInt         n = 0, node = 0;

  PetscFunctionBegin;
  if (l->params.at.n) {
    ByCall(NearestNode(tled, l, &node));
    PetscCall(AddDead(dead, node, i, l->params.force, 1.0));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc1(tled->mesh.n_nodes, &in));
  for (PetscInt g = 0; g < l->params.groups.n; g++) {
    PetscCall(TLEDMeshFindGroup_Private(&tled->mesh, l->params.groups.name[g], &group));
    for (PetscInt k = 0; k < group->n_nodes; k++) in[group->nodes[k]] = PETSC_TRUE;
  }
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) n += in[a];
  for (PetscInt a = 0; a < tled->mesh.n_nodes; a++)
    if (in[a]) PetscCall(AddDead(dead, a, i, l->params.force, 1.0 / (PetscReal)n));
  PetscCall(PetscFree(in));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* faces and dead forces of load i */
static PetscErrorCode SetUpLoad(TLED tled, PetscInt i, DeadList *dead)
{
  TLEDLoad             *l = &tled->loads.item[i];
  const TLEDLoadParams *p = &l->params;
  const PetscInt        n = tled->mesh.n_corners;
  const TLEDGroup      *group;
  PetscReal             share[10];
  char                  key[3 * BY_NAME_MAX];

  PetscFunctionBegin;
  ByCall(CheckLoad(l));
  ByCall(CourseCreate(l->key, &p->course, &l->course));
  PetscCall(PetscSNPrintf(key, sizeof key, "%s.groups", l->key));
  for (PetscInt g = 0; g < p->groups.n; g++) {
    const PetscInt dim = p->pressure != 0.0 || Given(p->traction) ? 2 : Given(p->body_force) ? 3 : 0;
    ByCall(TLEDMeshNeedGroup_Private(&tled->mesh, tled->params.mesh, key, p->groups.name[g], dim, &group));
    if (dim == 2) PetscCall(LoadFaces(tled, i, group, dead));
    if (!Given(p->body_force)) continue;
    ByCall(TLEDMeshNeedGroup_Private(&tled->mesh, tled->params.mesh, key, p->groups.name[g], 3, &group));
    for (PetscInt k = 0; k < group->n_tets; k++) {
      VolumeShares(&tled->mesh, group->tets[k], share);
      for (PetscInt a = 0; a < n; a++) PetscCall(AddDead(dead, tled->mesh.tets[n * group->tets[k] + a], i, p->body_force, share[a]));
    }
  }
  if (Given(p->force)) ByCall(SpreadForce(tled, i, dead));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* offsets from counts; the counting loops below shift them back by one place */
static void Accumulate(PetscInt n, int offset[])
{
  for (PetscInt a = 0; a < n; a++) offset[a + 1] += offset[a];
}

static void ShiftBack(PetscInt n, int offset[])
{
  for (PetscInt a = n; a > 0; a--) offset[a] = offset[a - 1];
  offset[0] = 0;
}

/* node by node: the dead forces, and the faces around */
static PetscErrorCode SortByNodes(TLED tled, const DeadList *dead)
{
  TLEDLoads      *l = &tled->loads;
  const PetscInt  n = tled->mesh.n_nodes, n_f = tled->mesh.n_face_nodes;
  const PetscInt *faces = tled->mesh.faces;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(n + 1, &l->dead_offset, n + 1, &l->slot_offset));
  PetscCall(PetscMalloc4(dead->n, &l->dead_load, 3 * dead->n, &l->dead, n_f * l->n_faces, &l->slot, 3 * n_f * l->n_faces, &l->face_force));
  for (PetscInt k = 0; k < dead->n; k++) l->dead_offset[dead->item[k].node + 1]++;
  for (PetscInt k = 0; k < n_f * l->n_faces; k++) l->slot_offset[faces[n_f * l->face[k / n_f] + k % n_f] + 1]++;
  Accumulate(n, l->dead_offset);
  Accumulate(n, l->slot_offset);
  for (PetscInt k = 0; k < dead->n; k++) {
    const int at    = l->dead_offset[dead->item[k].node]++;
    l->dead_load[at] = (int)dead->item[k].load;
    PetscCall(PetscArraycpy(&l->dead[3 * at], dead->item[k].force, 3));
  }
  for (PetscInt k = 0; k < n_f * l->n_faces; k++) l->slot[l->slot_offset[faces[n_f * l->face[k / n_f] + k % n_f]]++] = (int)k;
  ShiftBack(n, l->dead_offset);
  ShiftBack(n, l->slot_offset);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDLoadsSetUp_Private - where the loads act; nothing is made when there are none

  Errors: BY_ERR_INPUT, reported
*/
PetscErrorCode TLEDLoadsSetUp_Private(TLED tled)
{
  DeadList       dead = {0, 0, NULL};
  PetscErrorCode ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  if (!tled->loads.n) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < tled->loads.n && !ierr; i++) ierr = SetUpLoad(tled, i, &dead);
  if (!ierr) PetscCall(SortByNodes(tled, &dead));
  if (!ierr) PetscCall(PetscCalloc1(tled->loads.n, &tled->loads.scale));
  PetscCall(PetscFree(dead.item));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDLoadsDestroy_Private(TLEDLoads *l)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < l->n; i++) PetscCall(CourseDestroy(&l->item[i].course));
  PetscCall(PetscFree(l->item));
  PetscCall(PetscFree(l->scale));
  PetscCall(PetscFree(l->face));
  PetscCall(PetscFree(l->face_load));
  PetscCall(PetscFree2(l->dead_offset, l->slot_offset));
  PetscCall(PetscFree4(l->dead_load, l->dead, l->slot, l->face_force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* courses of all loads at time t; by one thread */
void TLEDLoadsAt_Private(TLEDLoads *l, PetscReal t)
{
  for (PetscInt i = 0; i < l->n; i++) {
    double g[3];
    CourseAt(&l->item[i].course, t, g);
    l->scale[i] = g[0];
  }
}

/* f += the loads on node a, with the courses and face forces last computed */
void TLEDAddLoads_Private(const TLEDLoads *l, int a, double f[3])
{
  for (int k = l->dead_offset[a]; k < l->dead_offset[a + 1]; k++)
    for (int i = 0; i < 3; i++) f[i] += l->scale[l->dead_load[k]] * l->dead[3 * k + i];
  for (int k = l->slot_offset[a]; k < l->slot_offset[a + 1]; k++)
    for (int i = 0; i < 3; i++) f[i] += l->face_force[3 * l->slot[k] + i];
}

/* forces of the pressures on their faces at displacement u; all threads of a parallel region call it, or one outside */
void TLEDFaceForces_OpenMP(const TLEDLoads *l, const TLEDMesh *mesh, const double u[])
{
  const int n = (int)mesh->n_face_nodes;

#pragma omp for schedule(static)
  for (int k = 0; k < l->n_faces; k++) {
    const PetscInt *node = &mesh->faces[n * l->face[k]];
    double          x[18];
    for (int i = 0; i < 3 * n; i++) x[i] = mesh->X[3 * node[i / 3] + i % 3] + u[3 * node[i / 3] + i % 3];
    TLEDFacePressure(n, x, l->scale[l->face_load[k]] * l->item[l->face_load[k]].params.pressure, &l->face_force[3 * n * k]);
  }
}

/*
  TLEDExternalForces_Private - all forces on the nodes but the internal ones and the supports'

  Input Parameters:
+ tled - set up
. t    - time [s], of the courses
- u    - displacement [m], n_nodes x 3

  Output Parameter:
. f - loads, contact, m g and the Vec f [N], n_nodes x 3, not projected
*/
PetscErrorCode TLEDExternalForces_Private(TLED tled, PetscReal t, const PetscReal u[], PetscReal f[])
{
  TLEDLoads       *l = &tled->loads;
  const PetscReal *held;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(tled->f, &held));
  if (l->n) TLEDLoadsAt_Private(l, t);
#pragma omp parallel num_threads(TLEDThreads_OpenMP(&tled->loops))
  {
    if (l->n) TLEDFaceForces_OpenMP(l, &tled->mesh, u);
#pragma omp for schedule(static)
    for (PetscInt a = 0; a < tled->mesh.n_nodes; a++) {
      for (int k = 0; k < 3; k++) f[3 * a + k] = held[3 * a + k] + tled->mass[a] * tled->gravity[k];
      if (l->n) TLEDAddLoads_Private(l, (int)a, &f[3 * a]);
      if (tled->contact.n) (void)TLEDContactAt_Private(tled, a, &u[3 * a], &f[3 * a], NULL, NULL);
    }
  }
  PetscCall(VecRestoreArrayRead(tled->f, &held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDExternalTangent_Private - stiffness of what follows the surface: -df_ext/du of the pressures and of contact

  Input Parameters:
+ tled - set up
. t    - time [s], of the courses
. u    - displacement [m], n_nodes x 3
- add  - called with (ctx, a, b, K), K the 3 x 3 block [N/m] of node a's force and node b's displacement; several blocks of the same
         nodes add up
*/
PetscErrorCode TLEDExternalTangent_Private(TLED tled, PetscReal t, const PetscReal u[], TLEDAddBlock add, void *ctx)
{
  TLEDLoads      *l    = &tled->loads;
  const TLEDMesh *mesh = &tled->mesh;
  const int       n    = (int)mesh->n_face_nodes;

  PetscFunctionBegin;
  if (l->n) TLEDLoadsAt_Private(l, t);
  for (int k = 0; k < l->n_faces; k++) {
    const PetscInt *node = &mesh->faces[n * l->face[k]];
    const PetscReal p    = l->scale[l->face_load[k]] * l->item[l->face_load[k]].params.pressure;
    PetscReal       x[18];
    for (int i = 0; i < 3 * n; i++) x[i] = mesh->X[3 * node[i / 3] + i % 3] + u[3 * node[i / 3] + i % 3];
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++) {
        PetscReal K[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
        TLEDFaceStiffness(n, x, p, a, b, K);
        PetscCall(add(ctx, node[a], node[b], K));
      }
  }
  for (PetscInt a = 0; a < mesh->n_nodes && tled->contact.n; a++) {
    PetscReal K[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    if (TLEDContactAt_Private(tled, a, &u[3 * a], NULL, K, NULL) > 0.0) PetscCall(add(ctx, a, a, K));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
