/* Error numbers of the command interpreter (firmware:6.4). A function that can fail returns one of these; 0 is success.
 */
#ifndef FIRMWARE_BASE_ERROR_H
#define FIRMWARE_BASE_ERROR_H

typedef enum {
  ERR_NONE = 0,
  ERR_PROGRAM_RUNNING = 1,
  ERR_PASSWORD = 2,
  ERR_DATA = 3,
  ERR_CHARACTER = 4,
  ERR_NEEDS_BUFFER = 5,
  ERR_NO_ROOM = 6,
  ERR_BUFFER_OPEN = 7,
  ERR_MACRO = 8,
  ERR_STRUCTURE = 9,
  ERR_BOTH_LIMITS = 10,
  ERR_MOVE_IN_PROGRESS = 11,
  ERR_OPEN_LOOP = 12,
  ERR_NOT_ACTIVATED = 13,
  ERR_NO_MOTORS = 14,
  ERR_NO_PROGRAM = 15,
  ERR_BAD_PROGRAM = 16,
  ERR_MOVED = 17,
  ERR_PHASING = 18
} error_t;

#endif
