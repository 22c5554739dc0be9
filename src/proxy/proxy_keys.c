/* proxy_keys.c - the keys of `<body>.proxy:` and `<obstacle>.proxy:`. */
#include "proxy/proxy.h"

static const char *const Kernels[] = {"half_space", "ellipsoid", "sphere", NULL};
static const char *const Measures[] = {"gaussian", "principal", NULL};
static const char *const Ranges[]  = {"robust", "minmax", NULL};

#define AT(field) offsetof(ProxyParams, field)

const Key ProxyKeys[] = {
  {"adaptive",           KEY_BOOL,   AT(adaptive),           "",       "true",       0, 0,     0, NULL,    "proxy density follows the surface's curvature; false = uniform"},
  {"eta_min",            KEY_REAL,   AT(eta_min),            "1",      "0.4",        0, 1,     KEY_LO_OPEN, NULL, "normalised curvature of the flattest parts: spacing there is h/(2 eta_min)"},
  {"eta_max",            KEY_REAL,   AT(eta_max),            "1",      "1",          0, 4,     KEY_LO_OPEN, NULL, "normalised curvature of the most curved parts"},
  {"kappa",              KEY_REAL,   AT(kappa),              "1",      "0",          0, 4,     0, NULL,    "uniform density of this normalised curvature, spacing h/(2 kappa); 0 = as `adaptive` says, whose false is 1"},
  {"density",            KEY_FILE,   AT(density),            "",       "",           0, 0,     0, NULL,    "density of your own: CSV file of x, y, z [m] in the undeformed body and normalised curvature there; a place takes that of the nearest row"},
  {"thin",               KEY_BOOL,   AT(thin),               "",       "true",       0, 0,     0, NULL,    "no closer than the wanted spacing where the mesh is finer; false = a proxy at every vertex, as published"},
  {"kernel",             KEY_CHOICE, AT(kernel),             "",       "half_space", 0, 0,     0, Kernels, "what a proxy does to the fluid: half-space profile, the paper's ellipsoid, or the usual sphere of radius h"},
  {"measure",            KEY_CHOICE, AT(measure),            "",       "gaussian",   0, 0,     0, Measures, "curvature that the density follows: largest principal curvature times support radius, or the paper's Gaussian"},
  {"range",              KEY_CHOICE, AT(range),              "",       "robust",     0, 0,     0, Ranges,  "Gaussian curvatures that map onto eta_min..eta_max: percentiles bounded by the support radius, or the paper's extremes"},
  {"inset",              KEY_REAL,   AT(inset),              "dx",     "-1",         -1, 1,    0, NULL,    "the wetted surface of the kernel lies beneath the mesh by this many spacings; negative = calibrated (half_space 0.045, the others 0.5)"},
  {"factor",             KEY_REAL,   AT(factor),             "1",      "0",          0, 4,     0, NULL,    "factor on the boundary volume; 0 = calibrated for kernel and support"},
  {"resample_tolerance", KEY_REAL,   AT(resample_tolerance), "1",      "0.1",        0, 10,    0, NULL,    "change of an edge or area ratio that samples the surface afresh; 0 = every step"},
  {"feature_angle",      KEY_REAL,   AT(feature_angle),      "degree", "40",         0, 180,   KEY_LO_OPEN, NULL, "edges with a larger angle between their triangles are sharp"},
  KEY_END
};
