#include "testbench/unit/firmware_program/program_generator.h"

namespace {

bool is_structure(const std::string& name) {
  static const std::set<std::string> names = {"IF", "WHILE", "AND", "OR", "ELSE", "END_IF", "END_WHILE", "WAIT"};
  return names.count(name) != 0;
}

}  // namespace

// A blank behind a hexadecimal constant: a letter would belong to it.
std::string ProgramGenerator::constant(bool with_sign) {
  std::string text = with_sign && number(4) == 0 ? "-" : "";
  const auto digits = [&](unsigned most) {
    std::string s;
    for (unsigned i = 0, count = 1 + number(most); i < count; ++i) s += static_cast<char>('0' + number(10));
    return s;
  };
  switch (number(6)) {
    case 0: {
      text += "$";
      for (unsigned i = 0, count = 1 + number(8); i < count; ++i) text += "0123456789ABCDEFabcdef"[number(22)];
      return text + " ";
    }
    case 1:
      return text + "." + digits(17);
    case 2:
      return text + digits(9) + "." + digits(9);
    case 3:
      return text + digits(3) + "." + digits(2);
    case 4:
      return text + digits(10);
    default:
      return text + std::to_string(number(30));
  }
}

std::string ProgramGenerator::expression(unsigned depth) {
  static const char* const functions[] = {"SIN",   "COS", "TAN", "ASIN", "ACOS", "ATAN",
                                          "ATAN2", "LN",  "EXP", "SQRT", "abs",  "INT"};
  switch (depth == 0 ? number(2) : number(8)) {
    case 0:
      return constant(true);
    case 1:
      return std::string(1, "MPQImpqi"[number(8)]) + std::to_string(number(8192));
    case 2:
      return std::string(functions[number(12)]) + "(" + expression(depth - 1) + ")";
    case 3:
      return std::string(1, "MPQI"[number(4)]) + "(" + expression(depth - 1) + ")";
    case 4:
      return "-" + expression(depth - 1);
    case 5:
      return "( " + expression(depth - 1) + ")";
    default:
      return expression(depth - 1) + "+-|^*/%&"[number(8)] + expression(depth - 1);
  }
}

std::string ProgramGenerator::value(bool with_sign) {
  return number(3) == 0 ? "(" + expression(2) + ")" : constant(with_sign);
}

std::string ProgramGenerator::condition() {
  static const char* const comparators[] = {"=", "!=", ">", "!>", "<", "!<", "~", "! ~"};
  std::string text = "(";
  for (unsigned i = 0, count = 1 + number(3); i < count; ++i) {
    if (i != 0) text += number(2) == 0 ? " AND " : " or ";
    text += expression(1) + comparators[number(8)] + expression(1);
  }
  return text + ")";
}

std::string ProgramGenerator::in_brackets(const std::vector<std::string>& letters) {
  std::string text;
  for (unsigned i = 0, count = 1 + number(4); i < count; ++i)
    text += (i == 0 ? "(" : ",") + letters[number(static_cast<unsigned>(letters.size()))];
  return text + ")";
}

std::string ProgramGenerator::numbers(unsigned first, unsigned last) {
  std::string text;
  for (unsigned i = 0, count = 1 + number(3); i < count; ++i) {
    const unsigned from = first + number(last - first + 1);
    if (i != 0) text += ",";
    text += std::to_string(from);
    if (number(3) == 0) text += ".." + std::to_string(from + number(last - from + 1));
  }
  return text;
}

std::string ProgramGenerator::argument(const statement_row& row) {
  static const std::vector<std::string> axes = {"A", "B", "C", "U", "v", "w", "X", "Y", "Z"};
  static const std::string characters = "abcXYZ 0159;#&(),.=+-*/!?'^~%$@<>";
  std::vector<std::string> letters = axes;
  std::string text;
  switch (row.argument) {
    case ARGUMENT_NONE:
      return " ";
    case ARGUMENT_AXIS:
      text = value(true);
      if (number(4) == 0) text += std::string(1, "^:"[number(2)]) + value(true);
      return text;
    case ARGUMENT_RATE:
      return value(false);
    case ARGUMENT_TIME:
      return std::to_string(1 + number(8388607)) + (number(2) == 0 ? ".5" : "");
    case ARGUMENT_LABEL:
      return std::to_string(number(262144));
    case ARGUMENT_AXES:
      letters.emplace_back("R");
      return number(3) == 0 ? " " : in_brackets(letters);
    case ARGUMENT_FRAX:
      return number(3) == 0 ? "," : in_brackets(letters);
    case ARGUMENT_LETTERS:
      return in_brackets({"A", "E", "F", "G", "M", "P", "S", "X", "Z"});
    case ARGUMENT_MOTORS:
      return numbers(1, 32);
    case ARGUMENT_PLCS:
      return numbers(0, 31);
    case ARGUMENT_ADDRESS:
      if (number(2) == 0) text = "#" + address(32);
      if (text.empty() || number(2) == 0) text += "&" + address(16);
      return text;
    case ARGUMENT_TEXT:
      if (number(4) == 0) return std::string("^") + "@ABKZ[_"[number(7)];
      break;
    case ARGUMENT_LOCK:
      if (number(4) == 0) return value(true);
      return std::to_string(number(8)) + "," + (number(2) == 0 ? " P" : "P") + std::to_string(number(8192));
    case ARGUMENT_DISPLAY:
      if (number(3) == 0)
        return std::to_string(number(80)) + "," + std::to_string(1 + number(16)) + "." + std::to_string(number(10)) +
               "," + expression(1);
      if (number(2) == 0) text = std::to_string(number(80));
      break;
    default:
      return value(true);
  }
  text += "\"";
  for (unsigned i = 0, count = number(20); i < count; ++i)
    text += characters[number(static_cast<unsigned>(characters.size()))];
  return text + "\"";
}

// A number, or a P-variable.
std::string ProgramGenerator::address(unsigned count) {
  return number(2) == 0 ? "P" + std::to_string(number(8192)) : std::to_string(1 + number(count));
}

std::string ProgramGenerator::name(const statement_row& row) {
  produced_.insert(row.name);
  std::string text;
  for (const char* c = row.brief != nullptr && number(2) == 0 ? row.brief : row.name; *c != '\0'; ++c) {
    const bool blank = *c == ' ' || *c == '_';
    if (blank && number(2) == 0) continue;
    text += blank ? ' ' : number(8) == 0 ? static_cast<char>(std::tolower(*c)) : *c;
  }
  return text;
}

std::string ProgramGenerator::assignment() {
  static const char* const synchronous[] = {"==", "&=", "|=", "^="};
  const char letter = "MPQI"[number(4)];
  std::string text(1, letter);
  text += number(5) == 0 ? "(" + expression(1) + ")" : std::to_string(number(number(2) == 0 ? 1024 : 8192));
  text += letter == 'M' && is_motion() && number(3) == 0 ? synchronous[number(4)] : "=";
  return text + (number(2) == 0 ? constant(true) : expression(3));
}

// What READ of the called program looks for.
std::string ProgramGenerator::called_letter() {
  std::vector<const statement_row*> rows;
  for (std::uint32_t i = 0; i < statement_row_count; ++i)
    if ((statement_rows[i].where & WHERE_CALLED) != 0) rows.push_back(&statement_rows[i]);
  const statement_row& row = *rows[number(static_cast<unsigned>(rows.size()))];
  return name(row) + argument(row);
}

std::string ProgramGenerator::simple(bool first) {
  if (number(4) == 0) return assignment() + " ";
  for (;;) {
    const statement_row& row = statement_rows[number(statement_row_count)];
    if ((row.where & where_ & 0xF) == 0 || is_structure(row.name)) continue;
    if ((row.where & WHERE_BEGUN) != 0 && first) continue;
    if ((row.where & WHERE_CALLED) != 0 && !called_) continue;
    if ((row.where & CALLS) != 0) called_ = true;
    std::string text = name(row) + argument(row);
    if ((row.where & CALLS) != 0 && number(2) == 0) text += called_letter();
    if (text.back() == ',') text.back() = ' ';  // FRAX alone
    return number(2) == 0 ? text + " "
                          : text + (row.argument == ARGUMENT_NONE || row.argument == ARGUMENT_TEXT ? " " : "");
  }
}

std::string ProgramGenerator::simple_line() {
  std::string line;
  called_ = false;
  for (unsigned i = 0, count = 1 + number(3); i < count && line.size() < 50; ++i) line += simple(i == 0);
  return number(10) == 0 ? line + " ; P1=1 \"comment" : line;
}

void ProgramGenerator::block(unsigned depth, std::vector<std::string>& lines) {
  const bool is_if = number(2) == 0;
  produced_.insert(is_if ? "IF" : "WHILE");
  lines.push_back((is_if ? "IF " : "while") + condition());
  if (number(3) == 0) {
    const bool with_and = number(2) == 0;
    produced_.insert(with_and ? "AND" : "OR");
    const std::string more = (with_and ? "AND" : "Or") + condition();
    if (is_motion())
      lines.back() += more;
    else
      lines.push_back(more);
  }
  for (unsigned i = 0, count = number(3); i < count; ++i) {
    if (depth != 0 && number(3) == 0)
      block(depth - 1, lines);
    else
      lines.push_back(simple_line());
  }
  if (is_if && number(2) == 0) {
    produced_.insert("ELSE");
    lines.emplace_back("ELSE");
    lines.push_back(simple_line());
    if (is_motion() && number(2) == 0) {  // its one statement ends the block
      const std::string body = lines.back();
      lines.pop_back();
      lines.back() += " " + body;
      return;
    }
  }
  const char* const ends[2][4] = {{"ENDIF", "ENDI", "END IF", "endif"}, {"ENDWHILE", "ENDW", "end while", "ENDWHILE"}};
  produced_.insert(is_if ? "END_IF" : "END_WHILE");
  lines.emplace_back(ends[is_if ? 0 : 1][number(4)]);
}

std::vector<std::string> ProgramGenerator::program(unsigned statements) {
  std::vector<std::string> lines;
  while (lines.size() < statements) {
    if ((where_ & WHERE_LOGIC) == 0 || number(4) != 0) {
      lines.push_back(simple_line());
    } else if (is_motion() && number(4) == 0) {
      const bool is_if = number(2) == 0;
      const bool waits = !is_if && number(2) == 0;
      called_ = false;
      lines.push_back((is_if ? "IF" : "WHILE") + condition() + (waits ? "WAIT" : simple(false)));
      if (waits) produced_.insert("WAIT");
      if (is_if && number(2) == 0) lines.push_back("ELSE " + simple_line());
    } else {
      block(2, lines);
    }
  }
  return lines;
}

std::string ProgramGenerator::statement() { return simple_line(); }

// Listed with more characters than it has: no 0 before the point, a short name, no blank.
std::string ProgramGenerator::growing() {
  if (number(2) == 0) return std::string(1, "ABCUVWXYZ"[number(9)]) + "." + std::to_string(1 + number(99));
  for (;;) {
    const statement_row& row = statement_rows[number(statement_row_count)];
    if ((row.where & where_ & 0xF) == 0 || row.argument != ARGUMENT_NONE) continue;
    return row.brief != nullptr ? row.brief : row.name;
  }
}

std::string ProgramGenerator::long_line() {
  const unsigned grows = number(5);  // of four statements
  std::string line;
  called_ = false;
  for (;;) {
    const std::string next = number(4) < grows ? growing() : simple(line.empty()) + " ";
    if (line.size() + next.size() > 255) return line;
    line += next;
  }
}
