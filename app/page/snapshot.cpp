#include "app/page/snapshot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/hand_encoder.h"
#include "app/page/executing_line.h"

namespace brick {

using nlohmann::json;

namespace {

constexpr Tick kSampleEvery = ns_to_ticks(10'000'000);
constexpr std::size_t kMostSamples = 1000;  // nobody takes them: all of them go
constexpr unsigned kMotors = 32, kSystems = 16, kMotorsOfNothing = 8;
constexpr unsigned kWordBits = 24, kMotorWords = 0x80, kSystemWords = 0x2000, kSystemStride = 0x100;

// Words of the main memory, firmware:1.10.
constexpr std::uint32_t kServoCount = 0x00, kGlobalStatus = 0x06, kRealTime = 0x0B, kWatchdog = 0x25, kTasks = 0x37;
constexpr std::uint32_t kStatus1 = 0x30, kStatus2 = 0x40, kAverageVelocity = 0x6F;                    // of a motor
constexpr std::uint32_t kRunTimeError = 0x14, kRotary = 0x3E, kCsStatus2 = 0x3F, kCsStatus13 = 0x40;  // of a system

// I-variables.
constexpr std::uint32_t kI8 = 8, kI10 = 10, kI16 = 16, kI17 = 17, kI19 = 19, kI40 = 40, kI52 = 52;
constexpr std::uint32_t kMotorBlock = 100, kIxx09 = 9;
constexpr std::uint32_t kServoDividerBelowDirection = 5;  // I7m02 and I7m07, I6802 and I6807

constexpr std::uint32_t kAssigned = 1u << 15, kSystemShift = 20;  // status word 2 of a motor, firmware:5.3

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

std::int32_t signed_word(std::uint32_t word) { return static_cast<std::int32_t>(word << 8) >> 8; }

double signed_long(std::uint32_t x, std::uint32_t y) {
  const auto value = static_cast<std::int64_t>((std::uint64_t{x} << kWordBits | y) << 16) >> 16;
  return static_cast<double>(value);
}

}  // namespace

Snapshot::Snapshot(Simulation& simulation, const std::string& firmware)
    : simulation_(simulation), machine_(simulation.machine()), image_(machine_, firmware), watch_(machine_) {
  const Signals& signals = machine_.signals();
  for (unsigned number = 1; number <= kMotors; ++number) {
    const auto place = motor_place(machine_.fitted(), number);
    if (!place) break;
    const auto id = [&](const char* name) {
      return *signals.find(fmt::format("{}.ch{}.{}", servo_ic_scope(place->ic), place->channel + 1, name));
    };
    pins_[number] = {id("plim"), id("mlim"), id("hmfl"), id("fault"), id("aena")};
  }
}

// ------------------------------------------------------------------------------------------------------------- reading

std::optional<std::uint64_t> Snapshot::call(const std::string& function,
                                            std::initializer_list<std::uint32_t> arguments) {
  return image_.call(function, arguments);
}

std::int32_t Snapshot::variable(std::uint32_t number) {
  return static_cast<std::int32_t>(call("i_integer_of", {number}).value_or(0));
}

// As an M-variable has it: also what the firmware makes when it is read.
Snapshot::Word Snapshot::word(std::uint32_t address) {
  if (!call("word_read_long", {address, ImageCalls::kWords, ImageCalls::kWords + 4})) return {};
  return {image_.word(0), image_.word(1)};
}

std::uint64_t Snapshot::signal(const std::string& name) const {
  const Signals& signals = machine_.signals();
  const auto id = signals.find(name);
  return id ? signals.value(*id) : 0;
}

// -------------------------------------------------------------------------------------------------------------- motors

// Those that are activated or have an axis of a plant; on a board without any its first ones.
std::vector<unsigned> Snapshot::shown_motors() {
  std::vector<unsigned> shown;
  plant::Plant* plant = simulation_.plant();
  const auto has_axis = [&](unsigned number) {
    const auto place = motor_place(machine_.fitted(), number);
    for (std::size_t i = 0; plant != nullptr && place && i < plant->axes(); ++i)
      if (plant->axis(i).ic() == place->ic && plant->axis(i).channel() == place->channel) return true;
    return false;
  };
  for (unsigned number = 1; number <= kMotors; ++number)
    if (variable(kMotorBlock * number) != 0 || has_axis(number)) shown.push_back(number);
  for (unsigned number = 1; shown.empty() && number <= kMotorsOfNothing; ++number) shown.push_back(number);
  return shown;
}

void Snapshot::sample() {
  const Tick now = machine_.now();
  if (sampled_ && now < *sampled_ + kSampleEvery) return;
  sampled_ = now;
  if (sample_times_.size() >= kMostSamples) {
    sample_times_.clear();
    for (auto& [number, samples] : samples_) samples.actuals.clear(), samples.errors.clear();
  }
  const RecordRow row{static_cast<double>(machine_.now_fs()) * 1e-12};
  sample_times_.push_back(rounded(row.ms));
  for (auto& [number, samples] : samples_) {
    samples.actuals.push_back(rounded(samples.actual.value(row)));
    samples.errors.push_back(rounded(samples.error.value(row)));
  }
}

json Snapshot::motor(unsigned number, double servo_khz) {
  const std::uint32_t base = kMotorWords * number;
  if (samples_.count(number) == 0) {  // new on the page: its plots begin here
    auto columns = record_columns(machine_, fmt::format("motor{0}.actual motor{0}.error", number));
    const std::vector<double> nothing(sample_times_.size(), NAN);
    samples_.emplace(number, Samples{columns[0], columns[1], nothing, nothing});
  }
  Samples& samples = samples_.at(number);
  const RecordRow row{};
  const Word velocity = word(base + kAverageVelocity);
  const std::int32_t scale = variable(kMotorBlock * number + kIxx09);
  json result{
      {"number", number},
      {"position", rounded(samples.actual.value(row))},
      {"error", rounded(samples.error.value(row))},
      {"velocity", rounded(signed_long(velocity.x, velocity.y) / (32.0 * (scale == 0 ? 1 : scale)) * servo_khz)},
      {"status", {word(base + kStatus1).x, word(base + kStatus2).y}},
      {"actuals", std::exchange(samples.actuals, {})},
      {"errors", std::exchange(samples.errors, {})}};
  const auto pins = pins_.find(number);
  if (pins == pins_.end()) return result;
  const Signals& signals = machine_.signals();
  const Pins& ids = pins->second;
  result["pins"] = {{"PLIM", signals.value(ids.plus_limit)},
                    {"MLIM", signals.value(ids.minus_limit)},
                    {"HMFL", signals.value(ids.home)},
                    {"FAULT", signals.value(ids.fault)},
                    {"AENA", signals.value(ids.enable)}};
  return result;
}

// -------------------------------------------------------------------------------------------------- coordinate systems

json Snapshot::system(unsigned number) {
  const std::uint32_t base = kSystemWords + kSystemStride * (number - 1);
  const Word status = word(base + kCsStatus13), ring = word(base + kRotary);
  const std::uint64_t feed = call("run_time_base", {number - 1}).value_or(0);
  return {{"number", number},
          {"status", {status.x, word(base + kCsStatus2).y, status.y}},
          {"feed", rounded(real_of(feed))},
          {"line", executing_line(image_, number)},
          {"error", word(base + kRunTimeError).y},
          {"lines", ring.x},
          {"words", ring.y},
          {"room", static_cast<std::uint32_t>(call("rotary_room", {number - 1}).value_or(0))}};
}

// The four views of the rotary buffer's state: `??` and PR stand in the coordinate system, these are the pins.
json Snapshot::request() {
  const auto selected = static_cast<std::uint32_t>(call("buffer_request_selected", {}).value_or(kSystems));
  return {{"selected", selected < kSystems ? json(selected + 1) : json(nullptr)},
          {"breq", signal("host.breq")},
          {"irq", signal("host.irq")},
          {"ist", signal("host.pic.ist")},
          {"sig", signal("host.pic.sig")},
          {"msk", signal("host.pic.msk")},
          {"elr", signal("host.pic.elr")},
          {"i16", variable(kI16)},
          {"i17", variable(kI17)}};
}

// ------------------------------------------------------------------------------------------------- clocks, tasks, dog

// What happened since the snapshot before: the servo clock as counted, the share of time that the CPU slept.
void Snapshot::measure() {
  Cpu& cpu = machine_.cpu();
  const Measure now{static_cast<double>(machine_.now_fs()) * 1e-12, word(kServoCount).x, cpu.cycle(), cpu.slept()};
  constexpr double kLeast = 20;  // ms
  if (now.ms - last_.ms >= kLeast) {
    servo_khz_ = ((now.servo_count - last_.servo_count) & 0xFFFFFF) / (now.ms - last_.ms);
    if (now.cycle > last_.cycle)
      asleep_ = static_cast<double>(now.slept - last_.slept) / static_cast<double>(now.cycle - last_.cycle);
    last_ = now;
  }
  const auto direction = static_cast<std::uint32_t>(variable(kI19));
  phase_cycles_ = static_cast<std::uint32_t>(call("phase_period", {}).value_or(0));
  servo_phases_ = static_cast<std::uint32_t>(variable(direction - kServoDividerBelowDirection) + 1);
  real_time_servos_ = static_cast<std::uint32_t>(variable(kI8) + 1);
}

json Snapshot::clocks() {
  const double cpu_mhz = 1e9 / static_cast<double>(machine_.cpu_period());
  const auto khz = [&](std::uint32_t cycles) { return cycles == 0 ? 0 : rounded(cpu_mhz * 1e3 / cycles); };
  return {{"i19", variable(kI19)},
          {"source", signal("clock.source")},
          {"phase_khz", khz(phase_cycles_)},
          {"servo_khz", khz(phase_cycles_ * servo_phases_)},
          {"counted_khz", rounded(servo_khz_)},
          {"i10", variable(kI10)},
          {"i52", variable(kI52)},
          {"cpu_mhz", rounded(cpu_mhz)}};
}

// Durations and loads as the controller has them, firmware:8.1: a duration, in half CPU cycles, is from interrupt to
// return; a load is the share of the task itself, without those that interrupted it.
json Snapshot::tasks() {
  const Word pair = word(kTasks), real_time = word(kRealTime);
  const double us = static_cast<double>(machine_.cpu_period()) * 1e-9;
  const std::uint32_t phase_period = phase_cycles_ / 2, servo_period = phase_period * servo_phases_;
  const auto task = [&](std::uint32_t halves, std::int64_t own, std::int64_t period) {
    return json{
        {"us", rounded(2 * halves * us)},
        {"load",
         period == 0 ? 0 : rounded(static_cast<double>(std::max<std::int64_t>(own, 0)) / static_cast<double>(period))}};
  };
  const std::int64_t phase = pair.x, servo = pair.y, longest = real_time.x;
  const auto times = [](std::int64_t span, std::uint32_t period) { return period == 0 ? 0 : span / period; };
  const std::int64_t servo_own = servo - times(servo, phase_period) * phase;
  const std::int64_t real_time_own =
      longest - times(longest, phase_period) * phase - times(longest, servo_period) * servo_own;
  return {{"phase", task(pair.x, phase, phase_period)},
          {"servo", task(pair.y, servo_own, servo_period)},
          {"real_time", task(real_time.x, real_time_own, std::int64_t{servo_period} * real_time_servos_)},
          {"real_time_longest_us", rounded(2 * real_time.y * us)},
          {"asleep", rounded(asleep_)}};
}

json Snapshot::watchdog() {
  const Word count = word(kWatchdog);
  const std::int32_t i40 = variable(kI40);
  constexpr std::int32_t kI40OfZero = 4095;
  return {{"count", signed_word(count.y)},
          {"lowest", signed_word(count.x)},
          {"reload", i40 == 0 ? kI40OfZero : i40},
          {"tripped", signal("watchdog.tripped")}};
}

// ------------------------------------------------------------------------------------------------------------ snapshot

json Snapshot::take() {
  image_.refresh();
  measure();
  const double cpu_mhz = 1e9 / static_cast<double>(machine_.cpu_period());
  const double servo_cycles = static_cast<double>(phase_cycles_) * servo_phases_;
  const double servo_khz = servo_cycles == 0 ? 0 : cpu_mhz * 1e3 / servo_cycles;
  const Word global = word(kGlobalStatus);
  json motors = json::array(), systems = json::array();
  std::uint32_t used = 1;  // coordinate system 1 is always shown
  const std::vector<unsigned> shown = shown_motors();
  for (auto at = samples_.begin(); at != samples_.end();)
    at = std::find(shown.begin(), shown.end(), at->first) == shown.end() ? samples_.erase(at) : std::next(at);
  for (const unsigned number : shown) {
    motors.push_back(motor(number, servo_khz));
    const std::uint32_t status2 = motors.back()["status"][1];
    if ((status2 & kAssigned) != 0) used |= 1u << (status2 >> kSystemShift & 0xF);
  }
  for (unsigned number = 1; number <= kSystems; ++number) {
    json one = (used >> (number - 1) & 1) != 0 || call("rotary_room", {number - 1}).value_or(0) != 0 ||
                       word(kSystemWords + kSystemStride * (number - 1) + kRotary).x != 0
                   ? system(number)
                   : json(nullptr);
    if (!one.is_null()) systems.push_back(std::move(one));
  }
  return {{"kind", "state"},
          {"ms", rounded(static_cast<double>(machine_.now_fs()) * 1e-12)},
          {"times", std::exchange(sample_times_, {})},
          {"motors", std::move(motors)},
          {"systems", std::move(systems)},
          {"global", {global.x, global.y}},
          {"request", request()},
          {"clocks", clocks()},
          {"tasks", tasks()},
          {"watchdog", watchdog()},
          {"watch", watch_.values()}};
}

}  // namespace brick
