#include "testbench/host/binary_commands.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>

#include "testbench/host/binary_statements.h"

namespace brick {

namespace {

constexpr std::size_t kLongestLine = 255;
constexpr std::uint32_t kStartOfLine = 0x800000;
constexpr std::string_view kAxes = "ABCUVWXYZ", kVariables = "MPQI";

using Argument = BinaryArgument;
using Statement = BinaryStatement;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

struct Number {
  BinaryResult result = BinaryResult::kOk;
  std::uint32_t fraction = 0;  // 24 bits, signed
  int exponent = 0;
  bool negative = false;
  std::optional<std::uint64_t> integer;  // its magnitude, if it is one
};

// digits / 10^decimals, exactly: digits / 5^decimals must be whole, and what is left must have 23 bits at most.
Number exact(std::uint64_t digits, unsigned decimals, bool negative) {
  constexpr int kBits = 23, kExponents = 32;  // the least of 18 digits is 2^-25
  Number number;
  number.negative = negative && digits != 0;
  if (decimals == 0) number.integer = digits;
  if (digits == 0) return number;
  for (unsigned i = 0; i < decimals; ++i) {
    if (digits % 5 != 0) {
      number.result = BinaryResult::kFloat;
      return number;
    }
    digits /= 5;
  }
  int bits = 64;
  while ((digits >> (bits - 1)) == 0) --bits;
  number.exponent = bits - static_cast<int>(decimals);
  for (; bits > kBits && digits % 2 == 0; --bits) digits /= 2;
  if (number.exponent >= kExponents) {
    number.result = BinaryResult::kRange;
  } else if (bits > kBits) {
    number.result = BinaryResult::kFloat;
  } else {
    const auto magnitude = static_cast<std::uint32_t>(digits) << (kBits - bits);
    number.fraction = (negative ? 0u - magnitude : magnitude) & 0xFFFFFF;
  }
  return number;
}

class Converter {
 public:
  explicit Converter(std::string_view text) {
    for (const char c : text) text_ += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    text_ = text_.substr(0, text_.find(';'));
  }

  BinaryLine convert() {
    BinaryLine line;
    while (line.result == BinaryResult::kOk && peek() != '\0') line.result = statement();
    if (line.result == BinaryResult::kOk) line.commands = std::move(commands_);
    if (!line.commands.empty()) line.commands[0].first |= kStartOfLine;
    return line;
  }

 private:
  char at(std::size_t place) const { return place < text_.size() ? text_[place] : '\0'; }

  char peek() {
    while (at(at_) == ' ' || at(at_) == '\t') ++at_;
    return at(at_);
  }

  bool accept(std::string_view text) {
    (void)peek();
    if (text_.compare(at_, text.size(), text) != 0) return false;
    at_ += text.size();
    return true;
  }

  void add(unsigned code1, unsigned code2, unsigned n, const Number& value = {}) {
    const auto exponent = static_cast<std::uint32_t>(value.exponent) & 0x3F;
    commands_.push_back({code1 << 19 | code2 << 16 | n << 6 | exponent, value.fraction});
  }

  // Digits with at most one point; two points are a range. `at_` stands behind them.
  Number unsigned_number(bool negative) {
    constexpr std::size_t kDigits = 18, kWhole = 10;  // 2^31 has ten
    std::string digits;
    unsigned decimals = 0;
    bool any = false;
    for (; is_digit(at(at_)); ++at_, any = true)
      if (!digits.empty() || at(at_) != '0') digits += at(at_);
    if (at(at_) == '.' && at(at_ + 1) != '.') {
      for (++at_; is_digit(at(at_)); ++at_, any = true) {
        digits += at(at_);
        ++decimals;
      }
    }
    Number number;
    if (!any) {
      number.result = BinaryResult::kConversion;
      return number;
    }
    for (; decimals != 0 && digits.back() == '0'; --decimals) digits.pop_back();
    digits.erase(0, digits.find_first_not_of('0'));
    if (digits.size() > kDigits) {
      number.result = digits.size() > decimals + kWhole ? BinaryResult::kRange : BinaryResult::kFloat;
      return number;
    }
    return exact(digits.empty() ? 0 : std::stoull(digits), decimals, negative);
  }

  // A constant, where a value has to be.
  Number value() {
    const bool negative = accept("-");
    if (!negative) (void)accept("+");
    const char next = peek();
    Number number;
    if (next == '(' || next == '$')
      number.result = BinaryResult::kIllegal;
    else
      number = unsigned_number(negative);
    return number;
  }

  BinaryResult add_value(unsigned code1, unsigned code2, unsigned n, Argument argument = Argument::kValue) {
    const Number number = value();
    if (number.result != BinaryResult::kOk) return number.result;
    if (!is_in_range(number, argument)) return BinaryResult::kRange;
    add(code1, code2, n, number);
    return BinaryResult::kOk;
  }

  static bool is_in_range(const Number& number, Argument argument) {
    constexpr std::uint64_t kLabels = 262143;
    constexpr int kTimeBits = 23;
    switch (argument) {
      case Argument::kNotNegative:
        return !number.negative;
      case Argument::kTime:
        return !number.negative && number.exponent <= kTimeBits;
      case Argument::kLabel:
        return !number.negative && number.integer && *number.integer <= kLabels;
      default:
        return true;
    }
  }

  // X1000^0.5, X1000:500.
  BinaryResult axis(unsigned n) {
    ++at_;
    BinaryResult result = add_value(1, 0, n);
    if (result == BinaryResult::kOk && accept("^"))
      result = add_value(1, 2, n);
    else if (result == BinaryResult::kOk && accept(":"))
      result = add_value(1, 3, n);
    return result;
  }

  // P5=2, M5&=1: false where there is something else.
  bool assignment(BinaryResult& result) {
    const std::size_t begin = at_;
    const auto letter = kVariables.find(peek());
    if (letter == std::string_view::npos) return false;
    ++at_;
    const bool indexed = peek() == '(', hexadecimal = peek() == '$';
    Number number;
    if (indexed)
      skip_brackets();
    else if (hexadecimal)
      at_ = std::min(text_.find_first_not_of("0123456789ABCDEF", at_ + 1), text_.size());
    else
      number = unsigned_number(false);
    if (number.result == BinaryResult::kConversion || !equals(letter == 0)) {
      at_ = begin;
      return false;
    }
    if (indexed || hexadecimal)
      result = BinaryResult::kIllegal;
    else if (number.result != BinaryResult::kOk || !number.integer || *number.integer >= 8192)
      result = BinaryResult::kRange;
    else
      result = assign(static_cast<unsigned>(4 + letter), static_cast<unsigned>(*number.integer));
    return true;
  }

  // Which: synchronous_ is 0 for `=`, else CODE2.
  bool equals(bool may_be_synchronous) {
    static constexpr std::array kForms = {"==", "&=", "|=", "^="};
    synchronous_ = 0;
    for (unsigned i = 0; may_be_synchronous && i < kForms.size(); ++i)
      if (accept(kForms[i])) synchronous_ = i + 1;
    return synchronous_ != 0 || accept("=");
  }

  // The value must be a constant alone: with an operator behind it, it is an expression.
  BinaryResult assign(unsigned code1, unsigned number) {
    const unsigned code2 = synchronous_;
    if (peek() != '-' && peek() != '+' && peek() != '.' && peek() != '$' && !is_digit(peek()))
      return peek() == '\0' ? BinaryResult::kConversion : BinaryResult::kIllegal;
    const Number constant = value();
    if (constant.result != BinaryResult::kOk) return constant.result;
    if (std::string_view("+-*/%&|^").find(peek()) != std::string_view::npos && peek() != '\0')
      return BinaryResult::kIllegal;
    if (number >= 1024) add(15, 0, number >> 10);
    add(code1, code2, number & 0x3FF, constant);
    return BinaryResult::kOk;
  }

  void skip_brackets() {
    unsigned depth = 0;
    do {
      depth += peek() == '(' ? 1 : 0;
      depth -= peek() == ')' ? 1 : 0;
      if (peek() != '\0') ++at_;
    } while (depth > 0 && peek() != '\0');
  }

  // Where `name` would end; npos: it is not next.
  std::size_t match(std::string_view name) {
    (void)peek();
    std::size_t place = at_;
    if (name.empty()) return std::string::npos;
    for (const char c : name) {
      if (c == ' ')
        while (at(place) == ' ' || at(place) == '\t') ++place;
      else if (at(place++) != c)
        return std::string::npos;
    }
    return place;
  }

  bool argument_starts(const Statement& s, std::size_t place) {
    const std::size_t kept = at_;
    at_ = place;
    bool starts = true;
    char next = peek();
    switch (s.argument) {
      case Argument::kNone:
      case Argument::kAxes:
      case Argument::kFrax:
      case Argument::kInAscii:
        break;
      case Argument::kMotors:
      case Argument::kPlcs:
        starts = is_digit(next);
        break;
      default:
        if (next == '+' || next == '-') {
          ++at_;
          next = peek();
        }
        starts = next == '(' || next == '$' || is_digit(next) || (next == '.' && is_digit(at(at_ + 1)));
    }
    at_ = kept;
    return starts;
  }

  const Statement* find() {
    const Statement* found = nullptr;
    std::size_t end = 0;
    for (const Statement& s : kBinaryStatements) {
      if (s.place == Statement::kBehindAnother && commands_.empty()) continue;
      if (s.place == Statement::kBehindCall && !called_) continue;
      const std::size_t whole = match(s.name);
      const std::size_t place = whole != std::string::npos ? whole : match(s.brief);
      if (place == std::string::npos || place <= end || !argument_starts(s, place)) continue;
      end = place;
      found = &s;
    }
    at_ = end;  // behind one that is unknown nothing is read
    return found;
  }

  BinaryResult axes(const Statement& s) {
    const bool is_frax = s.argument == Argument::kFrax;
    unsigned mask = is_frax ? 0x1C0 : 0x1FF;
    if (is_frax && at(at_) == ' ' && peek() == '(') return BinaryResult::kSyntax;
    if (accept("(")) {
      mask = 0;
      do {
        const auto axis = (std::string(kAxes) + "R").find(peek());
        if (axis == std::string::npos || (is_frax && axis == kAxes.size())) return BinaryResult::kSyntax;
        mask |= 1u << axis;
        ++at_;
      } while (accept(","));
      if (!accept(")")) return BinaryResult::kSyntax;
    }
    add(s.code1, s.code2, mask);
    return BinaryResult::kOk;
  }

  // 1,3..5 as a mask of 32 bits: 30 in the place of exponent and fraction, the others above the statement's five bits.
  BinaryResult list(const Statement& s) {
    const unsigned first = s.argument == Argument::kMotors ? 1 : 0;
    std::uint32_t mask = 0;
    do {
      (void)peek();
      const Number from = unsigned_number(false);
      const bool is_range = accept("..");
      if (is_range) (void)peek();
      const Number to = is_range ? unsigned_number(false) : from;
      if (!from.integer || !to.integer) return BinaryResult::kConversion;
      if (*from.integer < first || *to.integer > first + 31 || *to.integer < *from.integer) return BinaryResult::kRange;
      for (std::uint64_t i = *from.integer; i <= *to.integer; ++i) mask |= 1u << (i - first);
    } while (accept(","));
    const std::uint32_t n = s.n | mask >> 30 << 5;
    commands_.push_back({s.code1 << 19 | s.code2 << 16 | n << 6 | (mask >> 24 & 0x3F), mask & 0xFFFFFF});
    return BinaryResult::kOk;
  }

  BinaryResult statement() {
    const auto axis_letter = kAxes.find(peek());
    if (axis_letter != std::string_view::npos) {
      const std::size_t begin = at_++;
      const char next = peek();
      at_ = begin;
      if (is_digit(next) || (next != '\0' && std::string_view(".$-+(").find(next) != std::string_view::npos))
        return axis(static_cast<unsigned>(axis_letter));
    }
    BinaryResult result = BinaryResult::kOk;
    if (assignment(result)) return result;
    const Statement* s = find();
    if (s == nullptr) return BinaryResult::kSyntax;
    called_ |= s->place == Statement::kCall;
    switch (s->argument) {
      case Argument::kInAscii:
        return BinaryResult::kIllegal;
      case Argument::kNone:
        add(s->code1, s->code2, s->n);
        return BinaryResult::kOk;
      case Argument::kAxes:
      case Argument::kFrax:
        return axes(*s);
      case Argument::kMotors:
      case Argument::kPlcs:
        return list(*s);
      default:
        return add_value(s->code1, s->code2, s->n, s->argument);
    }
  }

  std::string text_;
  std::size_t at_ = 0;
  std::vector<BinaryCommand> commands_;
  bool called_ = false;
  unsigned synchronous_ = 0;
};

}  // namespace

BinaryLine binary_line(std::string_view text) {
  if (text.size() > kLongestLine) return {BinaryResult::kSyntax, {}};
  return Converter(text).convert();
}

}  // namespace brick
