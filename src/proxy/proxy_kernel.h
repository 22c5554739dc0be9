/* proxy_kernel.h - what one proxy does to one fluid particle: the half-space profile (method 4.4) and the paper's ellipsoid
   (method 4.3). Host and device. r = x_particle - x_proxy [m], n = outward unit normal, S = shape operator [1/m], symmetric
   (xx, yy, zz, xy, xz, yz) with S n = 0, convex positive; h = support radius [m] of the fluid's kernel. */
#ifndef BY_PROXY_KERNEL_H
#define BY_PROXY_KERNEL_H

#include "mat3.h"
#include "sph/sph_kernel.h"

/* what a proxy loses behind its surface: weights fall as exp(-(z/(0.15 h))^2), so that where two sides of a thin body are in
   reach the one in front decides, while a particle inside the body still sees the nearest side (the weights are normalised) */
#define PROXY_BACK_FADE 0.15
/* the ellipsoid kernel is not normalised: it fades to nothing over this part of h behind the surface */
#define PROXY_ELLIPSOID_FADE 0.25
/* weights end at distance h from the part of the surface that the proxy stands for, over this part of h */
#define PROXY_FAR_FADE 0.25
/* a particle that is past all that the proxies in reach stand for by the first part of h feels less and less of them, at the second nothing: whatever surface
   ends there, its other side is the nearer one, or it has none. What a right angle leaves of phi there is below 1e-3. */
#define PROXY_PAST_BEGIN 0.4
#define PROXY_PAST_END 0.7
/* the osculating surface is used from its own side only: weights end where 1 + c z0 falls from this to 0 (a ball's equator) */
#define PROXY_SIDE_FADE 0.5

/* how far beneath the mesh the profile has its surface, in dx. Half-space: settled water stands this much off the surfaces of held balls
   and cubes (R = 5 and 10 dx, side 10 dx: 0.04 to 0.06; docs/verification/proxy-slice.md). Ellipsoid: method 2. */
#define PROXY_INSET_HALF_SPACE 0.045
#define PROXY_INSET_ELLIPSOID 0.5

/* one proxy as the pair formulas see it */
typedef struct {
  double x[3];        /* position [m]; of the ellipsoid kernel: inset along -n                                          */
  double n[3];        /* outward unit normal                                                                            */
  double S[6];        /* shape operator [1/m]                                                                           */
  double bend;        /* c = tr S^3/tr S^2 [1/m], ProxyShapeBend(): the curvature of spheres and cylinders               */
  double e[3];        /* unit tangent; ellipsoid: of radius a                                                           */
  double offset;      /* mean height [m] of the surface that it stands for above its osculating surface, less the inset */
  double radius[2];   /* half-space: tangential radius h/kappa-bar [m], unused; ellipsoid: a, b [m] (c = h)             */
  double extent[8];   /* half-space: how far its part of the surface reaches from x in the directions e, m, (e + m)/sqrt 2,
                         (e - m)/sqrt 2, m = n x e, and then in the opposite ones [m]                                   */
  double weight;      /* half-space: area [m^2]; ellipsoid: volume Psi/rho0 [m^3] with the factor                       */
  double inset;       /* ellipsoid: depth of x beneath the surface [m]                                                  */
} ProxyPoint;

/* one pair of the half-space profile: weight w = A_b w_b, profile lambda, height z above the osculating surface */
typedef struct {
  double w, grad_w[3];           /* [1], [1/m]   */
  double lambda, grad_lambda[3]; /* [1], [1/m]   */
  double z, grad_z[3];           /* [m], [1]     */
  double beyond, out[3];         /* how far past the surface that the proxy stands for, in its tangent plane [m], and its gradient */
  double cover, grad_cover[3];   /* A w2 without the fades: its sum is 1 inside a patch, 1/2 on a straight border */
} ProxyPair;

/* Ellipsoid inset by dx/2: 0.85 at h = 2 dx, measured on a prototype with the cubic spline (method 2); nearer to 1 as (dx/h)^2 */
BY_HD double ProxyFactorEllipsoid(double h_over_dx)
{
  return 1.0 - 0.15 * 4.0 / (h_over_dx*h_over_dx);
}

/* K(d) = h^-2 int 2 pi t^3 W(sqrt(d^2 + t^2)) dt [1/m], second moment of the kernel in the plane at distance d >= 0 (method
   4.4). K'(d) = -2 d A(d)/h^2 with A of SPHPlaneDensity, so h K = int_q^1 2 s (h A)(s) ds, polynomial by pieces. */
BY_HD double ProxyPlaneMoment(int kernel, double d, double h)
{
  const double q = d / h, u = 1.0 - q, q2 = q*q, u5 = u*u*u*u*u;

  if (q >= 1.0) return 0.0;
  if (kernel == SPH_WENDLAND) return u5*u * (7.0 - u * (15.0 - u * (10.875 - u * (8.0/3.0)))) / h;
  if (kernel == SPH_POLY6) return 63.0/256.0 * (1.0 - q2)*(1.0 - q2)*(1.0 - q2)*(1.0 - q2)*(1.0 - q2) / h;
  if (kernel == SPH_SPIKY) return u5 * (3.0 - u * (4.5 - u * (12.0/7.0))) / h;
  if (q >= 0.5) return u5 * (3.2 - u * (4.8 - u * (64.0/35.0))) / h;
  return (31.0/140.0 - q2 * (1.4 - q2 * (4.0 - q2 * (8.0 - q * (38.4/7.0))))) / h;
}

/* cubic spline in two dimensions, radius R: value [1/m^2] and *F = (1/t) dw/dt [1/m^4]; 40/(7 pi R^2) {1 - 6q^2 + 6q^3; 2u^3} */
BY_HD double ProxyKernel2D(double t, double R, double *F)
{
  const double q = t / R, u = 1.0 - q, c = 40.0 / (7.0 * BY_PI * R*R);

  *F = 0.0;
  if (q >= 1.0) return 0.0;
  if (q < 0.5) {
    *F = c / (R*R) * (18.0*q - 12.0);
    return c * (1.0 - 6.0*q*q*u);
  }
  *F = c / (R*R) * (-6.0*u*u/q);
  return c * 2.0*u*u*u;
}

/* y = S t for a symmetric S (xx, yy, zz, xy, xz, yz) */
BY_HD void ProxyShapeTimes(const double S[6], const double t[3], double y[3])
{
  y[0] = S[0]*t[0] + S[3]*t[1] + S[4]*t[2];
  y[1] = S[3]*t[0] + S[1]*t[1] + S[5]*t[2];
  y[2] = S[4]*t[0] + S[5]*t[1] + S[2]*t[2];
}

/* smooth step 3 s^2 - 2 s^3 and its slope; 0 below 0, 1 above 1 */
BY_HD double ProxySmoothStep(double s, double *slope)
{
  *slope = 0.0;
  if (s <= 0.0) return 0.0;
  if (s >= 1.0) return 1.0;
  *slope = 6.0*s*(1.0 - s);
  return s*s*(3.0 - 2.0*s);
}

/* c = tr S^3/tr S^2 [1/m]: the curvature of a sphere, of a cylinder, 0 of a plane and of a minimal saddle */
BY_HD double ProxyShapeBend(const double S[6])
{
  const double mean = 0.5*(S[0] + S[1] + S[2]);
  const double square = S[0]*S[0] + S[1]*S[1] + S[2]*S[2] + 2.0*(S[3]*S[3] + S[4]*S[4] + S[5]*S[5]);
  const double gauss = 0.5*(4.0*mean*mean - square); // k1 k2, S has rank two

  // k1^3 + k2^3 = (k1 + k2)(k1^2 - k1 k2 + k2^2)
  return square > 0.0 ? 2.0*mean*(square - gauss)/square : 0.0;
}

/* Height z [m] of r above the osculating surface and its gradient: with F = n.r + 1/2 r.(S + c n n^T) r, z = 2 F/(1 + |grad F|), which is
   the distance from a plane, a sphere (c = curvature) and a cylinder to round-off, wherever on them the proxy lies; else to third
   order in |r|. The method's z = n.r + 1/2 H |t|^2 is its second-order part on a sphere. */
BY_HD double ProxyHeight(const ProxyPoint *b, double z0, const double t[3], double grad[3])
{
  double St[3], g[3], Sg[3], F, G;

  ProxyShapeTimes(b->S, t, St);
  F = z0 + 0.5*(Dot3(t, St) + b->bend*z0*z0);
  for (int k = 0; k < 3; k++) g[k] = (1.0 + b->bend*z0)*b->n[k] + St[k];
  G = Norm3(g);
  ProxyShapeTimes(b->S, g, Sg);
  const double along = b->bend*Dot3(b->n, g), u = 2.0/(1.0 + G), v = G > 0.0 ? -0.5*F*u*u/G : 0.0;
  for (int k = 0; k < 3; k++) grad[k] = u*g[k] + v*(Sg[k] + along*b->n[k]);
  return u*F;
}

/* S of a surface element with normal `from`, turned with it into the tangent plane of `to`: R S R^T, R the shortest rotation; added to T
   with a factor. Traces are kept, so a ball's proxies have its curvature however much of it they stand for. */
BY_HD void ProxyShapeAddTurned(const double S[6], const double from[3], const double to[3], double factor, double T[6])
{
  const double c = Dot3(from, to), f = c > -0.5 ? 1.0/(1.0 + c) : 0.0, M[9] = {S[0], S[3], S[4], S[3], S[1], S[5], S[4], S[5], S[2]};
  double       v[3], R[9], RM[9];

  // R = I + [v] + [v]^2/(1 + c), v = from x to; opposite normals are left alone
  Cross3(from, to, v);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) R[3*i + j] = f*v[i]*v[j] + (i == j ? (f > 0.0 ? c : 1.0) : 0.0);
  }
  if (f > 0.0) {
    R[1] -= v[2], R[2] += v[1], R[3] += v[2], R[5] -= v[0], R[6] -= v[1], R[7] += v[0];
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) RM[3*i + j] = R[3*i]*M[j] + R[3*i + 1]*M[3 + j] + R[3*i + 2]*M[6 + j];
  }
  for (int k = 0; k < 3; k++) {
    const int i = k == 2 ? 1 : 0, j = k == 0 ? 1 : 2;
    T[k] += factor*Dot3(&RM[3*k], &R[3*k]);
    T[3 + k] += factor*Dot3(&RM[3*i], &R[3*j]);
  }
}

/* Distance in the tangent plane of t from the octagon around the part of the surface that a proxy stands for; 0 inside; direction in grad */
BY_HD double ProxyBeyond(const ProxyPoint *b, const double t[3], double grad[3])
{
  const double diagonal = 0.70710678118654752440;
  double       m[3], beyond = 0.0, u = 0.0, v = 0.0;

  Cross3(b->n, b->e, m);
  const double x = Dot3(b->e, t), y = Dot3(m, t), c[4] = {x, y, diagonal*(x + y), diagonal*(x - y)};
  for (int k = 0; k < 8; k++) {
    const double sign = k < 4 ? 1.0 : -1.0, d = sign*c[k & 3] - b->extent[k];
    if (d <= beyond) continue;
    beyond = d;
    u = sign*((k & 3) == 0 ? 1.0 : (k & 3) == 1 ? 0.0 : diagonal);
    v = sign*((k & 3) == 0 ? 0.0 : (k & 3) == 1 ? 1.0 : (k & 3) == 2 ? diagonal : -diagonal);
  }
  for (int k = 0; k < 3; k++) grad[k] = u*b->e[k] + v*m[k];
  return beyond;
}

/* Half-space profile of one pair (method 4.4): t = r - (n.r) n, w = A w2(|t|, R) fades, height z of ProxyHeight(),
     lambda_H = lambda(z) - 1/2 H_z h^2 K(z),   H_z = H/(1 + c z), H = tr S/2
   H_z is the mean curvature of the parallel surface through the particle. For a ball of radius 1/H this is the exact part of the kernel
   in the ball (integrate 2 pi r^2 W (1 - (D^2 + r^2 - 1/H^2)/(2 D r)) over r, D = 1/H + z); the method's H is its first order.
   Three fades make the weights local: behind the surface; past the equator of the osculating ball; and where the part of the surface
   that the proxy stands for is h away. On a plane they all cancel, whatever they are. All gradients exact. Returns 0 when the pair does
   not touch. The slope of lambda is that of `gradient_kernel`, as at planes. */
BY_HD int ProxyPairHalfSpace(int kernel, int gradient_kernel, double h, const ProxyPoint *b, const double r[3], ProxyPair *pair)
{
  const double z0 = Dot3(b->n, r), R = b->radius[0], H = 0.5*(b->S[0] + b->S[1] + b->S[2]);
  const double t[3] = {r[0] - z0*b->n[0], r[1] - z0*b->n[1], r[2] - z0*b->n[2]}, t2 = Dot3(t, t);
  const double side = (1.0 + b->bend*z0)/PROXY_SIDE_FADE;
  double       F, w, z, d, slope, K, out[3];

  if (t2 >= R*R || side <= 0.0) return 0;
  z = ProxyHeight(b, z0, t, pair->grad_z) - b->offset;
  const double beyond = ProxyBeyond(b, t, out), far2 = z*z + beyond*beyond;
  if (far2 >= h*h) return 0;

  // weight in the tangent plane, and its fades
  w = ProxyKernel2D(sqrt(t2), R, &F);
  const double near_side = ProxySmoothStep(side, &slope), side_slope = slope*b->bend/PROXY_SIDE_FADE;
  const double back = z < 0.0 ? z/(PROXY_BACK_FADE*h) : 0.0, behind = z < 0.0 ? exp(-back*back) : 1.0;
  const double far = sqrt(far2), end = ProxySmoothStep((h - far)/(PROXY_FAR_FADE*h), &slope);
  const double end_slope = far > 0.0 ? -slope/(PROXY_FAR_FADE*h*far) : 0.0, behind_slope = -2.0*back/(PROXY_BACK_FADE*h)*behind;

  // profile above the osculating surface; K' = -2 z A/h^2
  const double bend = 1.0/(1.0 + b->bend*z), Hz = H*bend, A = b->weight;
  d            = z < 0.0 ? -z : z;
  K            = H != 0.0 ? 0.5*h*h*ProxyPlaneMoment(kernel, d, h) : 0.0;
  pair->z      = z;
  pair->beyond = beyond;
  pair->cover  = A*w*near_side;
  pair->w      = A*w*near_side*behind*end;
  pair->lambda = SPHHalfSpace(kernel, z, h) - Hz*K;
  slope        = -SPHPlaneDensity(gradient_kernel, d, h) * (1.0 - Hz*z) + K*Hz*bend*b->bend;
  for (int k = 0; k < 3; k++) {
    const double side_k = F*near_side*t[k] + w*side_slope*b->n[k];
    pair->grad_lambda[k] = slope * pair->grad_z[k];
    pair->grad_cover[k]  = A*side_k;
    pair->out[k]         = out[k];
    pair->grad_w[k]      = A*(side_k*behind*end + w*near_side*(behind_slope*end*pair->grad_z[k] + behind*end_slope*(z*pair->grad_z[k] + beyond*out[k])));
  }
  return 1;
}

/* Ellipsoid kernel of one proxy (method 4.3) without volume and cut: h^3/(a b c) W(|G r|, h), G = diag(h/a, h/b, h/c), c = h, in the
   frame (e, n x e, n); gradient with respect to the particle when grad is not NULL. */
BY_HD double ProxyEllipsoidW(int kernel, int gradient_kernel, double h, const ProxyPoint *b, const double r[3], double grad[3])
{
  double       m[3];
  Cross3(b->n, b->e, m);
  const double ga = h / b->radius[0], gb = h / b->radius[1];
  const double x = ga*Dot3(b->e, r), y = gb*Dot3(m, r), z = Dot3(b->n, r), q2 = x*x + y*y + z*z;

  if (q2 >= h*h) return 0.0;
  const double d = sqrt(q2), scale = ga*gb;
  if (grad) {
    const double F = scale * SPHKernelF(gradient_kernel, d, h);
    for (int k = 0; k < 3; k++) grad[k] = F * (ga*x*b->e[k] + gb*y*m[k] + z*b->n[k]);
  }
  return scale * SPHKernelW(kernel, d, h);
}

/* phi of one ellipsoid pair: V_b W_b(r) with a smooth end behind the surface: 1 for height z >= 0, 0 at z = -h/4 (one-sidedness) */
BY_HD double ProxyPairEllipsoid(int kernel, int gradient_kernel, double h, const ProxyPoint *b, const double r[3], double grad[3])
{
  double s[3], t[3], grad_z[3], W, cut, slope, z;

  W = ProxyEllipsoidW(kernel, gradient_kernel, h, b, r, grad);
  if (W == 0.0) return 0.0;
  for (int k = 0; k < 3; k++) s[k] = r[k] - b->inset*b->n[k]; // from the surface
  const double z0 = Dot3(b->n, s);
  for (int k = 0; k < 3; k++) t[k] = s[k] - z0*b->n[k];
  z   = ProxyHeight(b, z0, t, grad_z) - b->offset;
  cut = ProxySmoothStep(1.0 + z / (PROXY_ELLIPSOID_FADE*h), &slope);
  for (int k = 0; k < 3; k++) grad[k] = b->weight * (cut*grad[k] + W * slope/(PROXY_ELLIPSOID_FADE*h) * grad_z[k]);
  return b->weight * cut * W;
}

#endif
