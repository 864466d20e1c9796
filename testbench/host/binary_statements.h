// The statements that the binary form of program lines knows (host-bus:7.7), and those that it does not.
#pragma once

#include <array>
#include <string_view>

namespace brick {

enum class BinaryArgument {
  kNone,
  kValue,
  kNotNegative,
  kTime,
  kLabel,
  kAxes,
  kFrax,
  kMotors,
  kPlcs,
  kInAscii  // the statement has no binary form; what is behind it does not matter
};

struct BinaryStatement {
  std::string_view name, brief;  // a blank may be left out
  unsigned code1, code2, n;
  BinaryArgument argument;
  enum Place { kAnywhere, kCall, kBehindCall, kBehindAnother } place = kAnywhere;
};

inline constexpr std::array kBinaryStatements = {
    BinaryStatement{"I", "", 1, 1, 0, BinaryArgument::kValue, BinaryStatement::kBehindAnother},
    BinaryStatement{"J", "", 1, 1, 1, BinaryArgument::kValue},
    BinaryStatement{"K", "", 1, 1, 2, BinaryArgument::kValue},
    BinaryStatement{"R", "", 1, 1, 3, BinaryArgument::kValue},
    BinaryStatement{"LINEAR", "LIN", 2, 0, 0, BinaryArgument::kNone},
    BinaryStatement{"RAPID", "RPD", 2, 0, 1, BinaryArgument::kNone},
    BinaryStatement{"CIRCLE1", "CIR1", 2, 0, 2, BinaryArgument::kNone},
    BinaryStatement{"CIRCLE2", "CIR2", 2, 0, 3, BinaryArgument::kNone},
    BinaryStatement{"SPLINE1", "", 2, 0, 4, BinaryArgument::kNone},
    BinaryStatement{"SPLINE2", "", 2, 0, 5, BinaryArgument::kNone},
    BinaryStatement{"PVT", "", 2, 0, 6, BinaryArgument::kNotNegative},
    BinaryStatement{"CC0", "", 2, 0, 8, BinaryArgument::kNone},
    BinaryStatement{"CC1", "", 2, 0, 9, BinaryArgument::kNone},
    BinaryStatement{"CC2", "", 2, 0, 10, BinaryArgument::kNone},
    BinaryStatement{"CC3", "", 2, 0, 11, BinaryArgument::kNone},
    BinaryStatement{"BLOCKSTART", "BSTART", 2, 0, 16, BinaryArgument::kNone},
    BinaryStatement{"BLOCKSTOP", "BSTOP", 2, 0, 17, BinaryArgument::kNone},
    BinaryStatement{"STOP", "", 2, 0, 18, BinaryArgument::kNone},
    BinaryStatement{"TINIT", "", 2, 0, 24, BinaryArgument::kNone},
    BinaryStatement{"MOVETIME", "MVTM", 2, 0, 25, BinaryArgument::kNone},
    BinaryStatement{"PSET", "", 2, 0, 26, BinaryArgument::kNone},
    BinaryStatement{"NORMAL", "NRM", 2, 0, 27, BinaryArgument::kNone},
    BinaryStatement{"ABS", "", 2, 1, 0, BinaryArgument::kAxes},
    BinaryStatement{"INC", "", 2, 2, 0, BinaryArgument::kAxes},
    BinaryStatement{"FRAX", "", 2, 3, 0, BinaryArgument::kFrax},
    BinaryStatement{"NOFRAX", "", 2, 3, 0, BinaryArgument::kNone},
    BinaryStatement{"F", "", 3, 0, 0, BinaryArgument::kNotNegative},
    BinaryStatement{"TM", "", 3, 0, 1, BinaryArgument::kTime},
    BinaryStatement{"TA", "", 3, 0, 2, BinaryArgument::kNotNegative},
    BinaryStatement{"TS", "", 3, 0, 3, BinaryArgument::kNotNegative},
    BinaryStatement{"DWELL", "DWE", 3, 0, 4, BinaryArgument::kNotNegative},
    BinaryStatement{"DELAY", "DLY", 3, 0, 5, BinaryArgument::kNotNegative},
    BinaryStatement{"CCR", "", 3, 0, 6, BinaryArgument::kValue},
    BinaryStatement{"ADIS", "", 3, 0, 8, BinaryArgument::kValue},
    BinaryStatement{"IDIS", "", 3, 0, 9, BinaryArgument::kValue},
    BinaryStatement{"AROT", "", 3, 0, 10, BinaryArgument::kValue},
    BinaryStatement{"IROT", "", 3, 0, 11, BinaryArgument::kValue},
    BinaryStatement{"TSELECT", "TSEL", 3, 0, 12, BinaryArgument::kValue},
    BinaryStatement{"PRELUDE", "", 3, 0, 13, BinaryArgument::kValue},
    BinaryStatement{"G", "", 8, 0, 0, BinaryArgument::kValue, BinaryStatement::kCall},
    BinaryStatement{"M", "", 8, 0, 1, BinaryArgument::kValue, BinaryStatement::kCall},
    BinaryStatement{"T", "", 8, 0, 2, BinaryArgument::kValue, BinaryStatement::kCall},
    BinaryStatement{"D", "", 8, 0, 3, BinaryArgument::kValue, BinaryStatement::kCall},
    BinaryStatement{"S", "", 8, 0, 4, BinaryArgument::kValue},
    BinaryStatement{"N", "", 8, 0, 5, BinaryArgument::kLabel},
    BinaryStatement{"O", "", 8, 0, 6, BinaryArgument::kLabel},
    BinaryStatement{"E", "", 8, 0, 20, BinaryArgument::kValue, BinaryStatement::kBehindCall},
    BinaryStatement{"H", "", 8, 0, 23, BinaryArgument::kValue, BinaryStatement::kBehindCall},
    BinaryStatement{"L", "", 8, 0, 27, BinaryArgument::kValue, BinaryStatement::kBehindCall},
    BinaryStatement{"P", "", 8, 0, 31, BinaryArgument::kValue, BinaryStatement::kBehindCall},
    BinaryStatement{"Q", "", 8, 0, 32, BinaryArgument::kValue, BinaryStatement::kBehindCall},
    BinaryStatement{"CALL", "", 9, 0, 3, BinaryArgument::kValue, BinaryStatement::kCall},
    BinaryStatement{"LOCK", "", 9, 0, 12, BinaryArgument::kValue},
    BinaryStatement{"UNLOCK", "", 9, 0, 13, BinaryArgument::kValue},
    BinaryStatement{"HOME", "HM", 9, 1, 0, BinaryArgument::kMotors},
    BinaryStatement{"HOMEZ", "HMZ", 9, 1, 1, BinaryArgument::kMotors},
    BinaryStatement{"ENABLE PLC", "ENA PLC", 9, 1, 3, BinaryArgument::kPlcs},
    BinaryStatement{"DISABLE PLC", "DIS PLC", 9, 1, 4, BinaryArgument::kPlcs},
    BinaryStatement{"PAUSE PLC", "PAU PLC", 9, 1, 5, BinaryArgument::kPlcs},
    BinaryStatement{"RESUME PLC", "RES PLC", 9, 1, 6, BinaryArgument::kPlcs},
    BinaryStatement{"ENABLE PLCC", "ENA PLCC", 9, 1, 7, BinaryArgument::kPlcs},
    BinaryStatement{"DISABLE PLCC", "DIS PLCC", 9, 1, 8, BinaryArgument::kPlcs},
    BinaryStatement{"IF", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"WHILE", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"AND", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"OR", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"ELSE", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"ENDIF", "ENDI", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"END IF", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"ENDWHILE", "ENDW", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"END WHILE", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"WAIT", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"GOTO", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"GOSUB", "GOS", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"RETURN", "RET", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"READ", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"ADDRESS", "ADR", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"SEND", "", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"COMMAND", "CMD", 0, 0, 0, BinaryArgument::kInAscii},
    BinaryStatement{"DISPLAY", "DISP", 0, 0, 0, BinaryArgument::kInAscii},
};

}  // namespace brick
