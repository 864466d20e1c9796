// The serial encoder inputs by themselves: Verilated RTL or model, one tick at a time. `geo`, a strap, counts from the
// next reset on.
#include "testbench/unit/ssi/ssi_rig.h"
#include "testbench/unit/vectors/device.h"

namespace brick {
namespace {

constexpr unsigned kSsiChannels = 8;
// Places among the signals: inputs first.
enum : unsigned { kGeo, kPhase, kServo, kData, kClk = kData + kSsiChannels, kAll = kClk + kSsiChannels };

template <class Rig>
class SsiDevice : public Device {
 public:
  SsiDevice() : values_(kAll, 1) { values_[kGeo] = 0; }
  const std::vector<DeviceSignal>& signals() const override { return signals_; }
  Tick now() const override { return rig_.now(); }
  std::uint32_t value(unsigned signal) const override { return values_[signal]; }

  void reset() override {
    rig_.reset(values_[kGeo] != 0);
    for (unsigned i = kPhase; i < kAll; ++i) change(i, 1);
    run_to_ref();
  }
  void run(Tick ticks) override {
    for (; ticks > 0; --ticks) {
      rig_.tick();
      for (unsigned n = 0; n < kSsiChannels; ++n) change(kClk + n, rig_.clk() >> n & 1);
    }
  }
  void run_towards_change(unsigned, Tick limit) override {
    if (now() < limit) run(1);
  }
  void drive(unsigned signal, std::uint32_t value) override {
    change(signal, value & 1);
    unsigned data = 0;
    for (unsigned n = 0; n < kSsiChannels; ++n) data |= values_[kData + n] << n;
    rig_.nets(values_[kPhase] != 0, values_[kServo] != 0);
    rig_.data(data);
  }
  void write(bool x, unsigned addr, std::uint32_t value) override {
    rig_.begin({true, x, addr, value});
    run_to_ref();
  }
  std::uint32_t read(bool x, unsigned addr) override {
    rig_.begin({false, x, addr, 0});
    run_to_ref();
    return rig_.taken();
  }
  std::string command(const std::string&) override { throw DeviceError("the serial inputs take no commands"); }

 private:
  void run_to_ref() {
    do run(1);
    while (now() % kTicksPerRef != 0);
  }
  void change(unsigned signal, std::uint32_t value) {
    if (values_[signal] == value) return;
    values_[signal] = value;
    if (on_change) on_change(now(), signal, value);
  }

  Rig rig_;
  std::vector<DeviceSignal> signals_ = ssi_signals();
  std::vector<std::uint32_t> values_;
};

}  // namespace

std::vector<DeviceSignal> ssi_signals() {
  std::vector<DeviceSignal> all{{"geo", true}, {"clock.phase", true}, {"clock.servo", true}};
  for (unsigned n = 1; n <= kSsiChannels; ++n) all.push_back({"ch" + std::to_string(n) + ".data", true});
  for (unsigned n = 1; n <= kSsiChannels; ++n) all.push_back({"ch" + std::to_string(n) + ".clk", false});
  return all;
}

std::unique_ptr<Device> make_ssi(bool rtl) {
  if (rtl) return std::make_unique<SsiDevice<RtlSsiRig>>();
  return std::make_unique<SsiDevice<ModelSsiRig>>();
}

}  // namespace brick
