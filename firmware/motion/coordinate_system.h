/* State of the 16 coordinate systems. What a program moves are axes: their positions are kept here, those of motors
 * follow from the axis definitions (motion/system_motors.h). A system without motors runs all the same, its axes are
 * virtual then. Motion is a ring of pieces (motion/piece.h), which the servo task goes through; moves are what pieces
 * belong to, for programs, hosts and status words. Times of the trajectory are in trajectory units, 2^-23 ms, the unit
 * of I10, so that the servo task adds and compares integers only. Owners: B background, R real-time task, S servo task.
 * B changes what R or S own only while they are held off. */
#ifndef FIRMWARE_MOTION_COORDINATE_SYSTEM_H
#define FIRMWARE_MOTION_COORDINATE_SYSTEM_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/base/dimensions.h"
#include "firmware/language/word.h"
#include "firmware/motion/piece.h"
#include "firmware/variables/i_variables.h"

#define TRAJECTORY_LONGEST_MS 8388607.0

enum {
  TRAJECTORY_FRACTION_BITS = 23,
  MOVE_MINIMUM_UNITS = 4194304, /* 0.5 ms, least move time when TA and TS are both 0 (firmware:7.5) */
  CALCULATED_LINES_LIMIT = 32 /* lines without a move that one real-time interrupt works off for a coordinate system */
};

/* Lines of programs: that of the one that was called last, and before it those from which each was called. Program 0 is
 * the rotary buffer. */
enum { CALL_DEPTH = 15 }; /* calls in each other */
struct program_place {
  uint16_t program, offset;
};
struct program_trace {
  uint32_t depth;
  struct program_place places[CALL_DEPTH + 1];
};

enum program_pointer { POINTER_NONE, POINTER_ROTARY, POINTER_FIXED };

enum move_kind {
  MOVE_LINEAR,
  MOVE_DWELL,
  MOVE_OWN, /* motors go for themselves: RAPID, HOME */
  MOVE_PVT,
  MOVE_SPLINE,
  MOVE_SEGMENTS /* a sequence of LINEAR and CIRCLE moves (motion/segment.h) */
};

enum { KNOTS = 4 };
enum { SEGMENT_OVERRIDE_ONE = 1 << 30 }; /* Isx15 = 0 */

/* Where the axes are, and their velocities a ms, between two cubics. */
struct knot {
  double position[AXIS_COUNT], velocity[AXIS_COUNT];
};

/* One calculated move. R writes it while it is not the executing one, and its stop until that begins.
 *
 *   velocity   _____________              A move changes velocity during its first `blend_in` units, its corner lies in
 *            /:             \:            the middle of that; the next corner is `time` later. The next move, if it is
 *           / :              :\______     there in time, begins half its own acceleration time before that corner,
 *    ______/  :              :            else the velocity falls to zero during `stop_length` around the corner. From
 *          |<>|blend_in/2    corner + Tm  rest to rest a move so takes Tm + Ta. */
struct move {
  enum move_kind kind;
  int64_t time;         /* Tm, or the length of the DWELL */
  int64_t acceleration; /* Ta, even */
  int64_t s_curve;      /* TS */
  bool joins;           /* may blend with the move before it */
  int64_t blend_in;     /* length of the velocity change at its start */
  int64_t stop_length;  /* of that to rest about its end, for want of a blend; even */
  bool blended;         /* begins at the velocity of the move before */
  uint32_t straight;    /* number of its last piece of constant velocity, and when in the move that begins */
  int64_t straight_begin;
  double start[AXIS_COUNT]; /* corner at which it begins */
  double delta[AXIS_COUNT];
  double delta_before[AXIS_COUNT]; /* of the move before, and its Tm */
  int64_t time_before;
  /* PVT, SPLINE: cubics from knot to knot. The first is the move; what is behind it is left for the next move. Of a
   * SPLINE point n the positions are those of points n - 3 to n, velocities are not kept (motion/position.c). */
  uint32_t knot_count;
  int64_t knot_time[KNOTS - 1];
  int64_t time_ahead; /* SPLINE: of point n - 2 */
  struct knot knots[KNOTS];
  bool overruns;             /* motors end in motion: without a next one it runs on, to be stopped */
  bool waited;               /* its line was waited for: who is late then is the host */
  uint32_t own;              /* OWN: the motors */
  bool homes;                /* they search for home */
  bool is_sharp, has_dwell;  /* not blended: for its corner; Isx82 counts */
  struct program_trace line; /* PE */
};

/* Where a system stands between moves that do not blend (motion:5.3). */
enum corner_stop { CORNER_NONE, CORNER_IN_POSITION, CORNER_DWELL };

/* Why a program was stopped (firmware:7.10): the numbers that clients read in Y:+$14. */
enum run_time_error {
  RUN_TIME_NONE,
  RUN_TIME_STATEMENT,   /* cannot be executed: not built, or no statement */
  RUN_TIME_PROGRAM,     /* a program that is called is not there */
  RUN_TIME_LABEL,       /* nor a label */
  RUN_TIME_DEPTH,       /* CALL_DEPTH calls in each other, and one more */
  RUN_TIME_BLOCK,       /* IF, WHILE and their ends do not fit together, or too many loops in one line */
  RUN_TIME_SYNCHRONOUS, /* more assignments before one move than can wait */
  RUN_TIME_READ,        /* READ where nothing has been called */
  RUN_TIME_FEEDRATE,    /* a move goes by a feedrate that is not above 0 */
  RUN_TIME_LATE,        /* a PVT move in motion has no next one in time, a spline no point, a path no segment */
  RUN_TIME_IN_POSITION, /* motors are not in position within Isx81 */
  RUN_TIME_RADIUS,      /* there is no arc through the ends of a CIRCLE move */
  RUN_TIME_KINEMATIC,   /* a kinematic program does not end, or what it gives is no position */
  RUN_TIME_BY_USER      /* somebody has set the bit of run-time errors */
};

enum { ARC_VECTORS = 4, ARC_RADIUS_BIT = 8 }; /* I, J, K, R */

struct coordinate_system {
  /* program pointer and requests */
  enum program_pointer pointer; /* B */
  uint32_t fixed_program;       /* B: number given to B{n} */
  volatile bool running;        /* B sets, R clears */
  bool continuous;              /* B: R, not S */
  bool stepping;                /* B sets, R clears when the step's move is calculated */
  volatile bool quit;           /* Q, or the end of a step: calculate no more */
  bool ended;                   /* R: the end of the program was reached since its start, */
  bool own_stop;                /* R: or a STOP or a run-time error: `quit` is that, no start before it undoes it */
  volatile bool end_block;      /* `/`: no further move is started */
  bool quit_at_block;           /* B: `/` of motors, a Q that status shows until a start */
  /* moves are dropped: set by B or R; virtual axes stand still, motors leave the path; R finds the position and clears
   * it */
  volatile bool settling;
  bool matching;             /* B, R clears: axes are to be where motors are; before moves that wait at a start, */
  bool starting;             /* which is this: B, R clears; else behind them */
  bool matching_anew;        /* B: asked for once more, while it is worked out */
  bool match_failed;         /* R: `error` is that of a PMATCH while no program ran */
  bool must_return;          /* B: stopped where a start goes on, so motors that were jogged meanwhile must be back */
  volatile bool restarts;    /* B, an abort clears it: a program begins when the motors stand (run/restart.h) */
  bool must_have_returned;   /* B: a start was refused because they are not */
  enum run_time_error error; /* R; B clears it when the program is started */
  /* modal state of the program, R (B for on-line ABS, INC, FRAX) */
  uint32_t incremental, feedrate_axes; /* axis masks */
  bool vector_absolute, time_mode;
  enum mode mode;
  bool unblended; /* at the start of the program: Isx92 */
  bool may_join;  /* the last calculated move can blend with one after it */
  /* calculation, R */
  double position[AXIS_COUNT]; /* end of the last calculated move */
  /* of the last calculated move, and its Tm: a velocity is divided when it is needed */
  double last_delta[AXIS_COUNT];
  int64_t last_time;
  double carry[AXIS_COUNT];   /* what incremental moves have lost by rounding of the position: none adds up */
  double pending[AXIS_COUNT]; /* targets of the line being calculated */
  uint32_t pending_axes, pending_absolute;                          /* of those: by ABS */
  double pending_velocity[AXIS_COUNT], pending_trigger[AXIS_COUNT]; /* behind `:` and `^`: units a Isx90, units */
  uint32_t pending_velocities, pending_triggers;
  double pending_vector[ARC_VECTORS]; /* I, J, K, R of a CIRCLE line */
  uint32_t pending_vectors;
  double normal[3];          /* of the plane of arcs */
  bool sets_normal;          /* I, J, K are those of NORMAL, until the line ends or an axis comes */
  bool was_matched;          /* since the last MOVE_OWN */
  bool first;                /* no move of this run has been placed yet */
  bool waited;               /* for a line, since the last calculated move; a start is such a wait */
  bool sets_position;        /* the line is that of PSET */
  bool by_segments;          /* the line's path is made of segments */
  bool slots_wait;           /* assignments in the slots of the lookahead buffer; */
  bool slots_short;          /* one was lost since the start for want of one */
  struct program_trace line; /* being calculated */
  uint32_t planned;          /* moves so far */
  /* moves: moves[executing] is the one that executes or has been last, the other one is the next */
  struct move moves[2];
  volatile uint32_t executing; /* S */
  volatile bool active;        /* S: moves[executing] is under way */
  volatile bool next_valid;    /* R sets when it is calculated, S clears when it starts it */
  bool placed;                 /* R, S: the next one is in the ring; until then it does not start */
  volatile uint32_t started;   /* S: moves so far, counted as `planned` */
  uint32_t motors;             /* R, at the start of a program: those that its axes move; 0: the axes are virtual */
  uint32_t inverse_motors;     /* R, as those: which of them the inverse program moves */
  bool kinematic;              /* R, as those: Isx50, the forward program tells where the axes are */
  struct piece_ring ring;      /* piece.move is the number of the move, as `planned` counts */
  int64_t elapsed;             /* S: trajectory time since the executing move began to change velocity */
  enum corner_stop corner;     /* R */
  uint32_t corner_began;       /* R: real-time interrupt */
  enum run_time_error failure; /* R: found while a move waited to be placed */
  uint32_t segment_override;   /* R: Isx15 as the last segment had it; no end of a sequence or program changes it */
  /* time base: trajectory units a servo cycle */
  volatile int32_t increment;        /* S */
  int32_t increment_before;          /* S: at the interrupt before its last step */
  volatile int32_t increment_target; /* B */
  volatile int32_t increment_slew;   /* B; S when the target of a hold's end has been reached */
  volatile int32_t increment_usual;  /* B: Isx94, what is slewed by then */
  /* B: the word that Isx93 points to, which has the target instead; null: its own commanded time base */
  const volatile uint32_t* volatile time_base_source;
  int32_t increment_full;    /* B: I10, taken over by %100 */
  int32_t increment_command; /* B: target without the hold of H */
  bool held;                 /* B: H */
};

extern struct coordinate_system coordinate_systems[COORDINATE_SYSTEMS];

/* One bit a coordinate system that the servo task has work for. S clears, R sets; B sets only while both are held off.
 * A clear that is lost to R costs one more look, nothing else. */
extern volatile uint32_t cs_busy;
/* One bit a coordinate system that runs or settles. B and R set it behind either, R alone clears it. */
extern volatile uint32_t cs_awake;
extern uint32_t cs_interrupts; /* R: real-time interrupts so far */

void coordinate_systems_initialize(void);      /* power-up, $$$ and $$$***: idle, at 0, without axes */
void coordinate_systems_forget_programs(void); /* none points to a program any more: R needs a new B */
/* OP_ABS, OP_INC, OP_FRAX. Background and real-time task. */
void cs_set_axis_mode(struct coordinate_system* s, enum operation operation, uint32_t mask);

/* The calculated move goes on with the executing one: it blends with it, or is of the same sequence. */
static inline bool move_continues(const struct coordinate_system* s) {
  const struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  return s->active && next->joins && m->kind == next->kind;
}

/* The calculated move that waits for its start, 0: none. Its place is read first: where S starts it in between, it is
 * none, not the one that has been executed. */
static inline const struct move* cs_next_move(const struct coordinate_system* s) {
  const struct move* next = &s->moves[s->executing ^ 1u];
  return s->next_valid ? next : 0;
}

/* Something but a DWELL is under way or waits. */
static inline bool cs_moves(const struct coordinate_system* s) {
  const struct move *m = &s->moves[s->executing], *next = &s->moves[s->executing ^ 1u];
  return (s->active && m->kind != MOVE_DWELL) || (s->next_valid && next->kind != MOVE_DWELL);
}

static inline double cs_variable(uint32_t cs, enum i_name isxnn) { return i_variable_read(i_cs(cs, isxnn)); }
static inline double cs_real(uint32_t cs, enum i_real_name isxnn) { return i_variable_read(i_cs_real(cs, isxnn)); }

#endif
