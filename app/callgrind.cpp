#include "app/callgrind.h"

#include <numeric>
#include <sstream>

#include <fmt/format.h>

#include "app/build_info.h"
#include "app/image_lines.h"

namespace brick {

namespace {

constexpr const char* kUnknown = "???";

std::string columns(const TaskCycles& cycles) {
  std::string text = std::to_string(std::accumulate(cycles.begin(), cycles.end(), std::uint64_t{0}));
  for (const std::uint64_t of_task : cycles) text += fmt::format(" {}", of_task);
  return text;
}

}  // namespace

Callgrind::Callgrind(const std::string& image) : image_(image) {
  image_lines("--profile", image, [this](std::uint32_t address, const std::string& path, unsigned line) {
    places_[address] = {path, line};
  });
}

Callgrind::Place Callgrind::place_of(std::uint32_t pc) const {
  const auto found = places_.find(pc);
  return found == places_.end() ? Place{} : found->second;
}

void Callgrind::cost(std::uint32_t pc, const TaskCycles& cycles) { costs_[pc] = cycles; }

void Callgrind::call(std::uint32_t site, std::uint32_t callee, std::uint64_t count, const TaskCycles& inclusive) {
  calls_[site].push_back({callee, count, inclusive});
}

void Callgrind::write(std::ostream& out, const std::string& about,
                      const std::function<std::string(std::uint32_t)>& function) const {
  const auto name_of = [&](std::uint32_t pc) {
    const std::string name = function(pc);
    return name.empty() ? std::string(kUnknown) : name;
  };
  const std::string version = version_text();
  out << "# callgrind format\nversion: 1\ncreator: " << version.substr(0, version.find('\n')) << '\n';
  out << "cmd: " << image_ << '\n';
  std::istringstream lines(about);
  for (std::string line; std::getline(lines, line);) out << "desc: " << line << '\n';
  out << "positions: line\nevents: Cycles Background RealTime HostPort Servo Phase\n";

  std::string home, present, at;  // function under way, where it begins, file of the last cost
  for (const auto& [pc, cycles] : costs_) {
    const Place place = place_of(pc);
    if (const std::string name = name_of(pc); name != present) {
      present = name;
      home = at = place.path;  // a function begins in its own file: its first instruction opens its frame
      out << "\nfl=" << home << "\nfn=" << name << '\n';
    }
    if (place.path != at) {
      at = place.path;
      out << (at == home ? "fe=" : "fi=") << at << '\n';
    }
    out << place.line << ' ' << columns(cycles) << '\n';
    const auto calls = calls_.find(pc);
    if (calls == calls_.end()) continue;
    for (const Call& call : calls->second) {
      const Place callee = place_of(call.callee);
      out << "cfi=" << callee.path << "\ncfn=" << name_of(call.callee) << "\ncalls=" << call.count << ' ' << callee.line
          << '\n'
          << place.line << ' ' << columns(call.inclusive) << '\n';
    }
  }
}

}  // namespace brick
