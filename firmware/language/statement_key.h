/* Codes of the statements that something but compiler and lister knows by name; those of statements.def. */
#ifndef FIRMWARE_LANGUAGE_STATEMENT_KEY_H
#define FIRMWARE_LANGUAGE_STATEMENT_KEY_H

#include "firmware/language/word.h"

enum statement_key {
  KEY_ARC_VECTOR = WORD_KEY(1, 1, 0), /* I, then J, K, R */
  KEY_TRIGGER = WORD_KEY(1, 2, 0),    /* behind `^`, by axis */
  KEY_VELOCITY = WORD_KEY(1, 3, 0),   /* behind `:`, by axis */
  KEY_MODE = WORD_KEY(2, 0, 0),       /* and enum mode */
  KEY_BLOCKSTART = WORD_KEY(2, 0, 16),
  KEY_BLOCKSTOP = WORD_KEY(2, 0, 17),
  KEY_STOP = WORD_KEY(2, 0, 18),
  KEY_RETURN = WORD_KEY(2, 0, 19),
  KEY_WAIT = WORD_KEY(2, 0, 20),
  KEY_ELSE = WORD_KEY(2, 0, 21),
  KEY_ENDIF = WORD_KEY(2, 0, 22),
  KEY_ENDWHILE = WORD_KEY(2, 0, 23),
  KEY_TINIT = WORD_KEY(2, 0, 24),
  KEY_MOVETIME = WORD_KEY(2, 0, 25),
  KEY_PSET = WORD_KEY(2, 0, 26),
  KEY_NORMAL = WORD_KEY(2, 0, 27),
  KEY_ADIS = WORD_KEY(3, 0, 8), /* then IDIS, AROT, IROT, TSELECT */
  KEY_IDIS = WORD_KEY(3, 0, 9),
  KEY_AROT = WORD_KEY(3, 0, 10),
  KEY_IROT = WORD_KEY(3, 0, 11),
  KEY_TSELECT = WORD_KEY(3, 0, 12),
  KEY_PRELUDE = WORD_KEY(3, 0, 13),
  KEY_G = WORD_KEY(8, 0, 0),
  KEY_M = WORD_KEY(8, 0, 1),
  KEY_T = WORD_KEY(8, 0, 2),
  KEY_D = WORD_KEY(8, 0, 3),
  KEY_S = WORD_KEY(8, 0, 4),
  KEY_N = WORD_KEY(8, 0, 5),
  KEY_O = WORD_KEY(8, 0, 6),
  KEY_CALL = WORD_KEY(9, 0, 3),
  KEY_GOTO = WORD_KEY(9, 0, 10),
  KEY_GOSUB = WORD_KEY(9, 0, 11),
  KEY_READ = WORD_KEY(9, 1, 2),
  KEY_HOME = WORD_KEY(9, 1, 0),
  KEY_HOMEZ = WORD_KEY(9, 1, 1),
  KEY_ENABLE_PLC = WORD_KEY(9, 1, 3),
  KEY_DISABLE_PLC = WORD_KEY(9, 1, 4),
  KEY_PAUSE_PLC = WORD_KEY(9, 1, 5),
  KEY_RESUME_PLC = WORD_KEY(9, 1, 6),
  KEY_ENABLE_PLCC = WORD_KEY(9, 1, 7),
  KEY_DISABLE_PLCC = WORD_KEY(9, 1, 8),
  KEY_ADDRESS = WORD_KEY(9, 1, 9),
  KEY_SETPHASE = WORD_KEY(9, 1, 11),
  KEY_SEND = WORD_KEY(9, 2, 0), /* then SENDS, SENDP, SENDR, SENDA */
  KEY_COMMAND = WORD_KEY(9, 2, 5),
  KEY_DISPLAY = WORD_KEY(9, 2, 10),
  KEY_LOCK = WORD_KEY(9, 0, 12),
  KEY_UNLOCK = WORD_KEY(9, 0, 13)
};

#endif
