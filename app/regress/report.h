// The results of all runs of a plan, for people, for machines and for CI: report.html, report.json, report.xml.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/regress/covers.h"
#include "app/regress/result.h"

namespace brick::regress {

struct Replay {
  std::string command;  // the failure again, with a waveform
  std::string wave;     // file, beside the report; "" where it was not made
  std::string view;     // GTKWave's save file; "" where there is none
  std::string picture;  // of both, SVG; "" where there is none
  std::string note;     // what is odd: it passed this time, or failed elsewhere
};

struct Report {
  const Plan& plan;
  const std::vector<std::optional<Result>>& results;  // of each run; none: not made
  const std::vector<Bucket>& buckets;
  const std::vector<Replay>& replays;  // of each bucket
  nlohmann::json build;
  const Coverage& coverage;
  std::vector<Ranked> ranked;  // of --rank
  std::uint64_t fresh_from;
  double wall_seconds;
};

// Writes all three into `folder`. Throws UsageError when it cannot.
void write_reports(const Report& report, const std::string& folder);

nlohmann::json report_json(const Report& report);
std::string junit_text(const Report& report);  // JUnit's XML: a suite a bench, a case a run
// HTML with all it needs; asks for nothing outside (page.cpp). `pictures`: a list, of each bucket.
std::string page_text(const nlohmann::json& report, const nlohmann::json& pictures);

}  // namespace brick::regress
