/* scene_tables.h - a small set of tables that has one of everything, and a scene on disk with what the reader prints about it. */
#ifndef BY_SCENE_TABLES_H
#define BY_SCENE_TABLES_H

#include "check.h"
#include "scene.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct {
  PetscReal spacing, viscosity, tolerance;
  PetscInt  iterations;
  PetscBool free_surface;
  PetscReal mean[3];
  int       solver;
  Names     fill;
} FluidParams;

typedef struct {
  char      mesh[PETSC_MAX_PATH_LEN];
  PetscReal poisson;
  Names     fixed;
} BodyParams;

typedef struct {
  PetscReal gravity[3];
  Names     bodies, walls;
  char      directory[PETSC_MAX_PATH_LEN];
} TopParams;

static const char *const solvers[] = {"pcg", "jacobi", NULL};
static const char *const planes[]  = {"xmin", "xmax", "zmin", NULL};

static const Key TopKeys[] = {
  {"gravity", KEY_VEC3, offsetof(TopParams, gravity), "m/s^2", "0, 0, -9.81", -1000, 1000, 0, NULL, "acceleration of everything"},
  {"bodies", KEY_NAMES, offsetof(TopParams, bodies), "", NULL, 0, 0, 0, NULL, "names of the bodies"},
  {"walls", KEY_NAMES, offsetof(TopParams, walls), "", "[xmin, zmin]", 0, 0, 0, planes, "planar walls"},
  {"directory", KEY_STRING, offsetof(TopParams, directory), "", "runs", 0, 0, 0, NULL, "where results go"},
  KEY_END};
static const Key FluidKeys[] = {
  {"spacing", KEY_REAL, offsetof(FluidParams, spacing), "m", NULL, 0, INFINITY, KEY_LO_OPEN | KEY_REQUIRED, NULL, "particle spacing"},
  {"viscosity", KEY_REAL, offsetof(FluidParams, viscosity), "Pa s", "1e-3", 0, INFINITY, 0, NULL, "dynamic viscosity"},
  {"tolerance", KEY_REAL, offsetof(FluidParams, tolerance), "1", "1e-5", 0, 1, KEY_LO_OPEN | KEY_HI_OPEN, NULL, "of the pressure solve"},
  {"iterations", KEY_INT, offsetof(FluidParams, iterations), "1", "200", 1, 100000, 0, NULL, "limit of the pressure solve"},
  {"free_surface", KEY_BOOL, offsetof(FluidParams, free_surface), "", "true", 0, 0, 0, NULL, "no suction"},
  {"mean", KEY_VEC3, offsetof(FluidParams, mean), "m/s", NULL, -INFINITY, INFINITY, 0, NULL, "mean velocity"},
  {"solver", KEY_CHOICE, offsetof(FluidParams, solver), "", "pcg", 0, 0, 0, solvers, "pressure solver"},
  {"fill", KEY_NAMES, offsetof(FluidParams, fill), "", NULL, 0, 0, 0, NULL, "names of boxes of water"},
  KEY_END};
static const Key FillKeys[]  = {{"height", KEY_REAL, 0, "m", NULL, 0, INFINITY, KEY_LO_OPEN | KEY_REQUIRED, NULL, "of the box"}, KEY_END};
static const Key BodyKeys[]  = {{"mesh", KEY_FILE, offsetof(BodyParams, mesh), "", NULL, 0, 0, KEY_REQUIRED, NULL, "gmsh mesh"},
                                {"poisson", KEY_REAL, offsetof(BodyParams, poisson), "1", "0.4", 0, 0.5, KEY_HI_OPEN, NULL, "Poisson's ratio"},
                                {"fixed", KEY_NAMES, offsetof(BodyParams, fixed), "", NULL, 0, 0, 0, NULL, "groups that are held"},
                                KEY_END};
static const Key ProxyKeys[] = {{"adaptive", KEY_BOOL, 0, "", "true", 0, 0, 0, NULL, "density follows curvature"}, KEY_END};

static const SceneSection sections[] = {
  {"", TopKeys, NULL, NULL, NULL},
  {"sph", FluidKeys, NULL, NULL, "the fluid"},
  {"fill", FillKeys, "sph", "fill", "a box of water"},
  {"body", BodyKeys, NULL, "bodies", "an elastic body"},
  {"proxy", ProxyKeys, "body", NULL, "its surface"},
  {NULL, NULL, NULL, NULL, NULL},
};

/* a scene that has no error; the mesh is the scene file itself */
static const char good_scene[] = "# water and a flap\n"
                                 "gravity: [0, 0, -9.81]\n"
                                 "sph:\n"
                                 "  spacing: 0.01 # [m]\n"
                                 "  solver: jacobi\n"
                                 "  fill: [column]\n"
                                 "  column: {height: 0.3}\n"
                                 "bodies: [flap]\n"
                                 "flap: {mesh: scene.yaml, fixed: [root], proxy: {adaptive: false}}\n";

static char reported[65536]; /* what the reader printed on stderr */
static char scene_directory[64];

/* Write `text` to <temporary directory>/scene.yaml and read it with options; the report goes to `reported`. */
static inline PetscErrorCode ReadScene(const char text[], int argc, char *argv[], Scene *scene)
{
  char           path[128], log[128];
  PetscErrorCode result;
  FILE          *file;
  size_t         n;
  int            saved;

  if (!scene_directory[0]) {
    strcpy(scene_directory, "/tmp/byssus_scene_XXXXXX");
    if (!mkdtemp(scene_directory)) abort();
  }
  snprintf(path, sizeof path, "%s/scene.yaml", scene_directory);
  snprintf(log, sizeof log, "%s/log", scene_directory);
  file = fopen(path, "w");
  fputs(text, file);
  fclose(file);

  /* stderr goes to a file meanwhile */
  fflush(stderr);
  saved = dup(2);
  file  = fopen(log, "w+");
  dup2(fileno(file), 2);
  result = SceneRead(path, argc, argv, sections, scene);
  fflush(stderr);
  dup2(saved, 2);
  close(saved);
  rewind(file);
  n           = fread(reported, 1, sizeof reported - 1, file);
  reported[n] = 0;
  fclose(file);
  return result;
}

#endif
