/* Axis matrices (motion:8.2): X, Y and Z of programs are not those of the axis definitions, but
 *
 *     programmed = R x base + D
 *
 * with the matrix that the coordinate system has selected. Matrices stand in TBUF, twelve words each, for all systems;
 * a system works with its own copy, and with what leads back. Positions of coordinate_system.h are base. Real-time
 * task, in slices. */
#ifndef FIRMWARE_MOTION_AXIS_MATRIX_H
#define FIRMWARE_MOTION_AXIS_MATRIX_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/motion/coordinate_system.h"

void axis_matrix_initialize(void); /* none is selected. Background */
void axis_matrix_clear(void);      /* TBUF has come: the same, and its matrices are unit matrices. Background */

/* TSELECT n; 0: none. False: there are not so many, or it leads nowhere. */
bool axis_matrix_select(uint32_t cs, double number);
/* What changes the selected one; `q`: the first of three or nine Q-variables. False: none is selected, there are no
 * such variables, or nothing leads back from what it makes; it stays as it was then. */
enum matrix_change { MATRIX_ADIS, MATRIX_IDIS, MATRIX_AROT, MATRIX_IROT, MATRIX_TINIT };
bool axis_matrix_change(uint32_t cs, enum matrix_change change, double q);
bool axis_matrix_is_selected(uint32_t cs);

double axis_matrix_programmed(uint32_t cs, uint32_t axis); /* where the last calculated move ends */
/* The targets, velocities and vectors of the line, as the program has them, become those of base. */
void axis_matrix_line(uint32_t cs);
/* Of NORMAL: a plane of the program is that plane of base, in which arcs turn as the program sees them. */
void axis_matrix_normal(uint32_t cs, double normal[3]);

#endif
