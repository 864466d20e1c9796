#include "testbench/benches/program_text.h"

#include <cctype>

#include <fmt/format.h>

namespace brick {
namespace {

// Short name, long name.
using Name = const char* const[2];
constexpr Name kModes[] = {{"LIN", "LINEAR"},      {"RPD", "RAPID"},  {"CIR1", "CIRCLE1"},      {"CIR2", "CIRCLE2"},
                           {"SPLINE1", "SPLINE1"}, {"CC0", "CC0"},    {"BSTART", "BLOCKSTART"}, {"BSTOP", "BLOCKSTOP"},
                           {"MVTM", "MOVETIME"},   {"NRM", "NORMAL"}, {"PSET", "PSET"},         {"NOFRAX", "NOFRAX"},
                           {"STOP", "STOP"}};
constexpr Name kRates[] = {{"TA", "TA"}, {"TS", "TS"}, {"DWE", "DWELL"}, {"DLY", "DELAY"}, {"PVT", "PVT"}};
constexpr Name kCalls[] = {{"GOTO", "GOTO"}, {"GOS", "GOSUB"}, {"CALL", "CALL"}, {"TSEL", "TSELECT"}, {"CCR", "CCR"}};
constexpr Name kMotors[] = {{"HM", "HOME"}, {"HMZ", "HOMEZ"}};
constexpr Name kPlcs[] = {
    {"ENAPLC", "ENABLE PLC"}, {"DISPLC", "DISABLE PLC"}, {"PAUPLC", "PAUSE PLC"}, {"RESPLC", "RESUME PLC"}};
constexpr Name kTexts[] = {{"CMD", "COMMAND"}, {"CMDS", "COMMANDS"}, {"SEND", "SEND"}, {"SENDP", "SENDP"}};

}  // namespace

// In any case; what stands in quotes stays as it is.
std::string ProgramText::spelled(const std::string& text) {
  std::string made = text;
  bool quoted = false, lower = number(2) == 0;
  for (char& c : made) {
    if (c == '"') quoted = !quoted;
    if (!quoted && lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return made;
}

// 007.50 is listed as 7.5, .25 as 0.25, $00f as $F.
ProgramText::Text ProgramText::constant() {
  const unsigned whole = number(number(2) == 0 ? 20 : 1'000'000);
  if (number(5) == 0) {
    const std::string digits = fmt::format("{:X}", whole);
    return {fmt::format("${}{}", std::string(number(3), '0'), digits), "$" + digits, "$" + digits, true};
  }
  std::string fraction;
  if (number(3) == 0) fraction = fmt::format(".{}{}", number(90), 1 + number(9));
  const std::string text = std::to_string(whole) + fraction;
  std::string sent = whole == 0 && !fraction.empty() && number(2) == 0 ? fraction : std::string(number(3), '0') + text;
  if (!fraction.empty()) sent += std::string(number(3), '0');
  return {sent, text, text};
}

ProgramText::Text ProgramText::variable() {
  const std::string text = fmt::format("{}{}", "PQMI"[number(4)], number(8192));
  return {text, text, text};
}

// Brackets only where they are needed: those are listed.
ProgramText::Text ProgramText::expression(unsigned depth) {
  static const char* const functions[] = {"SIN", "COS", "ATAN2", "SQRT", "INT", "ABS", "LN"};
  const auto atom = [this] { return number(2) == 0 ? constant() : variable(); };
  const auto joined = [this](const Text& a, const std::string& op, const Text& b) {
    const std::string blank(number(2), ' ');
    return Text{a.sent + blank + op + blank + b.sent, a.brief + op + b.brief, a.full + op + b.full, b.blank};
  };
  const auto framed = [](const std::string& before, const Text& t) {
    return Text{before + "( " + t.sent + " )", before + "(" + t.brief + ")", before + "(" + t.full + ")"};
  };
  switch (depth == 0 ? 0 : number(5)) {
    case 0:
      return atom();
    case 1:
      return joined(atom(), std::string(1, "+-*/%&|^"[number(8)]), atom());
    case 2:
      return joined(framed("", joined(atom(), number(2) == 0 ? "+" : "-", atom())), "*", atom());
    case 3:
      return framed(functions[number(7)], expression(depth - 1));
    default:
      return framed(std::string(1, "PQMI"[number(4)]), expression(depth - 1));
  }
}

ProgramText::Text ProgramText::condition() {
  static const char* const comparators[] = {"=", "!=", ">", "!>", "<", "!<", "~", "!~"};
  Text text{"(", "(", "("};
  for (unsigned i = 0, count = 1 + number(2); i < count; ++i) {
    const char* const with = number(2) == 0 ? " AND " : " OR ";
    const Text left = expression(1), right = expression(1);
    const char* const op = comparators[number(8)];
    for (auto [whole, l, r] :
         {std::tuple{&text.sent, &left.sent, &right.sent}, std::tuple{&text.brief, &left.brief, &right.brief},
          std::tuple{&text.full, &left.full, &right.full}})
      *whole += (i == 0 ? "" : with) + *l + op + *r;
  }
  return {text.sent + ")", text.brief + ")", text.full + ")"};
}

ProgramText::Text ProgramText::keyword(const std::string& brief, const std::string& full) {
  produced_.insert(full);
  return {number(2) == 0 ? brief : full, brief, full, true};
}

// With a constant, or an expression in brackets.
ProgramText::Text ProgramText::valued(const std::string& brief, const std::string& full, bool with_sign) {
  const Text name = keyword(brief, full);
  const std::string blank(number(2), ' ');
  if (number(3) == 0) {
    const Text written = expression(2);  // a constant alone stands without brackets
    const Text inner =
        std::isdigit(static_cast<unsigned char>(written.brief[0])) != 0 || written.blank ? variable() : written;
    return {name.sent + blank + "(" + inner.sent + ")", brief + "(" + inner.brief + ")", full + "(" + inner.full + ")"};
  }
  const Text value = constant();
  const bool negative = with_sign && number(3) == 0 && value.brief != "0" && value.brief != "$0";
  const std::string sign = negative ? "-" : "";
  return {name.sent + blank + sign + value.sent, brief + sign + value.brief, full + sign + value.full, value.blank};
}

ProgramText::Text ProgramText::assignment() {
  const char letter = "PQMI"[number(4)];
  produced_.insert(std::string(1, letter) + "=");
  Text left = variable();
  left.sent[0] = left.brief[0] = left.full[0] = letter;
  const Text right = expression(2);
  const std::string blank(number(2), ' ');
  return {left.sent + blank + "=" + blank + right.sent, left.brief + "=" + right.brief, left.full + "=" + right.full,
          right.blank};
}

ProgramText::Text ProgramText::motion() {
  const auto pick = [this](const auto& names) -> const Name& {
    return names[number(static_cast<unsigned>(std::size(names)))];
  };
  switch (number(5)) {
    case 0: {
      const Name& name = pick(kModes);
      return keyword(name[0], name[1]);
    }
    case 1: {
      const Name& name = pick(kRates);
      return valued(name[0], name[1], false);
    }
    case 2: {
      const Name& name = pick(kCalls);
      return valued(name[0], name[1], false);
    }
    case 3: {
      const Name& name = pick(kMotors);
      const Text head = keyword(name[0], name[1]);
      const std::string list = number(2) == 0 ? std::to_string(1 + number(32)) : "3,9";
      return {head.sent + " " + list, head.brief + list, head.full + list};
    }
    default: {
      const std::string axis(1, "ABCUVWXYZ"[number(9)]);
      return valued(axis, axis, true);
    }
  }
}

ProgramText::Text ProgramText::simple() {
  if (kind_ == kKinematic || number(3) == 0) return assignment();
  if (kind_ == kMotion && number(3) != 0) return motion();
  switch (number(3)) {
    case 0: {
      const Name& name = kPlcs[number(4)];
      const Text head = keyword(name[0], name[1]);
      const std::string list = number(2) == 0 ? std::to_string(number(32)) : "4,7,30";
      return {head.sent + " " + list, head.brief + list, head.full + list};
    }
    case 1: {
      const Name& name = kTexts[number(4)];
      const Text head = keyword(name[0], name[1]);
      const std::string text = fmt::format("\"It; is (x) {}\"", number(1000));
      return {head.sent + " " + text, head.brief + text, head.full + text};
    }
    default:
      produced_.insert("DISPLAY");
      return {"DISPLAY 5, 8.2, P1", "DISP5,8.2,P1", "DISPLAY5,8.2,P1"};
  }
}

void ProgramText::add(const Text& text) {
  sent_.push_back(spelled(text.sent));
  brief_.push_back(text.brief);
  full_.push_back(text.full);
}

// Several statements: one line of a motion program, in other programs a line each.
void ProgramText::line(unsigned statements) {
  Text whole = simple();
  if (kind_ != kMotion) {
    brief_.push_back(whole.brief);
    full_.push_back(whole.full);
  }
  for (unsigned i = 1; i < statements; ++i) {
    const Text next = simple();
    whole.sent += " " + next.sent;
    if (kind_ == kMotion) {
      whole.brief += (whole.blank ? " " : "") + next.brief;
      whole.full += (whole.blank ? " " : "") + next.full;
      whole.blank = next.blank;
    } else {
      brief_.push_back(next.brief);
      full_.push_back(next.full);
    }
  }
  sent_.push_back(spelled(whole.sent) + (number(8) == 0 ? " ; P1=1" : ""));
  if (kind_ != kMotion) return;
  brief_.push_back(whole.brief);
  full_.push_back(whole.full);
}

void ProgramText::block(unsigned depth) {
  const bool is_if = number(2) == 0;
  const std::string name = is_if ? "IF" : "WHILE";
  produced_.insert(name);
  const Text inner = condition();
  add({name + " " + inner.sent, name + inner.brief, name + inner.full});
  line(1 + number(2));
  if (depth != 0 && number(2) == 0) block(depth - 1);
  if (is_if && number(2) == 0) {
    add(keyword("ELSE", "ELSE"));
    line(1);
  }
  if (is_if)
    add(keyword("ENDI", "ENDIF"));
  else
    add(keyword("ENDW", "ENDWHILE"));
}

void ProgramText::begin(Kind kind, unsigned statements) {
  kind_ = kind;
  sent_.clear();
  brief_.clear();
  full_.clear();
  while (brief_.size() < statements) {
    if (number(4) == 0)
      block(2);
    else
      line(1 + number(3));
  }
  add(keyword("RET", "RETURN"));
}

void ProgramText::spoil() {
  brief_.front() += "1";
  full_.front() += "1";
}

}  // namespace brick
