#include "app/regress/report.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "app/byte_text.h"
#include "systemc/core/usage_error.h"

namespace brick::regress {

namespace {

void write(const std::string& file, const std::string& text) {
  const std::string unfinished = file + ".new";
  std::ofstream out(unfinished, std::ios::binary);
  out << text;
  out.close();
  std::error_code failed;
  if (out) std::filesystem::rename(unfinished, file, failed);
  if (!out || failed) throw UsageError(fmt::format("{}: cannot be written; expected room for reports", file));
}

struct Writer : pugi::xml_writer {
  std::string text;
  void write(const void* data, std::size_t size) override { text.append(static_cast<const char*>(data), size); }
};

std::string headline(const Bucket& bucket) {
  std::string text = bucket.group + ": " + bucket.verdict;
  if (!bucket.step.empty()) text += ", " + bucket.step;
  if (!bucket.says.empty()) text += ": " + bucket.says;
  return text;
}

// Of a run that was stopped, or for which there was no time.
Result not_run() {
  Result none;
  none.verdict = "not run";
  none.says = "stopped, or no time was left";
  return none;
}

// XML has no control characters but the ends of lines, which a command may hold.
std::string readable_lines(const std::string& text) {
  std::stringstream in(text);
  std::string lines;
  for (std::string line; std::getline(in, line);) lines += readable_text(line) + (in.eof() ? "" : "\n");
  return lines;
}

}  // namespace

nlohmann::json report_json(const Report& report) {
  const Plan& plan = report.plan;
  nlohmann::json runs = nlohmann::json::array(), buckets = nlohmann::json::array();
  std::map<std::string, std::size_t> verdicts;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const Result result = report.results[i].value_or(not_run());
    ++verdicts[result.verdict];
    runs.push_back(result_json(plan.runs[i], result));
  }
  for (std::size_t b = 0; b < report.buckets.size(); ++b) {
    const Bucket& bucket = report.buckets[b];
    nlohmann::json names = nlohmann::json::array(), seeds = nlohmann::json::array();
    for (const std::size_t i : bucket.runs) {
      names.push_back(plan.runs[i].name);
      seeds.push_back(plan.runs[i].seed);
    }
    nlohmann::json entry = {
        {"group", bucket.group},        {"verdict", bucket.verdict},   {"step", bucket.step}, {"says", bucket.says},
        {"headline", headline(bucket)}, {"count", bucket.runs.size()}, {"runs", names},       {"seeds", seeds}};
    if (!bucket.runs.empty()) entry["command"] = command_text(plan.runs[bucket.runs[0]].words);
    if (b < report.replays.size() && !report.replays[b].command.empty()) {
      const Replay& replay = report.replays[b];
      entry["replay"] = {
          {"command", replay.command}, {"wave", replay.wave}, {"view", replay.view}, {"note", replay.note}};
    }
    buckets.push_back(entry);
  }
  const std::size_t missing = verdicts["not run"], passed = verdicts["passed"], skipped = verdicts["skipped"];
  return {{"title", plan.title},
          {"verdict", passed != 0 && passed + skipped == plan.runs.size() ? "passed" : "failed"},
          {"counts",
           {{"runs", plan.runs.size()},
            {"passed", passed},
            {"failed", plan.runs.size() - passed - skipped - missing},
            {"skipped", skipped},
            {"not_run", missing}}},
          {"build", report.build},
          {"fresh_from", report.fresh_from},
          {"wall_seconds", report.wall_seconds},
          {"buckets", buckets},
          {"covers", covers_json(report.coverage)},
          {"ranked", ranked_json(report.ranked, plan.runs)},
          {"runs", runs}};
}

std::string junit_text(const Report& report) {
  const Plan& plan = report.plan;
  pugi::xml_document document;
  pugi::xml_node suites = document.append_child("testsuites");
  suites.append_attribute("name") = readable_text(plan.title).c_str();
  struct Sum {
    pugi::xml_node suite;
    unsigned runs = 0, failures = 0, errors = 0, skipped = 0;
    double seconds = 0;
  };
  std::map<std::string, Sum> sums;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const Run& run = plan.runs[i];
    Sum& sum = sums[run.group];
    if (!sum.suite) {
      sum.suite = suites.append_child("testsuite");
      sum.suite.append_attribute("name") = readable_text(run.group).c_str();
    }
    pugi::xml_node test = sum.suite.append_child("testcase");
    test.append_attribute("classname") = readable_text(run.group).c_str();
    test.append_attribute("name") = readable_text(run.name).c_str();
    ++sum.runs;
    const Result result = report.results[i].value_or(not_run());
    if (result.skipped()) {
      test.append_child("skipped").append_attribute("message") = readable_text(result.says).c_str();
      ++sum.skipped;
      continue;
    }
    test.append_attribute("time") = fmt::format("{:.3f}", result.wall_seconds).c_str();
    sum.seconds += result.wall_seconds;
    if (result.passed()) continue;
    const bool failure = result.verdict == "failed";
    ++(failure ? sum.failures : sum.errors);
    pugi::xml_node what = test.append_child(failure ? "failure" : "error");
    what.append_attribute("type") = result.verdict.c_str();
    what.append_attribute("message") =
        readable_text(result.step.empty() ? result.says : fmt::format("{}: {}", result.step, result.says)).c_str();
    what.append_child(pugi::node_pcdata).set_value(readable_lines(command_text(run.words)).c_str());
  }
  for (auto& [name, sum] : sums) {
    sum.suite.append_attribute("tests") = sum.runs;
    sum.suite.append_attribute("failures") = sum.failures;
    sum.suite.append_attribute("errors") = sum.errors;
    sum.suite.append_attribute("skipped") = sum.skipped;
    sum.suite.append_attribute("time") = fmt::format("{:.3f}", sum.seconds).c_str();
  }
  Writer writer;
  document.save(writer, "  ");
  return writer.text;
}

void write_reports(const Report& report, const std::string& folder) {
  const nlohmann::json content = report_json(report);
  write(folder + "/report.json", text_of(content, 1) + "\n");
  write(folder + "/report.xml", junit_text(report));
  nlohmann::json pictures = nlohmann::json::array();
  for (const Replay& replay : report.replays) pictures.push_back(replay.picture);
  write(folder + "/report.html", page_text(content, pictures));
}

}  // namespace brick::regress
