/* scene.h - YAML scene -> checked values in PETSc's options database, with file:line for every key. Knows no physics:
   the caller hands in the tables of keys. */
#ifndef BY_SCENE_H
#define BY_SCENE_H

#include "keys.h"

typedef struct _Scene *Scene;

/* One kind of section. Examples (the program's list is in src/coupler/schema.c):
     {"",      TopKeys,   NULL,   NULL}         keys at the top: gravity, bodies, obstacles, probes
     {"sph",   SPHKeys,   NULL,   NULL}         a plain section
     {"fill",  FillKeys,  "sph",  "fill"}       blocks sph.<name> for each name in sph.fill
     {"body",  TLEDKeys,  NULL,   "bodies"}     blocks <name> for each name in bodies
     {"proxy", ProxyKeys, "body", NULL}         section <body name>.proxy
   Options: nested keys join with `_`: -sph_spacing, -sph_column_min, -flap_proxy_adaptive. */
typedef struct {
  const char *name;   /* section name, or the kind's name when `list` is given */
  const Key  *keys;
  const char *parent; /* kind in which it sits; NULL = top level */
  const char *list;   /* key (of the parent, or of the top) that names the blocks; NULL = one section */
  const char *help;   /* one line */
} SceneSection;

/* Read and check FILE and the command line's -key value overrides (argv[0] is the first of them) against `sections` (ends with name
   NULL). Every error is reported with file:line (or "command line"), all at once; then BY_ERR_INPUT. On success all keys are in
   PETSc's options database, files as absolute paths (relative ones are relative to the scene file, on the command line to the
   working directory). Unknown options with a PETSc solver prefix (ksp_, pc_, snes_, mat_, vec_, log_, options_, malloc_, info, help) and
   -<section>_view pass through untouched. */
BY_EXTERN PetscErrorCode SceneRead(const char file[], int argc, char *argv[], const SceneSection sections[], Scene *scene);
BY_EXTERN PetscErrorCode SceneDestroy(Scene *scene);
/* warn about options that passed through to PETSc and that nothing in the run has asked for */
BY_EXTERN PetscErrorCode SceneReportUnused(Scene scene);

BY_EXTERN PetscErrorCode SceneHas(Scene scene, const char section[], PetscBool *present);       /* "sph", "flap.proxy" */
BY_EXTERN PetscErrorCode SceneGetText(Scene scene, const char *text[]);                          /* the file as read    */
BY_EXTERN PetscErrorCode SceneGetPath(Scene scene, const char *path[]);
/* the scene as run: YAML text with the command line's overrides merged in */
BY_EXTERN PetscErrorCode SceneWrite(Scene scene, const char path[]);
/* the same as a text without one section of the top; free() it */
BY_EXTERN PetscErrorCode SceneFormat(Scene scene, const char without[], char **text);
/* table of all keys (for -help and the README's reference): kind is "text" or "markdown" */
BY_EXTERN PetscErrorCode ScenePrintKeys(const SceneSection sections[], const char kind[], FILE *out);

#endif
