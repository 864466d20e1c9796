// interrupts, on a board whose controller is an 8259: every source on every line gives its vector, by edge and by
// level; then random talk over the bus against a second description of the part (testbench/checkers/reference_8259.h),
// with three lines from outside and HREQ moving in between.
#include "testbench/benches/interrupt_host.h"
#include "testbench/checkers/reference_8259.h"

namespace brick {
namespace {

constexpr unsigned kBase = 0x08;
constexpr Tick kIrqAfter = 3 * kTicksPerRef, kSettled = 40;

class Interrupts8259 : public InterruptHost {
 public:
  using InterruptHost::InterruptHost;

  void run() {
    for (const bool level : {false, true}) {
      initialize(level);
      for (unsigned n = 0; n < kFixed.size(); ++n) fixed_line(n, level);
    }
    for (const unsigned source : sources()) chosen_lines(source);
    latency();
    Talked all;  // until chance has made enough of each
    for (unsigned round = 0; round < 100 && !all.enough(); ++round) talk(all);
    b.report.step("interrupts and polls at random", all.enough(),
                  fmt::format("{} and {}, {} and {} at least", all.acknowledged, all.polled, Talked::kAcknowledged,
                              Talked::kPolled));
  }

 private:
  void initialize(bool level) {
    b.bus.command_8259(level ? 0x1B : 0x13);
    b.bus.mask_8259(b.negative ? kBase + 8 : kBase);
    b.bus.mask_8259(0x01);
    b.bus.wait(kSettled);
  }
  std::string shown() { return fmt::format("INT={}", b.machine.outputs().get(pin::kIsaIrq)); }

  void fixed_line(unsigned n, bool level) {
    Comparison same;
    drive_fixed(n, true);
    b.bus.wait(kSettled);
    same.equal("rise", shown(), "INT=1");
    same.equal("vector", b.bus.acknowledge_8259(), kBase + n);
    b.bus.wait(kSettled);
    same.equal("in service", shown(), "INT=0");
    b.bus.command_8259(static_cast<std::uint8_t>(0x60 | n));
    b.bus.wait(kSettled);
    same.equal("after its end", shown(), level ? "INT=1" : "INT=0");
    drive_fixed(n, false);
    b.bus.wait(kSettled);
    same.equal("low", shown(), "INT=0");
    same.equal("default vector", b.bus.acknowledge_8259(), kBase + 7);
    b.report.step(fmt::format("IR{} {}, {}", n, kFixed[n], level ? "level" : "edge"), same, 6,
                  fmt::format("vector {:02X}", kBase + n));
  }

  // On all three lines at once, served from IR5 up.
  void chosen_lines(unsigned source) {
    Comparison same;
    select(source, source, source);
    initialize(false);
    drive(source, true);
    for (unsigned n = 5; n < 8; ++n) {
      same.equal("INT", shown(), "INT=1");
      same.equal("vector", b.bus.acknowledge_8259(), kBase + n);
      b.bus.command_8259(0x20);
      b.bus.wait(kSettled);
    }
    same.equal("all served", shown(), "INT=0");
    drive(source, false);
    b.report.step(fmt::format("IR5, IR6, IR7 from {}", kInterruptSources[source]), same, 7, "served in their order");
  }

  void latency() {
    select(kSourceMi1, 0, 0);
    initialize(false);
    Comparison same;
    for (Tick phase = 0; phase < kTicksPerRef; ++phase) {
      const Tick rise = (b.bus.now() / kTicksPerRef + 10) * kTicksPerRef + phase;
      const Tick sampled = (rise / kTicksPerRef + 1) * kTicksPerRef;
      play({{rise, [](HostInputs& in) { in.mi1 = true; }}});
      b.bus.wait_pin(pin::kIsaIrq, 1, 100);
      same.equal(fmt::format("phase {}: INT after the edge that samples the line", phase), b.bus.now() - sampled,
                 kIrqAfter - kTicksPerRef);
      b.bus.acknowledge_8259();
      b.bus.command_8259(0x20);
      drive(kSourceMi1, false);
    }
    b.report.step("INT at the third clock", same, 3, "at each phase of clk_ref");
  }

  // One operation after the other, as programs come to it, with all modes on the way.
  struct Talked {
    static constexpr unsigned kAcknowledged = 20, kPolled = 3;
    unsigned acknowledged = 0, polled = 0;
    bool enough() const { return acknowledged >= kAcknowledged && polled >= kPolled; }
  };
  void talk(Talked& all) {
    constexpr unsigned kOperations = 400;
    select(kSourceMi1, kSourceMi1 + 1, kSourceMi1 + 2);
    Reference8259 reference;
    Comparison same;
    unsigned acknowledged = 0, polled = 0, modes = 0;
    const auto command = [&](std::uint8_t byte) {
      b.bus.command_8259(byte);
      reference.write(false, byte);
    };
    const auto second = [&](std::uint8_t byte) {
      b.bus.mask_8259(byte);
      reference.write(true, byte);
    };
    for (unsigned i = 0; i < kOperations; ++i) {
      const unsigned what = i % 50 == 0 ? 0 : 1 + pick(9);
      switch (what) {
        case 0:
          command(pick(2) == 0 ? 0x13 : 0x1B);
          second(static_cast<std::uint8_t>(pick(32) << 3));
          second(pick(2) == 0 ? 0x01 : 0x03);
          ++modes;
          break;
        case 1:
          second(static_cast<std::uint8_t>(pick(2) == 0 ? pick(256) : 0));
          break;
        case 2:
          command(static_cast<std::uint8_t>((pick(8) << 5) | pick(8)));
          break;
        case 3:
          command(static_cast<std::uint8_t>(0x08 | (pick(256) & 0x67)));
          break;
        case 4:
        case 5: {
          const unsigned vector = b.bus.acknowledge_8259();
          acknowledged += reference.interrupts() ? 1 : 0;
          same.equal(fmt::format("operation {}, acknowledge", i), vector, reference.vector());
          break;
        }
        case 6: {
          const bool mask = pick(3) == 0;
          polled += reference.polls() ? 1 : 0;
          const unsigned byte = b.bus.io_read(mask ? HostBus::kMask8259 : HostBus::kCommand8259);
          same.equal(fmt::format("operation {}, read of {}", i, mask ? 9 : 8), byte, reference.read(mask));
          break;
        }
        default: {
          const unsigned n = pick(3);
          bool& line = b.machine.inputs().*kOutside[n];
          line = !line;
          b.machine.apply();
          reference.line(5 + n, line);
          break;
        }
      }
      b.bus.wait(kSettled);
      same.equal(fmt::format("operation {}: INT", i), b.machine.outputs().get(pin::kIsaIrq),
                 reference.interrupts() ? 1 : 0);
    }
    b.report.step("random talk", same, kOperations,
                  fmt::format("{} operations, {} initialisations, {} interrupts acknowledged, {} polls", kOperations,
                              modes, acknowledged, polled));
    all.acknowledged += acknowledged;
    all.polled += polled;
    for (unsigned i = 0; i < 3; ++i) drive(kSourceMi1 + i, false);
  }
};

}  // namespace

void interrupts_8259(BenchContext& b) { Interrupts8259(b).run(); }

}  // namespace brick
