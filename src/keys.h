/* keys.h - one row per scene key: name, type, unit, default, range, help. From this row come the default, the
   options reader, the scene check, -help, the View line and the reference page. Modules own their tables. */
#ifndef BY_KEYS_H
#define BY_KEYS_H

#include "base.h"

#define BY_NAME_MAX  64   /* length of a name in a scene */
#define BY_NAMES_MAX 32   /* how many names one list may hold */
#define BY_REALS_MAX 16   /* how many numbers                  */

typedef enum {
  KEY_REAL,   /* PetscReal                                                        */
  KEY_INT,    /* PetscInt                                                         */
  KEY_BOOL,   /* PetscBool                                                        */
  KEY_VEC3,   /* PetscReal[3]                                                     */
  KEY_REALS,  /* Reals, a list of numbers                                         */
  KEY_STRING, /* char[PETSC_MAX_PATH_LEN], a free string or an output path        */
  KEY_FILE,   /* char[PETSC_MAX_PATH_LEN], an existing file; relative to the scene file, or to the
                 working directory when it comes from the command line                         */
  KEY_NAMES,  /* Names, a list of free names                                      */
  KEY_CHOICE  /* int (an enum), one word of a list                                */
} KeyType;

typedef struct {
  PetscInt n;
  char     name[BY_NAMES_MAX][BY_NAME_MAX];
} Names;

typedef struct {
  PetscInt  n;
  PetscReal value[BY_REALS_MAX];
} Reals;

/* range flags: which ends of [lo, hi] are open, and that a key must be given. A bound of 1e300 and beyond is none; lo == hi means
   that any finite number will do. */
enum { KEY_LO_OPEN = 1, KEY_HI_OPEN = 2, KEY_REQUIRED = 4 };

typedef struct {
  const char        *name;    /* lower_case, as in the scene                                              */
  KeyType            type;
  size_t             offset;  /* of the value in the module's parameter struct                            */
  const char        *unit;    /* "m", "Pa s", "1" for a pure number, "" where units make no sense          */
  const char        *def;     /* default as a user would write it; NULL or "" = empty/zero/none            */
  double             lo, hi;  /* permitted range of REAL, INT and each number of VEC3 and REALS            */
  int                flags;
  const char *const *choices; /* NULL-terminated words of a KEY_CHOICE (or of each name in KEY_NAMES)      */
  const char        *help;    /* one line, lower-case, no full stop                                        */
} Key;

#define KEY_END {NULL, KEY_REAL, 0, NULL, NULL, 0, 0, 0, NULL, NULL}

/* Fill `params` with the defaults of a table (ends at KEY_END). */
BY_EXTERN PetscErrorCode KeysSetDefaults(const Key keys[], void *params);

/* Overwrite what the options database has under -<prefix><key>. A value that does not parse or is out of range is
   PETSC_ERR_ARG_OUTOFRANGE with the key, the value and what is allowed (scene files are checked before, with file:line). */
BY_EXTERN PetscErrorCode KeysSetFromOptions(const Key keys[], const char prefix[], void *params);

/* Print every key with its value and unit. */
BY_EXTERN PetscErrorCode KeysView(const Key keys[], const void *params, PetscViewer viewer);

/* Check one textual value against a row; `why` gets what is wrong and what is allowed, empty when the value is good. */
BY_EXTERN PetscErrorCode KeyCheck(const Key *key, const char value[], char why[], size_t n_why);

/* What may be written for a key, as in "a finite number > 0 [Pa s]". */
BY_EXTERN PetscErrorCode KeyDescribe(const Key *key, char text[], size_t n);

/* Edit distance of two words without regard to case (a swap of neighbours is one edit), and whether it is small enough to ask
   "did you mean". */
BY_EXTERN PetscInt  KeyDistance(const char a[], const char b[]);
BY_EXTERN PetscBool KeyIsNear(const char word[], const char known[]);

#endif
