#include "testbench/benches/path_host.h"

#include <algorithm>

#include <fmt/format.h>

#include "systemc/machine/board_family.h"

namespace brick {

namespace {

constexpr double kLateStart = 4;                             // servo cycles that a cubic start may need to show
constexpr double kSlope = 1.005, kBend = 1.02, kSpan = 400;  // motion:7.4/4
constexpr double kFirstUnits = 2, kSecondUnits = 4;
constexpr double kMoreTime = 1.02;                    // of a servo cycle, that `followed` looks to either side
constexpr double kInPosition = 1, kComesToRest = 10;  // counts; ms

}  // namespace

unsigned PathHost::systems() {
  const bool one = (bench().board.ssi_kind & kSsiGeoPmac) != 0;
  return one ? std::min(motors() / 2, 1u) : motors() / 2;
}

MotorPoint PathHost::at(const System& s, std::size_t sample) const {
  MotorPoint p;
  for (const unsigned m : s.motors) p.push_back(samples(m)[sample].commanded - samples(m)[0].commanded);
  return p;
}

std::size_t PathHost::last_of(const System& s, Span span) const { return std::min(span.to, last(s.motors.front())); }

std::size_t PathHost::begins(const System& s, std::size_t from) const {
  std::size_t first = last(s.motors.front());
  for (const unsigned m : s.motors)
    for (std::size_t i = from + 1; i < first; ++i)
      if (samples(m)[i].commanded != samples(m)[from].commanded) first = i;
  return first;
}

double PathHost::lasts(const System& s, Span span) const {
  std::size_t end = span.from;
  for (const unsigned m : s.motors)
    for (std::size_t i = last_of(s, span); i > end; --i)
      if (samples(m)[i].commanded != samples(m)[i - 1].commanded) end = i;
  return static_cast<double>(end + 1 - begins(s, span.from)) * period();
}

PathHost::Fitted PathHost::fitted(const System& s, const SplinePath& path) const {
  const std::size_t first = begins(s), end = last_of(s, {});
  if (first >= end) return {};
  std::vector<MotorPoint> places;
  for (std::size_t i = first - 1; i <= end; ++i) places.push_back(at(s, i));
  const auto with = [&](double shift) {  // time of the path at the first sample that shows it
    Fitted f;
    f.worst = 0;
    f.begin = static_cast<double>(first) * period() - shift;
    for (std::size_t i = first - 1; i <= end; ++i) {
      const double t = static_cast<double>(i) * period() - f.begin;
      const MotorPoint expected = path.at(t);
      const MotorPoint& found = places[i + 1 - first];
      for (std::size_t m = 0; m < found.size(); ++m)
        if (const double off = std::fabs(found[m] - expected[m]); off > f.worst) f.worst = off, f.at = t;
      if (t > 0 && t < path.end()) ++f.moving;
    }
    return f;
  };
  double low = 0, high = kLateStart * period();
  for (int i = 0; i < 40; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (with(a).worst < with(b).worst)
      high = b;
    else
      low = a;
  }
  return with((low + high) / 2);
}

void PathHost::report_fitted(const System& s, const SplinePath& path, const Fitted& fit) {
  const auto least = static_cast<std::size_t>(path.end() / period()) - 2;
  report().step(s.name + ": path", fit.worst <= kNear && fit.moving >= least,
                fit.worst > 1e8 ? "never moved"
                                : fmt::format("{:.4f} counts off at {:.1f} ms of {:.1f}, expected up to {}; {} servo "
                                              "interrupts, expected {} or more",
                                              fit.worst, fit.at, path.end(), kNear, fit.moving, least));
}

PathHost::Followed PathHost::followed(const System& s, const SplinePath& path, Span span,
                                      const MotorPoint& origin) const {
  Followed f;
  double time = 0;
  for (std::size_t i = span.from; i <= last_of(s, span); ++i) {
    const double reach = kMoreTime * period();
    MotorPoint p = at(s, i);
    for (std::size_t m = 0; m < origin.size(); ++m) p[m] -= origin[m];
    const auto nearest = path.nearest(p, std::max(0.0, time - reach), std::min(path.end(), time + reach));
    time = nearest.time;
    f.times.push_back(time);
    if (nearest.distance > f.worst) f.worst = nearest.distance, f.at = i;
  }
  return f;
}

void PathHost::report_followed(const System& s, const Followed& f, std::size_t least) {
  std::size_t moving = 0;
  for (std::size_t i = 1; i < f.times.size(); ++i) moving += f.times[i] != f.times[i - 1];
  report().step(s.name + ": on the path", f.worst <= kNear && moving >= least,
                fmt::format("{:.4f} counts beside it at sample {}, expected up to {}; {} servo interrupts, expected {} "
                            "or more",
                            f.worst, f.at, kNear, moving, least));
}

PathHost::Use PathHost::use(unsigned motor, Limits l, Span span) const {
  const auto& all = samples(motor);
  const auto unit = [&](std::size_t i) { return std::llround(all[i].commanded * kUnits); };
  const double per_acceleration = l.acceleration * kUnits;
  const auto k = l.acceleration > 0
                     ? static_cast<std::size_t>(std::ceil(std::sqrt(kSpan / per_acceleration) / period()))
                     : std::size_t{1};
  const double ms = static_cast<double>(k) * period();
  Use u;
  for (std::size_t i = span.from + 1; i <= std::min(span.to, all.size() - 1); ++i) {
    const auto slope = static_cast<double>(std::llabs(unit(i) - unit(i - 1)));
    if (const double part = l.velocity > 0 ? slope / (l.velocity * kUnits * period() * kSlope + kFirstUnits) : 0;
        part > u.velocity)
      u.velocity = part, u.fastest = i;
    if (l.acceleration <= 0 || i < span.from + 2 * k) continue;
    const auto bend = static_cast<double>(std::llabs(unit(i) - 2 * unit(i - k) + unit(i - 2 * k)));
    if (const double part = bend / (per_acceleration * ms * ms * kBend + kSecondUnits); part > u.acceleration)
      u.acceleration = part, u.sharpest = i;
  }
  return u;
}

void PathHost::report_limits(const System& s, const std::vector<Limits>& limits, double least, Span span) {
  double most = 0;
  std::string text, wrong;
  for (std::size_t m = 0; m < s.motors.size(); ++m) {
    const Use u = use(s.motors[m], limits[m], span);
    most = std::max({most, u.velocity, u.acceleration});
    text +=
        fmt::format("#{} {:.1f} % of Ixx16, {:.1f} % of Ixx17; ", s.motors[m], 100 * u.velocity, 100 * u.acceleration);
    if (u.velocity > 1) wrong += fmt::format("#{} exceeds Ixx16 at sample {}; ", s.motors[m], u.fastest);
    if (u.acceleration > 1) wrong += fmt::format("#{} exceeds Ixx17 at sample {}; ", s.motors[m], u.sharpest);
  }
  report().step(s.name + ": limits", wrong.empty() && most >= least,
                fmt::format("{}{}expected 100 % at most, {:.0f} % reached", wrong, text, 100 * least));
}

void PathHost::report_end(const System& s, const MotorPoint& way) {
  Comparison compared;
  const MotorPoint end = at(s, last_of(s, {}));
  for (std::size_t m = 0; m < way.size(); ++m)
    compared.equal(fmt::format("motor {}: way in units of 1/3072 count", s.motors[m]), std::llround(end[m] * kUnits),
                   std::llround(way[m] * kUnits));
  // To the unit, as above: the way of an arc is a sum of doubles.
  const auto off = [&](std::size_t m) {
    const auto& all = samples(s.motors[m]);
    return std::round((all.back().actual - all.front().commanded - way[m]) * kUnits) / kUnits;
  };
  for (std::size_t m = 0; m < way.size(); ++m) {
    for (double waited = 0; std::fabs(off(m)) > kInPosition && waited < kComesToRest; waited += 0.5) wait_ms(0.5);
    compared.judged(fmt::format("motor {}", s.motors[m]),
                    std::fabs(off(m)) <= kInPosition ? "" : fmt::format("is {:.2f} counts from there", off(m)));
  }
  report().step(s.name + ": end", compared, static_cast<unsigned>(way.size() * 2),
                "exactly where the program goes, the motors within a count");
}

void PathHost::watch(const std::vector<std::uint32_t>& addresses) {
  addresses_ = addresses;
  watched_.assign(addresses.size(), {});
  record();
}

void PathHost::looked() {
  for (std::size_t i = 0; i < addresses_.size(); ++i) watched_[i].push_back(y(addresses_[i]));
}

unsigned PathHost::run_time_error(const System& s) {
  return static_cast<unsigned>(std::stoul(ask(fmt::format("RY${:X}", 0x2014 + 0x100 * (s.number - 1)))));
}

std::uint32_t PathHost::status_word(const System& s, unsigned word) {
  const std::string answer = ask(fmt::format("&{}??", s.number));
  return answer.size() != 18 ? 0
                             : static_cast<std::uint32_t>(std::stoul(answer.substr(6 * (word - 1), 6), nullptr, 16));
}

}  // namespace brick
