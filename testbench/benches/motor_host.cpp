#include "testbench/benches/motor_host.h"

#include <algorithm>

#include <fmt/format.h>

#include "systemc/cpu/port_a.h"

namespace brick {

namespace {

constexpr std::uint32_t kMainMemory = 0xC0000000;  // docs/architecture.md, memory map
constexpr unsigned kServoTask = 2;                 // number in cpu.task, docs/signals.md
constexpr std::uint32_t kCommanded = 0x08, kActual = 0x0B;
constexpr double kJitter = 2.5;       // position units that a second difference at constant velocity may have
constexpr double kLongestStart = 40;  // ms from a command to the first move, at most
constexpr double kAfter = 2;          // ms of rest behind a path that are compared, too

std::int64_t long_word(std::uint32_t high, std::uint32_t low) {
  return static_cast<std::int64_t>((static_cast<std::uint64_t>(high) << 24 | low) << 16) >> 16;
}

}  // namespace

plant::AxisParameters dac_axis() {
  plant::AxisParameters axis;
  axis.drive = plant::Drive::kTorque;
  axis.motor.inertia = 1e-5;
  axis.motor.viscous = 1e-4;
  axis.motor.coulomb = 5e-4;
  axis.motor.torque_constant = 0.1;
  axis.amplifier.full_scale_amps = 10;
  axis.amplifier.trip_amps = 15;
  axis.amplifier.adc = false;
  return axis;
}

MotorHost::MotorHost(BenchContext& b)
    : ServoHost(b, b.seed * 7'919 + 11),
      motors_(std::min(b.motors, channels())),
      plant_(b.plant),
      output_(motors_),
      captured_(motors_),
      samples_(motors_),
      enables_(motors_),
      on_task_(b.machine.on_task) {
  b.machine.attach(*this);
  b.machine.on_bus_cycle = [this](const PortACycle& c) { cycle(c); };
  b.machine.on_task = [this](TimeFs time) { task_changed(time); };
  period_ = static_cast<double>(numbers("I10").at(0)) / 8'388'608;
}

MotorHost::~MotorHost() {
  bench().machine.on_task = on_task_;
  bench().machine.on_bus_cycle = nullptr;
  bench().machine.detach(*this);
}

std::uint32_t MotorHost::ics() const {
  std::uint32_t mask = 0;
  for (unsigned i = 0; i < motors_; ++i) mask |= 1u << ic(i / kChannels);
  return mask;
}

void MotorHost::changed(Tick tick, unsigned ic_number, const MotorOutputs&, const MotorOutputs& after) {
  for (unsigned i = 0; i < motors_; ++i) {
    if (ic(i / kChannels) != ic_number) continue;
    const bool on = after.get(motor_pin::kAena, i % kChannels) != 0;
    if (enables_[i].empty() || enables_[i].back().on != on) enables_[i].push_back({tick, on});
  }
}

Tick MotorHost::disabled_at(unsigned motor, Tick after) const {
  for (const Enable& e : enables(motor))
    if (!e.on && e.tick >= after) return e.tick;
  return -1;
}

void MotorHost::cycle(const PortACycle& c) {
  if (c.on_chip) return;
  for (unsigned i = 0; i < motors_; ++i) {
    if (c.write && !c.x && c.address == address(i, word::kOutA)) output_[i] = c.data;
    if (!c.write && c.x && c.address == address(i, word::kFlagPosition)) captured_[i] = c.data;
  }
}

// The servo task has ended when the CPU goes on with one below it; what interrupts it is above.
void MotorHost::task_changed(TimeFs time) {
  if (on_task_) on_task_(time);
  const unsigned task = bench().machine.task();
  if (in_servo_ && task < kServoTask) {
    left_ = time;
    look();
  }
  if (task == kServoTask || task < kServoTask) in_servo_ = task == kServoTask;
}

void MotorHost::look() {
  for (unsigned i = 0; i < motors_; ++i) {
    const std::uint32_t base = 0x80 * (i + 1);
    const auto counts = [&](std::uint32_t at) { return static_cast<double>(d(base + at)) / kUnits; };
    const auto word = static_cast<double>(static_cast<std::int32_t>(output_[i] << 8) >> 8);
    samples_[i].push_back({fs_to_tick(left_), counts(kCommanded), counts(kActual), word / 256, turned(i + 1),
                           !enables_[i].empty() && enables_[i].back().on});
  }
  looked();
}

std::uint32_t MotorHost::word_at(std::uint32_t address, unsigned byte) {
  const std::uint8_t* p = bench().machine.cpu().memory(kMainMemory + 8 * address + byte, 4);
  return p == nullptr ? 0 : p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16;
}

std::int64_t MotorHost::d(std::uint32_t address) { return long_word(x(address), y(address)); }

bool MotorHost::status_bit(unsigned motor, unsigned word, unsigned bit) {
  const std::string answer = status(motor);
  if (answer.size() != 12) return false;
  return (std::stoul(answer.substr(word == 1 ? 0 : 6, 6), nullptr, 16) >> bit & 1) != 0;
}

void MotorHost::record() {
  for (unsigned i = 0; i < motors_; ++i) {
    samples_[i].clear();
    captured_[i].reset();
    enables_[i] = {{now(), pin(motor_pin::kAena, i) != 0}};
  }
}

bool MotorHost::settle(double at_most_ms, double still_ms) {
  const auto still = static_cast<std::size_t>(still_ms / period_);
  const auto rests = [still](const std::vector<Sample>& s) {
    return s.size() > still && std::all_of(s.end() - static_cast<std::ptrdiff_t>(still), s.end(),
                                           [&s](const Sample& x) { return x.commanded == s.back().commanded; });
  };
  const auto moved = [this] {
    for (unsigned motor = 1; motor <= motors_; ++motor)
      if (departs(motor)) return true;
    return false;
  };
  for (double waited = 0; waited < at_most_ms; waited += still_ms / 4) {
    wait_ms(still_ms / 4);
    if ((waited > kLongestStart || moved()) && std::all_of(samples_.begin(), samples_.end(), rests)) return true;
  }
  return false;
}

void MotorHost::variables(unsigned k, double value) {
  std::vector<std::string> words;
  for (unsigned motor = 1; motor <= motors_; ++motor)
    words.push_back(fmt::format("I{}={:.12g}", 100 * motor + k, value));
  say(words);
}

// Gains: 40,000/s^2 and 400/s, as examples/setups/dac8.pmc derives them.
void MotorHost::set_up() {
  std::vector<std::string> words;
  for (unsigned i = 0; i < motors_; ++i) {
    const unsigned motor = 100 * (i + 1);
    const auto at = [&](unsigned k, const std::string& value) {
      words.push_back(fmt::format("I{}={}", motor + k, value));
    };
    words.push_back(fmt::format("I{}=3 I{}=3", i_channel(i, 0), i_channel(i, 6)));
    words.push_back(fmt::format("I{}=${:X}", 8000 + i, base(i / kChannels) + 8 * (i % kChannels)));
    at(0, "0");
    at(1, "0");
    at(2, fmt::format("${:X}", address(i, word::kOutA)));
    at(3, fmt::format("${:X}", 0x3501 + i));
    at(4, fmt::format("${:X}", 0x3501 + i));
    at(24, "$800001");
    at(25, fmt::format("${:X}", address(i, word::kStatus)));
    for (const auto& [k, value] : {std::pair{15u, 4},
                                   {16u, 200},
                                   {17u, 4},
                                   {19u, 4},
                                   {21u, 5},
                                   {22u, 32},
                                   {28u, 160},
                                   {30u, 112450},
                                   {31u, 2900},
                                   {32u, 2972},
                                   {33u, 37000},
                                   {35u, 16320},
                                   {69u, 32767}})
      at(k, std::to_string(value));
    at(0, "1");
  }
  words.insert(words.begin() + 2, fmt::format("I{}=0", 8000 + motors_));
  say(words);
}

void MotorHost::close_all() {
  for (unsigned motor = 1; motor <= motors_; ++motor) expect(fmt::format("#{}J/", motor), "");
  wait_ms(5);
}

std::optional<std::size_t> MotorHost::departs(unsigned motor, std::size_t from) const {
  const auto& s = samples(motor);
  for (std::size_t i = from + 2; i < s.size(); ++i)
    if (std::fabs(s[i].commanded - 2 * s[i - 1].commanded + s[i - 2].commanded) * kUnits > kJitter) return i;
  return std::nullopt;
}

MotorHost::Fit MotorHost::fit(unsigned motor, const std::function<Path(double)>& make, double duration,
                              std::size_t from, double velocity) const {
  const auto& s = samples(motor);
  const auto seen = departs(motor, from);
  if (!seen) return {};
  const std::size_t before = *seen - 1;
  // `shift`: time of the path at the first sample that departs from what was.
  const auto with = [&](double shift) {
    const double from_start = shift - period_;  // time of the path at the sample before
    const Path path = make(s[before].commanded - velocity * from_start);
    Fit f;
    f.worst = 0;
    f.begin = static_cast<double>(*seen) * period_ - shift;
    f.end = f.begin + duration;
    for (std::size_t i = before; i < s.size(); ++i) {
      const double t = static_cast<double>(i) * period_ - f.begin;
      if (t > duration + kAfter) break;
      const double off = std::fabs(s[i].commanded - path(t));
      if (off > f.worst) f.worst = off, f.at = t;
      if (t > 0 && t < duration) ++f.moving;
    }
    return f;
  };
  double low = 0, high = 4 * period_;  // a rounded start shows late
  for (int i = 0; i < 40; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (with(a).worst < with(b).worst)
      high = b;
    else
      low = a;
  }
  return with((low + high) / 2);
}

void report_fit(BenchReport& report, const std::string& name, const MotorHost::Fit& fit, std::size_t least) {
  report.step(name, fit.worst <= 1.0 / 16 && fit.moving >= least,
              fit.worst > 1e8
                  ? "never moved"
                  : fmt::format("{:.4f} counts off at {:.1f} ms, expected up to 0.0625; {} servo interrupts, "
                                "expected {} or more",
                                fit.worst, fit.at, fit.moving, least));
}

}  // namespace brick
