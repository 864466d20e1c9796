// servo-loop: motors closed over encoder and DAC, each with gains of its own. Judged by the model of motion:1.1 in
// double precision (testbench/checkers/position_loop_model.h), fed with the positions that the loop saw, output by
// output; by the distance that the motor keeps from where it is told to be; and at the DAC.
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/position_loop_model.h"

namespace brick {
namespace {

constexpr double kMoving = 20, kResting = 1;  // counts of following error at 32 counts/ms, and at rest
constexpr int kDistance = 1600;
constexpr double kTelling = 1;  // bits of 16

class ServoLoop {
 public:
  explicit ServoLoop(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  double pick(double from, double to) { return from + (to - from) * host_.pick(1001) / 1000; }
  double pick_whole(double from, double to) { return std::floor(pick(from, to)); }

  void choose_gains();
  void tell_gains(unsigned motor);
  void jog();
  void judge_errors();
  void judge_outputs(unsigned motor);
  void judge_dac();
  void open_loop();

  MotorHost host_;
  std::vector<LoopGains> gains_;
};

// Motor 1 is the reference, tuned as MotorHost::set_up() leaves it. The others have what makes the loop's other terms
// count.
void ServoLoop::choose_gains() {
  LoopGains g;
  g.p = 112450, g.d = 2900, g.vff = 2972, g.i = 37000, g.aff = 16320, g.limit = 32767;
  g.friction = 16;  // 5e-4 of 1 N m
  gains_.assign(host_.motors(), g);
  if (host_.motors() < 4) return;
  LoopGains& notch = gains_[1];
  notch.p = 60000;
  const double zeros = pick(0.6, 0.95), poles = pick(0.2, 0.6), angle = pick(0.4, 1.2);
  const auto stored = [](double value) { return std::round(value * 4096) / 4096; };  // exact in 22 bits and in decimal
  notch.notch = {stored(-2 * zeros * std::cos(angle)), stored(zeros * zeros), stored(-2 * poles * std::cos(angle)),
                 stored(poles * poles)};
  LoopGains& band = gains_[2];
  band.deadband_gain = pick_whole(-16, 16), band.deadband = pick_whole(8, 40), band.friction = pick_whole(5, 30);
  band.bias = pick_whole(-40, 40), band.integrate_at_rest = false, band.i = 80000;
  LoopGains& limits = gains_[3];
  limits.limit = pick_whole(700, 1200), limits.limit_e = 16 * pick_whole(3, 8), limits.limit_i = 8;
  limits.i = 200000, limits.integrate_at_rest = false, limits.d = pick_whole(2500, 2900);
}

void ServoLoop::tell_gains(unsigned motor) {
  const LoopGains& g = gains_.at(motor - 1);
  std::vector<std::string> words;
  for (const auto& [k, value] : {std::pair{29u, g.bias},
                                 {30u, g.p},
                                 {31u, g.d},
                                 {32u, g.vff},
                                 {33u, g.i},
                                 {34u, g.integrate_at_rest ? 1.0 : 0.0},
                                 {35u, g.aff},
                                 {36u, g.notch[0]},
                                 {37u, g.notch[1]},
                                 {38u, g.notch[2]},
                                 {39u, g.notch[3]},
                                 {63u, g.limit_i},
                                 {64u, g.deadband_gain},
                                 {65u, g.deadband},
                                 {67u, g.limit_e},
                                 {68u, g.friction},
                                 {69u, g.limit}})
    words.push_back(fmt::format("I{}={:.12g}", 100 * motor + k, value));
  if (motor != 1) words.push_back(fmt::format("I{}11=0", motor));  // no matter how far the odd ones fall behind
  host_.say(words);
}

void ServoLoop::jog() {
  host_.variables(92, 3);
  host_.record();
  host_.wait_ms(2);
  host_.close_all();
  std::string line;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    // A load that the loops have to hold.
    host_.axis(motor).set_load(motor == 1 ? 0 : 0.004 * (static_cast<double>(host_.pick(11)) - 5));
    line += fmt::format("#{}J:{} ", motor, kDistance);
  }
  host_.expect(line, "");
  const bool rests = host_.settle(200, 15);
  report().step("commanded positions come to rest", rests, rests ? "" : "still moving after 200 ms");
}

void ServoLoop::judge_errors() {
  const auto& s = host_.samples(1);
  double moving = 0, resting = 0, fastest = 0;
  unsigned moved = 0;
  for (std::size_t i = 1; i < s.size(); ++i) {
    const double error = std::fabs(s[i].commanded - s[i].actual), step = s[i].commanded - s[i - 1].commanded;
    fastest = std::max(fastest, step / host_.period());
    if (step != 0) moving = std::max(moving, error), ++moved;
    if (s.size() - i < 10) resting = std::max(resting, error);
  }
  report().step(
      "reference motor at 32 counts/ms: following error", moved > 100 && moving <= kMoving && fastest > 31.9,
      fmt::format("{:.2f} counts at most on the way, expected up to {}; {:.2f} counts/ms, {} servo interrupts", moving,
                  kMoving, fastest, moved));
  report().step("reference motor at rest: following error", s.size() > 10 && resting <= kResting,
                fmt::format("{:.2f} counts, expected up to {}", resting, kResting));
  Comparison exact;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    const auto& of = host_.samples(motor);
    exact.equal(fmt::format("#{} commanded, units of 1/3072 count", motor),
                std::llround((of.back().commanded - of.front().commanded) * MotorHost::kUnits),
                kDistance * std::llround(MotorHost::kUnits));
  }
  report().step("commanded targets are exact", exact, host_.motors(), fmt::format("{} motors", host_.motors()));
}

void ServoLoop::judge_outputs(unsigned motor) {
  const auto& s = host_.samples(motor);
  const auto on = std::find_if(s.begin(), s.end(), [](const MotorHost::Sample& x) { return x.enabled; });
  Comparison compared;
  double worst = 0;
  if (s.end() - on > 2) {
    LoopGains gains = gains_.at(motor - 1);
    if (host_.bench().negative) gains.p *= 1.01;
    PositionLoopModel model(gains, on->commanded, on->actual);
    for (auto x = on + 1; x != s.end(); ++x) {
      const double expected = model.output(x->commanded, x->actual), off = std::fabs(x->output - expected);
      model.follow(x->output);
      worst = std::max(worst, off);
      compared.judged(fmt::format("closure {}, error {:.3f}", x - on, x->commanded - x->actual),
                      off <= kTelling ? "" : fmt::format("output {:.2f}, expected {:.2f}", x->output, expected));
    }
  }
  static constexpr const char* kNames[] = {"reference gains", "notch", "deadband, friction, bias",
                                           "limits of error, integrator, output"};
  report().step(fmt::format("output of the model, motor {}: {}", motor, kNames[motor - 1]), compared, 100,
                fmt::format("{} closures, {:.2f} bits off at most", compared.made(), worst));
}

// What the loop wrote comes out of the converter a phase period later: one of the last words of it.
void ServoLoop::judge_dac() {
  if (host_.bench().plant != nullptr) return;
  Comparison compared;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) {
    const auto& s = host_.samples(motor);
    const double at_pin = host_.dac(motor) / 4.0;  // of 18 bits
    const bool found = std::any_of(s.end() - std::min<std::ptrdiff_t>(3, s.end() - s.begin()), s.end(),
                                   [at_pin](const MotorHost::Sample& x) { return std::fabs(x.output - at_pin) < 0.3; });
    compared.judged(fmt::format("#{}", motor),
                    found ? "" : fmt::format("{:.2f}, expected {:.2f}", at_pin, s.empty() ? 0 : s.back().output));
  }
  report().step("output at the DAC", compared, host_.motors(), "bits of 16");
}

// O commands a part of Ixx69; K takes it away, but for Ixx29.
void ServoLoop::open_loop() {
  host_.variables(29, 7);
  host_.expect("#1O2.5", "");
  host_.wait_ms(2);
  const double output = host_.samples(1).back().output, expected = 0.025 * 32767 + 7;
  report().step("#1O2.5: output", std::fabs(output - expected) <= 1.01,
                fmt::format("{:.2f} of 32767, expected {:.2f} with Ixx29", output, expected));
  report().equal("#1O2.5: open loop in ?", host_.status_bit(1, 1, 18), true);
  host_.expect("#1K", "");
  host_.wait_ms(2);
  report().step("#1K: output", host_.samples(1).back().output == 7,
                fmt::format("{:.2f}, expected Ixx29 = 7", host_.samples(1).back().output));
  report().equal("#1K: AENA", int{host_.pin(motor_pin::kAena, 0) != 0}, 0);
}

void ServoLoop::run() {
  host_.set_up();
  choose_gains();
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) tell_gains(motor);
  jog();
  judge_errors();
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) judge_outputs(motor);
  judge_dac();
  open_loop();
}

}  // namespace

Bench servo_loop_bench() {
  return {"servo-loop",
          "motors closed over encoder and DAC: following error, targets, every output against the formula",
          {"the scoreboard is told that Ixx30 is a hundredth higher", "output of the model, motor 1: reference gains",
           "expected"},
          [](BenchContext& b) { ServoLoop(b).run(); },
          kAServoIc,
          dac_axes<4>};
}

}  // namespace brick
