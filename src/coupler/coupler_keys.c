/* coupler_keys.c - keys of the scene that belong to no single module, and the schema of a whole scene. */
#include "coupler/coupler.h"
#include "sweep.h"
#include "tled/tled_implicit.h"

#define HUGE_LENGTH 1e6 /* [m], larger than anything a particle method resolves: catches wrong units */
#define ROW(S, f)   offsetof(S, f)

static const char *const wall_names[]   = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax", NULL};
static const char *const axis_names[]   = {"x", "y", "z", NULL};
static const char *const shape_names[]  = {"box", "sphere", "cylinder", NULL};
static const char *const field_names[]  = {"uniform", "taylor_green", "rotation", "shear", "strain", NULL};
static const char *const scheme_names[] = {"auto", "explicit", "iterated", "mass", NULL};
static const char *const force_names[]  = {"held", "interpolated", NULL};
static const char *const relaxations[]  = {"iqn_ils", "aitken", NULL};
static const char *const kinds[]        = {"static", "dynamic", "both", "implicit", "none", NULL};
static const char *const quantities[]   = {"displacement", "velocity", "pressure", "height", "force", "surface", "flow_rate", "power", "moment", NULL};

// clang-format off
const Key RunKeys[] = {
  {"end",              KEY_REAL,   ROW(RunParams, end),              "s", NULL, 0, 1e9, KEY_LO_OPEN | KEY_REQUIRED, NULL, "simulated time at which the run ends"},
  {"output_every",     KEY_REAL,   ROW(RunParams, output_every),     "s", "0",  0, 1e9, 0, NULL, "time between results, 0 = end/50"},
  {"fields_every",     KEY_REAL,   ROW(RunParams, fields_every),     "s", "0",  0, 1e9, 0, NULL, "time between particles, bodies and proxies in the results where tables are to be finer, a multiple of output_every; 0 = output_every"},
  {"checkpoint_every", KEY_REAL,   ROW(RunParams, checkpoint_every), "s", "0",  0, 1e9, 0, NULL, "time between checkpoints, 0 = only at the end or when interrupted"},
  {"max_steps",        KEY_INT,    ROW(RunParams, max_steps),        "1", "0",  0, 2e9, 0, NULL, "stop after this many steps, 0 = no limit"},
  {"directory",        KEY_STRING, ROW(RunParams, directory),        "",  NULL, 0, 0, KEY_REQUIRED, NULL, "run directory, relative to where the program is started"},
  KEY_END};

const Key DomainKeys[] = {
  {"min",      KEY_VEC3,  ROW(DomainParams, min),      "m", NULL, -HUGE_LENGTH, HUGE_LENGTH, KEY_REQUIRED, NULL, "lower corner of the domain"},
  {"max",      KEY_VEC3,  ROW(DomainParams, max),      "m", NULL, -HUGE_LENGTH, HUGE_LENGTH, KEY_REQUIRED, NULL, "upper corner of the domain"},
  {"walls",    KEY_NAMES, ROW(DomainParams, walls),    "",  "",   0, 0, 0, wall_names, "sides that are walls"},
  {"periodic", KEY_NAMES, ROW(DomainParams, periodic), "",  "",   0, 0, 0, axis_names, "directions in which the domain repeats"},
  {"slip",     KEY_NAMES, ROW(DomainParams, slip),     "",  "",   0, 0, 0, wall_names, "walls along which a viscous fluid slips freely"},
  {"moving",   KEY_NAMES, ROW(DomainParams, moving),   "",  "",   0, 0, 0, NULL, "names of motions of walls, each a section domain.<name>"},
  KEY_END};

const Key WallMotionKeys[] = {
  {"walls",       KEY_NAMES, ROW(WallMotionParams, walls),       "",  "", 0, 0, KEY_REQUIRED, wall_names, "walls that move, of domain.walls"},
  {"translation", KEY_VEC3,  ROW(WallMotionParams, translation), "m", "0,0,0", -HUGE_LENGTH, HUGE_LENGTH, KEY_REQUIRED, NULL, "displacement where the course is 1; in the wall's plane it drags what does not slip"},
  COURSE_KEYS(WallMotionParams, course),
  KEY_END};

const Key MotionKeys[] = {MOTION_KEYS(MotionSection, motion), KEY_END};

const Key TopKeys[] = {
  {"gravity",   KEY_VEC3,  ROW(TopParams, gravity),   "m/s^2", "0,0,0", -1e4, 1e4, 0, NULL, "acceleration of gravity"},
  {"bodies",    KEY_NAMES, ROW(TopParams, bodies),    "",      "", 0, 0, 0, NULL, "elastic bodies, a section each"},
  {"obstacles", KEY_NAMES, ROW(TopParams, obstacles), "",      "", 0, 0, 0, NULL, "rigid obstacles, at rest or moving, a section each"},
  {"probes",    KEY_NAMES, ROW(TopParams, probes),    "",      "", 0, 0, 0, NULL, "gauges written to probes.csv, a section each"},
  KEY_END};

const Key FillKeys[] = {
  {"min",       KEY_VEC3, ROW(FillParams, min),       "m",   "", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "lower corner of a box of water"},
  {"max",       KEY_VEC3, ROW(FillParams, max),       "m",   "", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "upper corner of a box of water"},
  {"velocity",  KEY_VEC3, ROW(FillParams, velocity),  "m/s", "0,0,0", -1e4, 1e4, 0, NULL, "initial velocity"},
  {"surface",   KEY_FILE, ROW(FillParams, surface),   "",    "", 0, 0, 0, NULL, "closed surface (stl, off, obj, ply, msh) that the water fills instead of a box"},
  {"scale",     KEY_REAL, ROW(FillParams, scale),     "1",   "1", 0, 1e6, KEY_LO_OPEN, NULL, "factor on the surface's coordinates"},
  {"translate", KEY_VEC3, ROW(FillParams, translate), "m",   "0,0,0", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "shift of the surface, after scaling"},
  {"shape",     KEY_CHOICE, ROW(FillParams, shape),   "",    "box", 0, 0, 0, shape_names, "box from min to max, or sphere or cylinder of center and radius"},
  {"center",    KEY_VEC3, ROW(FillParams, center),    "m",   "0,0,0", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "of the sphere or cylinder, and of the field"},
  {"radius",    KEY_REAL, ROW(FillParams, radius),    "m",   "0", 0, HUGE_LENGTH, 0, NULL, "of the sphere or cylinder"},
  {"length",    KEY_REAL, ROW(FillParams, length),    "m",   "0", 0, HUGE_LENGTH, 0, NULL, "of the cylinder along its axis, half of it to either side of center; 0 = through the whole domain"},
  {"axis",      KEY_CHOICE, ROW(FillParams, axis),    "",    "z", 0, 0, 0, axis_names, "of the cylinder and of the field"},
  {"field",     KEY_CHOICE, ROW(FillParams, field),   "",    "uniform", 0, 0, 0, field_names, "added to velocity; with axis z, (x, y) from center: taylor_green u = A sin kx cos ky, v = -A cos kx sin ky; rotation u = -R y, v = R x; shear u = R y; strain u = R x, v = -R y"},
  {"amplitude", KEY_REAL, ROW(FillParams, amplitude), "m/s", "0", -1e4, 1e4, 0, NULL, "A of taylor_green"},
  {"wavelength", KEY_REAL, ROW(FillParams, wavelength), "m", "0", 0, HUGE_LENGTH, 0, NULL, "of taylor_green, k = 2 pi/wavelength"},
  {"rate",      KEY_REAL, ROW(FillParams, rate),      "1/s", "0", -1e6, 1e6, 0, NULL, "R: angular velocity of rotation, rate of shear and strain"},
  KEY_END};

const Key ObstacleKeys[] = {
  {"surface",   KEY_FILE, ROW(ObstacleParams, surface),   "",  NULL, 0, 0, KEY_REQUIRED, NULL, "closed surface: stl, off, obj, ply or msh"},
  {"scale",     KEY_REAL, ROW(ObstacleParams, scale),     "1", "1", 0, 1e6, KEY_LO_OPEN, NULL, "factor on the surface's coordinates"},
  {"translate", KEY_VEC3, ROW(ObstacleParams, translate), "m", "0,0,0", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "shift of the surface, after scaling"},
  {"slip",      KEY_BOOL, ROW(ObstacleParams, slip),      "",  "false", 0, 0, 0, NULL, "a viscous fluid slips freely along it"},
  KEY_END};

const Key CouplerKeys[] = {
  {"scheme",         KEY_CHOICE, ROW(CouplerParams, scheme),         "",  "auto", 0, 0, 0, scheme_names, "how fluid and bodies are coupled; auto = by what the water moves of each body, said in the log"},
  {"response_beta",  KEY_REAL,   ROW(CouplerParams, response_beta),  "1", "0.25", 0, 1, 0, NULL, "beta of the interface response (M + beta dt^2 K)^-1 of scheme mass"},
  {"response_every", KEY_INT,    ROW(CouplerParams, response_every), "1", "10", 1, 1e6, 0, NULL, "steps between refreshes of the tangent in the interface response"},
  {"passes",         KEY_INT,    ROW(CouplerParams, passes),         "1", "1", 1, 100, 0, NULL, "most pressure solves a step of scheme mass, each with the body's true answer to the last, until both agree by the tolerance"},
  {"relaxation",     KEY_CHOICE, ROW(CouplerParams, relaxation),     "",  "iqn_ils", 0, 0, 0, relaxations, "of the interface's velocity in iterations: quasi-Newton by least squares, or one factor by Aitken"},
  {"relaxation_start", KEY_REAL, ROW(CouplerParams, relaxation_start), "1", "0.05", 0, 2, KEY_LO_OPEN, NULL, "first factor of scheme iterated without response"},
  {"response",       KEY_BOOL,   ROW(CouplerParams, response),       "",  "true", 0, 0, 0, NULL, "iterated: the bodies answer within each pressure solve as in scheme mass, a first guess of the Jacobian, where sph.solver takes it; false = the textbook's iteration between fluid and body as they are"},
  {"reuse",          KEY_INT,    ROW(CouplerParams, reuse),          "1", "8", 0, 50, 0, NULL, "steps whose differences iqn_ils keeps"},
  {"tolerance",      KEY_REAL,   ROW(CouplerParams, tolerance),      "1", "1e-3", 0, 1, 0, NULL, "iterations end when the interface's mean velocity over the step, of fluid and body, agree by this, relative, rms"},
  {"iterations",     KEY_INT,    ROW(CouplerParams, iterations),     "1", "20", 1, 1000, 0, NULL, "most pressure solves a step of scheme iterated"},
  {"forces",         KEY_CHOICE, ROW(CouplerParams, forces),         "",  "held", 0, 0, 0, force_names, "of the fluid on a body over its substeps: constant, or linear through the change since the last step; the impulse is the same"},
  {"contact_coefficient", KEY_REAL, ROW(CouplerParams, contact_coefficient), "1", "1", 0, 10, KEY_LO_OPEN, NULL, "K_c: contact forces on elastic bodies and their reaction on the fluid are scaled by it; 1 = as the pressure gives them"},
  KEY_END};

const Key ProbeKeys[] = {
  {"body",     KEY_STRING, ROW(ProbeParams, body),     "",  "", 0, 0, 0, NULL, "body, obstacle or wall (xmin ... zmax) it belongs to; none = the water"},
  {"at",       KEY_VEC3,   ROW(ProbeParams, at),       "m", "0,0,0", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "place; on a body: place in the undeformed body"},
  {"to",       KEY_VEC3,   ROW(ProbeParams, to),       "m", "", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "far end of a line, or opposite corner of a rectangle, from `at`: velocity or pressure of the water there, in a file <probe>.csv"},
  {"samples",  KEY_REALS,  ROW(ProbeParams, samples),  "1", "", 2, 1e6, 0, NULL, "how many points: n on the line, [n, m] on the rectangle, ends included"},
  {"min",      KEY_VEC3,   ROW(ProbeParams, min),      "m", "", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "corner of the box that cuts the patch out of the body or wall; of the rectangle of a flow rate"},
  {"max",      KEY_VEC3,   ROW(ProbeParams, max),      "m", "", -HUGE_LENGTH, HUGE_LENGTH, 0, NULL, "opposite corner"},
  {"quantity", KEY_CHOICE, ROW(ProbeParams, quantity), "",  "displacement", 0, 0, KEY_REQUIRED, quantities,
   "what is measured: pressure on a body, obstacle or wall is the force on a patch over its area; height is the volume of a column over its area, surface where the density falls below half; flow_rate is positive along the axis; power is that of the fluid on a wall or obstacle that moves; moment that of its forces on a body or obstacle about `at`"},
  {"mean",     KEY_BOOL,   ROW(ProbeParams, mean),     "",  "false", 0, 0, 0, NULL, "mean over all steps since the last row in place of the value of the moment: a short impact is not missed, its impulse is right"},
  KEY_END};

const Key VerifyKeys[] = {
  {"kind",              KEY_CHOICE, ROW(VerifyParams, kind),              "",  "static", 0, 0, 0, kinds, "what is compared: equilibrium, motion, both; implicit = nothing, the implicit equilibrium alone; none = frequencies alone"},
  {"tolerance",         KEY_REAL,   ROW(VerifyParams, tolerance),         "1", "1e-6", 0, 1, KEY_LO_OPEN, NULL, "allowed largest nodal difference of the equilibria, over the largest displacement"},
  {"relax_tolerance",   KEY_REAL,   ROW(VerifyParams, relax_tolerance),   "1", "1e-9", 0, 1, KEY_LO_OPEN, NULL, "relative residual at which the explicit solid counts as at rest"},
  {"relax_steps",       KEY_INT,    ROW(VerifyParams, relax_steps),       "1", "1000000", 1, 2e9, 0, NULL, "steps that its relaxation may take"},
  {"time",              KEY_REAL,   ROW(VerifyParams, time),              "s", "0",    0, 1e9, 0, NULL, "time of which loads and motions act in equilibrium"},
  {"duration",          KEY_REAL,   ROW(VerifyParams, duration),          "s", "0",    0, 1e9, 0, NULL, "simulated time of the dynamic runs"},
  {"steps",             KEY_REALS,  ROW(VerifyParams, steps),             "1", "0.8, 0.4, 0.2", 0, 1, KEY_LO_OPEN, NULL, "explicit steps over the critical one, falling"},
  {"implicit_step",     KEY_REAL,   ROW(VerifyParams, implicit_step),     "1", "0.5",  0, 1e6, KEY_LO_OPEN, NULL, "the same of the implicit reference; it runs at half of it too, and both are extrapolated"},
  {"samples",           KEY_INT,    ROW(VerifyParams, samples),           "1", "20",   1, 1e5, 0, NULL, "times at which dynamic runs are compared"},
  {"dynamic_tolerance", KEY_REAL,   ROW(VerifyParams, dynamic_tolerance), "1", "1e-3", 0, 1e3, KEY_LO_OPEN, NULL, "allowed largest nodal difference of the finest explicit run, over the largest displacement"},
  {"order",             KEY_REAL,   ROW(VerifyParams, order),             "1", "1.8",  0, 4, 0, NULL, "least order between the two finest steps; 0 = not judged"},
  {"modes",             KEY_INT,    ROW(VerifyParams, modes),             "1", "0",    0, BY_REALS_MAX, 0, NULL, "lowest natural frequencies compared with the ringing explicit solid, without gravity; 0 = none"},
  {"modes_tolerance",   KEY_REAL,   ROW(VerifyParams, modes_tolerance),   "1", "1e-3", 0, 1, KEY_LO_OPEN, NULL, "allowed relative difference of a frequency"},
  {"periods",           KEY_REAL,   ROW(VerifyParams, periods),           "1", "10",   2, 1e4, 0, NULL, "of the lowest mode that the explicit solid rings"},
  {"picture",           KEY_BOOL,   ROW(VerifyParams, picture),           "",  "true", 0, 0, 0, NULL, "draw the result"},
  {"directory",         KEY_STRING, ROW(VerifyParams, directory),         "",  "",     0, 0, 0, NULL, "directory of the results; none = that of the run, with _verify behind it"},
  KEY_END};

const SceneSection CouplerSchema[] = {
  {"",         TopKeys,      NULL,       NULL,        "top level"},
  {"run",      RunKeys,      NULL,       NULL,        "the run and its directory"},
  {"domain",   DomainKeys,   NULL,       NULL,        "box in which everything happens"},
  {"moving",   WallMotionKeys, "domain", "moving",    "walls of the domain that move"},
  {"frame",    MotionKeys,   NULL,       NULL,        "motion of the whole tank: results are as seen from it, gravity is the laboratory's"},
  {"sph",      SPHKeys,      NULL,       NULL,        "the fluid"},
  {"fill",     FillKeys,     "sph",      "fill",      "water at the start: a box, sphere or cylinder, or the inside of a surface"},
  {"inflow",   SPHInflowKeys,  "sph",    "inflow",    "an opening through which water enters"},
  {"outflow",  SPHOutflowKeys, "sph",    "outflow",   "an opening through which water leaves"},
  {"source",   SPHSourceKeys,  "sph",    "sources",   "a tap: water comes out of a disc in the domain"},
  {"body",     TLEDKeys,     NULL,       "bodies",    "an elastic body"},
  {"material", TLEDMaterialKeys, "body", "materials", "an elastic material of a part of a body"},
  {"constraint", TLEDConstraintKeys, "body", "constraints", "a support of a body: what is held or moved"},
  {"load",     TLEDLoadKeys, "body",     "loads",     "a load on a body"},
  {"implicit", TLEDImplicitKeys, "body", NULL,        "the implicit solver of a body (byssus verify)"},
  {"proxy",    ProxyKeys,    "body",     NULL,        "surface proxies of a body"},
  {"obstacle", ObstacleKeys, NULL,       "obstacles", "a rigid obstacle"},
  {"motion",   MotionKeys,   "obstacle", NULL,        "motion of an obstacle"},
  {"proxy",    ProxyKeys,    "obstacle", NULL,        "surface proxies of an obstacle"},
  {"coupler",  CouplerKeys,  NULL,       NULL,        "the staggered loop"},
  {"probe",    ProbeKeys,    NULL,       "probes",    "a gauge"},
  {"verify",   VerifyKeys,   NULL,       NULL,        "explicit against implicit solid (byssus verify)"},
  {"sweep",    SweepKeys,    NULL,       NULL,        "a grid of runs over keys of the scene, against a reference (byssus sweep)"},
  {"axis",     SweepAxisKeys, "sweep",   "over",      "what is varied"},
  {NULL, NULL, NULL, NULL, NULL}};
// clang-format on
