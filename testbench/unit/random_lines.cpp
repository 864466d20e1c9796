#include "testbench/unit/random_lines.h"

#include <algorithm>
#include <cstdio>

namespace brick {
namespace {

constexpr unsigned kLineLimit = 255, kCarriageReturn = 13;

// What is not of the grammar does not hit upon what is left out: it has no I-variable, no write and no pointer.
std::string harmless(std::string text) {
  for (char& c : text) c = c == 'I' || c == 'i' ? 'P' : c == 'W' || c == 'w' ? 'R' : c == '>' ? '<' : c;
  return text;
}

std::string hex(unsigned value) {
  char text[16];
  std::snprintf(text, sizeof text, "$%X", value);
  return text;
}

}  // namespace

// Small, large and at the edges alike.
std::string RandomLines::integer(unsigned below_it) {
  if (one_in(40)) return std::to_string(below_it - 1 + below(3));
  unsigned value = below(below_it);
  if (!one_in(3)) value %= 20;
  return one_in(6) ? hex(value) : std::to_string(value);
}

std::string RandomLines::constant() {
  static const std::vector<std::string> edges = {"0",
                                                 "-1",
                                                 "1",
                                                 "0.1",
                                                 "34359738368",
                                                 "-34359738368",
                                                 "$7FFFFF",
                                                 "$FFFFFFFFF",
                                                 ".0000001",
                                                 "99999999999999999999",
                                                 "8388607",
                                                 "-8388608",
                                                 "140737488355328"};
  if (one_in(30)) return pick(edges);
  std::string text = (one_in(4) ? "-" : "") + integer(100000);
  if (text.find('$') == std::string::npos && one_in(3)) text += "." + std::to_string(below(10000));
  return text;
}

std::string RandomLines::expression(unsigned depth) {
  static const std::vector<std::string> functions = {"SIN",   "COS", "TAN", "ASIN", "ACOS", "ATAN",
                                                     "ATAN2", "LN",  "EXP", "SQRT", "ABS",  "INT"};
  static const std::vector<std::string> operators = {"+", "-", "*", "/", "%", "&", "|", "^"};
  std::string text;
  const unsigned terms = depth == 0 ? 1 : 1 + below(one_in(5) ? 12 : 3);
  for (unsigned i = 0; i < terms; ++i) {
    if (i != 0) text += pick(operators);
    switch (below(depth == 0 ? 3 : 6)) {
      case 0:
      case 1:
        text += constant();
        break;
      case 2:
        text += pick({"P", "Q", "M", "I"}) + integer(8192);
        break;
      case 3:
        text += pick(functions) + "(" + expression(depth - 1) + ")";
        break;
      case 4:
        text += (one_in(3) ? "-(" : "(") + expression(depth - 1) + ")";
        break;
      default:
        text += pick({"P", "Q", "M", "I"}) + "(" + expression(depth - 1) + ")";
        break;
    }
  }
  return text;
}

std::string RandomLines::i_variable() {
  struct Block {
    unsigned first, last;
  };
  static const Block blocks[] = {{0, 18}, {20, 36}, {41, 51}, {53, 99}, {100, 4899}, {5000, 6699}, {8000, 8191}};
  unsigned number = 0;
  if (one_in(8)) {
    number = 7010 + 100 * below(10) + 50 * below(2) + below(40);  // channels
  } else {
    const Block& block = blocks[below(7)];
    number = block.first + below(block.last - block.first + 1);
  }
  return "I" + std::to_string(number);
}

std::string RandomLines::pqm_variable() {
  const std::string letter = pick({"P", "Q", "M"});
  return one_in(4) ? letter + "(" + expression(2) + ")" : letter + integer(8192);
}

std::string RandomLines::assignment() {
  std::string left = one_in(3) ? i_variable() : pqm_variable();
  if (left[0] == 'I') return left + "=" + (one_in(6) ? "*" : expression(1));
  if (one_in(8)) left += ".." + integer(8192);
  if (one_in(10)) left += "," + integer(8192) + (one_in(2) ? "," + integer(9) : "");
  return left + "=" + expression(3);
}

std::string RandomLines::settings() {
  std::string text;
  for (unsigned i = 0; i < 8; ++i) text += i_variable() + "=" + (one_in(3) ? integer(8388607) : constant()) + " ";
  return text;
}

std::string RandomLines::statement() {
  switch (below(6)) {
    case 0:
      return assignment();
    case 1:
      return pick({"LINEAR", "RAPID", "ABS", "INC", "ABS(X,Y)", "INC(A,B,R)", "FRAX(X)", "NOFRAX", "FRAX"});
    case 2:
      return pick({"F", "TM", "TA", "TS"}) + (one_in(2) ? integer(1000) : "(" + expression(2) + ")");
    case 3:
      return pick({"DWELL", "DELAY"}) + (one_in(2) ? std::to_string(below(5)) : "(" + expression(1) + ")");
    case 4:
      if (!one_in(5)) return "X" + constant();
      return one_in(2) ? logic()
                       : pick({"GOTO10", "CALL5", "SPLINE1", "N5X1", "RET", "SEND\"A\"", "CIRCLE1", "HM1..8", "M1==2",
                               "READ(A,B)", "CMD\"#1J/\"", "DISPLAY 5, 8.2, P1", "ENA PLC 1,3..7", "DISPLC0..31"});
    default: {
      std::string text;
      for (unsigned i = 0, axes = 1 + below(9); i < axes; ++i)
        text += pick({"A", "B", "C", "U", "V", "W", "X", "Y", "Z"}) +
                (one_in(2) ? constant() : "(" + expression(one_in(4) ? 3 : 1) + ")");
      return text;
    }
  }
}

std::string RandomLines::logic() {
  const std::string condition = "(" + expression(1) + pick({"=", "!=", "<", ">", "!<"}) + expression(1) + ")";
  return pick({"IF" + condition, "WHILE" + condition, "AND" + condition, "OR" + condition, std::string("ELSE"),
               std::string("ENDIF"), std::string("ENDWHILE"), "WAIT" + condition});
}

std::string RandomLines::report() {
  static const std::vector<std::string> queries = {"?",   "??",  "???",  "P",     "V",   "F",    "VER",  "TYPE", "CID",
                                                   "CPU", "VID", "DATE", "EAVER", "SID", "SIZE", "PR",   "PC",   "PE",
                                                   "%",   "&",   "#",    "##",    "MS",  "LIST", "TIME", "TODAY"};
  if (one_in(2)) return pick(queries);
  const std::string letter = pick({"I", "P", "Q", "M"});
  if (one_in(4)) return letter + "(" + expression(2) + ")";
  std::string text = letter + integer(8192);
  if (one_in(3)) text += ".." + integer(8192);
  if (one_in(6)) text += "," + integer(60);
  return letter == "M" && one_in(2) ? text + "->" : text;
}

std::string RandomLines::definition() {
  if (one_in(4))
    return "#" + integer(33) + "->" + pick({"", "0", "X", "1000X-0.5Y+5", "A", "I", "10X+A", constant() + "Z"});
  std::string text = "M" + integer(8192) + (one_in(6) ? ".." + integer(8192) : "") + "->";
  if (one_in(5)) return text + "*";
  const unsigned address = one_in(4)   ? 0x60000 + below(0x4000)
                           : one_in(3) ? 0x4000 + below(0x2000)
                                       : 0x100 + below(0x3FF00);
  text += pick({"X:", "Y:", "D:", "L:", "DP:", "X", "Y"}) + hex(address);
  if (one_in(2)) text += "," + integer(25) + (one_in(2) ? "," + integer(25) + (one_in(2) ? ",S" : "") : "");
  return text;
}

std::string RandomLines::memory() {
  const std::string form = pick({"X", "Y", "L", "D"});
  if (one_in(2)) {
    const unsigned address = one_in(3) ? below(0x1000000) : one_in(2) ? 0x78000 + below(0x4000) : below(0x40000);
    return pick({"R", "RH"}) + form + hex(address) + (one_in(2) ? "," + integer(66) : "");
  }
  const unsigned address = one_in(2)   ? 0x4000 + below(0xC800)
                           : one_in(2) ? 0x60000 + below(0x3F00)
                                       : 0x100 + below(0x3FE00);
  std::string text = "W" + form + hex(address);
  for (unsigned i = 0, count = 1 + below(8); i < count; ++i)
    text += "," + (one_in(2) ? hex(below(0x1000000)) : expression(1));
  return text;
}

std::string RandomLines::buffer() {
  static const std::vector<std::string> texts = {
      "OPEN ROT", "OPEN ROT",   "OPEN BINARY ROT",  "CLOSE",      "CLOSE",    "CLEAR",
      "DEL ROT",  "DEL GATHER", "DELETE ALL TEMPS", "DEF GATHER", "UNDEFINE", "UNDEFINE ALL"};
  if (one_in(4)) return fixed_buffer();
  if (one_in(2)) return pick(texts);
  return "DEF " + pick({"ROT", "ROT", "ROT", "GATHER", "LOOKAHEAD", "CCBUF"}) + integer(3000) +
         (one_in(4) ? "," + integer(300) : "");
}

std::string RandomLines::fixed_buffer() {
  const std::string motion = "PROG" + integer(12), plc = "PLC" + integer(33), part = "," + integer(300) + ",80";
  const std::string background_plc = "PLC" + std::to_string(1 + below(32));
  return pick({"OPEN " + motion + " CLEAR", "OPEN " + motion, "OPEN " + background_plc + " CLEAR",
               "OPEN " + background_plc, std::string("OPEN FORWARD"), std::string("OPEN INVERSE CLEAR"),
               "LIST " + motion, "LIST " + motion + part, "LIST " + plc + part, std::string("LIST ROT"),
               std::string("LIST PC,4"), std::string("LIST FORWARD"), std::string("LIST GATHER,0,9"), "ENABLE " + plc,
               "DISABLE " + plc, std::string("CLOSE CLEAR")});
}

std::string RandomLines::run_control() {
  if (one_in(100)) return "SAVE";
  if (one_in(100)) return pick({"$$$", "$$$", "$$$***"});
  if (one_in(3)) return "&" + integer(17);
  if (one_in(6)) return "#" + integer(33);
  if (one_in(5)) return "%" + integer(300);
  if (one_in(8)) return std::string(1, static_cast<char>(1 + below(31)));
  return pick({"R", "R", "R", "S", "Q", "A", "H", "/", "B0", "B0", "B0R", "B1"});
}

std::string RandomLines::grammar() {
  switch (below(10)) {
    case 0:
      return buffer();
    case 1:
    case 2:
      return run_control();
    case 3:
      return assignment();
    case 4:
      return report();
    case 5:
      return one_in(2) ? definition() : memory();
    default:
      return statement();
  }
}

std::string RandomLines::garbage() {
  std::string text;
  for (unsigned i = 0, length = below(one_in(5) ? 400 : 20); i < length; ++i) {
    static const std::string likely = "IPQM0123456789()+-*/=.,>$#&%?XYZABRS\";";
    text += one_in(3) ? static_cast<char>(1 + below(255)) : likely[below(static_cast<unsigned>(likely.size()))];
  }
  return text;
}

std::string RandomLines::program_statement() {
  switch (below(12)) {
    case 0:
      return "GOTO" + integer(20);
    case 1:
      return pick({"GOSUB", "CALL"}) + integer(20) + (one_in(3) ? "." + integer(99) : "");
    case 2:
      return pick({"RET", "N" + integer(20), "O" + integer(20), "STOP", "BSTART", "BSTOP"});
    case 3:
      return pick({"G", "M", "T", "D", "S"}) + integer(100) + (one_in(2) ? "X" + constant() : "");
    case 4:
      return pick({"ENA", "DIS", "PAUSE", "RESUME"}) + "PLC" + integer(33) + (one_in(3) ? ".." + integer(33) : "");
    case 5:
      return pick({"CMD", "SEND", "SENDP", "CMDR", "DISP 3,"}) + pick({"\"P1\"", "\"&1A\"", "\"R\"", "\"\"", "^A"});
    case 6:
      return "READ(" + pick({"A", "A,B,C", "X,Y,Z"}) + ")";
    case 7:
      return "P" + integer(50) + "=P" + integer(50) + "+1";
    default:
      return statement();
  }
}

// Of lines that are quick: each real-time interrupt waits for its end.
void RandomLines::plc0() {
  program_.emplace_back("CLOSE");
  program_.emplace_back("OPEN PLC 0 CLEAR");
  for (unsigned i = 0, lines = 3 + below(20); i < lines; ++i)
    program_.push_back(pick({"P" + integer(50) + "=P" + integer(50) + "+1", "IF(P" + integer(50) + ">9)P1=0",
                             "M" + integer(50) + "=" + constant(), "CMD\"&1R\"", "SEND\"A\"",
                             pick({"ENA", "DIS", "PAUSE", "RESUME"}) + "PLC" + std::to_string(1 + below(31))}));
  program_.emplace_back("CLOSE");
  program_.push_back("I5=" + integer(4) + " ENA PLC 0");
}

// Blocks are closed and loops end, nearly always.
void RandomLines::whole_program() {
  const std::string number = integer(12), plc = std::to_string(1 + below(31));
  const unsigned kind = below(4);
  program_.emplace_back("CLOSE");
  if (!one_in(4))
    program_.emplace_back(
        "\x01"
        "DELETE ALL TEMPS");
  program_.push_back(kind == 0   ? "OPEN PLC " + plc + " CLEAR"
                     : kind == 1 ? pick({"&1", "&2"}) + "OPEN " + pick({"FORWARD", "INVERSE"}) + " CLEAR"
                                 : "OPEN PROG " + number + " CLEAR");
  std::vector<std::string> open;
  for (unsigned i = 0, lines = 3 + below(20); i < lines; ++i) {
    const std::string condition = "(" + expression(1) + pick({"=", "!=", "<", ">", "!<", "!>"}) + expression(1) + ")";
    if (one_in(6)) {
      open.emplace_back("ENDIF");
      program_.push_back("IF" + condition);
    } else if (one_in(8)) {
      const std::string counter = "P" + integer(100);
      program_.push_back(one_in(10) ? "WHILE" + condition : "WHILE(" + counter + "<" + integer(100) + ")");
      program_.push_back(counter + "=" + counter + "+1");
      open.emplace_back("ENDWHILE");
    } else if (!open.empty() && one_in(4)) {
      program_.push_back(open.back());
      open.pop_back();
    } else if (!open.empty() && open.back() == "ENDIF" && one_in(6)) {
      program_.emplace_back("ELSE");
    } else {
      program_.push_back(program_statement());
    }
  }
  for (; !open.empty(); open.pop_back())
    if (!one_in(20)) program_.push_back(open.back());
  program_.emplace_back("CLOSE");
  if (kind == 0) program_.push_back("I5=" + integer(4) + " ENA PLC " + plc);
  if (kind > 1) program_.push_back("&" + integer(4) + "B" + number + pick({"R", "R", "S", ""}));
}

std::string RandomLines::next() {
  if (program_.empty()) {
    alone_ = one_in(400);
    if (alone_)
      plc0();
    else if (one_in(40))
      whole_program();
  }
  if (!program_.empty() && (alone_ || !one_in(30))) {
    std::string line = program_.front();
    program_.pop_front();
    return line.substr(0, kLineLimit);
  }
  if (one_in(15)) {  // the set-up that gives programs something to run in, as a host would make it
    return (one_in(4) ? "" : "\x01") + std::string("CLOSE DELETE ALL TEMPS DEF ROT 2000 B0 OPEN ROT R");
  }
  std::string text;
  if (one_in(10)) {
    text = harmless(garbage());
  } else {
    for (unsigned i = 0, count = 1 + below(one_in(8) ? 8 : one_in(3) ? 2 : 1); i < count; ++i)
      text += (i == 0 ? "" : " ") + grammar();
    if (one_in(20)) {
      text[below(static_cast<unsigned>(text.size()))] = static_cast<char>(' ' + below(95));
      text = harmless(text);
    }
  }
  if (text.size() > kLineLimit && !one_in(10)) text.resize(kLineLimit);
  text.erase(std::remove(text.begin(), text.end(), static_cast<char>(kCarriageReturn)), text.end());
  return text;
}

}  // namespace brick
