#include "app/command_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "app/macros.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr std::size_t kDeepestInclude = 16, kMostIncludes = 1000;
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

// An error that begins with its place. `included`: it says where that file was included.
class PlacedError : public UsageError {
 public:
  PlacedError(const std::string& text, bool is_included) : UsageError(text), included(is_included) {}
  bool included;
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
  void read(std::istream& in, const std::string& file);
  std::vector<SourceLine> take() { return std::move(lines_); }

 private:
  struct Condition {
    unsigned line;
    bool outer, chosen, has_else;  // outer: what is around it is chosen
  };
  struct File {
    std::string name;
    unsigned line = 0;
    unsigned comment = 0;  // line where the comment begins that is open
    std::vector<Condition> conditions;
    bool chosen() const { return conditions.empty() || (conditions.back().outer && conditions.back().chosen); }
  };

  std::string without_comments(File& file, std::string_view text) const;
  void line(File& file, std::string_view text);
  void directive(File& file, const Directive& directive);
  void condition(File& file, const Directive& directive);
  void include(const File& file, std::string_view name);
  void keep(const File& file, std::string_view text);

  Macros macros_;
  std::vector<SourceLine> lines_;
  std::size_t depth_ = 0, includes_ = 0;
};

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
    }
  }
  return result;
}

void Reader::keep(const File& file, std::string_view text) {
  if (!text.empty()) lines_.push_back({fmt::format("{}:{}", file.name, file.line), std::string(text)});
}

void Reader::line(File& file, std::string_view text) {
  if (text.find('\0') != std::string_view::npos)
    throw UsageError("a NUL byte in the line; expected text in ASCII or UTF-8");
  if (file.comment == 0 && is_expect(trimmed(text))) {  // as it stands: it is compared with what the controller says
    if (file.chosen()) keep(file, trimmed(text));
    return;
  }
  std::string bare = without_comments(file, text);
  std::replace(bare.begin(), bare.end(), '\t', ' ');  // to the controller it is ^I, the line before once more
  const std::string_view source = trimmed(bare);
  if (const auto found = directive_of(source)) {
    directive(file, *found);
  } else if (file.chosen()) {
    const std::string expanded = macros_.expand(source);
    if (expanded != source && expanded.size() > kControllerLine)
      throw UsageError(fmt::format("`{}` expands to {} characters; expected at most {}, the controller's line", source,
                                   expanded.size(), kControllerLine));
    keep(file, trimmed(expanded));
  }
}

void Reader::directive(File& file, const Directive& directive) {
  const std::string& word = directive.word;
  if (word == "ifdef" || word == "ifndef" || word == "else" || word == "endif") {
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

void Reader::condition(File& file, const Directive& directive) {
  const bool outer = file.chosen();
  if (directive.word == "ifdef" || directive.word == "ifndef") {
    const bool defined = macros_.defined(directive.rest);
    file.conditions.push_back({file.line, outer, defined == (directive.word == "ifdef"), false});
    return;
  }
  if (!directive.rest.empty())
    throw UsageError(fmt::format("`{}` behind #{}; expected nothing", directive.rest, directive.word));
  if (file.conditions.empty())
    throw UsageError(fmt::format("#{} without a beginning; expected #ifdef or #ifndef before it", directive.word));
  Condition& open = file.conditions.back();
  if (directive.word == "endif") {
    file.conditions.pop_back();
  } else if (open.has_else) {
    throw UsageError(fmt::format("a second #else; expected #endif of the condition in line {}", open.line));
  } else {
    open.has_else = true;
    open.chosen = !open.chosen;
  }
}

// Folders in names are divided by / or, as on the host programs' own system, by a backslash.
void Reader::include(const File& file, std::string_view name) {
  constexpr const char* kForm = "#include \"FILE\"";
  std::string text(name);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  if (text.empty() || text.find('"') != std::string::npos)
    throw UsageError(fmt::format("`{}` is no file; expected {}", name, kForm));
  std::replace(text.begin(), text.end(), '\\', '/');
  const auto path = (std::filesystem::path(file.name).parent_path() / text).lexically_normal();
  if (depth_ == kDeepestInclude)
    throw UsageError(fmt::format("`{}` is included by a file {} deep; expected no file that includes itself",
                                 path.string(), kDeepestInclude));
  if (++includes_ > kMostIncludes)
    throw UsageError(fmt::format("`{}` is one file too many; expected at most {}", path.string(), kMostIncludes));
  std::error_code ignored;
  std::ifstream in(path);
  if (!std::filesystem::is_regular_file(path, ignored) || !in)
    throw UsageError(fmt::format("`{}` cannot be read; expected a command file", path.string()));
  ++depth_;
  try {
    read(in, path.string());
  } catch (const PlacedError& e) {
    if (e.included) throw;
    throw PlacedError(fmt::format("{} (included at {}:{})", e.what(), file.name, file.line), true);
  }
  --depth_;
}

void Reader::read(std::istream& in, const std::string& name) {
  File file;
  file.name = name;
  const auto fail = [&](unsigned number, const std::string& what) {
    throw PlacedError(fmt::format("{}:{}: {}", name, number, what), false);
  };
  for (std::string text; std::getline(in, text);) {
    if (++file.line == 1 && text.rfind(kByteOrderMark, 0) == 0) text.erase(0, kByteOrderMark.size());
    try {
      line(file, text);
    } catch (const PlacedError&) { throw; } catch (const UsageError& e) {
      fail(file.line, e.what());
    }
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
