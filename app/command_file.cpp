#include "app/command_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/macros.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr std::size_t kDeepestInclude = 16, kMostIncludes = 1000, kMostMebibytes = 64, kMostLines = 1'000'000;
constexpr char kEndOfDosText = 0x1A;
constexpr const char* kSpaces = " \t\r\f\v";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpaces) + 1 - begin);
}

bool is_expect(std::string_view text) {
  constexpr std::string_view kWord = "@expect";
  return text.substr(0, kWord.size()) == kWord &&
         (text.size() == kWord.size() || text.find_first_of(kSpaces, kWord.size()) == kWord.size());
}

// Behind PASSWORD= all up to the line's end is the password (firmware:5.10/8).
bool ends_in_password(std::string_view text) {
  constexpr std::string_view kWord = "PASSWORD";
  if (text.empty() || text.back() != '=') return false;
  text = trimmed(text.substr(0, text.size() - 1));
  return text.size() >= kWord.size() &&
         std::equal(kWord.begin(), kWord.end(), text.end() - kWord.size(),
                    [](char expected, unsigned char c) { return expected == std::toupper(c); });
}

std::size_t begin_of_password(std::string_view text) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (!quoted && ends_in_password(text.substr(0, i + 1))) return i + 1;
  }
  return text.size();
}

// An error that begins with its place.
class PlacedError : public UsageError {
 public:
  using UsageError::UsageError;
};

struct Directive {
  std::string word;
  std::string_view rest;
};

// `#` and a word that C's preprocessor knows. All else that begins with # addresses a motor.
std::optional<Directive> directive_of(std::string_view text) {
  constexpr std::array<std::string_view, 13> kWords{"include", "define", "undef", "ifdef",   "ifndef", "else", "endif",
                                                    "if",      "elif",   "error", "warning", "pragma", "line"};
  if (text.empty() || text[0] != '#') return std::nullopt;
  text = trimmed(text.substr(1));
  std::size_t end = 0;
  std::string word;
  for (; end < text.size() && std::isalpha(static_cast<unsigned char>(text[end])) != 0; ++end)
    word.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(text[end]))));
  if (std::find(kWords.begin(), kWords.end(), word) == kWords.end()) return std::nullopt;
  return Directive{word, trimmed(text.substr(end))};
}

class Reader {
 public:
  void read(std::istream& in, const std::string& name) {
    File file;
    file.name = name;
    read(in, file);
  }
  std::vector<SourceLine> take() { return std::move(lines_); }

 private:
  struct Condition {
    unsigned line;
    bool outer, chosen, has_else;  // outer: what is around it is chosen
  };
  struct File {
    std::string name;
    const File* includer = nullptr;
    std::string included;  // for messages, where
    unsigned line = 0;
    unsigned comment = 0;  // line where the comment begins that is open
    std::vector<Condition> conditions;
    bool chosen() const { return conditions.empty() || (conditions.back().outer && conditions.back().chosen); }
  };

  void read(std::istream& in, File& file);
  bool next_line(std::istream& in, std::string& text);
  std::string_view behind_comments(File& file, std::string_view text) const;
  std::string without_comments(File& file, std::string_view text) const;
  void line(File& file, std::string_view text);
  void directive(File& file, const Directive& directive);
  void condition(File& file, const Directive& directive);
  void include(const File& file, std::string_view name);
  void keep(const File& file, std::string_view text);

  Macros macros_;
  std::vector<SourceLine> lines_;
  std::size_t includes_ = 0, bytes_ = 0;
};

// Lines end with LF, CR LF or, as old editors write them, with CR alone.
bool Reader::next_line(std::istream& in, std::string& text) {
  text.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    if (++bytes_ > kMostMebibytes << 20)
      throw UsageError(fmt::format("the text is too long; expected at most {} MiB in all files", kMostMebibytes));
    if (c == '\r' && in.peek() == '\n') in.get();
    if (c == '\r' || c == '\n') return true;
    text.push_back(static_cast<char>(c));
  }
  if (!text.empty() && text.back() == kEndOfDosText) text.pop_back();
  return !text.empty();
}

// Of a line that begins with comments what follows them.
std::string_view Reader::behind_comments(File& file, std::string_view text) const {
  for (;;) {
    if (file.comment == 0) {
      text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
      if (text.substr(0, 2) != "/*") return text;
      file.comment = file.line;
      text.remove_prefix(2);
    }
    const std::size_t end = text.find("*/");
    if (end == std::string_view::npos) return {};
    file.comment = 0;
    text.remove_prefix(end + 2);
  }
}

std::string Reader::without_comments(File& file, std::string_view text) const {
  std::string result;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view two = text.substr(i, 2);
    if (file.comment != 0) {
      if (two != "*/") continue;
      file.comment = 0;
      ++i;
      result.push_back(' ');
    } else if (!quoted && (text[i] == ';' || two == "//")) {
      break;
    } else if (!quoted && two == "/*") {
      file.comment = file.line;
      ++i;
    } else {
      if (text[i] == '"') quoted = !quoted;
      result.push_back(text[i]);
      if (!quoted && ends_in_password(result)) return result.append(text.substr(i + 1));
    }
  }
  return result;
}

void Reader::keep(const File& file, std::string_view text) {
  if (text.empty()) return;
  if (lines_.size() == kMostLines)
    throw UsageError(fmt::format("{} is one line too many; expected at most {}, those of included files each time",
                                 beginning_of(text), kMostLines));
  lines_.push_back({fmt::format("{}:{}", file.name, file.line), file.included, std::string(text)});
}

void Reader::line(File& file, std::string_view text) {
  if (text.find('\0') != std::string_view::npos)
    throw UsageError("a NUL byte in the line; expected text in ASCII or UTF-8");
  text = behind_comments(file, text);
  if (is_expect(text)) {  // as it stands: it is compared with what the controller says
    if (file.chosen()) keep(file, text);
    return;
  }
  std::string bare = without_comments(file, text);
  for (char& c : bare)  // to the controller they are ^I, ^K, ^L: the line before once more, kill, close
    if (c == '\t' || c == '\v' || c == '\f') c = ' ';
  const std::string_view source = trimmed(bare);
  if (const auto found = directive_of(source)) {
    directive(file, *found);
  } else if (file.chosen()) {
    const std::size_t commands = begin_of_password(source);
    const std::string expanded = macros_.expand(source.substr(0, commands)).append(source.substr(commands));
    if (expanded != source && expanded[0] != '@' && expanded.size() > kControllerLine)
      throw UsageError(fmt::format("{} expands to {} characters; expected at most {}, the controller's line",
                                   beginning_of(source), expanded.size(), kControllerLine));
    keep(file, trimmed(expanded));
  }
}

void Reader::directive(File& file, const Directive& directive) {
  const std::string& word = directive.word;
  if (word == "ifdef" || word == "ifndef" || word == "if" || word == "elif" || word == "else" || word == "endif") {
    condition(file, directive);
  } else if (!file.chosen()) {
    return;
  } else if (word == "define") {
    macros_.define(directive.rest);
  } else if (word == "undef") {
    macros_.undefine(directive.rest);
  } else if (word == "include") {
    include(file, directive.rest);
  } else {
    throw UsageError(
        fmt::format("`#{}` is not known; expected one of #include #define #undef #ifdef #ifndef #else #endif", word));
  }
}

// Where nothing is chosen anyway, conditions are counted only: what they say is not looked at.
void Reader::condition(File& file, const Directive& directive) {
  const std::string& word = directive.word;
  const bool outer = word == "elif" && !file.conditions.empty() ? file.conditions.back().outer : file.chosen();
  if (outer && (word == "if" || word == "elif"))
    throw UsageError(fmt::format("`#{}` is not known; expected #ifdef or #ifndef", word));
  if (word == "ifdef" || word == "ifndef" || word == "if") {
    const bool defined = outer && macros_.defined(directive.rest);
    file.conditions.push_back({file.line, outer, defined == (word == "ifdef"), false});
    return;
  }
  if (file.conditions.empty())
    throw UsageError(fmt::format("#{} without a beginning; expected #ifdef or #ifndef before it", word));
  Condition& open = file.conditions.back();
  if (open.outer && !directive.rest.empty())
    throw UsageError(fmt::format("{} behind #{}; expected nothing", beginning_of(directive.rest), word));
  if (word == "endif") {
    file.conditions.pop_back();
  } else if (word == "else" && open.has_else) {
    throw UsageError(fmt::format("a second #else; expected #endif of the condition in line {}", open.line));
  } else if (word == "else") {
    open.has_else = true;
    open.chosen = !open.chosen;
  }
}

// Folders in names are divided by / or, as on the host programs' own system, by a backslash. A name is made shorter
// only where that leads to the same file: behind a symbolic link `..` leads elsewhere.
void Reader::include(const File& file, std::string_view name) {
  constexpr const char* kForm = "#include \"FILE\"";
  std::string text(name);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  if (text.empty() || text.find('"') != std::string::npos)
    throw UsageError(fmt::format("{} is no file; expected {}", beginning_of(name), kForm));
  std::replace(text.begin(), text.end(), '\\', '/');
  std::error_code ignored;
  auto path = std::filesystem::path(file.name).parent_path() / text;
  if (std::filesystem::equivalent(path, path.lexically_normal(), ignored)) path = path.lexically_normal();

  File included;
  included.name = path.string();
  included.includer = &file;
  included.included = fmt::format(" (included at {}:{})", file.name, file.line);
  const std::string shown = beginning_of(included.name, kControllerLine);
  std::size_t depth = 0;
  bool inside_itself = false;
  for (const File* outer = &file; outer != nullptr; outer = outer->includer, ++depth)
    if (std::filesystem::equivalent(path, outer->name, ignored)) inside_itself = true;
  if (depth > kDeepestInclude)
    throw UsageError(
        inside_itself
            ? fmt::format("{} includes itself again and again, {} deep; expected no file that includes itself without "
                          "an end",
                          shown, depth)
            : fmt::format("{} is included {} deep; expected at most {}", shown, depth, kDeepestInclude));
  if (++includes_ > kMostIncludes)
    throw UsageError(fmt::format("{} is one file too many; expected at most {}", shown, kMostIncludes));
  const bool regular = std::filesystem::is_regular_file(path, ignored);  // opening a pipe would wait for its writer
  std::ifstream in;
  if (regular) in.open(path);
  if (!in.is_open()) throw UsageError(fmt::format("{} cannot be read; expected a command file", shown));
  read(in, included);
}

void Reader::read(std::istream& in, File& file) {
  const auto fail = [&](unsigned line, const std::string& what) {
    throw PlacedError(fmt::format("{}:{}: {}{}", file.name, line, what, file.included));
  };
  try {
    for (std::string text; file.line++, next_line(in, text);) {
      if (file.line == 1 && text.rfind(kByteOrderMark, 0) == 0) text.erase(0, kByteOrderMark.size());
      line(file, text);
    }
    if (in.bad()) throw UsageError("the file cannot be read to its end; expected a readable command file");
  } catch (const PlacedError&) { throw; } catch (const UsageError& e) {
    fail(file.line, e.what());
  }
  if (file.comment != 0) fail(file.comment, "a comment without its end; expected */");
  if (!file.conditions.empty())
    fail(file.conditions.back().line, "a condition without its end; expected #endif in the same file");
}

}  // namespace

std::vector<SourceLine> read_command_file(std::istream& in, const std::string& file) {
  Reader reader;
  reader.read(in, file);
  return reader.take();
}

}  // namespace brick
