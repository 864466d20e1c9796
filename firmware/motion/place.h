/* Calculated moves become pieces. Each is placed with a stop at its end; the next one takes the place of that stop if
 * it blends and comes before the servo task has begun it. docs/moves.md */
#ifndef FIRMWARE_MOTION_PLACE_H
#define FIRMWARE_MOTION_PLACE_H

#include <stdbool.h>
#include <stdint.h>

/* The calculated move, if there is one that is not placed. False: there is none, or it has to wait: for `/`, for the
 * end of the one before, or for room. Real-time task, in slices; of virtual axes the background too. */
bool move_place(uint32_t cs);
/* A PVT move that ends in motion would run on. What comes behind it in time, and does not go on with it, takes that
 * back, before it is placed itself: the move ends where it shall. False: it runs on. Real-time task. */
bool move_ends(uint32_t cs);
/* Of virtual axes, servo task held off: the next move is out of the ring again if it has not begun, and the executing
 * one stops at its corner, in what is left of it if its own stop should have begun. */
void move_take_back(uint32_t cs);

#endif
