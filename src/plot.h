/* plot.h - the Python program that draws pictures (src/plot). */
#ifndef BY_PLOT_H
#define BY_PLOT_H

#include "base.h"

/* become `plot.py argv[2] ...` (argv as main has it); returns an exit status only when that cannot be started */
BY_EXTERN int PlotProgram(char *argv[]);
/* pictures of a directory of results; a machine that cannot draw them has its numbers all the same: a warning */
BY_EXTERN void PlotDirectory(char directory[]);

#endif
