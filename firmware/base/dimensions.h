/* How many coordinate systems, motors and variables the controller has. The first two are counted from 0 inside the
 * firmware: `&1` is coordinate system 0, `#1` motor 0. */
#ifndef FIRMWARE_BASE_DIMENSIONS_H
#define FIRMWARE_BASE_DIMENSIONS_H

enum { COORDINATE_SYSTEMS = 16, MOTORS = 32 };

#define VARIABLE_COUNT 8192u /* of I, P, Q and M each */

#endif
