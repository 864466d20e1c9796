// smoke: the controller starts and every road between host and controller is open: identification, phase and servo
// clock to the tick, interrupt controller, dual-ported RAM, and all printable characters both ways.
#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "testbench/benches/benches.h"

namespace brick {
namespace {

// Default clocks (servo-ic:3.1, servo-ic:3.2): MaxPhase is 2 x 6527 + 3 = 13057 ticks, I7001 = 0, servo = 4 phases.
void clocks(BenchContext& b) {
  constexpr Tick kPhase = 2 * 6527 + 3, kServo = 4 * kPhase, kLimit = 4 * kServo;
  const Tick phase = b.next_fall(pin::kPhase, kLimit);
  for (int i = 1; i <= 3; ++i)
    b.report.equal<std::int64_t>(fmt::format("phase period {}, ticks", i), b.next_fall(pin::kPhase, kLimit) - phase,
                                 i * kPhase);
  Tick last = b.next_fall(pin::kServo, kLimit);
  for (int i = 1; i <= 2; ++i) {
    const Tick servo = b.next_fall(pin::kServo, kLimit);
    b.report.equal<std::int64_t>(fmt::format("servo period {}, ticks", i), servo - last, kServo);
    last = servo;
  }
  const auto source = b.machine.signals().find("clock.source");
  if (source)
    b.report.equal<std::int64_t>("clock.source", static_cast<std::int64_t>(b.machine.signals().value(*source)),
                                 b.clock_variable(7));
  else
    b.report.fail("clock.source", "no such signal");
}

void write_icr(BenchContext& b, std::uint32_t bits) {
  b.bus.io_write(regs::host_io::kIcr.address - HostBus::kIoBase, static_cast<std::uint8_t>(bits));
}

// The same request by an 8259: host-bus:4.5.
void interrupt_controller_8259(BenchContext& b) {
  const auto text = [](const HostBus::Pic8259& p) {
    return fmt::format("IRR={:02X} ISR={:02X} IMR={:02X}", p.irr, p.isr, p.imr);
  };
  b.bus.command_8259(0x1B);  // ICW1: level, single, ICW4
  b.bus.mask_8259(0x08);     // ICW2: vectors from 8
  b.bus.mask_8259(0x01);     // ICW4
  b.bus.mask_8259(0xEF);     // HREQ alone
  b.report.equal<std::string>("8259, initialised", text(b.bus.read_8259()), "IRR=00 ISR=00 IMR=EF");
  write_icr(b, regs::host_io::icr::kTreq.mask());  // the port can take a character: HREQ = 1
  b.report.equal<std::string>("HREQ by level", text(b.bus.read_8259()), "IRR=10 ISR=00 IMR=EF");
  b.report.equal<std::int64_t>("IRQ pin", b.machine.outputs().get(pin::kIsaIrq), 1);
  b.report.equal<std::int64_t>("vector", b.bus.acknowledge_8259(), 8 + 4);
  write_icr(b, 0);
  b.report.equal<std::string>("HREQ in service", text(b.bus.read_8259()), "IRR=00 ISR=10 IMR=EF");
  b.bus.command_8259(0x64);  // its end
  b.bus.mask_8259(0xFF);
}

void interrupt_controller(BenchContext& b) {
  if (b.board.pic_8259) return interrupt_controller_8259(b);
  const auto text = [](const HostBus::Pic& p) {
    return fmt::format("IST={:02X} MSK={:02X} ELR={:02X}", p.ist, p.msk, p.elr);
  };
  b.bus.write_pic_edge_level(0xA5);
  b.bus.write_pic_mask(0x00);
  b.bus.clear_pic();
  b.report.equal<std::string>("interrupt controller, edge/level register", text(b.bus.read_pic()),
                              "IST=00 MSK=00 ELR=A5");
  b.bus.write_pic_edge_level(0x10);  // HREQ level sensed
  b.bus.write_pic_mask(0x10);
  write_icr(b, regs::host_io::icr::kTreq.mask());  // the port can take a character: HREQ = 1
  b.report.equal<std::string>("HREQ by level", text(b.bus.read_pic()), "IST=10 MSK=10 ELR=10");
  b.report.equal<std::int64_t>("IRQ pin", b.machine.outputs().get(pin::kIsaIrq), 1);
  write_icr(b, 0);
  b.report.equal<std::string>("HREQ gone", text(b.bus.read_pic()), "IST=00 MSK=10 ELR=10");
  b.bus.write_pic_mask(0x00);
  b.bus.write_pic_edge_level(0x00);
}

// Walking ones by the host alone, then words across: the firmware sees Y:$060000 + n and X:$060000 + n at host offsets
// 4n and 4n + 2 (host-bus:6.1). At three quarters of the memory nothing is used by an automatic function.
void dual_ported_ram(BenchContext& b) {
  const std::uint32_t place = b.board.dpram_words / 2 * 3 / 4, host = 4 * place, address = 0x60000 + place;
  Comparison same;
  for (unsigned i = 0; i < 16; ++i) b.bus.dpram_write(host + 16 + 2 * i, static_cast<std::uint16_t>(1u << i));
  for (unsigned i = 0; i < 16; ++i)
    same.word(fmt::format("offset ${:X}", host + 16 + 2 * i), b.bus.dpram_read(host + 16 + 2 * i), 1u << i);
  b.report.step("dual-ported RAM, walking ones", same, 16, fmt::format("{} words", same.made()));
  b.bus.dpram_write(host, 0x1234);
  b.bus.dpram_write(host + 2, 0x0567);
  b.expect(fmt::format("RY${:06X}", address), "4660");
  b.expect(fmt::format("RX${:06X}", address), "1383");
  b.expect(fmt::format("WY${:06X},$5AA5", address + 1), "");
  b.report.equal<std::int64_t>("word written by the controller", b.bus.dpram_read(host + 4), 0x5AA5);
}

// Every printable character in a line that must be refused, and one that must be taken.
void characters(BenchContext& b) {
  std::string comment = "VERSION;";
  for (char c = ' '; c < 0x7F; ++c) comment.push_back(c);
  const Reply reply = b.link.command(comment);
  b.report.equal<std::string>("all printable characters in a comment",
                              reply.lines.empty() ? "no reply" : reply.lines[0], "1.947");
  std::string many;  // 35 commands, 245 characters: nearly as long as a line may be (255)
  for (int i = 10; i < 45; ++i) many += fmt::format("P{}={} ", i, 55 - i);
  const Reply taken = b.link.command(many);
  b.report.step("line of 245 characters", taken.complete && !taken.error,
                taken.lines.empty() ? "acknowledged" : taken.lines[0]);
  b.expect("P44", "11");
  b.expect("UUU", "ERR003");
}

void run(BenchContext& b) {
  if (b.negative) b.link.command(fmt::format("I{}=2", b.clock_variable(2)));
  b.expect("VERSION", "1.947");
  b.expect("CID", std::to_string(b.board.card));
  b.expect("I19", std::to_string(b.clock_variable(7)));
  clocks(b);
  interrupt_controller(b);
  dual_ported_ram(b);
  characters(b);
}

}  // namespace

Bench smoke_bench() {
  return {"smoke",
          "boot, identification, clocks to the tick, interrupt controller, dual-ported RAM, characters",
          {"servo divider changed behind the bench's back; in lock-step also SERVO of the RTL one tick late",
           "servo period 1, ticks", "39171, expected 52228", [](MachineConfig& c) { c.seeded_bug = true; }},
          run};
}

}  // namespace brick
