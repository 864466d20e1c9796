// host-port: the HI08 from both sides. Registers and their reset values, flags, HLEND, INIT, HREQ, host commands, and
// words both ways at random: what one side sent is what the other got, none lost, none twice, in order.
#include <algorithm>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "rtl/regs/brick_regs.hpp"
#include "testbench/benches/benches.h"
#include "testbench/benches/bus_cpu.h"

namespace brick {
namespace {

namespace io = regs::host_io;
namespace dsp = regs::hi08;
constexpr std::uint32_t kRreq = io::icr::kRreq.mask(), kTreq = io::icr::kTreq.mask(), kInit = io::icr::kInit.mask(),
                        kHlend = io::icr::kHlend.mask();

using Words = std::vector<std::uint32_t>;

class HostPortBench {
 public:
  explicit HostPortBench(BenchContext& b) : b_(b), random_(b.seed) {}

  void run() {
    {
      BusCpu cpu(b_.bus);
      cpu_ = &cpu;
      reset_values();
      flags();
      bytes_of_a_word();
      initialise();
      request();
      commands();
    }
    unsigned full = 0;  // until chance has filled both ways often enough
    for (unsigned round = 0; round < kMostRounds && full < kLeastFull && good_; ++round) full += words(round);
    b_.report.step("both ways full at once", full >= kLeastFull,
                   fmt::format("{} times, at least {}", full, kLeastFull));
    b_.machine.reset();
    b_.report.step("the firmware is back", b_.link.connect(HostLink::kBootTime), "after a reset");
  }

 private:
  std::uint8_t in(const regs::Register& r) { return b_.bus.io_read(r); }
  void out(const regs::Register& r, std::uint32_t v) { b_.bus.io_write(r, static_cast<std::uint8_t>(v)); }
  std::uint32_t isr(std::uint32_t mask) { return in(io::kIsr)&mask; }
  std::uint32_t hsr(std::uint32_t mask) { return cpu_->read_x(dsp::kHsr.address) & mask; }
  void cpu_write(const regs::Register& r, std::uint32_t v) { cpu_->write_x(r.address, v); }
  void send(std::uint32_t word) {
    out(io::kData5, word >> 16);
    out(io::kData6, word >> 8);
    out(io::kData7, word);
  }
  std::uint32_t receive() {
    const std::uint32_t high = in(io::kData5), middle = in(io::kData6);
    return high << 16 | middle << 8 | in(io::kData7);
  }
  // RESETDRV for 1 us (host-bus:3.8).
  void reset_host_side() {
    for (const bool level : {true, false}) {
      b_.bus.drive_at(b_.machine.now_fs() + isa::ns(1000), [=](HostInputs& pins) { pins.isa_resetdrv = level; });
      b_.bus.wait(12);
    }
  }
  std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

  void reset_values() {
    cpu_write(dsp::kHcr, 0);
    reset_host_side();
    Comparison same;
    same.word("ICR", in(io::kIcr), 0x00);
    same.word("CVR", in(io::kCvr), 0x32);
    same.word("ISR", in(io::kIsr), 0x06);
    same.word("IVR", in(io::kIvr), 0x0F);
    same.word("+4", b_.bus.io_read(4), 0x00);
    same.word("HSR", hsr(0x1F), 0x02);
    b_.report.step("reset values", same, 6, "ICR 00 CVR 32 ISR 06 IVR 0F HSR 02");
  }

  void flags() {
    Comparison same;
    for (unsigned pair = 0; pair < 4; ++pair) {
      out(io::kIcr, io::icr::kHf0.at(pair & 1) | io::icr::kHf1.at(pair >> 1));
      same.word("HF1 HF0", hsr(dsp::hsr::kHf0.mask() | dsp::hsr::kHf1.mask()) >> dsp::hsr::kHf0.lsb, pair);
      cpu_write(dsp::kHcr, dsp::hcr::kHf2.at(pair & 1) | dsp::hcr::kHf3.at(pair >> 1));
      same.word("HF3 HF2", isr(io::isr::kHf2.mask() | io::isr::kHf3.mask()) >> io::isr::kHf2.lsb, pair);
    }
    out(io::kIcr, 0);
    cpu_write(dsp::kHcr, 0);
    b_.report.step("flags both ways", same, 8, "every pair");
  }

  void bytes_of_a_word() {
    Comparison same;
    for (const std::uint32_t hlend : {0u, kHlend}) {
      out(io::kIcr, hlend);
      out(io::kData5, 0x12), out(io::kData6, 0x34), out(io::kData7, 0x56);
      same.word("HORX", cpu_->read_x(dsp::kHorx.address), hlend != 0 ? 0x563412 : 0x123456);
      cpu_write(dsp::kHotx, 0xABCDEF);
      same.word("+5", in(io::kData5), hlend != 0 ? 0xEF : 0xAB);
      same.word("+6", in(io::kData6), 0xCD);
      same.word("RXDF before +7", isr(HostBus::kRxdf), HostBus::kRxdf);
      same.word("+7", in(io::kData7), hlend != 0 ? 0xAB : 0xEF);
      same.word("RXDF after +7", isr(HostBus::kRxdf), 0);
    }
    out(io::kIcr, 0);
    b_.report.step("HLEND", same, 12, "bytes of a word in both orders, +7 takes it");
  }

  // Both ways full on both sides, then INIT with each pair of enables (host-bus:3.2/1).
  void initialise() {
    Comparison same;
    for (const std::uint32_t ways : {0u, kRreq, kTreq, kRreq | kTreq}) {
      for (unsigned i = 0; i < 2; ++i) {
        send(0x111111 * (i + 1));
        cpu_write(dsp::kHotx, 0x333333 * (i + 1));
        b_.bus.wait(12);
      }
      same.word("ISR full", isr(HostBus::kRxdf | HostBus::kTxde), HostBus::kRxdf);
      same.word("HSR full", hsr(dsp::hsr::kHrdf.mask() | dsp::hsr::kHtde.mask()), dsp::hsr::kHrdf.mask());
      out(io::kIcr, kInit | ways);
      const bool tx = (ways & kTreq) != 0, rx = (ways & kRreq) != 0;
      same.word("INIT reads 0", in(io::kIcr), ways);
      same.word("TXDE", isr(HostBus::kTxde) != 0, tx);
      same.word("RXDF", isr(HostBus::kRxdf) != 0, !rx);
      same.word("HRDF", hsr(dsp::hsr::kHrdf.mask()) != 0, !tx);
      same.word("HTDE", hsr(dsp::hsr::kHtde.mask()) != 0, rx);
      out(io::kIcr, kInit | kRreq | kTreq);
      out(io::kIcr, 0);
    }
    b_.report.step("INIT", same, 28, "empties the ways that TREQ and RREQ name");
  }

  // HREQ, bit 7 of ISR and the pin: all sixteen cases.
  void request() {
    Comparison same;
    for (const bool rxdf : {false, true}) {
      for (const bool full : {false, true}) {
        out(io::kIcr, kInit | kRreq | kTreq);
        if (rxdf) cpu_write(dsp::kHotx, 1);
        if (full) send(1), send(2);
        b_.bus.wait(12);
        for (const std::uint32_t enables : {0u, kRreq, kTreq, kRreq | kTreq}) {
          out(io::kIcr, enables);
          b_.bus.wait(6);
          const bool expected = ((enables & kRreq) != 0 && rxdf) || ((enables & kTreq) != 0 && !full);
          same.word("ISR.HREQ", isr(io::isr::kHreq.mask()) != 0, expected);
          same.word("HREQ", b_.machine.outputs().get(pin::kHreq), expected);
        }
      }
    }
    out(io::kIcr, kInit | kRreq | kTreq);
    out(io::kIcr, 0);
    b_.report.step("HREQ", same, 32, "sixteen cases of flags and enables");
  }

  void commands() {
    Comparison same;
    cpu_write(dsp::kHcr, dsp::hcr::kHcie.mask());
    for (unsigned i = 0; i < 8; ++i) {
      const std::uint32_t number = draw(0x80);
      same.word("no command", b_.machine.outputs().get(pin::kIrqHost), 0);
      out(io::kCvr, io::cvr::kHc.mask() | number);
      b_.bus.wait(12);
      same.word("CPU interrupt", b_.machine.outputs().get(pin::kIrqHost), 1);
      same.word("HCP", hsr(dsp::hsr::kHcp.mask()) != 0, 1);
      same.word("HV", dsp::hsr::kHv.get(hsr(0xFFFFFF)), number);
      same.word("HC pends", in(io::kCvr), io::cvr::kHc.mask() | number);
      cpu_write(dsp::kHsr, dsp::hsr::kHcp.mask());
      b_.bus.wait(6);
      same.word("HC taken", in(io::kCvr), number);
    }
    cpu_write(dsp::kHcr, 0);
    b_.report.step("host commands", same, 48, "eight numbers");
  }

  // ---------------------------------------------------------------------------------------------- words both ways
  // The CPU's side for itself: looks at HSR, takes what is there, sends when there is room, at its own pace.
  class Peer final : public BusMaster {
   public:
    Peer(Machine& machine, std::uint64_t seed) : machine_(machine), random_(seed) { machine_.attach_bus_master(this); }
    ~Peer() override { machine_.attach_bus_master(nullptr); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    Words sent, received;
    std::size_t wanted = 0;  // words to send

    std::optional<Access> next() override {
      const auto idle = static_cast<unsigned>(random_() % (random_() % 4 == 0 ? 400 : 20));
      const bool take = dsp::hsr::kHrdf.is_set(status_), room = dsp::hsr::kHtde.is_set(status_);
      status_ = 0;
      if (take && (!room || random_() % 2 == 0)) return Access{true, dsp::kHorx.address, false, 0, idle};
      if (room && sent.size() < wanted && random_() % 4 != 0) {
        const auto word = static_cast<std::uint32_t>(random_() & 0xFFFFFF);
        sent.push_back(word);
        return Access{true, dsp::kHotx.address, true, word, idle};
      }
      return Access{true, dsp::kHsr.address, false, 0, idle};
    }
    void done(const Access& access, std::uint32_t data) override {
      if (access.write) return;
      if (access.address == dsp::kHorx.address)
        received.push_back(data);
      else
        status_ = data;
    }

   private:
    Machine& machine_;
    std::mt19937_64 random_;
    std::uint32_t status_ = 0;
  };

  static constexpr unsigned kLeastFull = 10, kMostRounds = 100;

  // How often both ways were full.
  unsigned words(unsigned round) {
    constexpr std::size_t kWords = 300;
    Peer peer(b_.machine, b_.seed + 1 + round);
    peer.wanted = kWords;
    Words sent, received;
    unsigned full = 0;
    const Tick limit = b_.bus.now() + ns_to_ticks(20'000'000);
    const auto differ = [](const Words& from, const Words& to) {
      return !std::equal(to.begin(), to.end(), from.begin(), from.begin() + std::min(from.size(), to.size()));
    };
    const auto all = [&] { return std::min({sent.size(), received.size(), peer.received.size()}) >= kWords; };
    while (!all() && !differ(sent, peer.received) && !differ(peer.sent, received) && b_.bus.now() < limit) {
      const std::uint32_t status = isr(0xFF);
      const bool room = (status & HostBus::kTxde) != 0, word = (status & HostBus::kRxdf) != 0;
      full += !room && word ? 1 : 0;
      const bool blind = b_.negative && !room && sent.size() > 20;
      if ((room || blind) && sent.size() < kWords && (!word || draw(2) == 0)) {
        sent.push_back(draw(1u << 24));
        send(sent.back());
      } else if (word) {
        received.push_back(receive());
      }
      if (draw(8) == 0) b_.bus.wait(draw(2000));
    }
    compare("words host to CPU", sent, peer.received, kWords);
    compare("words CPU to host", peer.sent, received, kWords);
    return full;
  }

  void compare(const std::string& name, const Words& sent, const Words& received, std::size_t least) {
    std::size_t same = 0;
    while (same < sent.size() && same < received.size() && sent[same] == received[same]) ++same;
    const auto at = [same](const Words& v) {
      return same < v.size() ? fmt::format("${:06X}", v[same]) : std::string("nothing");
    };
    const bool good = same >= least && same == sent.size() && same == received.size();
    good_ = good_ && good;
    b_.report.step(name, good,
                   good ? fmt::format("{} words in order", same)
                        : fmt::format("word {} of {} arrived as {}, expected {}; {} came", same, sent.size(),
                                      at(received), at(sent), received.size()));
  }

  BenchContext& b_;
  std::mt19937_64 random_;
  BusCpu* cpu_ = nullptr;
  bool good_ = true;  // words both ways, so far
};

}  // namespace

Bench host_port_bench() {
  return {
      "host-port",
      "host port from both sides: flags, INIT, HLEND, HREQ, host commands, words both ways at random",
      {"the host writes words without looking at TXDE", "words host to CPU", "arrived as $??????, expected $??????;"},
      [](BenchContext& b) { HostPortBench(b).run(); }};
}

}  // namespace brick
