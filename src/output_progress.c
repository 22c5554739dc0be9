/* output_progress.c - the line that tells how far a run is. */
#include "output.h"
#include <unistd.h>

#define REFRESH_TERMINAL 0.1 /* [s] */
#define REFRESH_LOG 10.0     /* [s] */

struct _Progress {
  PetscBool active, terminal, started;
  PetscReal time0, wall0; /* where this process began: a resumed run does not count what was done before */
  PetscInt  step0;
  PetscReal shown;      /* wall time of the last line   */
  PetscInt  step_shown; /* its step                     */
  PetscReal rate;       /* steps per second, smoothed   */
};

PetscErrorCode ProgressCreate(Progress *progress)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscNew(progress));
  (*progress)->active   = rank == 0 ? PETSC_TRUE : PETSC_FALSE;
  (*progress)->terminal = isatty(STDERR_FILENO) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* hours, minutes, seconds */
static void FormatDuration(PetscReal seconds, char text[32])
{
  const double s = PetscIsInfOrNanReal(seconds) || seconds > 3.6e8 ? 3.6e8 : PetscMax(seconds, 0.0);
  const long   n = (long)(s + 0.5);

  snprintf(text, 32, "%02ld:%02ld:%02ld", n / 3600, n / 60 % 60, n % 60);
}

/*@
  ProgressShow - show how far a run is, on stderr: every tenth of a second on a terminal (one line that is written over), every ten
  seconds in a log; always when `last`

  Input Parameters:
+ progress - the progress
. state    - times [s], step, pressure iterations of the last step
- last     - the run is over; ends the line

  Note:
  The remaining time assumes that what is left goes as fast as what this process has done.
@*/
PetscErrorCode ProgressShow(Progress progress, const ProgressState *state, PetscBool last)
{
  const PetscReal refresh = progress->terminal ? REFRESH_TERMINAL : REFRESH_LOG;
  PetscReal       done, since;
  char            left[32];

  PetscFunctionBegin;
  if (!progress->active) PetscFunctionReturn(PETSC_SUCCESS);
  if (!progress->started) {
    progress->started    = PETSC_TRUE;
    progress->time0      = state->time;
    progress->wall0      = state->wall;
    progress->step0      = state->step;
    progress->shown      = state->wall;
    progress->step_shown = state->step;
    if (!last) PetscFunctionReturn(PETSC_SUCCESS);
  }
  since = state->wall - progress->shown;
  if (!last && since < refresh) PetscFunctionReturn(PETSC_SUCCESS);

  // steps per second of about the last five seconds; at the end of all
  if (last) progress->rate = state->wall > progress->wall0 ? (state->step - progress->step0) / (state->wall - progress->wall0) : 0;
  else {
    const PetscReal now = (state->step - progress->step_shown) / since, weight = PetscMin(1.0, since / 5.0);

    progress->rate = progress->rate > 0 ? (1 - weight) * progress->rate + weight * now : now;
  }
  progress->shown      = state->wall;
  progress->step_shown = state->step;

  done = state->time - progress->time0;
  FormatDuration(last       ? state->wall
                 : done > 0 ? (state->wall - progress->wall0) * (state->end - state->time) / done
                            : PETSC_INFINITY,
                 left);
  fprintf(stderr,
          "%s%5.1f %%  time %.5g / %.5g s  step %" PetscInt_FMT "  dt %.2e s  %" PetscInt_FMT " iterations  %.3g steps/s  %s %s%s",
          progress->terminal ? "\r" : "", 100.0 * state->time / PetscMax(state->end, 1e-300), state->time, state->end, state->step,
          state->dt, state->iterations, progress->rate, last ? "took" : "left", done > 0 || last ? left : "--:--:--",
          progress->terminal ? "\033[K" : "");
  if (last || !progress->terminal) fprintf(stderr, "\n");
  fflush(stderr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProgressDestroy(Progress *progress)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(*progress));
  PetscFunctionReturn(PETSC_SUCCESS);
}
