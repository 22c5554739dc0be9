/* output.c - what all results share: the message of a failed write, directories, whole text files, growing text, numbers. */
#include "output_file.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

PetscErrorCode OutputReport(const char path[], const char reason[])
{
  fflush(stdout);
  fprintf(stderr, "cannot write %s: %s\n", path, reason);
  return BY_ERR_OUTPUT;
}

PetscErrorCode OutputPath(const char directory[], const char name[], const char suffix[], char path[PETSC_MAX_PATH_LEN])
{
  const int n = snprintf(path, PETSC_MAX_PATH_LEN, "%s/%s%s", directory && *directory ? directory : ".", name, suffix);

  // room for the names under which files are first written
  return n < 0 || n > PETSC_MAX_PATH_LEN - 8 ? OutputReport(path, strerror(ENAMETOOLONG)) : PETSC_SUCCESS;
}

void OutputIgnoreSizeSignal(void)
{
  struct sigaction now;

  // a handler that someone else has set stays
  if (!sigaction(SIGXFSZ, NULL, &now) && now.sa_handler == SIG_DFL) signal(SIGXFSZ, SIG_IGN);
}

/*@
  OutputMakeDirectory - make a directory and its parents, and see that files can be written there

  Not Collective

  Input Parameter:
. path - the directory; one that exists is fine

  Errors:
  BY_ERR_OUTPUT, reported as `cannot write PATH: reason`

  Note:
  From here on a file that grows over the shell's limit (ulimit -f) is a failed write and no longer a deadly SIGXFSZ.
@*/
PetscErrorCode OutputMakeDirectory(const char path[])
{
  char        part[PETSC_MAX_PATH_LEN];
  struct stat status;
  size_t      n;

  PetscFunctionBegin;
  OutputIgnoreSizeSignal();
  n = strlen(path);
  if (n == 0) PetscFunctionReturn(OutputReport("(an empty directory name)", strerror(ENOENT)));
  if (n >= sizeof(part)) PetscFunctionReturn(OutputReport(path, strerror(ENAMETOOLONG)));
  memcpy(part, path, n + 1);
  for (char *end = part + 1;; end++) {
    if (*end != '/' && *end != '\0') continue;
    const char was = *end;

    *end = '\0';
    if (mkdir(part, 0777) && errno != EEXIST) PetscFunctionReturn(OutputReport(part, strerror(errno)));
    *end = was;
    if (!was) break;
  }
  if (stat(path, &status)) PetscFunctionReturn(OutputReport(path, strerror(errno)));
  if (!S_ISDIR(status.st_mode)) PetscFunctionReturn(OutputReport(path, strerror(ENOTDIR)));
  if (access(path, W_OK | X_OK)) PetscFunctionReturn(OutputReport(path, strerror(errno)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* all of a buffer to a file, whatever pieces the system takes it in */
static int WriteAll(int fd, const char text[], size_t n)
{
  while (n) {
    const ssize_t m = write(fd, text, n);

    if (m < 0 && errno != EINTR) return -1;
    if (m > 0) {
      text += m;
      n -= (size_t)m;
    }
  }
  return 0;
}

PetscErrorCode OutputReplaceText(const char path[], const char text[], size_t n, PetscBool sync)
{
  char name[PETSC_MAX_PATH_LEN];
  int  fd, failed;

  PetscFunctionBegin;
  OutputIgnoreSizeSignal();
  snprintf(name, sizeof(name), "%s.new", path);
  fd = open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) PetscFunctionReturn(OutputReport(path, strerror(errno)));
  failed = WriteAll(fd, text, n) || (sync && fsync(fd)) ? errno : 0;
  if (close(fd) && !failed) failed = errno;
  if (!failed && rename(name, path)) failed = errno;
  if (failed) {
    unlink(name);
    PetscFunctionReturn(OutputReport(path, strerror(failed)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void OutputFormatReal(PetscReal x, char text[32])
{
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, 32, "%.*g", digits, (double)x);
    if (strtod(text, NULL) == (double)x) return;
  }
}

PetscErrorCode OutputTextAdd(OutputText *text, const char format[], ...)
{
  va_list arguments;
  int     n;

  PetscFunctionBegin;
  va_start(arguments, format);
  n = vsnprintf(NULL, 0, format, arguments);
  va_end(arguments);
  PetscCheck(n >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "cannot format %s", format);
  if (text->n + (size_t)n + 1 > text->capacity) {
    const size_t capacity = 2 * text->capacity + (size_t)n + 1024;
    char        *more     = (char *)realloc(text->text, capacity);

    PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for %zu bytes of text", capacity);
    text->text     = more;
    text->capacity = capacity;
  }
  va_start(arguments, format);
  vsnprintf(text->text + text->n, (size_t)n + 1, format, arguments);
  va_end(arguments);
  text->n += (size_t)n;
  PetscFunctionReturn(PETSC_SUCCESS);
}
