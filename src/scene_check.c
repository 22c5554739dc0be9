/* scene_check.c - the tree of a scene and the command line against the tables of keys; every error with its line. */
#include "scene_impl.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* last word of a block's path: "proxy" of flap.proxy */
static const char *BlockName(const Block *block)
{
  const char *dot = strrchr(block->path, '.');

  return dot ? dot + 1 : block->path;
}

static PetscBool IsIdentifier(const char name[])
{
  if (!isalpha((unsigned char)name[0]) || strlen(name) >= BY_NAME_MAX) return PETSC_FALSE;
  for (const char *c = name; *c; c++) {
    if (!isalnum((unsigned char)*c) && *c != '_') return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* a word of the user's for a message: one line, not endless */
static const char *Printable(const char word[], char text[], size_t n)
{
  snprintf(text, n, "%s", word);
  for (char *c = text; *c; c++) {
    if ((unsigned char)*c < ' ' || *c == 127) *c = '?';
  }
  return text;
}

/* dotted name of a key in a block */
static const char *Dotted(const Block *block, const char key[], char text[], size_t n)
{
  char word[2 * BY_NAME_MAX];

  snprintf(text, n, "%s%s%s", block->path, block->path[0] ? "." : "", Printable(key, word, sizeof word));
  return text;
}

static const Key *FindKey(const Key keys[], const char name[])
{
  for (const Key *key = keys; key->name; key++) {
    if (!strcmp(key->name, name)) return key;
  }
  return NULL;
}

static PetscBool IsWithin(const SceneSection *section, const SceneSection *around)
{
  if (!section->name[0]) return PETSC_FALSE;
  if (!around->name[0]) return (PetscBool)(section->parent == NULL);
  return (PetscBool)(section->parent && !strcmp(section->parent, around->name));
}

/* a value as the options database holds it: lists joined by commas */
PetscErrorCode SceneValue(const Node *node, char text[], size_t n)
{
  PetscFunctionBegin;
  text[0] = 0;
  if (node->kind == NODE_SCALAR) snprintf(text, n, "%s", node->path ? node->path : node->text);
  for (const Node *child = node->child; child && node->kind == NODE_LIST; child = child->next) {
    const size_t used = strlen(text);
    snprintf(text + used, n - used, "%s%s", used || child != node->child ? "," : "", child->text ? child->text : "");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddBlock(Scene scene, const SceneSection *section, PetscInt parent, const char name[], Node *node)
{
  Block *block;

  PetscFunctionBegin;
  if (scene->n_blocks == scene->capacity_blocks) {
    scene->capacity_blocks = 2 * scene->capacity_blocks + 8;
    PetscCall(PetscRealloc((size_t)scene->capacity_blocks * sizeof *scene->blocks, &scene->blocks));
  }
  block          = &scene->blocks[scene->n_blocks++];
  block->section = section;
  block->parent  = parent;
  block->node    = node;
  block->path[0] = block->prefix[0] = 0;
  if (parent >= 0) {
    const Block *around = &scene->blocks[parent];
    snprintf(block->path, sizeof block->path, "%s%s%.63s", around->path, around->path[0] ? "." : "", name);
    snprintf(block->prefix, sizeof block->prefix, "%s%.63s_", around->prefix, name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the map of a block, made (with those around it) when only the command line speaks of it */
static PetscErrorCode EnsureNode(Scene scene, PetscInt b)
{
  Block *block = &scene->blocks[b];

  PetscFunctionBegin;
  if (block->node) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(EnsureNode(scene, block->parent));
  PetscCall(NodeCreate(NODE_MAP, BlockName(block), NULL, 0, &block->node));
  block->node->overridden = PETSC_TRUE;
  NodeAppend(scene->blocks[block->parent].node, block->node);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool TakesList(const Key *key)
{
  return (PetscBool)(key->type == KEY_VEC3 || key->type == KEY_REALS || key->type == KEY_NAMES);
}

static PetscErrorCode OverrideKey(Scene scene, PetscInt b, const Key *key, const char value[])
{
  Node *node, *item;

  PetscFunctionBegin;
  PetscCall(EnsureNode(scene, b));
  node = NodeFind(scene->blocks[b].node, key->name);
  if (!node) {
    PetscCall(NodeCreate(NODE_SCALAR, key->name, NULL, 0, &node));
    NodeAppend(scene->blocks[b].node, node);
  }
  for (Node *child = node->child, *next; child; child = next) {
    next = child->next;
    NodeDestroy(&child);
  }
  PetscCall(PetscFree(node->text));
  node->child = node->last = NULL;
  node->line               = 0;
  node->quoted             = PETSC_FALSE;
  node->overridden         = PETSC_TRUE;
  if (!value) value = key->type == KEY_BOOL ? "true" : "";
  if (!TakesList(key)) {
    node->kind = NODE_SCALAR;
    PetscCall(PetscStrallocpy(value, &node->text));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  node->kind = NODE_LIST;
  for (const char *start = value, *end; start && *value; start = end ? end + 1 : NULL) {
    char         word[PETSC_MAX_PATH_LEN];
    const size_t blanks = strspn(start, " [");

    end = strchr(start, ',');
    snprintf(word, sizeof word, "%.*s", (int)((end ? (size_t)(end - start) : strlen(start)) - PetscMin(blanks, strlen(start))),
             start + blanks);
    word[strcspn(word, " ]")] = 0;
    PetscCall(NodeCreate(NODE_SCALAR, NULL, word, 0, &item));
    NodeAppend(node, item);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MergeOverrides(Scene scene, PetscInt b)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < scene->n_overrides; i++) {
    Override    *o      = &scene->overrides[i];
    const char  *prefix = scene->blocks[b].prefix;
    const size_t n      = strlen(prefix);
    const Key   *key;

    if (o->used || strncmp(o->name, prefix, n)) continue;
    key = FindKey(scene->blocks[b].section->keys, o->name + n);
    if (key) {
      o->used = 1;
      PetscCall(OverrideKey(scene, b, key, o->value));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the map of a section, or NULL; a section without lines is one with defaults only */
static PetscErrorCode SectionNode(Scene scene, const Block *around, const char name[], Node **node)
{
  char value[128], dotted[512];

  PetscFunctionBegin;
  *node = NodeFind(around->node, name);
  if (!*node || (*node)->kind == NODE_MAP) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*node)->kind == NODE_SCALAR && !(*node)->quoted &&
      (!(*node)->text[0] || !strcmp((*node)->text, "~") || !strcmp((*node)->text, "null"))) {
    (*node)->kind = NODE_MAP;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  NodeFormat(*node, value, sizeof value);
  PetscCall(SceneAddError(scene, (*node)->line, "%s = %s is not a section\nexpected `key: value` lines beneath it",
                          Dotted(around, name, dotted, sizeof dotted), value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names of blocks must not stand for something else in the same place. */
static PetscErrorCode CheckBlockName(Scene scene, PetscInt b, const SceneSection *section, const char name[], int line,
                                     const SceneSection sections[], PetscBool *good)
{
  const Block *around = &scene->blocks[b];
  char         word[2 * BY_NAME_MAX], dotted[512];

  PetscFunctionBegin;
  *good = IsIdentifier(name);
  Dotted(around, section->list, dotted, sizeof dotted);
  if (!*good) {
    PetscCall(SceneAddError(scene, line,
                            "%s names '%s', which cannot be a section\nexpected letters, digits and _, beginning with a letter",
                            dotted, Printable(name, word, sizeof word)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (FindKey(around->section->keys, name)) *good = PETSC_FALSE;
  for (const SceneSection *other = sections; other->name; other++) {
    if (IsWithin(other, around->section) && !other->list && !strcmp(other->name, name)) *good = PETSC_FALSE;
  }
  for (PetscInt i = 0; i < scene->n_blocks; i++) {
    if (scene->blocks[i].parent == b && scene->blocks[i].section != section && !strcmp(BlockName(&scene->blocks[i]), name))
      *good = PETSC_FALSE;
  }
  if (!*good) PetscCall(SceneAddError(scene, line, "%s names %s, but that name is taken\nchoose another name", dotted, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ExpandList(Scene scene, PetscInt b, const SceneSection *section, const SceneSection sections[])
{
  const Node *list = NodeFind(scene->blocks[b].node, section->list);
  char        text[PETSC_MAX_PATH_LEN];
  Names       seen;
  PetscBool   good;

  PetscFunctionBegin;
  seen.n = 0;
  if (!list || list->kind == NODE_MAP) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneValue(list, text, sizeof text));
  for (char *name = text, *end; name && text[0] && seen.n < BY_NAMES_MAX; name = end ? end + 1 : NULL) {
    Node     *node;
    PetscBool twice = PETSC_FALSE;

    end = strchr(name, ',');
    if (end) *end = 0;
    for (PetscInt i = 0; i < seen.n; i++) twice = (PetscBool)(twice || !strcmp(seen.name[i], name));
    if (twice || !name[0]) continue; /* the list's own check reports these */
    PetscCall(CheckBlockName(scene, b, section, name, list->line, sections, &good));
    if (!good) continue;
    strcpy(seen.name[seen.n++], name);
    PetscCall(SectionNode(scene, &scene->blocks[b], name, &node));
    PetscCall(AddBlock(scene, section, b, name, node));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the blocks within block b */
static PetscErrorCode Expand(Scene scene, PetscInt b, const SceneSection sections[])
{
  PetscFunctionBegin;
  for (const SceneSection *section = sections; section->name; section++) {
    Node *node;

    if (!IsWithin(section, scene->blocks[b].section)) continue;
    if (section->list) PetscCall(ExpandList(scene, b, section, sections));
    else {
      PetscCall(SectionNode(scene, &scene->blocks[b], section->name, &node));
      PetscCall(AddBlock(scene, section, b, section->name, node));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* absolute path of a file, relative to the scene (or to the working directory when it comes from the command line) */
static PetscErrorCode ResolveFile(Scene scene, Node *node)
{
  char joined[2 * PETSC_MAX_PATH_LEN], work[PETSC_MAX_PATH_LEN] = "", *real;

  PetscFunctionBegin;
  if (node->path || !node->text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  if (node->text[0] == '/') snprintf(joined, sizeof joined, "%s", node->text);
  else snprintf(joined, sizeof joined, "%s%s", node->overridden ? "" : scene->directory, node->text);
  real = realpath(joined, NULL);
  if (!real && joined[0] != '/' && getcwd(work, sizeof work)) {
    char absolute[3 * PETSC_MAX_PATH_LEN + 2];
    snprintf(absolute, sizeof absolute, "%s/%s", work, joined);
    PetscCall(PetscStrallocpy(absolute, &node->path));
  } else PetscCall(PetscStrallocpy(real ? real : joined, &node->path));
  free(real);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckValue(Scene scene, const Block *block, const Key *key, Node *node)
{
  const PetscBool takes_list = TakesList(key);
  char            text[PETSC_MAX_PATH_LEN], why[PETSC_MAX_PATH_LEN + 1024] = "", allowed[512], dotted[512], value[512];
  PetscBool       nested = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(KeyDescribe(key, allowed, sizeof allowed));
  for (const Node *child = node->child; child; child = child->next)
    nested = (PetscBool)(nested || child->kind != NODE_SCALAR || strchr(child->text, ','));
  if (node->kind == NODE_MAP) snprintf(why, sizeof why, "is a section\nexpected %s", allowed);
  else if (node->kind == NODE_LIST && (!takes_list || nested))
    snprintf(why, sizeof why, "is %s\nexpected %s", takes_list ? "not a plain list" : "a list", allowed);
  else {
    if (key->type == KEY_FILE) PetscCall(ResolveFile(scene, node));
    PetscCall(SceneValue(node, text, sizeof text));
    if (node->kind == NODE_SCALAR && strlen(node->text) >= sizeof text) snprintf(why, sizeof why, "is too long");
    else PetscCall(KeyCheck(key, text, why, sizeof why));
    if (why[0] && node->path) {
      const size_t used = strlen(why);
      snprintf(why + used, sizeof why - used, "\nlooked for %s", node->path);
    }
  }
  if (!why[0]) PetscFunctionReturn(PETSC_SUCCESS);
  NodeFormat(node, value, sizeof value);
  if (node->overridden) snprintf(dotted, sizeof dotted, "-%s%s", block->prefix, key->name);
  else Dotted(block, key->name, dotted, sizeof dotted);
  PetscCall(SceneAddError(scene, node->line, "%s = %s %s", dotted, value, why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the known word nearest to an unknown one: a key or section of this block, else the same key elsewhere */
static void Suggest(Scene scene, PetscInt b, const char name[], char hint[], size_t n)
{
  const Block *block = &scene->blocks[b];
  const char  *best  = NULL;
  char         dotted[512];

  hint[0] = 0;
  for (const Key *key = block->section->keys; key->name; key++) {
    if (KeyIsNear(name, key->name) && (!best || KeyDistance(name, key->name) < KeyDistance(name, best))) best = key->name;
  }
  for (PetscInt i = 0; i < scene->n_blocks; i++) {
    const char *known = BlockName(&scene->blocks[i]);
    if (scene->blocks[i].parent == b && KeyIsNear(name, known) && (!best || KeyDistance(name, known) < KeyDistance(name, best)))
      best = known;
  }
  if (best) {
    if (block->path[0] && block->node && block->node->line)
      snprintf(hint, n, "did you mean %s (line %d has the section)?", Dotted(block, best, dotted, sizeof dotted),
               block->node->line);
    else snprintf(hint, n, "did you mean %s?", Dotted(block, best, dotted, sizeof dotted));
    return;
  }
  for (PetscInt i = 0; i < scene->n_blocks; i++) {
    if (FindKey(scene->blocks[i].section->keys, name)) {
      snprintf(hint, n, "did you mean %s?", Dotted(&scene->blocks[i], name, dotted, sizeof dotted));
      return;
    }
  }
}

static void AppendWord(char text[], size_t n, const char word[])
{
  const size_t used = strlen(text);

  snprintf(text + used, n - used, "%s%s", used && text[used - 1] != ' ' ? ", " : "", word);
}

static PetscErrorCode UnknownKey(Scene scene, PetscInt b, const Node *node, const SceneSection sections[])
{
  const Block *block = &scene->blocks[b];
  char         hint[2048], dotted[512];
  PetscBool    lists = PETSC_FALSE;

  PetscFunctionBegin;
  Dotted(block, node->key, dotted, sizeof dotted);
  Suggest(scene, b, node->key, hint, sizeof hint);
  if (hint[0]) {
    PetscCall(
        SceneAddError(scene, node->line, "%s is not a known %s\n%s", dotted, node->kind == NODE_MAP ? "section" : "key", hint));
    PetscFunctionReturn(PETSC_SUCCESS);
  }

  /* a section of the user's own needs a list that names it */
  if (node->kind == NODE_MAP) {
    snprintf(hint, sizeof hint, "add it to one of the lists: ");
    for (const SceneSection *section = sections; section->name; section++) {
      if (!section->list || !IsWithin(section, block->section)) continue;
      AppendWord(hint, sizeof hint, section->list);
      lists = PETSC_TRUE;
    }
    if (lists) {
      PetscCall(SceneAddError(scene, node->line, "%s is a section that no list names\n%s", dotted, hint));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  snprintf(hint, sizeof hint, "known here: ");
  for (const Key *key = block->section->keys; key->name; key++) AppendWord(hint, sizeof hint, key->name);
  for (PetscInt i = 0; i < scene->n_blocks; i++) {
    if (scene->blocks[i].parent == b) AppendWord(hint, sizeof hint, BlockName(&scene->blocks[i]));
  }
  PetscCall(SceneAddError(scene, node->line, "%s is not a known %s\n%s", dotted, node->kind == NODE_MAP ? "section" : "key", hint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckBlock(Scene scene, PetscInt b, const SceneSection sections[])
{
  const Block *block = &scene->blocks[b];
  char         dotted[512], allowed[512];

  PetscFunctionBegin;
  if (!block->node && block->section->list) {
    const Node *list = NodeFind(scene->blocks[block->parent].node, block->section->list);
    Dotted(&scene->blocks[block->parent], block->section->list, dotted, sizeof dotted);
    PetscCall(SceneAddError(scene, list->line, "%s names %s, but there is no section %s", dotted, BlockName(block), block->path));
  }
  if (!block->node || block->node->kind != NODE_MAP) PetscFunctionReturn(PETSC_SUCCESS);
  for (Node *node = block->node->child; node; node = node->next) {
    const Key *key      = FindKey(block->section->keys, node->key);
    PetscBool  is_block = PETSC_FALSE;

    if (key) {
      PetscCall(CheckValue(scene, block, key, node));
      continue;
    }
    for (PetscInt i = 0; i < scene->n_blocks; i++)
      is_block = (PetscBool)(is_block || (scene->blocks[i].parent == b && !strcmp(BlockName(&scene->blocks[i]), node->key)));
    if (!is_block) PetscCall(UnknownKey(scene, b, node, sections));
  }
  for (const Key *key = block->section->keys; key->name; key++) {
    if (!(key->flags & KEY_REQUIRED) || NodeFind(block->node, key->name)) continue;
    PetscCall(KeyDescribe(key, allowed, sizeof allowed));
    PetscCall(SceneAddError(scene, block->node->line, "%s is missing\nexpected %s: %s",
                            Dotted(block, key->name, dotted, sizeof dotted), allowed, key->help));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc looks for -ball_1_mesh under -ball_mesh too, and does not tell Ball from ball: such names cannot be in one scene */
static PetscErrorCode CheckClashes(Scene scene)
{
  char reduced[4 * BY_NAME_MAX], option[6 * BY_NAME_MAX];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->n_blocks; b++) {
    const Block *block = &scene->blocks[b];
    size_t       n     = 0;

    for (const char *c = block->prefix; *c; c++) {
      const size_t digits = *c == '_' ? strspn(c + 1, "0123456789") : 0;
      reduced[n++]        = *c;
      if (digits && c[1 + digits] == '_') c += 1 + digits;
    }
    reduced[n] = 0;
    for (PetscInt a = 0; a < scene->n_blocks; a++) {
      const Block *other = &scene->blocks[a];
      const size_t m     = strlen(other->prefix);
      PetscBool    clash;

      /* flap.proxy and fin.proxy clash only when flap and fin do */
      if (a == b || (block->parent != other->parent && !strcmp(BlockName(block), BlockName(other)))) continue;
      clash = (PetscBool)(!strcasecmp(reduced, other->prefix) && (a < b || strcasecmp(block->prefix, other->prefix)));

      for (const Key *key = block->section->keys; key->name && !clash && !strncasecmp(block->prefix, other->prefix, m); key++) {
        snprintf(option, sizeof option, "%s%s", block->prefix + m, key->name);
        clash = (PetscBool)(FindKey(other->section->keys, option) != NULL && strlen(block->prefix) > m);
      }
      if (clash)
        PetscCall(SceneAddError(scene, block->node ? block->node->line : 1,
                                "the names %s and %s cannot be in one scene: their options -%s... are the same\nrename one",
                                block->path, other->path, other->prefix));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* options that are PETSc's own, and the views and solvers of the blocks */
static PetscBool IsForeign(Scene scene, const char name[])
{
  static const char *const prefixes[]  = {"ksp_", "pc_", "snes_", "mat_", "vec_", "log_", "options_", "malloc_", NULL};
  static const char *const of_blocks[] = {"ksp_", "pc_", "tao_", "implicit_", NULL}; // solvers that a block makes

  if (!strcmp(name, "info") || !strcmp(name, "help") || !strcmp(name, "malloc")) return PETSC_TRUE;
  for (PetscInt i = 0; prefixes[i]; i++) {
    if (!strncmp(name, prefixes[i], strlen(prefixes[i]))) return PETSC_TRUE;
  }
  for (PetscInt b = 1; b < scene->n_blocks; b++) {
    const size_t n = strlen(scene->blocks[b].prefix);
    if (!scene->blocks[b].node || strncmp(name, scene->blocks[b].prefix, n)) continue;
    if (!strcmp(name + n, "view")) return PETSC_TRUE;
    for (PetscInt i = 0; of_blocks[i]; i++) {
      if (!strncmp(name + n, of_blocks[i], strlen(of_blocks[i]))) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

static PetscErrorCode CheckOverrides(Scene scene)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < scene->n_overrides; i++) {
    const char *name                  = scene->overrides[i].name;
    char        best[6 * BY_NAME_MAX] = "", option[6 * BY_NAME_MAX], word[2 * BY_NAME_MAX];

    if (scene->overrides[i].used || IsForeign(scene, name)) continue;
    for (PetscInt b = 0; b < scene->n_blocks; b++) {
      for (const Key *key = scene->blocks[b].section->keys; key->name; key++) {
        snprintf(option, sizeof option, "%s%s", scene->blocks[b].prefix, key->name);
        if (KeyIsNear(name, option) && (!best[0] || KeyDistance(name, option) < KeyDistance(name, best))) strcpy(best, option);
      }
    }
    Printable(name, word, sizeof word);
    if (best[0]) PetscCall(SceneAddError(scene, 0, "-%s is not a known option\ndid you mean -%s?", word, best));
    else PetscCall(SceneAddError(scene, 0, "-%s is not a known option\n`byssus run -help` lists them", word));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All errors of a parsed scene, and its blocks. */
PetscErrorCode SceneCheck(Scene scene, const SceneSection sections[])
{
  static const Key          no_keys[] = {KEY_END};
  static const SceneSection no_top    = {"", no_keys, NULL, NULL, NULL};
  const SceneSection       *top       = &no_top;

  PetscFunctionBegin;
  for (const SceneSection *section = sections; section->name; section++) {
    if (!section->name[0]) top = section;
  }
  PetscCall(AddBlock(scene, top, -1, "", scene->root));
  for (PetscInt b = 0; b < scene->n_blocks; b++) {
    PetscCall(MergeOverrides(scene, b));
    PetscCall(Expand(scene, b, sections));
  }
  for (PetscInt b = 0; b < scene->n_blocks; b++) PetscCall(CheckBlock(scene, b, sections));
  PetscCall(CheckClashes(scene));
  PetscCall(CheckOverrides(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checked values -> options database; keys that the scene does not have are cleared, whoever set them. */
PetscErrorCode SceneToOptions(Scene scene)
{
  char      option[6 * BY_NAME_MAX], text[PETSC_MAX_PATH_LEN];
  PetscBool was_used;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->n_blocks; b++) {
    for (const Key *key = scene->blocks[b].section->keys; key->name; key++) {
      const Node *node = NodeFind(scene->blocks[b].node, key->name);

      PetscCall(PetscSNPrintf(option, sizeof option, "-%s%s", scene->blocks[b].prefix, key->name));
      if (!node) {
        PetscCall(PetscOptionsClearValue(NULL, option));
        continue;
      }
      PetscCall(SceneValue(node, text, sizeof text));
      PetscCall(PetscOptionsSetValue(NULL, option, text));
    }
  }
  for (PetscInt i = 0; i < scene->n_overrides; i++) {
    if (scene->overrides[i].used) continue;
    PetscCall(PetscSNPrintf(option, sizeof option, "-%s", scene->overrides[i].name));
    PetscCall(PetscOptionsUsed(NULL, option + 1, &was_used));
    PetscCall(PetscOptionsSetValue(NULL, option, scene->overrides[i].value));
    if (was_used) PetscCall(PetscOptionsHasName(NULL, NULL, option, &was_used));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
