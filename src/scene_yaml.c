/* scene_yaml.c - YAML text -> tree with line numbers, and back. JSON is read by the same parser. */
#include "scene_impl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* deeper than any scene; keeps a hostile file from exhausting the stack */
#define DEPTH_MAX 16

PetscErrorCode NodeCreate(NodeKind kind, const char key[], const char text[], int line, Node **node)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(node));
  (*node)->kind = kind;
  (*node)->line = line;
  PetscCall(PetscStrallocpy(key, &(*node)->key));
  PetscCall(PetscStrallocpy(text, &(*node)->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void NodeAppend(Node *parent, Node *child)
{
  if (parent->last) parent->last->next = child;
  else parent->child = child;
  parent->last = child;
}

Node *NodeFind(const Node *map, const char key[])
{
  if (!map || map->kind != NODE_MAP) return NULL;
  for (Node *child = map->child; child; child = child->next) {
    if (!strcmp(child->key, key)) return child;
  }
  return NULL;
}

void NodeDestroy(Node **node)
{
  if (!*node) return;
  for (Node *child = (*node)->child, *next; child; child = next) {
    next = child->next;
    NodeDestroy(&child);
  }
  (void)PetscFree((*node)->key);
  (void)PetscFree((*node)->text);
  (void)PetscFree((*node)->path);
  (void)PetscFree(*node);
}

static void AppendText(char text[], size_t n, const char more[])
{
  const size_t used = strlen(text);

  snprintf(text + used, n - used, "%s", more);
}

static void AppendNode(const Node *node, char text[], size_t n)
{
  if (node->kind == NODE_SCALAR) {
    AppendText(text, n, node->text);
    return;
  }
  AppendText(text, n, node->kind == NODE_LIST ? "[" : "{");
  for (const Node *child = node->child; child; child = child->next) {
    if (child != node->child) AppendText(text, n, ", ");
    if (child->key) {
      AppendText(text, n, child->key);
      AppendText(text, n, ": ");
    }
    AppendNode(child, text, n);
  }
  AppendText(text, n, node->kind == NODE_LIST ? "]" : "}");
}

void NodeFormat(const Node *node, char text[], size_t n)
{
  text[0] = 0;
  AppendNode(node, text, n);

  /* messages are lines: no control characters, and an end that shows where text was cut */
  for (char *c = text; *c; c++) {
    if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
  }
  if (n > 4 && strlen(text) == n - 1) strcpy(text + n - 4, "...");
}

/* next event, or an error with its line */
static PetscErrorCode NextEvent(Scene scene, yaml_parser_t *parser, yaml_event_t *event, PetscBool *good)
{
  PetscFunctionBegin;
  *good = PETSC_TRUE;
  if (!yaml_parser_parse(parser, event)) {
    const int   line    = (int)parser->problem_mark.line + 1;
    const char *problem = parser->problem ? parser->problem : "cannot be read";

    *good = PETSC_FALSE;
    if (parser->context)
      PetscCall(SceneAddError(scene, line, "YAML: %s, %s (line %d)", problem, parser->context, (int)parser->context_mark.line + 1));
    else PetscCall(SceneAddError(scene, line, "YAML: %s", problem));
  } else if (event->type == YAML_ALIAS_EVENT) {
    *good = PETSC_FALSE;
    PetscCall(SceneAddError(scene, (int)event->start_mark.line + 1, "aliases (*%.40s) are not part of a scene\nwrite the value out",
                            (const char *)event->data.alias.anchor));
    yaml_event_delete(event);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadNode(Scene scene, yaml_parser_t *parser, yaml_event_t *event, const char key[], int key_line, int depth,
                               Node **node);

static PetscErrorCode ReadKeyAndValue(Scene scene, yaml_parser_t *parser, yaml_event_t *event, int depth, Node *map)
{
  Node     *value = NULL, *first;
  char     *key   = NULL;
  PetscBool good;
  const int line = (int)event->start_mark.line + 1;

  PetscFunctionBegin;
  if (event->type != YAML_SCALAR_EVENT) {
    PetscCall(SceneAddError(scene, line, "a key must be a word"));
    yaml_event_delete(event);
    map->kind = NODE_LIST; /* tells the caller that reading ends here */
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscStrallocpy((const char *)event->data.scalar.value, &key));
  yaml_event_delete(event);
  PetscCall(NextEvent(scene, parser, event, &good));
  if (good) PetscCall(ReadNode(scene, parser, event, key, line, depth + 1, &value));
  if (value) {
    first = NodeFind(map, key);
    if (first) PetscCall(SceneAddError(scene, line, "%s is given twice\nfirst in line %d", key, first->line));
    NodeAppend(map, value);
  } else map->kind = NODE_LIST;
  PetscCall(PetscFree(key));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the value that begins with `event` (which is consumed); *node = NULL after an error. */
static PetscErrorCode ReadNode(Scene scene, yaml_parser_t *parser, yaml_event_t *event, const char key[], int key_line, int depth,
                               Node **node)
{
  const int               line  = key_line ? key_line : (int)event->start_mark.line + 1;
  const yaml_event_type_t begin = event->type;
  PetscBool               good  = PETSC_TRUE;

  PetscFunctionBegin;
  *node = NULL;
  if (begin == YAML_SCALAR_EVENT) {
    PetscCall(NodeCreate(NODE_SCALAR, key, (const char *)event->data.scalar.value, line, node));
    (*node)->quoted = (PetscBool)(event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE);
    if (strlen((*node)->text) != event->data.scalar.length) {
      PetscCall(SceneAddError(scene, line, "text with a zero byte"));
      NodeDestroy(node);
    }
    yaml_event_delete(event);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  yaml_event_delete(event);
  if (depth > DEPTH_MAX) {
    PetscCall(SceneAddError(scene, line, "nested deeper than %d levels", DEPTH_MAX));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(NodeCreate(begin == YAML_MAPPING_START_EVENT ? NODE_MAP : NODE_LIST, key, NULL, line, node));
  while (good) {
    PetscCall(NextEvent(scene, parser, event, &good));
    if (!good) break;
    if (event->type == YAML_MAPPING_END_EVENT || event->type == YAML_SEQUENCE_END_EVENT) {
      yaml_event_delete(event);
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    if (begin == YAML_MAPPING_START_EVENT) {
      PetscCall(ReadKeyAndValue(scene, parser, event, depth, *node));
      good = (PetscBool)((*node)->kind == NODE_MAP);
    } else {
      Node *item;
      PetscCall(ReadNode(scene, parser, event, NULL, 0, depth + 1, &item));
      if (item) NodeAppend(*node, item);
      good = (PetscBool)(item != NULL);
    }
  }
  NodeDestroy(node);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Text of the scene -> scene->root, a map; errors are added to the scene. */
PetscErrorCode SceneParse(Scene scene)
{
  yaml_parser_t parser;
  yaml_event_t  event;
  PetscBool     good, more = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCheck(yaml_parser_initialize(&parser), PETSC_COMM_SELF, PETSC_ERR_MEM, "libyaml cannot allocate");
  yaml_parser_set_input_string(&parser, (const unsigned char *)scene->text, strlen(scene->text));
  while (more) {
    PetscCall(NextEvent(scene, &parser, &event, &good));
    if (!good) break;
    if (event.type == YAML_MAPPING_START_EVENT || event.type == YAML_SEQUENCE_START_EVENT || event.type == YAML_SCALAR_EVENT) {
      const int line = (int)event.start_mark.line + 1;

      if (scene->root) {
        PetscCall(SceneAddError(scene, line, "a second document begins here; a scene is one"));
        yaml_event_delete(&event);
        break;
      }
      PetscCall(ReadNode(scene, &parser, &event, NULL, 0, 0, &scene->root));
      more = (PetscBool)(scene->root != NULL);
      if (scene->root && scene->root->kind != NODE_MAP) {
        PetscCall(SceneAddError(scene, line, "a scene is a set of `key: value` lines"));
        break;
      }
    } else {
      more = (PetscBool)(event.type != YAML_STREAM_END_EVENT);
      yaml_event_delete(&event);
    }
  }
  yaml_parser_delete(&parser);
  if (!scene->root && !scene->n_errors) PetscCall(SceneAddError(scene, 1, "the scene is empty"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void WriteScalar(const Node *node, FILE *out)
{
  const char *text  = node->path ? node->path : node->text;
  const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-";

  if (!node->quoted && text[0] && strspn(text, plain) == strlen(text) && strcmp(text, "-") && strcmp(text, "---") &&
      strcmp(text, "...")) {
    fputs(text, out);
    return;
  }
  if (!node->quoted && !text[0]) return;
  fputc('"', out);
  for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
    if (*c == '"' || *c == '\\') fprintf(out, "\\%c", *c);
    else if (*c < ' ' || *c == 127) fprintf(out, "\\x%02X", *c);
    else fputc(*c, out);
  }
  fputc('"', out);
}

/* block style for sections, one line for lists */
static void WriteNode(const Node *node, int indent, FILE *out)
{
  if (node->kind == NODE_SCALAR) WriteScalar(node, out);
  else if (node->kind == NODE_MAP && node->child) {
    for (const Node *child = node->child; child; child = child->next) {
      if (indent || child != node->child) fputc('\n', out);
      fprintf(out, "%*s%s:", indent, "", child->key);
      if (child->kind != NODE_MAP || !child->child) fputc(' ', out);
      WriteNode(child, indent + 2, out);
    }
  } else {
    fputc(node->kind == NODE_MAP ? '{' : '[', out);
    for (const Node *child = node->child; child; child = child->next) {
      if (child != node->child) fputs(", ", out);
      WriteNode(child, indent, out);
    }
    fputc(node->kind == NODE_MAP ? '}' : ']', out);
  }
}

PetscErrorCode NodeWrite(const Node *root, const char without[], FILE *out)
{
  PetscFunctionBegin;
  for (const Node *child = root->child; child; child = child->next) {
    Node alone = *root, only = *child;

    if (without && child->key && !strcmp(child->key, without)) continue;
    alone.child = alone.last = &only;
    only.next                = NULL;
    WriteNode(&alone, 0, out);
    fputc('\n', out);
  }
  if (!root->child) fputs("{}\n", out);
  PetscFunctionReturn(PETSC_SUCCESS);
}
