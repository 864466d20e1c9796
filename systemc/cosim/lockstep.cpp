// Lock-step: both engines run the same stretch and leave a list of their pin changes; equal lists mean equal pins at
// every tick. The model goes first because it knows the stopping edge cheaply.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include "systemc/cosim/engines.h"

namespace brick {

namespace {

constexpr Tick kStretch = 65536;           // bounds the length of the lists
constexpr std::size_t kAccessesShown = 8;  // of each side

struct Change {
  Tick tick;
  BoardOutputs after;
  bool operator==(const Change& o) const { return tick == o.tick && after == o.after; }
};
struct MotorChange {
  Tick tick;
  unsigned ic;
  MotorOutputs after;
  bool operator==(const MotorChange& o) const { return tick == o.tick && ic == o.ic && after == o.after; }
};
using Motors = std::array<MotorOutputs, kMaxServoIcs>;

// Index of the first entry that the two lists do not share.
template <class T>
std::size_t first_difference(const std::vector<T>& a, const std::vector<T>& b) {
  return static_cast<std::size_t>(
      std::mismatch(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.size(), b.size())), b.begin()).first -
      a.begin());
}
template <class T>
Tick tick_at(const std::vector<T>& list, std::size_t i) {
  return i < list.size() ? list[i].tick : kNever;
}

// What was seen on Port A and on the host bus, for the report. Each side has its own list, and equal accesses in a row
// are one line of it: a host that polls a status register must not push the interesting lines out.
class AccessLog {
 public:
  void inputs_changed(Tick now, const BoardInputs& from, const BoardInputs& to) {
    strobe(cpu_, now, from.pa_wr_n, to.pa_wr_n,
           [&] { return fmt::format("CPU  write {} = ${:06X} AA={:X}", cpu_address(to), to.pa_wdata, to.pa_aa); });
    strobe(cpu_, now, from.pa_rd_n, to.pa_rd_n,
           [&] { return fmt::format("CPU  read  {} AA={:X}", cpu_address(to), to.pa_aa); });
    strobe(host_, now, from.isa_iow_n, to.isa_iow_n,
           [&] { return fmt::format("host I/O write {:05X} = {:04X}", to.isa_sa, to.isa_sd); });
    strobe(host_, now, from.isa_ior_n, to.isa_ior_n, [&] { return fmt::format("host I/O read  {:05X}", to.isa_sa); });
    strobe(host_, now, from.isa_memw_n, to.isa_memw_n,
           [&] { return fmt::format("host mem write {:05X} = {:04X}", to.isa_sa, to.isa_sd); });
    strobe(host_, now, from.isa_memr_n, to.isa_memr_n, [&] { return fmt::format("host mem read  {:05X}", to.isa_sa); });
    if (from.rst_n != to.rst_n) add(cpu_, now, to.rst_n ? "reset released" : "reset");
  }
  // Encoders may move often: nothing is made text before it is shown.
  void motor_changed(Tick now, unsigned ic, const MotorInputs& to) {
    motors_.push_back({now, ic, to});
    if (motors_.size() > kAccessesShown) motors_.pop_front();
  }
  std::string text() const {
    std::vector<Line> all(cpu_.begin(), cpu_.end());
    all.insert(all.end(), host_.begin(), host_.end());
    for (const auto& [tick, ic, in] : motors_)
      all.push_back({tick, tick, 1,
                     fmt::format("motor pins {} = {:03X} {:03X} {:03X} {:03X}, ADC {:X} {:X}", servo_ic_scope(ic),
                                 in.pins[0], in.pins[1], in.pins[2], in.pins[3], in.adc_a, in.adc_b)});
    std::stable_sort(all.begin(), all.end(), [](const Line& a, const Line& b) { return a.last < b.last; });
    std::string out;
    for (const Line& line : all) {
      out += fmt::format("\n  tick {:>12}  {}", line.last, line.what);
      if (line.times > 1) out += fmt::format(", {} times since tick {}", line.times, line.first);
    }
    return out.empty() ? " none" : out;
  }

 private:
  struct Line {
    Tick first, last;
    unsigned times;
    std::string what;
  };
  using Lines = std::deque<Line>;

  static std::string cpu_address(const BoardInputs& in) {
    if (in.pa_int) return fmt::format("on-chip peripheral {:02X}", in.pa_addr);
    return fmt::format("{}:${:06X}", in.pa_x ? 'X' : 'Y', in.pa_addr);
  }
  template <class Text>
  static void strobe(Lines& lines, Tick now, bool from, bool to, Text text) {
    if (from && !to) add(lines, now, text());
  }
  static void add(Lines& lines, Tick tick, std::string what) {
    if (!lines.empty() && lines.back().what == what) {
      lines.back().last = tick;
      ++lines.back().times;
      return;
    }
    lines.push_back({tick, tick, 1, std::move(what)});
    if (lines.size() > kAccessesShown) lines.pop_front();
  }
  struct Motor {
    Tick tick;
    unsigned ic;
    MotorInputs in;
  };
  Lines cpu_, host_;
  std::deque<Motor> motors_;
};

class LockstepBoard : public Board {
 public:
  LockstepBoard(std::unique_ptr<Board> rtl, std::unique_ptr<Board> model)
      : rtl_(std::move(rtl)), model_(std::move(model)) {
    rtl_->on_change = [this](Tick t, const BoardOutputs&, const BoardOutputs& after) {
      rtl_changes_.push_back({t, after});
    };
    model_->on_change = [this](Tick t, const BoardOutputs&, const BoardOutputs& after) {
      model_changes_.push_back({t, after});
    };
    rtl_->on_motor_change = [this](Tick t, unsigned ic, const MotorOutputs&, const MotorOutputs& after) {
      rtl_motors_.push_back({t, ic, after});
    };
    model_->on_motor_change = [this](Tick t, unsigned ic, const MotorOutputs&, const MotorOutputs& after) {
      model_motors_.push_back({t, ic, after});
    };
    for (Board* b : {rtl_.get(), model_.get()}) b->watch_motors(~0u);
    Motors rtl_pins;
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
      rtl_pins[ic] = rtl_->motor_outputs(ic);
      motors_[ic] = model_->motor_outputs(ic);
    }
    if (rtl_->outputs() != model_->outputs() || rtl_pins != motors_)
      fail(rtl_->now(), differences(rtl_->outputs(), model_->outputs()) + differences(rtl_pins, motors_));
    outputs_ = model_->outputs();
  }

  Tick now() const override { return rtl_->now(); }
  const BoardOutputs& outputs() const override { return outputs_; }
  BoardOutputs port_a_at_once() const override {
    const BoardOutputs rtl = rtl_->port_a_at_once(), model = model_->port_a_at_once();
    if (rtl != model) fail(now(), differences(rtl, model));
    return model;
  }
  std::optional<std::uint16_t> dpram_word(unsigned index) const override {
    const auto rtl = rtl_->dpram_word(index), model = model_->dpram_word(index);
    if (rtl && model && *rtl != *model)
      fail(now(), line(fmt::format("word {} of the dual-ported RAM", index), 16, true, *rtl, *model));
    return model;
  }
  void set_inputs(const BoardInputs& inputs) override {
    log_.inputs_changed(now(), inputs_, inputs);
    inputs_ = inputs;
    rtl_->set_inputs(inputs);
    model_->set_inputs(inputs);
  }
  Tick quiet_until(const BoardOutputs& watched) const override { return model_->quiet_until(watched); }

  void set_motor_inputs(unsigned ic, const MotorInputs& inputs) override {
    log_.motor_changed(now(), ic, inputs);
    rtl_->set_motor_inputs(ic, inputs);
    model_->set_motor_inputs(ic, inputs);
  }
  MotorOutputs motor_outputs(unsigned ic) const override { return ic < kMaxServoIcs ? motors_[ic] : MotorOutputs{}; }
  void watch_motor(unsigned ic, const MotorOutputs& select) override {
    if (ic < kMaxServoIcs) watched_[ic] = select;
  }
  void stop_on_motor(unsigned ic, const MotorOutputs& select) override {
    if (ic >= kMaxServoIcs) return;
    stop_[ic] = select;
    model_->stop_on_motor(ic, select);
  }

  Tick run_until(Tick limit, const BoardOutputs& stop_on) override {
    while (now() < limit) {
      const Tick target = std::min(limit, now() + kStretch);
      rtl_changes_.clear();
      model_changes_.clear();
      rtl_motors_.clear();
      model_motors_.clear();
      const Tick end = model_->run_until(target, stop_on);
      rtl_->run_until(end);
      if (rtl_changes_ != model_changes_ || rtl_motors_ != model_motors_) report();
      if (deliver(stop_on)) break;
    }
    return now();
  }

 private:
  // Hands the changes of the stretch on, edge by edge: the board's pins first. Says whether the run was to end with the
  // last one.
  bool deliver(const BoardOutputs& stop_on) {
    bool stopped = false;
    std::size_t i = 0, k = 0;
    while (i < rtl_changes_.size() || k < rtl_motors_.size()) {
      if (tick_at(rtl_changes_, i) <= tick_at(rtl_motors_, k)) {
        const Change& c = rtl_changes_[i++];
        const BoardOutputs before = outputs_;
        outputs_ = c.after;
        if (on_change) on_change(c.tick, before, outputs_);
        stopped |= before.differs(outputs_, stop_on);
      } else {
        const MotorChange& c = rtl_motors_[k++];
        const MotorOutputs &watched = watched_[c.ic], before = motors_[c.ic] & watched, after = c.after & watched;
        motors_[c.ic] = c.after;
        if (before == after) continue;
        if (on_motor_change) on_motor_change(c.tick, c.ic, before, after);
        stopped |= before.differs(after, stop_[c.ic]);
      }
    }
    return stopped;
  }

  // outputs_ and motors_ still stand before the stretch.
  [[noreturn]] void report() const {
    const std::size_t i = first_difference(rtl_changes_, model_changes_),
                      k = first_difference(rtl_motors_, model_motors_);
    const Tick tick = std::min(std::min(tick_at(rtl_changes_, i), tick_at(model_changes_, i)),
                               std::min(tick_at(rtl_motors_, k), tick_at(model_motors_, k)));
    fail(tick, differences(at(tick, rtl_changes_), at(tick, model_changes_)) +
                   differences(at(tick, rtl_motors_), at(tick, model_motors_)));
  }
  // What one engine showed after the edge `tick`.
  BoardOutputs at(Tick tick, const std::vector<Change>& changes) const {
    BoardOutputs out = outputs_;
    for (std::size_t i = 0; tick_at(changes, i) <= tick && i < changes.size(); ++i) out = changes[i].after;
    return out;
  }
  Motors at(Tick tick, const std::vector<MotorChange>& changes) const {
    Motors out = motors_;
    for (std::size_t i = 0; tick_at(changes, i) <= tick && i < changes.size(); ++i)
      out[changes[i].ic] = changes[i].after;
    return out;
  }
  static std::string differences(const BoardOutputs& rtl, const BoardOutputs& model) {
    std::string text;
    for (const PinField& f : pin::kAll)
      if (rtl.get(f) != model.get(f)) text += line(f.name, f.width, f.hex, rtl.get(f), model.get(f));
    return text;
  }
  static std::string differences(const Motors& rtl, const Motors& model) {
    std::string text;
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      for (unsigned n = 0; n < kChannels; ++n)
        for (const MotorField& f : motor_pin::kAll) {
          const std::uint32_t r = rtl[ic].get(f, n), m = model[ic].get(f, n);
          if (r == m || (f.shared && n > 0)) continue;
          text += line(fmt::format("{}.ch{}.{}", servo_ic_scope(ic), n + 1, f.name), f.width, f.width > 1, r, m);
        }
    return text;
  }
  static std::string line(std::string_view name, unsigned width, bool hex, std::uint32_t rtl, std::uint32_t model) {
    if (!hex) return fmt::format("\n  {}: rtl {}, systemc {}", name, rtl, model);
    return fmt::format("\n  {}: rtl ${:0{}X}, systemc ${:0{}X}", name, rtl, (width + 3) / 4, model, (width + 3) / 4);
  }
  [[noreturn]] void fail(Tick tick, const std::string& differences) const {
    const TimeFs time = tick_to_fs(tick);
    throw LockstepDifference(
        fmt::format("lock-step: RTL and SystemC model differ at tick {} ({}.{:06} ns){}\nlast bus accesses:{}", tick,
                    time / kFsPerNs, time % kFsPerNs, differences, log_.text()));
  }

  std::unique_ptr<Board> rtl_, model_;
  std::vector<Change> rtl_changes_, model_changes_;
  std::vector<MotorChange> rtl_motors_, model_motors_;
  BoardInputs inputs_;
  BoardOutputs outputs_;
  Motors motors_, stop_{}, watched_{};
  AccessLog log_;
};

}  // namespace

std::unique_ptr<Board> make_lockstep_board(std::unique_ptr<Board> rtl, std::unique_ptr<Board> model) {
  return std::make_unique<LockstepBoard>(std::move(rtl), std::move(model));
}

}  // namespace brick
