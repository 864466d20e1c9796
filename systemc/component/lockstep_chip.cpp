#include "systemc/component/lockstep_chip.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "systemc/component/error.h"

namespace brick::component {
namespace {

class LockstepChip final : public Chip {
 public:
  LockstepChip(std::string name, std::unique_ptr<Chip> rtl, std::unique_ptr<Chip> model,
               const std::vector<PinInfo>& table)
      : name_(std::move(name)),
        rtl_(std::move(rtl)),
        model_(std::move(model)),
        table_(table),
        watched_(rtl_->outputs().size()),
        before_(watched_.size()) {
    const PinWords all(watched_.size(), ~0u);
    rtl_->watch(all);
    model_->watch(all);
  }

  Tick now() const override { return rtl_->now(); }
  const PinWords& outputs() const override { return rtl_->outputs(); }
  void watch(const PinWords& outputs) override { watched_ = outputs; }
  void set_inputs(const PinWords& inputs) override {
    rtl_->set_inputs(inputs);
    model_->set_inputs(inputs);
  }

  bool run_until(Tick limit) override {
    while (now() < limit) {
      before_ = rtl_->outputs();
      const bool rtl = rtl_->run_until(std::min({limit, model_->quiet_until(), kNever - 1}) +
                                       (model_->quiet_until() < limit ? 1 : 0));
      while (model_->now() < now())
        if (model_->run_until(now()) && model_->now() < now()) fail(model_->now(), before_);
      compare();
      if (end_cycles() || (rtl && differ(rtl_->outputs(), before_, watched_))) return true;
    }
    return false;
  }
  Tick quiet_until() const override { return model_->quiet_until(); }

  void begin(unsigned face, const Cycle& cycle) override {
    rtl_->begin(face, cycle);
    model_->begin(face, cycle);
    under_way_.emplace_back(face, cycle);
  }
  void abandon(unsigned face) override {
    rtl_->abandon(face);
    model_->abandon(face);
    under_way_.erase(
        std::remove_if(under_way_.begin(), under_way_.end(), [face](const auto& c) { return c.first == face; }),
        under_way_.end());
  }
  bool busy(unsigned face) const override { return rtl_->busy(face); }
  std::uint32_t value(unsigned face) const override { return rtl_->value(face); }
  Tick no_end_until() const override { return model_->no_end_until(); }
  std::uint32_t peek(unsigned face, unsigned address) override {
    const std::uint32_t rtl = rtl_->peek(face, address);
    same_word(address, rtl, model_->peek(face, address));
    return rtl;
  }

 private:
  void compare() const {
    if (rtl_->outputs() != model_->outputs()) fail(now(), rtl_->outputs());
  }
  // Cycles end at one edge and read the same; true if one has.
  bool end_cycles() {
    bool ended = false;
    for (auto c = under_way_.begin(); c != under_way_.end();) {
      const auto& [face, cycle] = *c;
      if (rtl_->busy(face) != model_->busy(face)) {
        std::ostringstream text;
        text << "\n  access at byte " << cycle.address << ": ended with " << (rtl_->busy(face) ? "systemc" : "rtl")
             << " alone";
        report(now(), text.str());
      }
      if (rtl_->busy(face)) {
        ++c;
        continue;
      }
      if (!cycle.write) same_word(cycle.address, rtl_->value(face), model_->value(face));
      c = under_way_.erase(c);
      ended = true;
    }
    return ended;
  }
  void same_word(unsigned address, std::uint32_t rtl, std::uint32_t model) const {
    if (rtl == model) return;
    std::ostringstream text;
    text << "\n  register at byte " << address << std::hex << std::uppercase << ": rtl $" << rtl << ", systemc $"
         << model;
    report(now(), text.str());
  }
  [[noreturn]] void fail(Tick tick, const PinWords& rtl) const {
    std::ostringstream text;
    for (const PinInfo& info : table_) {
      if (info.direction == PinDirection::kIn) continue;
      const auto value = [&info](const PinWords& words) {
        return words[info.word] >> info.lsb & (info.width >= 32 ? ~0u : (1u << info.width) - 1);
      };
      if (value(rtl) != value(model_->outputs()))
        text << "\n  " << info.name << ": rtl " << value(rtl) << ", systemc " << value(model_->outputs());
    }
    report(tick, text.str());
  }
  [[noreturn]] void report(Tick tick, const std::string& differences) const {
    const TimeFs time = tick_to_fs(tick);
    std::ostringstream text;
    text << name_ << ": RTL and SystemC model differ at tick " << tick << " (" << fs_to_ns(time) << " ns)"
         << differences;
    raise_error("/brick/lockstep", text.str());
  }

  std::string name_;
  std::unique_ptr<Chip> rtl_, model_;
  const std::vector<PinInfo>& table_;
  PinWords watched_, before_;
  std::vector<std::pair<unsigned, Cycle>> under_way_;  // by face
};

}  // namespace

std::unique_ptr<Chip> lockstep_chip(std::string name, std::unique_ptr<Chip> rtl, std::unique_ptr<Chip> model,
                                    const std::vector<PinInfo>& table) {
  return std::make_unique<LockstepChip>(std::move(name), std::move(rtl), std::move(model), table);
}

}  // namespace brick::component
