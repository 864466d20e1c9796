// A host with motors at the controller: stands a plant at the channels, sets motors up by commands, and looks at each
// of them whenever the servo task has ended: the commanded and the actual position in its memory words (firmware:1.10),
// what it wrote to its output, where the motor stands, and its amplifier enable at the pin. What the benches of motion
// share.
#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <optional>

#include "systemc/machine/motor_peer.h"
#include "testbench/benches/servo_host.h"
#include "testbench/plant/plant.h"

namespace brick {

struct PortACycle;

constexpr double kTicksPerMs = kPwmClockHz / 1000.0;

// A small motor whose amplifier takes +-10 V as +-1 N m, 4000 counts a turn: one bit of 16 makes 1943 counts/s^2.
plant::AxisParameters dac_axis();
template <std::size_t kCount>
std::vector<plant::AxisParameters> dac_axes() {
  return std::vector<plant::AxisParameters>(kCount, dac_axis());
}

class MotorHost : public ServoHost, public MotorPeer {
 public:
  static constexpr double kUnits = 32 * 96;  // of a count in a position word, Ixx08 = 96

  struct Sample {  // as a servo task left them
    Tick tick;
    double commanded, actual;  // counts
    double output;             // word of OUT A in bits of 16
    double turned;             // where the plant stands, counts
    bool enabled;              // AENA
  };
  struct Enable {
    Tick tick;
    bool on;
  };

  // As many motors as the bench brings along, at the first channels (Bench::motors).
  explicit MotorHost(BenchContext& bench);
  ~MotorHost() override;

  unsigned motors() const { return motors_; }
  plant::Axis& axis(unsigned motor) { return plant_->axis(motor - 1); }
  int dac(unsigned motor) { return plant_->dac(ic((motor - 1) / kChannels)).value((motor - 1) % kChannels); }
  double turned(unsigned motor) { return static_cast<double>(axis(motor).position(now())) / plant::kUnitsPerCount; }

  // Motors are numbered from 1. `Ixx11=32000` for each motor: variables(11, 32000).
  void variables(unsigned k, double value);
  void set_up();                             // channels, conversion table, gains and limits of these motors
  void close_all();                          // J/ to each
  double period() const { return period_; }  // of a servo cycle in ms, as I10 has it
  void wait_ms(double ms) { wait(ns_to_ticks(static_cast<std::uint64_t>(ms * 1e6))); }

  // Samples since record(). settle() goes on until no motor's commanded position has moved for `still` ms.
  void record();
  const std::vector<Sample>& samples(unsigned motor) const { return samples_.at(motor - 1); }
  bool settle(double at_most_ms, double still_ms = 5);
  const std::vector<Enable>& enables(unsigned motor) const { return enables_.at(motor - 1); }
  std::optional<std::uint32_t> captured(unsigned motor) const {
    return captured_.at(motor - 1);
  }                                                    // read since record()
  Tick disabled_at(unsigned motor, Tick after) const;  // first fall of AENA at or after, -1: none

  // Words of the motor that are not sampled, straight out of the memory.
  std::uint32_t x(std::uint32_t address) { return word_at(address, 4); }
  std::uint32_t y(std::uint32_t address) { return word_at(address, 0); }
  std::int64_t d(std::uint32_t address);
  std::string status(unsigned motor) { return ask("#" + std::to_string(motor) + "?"); }
  bool status_bit(unsigned motor, unsigned word, unsigned bit);  // word 1 or 2 of `?`

  // How far the samples are from a path. It begins at an instant within the servo cycles before the first sample that
  // shows it, where the motor is then: `make` gets that position. `velocity` is what the motor has until then, counts a
  // ms; looked for behind sample `from`.
  using Path = std::function<double(double)>;  // counts over ms since its start
  struct Fit {
    double worst = 1e9, at = 0;  // counts; ms since the start
    double begin = 0, end = 0;   // start and end of the path, ms since the first sample
    std::size_t moving = 0;      // samples between them
  };
  Fit fit(unsigned motor, const std::function<Path(double)>& make, double duration, std::size_t from = 0,
          double velocity = 0) const;
  // First sample behind `from` that shows another velocity than the two before it.
  std::optional<std::size_t> departs(unsigned motor, std::size_t from = 0) const;
  std::size_t last(unsigned motor) const { return samples(motor).size() - 1; }

  std::uint32_t ics() const override;
  Tick next_event() const override { return kNever; }
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) override;
  bool step(Tick, MotorInputPins&) override { return false; }

 private:
  virtual void looked() {}  // behind each sample
  std::uint32_t word_at(std::uint32_t address, unsigned byte);
  void look();
  void task_changed(TimeFs time);
  void cycle(const PortACycle& c);

  unsigned motors_;
  plant::Plant* plant_;
  double period_ = 0;
  bool in_servo_ = false;
  TimeFs left_ = 0;
  std::vector<std::uint32_t> output_;  // last word written to OUT A
  std::vector<std::optional<std::uint32_t>> captured_;
  std::vector<std::vector<Sample>> samples_;
  std::vector<std::vector<Enable>> enables_;
  std::function<void(TimeFs)> on_task_;
};

// A step for a fit: within a sixteenth of a count at each of `least` servo interrupts or more.
void report_fit(BenchReport& report, const std::string& name, const MotorHost::Fit& fit, std::size_t least);

}  // namespace brick
