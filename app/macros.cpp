#include "app/macros.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/byte_text.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr const char* kSpaces = " \t";

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_hex_digit(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }
bool starts_name(char c) { return in_word(c) && std::isdigit(static_cast<unsigned char>(c)) == 0; }

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpaces) + 1 - begin);
}

// The word, the text in quotation marks or the single character at `at`.
std::string_view piece(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  if (text[at] == '"')
    end = std::min(text.find('"', end), text.size() - 1) + 1;
  else if (in_word(text[at]))
    while (end < text.size() && in_word(text[end])) ++end;
  return text.substr(at, end - at);
}

std::string_view name_at_start(std::string_view text, const char* form) {
  if (text.empty() || !starts_name(text[0]))
    throw UsageError(fmt::format("{} is no name of a macro; expected {}", beginning_of(text), form));
  return piece(text, 0);
}

std::string_view only_name(std::string_view text, const char* form) {
  text = trimmed(text);
  const std::string_view name = name_at_start(text, form);
  if (name.size() != text.size())
    throw UsageError(fmt::format("{} is not known; expected {}", beginning_of(text), form));
  return name;
}

// "A,B" of (A,B); `at` is behind the opening bracket and is moved behind the closing one.
std::optional<std::vector<std::string>> list_in_brackets(std::string_view text, std::size_t& at) {
  std::vector<std::string> list{""};
  for (int depth = 1; at < text.size();) {
    const std::string_view word = piece(text, at);
    at += word.size();
    if (word == "(") ++depth;
    if (word == ")" && --depth == 0) {
      for (std::string& item : list) item = trimmed(item);
      if (list.size() == 1 && list[0].empty()) list.clear();
      return list;
    }
    if (word == "," && depth == 1)
      list.emplace_back();
    else
      list.back() += word;
  }
  return std::nullopt;
}

}  // namespace

void Macros::define(std::string_view text) {
  constexpr const char* kForm = "#define NAME TEXT or #define NAME(A,B) TEXT";
  text = trimmed(text);
  const std::string name(name_at_start(text, kForm));
  std::size_t at = name.size();
  Macro macro;
  if (at < text.size() && text[at] == '(') {
    macro.parameters = list_in_brackets(text, ++at);
    if (!macro.parameters)
      throw UsageError(fmt::format("{} has no closing bracket; expected {}", beginning_of(text), kForm));
    for (auto p = macro.parameters->begin(); p != macro.parameters->end(); ++p) {
      only_name(*p, "the name of an argument, as in #define NAME(A,B) TEXT");
      if (std::find(macro.parameters->begin(), p, *p) != p)
        throw UsageError(fmt::format("two arguments of {} are called {}; expected different names", beginning_of(name),
                                     beginning_of(*p)));
    }
  } else if (at < text.size() && text.find_first_of(kSpaces, at) != at) {
    throw UsageError(fmt::format("{} is no name of a macro; expected {}", beginning_of(text), kForm));
  }
  macro.text = trimmed(text.substr(at));
  macros_.insert_or_assign(name, std::move(macro));
}

void Macros::undefine(std::string_view text) {
  const auto found = macros_.find(only_name(text, "#undef NAME"));
  if (found != macros_.end()) macros_.erase(found);
}

bool Macros::defined(std::string_view text) const {
  return macros_.find(only_name(text, "a name, as in #ifdef NAME")) != macros_.end();
}

std::string Macros::expand(std::string_view line) const {
  Work work;
  return expand(line, work);
}

// `$Base0A`: the longest name before hexadecimal digits, also where both are hexadecimal.
Macros::Found Macros::find_before_digits(std::string_view word) const {
  for (std::size_t digits = 1; digits <= kMostDigits && digits < word.size(); ++digits) {
    if (!is_hex_digit(word[word.size() - digits])) break;
    const Found found = macros_.find(word.substr(0, word.size() - digits));
    if (found != macros_.end() && !found->second.parameters) return found;
  }
  return macros_.end();
}

// `behind_dollar`: what the text is put behind ends with `$`.
std::string Macros::expand(std::string_view text, Work& work, bool behind_dollar) const {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view word = piece(text, at);
    at += word.size();
    const bool dollar = result.empty() ? behind_dollar : result.back() == '$';
    Found macro = starts_name(word[0]) ? macros_.find(word) : macros_.end();
    std::string_view digits;
    if (macro == macros_.end() && dollar && starts_name(word[0])) {
      macro = find_before_digits(word);
      if (macro != macros_.end()) digits = word.substr(macro->first.size());
    }
    if (macro == macros_.end())
      result += word;
    else
      result += replacement(macro->first, macro->second, text, at, work, dollar).append(digits);
    if (!work.names.empty() && result.size() > kLongest)
      throw UsageError(
          fmt::format("macro {} expands to more than {} characters; expected less: the controller's "
                      "line has 255",
                      beginning_of(work.names.front()), kLongest));
  }
  return result;
}

// Of the macro whose name ends at `at`; its arguments, if it has any, are taken from there.
std::string Macros::replacement(std::string_view name, const Macro& macro, std::string_view text, std::size_t& at,
                                Work& work, bool behind_dollar) const {
  if (std::find(work.names.begin(), work.names.end(), name) != work.names.end())
    throw UsageError(fmt::format("macro {} expands to itself ({}); expected a text without it", beginning_of(name),
                                 cut_text(fmt::format("{}, {}", fmt::join(work.names, ", "), name))));
  if (work.names.size() == kDeepest || ++work.replacements > kMostReplacements)
    throw UsageError(fmt::format("macro {} has too many macros in it; expected at most {}, {} deep",
                                 beginning_of(work.names.empty() ? name : work.names.front()), kMostReplacements,
                                 kDeepest));
  std::string body = macro.text;
  if (macro.parameters) {
    const Arguments given = arguments(name, macro, text, at, work);
    body.clear();
    for (std::size_t i = 0; i < macro.text.size();) {
      const std::string_view word = piece(macro.text, i);
      i += word.size();
      const auto argument = given.find(word);
      body += argument == given.end() ? word : std::string_view(argument->second);
      if (body.size() > kLongest)
        throw UsageError(
            fmt::format("macro {} expands to more than {} characters; expected less", beginning_of(name), kLongest));
    }
  }
  work.names.push_back(name);
  std::string result = expand(body, work, behind_dollar);
  work.names.pop_back();
  return result;
}

Macros::Arguments Macros::arguments(std::string_view name, const Macro& macro, std::string_view text, std::size_t& at,
                                    Work& work) const {
  const std::string form = cut_text(fmt::format("{}({})", name, fmt::join(*macro.parameters, ",")));
  const std::size_t open = text.find_first_not_of(kSpaces, at);
  if (open == std::string_view::npos || text[open] != '(')
    throw UsageError(fmt::format("macro {} without arguments; expected {}", beginning_of(name), form));
  at = open + 1;
  auto list = list_in_brackets(text, at);
  if (!list)
    throw UsageError(fmt::format("{} has no closing bracket; expected {}", beginning_of(text.substr(open)), form));
  if (list->empty() && macro.parameters->size() == 1) list->emplace_back();
  if (list->size() != macro.parameters->size())
    throw UsageError(fmt::format("macro {} with {} arguments; expected {}", beginning_of(name), list->size(), form));
  Arguments given;
  for (std::size_t i = 0; i < list->size(); ++i) given[(*macro.parameters)[i]] = expand((*list)[i], work);
  return given;
}

}  // namespace brick
