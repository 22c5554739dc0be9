/* scene_impl.h - the tree of a scene file and the blocks that the tables recognise in it; for scene*.c only. */
#ifndef BY_SCENE_IMPL_H
#define BY_SCENE_IMPL_H

#include "scene.h"

typedef enum { NODE_SCALAR, NODE_LIST, NODE_MAP } NodeKind;

/* A value of the file, with the key before it. Children of a node form a chain in the order of the file. */
typedef struct _Node Node;
struct _Node {
  NodeKind  kind;
  char     *key;          /* NULL in lists and at the top                                     */
  char     *text;         /* of a scalar                                                      */
  char     *path;         /* absolute path of a KEY_FILE, once found                          */
  PetscBool quoted;       /* "..." or '...' or a block text: never an empty section           */
  PetscBool overridden;   /* given on the command line, which has no lines                    */
  int       line;         /* of the key where there is one, else of the value; 1 is the first */
  Node     *child, *last; /* first and last child                                            */
  Node     *next;         /* sibling                                                          */
};

/* One section that may occur: the top, sph, flap, flap.proxy, each with its table. */
typedef struct {
  const SceneSection *section;
  char                path[4 * BY_NAME_MAX];   /* "flap.proxy", "" for the top                              */
  char                prefix[4 * BY_NAME_MAX]; /* "flap_proxy_", the same as options begin with             */
  Node               *node;                    /* NULL: not in this scene                                   */
  PetscInt            parent;                  /* index of the block around it, -1 for the top              */
} Block;

typedef struct {
  char  name[PETSC_MAX_PATH_LEN]; /* without the dash                     */
  char *value;                    /* NULL: none given                     */
  int   used;                     /* taken by a key of a block            */
} Override;

typedef struct {
  int   line; /* 0: command line */
  char *text;
} SceneError;

struct _Scene {
  char       *path, *text;
  char        directory[PETSC_MAX_PATH_LEN]; /* of the scene file, with a slash at its end, or empty */
  Node       *root;
  PetscInt    n_blocks, n_overrides, n_errors, capacity_blocks, capacity_errors;
  Block      *blocks;
  Override   *overrides;
  SceneError *errors;
};

/* scene_yaml.c: the tree */
PETSC_INTERN PetscErrorCode SceneParse(Scene scene);
PETSC_INTERN PetscErrorCode NodeCreate(NodeKind kind, const char key[], const char text[], int line, Node **node);
PETSC_INTERN void           NodeAppend(Node *parent, Node *child);
PETSC_INTERN Node          *NodeFind(const Node *map, const char key[]);
PETSC_INTERN void           NodeFormat(const Node *node, char text[], size_t n); /* "[0, 1, 2]" on one line */
PETSC_INTERN void           NodeDestroy(Node **node);
PETSC_INTERN PetscErrorCode NodeWrite(const Node *root, const char without[], FILE *out); /* without: a key of the root, or NULL */

/* scene_check.c: tree and overrides against the tables */
PETSC_INTERN PetscErrorCode SceneCheck(Scene scene, const SceneSection sections[]);
PETSC_INTERN PetscErrorCode SceneToOptions(Scene scene);
PETSC_INTERN PetscErrorCode SceneValue(const Node *node, char text[], size_t n); /* lists as a,b,c */

/* scene.c: errors are collected, then printed in the order of lines */
PETSC_INTERN PetscErrorCode SceneAddError(Scene scene, int line, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(3, 4);

#endif
