/* Where the automatic functions have their words in the dual-ported RAM (host-bus:6.2, host-bus:7.2): byte offsets as
 * the host counts them, for the firmware (C) and for hosts and tests (C++). PMAC address $060000 + offset / 4; an
 * offset that divides by 4 is its Y word, the one behind it its X word. An item of 32 bits has its low half first.
 *
 * Not in the SystemRDL maps: those describe registers that the RTL holds, each with its reset and its users in RTL and
 * model, while to the hardware these are words of one memory. */
#ifndef RTL_REGS_DPRAM_MAP_H
#define RTL_REGS_DPRAM_MAP_H

enum dpram_map {
  DPRAM_WORD_BYTES = 2, /* a 16-bit word */
  DPRAM_ITEM_BYTES = 4, /* an item of 32 bits: a PMAC address */

  /* Both reports have the same header: X word 0 host busy, X word 1 data ready and the high bits of the timer. */
  DPRAM_HOST_BUSY = 0x8000,
  DPRAM_DATA_READY = 0x8000,
  DPRAM_TIMER_HIGH = 0x00FF,

  /* Motor data, host-bus:6.4. */
  DPRAM_MOTOR_HOST_BUSY = 0x006A,
  DPRAM_MOTOR_TIMER = 0x006C, /* bits 15..0 of the servo counter */
  DPRAM_MOTOR_READY = 0x006E, /* bits 23..16, and DPRAM_DATA_READY */
  DPRAM_MOTOR_MASK = 0x0070,  /* 32 bits: motor m is bit m - 1 */
  DPRAM_MOTOR_BLOCKS = 0x0074,
  DPRAM_MOTOR_STRIDE = 48,
  DPRAM_MOTOR_FOLLOWING_ERROR = 0, /* long */
  DPRAM_MOTOR_OUTPUT = 8,
  DPRAM_MOTOR_SERVO_STATUS = 12,
  DPRAM_MOTOR_STATUS = 16,
  DPRAM_MOTOR_BIAS = 20, /* long */
  DPRAM_MOTOR_VELOCITY = 28,
  DPRAM_MOTOR_MASTER = 32,   /* long */
  DPRAM_MOTOR_POSITION = 40, /* long */

  /* Background data, host-bus:6.5. */
  DPRAM_BACKGROUND_COUNT = 0x0674, /* bits 7..0: coordinate systems that are reported */
  DPRAM_BACKGROUND_HOST_BUSY = 0x0676,
  DPRAM_BACKGROUND_TIMER = 0x0678,
  DPRAM_BACKGROUND_READY = 0x067A,
  DPRAM_PANEL_PORT = 0x067C,
  DPRAM_MACHINE_PORT = 0x0680,
  DPRAM_THUMBWHEEL_PORT = 0x0684,
  DPRAM_GLOBAL_STATUS = 0x0688, /* two items */
  DPRAM_CS_BLOCKS = 0x069C,
  DPRAM_CS_STRIDE = 128,
  DPRAM_CS_FEED_RATE = 0, /* long float */
  DPRAM_CS_TIME_BASE = 8,
  DPRAM_CS_TIME_BASE_SOURCE = 12,
  DPRAM_CS_STATUS_3 = 16, /* third word of `??` */
  DPRAM_CS_STATUS_1 = 20, /* its first */
  DPRAM_CS_TARGETS = 24,  /* A B C U V W X Y Z, long floats */
  DPRAM_CS_STATUS_2 = 96,
  DPRAM_CS_LINES = 100, /* PR */
  DPRAM_CS_MOVE_TIME_LEFT = 104,
  DPRAM_CS_ACCELERATION_TIME_LEFT = 108,
  DPRAM_CS_EXECUTING = 112, /* PE */

  /* ASCII port, host-bus:6.6. */
  DPRAM_COMMAND_CONTROL = 0x0E9C, /* bit 0: a command stands in the buffer */
  DPRAM_CONTROL_CHARACTER = 0x0E9E,
  DPRAM_COMMAND_TEXT = 0x0EA0,
  DPRAM_COMMAND_BYTES = 160,
  DPRAM_RESPONSE_CONTROL = 0x0F40,
  DPRAM_RESPONSE_COUNT = 0x0F42, /* characters + 1 */
  DPRAM_RESPONSE_TEXT = 0x0F44,
  DPRAM_RESPONSE_BYTES = 256,
  DPRAM_RESPONSE_LINE = 0x000D,
  DPRAM_RESPONSE_ACKNOWLEDGE = 0x0006,
  DPRAM_RESPONSE_COMMAND = 0x010D,
  DPRAM_RESPONSE_SEND = 0x020D,
  DPRAM_RESPONSE_ERROR = 0x8000, /* and three decimal digits, four bits each */

  /* Background variable buffers, host-bus:6.7. Starts are in PMAC addresses from DPRAM_OPEN on, here and below. */
  DPRAM_READ_CONTROL = 0x1044,
  DPRAM_READ_TIMER = 0x1046,
  DPRAM_READ_SIZE = 0x1048,
  DPRAM_READ_START = 0x104A,
  DPRAM_WRITE_SIZE = 0x104C,
  DPRAM_WRITE_START = 0x104E,
  DPRAM_READ_READY = 0x0001,      /* control word, single-user mode */
  DPRAM_READ_MULTI_USER = 0x0100, /* control word */
  DPRAM_ENTRY_READY = 0x8000,     /* type word of an entry, multi-user mode */
  DPRAM_READ_ENTRIES = 128,
  DPRAM_WRITE_ENTRIES = 32,
  DPRAM_WRITE_ENTRY_BYTES = 12,

  /* Binary rotary transfer, host-bus:7.2: a header a coordinate system. */
  DPRAM_ROTARY_HEADERS = 0x1050,
  DPRAM_ROTARY_STRIDE = 12,
  DPRAM_ROTARY_STATUS = 0, /* PMAC writes it */
  DPRAM_ROTARY_ENABLE = 2, /* number of the coordinate system; 0: off */
  DPRAM_ROTARY_HOST_INDEX = 4,
  DPRAM_ROTARY_PMAC_INDEX = 6, /* PMAC writes it */
  DPRAM_ROTARY_SIZE = 8,       /* items of 32 bits */
  DPRAM_ROTARY_START = 10,
  DPRAM_ROTARY_ERROR_CODE = 0x00FF,
  DPRAM_ROTARY_BUSY = 0x4000,
  DPRAM_ROTARY_ERROR = 0x8000,

  /* Gathering, host-bus:6.8. */
  DPRAM_GATHER_SIZE = 0x113C,
  DPRAM_GATHER_POINTER = 0x113E,

  DPRAM_OPEN = 0x1140, /* the host's own, and the buffers whose place is its choice */
  DPRAM_OPEN_ADDRESS = 0x060450
};

#endif
