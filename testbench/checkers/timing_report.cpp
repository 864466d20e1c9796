#include "testbench/checkers/timing_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace brick {

namespace {

constexpr const char* kTaskNames[TimingProfile::kTasks] = {"background", "real-time", "servo", "phase", "bench"};

double ns(TimeFs time) { return static_cast<double>(time) / kFsPerNs; }
double percent(TimeFs part, TimeFs whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

struct SpanRow {
  const char *name, *from_to, *rule, *bound;
  const TimingProfile::Span& span;
};
std::vector<SpanRow> span_rows(const TimingProfile& p) {
  return {
      {"T_FALL", "CR of a line read by the CPU to BREQ low", "host-bus:5.7/5", "one pass of the background", p.fall()},
      {"T_PULSE", "BREQ low for a stored line", "host-bus:5.7/6", "1 us to 50 us", p.pulse()},
      {"longer", "BREQ low longer than that within one line", "host-bus:5.7/6",
       "a line such as &1CLEAR, else T_PULSE is broken", p.longer()},
      {"T_RISE", "start of the real-time interrupt to its rise of BREQ", "host-bus:5.7/8", "within that interrupt",
       p.rise()},
      {"line to IRQ", "enabled line high to IRQ high", "host-bus:4.1/8", "at most 76.3 ns", p.interrupt()}};
}

// Functions by their share of the bus, the greatest first.
std::vector<std::pair<std::pair<unsigned, std::string>, TimingProfile::Load>> by_load(const TimingProfile& profile) {
  const auto all = profile.functions();
  std::vector<std::pair<std::pair<unsigned, std::string>, TimingProfile::Load>> list(all.begin(), all.end());
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.second.time > b.second.time; });
  return list;
}

std::string function_name(unsigned task, const std::string& name) {
  return !name.empty() ? name : task == TimingProfile::kBench ? "bus master" : "?";
}

}  // namespace

std::string timing_table(const TimingBook& book) {
  std::string text;
  for (const TimingLedger* ledger : book.ledgers()) {
    text += fmt::format("\n{}\n{:>5}  {:<22}{:>12}{:>12}{:>12}{:>12}  where\n", ledger->bus(), "rule", "region",
                        "required", "measured", "margin", "evaluated");
    for (unsigned rule = 0; rule < ledger->rules().size(); ++rule) {
      const TimingRule& r = ledger->rules()[rule];
      text += fmt::format("{:>5}  {} ({}), ns\n", r.id, r.text,
                          r.kind == TimingRule::Kind::kMost    ? "most"
                          : r.kind == TimingRule::Kind::kLeast ? "least"
                                                               : "always");
      for (unsigned region = 0; region < ledger->regions().size(); ++region) {
        const TimingRow& row = ledger->row(rule, region);
        if (row.evaluations == 0) continue;
        const bool timed = r.kind != TimingRule::Kind::kHolds;
        text += timed ? fmt::format("{:>5}  {:<22}{:>12.3f}{:>12.3f}{:>12.3f}{:>12}", "", ledger->regions()[region],
                                    ns(row.required), ns(row.measured), ns(row.margin), row.evaluations)
                      : fmt::format("{:>5}  {:<22}{:>36}{:>12}", "", ledger->regions()[region],
                                    row.violations == 0 ? "held" : "did not hold", row.evaluations);
        text += fmt::format("  {} {}, {}", row.where.write ? "write" : "read", timing_address(row.where),
                            book.place_text(row.where));
        if (row.violations > 0) text += fmt::format("  VIOLATED {} times", row.violations);
        text += "\n";
      }
    }
  }
  return text;
}

std::string timing_spans(const TimingProfile& profile) {
  std::string text = fmt::format("\nBREQ and interrupt, us\n{:<12}{:>10}{:>12}{:>12}  {}\n", "", "times", "shortest",
                                 "longest", "what, rule, bound");
  for (const SpanRow& row : span_rows(profile)) {
    const std::string what = fmt::format("{}; {}, {}", row.from_to, row.rule, row.bound);
    text += row.span.count == 0 ? fmt::format("{:<12}{:>34}  {}\n", row.name, "none seen", what)
                                : fmt::format("{:<12}{:>10}{:>12.4f}{:>12.4f}  {}\n", row.name, row.span.count,
                                              ns(row.span.least) / 1000, ns(row.span.most) / 1000, what);
  }
  return text;
}

std::string timing_load(const TimingProfile& profile, TimeFs run) {
  TimingProfile::Load all;
  for (const TimingProfile::Load& task : profile.tasks()) {
    all.cycles += task.cycles;
    all.time += task.time;
  }
  const auto line = [&](const std::string& task, const std::string& function, const TimingProfile::Load& load) {
    return fmt::format("{:<12}{:<34}{:>12}{:>14.3f}{:>10.3f} %\n", task, function, load.cycles, ns(load.time) / 1000,
                       percent(load.time, run));
  };
  std::string text = fmt::format("\nBus load of Port A\n{:<12}{:<34}{:>12}{:>14}{:>12}\n", "task", "function", "cycles",
                                 "us", "of the run");
  for (unsigned task = 0; task < TimingProfile::kTasks; ++task)
    text += line(kTaskNames[task], "all", profile.tasks()[task]);
  text += line("all", "", all);
  for (const auto& [key, load] : by_load(profile))
    text += line(kTaskNames[key.first], function_name(key.first, key.second), load);
  return text;
}

nlohmann::json timing_json(const TimingBook& book, const TimingProfile& profile, TimeFs run) {
  nlohmann::json rules = nlohmann::json::array(), violations = nlohmann::json::array(), load = nlohmann::json::array();
  for (const TimingLedger* ledger : book.ledgers()) {
    for (unsigned rule = 0; rule < ledger->rules().size(); ++rule) {
      for (unsigned region = 0; region < ledger->regions().size(); ++region) {
        const TimingRow& row = ledger->row(rule, region);
        const TimingRule& r = ledger->rules()[rule];
        nlohmann::json entry = {{"bus", ledger->bus()},
                                {"rule", r.id},
                                {"text", r.text},
                                {"source", r.source},
                                {"region", ledger->regions()[region]},
                                {"evaluations", row.evaluations},
                                {"violations", row.violations}};
        if (row.evaluations > 0)
          entry.update({{"required_ns", ns(row.required)},
                        {"measured_ns", ns(row.measured)},
                        {"margin_ns", ns(row.margin)},
                        {"address", timing_address(row.where)},
                        {"where", book.place_text(row.where)}});
        rules.push_back(std::move(entry));
      }
    }
    for (const TimingViolation& v : ledger->violations())
      violations.push_back({{"bus", ledger->bus()},
                            {"rule", ledger->rules()[v.rule].id},
                            {"region", ledger->regions()[v.region]},
                            {"address", timing_address(v.where)},
                            {"count", v.count},
                            {"text", book.text(*ledger, v)}});
  }
  nlohmann::json spans;
  for (const SpanRow& row : span_rows(profile))
    spans[row.name] = {{"count", row.span.count},
                       {"least_ns", ns(row.span.least)},
                       {"most_ns", ns(row.span.most)},
                       {"rule", row.rule}};
  for (const auto& [key, l] : by_load(profile))
    load.push_back({{"task", kTaskNames[key.first]},
                    {"function", function_name(key.first, key.second)},
                    {"cycles", l.cycles},
                    {"us", ns(l.time) / 1000},
                    {"percent", percent(l.time, run)}});
  return {{"rules", rules}, {"violations", violations}, {"spans", spans}, {"load", load}};
}

}  // namespace brick
