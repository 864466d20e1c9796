#include "app/regress/result.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <climits>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/byte_text.h"
#include "systemc/core/usage_error.h"

namespace brick::regress {

namespace {

constexpr std::size_t kLongestText = 300;
constexpr int kSkipped = 77;  // exit status, as ctest and automake have it
constexpr std::streamoff kEndOfOutput = 64 * 1024;

std::string shortened(const std::string& bytes) {
  std::string text = readable_text(bytes);
  if (text.size() <= kLongestText) return text;
  std::size_t end = kLongestText;
  while ((text[end] & 0xC0) == 0x80) --end;  // within a character
  return text.substr(0, end) + "...";
}

std::string host_name() {
  char name[HOST_NAME_MAX + 1] = "";
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

// A run may leave anything under the names of its results: a pipe would be waited at, a folder cannot be read.
bool is_file(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

// The last line that tells of a failure, else the last line; of a long output its end is looked at.
std::string last_said(const std::string& file) {
  if (!is_file(file)) return "";
  std::ifstream in(file, std::ios::binary);
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size - kEndOfOutput));
  std::string line, last, failure;
  while (std::getline(in, line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    last = line;
    if (failure.empty() && (line.find("FAIL") != std::string::npos || line.find("rror:") != std::string::npos))
      failure = line;
  }
  return shortened(failure.empty() ? last : failure);
}

// How far a bench came and the first step that failed; a file of another form tells nothing.
Result steps_of(const nlohmann::json& run) {
  if (!run.is_object()) return {};
  try {
    Result result;
    result.simulated_ms = run.value("simulated_ns", 0.0) * 1e-6;
    for (const auto& step : run.value("steps", nlohmann::json::array())) {
      if (step.value("passed", false)) continue;
      result.step = shortened(step.value("name", ""));
      if (result.step.empty()) result.step = "a step without a name";
      result.says = shortened(step.value("detail", ""));
      result.at_ms = step.value("ns", 0.0) * 1e-6;
      break;
    }
    return result;
  } catch (const nlohmann::json::exception&) { return {}; }
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_hex(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }
bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// # for each number: decimal, hexadecimal behind $ or 0x or as a word that has a digit, and digits in names (ch3).
std::string without_numbers(const std::string& text) {
  const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : ' '; };
  const auto word_end = [&](std::size_t i) {
    while (in_word(at(i))) ++i;
    return i;
  };
  std::string plain;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t from = text[i] == '$' ? i + 1 : i;
    std::size_t end = word_end(from);
    const std::string word = text.substr(from, end - from);
    const bool is_number = (std::all_of(word.begin(), word.end(), is_hex) || word.compare(0, 2, "0x") == 0) &&
                           std::any_of(word.begin(), word.end(), is_digit);
    if (is_number) {
      while (at(end) == '.' && is_digit(at(end + 1))) end = word_end(end + 1);
      if (std::tolower(text[end - 1]) == 'e' && (at(end) == '-' || at(end) == '+') && is_digit(at(end + 1)))
        end = word_end(end + 1);
      plain += '#';
    } else if (word.empty()) {
      plain += text[i];
      end = i + 1;
    } else {
      if (from != i) plain += '$';
      for (std::size_t c = 0; c < word.size(); ++c)
        if (!is_digit(word[c]))
          plain += word[c];
        else if (c == 0 || !is_digit(word[c - 1]))
          plain += '#';
    }
    i = end;
  }
  return plain;
}

}  // namespace

nlohmann::json json_of(const std::string& file) {
  if (!is_file(file)) return {};
  std::ifstream in(file);
  return in ? nlohmann::json::parse(in, nullptr, false) : nlohmann::json();
}

Result judge(const Run& run, const Ended& ended, const std::string& folder) {
  Result result = steps_of(json_of(folder + "/run.json"));  // a bench of somebody else may leave one too
  result.wall_seconds = ended.seconds;
  result.host = host_name();
  const std::string output = folder + "/output.txt";
  switch (ended.how) {
    case Ended::How::kLimit:
      result.verdict = "limit";
      result.says = fmt::format("no end within {:g} s", run.limit_seconds);
      return result;
    case Ended::How::kSignal:
      result.verdict = "crashed";
      result.says = fmt::format("ended by SIG{}", sigabbrev_np(ended.code) != nullptr ? sigabbrev_np(ended.code) : "?");
      return result;
    case Ended::How::kExit:
      break;
  }
  if (ended.code == 0) {
    result.verdict = result.step.empty() ? "passed" : "failed";  // whatever it ended with
    return result;
  }
  if (ended.code == kSkipped && !run.bench()) {
    result.verdict = "skipped";
    result.says = last_said(output);
    return result;
  }
  result.verdict = ended.code == 1 ? "failed" : ended.code == 2 ? "bad" : "crashed";
  if (result.step.empty()) result.says = last_said(output);
  if (ended.code > 2) result.says = fmt::format("exit status {}: {}", ended.code, result.says);
  return result;
}

nlohmann::json result_json(const Run& run, const Result& result) {
  return {{"name", run.name},
          {"group", run.group},
          {"column", run.column},
          {"engine", run.engine},
          {"seed", run.seed},
          {"command", command_text(run.words)},
          {"verdict", result.verdict},
          {"step", result.step},
          {"says", result.says},
          {"at_ms", result.at_ms},
          {"simulated_ms", result.simulated_ms},
          {"wall_seconds", result.wall_seconds},
          {"host", result.host}};
}

std::string text_of(const nlohmann::json& content, int indent) {
  return content.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

void keep(const Run& run, const Result& result, const nlohmann::json& build, const std::string& folder) {
  nlohmann::json content = result_json(run, result);
  content["build"] = build;
  const std::string file = folder + "/result.json", unfinished = file + ".new";
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  for (const std::string& taken : {unfinished, file})
    if (!is_file(taken)) std::filesystem::remove_all(taken, failed);
  std::ofstream out(unfinished);
  out << text_of(content, 2) << '\n';
  out.close();
  if (out) std::filesystem::rename(unfinished, file, failed);
  if (!out || failed) throw UsageError(fmt::format("{}: cannot be written; expected room for results", file));
}

std::optional<Result> kept(const Run& run, const nlohmann::json& build, const std::string& folder) {
  const nlohmann::json content = json_of(folder + "/result.json");
  if (!content.is_object()) return std::nullopt;
  try {
    if (content.at("command") != command_text(run.words) || content.at("build") != build) return std::nullopt;
    Result result;
    result.verdict = content.at("verdict");
    result.step = content.at("step");
    result.says = content.at("says");
    result.at_ms = content.at("at_ms");
    result.simulated_ms = content.at("simulated_ms");
    result.wall_seconds = content.at("wall_seconds");
    result.host = content.at("host");
    return result;
  } catch (const nlohmann::json::exception&) { return std::nullopt; }  // not of ours
}

std::vector<Bucket> buckets_of(const std::vector<Run>& runs, const std::vector<std::optional<Result>>& results) {
  std::map<std::tuple<std::string, std::string, std::string, std::string>, Bucket> kinds;
  std::map<std::string, std::vector<std::size_t>> by_choice;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!results[i]) continue;
    if (runs[i].bench()) by_choice[runs[i].choice].push_back(i);
    const Result& r = *results[i];
    if (r.passed()) continue;
    Bucket kind{runs[i].group, r.verdict, without_numbers(r.step), without_numbers(r.says), {}};
    kinds.try_emplace({kind.group, kind.verdict, kind.step, kind.says}, kind).first->second.runs.push_back(i);
  }
  for (const auto& [choice, same] : by_choice) {
    std::set<std::string> verdicts;
    for (const std::size_t i : same) verdicts.insert(results[i]->verdict);
    if (verdicts.size() < 2) continue;
    const std::string& group = runs[same[0]].group;
    Bucket& differ =
        kinds.try_emplace({group, "engines differ", "", ""}, Bucket{group, "engines differ", "", "", {}}).first->second;
    for (const std::size_t i : same)
      if (!results[i]->passed()) differ.runs.push_back(i);
  }
  std::vector<Bucket> all;
  for (auto& [key, bucket] : kinds) all.push_back(std::move(bucket));
  std::stable_sort(all.begin(), all.end(),
                   [](const Bucket& a, const Bucket& b) { return a.runs.size() > b.runs.size(); });
  return all;
}

std::string command_text(const std::vector<std::string>& words) {
  std::vector<std::string> shown;
  for (const std::string& word : words) {
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789-_./=:,+@%") == std::string::npos;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    shown.push_back(plain ? word : quoted + "'");
  }
  return fmt::format("{}", fmt::join(shown, " "));
}

}  // namespace brick::regress
