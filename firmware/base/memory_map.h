/* PMAC words of main memory that the firmware keeps or reads, as users find them (firmware:1.10). Words of devices come
 * from rtl/regs/brick_regs.h. */
#ifndef FIRMWARE_BASE_MEMORY_MAP_H
#define FIRMWARE_BASE_MEMORY_MAP_H

enum {
  MEMORY_SERVO_COUNT = 0x000000,         /* X: servo interrupts */
  MEMORY_GLOBAL_STATUS = 0x000006,       /* X: first word, Y: second */
  MEMORY_REAL_TIME_DURATIONS = 0x00000B, /* X: last, Y: longest real-time task, in half CPU cycles */
  MEMORY_DISPLAY_POINTER = 0x000024,     /* X: address of the display text */
  MEMORY_WATCHDOG_COUNT = 0x000025,      /* Y: counter, X: lowest value since reset */
  MEMORY_TASK_DURATIONS = 0x000037,      /* Y: servo task, X: phase task, in half CPU cycles */
  MEMORY_DPRAM_END = 0x00003F,           /* Y: address after the dual-ported RAM, tells its size */
  MEMORY_FAULT = 0x000070,               /* three long words: image/fault.h */
  MEMORY_STACKS = 0x000073,              /* X, Y: kernel/stack_watch.h */
  MEMORY_MOTOR_WORDS = 0x000080,         /* registers of motor n (1..32) begin at n times this */
  MEMORY_MOTOR_COMMANDED = 0x08,         /* D: and actual position, compensation, bias: 1/(32 Ixx08) count */
  MEMORY_MOTOR_ACTUAL = 0x0B,
  MEMORY_MOTOR_MASTER = 0x0D,
  MEMORY_MOTOR_COMPENSATION = 0x10,
  MEMORY_MOTOR_VELOCITY = 0x1D,      /* X: 1/(32 Ixx09) count a servo cycle */
  MEMORY_MOTOR_FILTER_OUTPUT = 0x3F, /* X: what the servo loop commands, 24 bits */
  MEMORY_MOTOR_TARGET = 0x47,        /* D: end of the present motion */
  MEMORY_MOTOR_BIAS = 0x4C,
  MEMORY_MOTOR_CAPTURE = 0x4E,          /* Y: counter at the last trigger */
  MEMORY_MOTOR_JOG = 0x57,              /* L: position or distance of J=*, J:*, J^* in counts */
  MEMORY_MOTOR_AVERAGE_VELOCITY = 0x6F, /* D: 1/(32 Ixx09) count a servo cycle */
  MEMORY_DISPLAY = 0x001080,            /* Y: one character a word (run/display.h) */
  MEMORY_CS_WORDS = 0x002000,           /* registers of coordinate system 1, the others each CS_STRIDE on */
  MEMORY_CS_STRIDE = 0x100,
  MEMORY_CS_ROTARY = 0x3E,           /* X: lines of the rotary buffer that are not calculated, Y: their words */
  MEMORY_CS_TARGETS = 0x41,          /* L: of A, B, C, U, V, W, X, Y, Z */
  MEMORY_PLC_STATUS = 0x003100,      /* Y: one word a PLC (run/plc_control.h) */
  MEMORY_GATHER_POINTERS = 0x003120, /* X: address of the buffer, Y: of what is gathered next */
  MEMORY_CONVERSION = 0x003501, /* X: results of the encoder conversion table, a line each; Y: its lines, I8000 on */
  MEMORY_M_DEFINITIONS = 0x004000,
  MEMORY_P_VARIABLES = 0x006000,
  MEMORY_Q_VARIABLES = 0x008000,
  MEMORY_BUFFERS = 0x00A000,
  MEMORY_BUFFERS_END = 0x010800
};

#endif
