/* proxy_combine.h - several smooth patches of one body at one particle (method 4.4 at edges, corners and thin sheets). Host and
   device.

   Patch p gives the part lambda_p of the kernel's volume behind its surface, a height z_p, a normal n_p and a foot point f_p.
   Two patches are convex neighbours when each foot lies behind the other's plane: the body is the intersection of their half spaces;
   concave, when each lies in front: the union. With u, v the two parts and alpha the angle between the normals, the intersection's part is
   Plackett's copula C(u, v; theta) [Plackett 1965, J. Amer. Statist. Assoc. 60, 516], sqrt(theta) = (pi - alpha)/alpha:
     alpha = 90 degrees: C = u v, the product rule of method 2;  alpha -> 0: C -> min(u, v);  alpha -> 180: C -> max(0, u+v-1)
     u = v = 1/2 (on the edge): C = (pi - alpha)/(2 pi), exact for every radial kernel
     C(u,v) = u + v - 1 + C(1-u,1-v): unions are u + v - C(u,v), consistent with intersections of the complement.
   More patches: unions of intersections of unions ..., as the relations allow (ProxyCotree()).

   The two faces of a thin sheet (convex, normals opposed) would take volume off each other: the one behind is neutral for a
   particle in front of the other, and between them the nearer one decides (one-sidedness of method 4.3).

   Everything is differentiated forward, per patch, so that the gradient is exact and splits into the patches' parts. */
#ifndef BY_PROXY_COMBINE_H
#define BY_PROXY_COMBINE_H

#include "proxy/proxy_kernel.h"

#define PROXY_PATCHES 8        /* patches of one body within reach of one particle; further ones are left out          */
#define PROXY_RIM_COVERAGE 0.4 /* an open rim fades when the proxies cover less than this part of the tangent plane     */
#define PROXY_MIN_COVERAGE 0.1 /* so does everything when they cover less than this: beyond a corner at 0.4 h it is 0.06 */

/* Shepard means over the proxies of one patch at one particle, with gradients (grad_n: row k is the gradient of n_k) */
typedef struct {
  double lambda, grad_lambda[3];     /* [1], [1/m]                                       */
  double z, grad_z[3];               /* height [m]                                       */
  double n[3], grad_n[9];            /* mean normal, not normalised                      */
  double foot[3];                    /* [m], mean centre of the surface, from the particle */
  double coverage, grad_coverage[3]; /* sum of A w: 1 inside a patch, 1/2 on its border  */
  double exposed, grad_exposed[3];   /* part of the patch that acts, 0 where it lies on a wall */
  int    open;                       /* the patch has an open border                     */
} ProxyPatchValue;

/* a number and its gradient by patch */
typedef struct {
  double v, g[3*PROXY_PATCHES];
} ProxyDual;

/* a half space or a combination of them: s times the part of the kernel's volume, a representative normal, the height above it, and how
   much of the tangent plane its proxies cover */
typedef struct {
  ProxyDual y, n[3], z, coverage;
} ProxyNode;

BY_HD ProxyDual ProxyDualOf(double v)
{
  ProxyDual a;
  a.v = v;
  for (int k = 0; k < 3*PROXY_PATCHES; k++) a.g[k] = 0.0;
  return a;
}
/* alpha a + beta b */
BY_HD ProxyDual ProxyDualSum(double alpha, const ProxyDual *a, double beta, const ProxyDual *b)
{
  ProxyDual c;
  c.v = alpha*a->v + beta*b->v;
  for (int k = 0; k < 3*PROXY_PATCHES; k++) c.g[k] = alpha*a->g[k] + beta*b->g[k];
  return c;
}
/* f(a, b) from its value and two partial derivatives */
BY_HD ProxyDual ProxyDualOf2(double f, double fa, const ProxyDual *a, double fb, const ProxyDual *b)
{
  ProxyDual c = ProxyDualSum(fa, a, fb, b);
  c.v = f;
  return c;
}
BY_HD ProxyDual ProxyDualTimes(const ProxyDual *a, const ProxyDual *b)
{
  return ProxyDualOf2(a->v*b->v, b->v, a, a->v, b);
}
BY_HD ProxyDual ProxyDualDot(const ProxyDual a[3], const ProxyDual b[3])
{
  ProxyDual c = ProxyDualTimes(&a[0], &b[0]);
  for (int k = 1; k < 3; k++) {
    const ProxyDual ab = ProxyDualTimes(&a[k], &b[k]);
    c = ProxyDualSum(1.0, &c, 1.0, &ab);
  }
  return c;
}
/* n / |n|; returns 0 and leaves n alone when it has no direction */
BY_HD int ProxyDualNormalize(ProxyDual n[3])
{
  const ProxyDual n2 = ProxyDualDot(n, n);

  if (n2.v < 1e-12) return 0;
  const double    r = 1.0 / sqrt(n2.v);
  const ProxyDual s = ProxyDualOf2(r, -0.5*r/n2.v, &n2, 0.0, &n2);
  for (int k = 0; k < 3; k++) n[k] = ProxyDualTimes(&n[k], &s);
  return 1;
}

/* Plackett's copula C(u, v; theta) and its three partial derivatives; u, v in [0, 1] */
BY_HD double ProxyCopula(double u, double v, double theta, double *Cu, double *Cv, double *Ctheta)
{
  const double eta = theta - 1.0, S = 1.0 + eta*(u + v), root = sqrt(S*S - 4.0*u*v*theta*eta);

  // near independence: the series, free of cancellation
  if (fabs(eta) < 1e-4) {
    const double a = u*(1.0 - u), b = v*(1.0 - v);
    *Cu     = v + eta*(1.0 - 2.0*u)*b;
    *Cv     = u + eta*(1.0 - 2.0*v)*a;
    *Ctheta = a*b;
    return u*v + eta*a*b;
  }
  *Cu     = 0.5*(1.0 - (1.0 + eta*u - (theta + 1.0)*v)/root);
  *Cv     = 0.5*(1.0 - (1.0 + eta*v - (theta + 1.0)*u)/root);
  *Ctheta = (u + v - (S*(u + v) - 2.0*u*v*(2.0*theta - 1.0))/root)/(2.0*eta) - (S - root)/(2.0*eta*eta);
  // (S - root)/(2 eta) without cancellation
  return 2.0*u*v*theta/(S + root);
}

/* theta of the angle between two unit normals, and d theta/d cos; alpha is kept within [0.1, pi - 0.1], theta finite */
BY_HD double ProxyCopulaTheta(double cosine, double *slope)
{
  const double c = cosine > 1.0 ? 1.0 : cosine < -1.0 ? -1.0 : cosine, alpha = acos(c);
  const double a = alpha < 0.1 ? 0.1 : alpha > BY_PI - 0.1 ? BY_PI - 0.1 : alpha, k = (BY_PI - a)/a;

  *slope = a == alpha ? 2.0*k*BY_PI/(a*a*sqrt(1.0 - c*c)) : 0.0;
  return k*k;
}

/* smooth step of coverage over what must be covered: `least`, less for a particle far off, which sees only the proxies right
   beneath it (over the outer half of h) */
BY_HD ProxyDual ProxyCovered(double h, double least, const ProxyDual *coverage, const ProxyDual *z)
{
  const double sign = z->v < 0.0 ? -1.0 : 1.0;
  double       slope;
  const double part = ProxySmoothStep((h - sign*z->v)/(0.5*h), &slope), need = least*part;

  if (coverage->v >= need) return ProxyDualOf(1.0);
  const double need_slope = -sign*least*slope/(0.5*h), value = ProxySmoothStep(coverage->v/need, &slope);
  return ProxyDualOf2(value, slope/need, coverage, -slope*coverage->v/(need*need)*need_slope, z);
}

/* A node ends where its proxies end. As one of a union's two: where they no longer cover the particle's tangent plane, for there it would
   be a half space that the surface does not have (a flap of a fold, a step lower than the kernel). As the whole body: a particle behind it
   (over 0.2 h) that they do not cover is not inside but past a bend; and one of which they see next to nothing is not there. */
BY_HD void ProxyTrust(double h, int whole, ProxyNode *a)
{
  double       slope = 0.0;
  const double behind = whole ? ProxySmoothStep(-a->z.v/(0.2*h), &slope) : 1.0;

  if (whole) {
    const ProxyDual seen = ProxyCovered(h, PROXY_MIN_COVERAGE, &a->coverage, &a->z);
    if (seen.v < 1.0) a->y = ProxyDualTimes(&a->y, &seen);
  }
  if (behind == 0.0) return;
  const ProxyDual covered = ProxyCovered(h, PROXY_RIM_COVERAGE, &a->coverage, &a->z);
  const ProxyDual trust = ProxyDualOf2(1.0 - (1.0 - covered.v)*behind, behind, &covered, (1.0 - covered.v)*slope/(0.2*h), &a->z);
  a->y = ProxyDualTimes(&a->y, &trust);
}

/* intersection (convex) or union of two nodes; s = calibration factor carried by both */
BY_HD void ProxyCombine(int convex, double h, double s, ProxyNode *a, ProxyNode *b, ProxyNode *out)
{
  if (!convex) {
    ProxyTrust(h, 0, a);
    ProxyTrust(h, 0, b);
  }
  const ProxyDual cosine = ProxyDualDot(a->n, b->n);
  double          slope, Cu, Cv, Ct, u = a->y.v/s, v = b->y.v/s, C;
  const double    theta = ProxyCopulaTheta(cosine.v, &slope);
  ProxyDual       product, sum;

  u = u < 0.0 ? 0.0 : u > 1.0 ? 1.0 : u;
  v = v < 0.0 ? 0.0 : v > 1.0 ? 1.0 : v;
  C = ProxyCopula(u, v, theta, &Cu, &Cv, &Ct);
  if (convex) { // s C
    product = ProxyDualOf2(s*C, Cu, &a->y, Cv, &b->y);
    out->y  = ProxyDualOf2(s*C, 1.0, &product, s*Ct*slope, &cosine);
  } else { // y_a + y_b - s^2 C: at 90 degrees 1 - (1 - s u)(1 - s v), the rule of planar walls
    product = ProxyDualOf2(s*s*C, s*Cu, &a->y, s*Cv, &b->y);
    product = ProxyDualOf2(s*s*C, 1.0, &product, s*s*Ct*slope, &cosine);
    sum     = ProxyDualSum(1.0, &a->y, 1.0, &b->y);
    out->y  = ProxyDualSum(1.0, &sum, -1.0, &product);
  }

  // in front of an intersection when in front of one, of a union when in front of both
  out->z        = (a->z.v > b->z.v) == (convex != 0) ? a->z : b->z;
  out->coverage = ProxyDualSum(1.0, &a->coverage, 1.0, &b->coverage);

  // representative normal: an intersection is ruled by the smaller part, a union by the larger
  ProxyDual wa = ProxyDualOf2(convex ? 1.001 - u : 0.001 + u, (convex ? -1.0 : 1.0)/s, &a->y, 0.0, &a->y);
  ProxyDual wb = ProxyDualOf2(convex ? 1.001 - v : 0.001 + v, (convex ? -1.0 : 1.0)/s, &b->y, 0.0, &b->y);
  for (int k = 0; k < 3; k++) {
    const ProxyDual na = ProxyDualTimes(&wa, &a->n[k]), nb = ProxyDualTimes(&wb, &b->n[k]);
    out->n[k] = ProxyDualSum(1.0, &na, 1.0, &nb);
  }
  if (!ProxyDualNormalize(out->n)) {
    for (int k = 0; k < 3; k++) out->n[k] = a->n[k];
  }
}

/* the patches of `set` that hang together with its first one in the relation `related` (bit sets by patch) */
BY_HD unsigned ProxyComponent(unsigned set, const unsigned related[PROXY_PATCHES])
{
  unsigned component = set & (~set + 1u), before = 0u;

  while (component != before) {
    before = component;
    for (int p = 0; p < PROXY_PATCHES; p++) {
      if (before & (1u << p)) component |= related[p] & set;
    }
  }
  return component;
}

/* Combine the leaves along a cotree of the relations: no convex pair between two groups -> their union; no concave pair between them ->
   their intersection; else (teeth finer than h) the patch that the particle is farthest behind is taken out by intersection. Pairs
   that are neither convex nor concave fit both ways. Iterative: sets are split first, then evaluated backwards. */
BY_HD void ProxyCotree(int n, double h, double s, const unsigned convex[PROXY_PATCHES], const unsigned concave[PROXY_PATCHES],
                       ProxyNode leaf[], ProxyNode *total)
{
  unsigned set[2*PROXY_PATCHES];
  int      parent[2*PROXY_PATCHES], is_convex[2*PROXY_PATCHES], slot[2*PROXY_PATCHES], n_sets = 1;

  // split sets until they are single patches; a parent comes before its halves
  set[0]    = (1u << n) - 1u;
  parent[0] = -1;
  for (int i = 0; i < n_sets; i++) {
    const unsigned lowest = set[i] & (~set[i] + 1u);
    unsigned       part;

    is_convex[i] = 0;
    if (set[i] == lowest) continue;
    part = ProxyComponent(set[i], convex);
    if (part == set[i]) {
      is_convex[i] = 1;
      part         = ProxyComponent(set[i], concave);
      if (part == set[i]) {
        int deepest = -1;
        for (int p = 0; p < n; p++) {
          if ((set[i] & (1u << p)) && (deepest < 0 || leaf[p].z.v < leaf[deepest].z.v)) deepest = p;
        }
        part = 1u << deepest;
      }
    }
    set[n_sets] = part;
    parent[n_sets++] = i;
    set[n_sets] = set[i] & ~part;
    parent[n_sets++] = i;
  }

  // combine backwards; the result of a set lives in the leaf of one of its patches
  for (int i = n_sets - 1; i >= 0; i--) {
    const unsigned lowest = set[i] & (~set[i] + 1u);
    if (set[i] == lowest) {
      for (slot[i] = 0; lowest != (1u << slot[i]);) slot[i]++;
    } else {
      int half[2], m = 0;
      for (int j = i + 1; j < n_sets; j++) {
        if (parent[j] == i) half[m++] = slot[j];
      }
      ProxyNode out;
      ProxyCombine(is_convex[i], h, s, &leaf[half[0]], &leaf[half[1]], &out);
      leaf[half[0]] = out;
      slot[i]       = half[0];
    }
  }
  *total = leaf[slot[0]];
}

/* How far patch q is neutral because p, its opposite across a thin sheet, is nearer; 0 .. 1. o(cos): only nearly parallel faces are a
   sheet (from 150 to 166 degrees between the normals), a wedge is an intersection. In front of p, q is neutral, as far as the particle is
   behind q at all (0.05 h: a rounded tip); between the two, z_q/(z_p + z_q) tells which is nearer. */
BY_HD ProxyDual ProxyNeutral(double h, const ProxyDual *z_p, const ProxyDual *z_q, const ProxyDual *cosine)
{
  double       slope, part, part_p = 0.0, part_q = 0.0;
  const double sum = z_p->v + z_q->v;

  if (z_q->v >= 0.0) return ProxyDualOf(0.0);
  const double    o = ProxySmoothStep((-cosine->v - 0.866)/0.104, &slope);
  const ProxyDual opposed = ProxyDualOf2(o, -slope/0.104, cosine, 0.0, cosine);
  const double    tip = ProxySmoothStep(-z_q->v/(0.05*h), &slope), tip_slope = -slope/(0.05*h);
  part = 1.0;
  if (z_p->v < 0.0) {
    part   = ProxySmoothStep(z_q->v/sum, &slope);
    part_p = -slope*z_q->v/(sum*sum);
    part_q = slope*z_p->v/(sum*sum);
  }
  const ProxyDual nearer = ProxyDualOf2(part*tip, part_p*tip, z_p, part_q*tip + part*tip_slope, z_q);
  return ProxyDualTimes(&opposed, &nearer);
}

/* phi of a body at a particle from its n patches, and the part of its gradient that belongs to each (n x 3); s = calibration */
BY_HD double ProxyBodyPhi(int n, double h, double s, const ProxyPatchValue patch[], double grad[][3])
{
  ProxyNode leaf[PROXY_PATCHES], total;
  ProxyDual coverage = ProxyDualOf(0.0);
  unsigned  convex[PROXY_PATCHES], concave[PROXY_PATCHES];
  const double tol = 1e-6*h; // round-off of feet on one plane

  // leaves: s lambda, normals, heights
  for (int p = 0; p < n; p++) {
    leaf[p].y = ProxyDualOf(s*patch[p].lambda);
    leaf[p].z        = ProxyDualOf(patch[p].z);
    leaf[p].coverage = ProxyDualOf(patch[p].coverage);
    coverage.v += patch[p].coverage;
    for (int k = 0; k < 3; k++) {
      leaf[p].y.g[3*p + k] = s*patch[p].grad_lambda[k];
      leaf[p].z.g[3*p + k]        = patch[p].grad_z[k];
      leaf[p].coverage.g[3*p + k] = coverage.g[3*p + k] = patch[p].grad_coverage[k];
      leaf[p].n[k]         = ProxyDualOf(patch[p].n[k]);
      for (int j = 0; j < 3; j++) leaf[p].n[k].g[3*p + j] = patch[p].grad_n[3*k + j];
    }
    ProxyDualNormalize(leaf[p].n);
    convex[p] = concave[p] = 0u;
  }

  // relations; the opposite face of a thin sheet is neutral: 1 - lambda is taken down by 1 - g
  for (int p = 0; p < n; p++) {
    for (int q = 0; q < p; q++) {
      double a = 0.0, b = 0.0; // height of q's foot above p's plane, of p's above q's
      for (int k = 0; k < 3; k++) {
        a += leaf[p].n[k].v*(patch[q].foot[k] - patch[p].foot[k]);
        b += leaf[q].n[k].v*(patch[p].foot[k] - patch[q].foot[k]);
      }
      if (a <= tol && b <= tol && a + b < -tol) convex[p] |= 1u << q, convex[q] |= 1u << p;
      if (a >= -tol && b >= -tol && a + b > tol) concave[p] |= 1u << q, concave[q] |= 1u << p;
    }
  }
  for (int q = 0; q < n; q++) {
    for (int p = 0; p < n; p++) {
      if (p == q || !(convex[p] & (1u << q))) continue;
      const ProxyDual cosine = ProxyDualDot(leaf[p].n, leaf[q].n);
      if (cosine.v > -0.866) continue;
      const ProxyDual g = ProxyNeutral(h, &leaf[p].z, &leaf[q].z, &cosine);
      leaf[q].y = ProxyDualOf2(s - (s - leaf[q].y.v)*(1.0 - g.v), 1.0 - g.v, &leaf[q].y, s - leaf[q].y.v, &g);
    }
  }

  // open rims end where the proxies of all patches together no longer cover the particle's tangent plane
  for (int p = 0; p < n; p++) {
    if (!patch[p].open) continue;
    const ProxyDual cut = ProxyCovered(h, PROXY_RIM_COVERAGE, &coverage, &leaf[p].z);
    if (cut.v < 1.0) leaf[p].y = ProxyDualTimes(&leaf[p].y, &cut);
  }

  ProxyCotree(n, h, s, convex, concave, leaf, &total);
  ProxyTrust(h, 1, &total);
  for (int p = 0; p < n; p++) {
    for (int k = 0; k < 3; k++) grad[p][k] = total.y.g[3*p + k];
  }
  return total.y.v;
}

/* The same when patches lie on walls: in full they are not there at all. Between, the value goes from one to the other in proportion, patches
   leaving in the order of their exposure E: phi = sum_k (E_k - E_k+1) phi(patches 1 .. k), E_1 >= E_2 >= ... (Lovasz's extension of the
   set function). Continuous; the gradient is exact but where two exposures cross. */
BY_HD double ProxyExposedPhi(int n, double h, double s, const ProxyPatchValue patch[], double grad[][3])
{
  ProxyPatchValue some[PROXY_PATCHES];
  double          part[PROXY_PATCHES][3], phi = 0.0, before = 0.0;
  int             order[PROXY_PATCHES];

  for (int p = 0; p < n; p++) {
    int at = p;
    for (; at > 0 && patch[order[at - 1]].exposed < patch[p].exposed; at--) order[at] = order[at - 1];
    order[at] = p;
    for (int k = 0; k < 3; k++) grad[p][k] = 0.0;
  }
  for (int m = 1; m <= n && patch[order[m - 1]].exposed > 0.0; m++) {
    const double E = patch[order[m - 1]].exposed, next = m < n ? patch[order[m]].exposed : 0.0;
    some[m - 1] = patch[order[m - 1]];
    if (E == next && E == 1.0) continue; // all of the fully exposed come in together
    const double value = ProxyBodyPhi(m, h, s, some, part);
    phi += (E - next)*value;
    for (int q = 0; q < m; q++) {
      for (int k = 0; k < 3; k++) grad[order[q]][k] += (E - next)*part[q][k];
    }
    for (int k = 0; k < 3 && E < 1.0; k++) grad[order[m - 1]][k] += (value - before)*patch[order[m - 1]].grad_exposed[k];
    before = value;
  }
  return phi;
}

#endif
