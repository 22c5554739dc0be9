/* tled_keys.c - the scene keys of a body: default, unit, range and help of each member of TLEDParams. */
#include "tled/tled.h"

static const char *const materials[] = {"neo_hookean", "st_venant_kirchhoff", "neo_hookean_iso", "mooney_rivlin", "transversely_isotropic",
                                        NULL};                      /* in the order of TLEDMaterial */
static const char *const elements[]  = {"auto", "t4", "anp", "t10", NULL}; /* in the order of TLEDElement */
static const char *const rules[]     = {"4", "14", NULL}; /* in the order of TLEDQuadrature */

/* the keys of a material, for a struct S in which it is the member m (with its dot, or nothing) */
// clang-format off
#define ELASTIC(S, m) \
  {"material", KEY_CHOICE, offsetof(S, m material), "", "neo_hookean", 0, 0, 0, materials, "elastic law"}, \
  {"density", KEY_REAL, offsetof(S, m density), "kg/m^3", "1000", 0, 1e6, KEY_LO_OPEN, NULL, "mass per reference volume"}, \
  {"young", KEY_REAL, offsetof(S, m young), "Pa", NULL, 0, 1e15, KEY_LO_OPEN, NULL, "Young's modulus at small strain; every law but mooney_rivlin needs it"}, \
  {"poisson", KEY_REAL, offsetof(S, m poisson), "1", "0.3", -1, 0.5, KEY_LO_OPEN | KEY_HI_OPEN, NULL, "Poisson's ratio at small strain"}, \
  {"bulk", KEY_REAL, offsetof(S, m bulk), "Pa", NULL, 0, 1e15, KEY_LO_OPEN, NULL, "bulk modulus of neo_hookean_iso, mooney_rivlin and transversely_isotropic; none: from poisson"}, \
  {"c10", KEY_REAL, offsetof(S, m c10), "Pa", NULL, -1e15, 1e15, 0, NULL, "first constant of mooney_rivlin"}, \
  {"c01", KEY_REAL, offsetof(S, m c01), "Pa", NULL, -1e15, 1e15, 0, NULL, "second constant of mooney_rivlin; twice their sum is the shear modulus"}, \
  {"fibre_stiffness", KEY_REAL, offsetof(S, m fibre_stiffness), "Pa", NULL, 0, 1e15, KEY_LO_OPEN, NULL, "stiffness eta along the fibres of transversely_isotropic"}, \
  {"fibre", KEY_VEC3, offsetof(S, m fibre), "1", NULL, -1e9, 1e9, 0, NULL, "direction of the fibres of transversely_isotropic, of any length"}, \
  {"fibre_field", KEY_STRING, offsetof(S, m fibre_field), "", NULL, 0, 0, 0, NULL, "in place of fibre: name of a view of vectors on the elements ($ElementData) in the mesh file"}, \
  {"prony_alpha", KEY_REALS, offsetof(S, m prony_alpha), "1", NULL, 0, 1, KEY_LO_OPEN | KEY_HI_OPEN, NULL, "viscoelasticity: parts of the isochoric stress that relax, a sum < 1"}, \
  {"prony_tau", KEY_REALS, offsetof(S, m prony_tau), "s", NULL, 0, 1e12, KEY_LO_OPEN, NULL, "relaxation time of each part in prony_alpha"}
// clang-format on

#define ROW(key, type, unit, def, lo, hi, flags, choices, help)                                                                    \
  {                                                                                                                                \
#key, type, offsetof(TLEDParams, key), unit, def, lo, hi, flags, choices, help                                                 \
  }

const Key TLEDKeys[] = {
    ROW(mesh, KEY_FILE, "", NULL, 0, 0, KEY_REQUIRED, NULL, "gmsh mesh of tetrahedra with named physical groups"),
    ELASTIC(TLEDParams, elastic.),
    ROW(materials, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "further materials, a section each"),
    ROW(element, KEY_CHOICE, "", "auto", 0, 0, 0, elements,
        "t4: constant strain; anp: average nodal pressure, does not lock; t10: quadratic, on a mesh of second order; auto: t10 on such a mesh, else "
        "anp when a material has poisson above 0.4, else t4"),
    ROW(quadrature, KEY_CHOICE, "", "4", 0, 0, 0, rules, "integration points of a t10 element: 4 (degree 2) or 14 (degree 5)"),
    ROW(fixed, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "physical groups whose nodes are held"),
    ROW(prescribed, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "physical groups whose nodes move with prescribed_velocity from time 0 on"),
    ROW(prescribed_velocity, KEY_VEC3, "m/s", "0,0,0", -1e6, 1e6, 0, NULL, "velocity of the groups in prescribed"),
    ROW(constraints, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "supports of other kinds, a section of the body each"),
    ROW(loads, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "pressures, tractions and forces, a section of the body each"),
    ROW(contact, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "walls of the domain and obstacles that the body cannot pass"),
    ROW(contact_stiffness, KEY_REAL, "Pa/m", "0", 0, 1e30, 0, NULL, "contact pressure over depth; 0: twice Young's modulus over the mean edge of the surface"),
    ROW(wetted, KEY_NAMES, "", NULL, 0, 0, 0, NULL, "surface groups that touch the fluid; none named: the whole boundary"),
    ROW(damping, KEY_REAL, "1/s", "0", 0, 1e9, 0, NULL, "mass-proportional damping"),
    ROW(stiffness_damping, KEY_REAL, "s", "0", 0, 1e3, 0, NULL, "stiffness-proportional damping; a body in water that does not name it has 0.05 of its critical step"),
    ROW(safety, KEY_REAL, "1", "0.9", 0, 1, KEY_LO_OPEN, NULL, "time step over the critical time step"),
    ROW(step, KEY_REAL, "s", "0", 0, 1e6, 0, NULL, "longest time step of the body; 0: safety times the critical one"),
    ROW(step_limit, KEY_REAL, "s", "0", 0, 1e6, 0, NULL, "the run ends when the critical step falls below it; 0: none"),
    ROW(mass_scaling, KEY_REAL, "s", "0", 0, 1e6, 0, NULL,
        "critical step that the shortest elements are given mass to reach, safety not included; 0: none"),
    ROW(scale, KEY_REAL, "1", "1", 0, 1e9, KEY_LO_OPEN, NULL, "factor on the mesh's coordinates"),
    ROW(translate, KEY_VEC3, "m", "0,0,0", -1e9, 1e9, 0, NULL, "shift of the mesh after scaling"),
    ROW(velocity, KEY_VEC3, "m/s", "0,0,0", -1e6, 1e6, 0, NULL, "initial velocity"),
    KEY_END};

const Key TLEDMaterialKeys[] = {
    {"volumes", KEY_NAMES, offsetof(TLEDMaterialParams, volumes), "", NULL, 0, 0, KEY_REQUIRED, NULL, "physical volumes of the mesh that are made of it"},
    ELASTIC(TLEDMaterialParams, ), KEY_END};
