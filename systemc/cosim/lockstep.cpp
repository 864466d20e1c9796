// Lock-step: both engines run the same stretch and leave a list of their pin changes; equal lists mean equal pins at every
// tick. The model goes first because it knows the stopping edge cheaply.
#include <fmt/format.h>

#include <algorithm>
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

// What was seen on Port A and on the host bus, for the report. Each side has its own list, and equal accesses in a row are
// one line of it: a host that polls a status register must not push the interesting lines out.
class AccessLog {
 public:
  void inputs_changed(Tick now, const BoardInputs& from, const BoardInputs& to) {
    strobe(cpu_, now, from.pa_wr_n, to.pa_wr_n,
           [&] { return fmt::format("CPU  write {} = ${:06X} AA={:X}", cpu_address(to), to.pa_wdata, to.pa_aa); });
    strobe(cpu_, now, from.pa_rd_n, to.pa_rd_n, [&] { return fmt::format("CPU  read  {} AA={:X}", cpu_address(to), to.pa_aa); });
    strobe(host_, now, from.isa_iow_n, to.isa_iow_n, [&] { return fmt::format("host I/O write {:05X} = {:04X}", to.isa_sa, to.isa_sd); });
    strobe(host_, now, from.isa_ior_n, to.isa_ior_n, [&] { return fmt::format("host I/O read  {:05X}", to.isa_sa); });
    strobe(host_, now, from.isa_memw_n, to.isa_memw_n, [&] { return fmt::format("host mem write {:05X} = {:04X}", to.isa_sa, to.isa_sd); });
    strobe(host_, now, from.isa_memr_n, to.isa_memr_n, [&] { return fmt::format("host mem read  {:05X}", to.isa_sa); });
    if (from.rst_n != to.rst_n) add(cpu_, now, to.rst_n ? "reset released" : "reset");
  }
  std::string text() const {
    std::vector<Line> all(cpu_.begin(), cpu_.end());
    all.insert(all.end(), host_.begin(), host_.end());
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
  Lines cpu_, host_;
};

class LockstepBoard : public Board {
 public:
  LockstepBoard(std::unique_ptr<Board> rtl, std::unique_ptr<Board> model) : rtl_(std::move(rtl)), model_(std::move(model)) {
    rtl_->on_change = [this](Tick t, const BoardOutputs&, const BoardOutputs& after) { rtl_changes_.push_back({t, after}); };
    model_->on_change = [this](Tick t, const BoardOutputs&, const BoardOutputs& after) { model_changes_.push_back({t, after}); };
    if (rtl_->outputs() != model_->outputs()) fail(rtl_->now(), rtl_->outputs(), model_->outputs());
    outputs_ = model_->outputs();
  }

  Tick now() const override { return rtl_->now(); }
  const BoardOutputs& outputs() const override { return outputs_; }
  void set_inputs(const BoardInputs& inputs) override {
    log_.inputs_changed(now(), inputs_, inputs);
    inputs_ = inputs;
    rtl_->set_inputs(inputs);
    model_->set_inputs(inputs);
  }
  Tick quiet_until(const BoardOutputs& watched) const override { return model_->quiet_until(watched); }

  Tick run_until(Tick limit, const BoardOutputs& stop_on) override {
    while (now() < limit) {
      const Tick target = std::min(limit, now() + kStretch);
      rtl_changes_.clear();
      model_changes_.clear();
      const Tick end = model_->run_until(target, stop_on);
      rtl_->run_until(end);
      if (rtl_changes_ != model_changes_) report();
      bool stopped = false;
      for (const Change& c : rtl_changes_) {
        const BoardOutputs before = outputs_;
        outputs_ = c.after;
        if (on_change) on_change(c.tick, before, outputs_);
        stopped = before.differs(outputs_, stop_on);
      }
      if (stopped) break;
    }
    return now();
  }

 private:
  [[noreturn]] void report() const {
    std::size_t i = 0;
    const std::size_t common = std::min(rtl_changes_.size(), model_changes_.size());
    while (i < common && rtl_changes_[i] == model_changes_[i]) ++i;
    // outputs_ still stands before the stretch.
    BoardOutputs rtl = i > 0 ? rtl_changes_[i - 1].after : outputs_;
    BoardOutputs model = rtl;
    const Tick rtl_tick = i < rtl_changes_.size() ? rtl_changes_[i].tick : kNever;
    const Tick model_tick = i < model_changes_.size() ? model_changes_[i].tick : kNever;
    const Tick tick = std::min(rtl_tick, model_tick);
    if (rtl_tick == tick) rtl = rtl_changes_[i].after;
    if (model_tick == tick) model = model_changes_[i].after;
    fail(tick, rtl, model);
  }
  [[noreturn]] void fail(Tick tick, const BoardOutputs& rtl, const BoardOutputs& model) const {
    const TimeFs time = tick_to_fs(tick);
    std::string text =
        fmt::format("lock-step: RTL and SystemC model differ at tick {} ({}.{:06} ns)", tick, time / kFsPerNs, time % kFsPerNs);
    for (const PinField& f : pin::kAll) {
      if (rtl.get(f) == model.get(f)) continue;
      if (f.hex)
        text +=
            fmt::format("\n  {}: rtl ${:0{}X}, systemc ${:0{}X}", f.name, rtl.get(f), (f.width + 3) / 4, model.get(f), (f.width + 3) / 4);
      else
        text += fmt::format("\n  {}: rtl {}, systemc {}", f.name, rtl.get(f), model.get(f));
    }
    throw LockstepDifference(text + "\nlast bus accesses:" + log_.text());
  }

  std::unique_ptr<Board> rtl_, model_;
  std::vector<Change> rtl_changes_, model_changes_;
  BoardInputs inputs_;
  BoardOutputs outputs_;
  AccessLog log_;
};

}  // namespace

std::unique_ptr<Board> make_lockstep_board(std::unique_ptr<Board> rtl, std::unique_ptr<Board> model) {
  return std::make_unique<LockstepBoard>(std::move(rtl), std::move(model));
}

}  // namespace brick
