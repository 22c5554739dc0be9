/* tled_mesh.c - from what a gmsh file holds to the mesh of a body: tetrahedra, outward boundary faces, physical groups by name. */
#include "tled/tled_impl.h"
#include "tled/tled_element.h"
#include "tled/tled_t10.h"
#include <string.h>

/* Faces of the tetrahedra by their vertices: those with the smallest vertex v are entries first[v] ... first[v] + n[v] - 1. */
typedef struct {
  PetscInt *first, *n; /* n_nodes + 1, n_nodes                                                  */
  PetscInt *rest;      /* the other two vertices, ascending                                     */
  PetscInt *element;   /* the first tetrahedron of the face                                     */
  PetscInt *side;      /* which of its faces it is                                              */
  PetscInt *number;    /* tetrahedra that have the face; then its number on the boundary, or -1 */
} Faces;

/* nodes of the four faces of a tetrahedron, outward by the right-hand rule: corners, then the nodes of the edges after each */
static const int face_nodes[4][6] = {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}};

/* coordinates of the nodes of element e */
static void ElementCoordinates(const TLEDMesh *mesh, PetscInt e, PetscReal x[])
{
  for (PetscInt a = 0; a < mesh->n_corners; a++)
    for (PetscInt k = 0; k < 3; k++) x[3 * a + k] = mesh->X[3 * mesh->tets[mesh->n_corners * e + a] + k];
}

/* number of elements of a gmsh type */
static PetscInt CountType(const TLEDGmshFile *file, PetscInt type)
{
  PetscInt n = 0;

  for (PetscInt e = 0; e < file->n_elements; e++) n += file->type[e] == type;
  return n;
}

/* nodes and tetrahedra, in the file's order; gmsh lists the last two edges of a quadratic tetrahedron the other way round than VTK */
static PetscErrorCode GetCells(const char key[], const TLEDGmshFile *file, const TLEDParams *p, TLEDMesh *mesh)
{
  const PetscInt n_linear = CountType(file, TLED_GMSH_TET4), n_quadratic = CountType(file, TLED_GMSH_TET10);
  const PetscInt type = n_quadratic ? TLED_GMSH_TET10 : TLED_GMSH_TET4;
  PetscInt       n    = 0;

  PetscFunctionBegin;
  if (n_linear && n_quadratic)
    PetscFunctionReturn(InputError(key,
                                   "holds %" PetscInt_FMT " tetrahedra of first order and %" PetscInt_FMT
                                   " of second\n  expected one order for all (gmsh -order 1 or 2)",
                                   n_linear, n_quadratic));
  if (!n_linear && !n_quadratic)
    PetscFunctionReturn(InputError(key,
                                   "is a mesh of the wrong kind: no tetrahedra, %" PetscInt_FMT
                                   " triangles\n  expected a volume mesh (gmsh -3) with a physical volume; "
                                   "meshes/solid_from_surface.py makes one from a closed surface",
                                   CountType(file, TLED_GMSH_TRIANGLE3) + CountType(file, TLED_GMSH_TRIANGLE6)));
  mesh->n_nodes   = file->n_nodes;
  mesh->n_tets    = n_linear + n_quadratic;
  mesh->n_corners = n_quadratic ? 10 : 4;
  PetscCall(PetscMalloc3(3 * mesh->n_nodes, &mesh->X, mesh->n_corners * mesh->n_tets, &mesh->tets, mesh->n_tets, &mesh->tag));
  for (PetscInt k = 0; k < 3 * mesh->n_nodes; k++) mesh->X[k] = p->scale * file->X[k] + p->translate[k % 3];
  for (PetscInt e = 0; e < file->n_elements; e++) {
    PetscInt *corner = &mesh->tets[mesh->n_corners * n];
    if (file->type[e] != type) continue;
    for (PetscInt a = 0; a < mesh->n_corners; a++) corner[a] = file->corner[file->first[e] + (a < 8 ? a : 17 - a)];
    mesh->tag[n++] = file->tag[e];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Size of an element to tell whether it is good: its volume [m^3], or the smallest Jacobian over 6 of a quadratic one at the points of
   both quadrature rules */
static PetscReal WorstVolume(const TLEDMesh *mesh, const PetscReal x[])
{
  static const int rules[2] = {TLED_T10_POINTS, TLED_T10_POINTS_FINE};
  PetscReal        worst    = PETSC_MAX_REAL, M[9], L[4];

  if (mesh->n_corners == 4) return TLEDReferenceGradients(x, M);
  for (int r = 0; r < 2; r++) {
    for (int q = 0; q < rules[r]; q++) {
      (void)TLEDQuadratureT10(rules[r], q, L);
      const PetscReal V = TLEDJacobianT10(L, x, M) / 6.0;
      if (!(V > worst)) worst = V;
    }
  }
  return worst;
}

/* no element without volume or turned inside out */
static PetscErrorCode CheckVolumes(const char key[], const TLEDMesh *mesh)
{
  PetscInt  n_bad = 0, first = 0;
  PetscReal V_first = 0.0, x[3 * TLED_CORNERS_MAX];

  PetscFunctionBegin;
  for (PetscInt e = 0; e < mesh->n_tets; e++) {
    PetscReal longest = 0.0;
    ElementCoordinates(mesh, e, x);
    for (PetscInt a = 1; a < 4; a++)
      longest = PetscMax(longest, PetscSqr(x[3 * a] - x[0]) + PetscSqr(x[3 * a + 1] - x[1]) + PetscSqr(x[3 * a + 2] - x[2]));
    const PetscReal V = WorstVolume(mesh, x);
    if (V > 1e-12 * longest * PetscSqrtReal(longest)) continue; /* a flat element of any size: round-off of its coordinates */
    if (!n_bad++) first = e, V_first = V;
  }
  if (!n_bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscFunctionReturn(InputError(
      key,
      "has %s element: number %" PetscInt_FMT " of the file has %s %g m^3 (%" PetscInt_FMT " of %" PetscInt_FMT
      " elements are bad)\n  every tetrahedron needs a positive %s; mesh again with optimisation (gmsh -3 -optimize%s)",
      V_first < 0.0 ? "an inverted" : "a flat", mesh->tag[first],
      mesh->n_corners == 4 ? "volume" : "a smallest Jacobian at its integration points of", (double)(mesh->n_corners == 4 ? 1 : 6) * V_first,
      n_bad, mesh->n_tets, mesh->n_corners == 4 ? "volume" : "Jacobian", mesh->n_corners == 4 ? "" : "_ho"));
}

static void Sort3(PetscInt v[3])
{
  PetscInt t;

  if (v[0] > v[1]) t = v[0], v[0] = v[1], v[1] = t;
  if (v[1] > v[2]) t = v[1], v[1] = v[2], v[2] = t;
  if (v[0] > v[1]) t = v[0], v[0] = v[1], v[1] = t;
}

/* the entry of the face with three vertices, -1 when there is none; the vertices are sorted */
static PetscInt FindFace(const Faces *f, PetscInt v[3])
{
  Sort3(v);
  for (PetscInt k = f->first[v[0]]; k < f->first[v[0]] + f->n[v[0]]; k++)
    if (f->rest[2 * k] == v[1] && f->rest[2 * k + 1] == v[2]) return k;
  return -1;
}

static void FaceVertices(const TLEDMesh *mesh, PetscInt e, PetscInt side, PetscInt v[3])
{
  for (int a = 0; a < 3; a++) v[a] = mesh->tets[mesh->n_corners * e + face_nodes[side][a]];
}

/* what two tetrahedra with a common face must share: the nodes of its edges, and no third one has that face */
static PetscErrorCode CheckShared(const char key[], const TLEDMesh *mesh, const Faces *f, PetscInt k, PetscInt e, PetscInt side)
{
  const PetscInt *other = &mesh->tets[mesh->n_corners * f->element[k]], *own = &mesh->tets[mesh->n_corners * e];

  PetscFunctionBegin;
  if (f->number[k] > 2)
    PetscFunctionReturn(
        InputError(key,
                   "has elements that overlap: %" PetscInt_FMT " tetrahedra, number %" PetscInt_FMT
                   " of the file among them, share one face\n  a face belongs to two tetrahedra, or to one at the boundary",
                   f->number[k], mesh->tag[e]));
  for (int a = 3; a < 6 && mesh->n_corners == 10; a++) {
    PetscBool found = PETSC_FALSE;
    for (int b = 3; b < 6; b++) found = (PetscBool)(found || own[face_nodes[side][a]] == other[face_nodes[f->side[k]][b]]);
    if (!found)
      PetscFunctionReturn(InputError(key,
                                     "has elements that do not fit: number %" PetscInt_FMT " and %" PetscInt_FMT
                                     " of the file share the vertices of a face, but not the nodes on its edges",
                                     mesh->tag[f->element[k]], mesh->tag[e]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* all faces of the tetrahedra, each once */
static PetscErrorCode ListFaces(const char key[], const TLEDMesh *mesh, Faces *f)
{
  const PetscInt n = 4 * mesh->n_tets;
  PetscInt       v[3];

  PetscFunctionBegin;
  PetscCall(PetscCalloc6(mesh->n_nodes + 1, &f->first, mesh->n_nodes, &f->n, 2 * n, &f->rest, n, &f->element, n, &f->side, n, &f->number));
  for (PetscInt i = 0; i < n; i++) {
    FaceVertices(mesh, i / 4, i % 4, v);
    f->first[PetscMin(v[0], PetscMin(v[1], v[2])) + 1]++;
  }
  for (PetscInt a = 0; a < mesh->n_nodes; a++) f->first[a + 1] += f->first[a];
  for (PetscInt i = 0; i < n; i++) {
    FaceVertices(mesh, i / 4, i % 4, v);
    PetscInt k = FindFace(f, v);
    if (k < 0) {
      k          = f->first[v[0]] + f->n[v[0]]++;
      f->rest[2 * k] = v[1], f->rest[2 * k + 1] = v[2];
      f->element[k] = i / 4, f->side[k] = i % 4;
    }
    f->number[k]++;
    ByCall(CheckShared(key, mesh, f, k, i / 4, i % 4));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the boundary: faces of one tetrahedron, in the order of the elements, and the triangles they are cut into */
static PetscErrorCode GetBoundary(Faces *f, TLEDMesh *mesh)
{
  static const int cut[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  const PetscInt   n_cut = mesh->n_corners == 4 ? 1 : 4, n_nodes = mesh->n_corners == 4 ? 3 : 6;
  PetscInt         v[3];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 4 * mesh->n_tets; i++) {
    FaceVertices(mesh, i / 4, i % 4, v);
    const PetscInt k = FindFace(f, v);
    if (f->element[k] == i / 4 && f->side[k] == i % 4) f->number[k] = f->number[k] == 1 ? mesh->n_faces++ : -1;
  }
  mesh->n_face_nodes = n_nodes;
  mesh->n_triangles  = n_cut * mesh->n_faces;
  PetscCall(PetscMalloc2(n_nodes * mesh->n_faces, &mesh->faces, 3 * mesh->n_triangles, &mesh->triangles));
  for (PetscInt i = 0; i < 4 * mesh->n_tets; i++) {
    FaceVertices(mesh, i / 4, i % 4, v);
    const PetscInt k = FindFace(f, v), face = f->number[k];
    if (face < 0) continue;
    for (PetscInt a = 0; a < n_nodes; a++) mesh->faces[n_nodes * face + a] = mesh->tets[mesh->n_corners * (i / 4) + face_nodes[i % 4][a]];
    for (PetscInt t = 0; t < n_cut; t++)
      for (PetscInt a = 0; a < 3; a++)
        mesh->triangles[3 * (n_cut * face + t) + a] = mesh->faces[n_nodes * face + (n_cut == 1 ? a : cut[t][a])];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* nodes, tetrahedra and boundary triangles of group g */
static PetscErrorCode GetGroup(const TLEDGmshFile *file, const Faces *f, PetscInt g, const TLEDMesh *mesh, TLEDGroup *group)
{
  const PetscInt n_cut = mesh->n_faces ? mesh->n_triangles / mesh->n_faces : 1;
  PetscBool     *in_group, *is_triangle, *is_tet;
  PetscInt       n = 0, tet = 0, v[3];

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(group->name, file->name[g], BY_NAME_MAX));
  group->dim = file->dim[g];
  PetscCall(PetscCalloc3(mesh->n_nodes, &in_group, mesh->n_triangles, &is_triangle, mesh->n_tets, &is_tet));
  for (PetscInt e = 0; e < file->n_elements; e++) {
    const PetscInt *corner = &file->corner[file->first[e]], type = file->type[e];
    const PetscBool is_cell = (PetscBool)(type == TLED_GMSH_TET4 || type == TLED_GMSH_TET10);
    tet += is_cell;
    if (!(file->groups[e] >> g & 1)) continue;
    for (PetscInt a = 0; a < file->first[e + 1] - file->first[e]; a++) in_group[corner[a]] = PETSC_TRUE;
    if (is_cell) is_tet[tet - 1] = PETSC_TRUE;
    if (type != TLED_GMSH_TRIANGLE3 && type != TLED_GMSH_TRIANGLE6) continue;
    for (int a = 0; a < 3; a++) v[a] = corner[a];
    const PetscInt k = FindFace(f, v);
    for (PetscInt t = 0; t < n_cut && k >= 0 && f->number[k] >= 0; t++) is_triangle[n_cut * f->number[k] + t] = PETSC_TRUE;
  }
  for (PetscInt i = 0; i < mesh->n_nodes; i++) group->n_nodes += in_group[i];
  for (PetscInt i = 0; i < mesh->n_triangles; i++) group->n_triangles += is_triangle[i];
  for (PetscInt i = 0; i < mesh->n_tets; i++) group->n_tets += is_tet[i];
  PetscCall(PetscMalloc3(group->n_nodes, &group->nodes, group->n_triangles, &group->triangles, group->n_tets, &group->tets));
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    if (in_group[i]) group->nodes[n++] = i;
  n = 0;
  for (PetscInt i = 0; i < mesh->n_triangles; i++)
    if (is_triangle[i]) group->triangles[n++] = i;
  n = 0;
  for (PetscInt i = 0; i < mesh->n_tets; i++)
    if (is_tet[i]) group->tets[n++] = i;
  PetscCall(PetscFree3(in_group, is_triangle, is_tet));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Convert(const char key[], const TLEDGmshFile *file, const TLEDParams *params, TLEDMesh *mesh)
{
  Faces          faces = {0};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ByCall(GetCells(key, file, params, mesh));
  ByCall(CheckVolumes(key, mesh));
  ierr = ListFaces(key, mesh, &faces);
  if (!ierr) {
    PetscCall(GetBoundary(&faces, mesh));
    mesh->n_groups = file->n_groups;
    PetscCall(PetscCalloc1(mesh->n_groups, &mesh->groups));
    for (PetscInt g = 0; g < mesh->n_groups; g++) PetscCall(GetGroup(file, &faces, g, mesh, &mesh->groups[g]));
  }
  PetscCall(PetscFree6(faces.first, faces.n, faces.rest, faces.element, faces.side, faces.number));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDMeshRead_Private - read params->mesh, scaled and moved

  Input Parameters:
+ key    - scene key of the mesh, "flap.mesh", for messages
- params - mesh, scale and translate are used

  Output Parameter:
. mesh - nodes and elements in the file's order; TLEDMeshDestroy_Private() frees it, also after an error

  Errors: BY_ERR_INPUT, reported with the file, element and volume: no file, not gmsh, broken, no tetrahedra, two orders, inverted, flat
  or overlapping elements
*/
PetscErrorCode TLEDMeshRead_Private(const char key[], const TLEDParams *params, TLEDMesh *mesh)
{
  TLEDGmshFile   file;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(mesh, sizeof *mesh));
  ierr = TLEDGmshRead_Private(key, params->mesh, &file);
  if (!ierr) ierr = Convert(key, &file, params, mesh);
  PetscCall(TLEDGmshDestroy_Private(&file));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDMeshDestroy_Private(TLEDMesh *mesh)
{
  PetscInt g;

  PetscFunctionBegin;
  for (g = 0; g < mesh->n_groups && mesh->groups; g++)
    PetscCall(PetscFree3(mesh->groups[g].nodes, mesh->groups[g].triangles, mesh->groups[g].tets));
  PetscCall(PetscFree(mesh->material));
  PetscCall(PetscFree(mesh->groups));
  PetscCall(PetscFree2(mesh->faces, mesh->triangles));
  PetscCall(PetscFree3(mesh->X, mesh->tets, mesh->tag));
  PetscCall(PetscMemzero(mesh, sizeof *mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the group of a name, NULL when there is none */
PetscErrorCode TLEDMeshFindGroup_Private(const TLEDMesh *mesh, const char name[], const TLEDGroup **group)
{
  PetscFunctionBegin;
  *group = NULL;
  for (PetscInt g = 0; g < mesh->n_groups; g++)
    if (!strcmp(mesh->groups[g].name, name)) *group = &mesh->groups[g];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* edit distance of two names [Levenshtein] */
static PetscInt EditDistance(const char a[], const char b[])
{
  const size_t n = strlen(a), m = strlen(b);
  PetscInt     row[BY_NAME_MAX + 1];

  if (n >= BY_NAME_MAX || m >= BY_NAME_MAX) return BY_NAME_MAX;
  for (size_t j = 0; j <= m; j++) row[j] = (PetscInt)j;
  for (size_t i = 1; i <= n; i++) {
    PetscInt diagonal = row[0];
    row[0]            = (PetscInt)i;
    for (size_t j = 1; j <= m; j++) {
      const PetscInt change = diagonal + (a[i - 1] != b[j - 1]);
      diagonal              = row[j];
      row[j]                = PetscMin(change, 1 + PetscMin(row[j], row[j - 1]));
    }
  }
  return row[m];
}

/*
  TLEDMeshNeedGroup_Private - a group that the scene names, of dimension `dim` (0: any)

  Errors: BY_ERR_INPUT, reported with the groups that the mesh has and the nearest name
*/
PetscErrorCode TLEDMeshNeedGroup_Private(const TLEDMesh *mesh, const char path[], const char key[], const char name[], PetscInt dim,
                                         const TLEDGroup **group)
{
  char        list[1024] = "", near[BY_NAME_MAX + 32] = "";
  const char *slash = strrchr(path, '/');
  size_t      used  = 0;
  PetscInt    best  = 3, g, d;

  PetscFunctionBegin;
  PetscCall(TLEDMeshFindGroup_Private(mesh, name, group));
  if (*group && (!dim || (*group)->dim == dim) && (*group)->n_nodes) PetscFunctionReturn(PETSC_SUCCESS);
  for (g = 0; g < mesh->n_groups; g++) {
    const TLEDGroup *have = &mesh->groups[g];
    if (used < sizeof list - BY_NAME_MAX - 32)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s (%s)", g ? ", " : "", have->name,
                               have->dim == 3   ? "volume"
                               : have->dim == 2 ? "surface"
                               : have->dim == 1 ? "curve"
                                                : "point");
    d = EditDistance(have->name, name);
    if (d < best && d > 0 && (!dim || have->dim == dim)) {
      best = d;
      snprintf(near, sizeof near, "did you mean %s? ", have->name);
    }
  }
  if (*group && dim && (*group)->dim != dim)
    PetscFunctionReturn(InputError(key, "names the group %s of %s, which is not a %s\n  groups in the mesh: %s", name,
                                   slash ? slash + 1 : path, dim == 3 ? "volume" : "surface", list));
  if (*group)
    PetscFunctionReturn(
        InputError(key, "names the group %s of %s, which holds no surface or volume of the mesh\n  groups in the mesh: %s", name,
                   slash ? slash + 1 : path, list));
  PetscFunctionReturn(InputError(key, "names the group %s, which %s does not have\n  %sgroups in the mesh: %s", name,
                                 slash ? slash + 1 : path, near, mesh->n_groups ? list : "none; name physical groups in gmsh"));
}
