/* tled_mesh.c - gmsh mesh through PETSc DMPlex: nodes, tetrahedra, outward boundary triangles, physical groups by name. */
#include "tled/tled_impl.h"
#include "tled/tled_element.h"
#include <petscdmplex.h>
#include <string.h>

/* Let PETSc read the file, without its traceback: a file it cannot read is the user's. The option is given for this call only. */
static PetscErrorCode ReadPlex(const char key[], const char path[], DM *dm)
{
  const char     option[] = "-dm_plex_gmsh_use_regions";
  PetscBool      given;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &given));
  if (!given) PetscCall(PetscOptionsSetValue(NULL, option, NULL));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = DMPlexCreateGmshFromFile(PETSC_COMM_SELF, path, PETSC_TRUE, dm);
  PetscCall(PetscPopErrorHandler());
  if (!given) PetscCall(PetscOptionsClearValue(NULL, option));
  if (!ierr) PetscFunctionReturn(PETSC_SUCCESS);
  *dm = NULL; /* what PETSc leaves of a mesh it could not finish cannot be destroyed */
  PetscFunctionReturn(InputError(key,
                                 "is a gmsh file that cannot be read (PETSc's reader: error %d)\n"
                                 "  write it again with gmsh (formats 4.1 and 2.2 are read)",
                                 (int)ierr));
}

/* refuse what is not a mesh of first-order tetrahedra */
static PetscErrorCode CheckKind(const char key[], const TLEDGmshFile *file, DM dm)
{
  PetscInt       dim, c, c_start, c_end;
  DMPolytopeType type;

  PetscFunctionBegin;
  if (file->n_other)
    PetscFunctionReturn(InputError(key, "holds a %s\n  expected a mesh of first-order (4-node) tetrahedra only", file->other));
  if (file->n_tets == 0)
    PetscFunctionReturn(InputError(key,
                                   "is a mesh of the wrong kind: no tetrahedra, %" PetscInt_FMT
                                   " triangles\n  expected a volume mesh (gmsh -3) with a physical volume; "
                                   "meshes/solid_from_surface.py makes one from a closed surface",
                                   file->n_triangles));
  if (!dm) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetDimension(dm, &dim));
  if (dim != 3)
    PetscFunctionReturn(InputError(
        key, "is a mesh of the wrong kind: its elements have %" PetscInt_FMT " dimensions\n  expected tetrahedra (gmsh -3)", dim));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &c_start, &c_end));
  for (c = c_start; c < c_end; c++) {
    PetscCall(DMPlexGetCellType(dm, c, &type));
    if (type != DM_POLYTOPE_TETRAHEDRON)
      PetscFunctionReturn(InputError(key,
                                     "is a mesh of the wrong kind: element %" PetscInt_FMT " is a %s\n  expected tetrahedra only",
                                     c - c_start + 1, DMPolytopeTypes[type]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coordinates and connectivity. Plex keeps the file's corner order but for its own convention, in which a tetrahedron of positive
   volume has its first two corners exchanged: an element inverted in the file stays so, and is found by CheckVolumes(). */
static PetscErrorCode GetCells(const char key[], DM dm, const TLEDParams *p, TLEDMesh *mesh)
{
  PetscInt           c, c_start, c_end, v_start, v_end, n, k, a;
  PetscInt          *closure = NULL;
  Vec                coordinates;
  const PetscScalar *xyz;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &c_start, &c_end));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &v_start, &v_end));
  mesh->n_tets    = c_end - c_start;
  mesh->n_nodes   = v_end - v_start;
  mesh->n_corners = 4;
  PetscCall(PetscMalloc3(3 * mesh->n_nodes, &mesh->X, 4 * mesh->n_tets, &mesh->tets, mesh->n_tets, &mesh->tag));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(VecGetLocalSize(coordinates, &n));
  if (n != 3 * mesh->n_nodes)
    PetscFunctionReturn(
        InputError(key, "holds elements of second or higher order\n  expected a mesh of first-order (4-node) tetrahedra only"));
  PetscCall(VecGetArrayRead(coordinates, &xyz));
  for (k = 0; k < 3 * mesh->n_nodes; k++) mesh->X[k] = p->scale * PetscRealPart(xyz[k]) + p->translate[k % 3];
  PetscCall(VecRestoreArrayRead(coordinates, &xyz));
  for (c = c_start; c < c_end; c++) {
    PetscInt *corner = &mesh->tets[4 * (c - c_start)];
    PetscCall(DMPlexGetTransitiveClosure(dm, c, PETSC_TRUE, &n, &closure));
    for (k = 0, a = 0; k < n && a < 4; k++)
      if (closure[2 * k] >= v_start && closure[2 * k] < v_end) corner[a++] = closure[2 * k] - v_start;
    PetscCall(DMPlexRestoreTransitiveClosure(dm, c, PETSC_TRUE, &n, &closure));
    PetscCall(DMPlexInvertCell(DM_POLYTOPE_TETRAHEDRON, corner));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* no element without volume or turned inside out */
static PetscErrorCode CheckVolumes(const char key[], const TLEDMesh *mesh)
{
  PetscInt  e, a, k, n_bad = 0, first = 0;
  PetscReal V, V_first = 0.0, longest, l2;

  PetscFunctionBegin;
  for (e = 0; e < mesh->n_tets; e++) {
    PetscReal x[12], G[9];
    for (a = 0; a < 4; a++)
      for (k = 0; k < 3; k++) x[3 * a + k] = mesh->X[3 * mesh->tets[4 * e + a] + k];
    V = TLEDReferenceGradients(x, G);
    for (a = 1, longest = 0.0; a < 4; a++) {
      l2 = PetscSqr(x[3 * a] - x[0]) + PetscSqr(x[3 * a + 1] - x[1]) + PetscSqr(x[3 * a + 2] - x[2]);
      if (l2 > longest) longest = l2;
    }
    if (V > 1e-12 * longest * PetscSqrtReal(longest)) continue; /* a flat element of any size: round-off of its coordinates */
    if (!n_bad++) first = e, V_first = V;
  }
  if (!n_bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscFunctionReturn(InputError(
      key,
      "has %s element: number %" PetscInt_FMT " of the file has volume %g m^3 (%" PetscInt_FMT " of %" PetscInt_FMT
      " elements are bad)\n  every tetrahedron needs a positive volume; mesh again with optimisation (gmsh -3 -optimize)",
      V_first < 0.0 ? "an inverted" : "a flat", mesh->tag[first], (double)V_first, n_bad, mesh->n_tets));
}

/* triangles with one tetrahedron, turned so that the normal points away from its fourth corner; face_triangle[f] is the number of
   the triangle made of face f, or -1 */
static PetscErrorCode GetBoundary(const char key[], DM dm, TLEDMesh *mesh, PetscInt face_triangle[])
{
  PetscInt        f, f_start, f_end, v_start, v_end, c_start, n, k, a;
  PetscInt       *closure = NULL;
  const PetscInt *support;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(dm, 1, &f_start, &f_end));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &c_start, NULL));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &v_start, &v_end));
  for (f = f_start; f < f_end; f++) {
    PetscCall(DMPlexGetSupportSize(dm, f, &n));
    face_triangle[f - f_start] = n == 1 ? mesh->n_triangles++ : -1;
    if (n <= 2) continue;
    PetscCall(DMPlexGetSupport(dm, f, &support));
    PetscFunctionReturn(
        InputError(key,
                   "has elements that overlap: %" PetscInt_FMT " tetrahedra, number %" PetscInt_FMT
                   " of the file among them, share one face\n  a face belongs to two tetrahedra, or to one at the boundary",
                   n, mesh->tag[support[0] - c_start]));
  }
  PetscCall(PetscMalloc1(3 * mesh->n_triangles, &mesh->triangles));
  for (f = f_start; f < f_end; f++) {
    PetscInt        corner[3], opposite = -1;
    const PetscInt *tet;
    PetscReal       e1[3], e2[3], e3[3], normal[3];
    if (face_triangle[f - f_start] < 0) continue;
    PetscCall(DMPlexGetTransitiveClosure(dm, f, PETSC_TRUE, &n, &closure));
    for (k = 0, a = 0; k < n && a < 3; k++)
      if (closure[2 * k] >= v_start && closure[2 * k] < v_end) corner[a++] = closure[2 * k] - v_start;
    PetscCall(DMPlexRestoreTransitiveClosure(dm, f, PETSC_TRUE, &n, &closure));
    PetscCall(DMPlexGetSupport(dm, f, &support));
    tet = &mesh->tets[4 * (support[0] - c_start)];
    for (a = 0; a < 4; a++)
      if (tet[a] != corner[0] && tet[a] != corner[1] && tet[a] != corner[2]) opposite = tet[a];
    Sub3(&mesh->X[3 * corner[1]], &mesh->X[3 * corner[0]], e1);
    Sub3(&mesh->X[3 * corner[2]], &mesh->X[3 * corner[0]], e2);
    Sub3(&mesh->X[3 * opposite], &mesh->X[3 * corner[0]], e3);
    Cross3(e1, e2, normal);
    if (Dot3(normal, e3) > 0.0) k = corner[1], corner[1] = corner[2], corner[2] = k;
    for (a = 0; a < 3; a++) mesh->triangles[3 * face_triangle[f - f_start] + a] = corner[a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* nodes, boundary triangles and elements of one group from the label of its name */
static PetscErrorCode GetGroup(DM dm, const PetscInt face_triangle[], const TLEDMesh *mesh, TLEDGroup *group)
{
  DMLabel         label;
  IS              points, values;
  PetscInt        i, j, k, n, n_values, n_points, n_closure, f_start, f_end, v_start, v_end, *closure = NULL;
  const PetscInt *point, *value;
  PetscInt        c_start, c_end, n_tets = mesh->n_tets;
  PetscBool      *in_group, *is_triangle, *is_tet;

  PetscFunctionBegin;
  PetscCall(DMGetLabel(dm, group->name, &label));
  PetscCall(PetscCalloc3(mesh->n_nodes, &in_group, mesh->n_triangles, &is_triangle, n_tets, &is_tet));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &c_start, &c_end));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &f_start, &f_end));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &v_start, &v_end));
  if (label) {
    PetscCall(DMLabelGetValueIS(label, &values));
    PetscCall(ISGetLocalSize(values, &n_values));
    PetscCall(ISGetIndices(values, &value));
    for (i = 0; i < n_values; i++) {
      PetscCall(DMLabelGetStratumIS(label, value[i], &points));
      PetscCall(ISGetLocalSize(points, &n_points));
      PetscCall(ISGetIndices(points, &point));
      for (j = 0; j < n_points; j++) {
        if (point[j] >= c_start && point[j] < c_end) is_tet[point[j] - c_start] = PETSC_TRUE;
        if (point[j] >= f_start && point[j] < f_end && face_triangle[point[j] - f_start] >= 0)
          is_triangle[face_triangle[point[j] - f_start]] = PETSC_TRUE;
        PetscCall(DMPlexGetTransitiveClosure(dm, point[j], PETSC_TRUE, &n_closure, &closure));
        for (k = 0; k < n_closure; k++)
          if (closure[2 * k] >= v_start && closure[2 * k] < v_end) in_group[closure[2 * k] - v_start] = PETSC_TRUE;
        PetscCall(DMPlexRestoreTransitiveClosure(dm, point[j], PETSC_TRUE, &n_closure, &closure));
      }
      PetscCall(ISRestoreIndices(points, &point));
      PetscCall(ISDestroy(&points));
    }
    PetscCall(ISRestoreIndices(values, &value));
    PetscCall(ISDestroy(&values));
  }
  for (i = 0; i < n_tets; i++) group->n_tets += is_tet[i];
  PetscCall(PetscMalloc1(group->n_tets, &group->tets));
  for (i = 0, n = 0; i < n_tets; i++)
    if (is_tet[i]) group->tets[n++] = i;
  for (i = 0; i < mesh->n_nodes; i++) group->n_nodes += in_group[i];
  for (i = 0; i < mesh->n_triangles; i++) group->n_triangles += group->dim == 2 && is_triangle[i];
  PetscCall(PetscMalloc2(group->n_nodes, &group->nodes, group->n_triangles, &group->triangles));
  for (i = 0, n = 0; i < mesh->n_nodes; i++)
    if (in_group[i]) group->nodes[n++] = i;
  for (i = 0, n = 0; i < mesh->n_triangles && group->dim == 2; i++)
    if (is_triangle[i]) group->triangles[n++] = i;
  PetscCall(PetscFree3(in_group, is_triangle, is_tet));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ConvertPlex(DM dm, const char key[], const TLEDGmshFile *file, const TLEDParams *params, TLEDMesh *mesh)
{
  PetscInt       e, g, f_start, f_end, *face_triangle;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ByCall(CheckKind(key, file, dm));
  ByCall(GetCells(key, dm, params, mesh));
  for (e = 0; e < mesh->n_tets; e++) mesh->tag[e] = file->n_tets == mesh->n_tets ? file->tag[e] : e + 1;
  ByCall(CheckVolumes(key, mesh));
  PetscCall(DMPlexGetHeightStratum(dm, 1, &f_start, &f_end));
  PetscCall(PetscMalloc1(f_end - f_start, &face_triangle));
  ierr = GetBoundary(key, dm, mesh, face_triangle);
  if (ierr) PetscCall(PetscFree(face_triangle));
  ByCall(ierr);
  mesh->n_groups = file->n_groups;
  PetscCall(PetscCalloc1(mesh->n_groups, &mesh->groups));
  for (g = 0; g < mesh->n_groups; g++) {
    PetscCall(PetscStrncpy(mesh->groups[g].name, file->name[g], BY_NAME_MAX));
    mesh->groups[g].dim = file->dim[g];
    PetscCall(GetGroup(dm, face_triangle, mesh, &mesh->groups[g]));
  }
  PetscCall(PetscFree(face_triangle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDMeshRead_Private - read params->mesh, scaled and moved

  Input Parameters:
+ key    - scene key of the mesh, "flap.mesh", for messages
- params - mesh, scale and translate are used

  Output Parameter:
. mesh - nodes and elements in the file's order; TLEDMeshDestroy_Private() frees it, also after an error

  Errors: BY_ERR_INPUT, reported with the file, element and volume: no file, not gmsh, broken, no tetrahedra, second-order elements,
  inverted or flat elements
*/
PetscErrorCode TLEDMeshRead_Private(const char key[], const TLEDParams *params, TLEDMesh *mesh)
{
  TLEDGmshFile   file;
  DM             dm = NULL;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(mesh, sizeof *mesh));
  ierr = TLEDGmshRead_Private(key, params->mesh, &file);
  if (!ierr) ierr = CheckKind(key, &file, NULL);
  if (!ierr) ierr = ReadPlex(key, params->mesh, &dm);
  if (!ierr) ierr = ConvertPlex(dm, key, &file, params, mesh);
  PetscCall(DMDestroy(&dm));
  PetscCall(TLEDGmshDestroy_Private(&file));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDMeshDestroy_Private(TLEDMesh *mesh)
{
  PetscInt g;

  PetscFunctionBegin;
  for (g = 0; g < mesh->n_groups && mesh->groups; g++) {
    PetscCall(PetscFree2(mesh->groups[g].nodes, mesh->groups[g].triangles));
    PetscCall(PetscFree(mesh->groups[g].tets));
  }
  PetscCall(PetscFree(mesh->material));
  PetscCall(PetscFree(mesh->groups));
  PetscCall(PetscFree(mesh->triangles));
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
