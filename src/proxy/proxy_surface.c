/* proxy_surface.c - connectivity of a triangle surface: edges, sharp edges, smooth patches, vertex fans. */
#include "proxy/proxy_impl.h"

/* Copy the triangles, leaving out those in a periodic plane of the domain when the body reaches through the whole period: there it
   goes on into its own image. */
static PetscErrorCode CopyTriangles(const ProxyFluid *fluid, PetscInt n_nodes, const PetscReal X[], PetscInt n, const PetscInt triangles[],
                                    ProxySurface *s)
{
  PetscBool through[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  PetscReal tol[3];
  PetscInt  m = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(3*n_nodes, &s->X, 3*n, &s->triangles));
  PetscCall(PetscArraycpy(s->X, X, 3*n_nodes));
  for (int k = 0; k < 3; k++) {
    PetscReal lo = PETSC_MAX_REAL, hi = PETSC_MIN_REAL;
    tol[k] = 1e-6 * (fluid->max[k] - fluid->min[k]);
    if (!(fluid->periodic & (1u << k))) continue;
    for (PetscInt i = 0; i < 3*n; i++) {
      lo = PetscMin(lo, X[3*triangles[i] + k]);
      hi = PetscMax(hi, X[3*triangles[i] + k]);
    }
    through[k] = (PetscBool)(PetscAbsReal(lo - fluid->min[k]) < tol[k] && PetscAbsReal(hi - fluid->max[k]) < tol[k]);
  }
  for (PetscInt t = 0; t < n; t++) {
    PetscBool drop = PETSC_FALSE;
    for (int k = 0; k < 3; k++) {
      if (!through[k]) continue;
      for (int side = 0; side < 2; side++) {
        const PetscReal plane = side ? fluid->max[k] : fluid->min[k];
        int             in    = 0;
        for (int i = 0; i < 3; i++) in += PetscAbsReal(X[3*triangles[3*t + i] + k] - plane) < tol[k];
        if (in == 3) drop = PETSC_TRUE;
      }
    }
    if (drop) continue;
    for (int i = 0; i < 3; i++) s->triangles[3*m + i] = triangles[3*t + i];
    m++;
  }
  s->n_nodes     = n_nodes;
  s->n_triangles = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckTriangles(const char key[], const ProxySurface *s)
{
  PetscFunctionBegin;
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt *v = &s->triangles[3*t];
    double          e1[3], e2[3], e3[3], c[3];
    for (int i = 0; i < 3; i++) {
      PetscCheck(v[i] >= 0 && v[i] < s->n_nodes, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "triangle %" PetscInt_FMT " has node %" PetscInt_FMT " of %" PetscInt_FMT, t, v[i], s->n_nodes);
    }
    Sub3(&s->X[3*v[1]], &s->X[3*v[0]], e1);
    Sub3(&s->X[3*v[2]], &s->X[3*v[0]], e2);
    Sub3(&s->X[3*v[2]], &s->X[3*v[1]], e3);
    Cross3(e1, e2, c);
    // round-off level: a triangle this thin has no normal
    if (!(Norm3(c) > 1e-10 * PetscMax(Dot3(e1, e1), PetscMax(Dot3(e2, e2), Dot3(e3, e3))))) {
      PetscFunctionReturn(InputError(key, "has a triangle without area at (%g, %g, %g), nodes %" PetscInt_FMT " %" PetscInt_FMT " %" PetscInt_FMT "\n  remesh the surface or remove the triangle", (double)s->X[3*v[0]], (double)s->X[3*v[0] + 1], (double)s->X[3*v[0] + 2], v[0], v[1], v[2]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EdgeError(const char key[], const ProxySurface *s, PetscInt a, PetscInt b, const char what[])
{
  const PetscReal *p = &s->X[3*a], *q = &s->X[3*b];
  return InputError(key, "has an edge %s: from (%g, %g, %g) to (%g, %g, %g), nodes %" PetscInt_FMT " and %" PetscInt_FMT "\n  a wetted surface needs at most two triangles at an edge, oriented alike", what, (double)p[0], (double)p[1], (double)p[2], (double)q[0], (double)q[1], (double)q[2], a, b);
}

/* unique edges from half-edges bucketed by their lower node */
static PetscErrorCode BuildEdges(const char key[], ProxySurface *s)
{
  PetscInt *start, *item, n = s->n_triangles, n_edges = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc7(6*n, &s->edge_nodes, 6*n, &s->edge_triangles, 6*n, &s->edge_side, 3*n, &s->triangle_edges, 3*n, &s->edge_sharp, 3*n, &s->edge_feature, 3*n, &s->edge_fold));
  PetscCall(PetscCalloc1(s->n_nodes + 2, &start));
  PetscCall(PetscMalloc1(3*n, &item));
  for (PetscInt i = 0; i < 3*n; i++) {
    const PetscInt a = s->triangles[i], b = s->triangles[3*(i/3) + (i%3 + 1)%3];
    start[PetscMin(a, b) + 2]++;
  }
  for (PetscInt v = 0; v < s->n_nodes; v++) start[v + 2] += start[v + 1];
  for (PetscInt i = 0; i < 3*n; i++) {
    const PetscInt a = s->triangles[i], b = s->triangles[3*(i/3) + (i%3 + 1)%3];
    item[start[PetscMin(a, b) + 1]++] = i;
  }

  // within a bucket, match half-edges by their upper node
  for (PetscInt v = 0; v < s->n_nodes; v++) {
    const PetscInt first = n_edges;
    for (PetscInt k = start[v]; k < start[v + 1]; k++) {
      const PetscInt i = item[k], t = i/3, side = i%3;
      const PetscInt a = s->triangles[i], b = s->triangles[3*t + (side + 1)%3], high = PetscMax(a, b);
      PetscInt       e = first;
      while (e < n_edges && s->edge_nodes[2*e + 1] != high) e++;
      if (e == n_edges) {
        s->edge_nodes[2*e]     = v;
        s->edge_nodes[2*e + 1] = high;
        s->edge_triangles[2*e] = t, s->edge_triangles[2*e + 1] = -1;
        s->edge_side[2*e] = side, s->edge_side[2*e + 1] = -1;
        n_edges++;
      } else {
        const PetscInt other = 3*s->edge_triangles[2*e] + s->edge_side[2*e];
        const char    *what  = NULL;
        if (s->edge_triangles[2*e + 1] >= 0) what = "shared by three triangles";
        else if (s->triangles[other] == a) what = "whose two triangles are oriented against each other";
        if (what) {
          PetscCall(PetscFree(start));
          PetscCall(PetscFree(item));
          PetscFunctionReturn(EdgeError(key, s, v, high, what));
        }
        s->edge_triangles[2*e + 1] = t;
        s->edge_side[2*e + 1]      = side;
      }
      s->triangle_edges[i] = e;
    }
  }
  s->n_edges = n_edges;
  PetscCall(PetscFree(start));
  PetscCall(PetscFree(item));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* whether the dihedral angle of every edge is beyond feature_angle [degree] at the places x; open edges: no */
static void MarkFolds(PetscReal feature_angle, const ProxySurface *s, const PetscReal x[], PetscBool fold[])
{
  const double limit = cos(PetscMin(feature_angle, 180.0) * BY_PI/180.0);

  for (PetscInt e = 0; e < s->n_edges; e++) {
    double n[2][3];
    fold[e] = PETSC_FALSE;
    if (s->edge_triangles[2*e + 1] < 0) continue;
    for (int k = 0; k < 2; k++) {
      const PetscInt *v = &s->triangles[3*s->edge_triangles[2*e + k]];
      double          e1[3], e2[3];
      Sub3(&x[3*v[1]], &x[3*v[0]], e1);
      Sub3(&x[3*v[2]], &x[3*v[0]], e2);
      Cross3(e1, e2, n[k]);
    }
    fold[e] = (PetscBool)(Dot3(n[0], n[1]) < limit * Norm3(n[0]) * Norm3(n[1]));
  }
}

/* patches: triangles connected through smooth edges, numbered by their first triangle */
static PetscErrorCode BuildPatches(ProxySurface *s)
{
  PetscInt *stack, n = s->n_triangles, n_stack = 0;

  PetscFunctionBegin;
  s->n_patches = 0;
  PetscCall(PetscMalloc1(n, &s->patch));
  PetscCall(PetscMalloc1(n, &stack));
  for (PetscInt t = 0; t < n; t++) s->patch[t] = -1;
  for (PetscInt first = 0; first < n; first++) {
    if (s->patch[first] >= 0) continue;
    s->patch[first]  = s->n_patches;
    stack[n_stack++] = first;
    while (n_stack) {
      const PetscInt t = stack[--n_stack];
      for (int i = 0; i < 3; i++) {
        const PetscInt e = s->triangle_edges[3*t + i];
        if (s->edge_sharp[e]) continue;
        const PetscInt other = s->edge_triangles[2*e] == t ? s->edge_triangles[2*e + 1] : s->edge_triangles[2*e];
        if (s->patch[other] >= 0) continue;
        s->patch[other]  = s->n_patches;
        stack[n_stack++] = other;
      }
    }
    s->n_patches++;
  }
  PetscCall(PetscFree(stack));
  PetscCall(PetscCalloc2(s->n_patches, &s->patch_open, s->n_patches, &s->patch_sharp));
  for (PetscInt e = 0; e < s->n_edges; e++) {
    if (!s->edge_sharp[e]) continue;
    for (int k = 0; k < 2; k++) {
      const PetscInt t = s->edge_triangles[2*e + k];
      if (t < 0) s->patch_open[s->patch[s->edge_triangles[2*e]]] = PETSC_TRUE;
      else if (s->edge_triangles[2*e + 1] >= 0 && s->patch[s->edge_triangles[2*e]] != s->patch[s->edge_triangles[2*e + 1]]) s->patch_sharp[s->patch[t]] = PETSC_TRUE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt FindRoot(PetscInt parent[], PetscInt i)
{
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

static PetscErrorCode DestroyPatches(ProxySurface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(s->patch));
  PetscCall(PetscFree2(s->patch_open, s->patch_sharp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A patch of less than 0.03 h^2 is noise at the kernel's scale (a fold of a scanned mesh): it joins the neighbour with which it shares the
   longest border, so that its plane does not act as a half space. */
static PetscErrorCode AbsorbSmallPatches(PetscReal h, ProxySurface *s)
{
  PetscReal *area, *border;
  PetscInt   joined = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(s->n_patches, &area, s->n_patches, &border));
  for (PetscInt t = 0; t < s->n_triangles; t++) {
    const PetscInt *v = &s->triangles[3*t];
    double          e1[3], e2[3], c[3];
    Sub3(&s->X[3*v[1]], &s->X[3*v[0]], e1);
    Sub3(&s->X[3*v[2]], &s->X[3*v[0]], e2);
    Cross3(e1, e2, c);
    area[s->patch[t]] += 0.5*Norm3(c);
  }
  for (PetscInt p = 0; p < s->n_patches; p++) {
    PetscInt best = -1;
    if (area[p] >= 0.03*h*h) continue;
    for (int pass = 0; pass < 2; pass++) { // measure the borders, then open the longest
      for (PetscInt e = 0; e < s->n_edges; e++) {
        const PetscInt t = s->edge_triangles[2*e], u = s->edge_triangles[2*e + 1];
        if (!s->edge_sharp[e] || u < 0 || s->patch[t] == s->patch[u] || (s->patch[t] != p && s->patch[u] != p)) continue;
        const PetscInt other = s->patch[t] == p ? s->patch[u] : s->patch[t];
        double         r[3];
        Sub3(&s->X[3*s->edge_nodes[2*e + 1]], &s->X[3*s->edge_nodes[2*e]], r);
        if (!pass) border[other] += Norm3(r);
        else if (other == best) s->edge_sharp[e] = PETSC_FALSE, joined++;
      }
      for (PetscInt q = 0; !pass && q < s->n_patches; q++) {
        if (border[q] > (best < 0 ? 0.0 : border[best])) best = q;
      }
      if (best < 0) break;
    }
    PetscCall(PetscArrayzero(border, s->n_patches));
  }
  PetscCall(PetscFree2(area, border));
  if (joined) {
    PetscCall(DestroyPatches(s));
    PetscCall(BuildPatches(s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* fans: corners of one vertex that meet across smooth edges (union-find over corners), numbered by their first corner */
static PetscErrorCode BuildFans(ProxySurface *s)
{
  PetscInt *parent, *at, n = 3*s->n_triangles;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n, &s->fan, n, &s->fan_corner));
  PetscCall(PetscMalloc1(n, &parent));
  for (PetscInt i = 0; i < n; i++) parent[i] = i;
  for (PetscInt e = 0; e < s->n_edges; e++) {
    if (s->edge_sharp[e]) continue;
    const PetscInt t = s->edge_triangles[2*e], u = s->edge_triangles[2*e + 1], i = s->edge_side[2*e], j = s->edge_side[2*e + 1];
    // oriented alike: the side runs the other way round in the second triangle
    const PetscInt pairs[2][2] = {{3*t + i, 3*u + (j + 1)%3}, {3*t + (i + 1)%3, 3*u + j}};
    for (int k = 0; k < 2; k++) {
      const PetscInt a = FindRoot(parent, pairs[k][0]), b = FindRoot(parent, pairs[k][1]);
      parent[PetscMax(a, b)] = PetscMin(a, b);
    }
  }
  s->n_fans = 0;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt root = FindRoot(parent, i);
    s->fan[i] = root == i ? s->n_fans++ : s->fan[root];
  }
  PetscCall(PetscFree(parent));

  PetscCall(PetscCalloc1(s->n_fans, &s->fan_sharp));
  for (PetscInt i = 0; i < n; i++) {
    if (s->edge_sharp[s->triangle_edges[i]]) s->fan_sharp[s->fan[i]] = s->fan_sharp[s->fan[3*(i/3) + (i + 1)%3]] = PETSC_TRUE;
  }
  PetscCall(PetscCalloc1(s->n_fans + 1, &s->fan_start));
  PetscCall(PetscMalloc1(s->n_fans, &at));
  for (PetscInt i = 0; i < n; i++) s->fan_start[s->fan[i] + 1]++;
  for (PetscInt f = 0; f < s->n_fans; f++) {
    s->fan_start[f + 1] += s->fan_start[f];
    at[f] = s->fan_start[f];
  }
  for (PetscInt i = 0; i < n; i++) s->fan_corner[at[s->fan[i]]++] = i;
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sharp edges, smooth patches between them, fans */
static PetscErrorCode BuildSmoothParts(PetscReal h, ProxySurface *s)
{
  PetscFunctionBegin;
  for (PetscInt e = 0; e < s->n_edges; e++) s->edge_sharp[e] = (PetscBool)(s->edge_triangles[2*e + 1] < 0 || s->edge_feature[e] || s->edge_fold[e]);
  PetscCall(BuildPatches(s));
  PetscCall(AbsorbSmallPatches(h, s));
  PetscCall(BuildFans(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFans(ProxySurface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(s->fan, s->fan_corner));
  PetscCall(PetscFree(s->fan_start));
  PetscCall(PetscFree(s->fan_sharp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxySurfaceFold(PetscReal feature_angle, const ProxyFluid *fluid, const PetscReal x[], ProxySurface *s, PetscBool *changed)
{
  PetscBool *fold, same;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->n_edges, &fold));
  MarkFolds(feature_angle, s, x, fold);
  PetscCall(PetscArraycmp(fold, s->edge_fold, s->n_edges, &same));
  *changed = (PetscBool)!same;
  if (!same) {
    PetscCall(PetscArraycpy(s->edge_fold, fold, s->n_edges));
    PetscCall(DestroyPatches(s));
    PetscCall(DestroyFans(s));
    PetscCall(BuildSmoothParts(fluid->h, s));
  }
  PetscCall(PetscFree(fold));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ProxySurfaceCreased(PetscReal feature_angle, const ProxySurface *s, const PetscReal normal[])
{
  const double fold = cos(PetscMin(180.0, feature_angle + PROXY_FOLD_MARGIN)*BY_PI/180.0), smooth = cos(PetscMax(0.0, feature_angle - PROXY_FOLD_MARGIN)*BY_PI/180.0);
  int          creased = 0;

#pragma omp parallel for schedule(static) reduction(| : creased)
  for (PetscInt e = 0; e < s->n_edges; e++) {
    if (s->edge_triangles[2*e + 1] < 0 || s->edge_feature[e]) continue;
    const double cosine = Dot3(&normal[3*s->edge_triangles[2*e]], &normal[3*s->edge_triangles[2*e + 1]]);
    creased |= s->edge_fold[e] ? cosine > smooth : cosine < fold;
  }
  return (PetscBool)creased;
}

/* Build the connectivity of a surface. `key` is the scene key that named it, for messages; an edge of three triangles, neighbours
   of opposite orientation and triangles without area are the user's errors. */
PetscErrorCode ProxySurfaceBuild(const char key[], PetscReal feature_angle, const ProxyFluid *fluid, PetscInt n_nodes, const PetscReal X[],
                                 PetscInt n_triangles, const PetscInt triangles[], ProxySurface *surface)
{
  PetscFunctionBegin;
  PetscCall(CopyTriangles(fluid, n_nodes, X, n_triangles, triangles, surface));
  ByCall(CheckTriangles(key, surface));
  ByCall(BuildEdges(key, surface));
  MarkFolds(feature_angle, surface, surface->X, surface->edge_feature);
  PetscCall(PetscArraycpy(surface->edge_fold, surface->edge_feature, surface->n_edges));
  PetscCall(BuildSmoothParts(fluid->h, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProxySurfaceDestroy(ProxySurface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(s->X, s->triangles));
  PetscCall(PetscFree7(s->edge_nodes, s->edge_triangles, s->edge_side, s->triangle_edges, s->edge_sharp, s->edge_feature, s->edge_fold));
  PetscCall(DestroyPatches(s));
  PetscCall(DestroyFans(s));
  PetscCall(PetscMemzero(s, sizeof(*s)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
