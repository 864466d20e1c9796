// The macros of command files: names that #define gives a text, with or without arguments. A name is a whole word of
// letters, digits and _ that begins with no digit; right behind `$` hexadecimal digits may follow it (`$Base0A`).
// Capitals count; texts in quotation marks are left alone. Errors are UsageErrors that say what was found and what was
// expected; whoever knows file and line puts them in front.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace brick {

class Macros {
 public:
  static constexpr std::size_t kMostReplacements = 1000;  // in a line
  static constexpr std::size_t kDeepest = 50;             // macros in macros
  static constexpr std::size_t kLongest = 4096;           // characters on the way to the line that is sent
  static constexpr std::size_t kMostDigits = 12;          // behind a name behind `$`: those of the longest constant

  void define(std::string_view text);    // behind #define: NAME TEXT or NAME(A,B) TEXT; a new text replaces the old one
  void undefine(std::string_view text);  // behind #undef: NAME, known or not
  bool defined(std::string_view text) const;  // behind #ifdef: NAME

  std::string expand(std::string_view line) const;

 private:
  struct Macro {
    std::optional<std::vector<std::string>> parameters;
    std::string text;
  };
  struct Work {
    std::vector<std::string_view> names;  // being expanded, from the outside inwards
    std::size_t replacements = 0;
  };
  using Arguments = std::map<std::string, std::string, std::less<>>;

  using Found = std::map<std::string, Macro, std::less<>>::const_iterator;

  std::string expand(std::string_view text, Work& work, bool behind_dollar = false) const;
  Found find_before_digits(std::string_view word) const;
  std::string replacement(std::string_view name, const Macro& macro, std::string_view text, std::size_t& at, Work& work,
                          bool behind_dollar) const;
  Arguments arguments(std::string_view name, const Macro& macro, std::string_view text, std::size_t& at,
                      Work& work) const;

  std::map<std::string, Macro, std::less<>> macros_;
};

}  // namespace brick
